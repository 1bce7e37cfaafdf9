// One plan view: pan with a drag, zoom with the wheel, lamps and the bar on top.

import { h, svg } from "../base/dom.js";
import { arrowStep, onDrag } from "../base/dragging.js";
import { oncePerFrame } from "../base/frame.js";
import { hasPlace } from "../base/lamps.js";
import { Backdrop, boxCorners, frustumEnds } from "./backdrop.js";
import { BarMarks } from "./bar_marks.js";
import { LampMarks } from "./lamp_marks.js";
import { Viewport } from "./viewport.js";
import { VIEW_LABELS, viewAxes } from "./views.js";

const WHEEL_ZOOM = 0.0015;
const KEY_ZOOM = 1.25;
const KEY_PAN = 20; // pixels

export class PlanView {
    #place;
    #view;
    #scene;
    #outlines;
    #viewport = null;
    #backdrop;
    #overlay;
    #lamps;
    #bar;
    #settings;
    #actions;
    #drawSoon;

    /** `view`: top, side or front; `outlines`: an observable list of segments. */
    constructor(place, view, scene, outlines, settings, actions) {
        this.#place = place;
        this.#view = view;
        this.#scene = scene;
        this.#outlines = outlines;
        this.#settings = settings;
        this.#actions = actions;
        const canvas = h("canvas", { "aria-hidden": "true" });
        this.#overlay = svg("svg", {
            class: "overlay", tabindex: 0, role: "group",
            "aria-label": `${VIEW_LABELS[view]} view: arrow keys pan, plus and minus zoom, ` +
                "Home shows everything",
        });
        const tool = (label, title, action) =>
            h("button", { type: "button", class: "flat", title, "aria-label": title,
                onclick: action }, label);
        place.append(canvas, this.#overlay, h("div", { class: "plan-title" },
            h("span", {}, VIEW_LABELS[view]),
            tool("−", `Zoom the ${view} view out`, () => this.#zoom(1 / KEY_ZOOM)),
            tool("+", `Zoom the ${view} view in`, () => this.#zoom(KEY_ZOOM)),
            tool("⤢", `Show everything in the ${view} view`, () => this.fit())));
        this.#backdrop = new Backdrop(canvas);
        this.#drawSoon = oncePerFrame(() => this.#draw());
        this.#listen();
        new ResizeObserver(this.#drawSoon).observe(place);
        for (const source of [scene, outlines, settings]) source.observe(this.#drawSoon);
        matchMedia("(prefers-color-scheme: dark)").addEventListener("change", this.#drawSoon);
    }

    #listen() {
        onDrag(this.#overlay, () => {
            let last = [0, 0];
            return (delta) => {
                this.#viewport.pan([delta[0] - last[0], delta[1] - last[1]]);
                last = delta;
                this.#drawSoon();
            };
        });
        this.#overlay.addEventListener("wheel", (event) => {
            event.preventDefault();
            const room = this.#overlay.getBoundingClientRect();
            this.#viewport.zoomAt([event.clientX - room.left, event.clientY - room.top],
                Math.exp(-event.deltaY * WHEEL_ZOOM));
            this.#drawSoon();
        }, { passive: false });
        this.#overlay.addEventListener("keydown", (event) => {
            if (event.target !== this.#overlay || event.ctrlKey) return;
            const arrow = arrowStep(event);
            if (arrow) this.#viewport.pan([-arrow[0] * KEY_PAN, -arrow[1] * KEY_PAN]);
            else if (event.key === "+" || event.key === "=") this.#zoom(KEY_ZOOM);
            else if (event.key === "-") this.#zoom(1 / KEY_ZOOM);
            else if (event.key === "Home") this.fit();
            else return;
            event.preventDefault();
            this.#drawSoon();
        });
    }

    #zoom(factor) {
        this.#viewport.zoomAt(this.#viewport.size.map((size) => size / 2), factor);
        this.#drawSoon();
    }

    /** Shows camera, lamps, volumes and what the camera sees. */
    fit() {
        const { camera, lamps, volumes } = this.#scene.value;
        this.#viewport.fit([
            camera.position, ...frustumEnds(camera),
            ...lamps.filter(hasPlace)
                .flatMap(({ world_position: at, axis_handle: axis }) => [at, axis.point]),
            ...volumes.flatMap(({ bounds }) => (bounds ? boxCorners(bounds) : [])),
        ]);
        this.#drawSoon();
    }

    #begin(camera) {
        const axes = viewAxes(camera)[this.#view];
        this.#viewport = new Viewport(axes);
        this.#bar = new BarMarks(this.#overlay, this.#viewport, this.#settings);
        this.#lamps = new LampMarks(this.#overlay, this.#view, this.#viewport, this.#settings,
            this.#actions);
    }

    #draw() {
        const scene = this.#scene.value;
        if (!scene) return;
        const { width, height } = this.#place.getBoundingClientRect();
        if (width < 1 || height < 1) return;
        const first = this.#viewport === null;
        if (first) this.#begin(scene.camera);
        this.#viewport.size = [width, height];
        if (first) this.fit();
        this.#overlay.setAttribute("viewBox", `0 0 ${width} ${height}`);
        this.#backdrop.draw(this.#viewport, scene, this.#outlines.value);
        this.#bar.update();
        this.#lamps.update(scene);
    }
}
