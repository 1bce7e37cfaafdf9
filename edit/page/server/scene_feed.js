// The scene as the server has it: fetched when the server says that it changed, and with it, when
// they are others, the outlines of the surfaces.

import { get, Refusal, Unreachable } from "./api.js";

export class SceneFeed {
    #scene;
    #outlines;
    #editing;
    #onUnreadable;
    #onChange;
    #fetching = false;
    #stale = false;
    #outlinesKey = null;

    /**
     * `onUnreadable(state)`: the file could not be read yet, and there is nothing to show;
     * `onChange(state)`: the scene was changed, and not from here.
     */
    constructor(scene, outlines, editing, onUnreadable, onChange) {
        this.#scene = scene;
        this.#outlines = outlines;
        this.#editing = editing;
        this.#onUnreadable = onUnreadable;
        this.#onChange = onChange;
        scene.observe(({ outlines: { key } }) => this.#fetchOutlines(key));
    }

    async fetch() {
        this.#stale = this.#fetching;
        if (this.#fetching) return;
        this.#fetching = true;
        do {
            // What is being changed here comes with the answers to the edits, and is newer.
            await this.#editing.settled();
            this.#stale = false;
            try {
                const state = await get("state");
                if (this.#editing.isBusy) this.#stale = true;
                else if (state.lamps) this.#take(state);
                else this.#onUnreadable(state);
            } catch (error) {
                if (!(error instanceof Refusal || error instanceof Unreachable)) throw error;
            }
        } while (this.#stale);
        this.#fetching = false;
    }

    #take(state) {
        const before = this.#scene.value?.revision ?? null;
        this.#scene.set(state);
        if (before !== null && before !== state.revision) this.#onChange(state);
    }

    async #fetchOutlines(key) {
        if (key === this.#outlinesKey) return;
        this.#outlinesKey = key;
        try {
            this.#outlines.set((await get("outlines")).segments);
        } catch (error) {
            this.#outlinesKey = null;
            if (!(error instanceof Refusal || error instanceof Unreachable)) throw error;
        }
    }
}
