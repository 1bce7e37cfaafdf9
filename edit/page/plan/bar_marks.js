// The bar that lamps may be bolted to: a line between two points, whose ends are dragged.

import { setAttributes, sizeFactor, svg } from "../base/dom.js";
import { arrowStep, onDrag } from "../base/dragging.js";
import { add, scale } from "../base/vec.js";

const KEY_METRES = 0.01;
const HALF_LENGTH = 1.5; // metres of the bar to begin with, across the camera

/** A bar across the camera, above it by nothing, for want of the user's own. */
export const barAcross = (camera) => ({
    from: add(camera.position, scale(camera.right, -HALF_LENGTH)),
    to: add(camera.position, scale(camera.right, HALF_LENGTH)),
});

export class BarMarks {
    #viewport;
    #settings;
    #group;
    #line;
    #ends;

    constructor(layer, viewport, settings) {
        this.#viewport = viewport;
        this.#settings = settings;
        this.#line = svg("line", { class: "bar" });
        this.#ends = ["from", "to"].map((key) => {
            const end = svg("g", { class: "handle bar-end", tabindex: 0, role: "button",
                "aria-label": `End of the bar: arrow keys move it` },
            svg("circle", { r: 9, class: "reach" }), svg("rect", { x: -4, y: -4, width: 8, height: 8 }));
            onDrag(end, () => {
                end.focus();
                const start = settings.value.bar[key];
                return (delta) => this.#move(key, viewport.moved(start, delta));
            });
            end.addEventListener("keydown", (event) => {
                const arrow = arrowStep(event);
                if (!arrow) return;
                event.preventDefault();
                const step = KEY_METRES * (event.shiftKey ? 10 : 1) * viewport.zoom;
                this.#move(key, viewport.moved(settings.value.bar[key],
                    [arrow[0] * step, arrow[1] * step]));
            });
            return { key, end };
        });
        this.#group = svg("g", {}, this.#line, ...this.#ends.map(({ end }) => end));
        layer.append(this.#group);
    }

    #move(key, point) {
        this.#settings.update({ bar: { ...this.#settings.value.bar, [key]: point } });
    }

    update() {
        const { bar, snap } = this.#settings.value;
        this.#group.style.display = bar && snap === "bar" ? "" : "none";
        if (!bar) return;
        const points = this.#ends.map(({ key }) => this.#viewport.toScreen(bar[key]));
        setAttributes(this.#line, {
            x1: points[0][0], y1: points[0][1], x2: points[1][0], y2: points[1][1],
        });
        this.#ends.forEach(({ end }, index) =>
            setAttributes(end, { transform: `translate(${points[index][0]} ${points[index][1]}) ` +
                `scale(${sizeFactor()})` }));
    }
}
