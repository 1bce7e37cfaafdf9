// What the picture is seen through where that is not sRGB: a view of an OpenColorIO config, as a table
// of bytes over red, green and blue, at equal steps of log2(1 + light / least).

import { getBytes, Refusal, Unreachable } from "../server/api.js";

/** The colour of light as the table has it, interpolated linearly: writes three bytes. */
export function lookUp({ side, least, octaves, bytes }, light, into, at) {
    const below = [0, 0, 0], part = [0, 0, 0];
    for (let channel = 0; channel < 3; ++channel) {
        const value = light[channel];
        const place = value > 0
            ? Math.min(Math.log2(1 + value / least) / octaves, 1) * (side - 1) : 0;
        below[channel] = Math.min(Math.floor(place), side - 2);
        part[channel] = place - below[channel];
    }
    const first = 3 * (below[0] + side * (below[1] + side * below[2]));
    const [right, down, back] = [3, 3 * side, 3 * side * side];
    for (let channel = 0; channel < 3; ++channel) {
        let sum = 0;
        for (let corner = 0; corner < 8; ++corner) {
            const weight = (corner & 1 ? part[0] : 1 - part[0]) *
                (corner & 2 ? part[1] : 1 - part[1]) * (corner & 4 ? part[2] : 1 - part[2]);
            sum += weight * bytes[first + (corner & 1 ? right : 0) + (corner & 2 ? down : 0) +
                (corner & 4 ? back : 0) + channel];
        }
        into[at + channel] = Math.floor(sum + 0.5);
    }
}

/** Fetches the view of the scene's pictures when it is another; `onView(view)`, null: sRGB. */
export class ViewFeed {
    #onView;
    #key = null;

    constructor(scene, onView) {
        this.#onView = onView;
        scene.observe((state) => this.#take(state.view));
    }

    /** The server's keys begin anew. */
    forget() {
        this.#key = null;
    }

    async #take(view) {
        const key = view?.key ?? null;
        if (key === this.#key) return;
        this.#key = key;
        if (view === null) {
            this.#onView(null);
            return;
        }
        try {
            const bytes = new Uint8Array(await getBytes("view"));
            if (key === this.#key) this.#onView({ ...view, bytes });
        } catch (error) {
            this.#key = null; // asked for again with the next change
            if (!(error instanceof Refusal || error instanceof Unreachable)) throw error;
        }
    }
}
