// The list of lamps: choose, switch on and off, solo, and the tools that add and take away.

import { h, setAttributes, setText } from "../base/dom.js";
import { hasPlace } from "../base/lamps.js";
import { lampColour } from "./lamp_colours.js";

/** Half a metre to the left of the camera, shining ahead. */
const NEW_LAMP = {
    name: "lamp", position: [-0.5, 0, 0], direction: [0, 0, 1],
    profile: { type: "spot", beam: 60, edge: 5 }, intensity: 20,
};

export class LampList {
    #list;
    #rows = new Map();
    #settings;
    #editing;
    #scene;
    #tools;

    constructor(place, scene, settings, editing) {
        this.#settings = settings;
        this.#editing = editing;
        this.#scene = scene;
        this.#list = h("ul", { class: "lamp-list", role: "listbox", "aria-label": "Lamps",
            onkeydown: (event) => this.#key(event) });
        const tool = (name, title, action) => h("button",
            { type: "button", title, onclick: action }, name);
        this.#tools = {
            add: tool("Add", "A new lamp beside the camera", () => this.add()),
            duplicate: tool("Duplicate", "A copy of the chosen lamp (D)", () => this.duplicate()),
            mirror: tool("Mirror", "A copy on the other side of the camera (M)", () => this.mirror()),
            remove: tool("Delete", "Take the chosen lamp away (Delete)", () => this.remove()),
        };
        place.append(this.#list, h("div", { class: "tools", role: "toolbar",
            "aria-label": "Lamps" }, ...Object.values(this.#tools)));
        scene.observe(() => this.#update());
        settings.observe(() => this.#update());
    }

    get chosen() {
        const { selected } = this.#settings.value;
        return this.#scene.value?.lamps.find((lamp) => lamp.name === selected) ?? null;
    }

    select(lamp) {
        if (lamp && lamp.name !== this.#settings.value.selected) {
            this.#settings.update({ selected: lamp.name });
        }
    }

    /** Runs a change that makes a lamp, and chooses what it made. */
    async #make(label, change) {
        const before = new Set(this.#scene.value.lamps.map((lamp) => lamp.name));
        if (await this.#editing.edit(label, [change])) {
            this.select(this.#scene.value.lamps.find((lamp) => !before.has(lamp.name)));
        }
    }

    add() {
        const like = this.chosen?.editable && hasPlace(this.chosen) ? { like: this.chosen.name } : {};
        return this.#make("add lamp", { op: "add_lamp", ...like, lamp: NEW_LAMP });
    }

    duplicate() {
        const lamp = this.chosen;
        return lamp && this.#make(`duplicate ${lamp.name}`, { op: "duplicate_lamp", lamp: lamp.name });
    }

    mirror() {
        const lamp = this.chosen;
        return lamp && hasPlace(lamp) && this.#make(`mirror ${lamp.name}`,
            { op: "mirror_lamp", lamp: lamp.name, copy: true });
    }

    async remove() {
        const lamp = this.chosen;
        if (!lamp?.editable) return;
        const lamps = this.#scene.value.lamps;
        const next = lamps[lamps.indexOf(lamp) + 1] ?? lamps[lamps.indexOf(lamp) - 1] ?? null;
        if (await this.#editing.edit(`delete ${lamp.name}`, [{ op: "remove_lamp", lamp: lamp.name }])) {
            this.#settings.update({ selected: next?.name ?? null });
        }
    }

    toggleOn(lamp = this.chosen) {
        if (!lamp) return;
        this.#editing.edit(`switch ${lamp.name} ${lamp.on ? "off" : "on"}`,
            [{ op: "lamp_on", lamp: lamp.name, on: !lamp.on }]);
    }

    toggleSolo(lamp = this.chosen) {
        if (!lamp) return;
        const { solo } = this.#settings.value;
        this.#settings.update({ solo: solo === lamp.name ? null : lamp.name });
    }

    #row(of) {
        const lamp = () => this.#scene.value.lamps.find((each) => each.name === of);
        const on = h("button", { type: "button", class: "toggle on", role: "switch",
            onclick: (event) => { event.stopPropagation(); this.toggleOn(lamp()); } });
        const solo = h("button", { type: "button", class: "toggle solo",
            onclick: (event) => { event.stopPropagation(); this.toggleSolo(lamp()); } }, "S");
        const name = h("span", { class: "lamp-name" });
        const detail = h("span", { class: "lamp-detail" });
        const option = h("div", { class: "lamp-option", role: "option",
            onclick: () => { this.select(lamp()); option.focus(); },
            onfocus: () => this.select(lamp()) },
        h("span", { class: "swatch", "aria-hidden": "true" }), name, detail);
        const element = h("li", { role: "presentation" }, option, on, solo);
        return { element, option, on, solo, name, detail };
    }

    #update() {
        const scene = this.#scene.value;
        if (!scene) return;
        const { selected, solo } = this.#settings.value;
        if (!scene.lamps.some((lamp) => lamp.name === selected) && scene.lamps.length > 0) {
            this.#settings.update({ selected: scene.lamps[0].name });
            return;
        }
        if (solo !== null && !scene.lamps.some((lamp) => lamp.name === solo)) {
            this.#settings.update({ solo: null });
            return;
        }
        const seen = new Set(scene.lamps.map((lamp) => lamp.name));
        for (const [name, row] of this.#rows) {
            if (!seen.has(name)) {
                row.element.remove();
                this.#rows.delete(name);
            }
        }
        scene.lamps.forEach((lamp, index) => {
            if (!this.#rows.has(lamp.name)) this.#rows.set(lamp.name, this.#row(lamp.name));
            const row = this.#rows.get(lamp.name);
            if (this.#list.children[index] !== row.element) {
                this.#list.insertBefore(row.element, this.#list.children[index] ?? null);
            }
            this.#show(row, lamp, index, selected, solo);
        });
        const { chosen } = this;
        this.#tools.duplicate.disabled = !chosen;
        this.#tools.mirror.disabled = !chosen || !hasPlace(chosen);
        this.#tools.remove.disabled = !chosen?.editable;
    }

    #show(row, lamp, index, selected, solo) {
        const chosen = lamp.name === selected;
        row.element.style.setProperty("--lamp", lampColour(index));
        setAttributes(row.element, {
            class: `${chosen ? "chosen" : ""}${lamp.on ? "" : " off"}` +
                `${solo !== null && solo !== lamp.name ? " silenced" : ""}`,
        });
        setAttributes(row.option, { "aria-selected": String(chosen), tabindex: chosen ? 0 : -1 });
        setText(row.name, lamp.name);
        setText(row.detail, `${lamp.profile.type}, ${lamp.frame}${lamp.editable ? "" : " · locked"}`);
        setAttributes(row.on, { "aria-checked": String(lamp.on),
            "aria-label": `Lamp ${lamp.name} on`, title: lamp.on ? "Switch off (O)" : "Switch on (O)" });
        setAttributes(row.solo, { "aria-pressed": String(solo === lamp.name),
            "aria-label": `Only lamp ${lamp.name}`, title: "See this lamp's light alone (S)" });
    }

    #key(event) {
        const step = { ArrowDown: 1, ArrowUp: -1 }[event.key];
        if (!step || event.target.getAttribute("role") !== "option") return;
        const options = [...this.#list.querySelectorAll("[role=option]")];
        const next = options[options.indexOf(event.target) + step];
        if (!next) return;
        event.preventDefault();
        next.focus();
    }
}
