// The bar at the top: file, undo, what is looked at, exposure, snapshot, export, suggest.

import { h, setAttributes, setText } from "../base/dom.js";
import { parseNumber } from "../base/numbers.js";
import { rampGradient } from "../picture/false_colour.js";
import { LOOKS } from "../picture/mix.js";

const STOPS = [-10, 10];

function menu(label, items) {
    const list = h("div", { class: "menu-list" }, items.map(({ text, action }) =>
        h("button", { type: "button", onclick: () => {
            details.open = false;
            action();
        } }, text)));
    const details = h("details", { class: "menu" }, h("summary", {}, label), list);
    details.addEventListener("keydown", (event) => {
        if (event.key !== "Escape" || !details.open) return;
        details.open = false;
        details.firstChild.focus();
        event.stopPropagation();
    });
    addEventListener("pointerdown", (event) => {
        if (!details.contains(event.target)) details.open = false;
    });
    return details;
}

export class Toolbar {
    #scene;
    #settings;
    #parts;
    #lamps;
    #cameras;
    #frames;
    #moment;

    /**
     * `actions`: save, saveAs, reload, undo, redo, show, chooseExposure, keepSnapshot, dropSnapshot,
     * exportNumbers, exportPicture, exportShown, suggest, help.
     */
    constructor(place, scene, settings, actions) {
        this.#scene = scene;
        this.#settings = settings;
        const button = (text, title, action) =>
            h("button", { type: "button", title, onclick: action }, text);
        const looks = Object.fromEntries(Object.entries(LOOKS).map(([look, { label }]) =>
            [look, button(label, `See ${label.toLowerCase()}`, () => settings.update({ look }))]));
        this.#lamps = h("select", { "aria-label": "Whose light", title: "Whose light",
            onchange: () => settings.update({ onlyLamp: this.#lamps.value || null }) });
        const slider = h("input", { type: "range", min: STOPS[0], max: STOPS[1], step: 0.1,
            "aria-label": "Exposure, stops", oninput: () =>
                settings.update({ stops: Number(slider.value) }) });
        const stops = h("input", { type: "text", class: "number", inputmode: "decimal",
            "aria-label": "Exposure in stops", onchange: () => {
                const value = parseNumber(stops.value);
                if (value !== null) settings.update({ stops: value });
                this.#update();
            } });
        this.#cameras = h("select", { "aria-label": "Camera", title: "Which camera of the rig",
            hidden: true, onchange: () => actions.show({ camera: this.#cameras.value }) });
        this.#frames = h("input", { type: "range", step: 1, "aria-label": "Frame",
            oninput: () => actions.show({ frame: Number(this.#frames.value) }) });
        this.#moment = h("span", { class: "moment", hidden: true }, this.#frames,
            h("span", { class: "unit" }));
        this.#parts = {
            name: h("span", { class: "scene-name" }),
            save: button("Save", "Save the scene (Ctrl S)", actions.save),
            undo: button("Undo", "Undo (Ctrl Z)", actions.undo),
            redo: button("Redo", "Redo (Ctrl Shift Z)", actions.redo),
            looks, slider, stops,
            legend: h("span", { class: "legend", "aria-label": "False colours", hidden: true },
                h("span", {}, "0"), h("span", { class: "legend-bar",
                    style: { background: rampGradient("to right") } }), h("span", { class: "most" })),
            keep: button("Snapshot", "Keep this picture beside those to come (K)",
                actions.keepSnapshot),
            split: h("button", { type: "button", title: "Split view: snapshot and now (V)",
                onclick: () => settings.update({ split:
                    { ...settings.value.split, on: !settings.value.split.on } }) }, "Split"),
        };
        const group = (label, ...children) =>
            h("div", { class: "tool-group", role: "group", "aria-label": label }, ...children);
        place.append(
            group("Scene", this.#parts.name, this.#parts.save, menu("File", [
                { text: "Save as…", action: actions.saveAs },
                { text: "Load from disk", action: actions.reload },
                { text: "Export numbers (CSV)", action: actions.exportNumbers },
                { text: "Export picture, total (PNG)", action: actions.exportPicture },
                { text: "Export what is shown (PNG)", action: actions.exportShown },
            ])),
            group("History", this.#parts.undo, this.#parts.redo),
            group("What is seen", h("div", { class: "segments" }, ...Object.values(looks)),
                this.#lamps),
            group("View", this.#cameras, this.#moment),
            group("Exposure", h("span", { class: "unit" }, "EV"), slider, stops,
                button("Auto", "Choose the exposure anew (A)", actions.chooseExposure),
                this.#parts.legend),
            group("Snapshot", this.#parts.keep, this.#parts.split),
            group("Tools", h("button", { type: "button", class: "primary",
                title: "Search a place for the chosen lamp", onclick: actions.suggest }, "Suggest…"),
            button("?", "Keys (F1)", actions.help)));
        scene.observe(() => this.#update());
        settings.observe(() => this.#update());
    }

    /** The cameras of a rig, the frames of what moves; of other scenes nothing. */
    #showView({ cameras, camera, moment }) {
        this.#cameras.hidden = cameras.length < 2;
        this.#moment.hidden = moment === null;
        this.#cameras.parentElement.hidden = this.#cameras.hidden && this.#moment.hidden;
        if (this.#cameras.options.length !== cameras.length ||
            cameras.some((name, index) => this.#cameras.options[index].value !== name)) {
            this.#cameras.replaceChildren(...cameras.map((name) => h("option", { value: name }, name)));
        }
        this.#cameras.value = camera.name;
        if (moment === null) return;
        setAttributes(this.#frames, { min: moment.first, max: moment.last });
        if (!this.#frames.matches(":active")) this.#frames.value = moment.frame ?? moment.first;
        const text = moment.frame === null ? `${moment.time.toFixed(2)} s`
            : `${moment.frame} · ${moment.time.toFixed(2)} s`;
        setAttributes(this.#frames, { "aria-valuetext": `frame ${text}`, title: `Frame ${text}` });
        setText(this.#moment.lastChild, text);
    }

    #update() {
        const scene = this.#scene.value;
        if (!scene) return;
        const { look, onlyLamp, stops, split } = this.#settings.value;
        const { name, save, undo, redo, looks, slider, stops: typed, legend, split: splits } =
            this.#parts;
        setText(name, `${scene.scene}${scene.unsaved ? " •" : ""}`);
        setAttributes(name, { title: `${scene.folder}/${scene.scene}` +
            (scene.unsaved ? ": unsaved changes" : "") });
        document.title = `${scene.unsaved ? "• " : ""}${scene.scene} – uwvdb`;
        save.disabled = !scene.unsaved && !scene.deleted_on_disk;
        undo.disabled = !scene.can_undo;
        redo.disabled = !scene.can_redo;
        setAttributes(undo, { title: `Undo${scene.can_undo ? ` ${scene.undo_label}` : ""} (Ctrl Z)` });
        setAttributes(redo, {
            title: `Redo${scene.can_redo ? ` ${scene.redo_label}` : ""} (Ctrl Shift Z)` });
        for (const [each, element] of Object.entries(looks)) {
            const { label, layers, needs } = LOOKS[each];
            element.disabled = needs !== undefined && !scene.light.includes(layers[0]);
            setAttributes(element, { "aria-pressed": String(each === look),
                title: element.disabled ? `Not in this scene; ${needs}`
                    : `See ${label.toLowerCase()}` });
        }
        this.#showView(scene);
        this.#showLamps(scene.lamps, onlyLamp);
        if (!slider.matches(":active")) slider.value = stops ?? 0;
        if (document.activeElement !== typed) typed.value = (stops ?? 0).toFixed(1);
        legend.hidden = !LOOKS[look].falseColour;
        setText(legend.querySelector(".most"), `${(2 ** -(stops ?? 0)).toPrecision(2)} W/m²`);
        setAttributes(splits, { "aria-pressed": String(split.on) });
    }

    #showLamps(lamps, onlyLamp) {
        const wanted = JSON.stringify(lamps.map(({ name }) => name));
        if (this.#lamps.dataset.shown !== wanted) {
            this.#lamps.dataset.shown = wanted;
            this.#lamps.replaceChildren(h("option", { value: "" }, "all lamps"),
                ...lamps.map(({ name }) => h("option", { value: name }, name)));
        }
        const known = lamps.some((lamp) => lamp.name === onlyLamp);
        this.#lamps.value = known ? onlyLamp : "";
    }

    /** Whether there is a snapshot to be seen beside the picture. */
    showSnapshot(kept) {
        this.#parts.split.disabled = !kept;
    }
}
