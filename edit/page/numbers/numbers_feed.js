// The numbers of the picture at hand, asked for anew when the picture or the patch has changed, one
// request at a time.

import { get, Refusal, Unreachable } from "../server/api.js";

/** The numbers' query: the patch, if it was chosen, and the ratio. */
export function numbersQuery({ patch, ratio }) {
    const query = new URLSearchParams({ ratio });
    if (patch) ["x0", "y0", "x1", "y1"].forEach((name, index) => query.set(name, patch[index]));
    return `?${query}`;
}

const CONFLICT = 409; // another picture, or a newer request, came between

export class NumbersFeed {
    #settings;
    #onNumbers;
    #onRefusal;
    #fetching = false;
    #stale = false;
    #quality = null;
    #asked = null;

    /** Curves are asked for while they can be seen, and not of the first small pictures. */
    constructor(settings, onNumbers, onRefusal) {
        this.#settings = settings;
        this.#onNumbers = onNumbers;
        this.#onRefusal = onRefusal;
        settings.observe(() => {
            if (this.#quality !== null && this.#query() !== this.#asked) this.fetch(this.#quality);
        });
    }

    #query() {
        const withCurves = this.#settings.value.tab === "numbers" && this.#quality !== "small";
        return `${numbersQuery(this.#settings.value)}${withCurves ? "&curves=1" : ""}`;
    }

    /** Of the newest picture, whose quality is known. */
    async fetch(quality) {
        this.#quality = quality;
        this.#stale = this.#fetching;
        if (this.#fetching) return;
        this.#fetching = true;
        do {
            this.#stale = false;
            this.#asked = this.#query();
            try {
                this.#onNumbers(await get(`numbers${this.#asked}`));
            } catch (error) {
                // Without a server the page says so elsewhere.
                if (error instanceof Refusal) {
                    if (error.status !== CONFLICT) this.#onRefusal(error);
                } else if (!(error instanceof Unreachable)) throw error;
            }
        } while (this.#stale);
        this.#fetching = false;
    }
}
