// An exposure that suits the picture at hand. It is chosen when asked for, and stays put otherwise.

import { valueReader } from "./image_planes.js";

const MOST_SAMPLES = 20000;
const BRIGHT_FRACTION = 0.99;

/** In stops: the factor 2^stops brings the brightest hundredth of the mixed picture near white. */
export function automaticStops(image, mix) {
    const pixels = image.width * image.height;
    const read = valueReader(image);
    const step = Math.max(1, Math.floor(pixels / MOST_SAMPLES));
    const values = [];
    for (let pixel = 0; pixel < pixels; pixel += step) {
        const sum = [0, 0, 0];
        for (const { plane, weight } of mix) {
            const first = (plane * pixels + pixel) * 3;
            for (let channel = 0; channel < 3; ++channel) {
                sum[channel] += weight[channel] * read(first + channel);
            }
        }
        values.push(Math.max(...sum));
    }
    values.sort((a, b) => a - b);
    const bright = values[Math.floor(BRIGHT_FRACTION * (values.length - 1))];
    if (!(bright > 0)) return 0;
    return Math.round(Math.log2(1 / bright) * 10) / 10;
}
