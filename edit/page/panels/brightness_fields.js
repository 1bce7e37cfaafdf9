// A lamp's brightness: what it is given in, its spectrum, numbers and sliders. A slider that moves
// mixes the picture in the browser; the scene changes once, when it is let go.

import { rounded } from "../base/numbers.js";
import { newGroup } from "../server/editing.js";
import { logSlider, numberField, selectField } from "./fields.js";
import { bound } from "./form.js";

const KINDS = {
    intensity: { label: "intensity on the axis", unit: "W/sr", low: 0.1, high: 1e4 },
    power: { label: "power, all directions", unit: "W", low: 1, high: 1e5 },
    lumens: { label: "luminous flux", unit: "lm", low: 10, high: 1e6 },
    profile: { label: "that of the IES file" },
    irradiance: { label: "irradiance at the surface", unit: "W/m²", low: 0.01, high: 1e4 },
    lux: { label: "illuminance at the surface", unit: "lx", low: 1, high: 1e6 },
};

const listOf = (value) => (Array.isArray(value) ? value : [value]);

/** The spectrum as one line of text. */
const spectrumText = (spectrum) =>
    spectrum === null ? "" : spectrum.name ?? spectrum.file ??
        (spectrum.temperature ? `${spectrum.type} ${spectrum.temperature} K` : spectrum.type);

export function brightnessFields(scene, lamp, editing, picture) {
    const locked = ({ lamp: now }) => !now.editable;
    const { kind, spectrum } = lamp.brightness;
    const change = brightnessChange(lamp.name, editing);
    const parts = [
        bound(selectField({ label: "Given as", key: "brightness.kind",
            options: Object.entries(KINDS)
                .filter(([name]) => name === kind || suits(name, lamp))
                .map(([value, { label }]) => ({ value, label })),
            commit: (value, refuse) => recast(editing, lamp, change, value, spectrum, refuse) }),
        ({ lamp: now }) => now.brightness.kind, locked),
        bound(selectField({ label: "Spectrum", key: "brightness.spectrum",
            options: [{ value: null, label: "per band" },
                ...spectrumOptions(scene.spectra, spectrum)],
            commit: (text, refuse) => recast(editing, lamp, change,
                text === null ? { lumens: "intensity", lux: "irradiance" }[kind] ?? kind : kind,
                JSON.parse(text), refuse) }),
        ({ lamp: now }) => now.brightness.spectrum && JSON.stringify(now.brightness.spectrum), locked),
    ];
    if (kind === "profile") return parts;
    return [...parts, ...valueParts(scene, lamp, picture,
        (value, refuse) => change({ [kind]: value }, newGroup("brightness"), refuse), locked)];
}

/** Whether a lamp's brightness may be given so. */
function suits(kind, { profile: { type }, brightness: { spectrum } }) {
    if (kind === "lumens" || kind === "lux") return spectrum !== null && (kind === "lux") === (type === "sun");
    if (kind === "profile") return type === "ies";
    return (kind === "irradiance") === (type === "sun");
}

/** Sets keys of the lamp: brightnessChange(...)({power: 5}, group, refuse). */
const brightnessChange = (name, editing) => (keys, group, onRefusal) =>
    editing.edit(`brightness of ${name}`, Object.entries(keys).map(([key, value]) =>
        ({ op: "set", path: `lamps.${name}.${key}`, value })), { group, onRefusal });

/**
 * The same light, given otherwise. What one unit of it is on the axis the server says; with that the
 * value follows, in the same step of undo.
 */
async function recast(editing, lamp, change, kind, spectrum, refuse) {
    const group = newGroup("brightness");
    const before = lamp.brightness.kind;
    const keys = { spectrum: spectrum ?? null };
    if (before !== "profile" && before !== kind) keys[before] = null;
    if (kind !== "profile") keys[kind] = 1;
    if (!(await change(keys, group, refuse)) || kind === "profile") return;
    const unit = editing.scene.lamps[lamp.index].band_intensity;
    const sum = (values) => values.reduce((total, value) => total + value, 0);
    const value = spectrum ? sum(lamp.band_intensity) / sum(unit)
        : unit.map((one, band) => lamp.band_intensity[band] / one);
    await change({ [kind]: rounded(value) }, group, refuse);
}

function spectrumOptions(known, own) {
    const all = known.map((spectrum) => JSON.stringify(spectrum));
    const mine = own === null ? [] : [JSON.stringify(own)].filter((text) => !all.includes(text));
    return [...all, ...mine].map((value) => ({ value, label: spectrumText(JSON.parse(value)) }));
}

/**
 * A slider and a number for all bands together, and one of each for every band. Sliders of single
 * bands are mixed here if the bands are the picture's red, green and blue.
 */
function valueParts(scene, lamp, picture, change, locked) {
    const { kind, spectrum } = lamp.brightness;
    const { unit, low, high } = KINDS[kind];
    const { bands } = scene.image;
    let now = lamp.brightness.value;
    const largest = () => Math.max(...listOf(now));
    const perBand = () => bands.map((_, band) => listOf(now)[band] ?? now);
    const send = async (value, refuse) => {
        await change(value, refuse);
        picture.setFactor(lamp.name, null);
    };
    const all = (value) => {
        const each = (old) => (largest() > 0 ? (old * value) / largest() : value);
        return Array.isArray(now) ? now.map(each) : each(now);
    };
    const one = (band, value) => perBand().map((old, k) => (k === band ? value : old));
    const part = (label, key, read, apply, factors) => {
        const number = numberField({ label, unit, key,
            commit: (value, refuse) => send(apply(value), refuse) });
        const slider = logSlider({
            label: `${label} of ${lamp.name}, ${unit}`, key: `${key}.slider`, low, high,
            input: (value) => {
                number.update(Number(value.toPrecision(3)));
                if (factors && read() > 0) picture.setFactor(lamp.name, factors(value / read()));
            },
            commit: (value) => send(rounded(apply(value))),
        });
        number.element.querySelector(".field-controls").prepend(slider.element);
        return {
            element: number.element,
            update: (subject) => {
                now = subject.lamp.brightness.value;
                number.update(read(), locked(subject));
                slider.update(read(), locked(subject));
            },
        };
    };
    const parts = [part(spectrum === null ? "All bands" : "Brightness", "brightness", largest, all,
        (factor) => Array(3).fill(factor))];
    if (spectrum !== null) return parts;
    bands.forEach((nm, band) => parts.push(part(`${nm} nm`, `brightness.${band}`,
        () => perBand()[band], (value) => one(band, value),
        scene.image.bands_are_rgb && ((factor) => bands.map((_, k) => (k === band ? factor : 1))))));
    return parts;
}
