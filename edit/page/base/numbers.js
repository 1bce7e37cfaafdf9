// Numbers as text, and text as numbers.

/** With as many digits as matter, without exponents where they can be avoided. */
export function formatNumber(value, digits = 4) {
    if (value === null || value === undefined || Number.isNaN(value)) return "–";
    if (!Number.isFinite(value)) return value > 0 ? "∞" : "−∞";
    if (value === 0) return "0";
    const size = Math.abs(value);
    if (size >= 1e7 || size < 1e-5) return value.toExponential(digits - 1);
    return String(Number(value.toPrecision(digits)));
}

/** As it may be typed back: all that a scene file's number needs. */
export const editableNumber = (value) =>
    value === null || value === undefined ? "" : String(Number(value.toPrecision(7)));

/** Numbers that no scene file needs more digits of than four. */
export const rounded = (value) => (Array.isArray(value) ? value.map(rounded)
    : Number(value.toPrecision(4)));

/** As coordinates are shown until they are typed in: to the millimetre, or three digits. */
export function shortNumber(value) {
    if (value === null || value === undefined) return "";
    return String(Math.abs(value) < 0.01 ? Number(value.toPrecision(3)) : Number(value.toFixed(3)));
}

/** A typed number, with a point or a comma; null if it is none. */
export function parseNumber(text) {
    const trimmed = text.trim().replace(",", ".").replace("−", "-");
    if (!/^[-+]?(\d+\.?\d*|\.\d+)(e[-+]?\d+)?$/i.test(trimmed)) return null;
    return Number(trimmed);
}

/** Rounded to a multiple of `step`, without the dust of binary fractions. */
export const roundTo = (value, step) => Number((Math.round(value / step) * step).toFixed(9));

/** Round values from `low` to `high`, about `count` of them. */
export function ticks(low, high, count) {
    const span = high - low;
    if (!(span > 0)) return [];
    const rough = span / count;
    const power = 10 ** Math.floor(Math.log10(rough));
    const step = [1, 2, 5, 10].map((factor) => factor * power).find((each) => each >= rough);
    const found = [];
    for (let i = Math.ceil(low / step - 1e-9); i * step <= high + step * 1e-9; ++i) {
        found.push(Number((i * step).toPrecision(12)));
    }
    return found;
}
