// Edits of the scene, one after the other. While one is on its way, a newer one of the same group (a
// drag, say) takes the place of an older one that still waits: only the last position matters.

import { post } from "./api.js";

export class Editing {
    #scene;
    #waiting = [];
    #idle = [];
    #sending = false;
    #onRefusal;
    #onBusy;

    /**
     * `scene`: the observable state of the server; `onRefusal(error)` hears what was refused,
     * `onBusy(isBusy)` when the first edit is sent and the last one answered.
     */
    constructor(scene, onRefusal, onBusy) {
        this.#scene = scene;
        this.#onRefusal = onRefusal;
        this.#onBusy = onBusy;
    }

    /** The scene after the last answer. */
    get scene() {
        return this.#scene.value;
    }

    get isBusy() {
        return this.#sending;
    }

    /** Resolves when nothing is on its way or waits. */
    settled() {
        if (!this.#sending) return Promise.resolve();
        return new Promise((resolve) => { this.#idle.push(resolve); });
    }

    /**
     * Asks for changes that are undone together under `label`; changes of one `group` in succession
     * are one step. A function of the scene makes the changes when it is their turn: so each of
     * several steps begins where the one before ended. True when done, false when refused (unless
     * the caller hears of that itself, by `onRefusal`) or replaced by a newer change.
     */
    edit(label, changes, { group = null, onRefusal = this.#onRefusal } = {}) {
        const body = (scene) => ({
            revision: scene.revision, label,
            changes: typeof changes === "function" ? changes(scene) : changes,
            ...(group === null ? {} : { group }),
        });
        const replaces = typeof changes === "function" ? null : group;
        return this.#enqueue({ path: "edit", body, replaces, onRefusal });
    }

    /** Undo, redo, save, show and so on: `post`s whose answer is the new state. */
    run(path, body = {}, onRefusal = this.#onRefusal) {
        return this.#enqueue({ path, body: () => body, replaces: path === "show" ? path : null, onRefusal });
    }

    #enqueue(task) {
        return new Promise((resolve) => {
            const last = this.#waiting.at(-1);
            if (task.replaces !== null && last?.replaces === task.replaces) {
                last.resolve(false);
                this.#waiting.pop();
            }
            this.#waiting.push({ ...task, resolve });
            this.#send();
        });
    }

    async #send() {
        if (this.#sending) return;
        this.#sending = true;
        this.#onBusy(true);
        for (let task; (task = this.#waiting.shift()); ) {
            try {
                this.#scene.set(await post(task.path, task.body(this.#scene.value)));
                task.resolve(true);
            } catch (error) {
                task.onRefusal(error);
                task.resolve(false);
            }
        }
        this.#sending = false;
        this.#onBusy(false);
        for (const resolve of this.#idle.splice(0)) resolve();
    }
}

let lastGroup = 0;
const page = Math.random().toString(36).slice(2);

/** A name for the edits of one drag, unlike that of any other window. */
export const newGroup = (kind) => `${kind}-${page}-${++lastGroup}`;
