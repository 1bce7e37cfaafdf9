// The colours that stand for irradiance: from black over blue, red and yellow to white, each
// brighter than the one before, so that it reads without colour vision and in print, too.

export const RAMP = [
    [0.0, 0.0, 0.02],
    [0.11, 0.07, 0.35],
    [0.33, 0.08, 0.5],
    [0.62, 0.14, 0.45],
    [0.85, 0.28, 0.27],
    [0.96, 0.52, 0.13],
    [0.98, 0.79, 0.27],
    [1.0, 1.0, 0.85],
];

/** The ramp as a CSS gradient, from low to high. */
export const rampGradient = (direction) =>
    `linear-gradient(${direction}, ${RAMP.map(
        (colour) => `rgb(${colour.map((value) => Math.round(value * 255)).join(" ")})`,
    ).join(", ")})`;
