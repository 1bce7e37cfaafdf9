// The line at the bottom: what was done last, and what is being computed.

import { h, setText } from "../base/dom.js";

const REFUSAL_SECONDS = 12;
// The pictures by their names in the API.
const PICTURES = {
    first: "light scattered once", small: "small draft", draft: "draft",
    "full-draft": "full-size draft", final: "final picture",
};

export class StatusBar {
    #message;
    #stage;
    #progress;
    #connection;
    #timer = 0;

    constructor(place) {
        this.#message = h("span", { class: "status-message", role: "status", "aria-live": "polite" });
        this.#stage = h("span", { class: "status-stage" });
        this.#progress = h("progress", { max: 1, value: 0, "aria-label": "Picture" });
        this.#connection = h("span", { class: "status-connection" });
        place.append(this.#message, this.#stage, this.#progress, this.#connection);
        this.#progress.hidden = true;
    }

    say(text) {
        clearTimeout(this.#timer);
        this.#message.classList.remove("refused");
        setText(this.#message, text);
    }

    /** Takes away what was done last; what was refused stays for its time. */
    sayNothing() {
        if (!this.#message.classList.contains("refused")) this.say("");
    }

    /** What was refused, in the server's words. */
    refuse(text) {
        this.say(text);
        this.#message.classList.add("refused");
        this.#timer = setTimeout(() => this.say(""), REFUSAL_SECONDS * 1000);
    }

    showConnection(connected) {
        setText(this.#connection, connected ? "connected" : "no server");
        this.#connection.classList.toggle("gone", !connected);
    }

    showProgress({ stage, fraction }) {
        this.#progress.hidden = fraction >= 1;
        this.#progress.value = fraction;
        setText(this.#stage, fraction >= 1 ? "" : `computing: ${PICTURES[stage]}`);
    }

    showImage({ width, height, quality }) {
        this.#progress.hidden = true;
        setText(this.#stage, `${width}×${height}, ${PICTURES[quality]}${
            quality === "first" ? "; all light follows" : ""}`);
    }
}
