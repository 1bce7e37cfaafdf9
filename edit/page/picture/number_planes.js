// The planes of an image in memory, and the picture that they are mixed into.

import { lookUp } from "./display_view.js";
import { RAMP } from "./false_colour.js";
import { toNumbers } from "./image_planes.js";

const STEPS = 8192; // of a table over the light that is shown, 0 to 1

/** `colourOf` of equal steps from 0 to 1, each as bytes red, green, blue. */
function tableOf(colourOf) {
    const table = new Uint8ClampedArray((STEPS + 1) * 3);
    for (let step = 0; step <= STEPS; ++step) {
        table.set(colourOf(step / STEPS).map((value) => 255 * value), step * 3);
    }
    return table;
}

const SRGB = tableOf((light) => {
    const value = light <= 0.0031308 ? 12.92 * light : 1.055 * light ** (1 / 2.4) - 0.055;
    return [value, value, value];
});

const FALSE_COLOURS = tableOf((value) => {
    const scaled = value * (RAMP.length - 1);
    const below = Math.min(Math.floor(scaled), RAMP.length - 2);
    return RAMP[below].map(
        (low, channel) => low + (scaled - below) * (RAMP[below + 1][channel] - low));
});

export class NumberPlanes {
    #planes = [];
    #light; // their sum
    #picture; // and its colours
    #painted = document.createElement("canvas"); // of the image's size
    #paintedAs = null; // what it shows

    /** Takes an image's planes over. */
    upload({ width, height, planes, data }) {
        this.#painted.width = width;
        this.#painted.height = height;
        const size = width * height * 3;
        this.#planes = planes.map((_, plane) =>
            toNumbers(data.subarray(plane * size, (plane + 1) * size)));
        if (this.#light?.length !== size) this.#light = new Float32Array(size);
        this.#picture = new ImageData(width, height);
        this.#paintedAs = null;
    }

    free() {
        this.#planes = [];
    }

    /** A canvas with the picture, seen through `view` unless that is null; it stays this object's. */
    paint(mix, exposure, falseColour, view) {
        const as = JSON.stringify([mix, exposure, falseColour, view?.key]);
        if (as !== this.#paintedAs) {
            this.#sum(mix);
            if (view && !falseColour) this.#see(exposure, view);
            else this.#colour(exposure, falseColour);
            this.#painted.getContext("2d", { alpha: false }).putImageData(this.#picture, 0, 0);
            this.#paintedAs = as;
        }
        return this.#painted;
    }

    #sum(mix) {
        const light = this.#light.fill(0);
        for (const { plane, weight: [red, green, blue] } of mix) {
            const from = this.#planes[plane];
            for (let i = 0; i < light.length; i += 3) {
                light[i] += red * from[i];
                light[i + 1] += green * from[i + 1];
                light[i + 2] += blue * from[i + 2];
            }
        }
    }

    #see(exposure, view) {
        const light = this.#light;
        const bytes = this.#picture.data.fill(255);
        const seen = [0, 0, 0];
        for (let i = 0, at = 0; i < light.length; i += 3, at += 4) {
            for (let channel = 0; channel < 3; ++channel) seen[channel] = exposure * light[i + channel];
            lookUp(view, seen, bytes, at);
        }
    }

    #colour(exposure, falseColour) {
        const light = this.#light;
        const bytes = this.#picture.data;
        const scale = exposure * STEPS;
        // Negative light and what is no number are black.
        const place = (value) =>
            3 * (value > 0 ? Math.floor(Math.min(value * scale, STEPS) + 0.5) : 0);
        for (let i = 0, at = 0; i < light.length; i += 3, at += 4) {
            if (falseColour) {
                const step = place((light[i] + light[i + 1] + light[i + 2]) / 3);
                bytes[at] = FALSE_COLOURS[step];
                bytes[at + 1] = FALSE_COLOURS[step + 1];
                bytes[at + 2] = FALSE_COLOURS[step + 2];
            } else {
                bytes[at] = SRGB[place(light[i])];
                bytes[at + 1] = SRGB[place(light[i + 1])];
                bytes[at + 2] = SRGB[place(light[i + 2])];
            }
            bytes[at + 3] = 255;
        }
    }
}
