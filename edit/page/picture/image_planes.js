// The server's image: planes of floats, one per lamp and layer, behind a header of JSON.

const ALIGNMENT = 16;

/**
 * {key, revision, width, height, scale, quality, lamps, lamp_brightness, planes, data}; `data` holds
 * the planes of three channels, one behind the other, as half floats (Uint16Array) or floats.
 * Planes of one channel (depth) are the last, and left out.
 */
export function readImage(bytes) {
    const view = new DataView(bytes);
    const length = view.getUint32(0, true);
    const header = JSON.parse(new TextDecoder().decode(new Uint8Array(bytes, 4, length)));
    const start = Math.ceil((4 + length) / ALIGNMENT) * ALIGNMENT;
    const Numbers = header.type === "f16" ? Uint16Array : Float32Array;
    const planes = header.planes.filter((plane) => plane.channels === 3);
    const values = header.width * header.height * 3 * planes.length;
    return { ...header, planes, data: new Numbers(bytes, start, values) };
}

/** A half float as a number. */
export function halfToNumber(half) {
    const sign = half & 0x8000 ? -1 : 1;
    const exponent = (half >> 10) & 0x1f;
    const fraction = half & 0x3ff;
    if (exponent === 0) return sign * fraction * 2 ** -24;
    if (exponent === 31) return fraction ? NaN : sign * Infinity;
    return sign * (1 + fraction / 1024) * 2 ** (exponent - 15);
}

/** Reads one value of an image, whatever its type. */
export const valueReader = (image) =>
    image.data instanceof Uint16Array
        ? (index) => halfToNumber(image.data[index])
        : (index) => image.data[index];

let numbersOfHalves = null;

/** Half floats (Uint16Array) or floats as floats. */
export function toNumbers(values) {
    if (!(values instanceof Uint16Array)) return values;
    numbersOfHalves ??= Float32Array.from({ length: 65536 }, (_, half) => halfToNumber(half));
    const numbers = new Float32Array(values.length);
    for (let i = 0; i < values.length; ++i) numbers[i] = numbersOfHalves[values[i]];
    return numbers;
}
