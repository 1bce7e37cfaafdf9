// What has to be said above everything: no server, a scene that cannot be read, a file that changed.

import { h } from "../base/dom.js";

export class Banners {
    #place;
    #shown = new Map();

    constructor(place) {
        this.#place = place;
    }

    /** Shows, changes or (text null) removes the banner of that name. */
    show(name, text, { kind = "warning", buttons = [] } = {}) {
        const key = text === null ? null : JSON.stringify([text, kind, buttons.map((b) => b.label)]);
        if ((this.#shown.get(name)?.key ?? null) === key) return;
        this.#shown.get(name)?.element.remove();
        this.#shown.delete(name);
        if (text === null) return;
        const element = h("div", { class: `banner ${kind}`, role: "alert", "data-banner": name },
            h("span", { class: "banner-text" }, text),
            buttons.map(({ label, action }) =>
                h("button", { type: "button", onclick: action }, label)));
        this.#place.append(element);
        this.#shown.set(name, { key, element });
    }
}
