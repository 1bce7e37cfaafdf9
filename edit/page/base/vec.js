// Points and vectors of three numbers, as arrays.

export const add = (a, b) => [a[0] + b[0], a[1] + b[1], a[2] + b[2]];
export const subtract = (a, b) => [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
export const scale = (a, s) => [a[0] * s, a[1] * s, a[2] * s];
export const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
export const length = (a) => Math.sqrt(dot(a, a));
export const normalize = (a) => scale(a, 1 / length(a));
export const cross = (a, b) => [
    a[1] * b[2] - a[2] * b[1],
    a[2] * b[0] - a[0] * b[2],
    a[0] * b[1] - a[1] * b[0],
];
export const along = (point, direction, distance) => add(point, scale(direction, distance));

/** Two unit vectors that are at right angles to `axis` and to each other. */
export function perpendiculars(axis) {
    const other = Math.abs(axis[0]) < 0.9 ? [1, 0, 0] : [0, 1, 0];
    const first = normalize(cross(axis, other));
    return [first, cross(axis, first)];
}

/** The point of the segment from `from` to `to` that is nearest to `point`. */
export function nearestOnSegment(point, from, to) {
    const direction = subtract(to, from);
    const squared = dot(direction, direction);
    if (squared === 0) return from;
    const t = dot(subtract(point, from), direction) / squared;
    return along(from, direction, Math.min(Math.max(t, 0), 1));
}
