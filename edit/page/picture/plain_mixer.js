// Mixes planes into the picture on a canvas where there is no graphics card: WebGL, computed, takes
// longer than the same sums in JavaScript, done for the pixels of the image, not of the window.

import { NumberPlanes } from "./number_planes.js";

export class PlainMixer {
    #context;
    #view = null;
    #whole = document.createElement("canvas"); // of the window's size, where columns are drawn

    constructor(canvas) {
        this.#context = canvas.getContext("2d", { alpha: false });
    }

    /** What the picture is seen through (ViewFeed). */
    setView(view) {
        this.#view = view;
    }

    newPlanes() {
        return new NumberPlanes();
    }

    clear() {
        const { width, height } = this.#context.canvas;
        this.#context.fillStyle = "black";
        this.#context.fillRect(0, 0, width, height);
    }

    /** Draws the columns from `from` to `to` (fractions of the width). */
    draw(planes, mix, { exposure, falseColour = false, from = 0, to = 1 }) {
        const { width, height } = this.#context.canvas;
        const first = Math.round(from * width);
        const columns = Math.round(to * width) - first;
        if (columns <= 0) return;
        // Enlarged as a whole: the columns are those of the whole picture to the byte.
        const whole = columns === width ? this.#context : this.#aside(width, height);
        whole.drawImage(planes.paint(mix, exposure, falseColour, this.#view), 0, 0, width,
            height);
        if (whole !== this.#context) {
            this.#context.drawImage(whole.canvas, first, 0, columns, height, first, 0, columns,
                height);
        }
    }

    #aside(width, height) {
        if (this.#whole.width !== width) this.#whole.width = width;
        if (this.#whole.height !== height) this.#whole.height = height;
        return this.#whole.getContext("2d", { alpha: false });
    }
}
