// The bar between the kept snapshot, on its left, and the picture: dragged, or moved by arrow keys.

import { h, setAttributes } from "../base/dom.js";

const KEY_STEP = 0.02;

export class SplitBar {
    #bar;
    #labels;

    constructor(box, settings) {
        this.#bar = h("div", {
            class: "split-bar", role: "separator", tabindex: 0, "aria-orientation": "vertical",
            "aria-label": "Snapshot on the left, the picture at hand on the right",
            "aria-valuemin": 0, "aria-valuemax": 100, hidden: true,
        });
        this.#labels = h("div", { class: "split-labels", "aria-hidden": "true", hidden: true },
            h("span", {}, "snapshot"), h("span", {}, "now"));
        box.append(this.#labels, this.#bar);
        const moveTo = (at) => {
            const inside = Math.min(Math.max(at, 0.01), 0.99);
            settings.update({ split: { ...settings.value.split, at: inside } });
        };
        this.#bar.addEventListener("pointerdown", (event) => {
            this.#bar.setPointerCapture(event.pointerId);
            event.preventDefault();
            this.#bar.focus();
        });
        this.#bar.addEventListener("pointermove", (event) => {
            if (!this.#bar.hasPointerCapture(event.pointerId)) return;
            const room = box.getBoundingClientRect();
            moveTo((event.clientX - room.left) / room.width);
        });
        this.#bar.addEventListener("keydown", (event) => {
            const step = { ArrowLeft: -KEY_STEP, ArrowRight: KEY_STEP }[event.key];
            if (!step) return;
            event.preventDefault();
            moveTo(settings.value.split.at + step);
        });
    }

    update(shown, at) {
        this.#bar.hidden = !shown;
        this.#labels.hidden = !shown;
        this.#bar.style.left = `${at * 100}%`;
        this.#labels.style.left = `${at * 100}%`;
        setAttributes(this.#bar, { "aria-valuenow": Math.round(at * 100) });
    }
}
