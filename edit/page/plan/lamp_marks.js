// The lamps in a plan view: a disc with its beam, and a diamond on the axis that turns it.

import { setAttributes, sizeFactor, svg } from "../base/dom.js";
import { arrowStep, onDrag } from "../base/dragging.js";
import { hasPlace } from "../base/lamps.js";
import { along, normalize } from "../base/vec.js";
import { lampColour } from "../panels/lamp_colours.js";
import { beamOutline } from "./beam.js";
import { snapped } from "./snap.js";
import { TITLE_PIXELS } from "./viewport.js";

const BEAM_METRES = 1.5;
const AXIS_PIXELS = 46; // from the lamp to its axis's handle, unless the axis is foreshortened
const LABEL_PIXELS = 90; // that a name may need
const KEY_METRES = 0.01; // per press of an arrow key, times ten with Shift

const lampOf = (scene, name) => scene.lamps.find((lamp) => lamp.name === name);

export class LampMarks {
    #layer;
    #viewport;
    #view;
    #settings;
    #actions;
    #marks = new Map();
    #scene = null;

    constructor(layer, view, viewport, settings, actions) {
        this.#layer = layer;
        this.#view = view;
        this.#viewport = viewport;
        this.#settings = settings;
        this.#actions = actions;
    }

    update(scene) {
        this.#scene = scene;
        const seen = new Set();
        scene.lamps.forEach((lamp, index) => {
            seen.add(lamp.name);
            if (!this.#marks.has(lamp.name)) this.#marks.set(lamp.name, this.#make(lamp.name));
            this.#place(this.#marks.get(lamp.name), lamp, index);
        });
        for (const [name, mark] of this.#marks) {
            if (seen.has(name)) continue;
            mark.group.remove();
            this.#marks.delete(name);
        }
    }

    #make(name) {
        const beam = svg("path", { class: "beam" });
        const line = svg("line", { class: "axis-line" });
        const disc = svg("g", { class: "handle lamp-handle", tabindex: 0, role: "button" },
            svg("circle", { r: 12, class: "reach" }), svg("circle", { r: 6, class: "disc" }));
        const axis = svg("g", { class: "handle axis-handle", tabindex: 0, role: "button" },
            svg("circle", { r: 10, class: "reach" }), svg("path", { d: "M0,-5 L5,0 L0,5 L-5,0 Z" }));
        const label = svg("text", { class: "handle-label", "aria-hidden": "true" });
        const group = svg("g", {}, beam, line, axis, disc, label);
        this.#layer.append(group);
        for (const [element, kind] of [[disc, "lamp"], [axis, "axis"]]) {
            element.addEventListener("focus", () => this.#actions.select(lampOf(this.#scene, name)));
            element.addEventListener("keydown", (event) => this.#key(event, name, kind));
            onDrag(element, () => this.#grab(element, name, kind));
        }
        return { group, beam, line, disc, axis, label };
    }

    /** The end of the axis's handle, in the world. */
    #axisEnd(lamp) {
        return along(lamp.world_position, normalize(lamp.world_direction),
            (AXIS_PIXELS * sizeFactor()) / this.#viewport.zoom);
    }

    #place(mark, lamp, index) {
        const viewport = this.#viewport;
        const size = sizeFactor();
        const selected = lamp.name === this.#settings.value.selected;
        const at = viewport.toScreen(lamp.world_position);
        const end = viewport.toScreen(this.#axisEnd(lamp));
        const outline = beamOutline(lamp, viewport, BEAM_METRES)
            .map((point) => viewport.planToScreen(point));
        const turns = lamp.profile.type !== "isotropic";
        mark.group.style.setProperty("--lamp", lampColour(index));
        setAttributes(mark.group, {
            display: hasPlace(lamp) ? null : "none",
            class: `lamp${selected ? " selected" : ""}${lamp.on ? "" : " off"}` +
                `${lamp.editable ? "" : " locked"}`,
        });
        setAttributes(mark.beam, {
            d: outline.length < 3 ? "" : `M${outline.map(([x, y]) =>
                `${x.toFixed(1)},${y.toFixed(1)}`).join("L")}Z`,
        });
        setAttributes(mark.disc, {
            transform: `translate(${at[0]} ${at[1]}) scale(${size})`,
            "aria-label": `Lamp ${lamp.name} from the ${this.#view}: arrow keys move it`,
        });
        setAttributes(mark.axis, {
            transform: `translate(${end[0]} ${end[1]}) scale(${size})`, visibility: turns ? "visible" : "hidden",
            "aria-label": `Axis of lamp ${lamp.name} from the ${this.#view}: arrow keys turn it`,
        });
        setAttributes(mark.line, {
            x1: at[0], y1: at[1], x2: end[0], y2: end[1],
            visibility: turns ? "visible" : "hidden",
        });
        // Its name is beside it: not under the view's title, nor across its edge.
        const isLow = at[1] < (TITLE_PIXELS + 20) * size;
        const isLeft = at[0] > viewport.size[0] - LABEL_PIXELS * size;
        setAttributes(mark.label, {
            x: at[0] + (isLeft ? -10 : 10) * size, y: at[1] + (isLow ? 16 : -8) * size,
            "text-anchor": isLeft ? "end" : "start",
        });
        mark.label.textContent = selected ? lamp.name : "";
    }

    #change(lamp, kind, delta) {
        const viewport = this.#viewport;
        if (kind === "axis") {
            return { op: "aim_lamp", lamp: lamp.name,
                world: viewport.moved(this.#axisEnd(lamp), delta) };
        }
        return { op: "move_lamp", lamp: lamp.name,
            world: snapped(viewport.moved(lamp.world_position, delta), viewport.axes,
                this.#settings.value) };
    }

    #labelOf(name, kind) {
        return kind === "axis" ? `turn ${name}` : `move ${name}`;
    }

    #grab(element, name, kind) {
        element.focus();
        const lamp = lampOf(this.#scene, name);
        if (!lamp.editable) return null;
        const group = this.#actions.newGroup(kind);
        return (delta) => this.#actions.edit(this.#labelOf(name, kind),
            [this.#change(lamp, kind, delta)], { group });
    }

    #key(event, name, kind) {
        const arrow = arrowStep(event);
        const { editable } = lampOf(this.#scene, name);
        if (!arrow || !editable || event.ctrlKey || event.altKey) return;
        event.preventDefault();
        const { snap, grid } = this.#settings.value;
        const metres = snap === "grid" ? grid : KEY_METRES * (event.shiftKey ? 10 : 1);
        const step = metres * this.#viewport.zoom;
        this.#actions.edit(this.#labelOf(name, kind), (scene) =>
            [this.#change(lampOf(scene, name), kind, [arrow[0] * step, arrow[1] * step])],
        { group: `keys-${kind}-${name}` });
    }
}
