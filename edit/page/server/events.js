// The server's events, and whether it can be reached.

import { addressOf, get, Refusal } from "./api.js";

const RETRY_MILLISECONDS = 1500;

/**
 * Calls `handlers[name](data)` for each event. `onConnection` hears "connected", "gone" (nobody
 * answers; tried again and again) or "moved" (a server answers that does not know this address).
 */
export class Events {
    #source = null;
    #handlers;
    #onConnection;
    #connection = null;

    constructor(handlers, onConnection) {
        this.#handlers = handlers;
        this.#onConnection = onConnection;
        this.#open();
        addEventListener("pagehide", () => this.#source?.close());
        addEventListener("pageshow", (event) => event.persisted && this.#open());
    }

    #tell(connection) {
        if (connection === this.#connection) return;
        this.#connection = connection;
        this.#onConnection(connection);
    }

    #open() {
        this.#source?.close();
        this.#source = new EventSource(addressOf("events"));
        this.#source.onopen = () => this.#tell("connected");
        // The server has an event of that name, too, with data.
        this.#source.onerror = (event) => event.data === undefined && this.#retry();
        for (const [name, handler] of Object.entries(this.#handlers)) {
            this.#source.addEventListener(name, (event) => {
                if (event.data !== undefined) handler(JSON.parse(event.data));
            });
        }
    }

    async #retry() {
        this.#source.close();
        try {
            await get("state");
            this.#open();
        } catch (error) {
            this.#tell(error instanceof Refusal ? "moved" : "gone");
            setTimeout(() => this.#retry(), RETRY_MILLISECONDS);
        }
    }
}
