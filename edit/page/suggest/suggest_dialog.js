// Suggest: asks the server to try positions of a lamp, shows the map of the objective while it does,
// and applies the best one as one step that can be undone.

import { h, setText } from "../base/dom.js";
import { hasPlace } from "../base/lamps.js";
import { formatNumber } from "../base/numbers.js";
import { post } from "../server/api.js";
import { numberField, numbersField, selectField } from "../panels/fields.js";
import { objectiveMap } from "./objective_map.js";

const OBJECTIVES = {
    contrast: "contrast of the target",
    signal_to_backscatter: "signal to backscatter",
    irradiance: "irradiance on the target",
};
const HALF_BAR = 1.5; // metres to both sides of the lamp's place
const HALF_BOX = [1, 0.6, 0.4];

export class SuggestDialog {
    #dialog;
    #scene;
    #editing;
    #form;
    #map;
    #status;
    #progress;
    #buttons;
    #wish = null;
    #running = false;
    #result = null;

    constructor(scene, editing) {
        this.#scene = scene;
        this.#editing = editing;
        this.#form = h("div", { class: "form suggest-form" });
        this.#map = h("div", { class: "objective" });
        this.#status = h("p", { class: "hint", role: "status" });
        this.#progress = h("progress", { max: 1, value: 0, "aria-label": "Positions tried" });
        const button = (label, action, kind) =>
            h("button", { type: "button", class: kind, onclick: action }, label);
        this.#buttons = {
            search: button("Search", () => this.#search(), "primary"),
            cancel: button("Cancel search", () => this.#cancel()),
            apply: button("Apply", () => this.#apply(), "primary"),
            close: button("Close", () => this.#dialog.close()),
        };
        this.#dialog = h("dialog", { class: "suggest", "aria-label": "Suggest a place for a lamp",
            onclose: () => this.#running && this.#cancel() },
        h("h2", {}, "Suggest a place for a lamp"),
        h("div", { class: "suggest-columns" }, this.#form,
            h("div", {}, this.#map, this.#progress, this.#status)),
        h("div", { class: "dialog-buttons" }, ...Object.values(this.#buttons)));
        document.body.append(this.#dialog);
    }

    /** `bar`: that of the plan views in the world, or null. */
    open(lamp) {
        this.#result = null;
        this.#wish = {
            lamp: lamp.name, shape: "bar", mirror: null, aim: true, distance: 3,
            objective: "contrast", samples: 60, least_light: 0.5,
            ...this.#room(lamp, "bar"),
        };
        this.#map.replaceChildren(h("p", { class: "hint" },
            "The map of the objective appears here while positions are tried."));
        this.#build();
        this.#show();
        this.#dialog.showModal();
    }

    /** Where to search, around the lamp's place, in its own frame. */
    #room({ position }, shape) {
        const half = shape === "bar" ? [HALF_BAR, 0, 0] : HALF_BOX;
        const rounded = (value) => Number(value.toFixed(3));
        return {
            from: shape === "bar" ? [-HALF_BAR, position[1], position[2]].map(rounded)
                : position.map((value, k) => rounded(value - half[k])),
            to: shape === "bar" ? [HALF_BAR, position[1], position[2]].map(rounded)
                : position.map((value, k) => rounded(value + half[k])),
        };
    }

    #build() {
        const wish = this.#wish;
        const { lamps } = this.#scene.value;
        const editable = lamps.filter((lamp) => lamp.editable && hasPlace(lamp));
        const lamp = lamps.find((each) => each.name === wish.lamp);
        const parts = [];
        const add = (field, value) => {
            field.update(value);
            parts.push(field.element);
        };
        const keep = (key, then = () => {}) => (value) => {
            wish[key] = value;
            then(value);
        };
        add(selectField({ label: "Lamp", key: "lamp",
            options: editable.map(({ name }) => ({ value: name, label: name })),
            commit: keep("lamp", (name) => {
                Object.assign(wish, this.#room(lamps.find((each) => each.name === name), wish.shape));
                if (wish.mirror === name) wish.mirror = null;
                this.#build();
            }) }), wish.lamp);
        add(selectField({ label: "Mirrored lamp", key: "mirror",
            options: [{ value: null, label: "none" }, ...editable.filter((each) =>
                each.name !== wish.lamp).map(({ name }) => ({ value: name, label: name }))],
            commit: keep("mirror") }), wish.mirror);
        add(selectField({ label: "Search", key: "shape",
            options: [{ value: "bar", label: "along a bar" }, { value: "box", label: "within a box" }],
            commit: keep("shape", (shape) => {
                Object.assign(wish, this.#room(lamp, shape));
                this.#build();
            }) }), wish.shape);
        const corner = (label, key) => add(numbersField({ label, unit: "m", key, step: 0.05,
            names: ["x", "y", "z"], commit: keep(key, () => this.#build()) }), wish[key]);
        corner(wish.shape === "bar" ? "From" : "Least", "from");
        corner(wish.shape === "bar" ? "To" : "Greatest", "to");
        parts.push(h("p", { class: "hint" }, `In the lamp's frame: ${lamp.frame}.`));
        add(selectField({ label: "Direction", key: "aim",
            options: [{ value: "aim", label: "turned to the target" },
                { value: null, label: "as it is" }],
            commit: (value) => { wish.aim = value !== null; } }), wish.aim ? "aim" : null);
        const number = (label, unit, key) => add(numberField({ label, unit, key,
            commit: keep(key) }), wish[key]);
        number("Target at", "m", "distance");
        add(selectField({ label: "Best", key: "objective",
            options: Object.entries(OBJECTIVES).map(([value, label]) => ({ value, label })),
            commit: keep("objective") }), wish.objective);
        number("Least light kept", "", "least_light");
        number("Positions, at most", "", "samples");
        parts.push(h("p", { class: "hint" }, "Computed of light that is scattered once, for a target " +
            "alone in the scene's water."));
        this.#form.replaceChildren(...parts);
    }

    #show(text = "") {
        const { search, cancel, apply } = this.#buttons;
        search.hidden = this.#running;
        cancel.hidden = !this.#running;
        apply.disabled = this.#running || !this.#isBetter();
        this.#progress.hidden = !this.#running;
        setText(this.#status, text);
    }

    #isBetter() {
        return this.#result !== null && this.#result.best.value > this.#result.before.value;
    }

    async #search() {
        const { shape, from, to, ...rest } = this.#wish;
        this.#result = null;
        this.#running = true;
        this.#progress.value = 0;
        this.#show("Positions are being tried…");
        try {
            await post("suggest", { ...rest, ...(shape === "bar" ? { along: { from, to } }
                : { box: { min: from, max: to } }) });
        } catch (error) {
            this.#running = false;
            this.#show(error.message);
        }
    }

    async #cancel() {
        try {
            await post("suggest/cancel");
        } catch (error) {
            this.#show(error.message);
        }
    }

    /** The server's event: {state: searching, found, cancelled or failed, ...}. */
    hear(event) {
        if (!this.#dialog.open) return;
        if (event.state === "searching") {
            this.#progress.value = event.tried / event.samples;
            setText(this.#status, `${event.tried} of at most ${event.samples} positions tried; ` +
                `best so far ${formatNumber(event.best.value, 4)}`);
            return;
        }
        this.#running = false;
        this.#result = event.state === "found" ? event : null;
        if (this.#result) this.#draw(event);
        this.#show({ found: () => this.#outcome(event), cancelled: () => "Cancelled.",
            failed: () => event.message }[event.state]());
    }

    #outcome({ before, best, tried }) {
        const value = (point) => formatNumber(point.value, 4);
        if (!this.#isBetter())
            return `${OBJECTIVES[this.#wish.objective]}: ${value(before)} now; none of ${tried} ` +
                `positions is better, the best reaches ${value(best)}.`;
        const place = best.position.map((each) => formatNumber(each, 3)).join(", ");
        const light = best.numbers.irradiance / before.numbers.irradiance;
        return `${OBJECTIVES[this.#wish.objective]}: ${value(before)} now, ${value(best)} at ` +
            `(${place}) m, with ${formatNumber(light, 3)} of the light on the target; ` +
            `${tried} positions tried.`;
    }

    #draw(result) {
        this.#map.replaceChildren(objectiveMap(result, this.#wish, OBJECTIVES[this.#wish.objective]));
    }

    async #apply() {
        const rounded = (vector) => vector.map((value) => Number(value.toFixed(4)));
        const changes = this.#result.lamps.flatMap(({ lamp, position, direction }) => [
            { op: "set", path: `lamps.${lamp}.position`, value: rounded(position) },
            { op: "set", path: `lamps.${lamp}.direction`, value: rounded(direction) },
        ]);
        const done = await this.#editing.edit(`suggested place of ${this.#wish.lamp}`, changes,
            { onRefusal: (error) => this.#show(error.message) });
        if (done) this.#dialog.close();
    }
}
