// Which planes make what is looked at, and how much of each: all that lamps light is linear in their
// brightness, so that other gains are another sum of the same planes.

/** What can be looked at, in the order of its buttons. */
export const LOOKS = {
    total: { label: "Total", layers: ["direct", "backscatter", "forward", "multiple", "snow"] },
    direct: { label: "Direct", layers: ["direct"] },
    backscatter: { label: "Backscatter", layers: ["backscatter", "snow"] },
    multiple: { label: "Multiple", layers: ["multiple"],
        needs: "scattered or reflected more than once: set render.scattering to multiple" },
    forward: { label: "Forward", layers: ["forward"],
        needs: "the paper's blur: set water.forward_scatter.K" },
    clean: { label: "Clean", layers: ["clean"] },
    irradiance: { label: "Irradiance", layers: ["irradiance"], falseColour: true },
};

/**
 * How much brighter each lamp is now than when the image was computed, per channel, by name. `solo` is
 * the only lamp to be seen, or null; `factors` are those of sliders being moved, per channel. A lamp
 * that is gone, or has another name now, stays as it was until the image without it is here.
 */
export function lampGains(image, lamps, { solo = null, factors = {} } = {}) {
    const gains = new Map();
    image.lamps.forEach((name, index) => {
        const lamp = lamps.find((each) => each.name === name);
        const used = image.lamp_brightness[index];
        const dark = solo === null ? lamp?.on === false : solo !== name;
        const now = lamp?.rgb_scale ?? used;
        const factor = factors[name] ?? [1, 1, 1];
        gains.set(name, used.map((value, channel) =>
            dark || value === 0 ? 0 : (now[channel] / value) * factor[channel]));
    });
    return gains;
}

/** [{plane, weight: [r, g, b]}] of the planes that count. `onlyLamp` is a lamp's name, or null. */
export function mixOf(image, look, gains, onlyLamp = null) {
    const { layers } = LOOKS[look];
    const mix = [];
    image.planes.forEach(({ lamp, layer, factor }, plane) => {
        if (!layers.includes(layer)) return;
        if (onlyLamp !== null && lamp !== onlyLamp) return;
        // What no lamp makes shines by itself, and is left as it is.
        const gain = lamp === null ? [1, 1, 1] : gains.get(lamp);
        if (gain.every((value) => value === 0)) return;
        mix.push({ plane, weight: gain.map((value) => value * factor) });
    });
    return mix;
}
