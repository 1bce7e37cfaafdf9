// The lamps' handles over the picture: a disc where the lamp is seen, or an arrow at the image's rim
// in its direction; a diamond on its axis; the outline of its beam.

import { setAttributes, setText, sizeFactor, svg } from "../base/dom.js";
import { arrowStep, onDrag } from "../base/dragging.js";
import { hasPlace } from "../base/lamps.js";
import { lampColour } from "../panels/lamp_colours.js";
import { aimAt, moveInDepth, moveInPlane } from "./lamp_motion.js";

const RIM_INSET = 14; // CSS pixels from the image's edge to a handle at its rim
const KEY_STEP = 4; // CSS pixels per press of an arrow key, times ten with Shift

const DEPTH_KEYS = { PageUp: -1, PageDown: 1 };

const lampOf = (scene, name) => scene.lamps.find((lamp) => lamp.name === name);

export class LampHandles {
    #layer;
    #actions;
    #handles = new Map();
    #scene = null;
    #scale = 1;
    #dragged = null; // {lamp, kind, at}: follows the pointer until the server's answer is here

    /**
     * `actions`: select(lamp), edit(label, changes, options) as of Editing, newGroup(kind), settled()
     * (a promise: the server has answered all edits) and redraw().
     */
    constructor(layer, actions) {
        this.#layer = layer;
        this.#actions = actions;
    }

    /** `scale`: CSS pixels per pixel of the image. */
    update(scene, selected, scale) {
        this.#scene = scene;
        this.#scale = scale;
        const seen = new Set();
        scene.lamps.forEach((lamp, index) => {
            seen.add(lamp.name);
            if (!this.#handles.has(lamp.name)) this.#handles.set(lamp.name, this.#make(lamp.name));
            this.#place(this.#handles.get(lamp.name), lamp, index, lamp.name === selected,
                scene.image);
        });
        for (const [name, handle] of this.#handles) {
            if (seen.has(name)) continue;
            handle.group.remove();
            this.#handles.delete(name);
        }
    }

