// Fetches the newest image whenever the server says that there is one, one request at a time.

import { getBytes, Refusal, Unreachable } from "../server/api.js";
import { readImage } from "./image_planes.js";

export class ImageFeed {
    #onImage;
    #key = null;
    #fetching = false;
    #stale = false;

    constructor(onImage) {
        this.#onImage = onImage;
    }

    /** The server's keys begin anew. */
    forget() {
        this.#key = null;
    }

    async fetch() {
        if (this.#fetching) {
            this.#stale = true;
            return;
        }
        this.#fetching = true;
        do {
            this.#stale = false;
            try {
                const least = this.#key === null ? "" : `&min=${this.#key + 1}`;
                const bytes = await getBytes(`image?type=f16${least}`);
                if (bytes) {
                    const image = readImage(bytes);
                    this.#key = image.key;
                    this.#onImage(image);
                }
            } catch (error) {
                // Without a server the page says so elsewhere; with the next event it asks again.
                if (!(error instanceof Refusal || error instanceof Unreachable)) throw error;
            }
        } while (this.#stale);
        this.#fetching = false;
    }
}
