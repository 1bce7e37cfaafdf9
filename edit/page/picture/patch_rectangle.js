// The part of the picture in which contrast is measured: shown, and chosen by a drag over it.

import { setAttributes, svg } from "../base/dom.js";

const LEAST_PIXELS = 4;

export class PatchRectangle {
    #rectangle;
    #scene = null;
    #scale = 1;
    #settings;
    #measured = null; // what the numbers at hand were measured in
    #chosen = null; // while it is being dragged: [x0, y0, x1, y1]

    constructor(overlay, box, settings) {
        this.#settings = settings;
        this.#rectangle = svg("rect", { class: "patch" });
        overlay.append(this.#rectangle);
        settings.observe(({ choosingPatch }) => box.classList.toggle("choosing", choosingPatch));
        overlay.addEventListener("pointerdown", (event) => {
            if (!settings.value.choosingPatch || event.button !== 0) return;
            event.preventDefault();
            overlay.setPointerCapture(event.pointerId);
            const start = this.#pixelAt(overlay, event);
            const move = (moved) => {
                this.#chosen = [...start, ...this.#pixelAt(overlay, moved)];
                this.#draw();
            };
            const end = () => {
                overlay.removeEventListener("pointermove", move);
                const [x0, y0, x1, y1] = this.#chosen ?? [0, 0, 0, 0];
                const sorted = [Math.min(x0, x1), Math.min(y0, y1), Math.max(x0, x1),
                    Math.max(y0, y1)].map(Math.round);
                this.#chosen = null;
                const large = sorted[2] - sorted[0] >= LEAST_PIXELS &&
                    sorted[3] - sorted[1] >= LEAST_PIXELS;
                settings.update({ choosingPatch: false, ...(large ? { patch: sorted } : {}) });
            };
            overlay.addEventListener("pointermove", move);
            overlay.addEventListener("lostpointercapture", end, { once: true });
        });
    }

    showMeasured(pixels) {
        this.#measured = pixels;
        this.#draw();
    }

    update(scene, scale) {
        this.#scene = scene;
        this.#scale = scale;
        this.#draw();
    }

    #pixelAt(overlay, event) {
        const room = overlay.getBoundingClientRect();
        const { width, height } = this.#scene.image;
        const inside = (value, size) => Math.min(Math.max(value, 0), size);
        return [inside((event.clientX - room.left) / this.#scale, width),
            inside((event.clientY - room.top) / this.#scale, height)];
    }

    #draw() {
        const pixels = this.#chosen ?? this.#settings.value.patch ?? this.#measured;
        this.#rectangle.style.display = pixels ? "" : "none";
        if (!pixels) return;
        const [x0, y0, x1, y1] = pixels.map((value) => value * this.#scale);
        setAttributes(this.#rectangle, {
            x: Math.min(x0, x1), y: Math.min(y0, y1),
            width: Math.abs(x1 - x0), height: Math.abs(y1 - y0),
        });
    }
}