    #make(name) {
        const cone = svg("path", { class: "cone" });
        const line = svg("line", { class: "axis-line" });
        const disc = svg("g", { class: "handle lamp-handle", tabindex: 0, role: "button" },
            svg("circle", { r: 14, class: "reach" }), svg("circle", { r: 7, class: "disc" }),
            svg("circle", { r: 2, class: "dot" }), svg("path", { d: "M0,-8 L9,0 L0,8 Z", class: "arrow" }));
        const axis = svg("g", { class: "handle axis-handle", tabindex: 0, role: "button" },
            svg("circle", { r: 12, class: "reach" }), svg("path", { d: "M0,-6 L6,0 L0,6 L-6,0 Z" }));
        const label = svg("text", { class: "handle-label", "aria-hidden": "true" });
        const group = svg("g", { class: "lamp" }, cone, line, axis, disc, label);
        this.#layer.append(group);
        this.#listen(disc, name, "lamp");
        this.#listen(axis, name, "axis");
        return { group, cone, line, disc, axis, label };
    }

    /** Where a handle is shown [CSS pixels]; at the rim if its point is outside the picture. */
    #at(lamp, kind, { width, height }) {
        const { pixel, inside, rim } = kind === "axis" ? lamp.axis_handle : lamp.handle;
        const inset = (RIM_INSET * sizeFactor()) / this.#scale;
        const clamp = (value, size) => Math.min(Math.max(value, inset), size - inset);
        const [u, v] = pixel && inside ? pixel : [clamp(rim[0], width), clamp(rim[1], height)];
        return [u * this.#scale, v * this.#scale];
    }

    #place(handle, lamp, index, selected, image) {
        const scale = this.#scale;
        const size = sizeFactor();
        const [width, height] = [image.width * scale, image.height * scale];
        const inside = lamp.handle.pixel && lamp.handle.inside;
        const shown = (kind) => (this.#dragged?.name === lamp.name && this.#dragged.kind === kind
            ? this.#dragged.at : this.#at(lamp, kind, image));
        const at = shown("lamp");
        const axisAt = shown("axis");
        const angle = inside ? 0
            : (Math.atan2(at[1] - height / 2, at[0] - width / 2) * 180) / Math.PI;
        const turns = lamp.profile.type === "isotropic" ? "hidden" : "visible";
        handle.group.style.setProperty("--lamp", lampColour(index));
        setAttributes(handle.group, {
            display: hasPlace(lamp) ? null : "none",
            class: `lamp${selected ? " selected" : ""}${lamp.on ? "" : " off"}` +
                `${lamp.editable ? "" : " locked"}${inside ? "" : " at-rim"}`,
        });
        setAttributes(handle.disc, {
            transform: `translate(${at[0]} ${at[1]}) scale(${size})`,
            "aria-label": `Lamp ${lamp.name}${inside ? "" : ", outside the picture"}: ` +
                "arrow keys move it in the image plane, Page Up and Page Down in depth",
        });
        setAttributes(handle.disc.lastChild, { transform: `rotate(${angle})` });
        setAttributes(handle.axis, {
            transform: `translate(${axisAt[0]} ${axisAt[1]}) scale(${size})`, visibility: turns,
            "aria-label": `Axis of lamp ${lamp.name}: arrow keys turn it`,
        });
        setAttributes(handle.line,
            { x1: at[0], y1: at[1], x2: axisAt[0], y2: axisAt[1], visibility: turns });
        setAttributes(handle.cone, {
            d: lamp.cone.length < 2 ? "" : `M${lamp.cone.map(([u, v]) =>
                `${(u * scale).toFixed(1)},${(v * scale).toFixed(1)}`).join("L")}Z`,
        });
        const right = at[0] > width - 80 * size;
        setAttributes(handle.label, {
            x: at[0] + (right ? -13 : 13) * size,
            y: at[1] + (at[1] < 24 * size ? 22 : -9) * size,
            "text-anchor": right ? "end" : "start",
        });
        setText(handle.label, lamp.name);
    }

    #listen(element, name, kind) {
        element.addEventListener("focus", () => this.#actions.select(lampOf(this.#scene, name)));
        element.addEventListener("keydown", (event) => this.#key(event, name, kind));
        onDrag(element, () => this.#grab(element, name, kind), () => this.#release());
    }

    /** The change that moving a handle from (x, y) by (dx, dy) CSS pixels makes. */
    #change(scene, lamp, kind, [x, y], [dx, dy], inDepth) {
        const scale = this.#scale;
        if (kind === "axis") return aimAt(scene, lamp, [(x + dx) / scale, (y + dy) / scale]);
        return inDepth ? moveInDepth(scene, lamp, dy)
            : moveInPlane(scene, lamp, dx / scale, dy / scale);
    }

    #labelOf(name, kind) {
        return kind === "axis" ? `turn ${name}` : `move ${name}`;
    }

    /** The movement of a drag that begins on a handle; null if the lamp cannot be moved. */
    #grab(element, name, kind) {
        element.focus();
        const scene = this.#scene;
        const lamp = lampOf(scene, name);
        if (!lamp.editable) return null;
        const from = this.#at(lamp, kind, scene.image);
        const group = this.#actions.newGroup(kind);
        return (delta, event) => {
            const inDepth = event.shiftKey && kind === "lamp";
            const at = inDepth ? from : [from[0] + delta[0], from[1] + delta[1]];
            this.#dragged = { name, kind, at };
            this.#actions.edit(this.#labelOf(name, kind),
                [this.#change(scene, lamp, kind, from, delta, inDepth)], { group });
            this.#actions.redraw();
        };
    }

    async #release() {
        await this.#actions.settled();
        this.#dragged = null;
        this.#actions.redraw();
    }

    #key(event, name, kind) {
        const step = KEY_STEP * (event.shiftKey ? 10 : 1);
        const arrow = arrowStep(event);
        const depth = kind === "lamp" ? DEPTH_KEYS[event.key] : undefined;
        const { editable } = lampOf(this.#scene, name);
        if (!(arrow || depth) || !editable || event.ctrlKey || event.altKey) return;
        event.preventDefault();
        const delta = arrow ? [arrow[0] * step, arrow[1] * step] : [0, depth * step];
        this.#actions.edit(this.#labelOf(name, kind), (scene) => {
            const lamp = lampOf(scene, name);
            return [this.#change(scene, lamp, kind, this.#at(lamp, kind, scene.image), delta, !arrow)];
        }, { group: `keys-${kind}-${name}` });
    }
}
