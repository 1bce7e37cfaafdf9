// A form whose fields depend on what it shows: built anew when other fields are due, else only
// updated, and the keyboard's focus stays where it was in either case.

import { h } from "../base/dom.js";

export class Form {
    #place;
    #build;
    #signature = null;
    #parts = [];

    /**
     * `build(subject)` gives the form's parts: {element, update(subject)}; a string is a heading.
     * They are built anew when `signature(subject)` differs.
     */
    constructor(place, signature, build) {
        this.#place = place;
        this.#build = build;
        this.signature = signature;
    }

    update(subject) {
        const signature = JSON.stringify(this.signature(subject));
        if (signature !== this.#signature) {
            this.#signature = signature;
            const focused = this.#place.contains(document.activeElement)
                ? document.activeElement.dataset.key : null;
            this.#parts = this.#build(subject);
            this.#place.replaceChildren(...this.#parts.map((part) =>
                typeof part === "string" ? h("h3", {}, part) : part.element));
            if (focused) this.#place.querySelector(`[data-key="${CSS.escape(focused)}"]`)?.focus();
        }
        for (const part of this.#parts) {
            if (typeof part !== "string") part.update(subject);
        }
    }
}

/** Binds a field to what it shows of the subject: `read(subject)`, `disabled(subject)`. */
export const bound = (field, read, disabled = () => false) => ({
    element: field.element,
    update: (subject) => field.update(read(subject), disabled(subject)),
});
