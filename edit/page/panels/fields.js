// Fields of forms: each has an `element` and `update(value)`, which leaves alone what is being typed.

import { h, newId, setAttributes } from "../base/dom.js";
import { editableNumber, parseNumber, shortNumber } from "../base/numbers.js";

const NUDGE = 0.01; // of a number's size, per press of an arrow key; times ten with Shift

/**
 * An input for one number. `commit(value, refuse)` is called when a number was typed; it may call
 * `refuse(message)` later. Arrow keys step, Escape brings the old value back.
 */
class NumberInput {
    #value = null;
    #message;
    #commit;
    #step;
    #optional;
    #format; // while it is not being typed in

    constructor({ label, key, step = null, optional = false, format = editableNumber, commit,
        message }) {
        this.#format = format;
        this.#commit = commit;
        this.#step = step;
        this.#optional = optional;
        this.#message = message;
        this.element = h("input", {
            type: "text", inputmode: "decimal", class: "number", "aria-label": label,
            "data-key": key, autocomplete: "off", spellcheck: "false", placeholder:
                optional ? "default" : null,
            onchange: () => this.#typed(), onkeydown: (event) => this.#key(event),
            onfocus: () => {
                this.#show(editableNumber);
                this.element.select();
            },
            onblur: () => this.isDirty || this.element.ariaInvalid || this.#show(this.#format),
        });
    }

    update(value, disabled) {
        this.#value = value;
        this.element.disabled = disabled;
        const typing = document.activeElement === this.element && this.isDirty;
        if (typing) return;
        this.#show(document.activeElement === this.element ? editableNumber : this.#format);
    }

    get isDirty() {
        return this.element.value !== this.element.defaultValue;
    }

    #show(format) {
        this.element.value = format(this.#value);
        this.element.defaultValue = this.element.value;
        this.#say("");
    }

    #say(text) {
        this.#message(text);
        setAttributes(this.element, { "aria-invalid": text ? "true" : null });
    }

    #typed() {
        const text = this.element.value;
        if (this.#optional && text.trim() === "") return this.#send(null);
        const value = parseNumber(text);
        if (value === null) return this.#say(`“${text}” is no number`);
        return this.#send(value);
    }

    #send(value) {
        const before = this.#value;
        this.#value = value;
        this.element.defaultValue = this.element.value;
        this.#say("");
        this.#commit(value, (error) => {
            this.#value = before;
            this.#say(error.message);
        });
    }

    #key(event) {
        if (event.key === "Escape" && this.isDirty) {
            event.stopPropagation();
            this.#show(editableNumber);
            this.element.select();
        }
        const up = { ArrowUp: 1, ArrowDown: -1 }[event.key];
        const now = parseNumber(this.element.value);
        if (!up || now === null) return;
        event.preventDefault();
        const step = this.#step ?? Math.max(10 ** Math.floor(Math.log10(Math.abs(now) || 1)) * NUDGE * 10, 1e-6);
        this.element.value = editableNumber(now + up * step * (event.shiftKey ? 10 : 1));
        this.#send(parseNumber(this.element.value));
    }
}

function row(label, controls, unit, message) {
    return h("div", { class: "field", role: "group", "aria-label": label },
        h("span", { class: "field-label", "aria-hidden": "true" }, label),
        h("span", { class: "field-controls" }, controls,
            unit ? h("span", { class: "unit" }, unit) : null),
        message);
}

function messageLine() {
    const element = h("span", { class: "field-message", role: "alert" });
    return { element, say: (text) => { element.textContent = text; } };
}

/** `commit(value, refuse)`. */
export function numberField({ label, unit, key, step, optional, commit }) {
    const message = messageLine();
    const input = new NumberInput({
        label: unit ? `${label}, ${unit}` : label, key, step, optional, commit, message: message.say,
    });
    return {
        element: row(label, [input.element], unit, message.element),
        update: (value, disabled = false) => input.update(value, disabled),
    };
}

/** Several numbers in a row, e.g. coordinates: `names` are said, and shown before them. */
export function numbersField({ label, unit, key, names, step, commit }) {
    const message = messageLine();
    let values = names.map(() => 0);
    const inputs = names.map((name, index) => new NumberInput({
        label: `${label} ${name}${unit ? `, ${unit}` : ""}`, key: `${key}.${index}`, step,
        format: shortNumber,
        message: message.say,
        commit: (value, refuse) =>
            commit(values.map((old, i) => (i === index ? value : old)), refuse),
    }));
    const element = row(label, inputs.map((input, index) =>
        h("span", { class: "named" }, h("span", { "aria-hidden": "true" }, names[index]),
            input.element)), unit, message.element);
    element.classList.add("several");
    return {
        element,
        update: (now, disabled = false) => {
            values = now;
            inputs.forEach((input, index) => input.update(now[index], disabled));
        },
    };
}

/** `options`: [{value, label}], the empty value standing for null. */
export function selectField({ label, key, options, commit }) {
    const message = messageLine();
    let shown = null;
    const select = h("select", {
        "aria-label": label, "data-key": key,
        onchange: () => {
            message.say("");
            commit(select.value === "" ? null : select.value, (error) => {
                select.value = shown ?? "";
                message.say(error.message);
            });
        },
    }, options.map(({ value, label: text }) => h("option", { value: value ?? "" }, text)));
    return {
        element: row(label, [select], null, message.element),
        update: (value, disabled = false) => {
            shown = value;
            select.value = value ?? "";
            select.disabled = disabled;
        },
    };
}

/** `commit(checked, refuse)`. */
export function checkField({ label, key, commit }) {
    const message = messageLine();
    const id = newId("check");
    const box = h("input", {
        type: "checkbox", id, "data-key": key,
        onchange: () => commit(box.checked, (error) => message.say(error.message)),
    });
    return {
        element: h("div", { class: "field" }, h("span", { class: "field-label" }),
            h("label", { class: "field-controls", for: id }, box, label), message.element),
        update: (value, disabled = false) => {
            box.checked = value;
            box.disabled = disabled;
        },
    };
}

/** A name or other text of one line. */
export function textField({ label, key, commit }) {
    const message = messageLine();
    let shown = "";
    const input = h("input", {
        type: "text", class: "text", "aria-label": label, "data-key": key, autocomplete: "off",
        spellcheck: "false",
        onchange: () => {
            input.defaultValue = input.value;
            message.say("");
            commit(input.value.trim(), (error) => message.say(error.message));
        },
        onkeydown: (event) => {
            if (event.key === "Escape" && input.value !== shown) {
                event.stopPropagation();
                input.value = shown;
                message.say("");
            }
        },
    });
    return {
        element: row(label, [input], null, message.element),
        update: (value, disabled = false) => {
            shown = value;
            input.disabled = disabled;
            if (document.activeElement === input && input.value !== input.defaultValue) return;
            input.value = value;
            input.defaultValue = value;
            message.say("");
        },
    };
}

/** A slider over decades. `input(value)` while it moves, `commit(value)` when it was let go. */
export function logSlider({ label, key, low, high, input, commit }) {
    const decades = Math.log10(high / low);
    const valueOf = () => low * 10 ** (Number(slider.value) * decades);
    const slider = h("input", {
        type: "range", min: 0, max: 1, step: 0.002, "aria-label": label, "data-key": key,
        oninput: () => input(valueOf()), onchange: () => commit(valueOf()),
    });
    return {
        element: slider,
        update: (value, disabled = false) => {
            slider.disabled = disabled;
            if (slider.matches(":active")) return;
            const place = Math.log10(Math.max(value, low) / low) / decades;
            slider.value = Math.min(Math.max(place, 0), 1);
            setAttributes(slider, { "aria-valuetext": editableNumber(value) });
        },
    };
}
