// Everything about the chosen lamp, to be typed.

import { h } from "../base/dom.js";
import { hasPlace } from "../base/lamps.js";
import { add } from "../base/vec.js";
import { newGroup } from "../server/editing.js";
import { brightnessFields } from "./brightness_fields.js";
import { numberField, numbersField, selectField, textField } from "./fields.js";
import { bound, Form } from "./form.js";

const PROFILES = {
    isotropic: { label: "isotropic", keys: [], start: () => ({}) },
    spot: { label: "spot", keys: ["beam", "edge"], start: () => ({ beam: 60, edge: 5 }) },
    cosine: { label: "cosine", keys: ["fwhm"], start: () => ({ fwhm: 120 }) },
    ies: {
        label: "IES file", keys: ["rotate", "tilt"],
        start: (scene) => ({ file: scene.ies_files[0] }),
    },
};

const KEY_LABELS = {
    beam: "Beam", edge: "Edge", fwhm: "Full width at half", rotate: "Rotate", tilt: "Tilt",
};

const EXTENT_STEPS = { radius: 0.01, width: 0.01, height: 0.01, rotate: 1, samples: 1 };

/** point, rectangle, disk; of a sun whether its disc has an extent. */
const kindOf = ({ extent, sun }) => extent?.type ?? (sun ? `sun ${sun.angle > 0}` : "point");

const hint = (text) => ({ element: h("p", { class: "hint" }, text), update: () => {} });

export class LampForm {
    #form;
    #settings;
    #editing;
    #picture;

    constructor(place, settings, editing, picture) {
        this.#settings = settings;
        this.#editing = editing;
        this.#picture = picture;
        this.#form = new Form(place, (subject) => this.#signature(subject),
            (subject) => this.#build(subject));
    }

    update(scene, lamp) {
        this.#form.update({ scene, lamp });
    }

    #signature({ scene, lamp }) {
        return lamp && [lamp.name, lamp.profile.type, lamp.why_not, kindOf(lamp),
            lamp.brightness.kind, lamp.brightness.spectrum, Array.isArray(lamp.brightness.value),
            scene.ies_files, scene.image.bands, scene.rig];
    }

    #build({ scene, lamp }) {
        if (!lamp) {
            return [hint("No lamp is chosen. Add one, or choose one above.")];
        }
        const locked = ({ lamp: now }) => !now.editable;
        const path = (key) => `lamps.${lamp.name}.${key}`;
        const set = (label, key) => (value, onRefusal) => this.#editing.edit(
            `${label} of ${lamp.name}`, [{ op: "set", path: path(key), value }],
            { group: `typed-${lamp.name}-${key}`, onRefusal });
        const field = (made, read) => bound(made, ({ lamp: now }) => read(now), locked);
        const parts = [];
        if (lamp.why_not) {
            parts.push({ element: h("p", { class: "hint locked" }, lamp.why_not), update: () => {} });
        }
        parts.push(field(textField({ label: "Name", key: "name", commit:
            (value, refuse) => this.#rename(lamp.name, value, refuse) }), (now) => now.name));
        const direction = field(numbersField({ label: "Direction", key: "direction",
            names: ["x", "y", "z"], step: 0.01, commit: set("direction", "direction") }),
        (now) => now.direction);
        const brightness = brightnessFields(scene, lamp, this.#editing, this.#picture);
        if (!hasPlace(lamp)) {
            return [...parts, direction, ...this.#discParts(lamp, field, set), "Brightness",
                ...brightness, hint("The water's surface is changed in the scene file.")];
        }
        parts.push(
            field(selectField({ label: "Kind", key: "type",
                options: ["point", "rectangle", "disk"].map((kind) => ({ value: kind, label: kind })),
                commit: (kind, refuse) => this.#setKind(lamp, kind, refuse) }), kindOf),
            field(selectField({ label: "Frame", key: "frame",
                options: ["camera", ...(scene.rig ? ["rig"] : []), "world",
                    ...(lamp.frame === "trajectory" ? ["trajectory"] : [])]
                    .map((frame) => ({ value: frame, label: frame })),
                commit: (frame, refuse) => this.#setFrame(lamp, frame, refuse) }), (now) => now.frame),
            field(numbersField({ label: "Position", unit: "m", key: "position", names: ["x", "y", "z"],
                step: 0.01, commit: set("position", "position") }), (now) => now.position),
            direction, ...this.#extentParts(lamp, field, set),
            "Profile", ...this.#profileParts(scene, lamp, field, set),
            "Brightness", ...brightness);
        return parts;
    }

    async #rename(from, to, onRefusal) {
        const renamed = await this.#editing.edit(`rename ${from}`,
            [{ op: "rename_lamp", lamp: from, name: to }], { onRefusal });
        if (!renamed) return;
        const { selected, solo, onlyLamp } = this.#settings.value;
        const now = (name) => (name === from ? to : name);
        this.#settings.update({ selected: now(selected), solo: now(solo), onlyLamp: now(onlyLamp) });
    }

    /** Another kind of lamp, about as large as it was. Keys of its old kind leave the file. */
    #setKind({ name, extent }, kind, onRefusal) {
        const { radius = 0.1, width = 2 * radius, height = width } = extent ?? {};
        const keys = {
            point: { type: null, width: null, height: null, rotate: null, radius: null, samples: null },
            rectangle: { type: kind, width, height, radius: null },
            disk: { type: kind, width: null, height: null, rotate: null,
                radius: Math.min(width, height) / 2 },
        }[kind];
        return this.#editing.edit(`kind of ${name}`, Object.entries(keys).map(([key, value]) =>
            ({ op: "set", path: `lamps.${name}.${key}`, value })), { onRefusal });
    }

    /** Another frame; the lamp stays where it is and shines as it did. */
    async #setFrame({ name, world_position: at, world_direction: direction }, frame, onRefusal) {
        const group = newGroup("frame");
        const label = `frame of ${name}`;
        const path = `lamps.${name}.frame`;
        const done = await this.#editing.edit(label, [{ op: "set", path, value: frame }],
            { group, onRefusal });
        if (!done) return;
        await this.#editing.edit(label, [
            { op: "move_lamp", lamp: name, world: at },
            { op: "aim_lamp", lamp: name, world: add(at, direction) },
        ], { group, onRefusal });
    }

    /** The size of a lamp that is not a point. */
    #extentParts({ extent }, field, set) {
        if (extent === null) return [];
        const number = (label, unit, key) => field(numberField({ label, unit, key, step: EXTENT_STEPS[key],
            commit: set(label.toLowerCase(), key) }), (now) => now.extent?.[key] ?? 0);
        return [`Luminous ${extent.type}`,
            ...(extent.type === "disk" ? [number("Radius", "m", "radius")]
                : [number("Width", "m", "width"), number("Height", "m", "height"),
                    number("Rotate", "°", "rotate")]),
            number("Points", null, "samples")];
    }

    /** The disc of a sun. */
    #discParts({ sun }, field, set) {
        const number = (label, unit, key, step) => field(numberField({ label, unit, key, step,
            commit: set(label.toLowerCase(), key) }), (now) => now.sun?.[key] ?? 0);
        return ["Disc", number("Angle across", "°", "angle", 0.1),
            ...(sun.angle > 0 ? [number("Directions", null, "samples", 1)] : [])];
    }

    #profileParts(scene, lamp, field, set) {
        const { type } = lamp.profile;
        const replace = set("profile", "profile");
        const options = Object.entries(PROFILES)
            .filter(([name]) => name !== "ies" || scene.ies_files.length > 0 || type === "ies")
            .map(([value, { label }]) => ({ value, label }));
        const parts = [field(selectField({ label: "Type", key: "profile.type", options,
            commit: (chosen, refuse) =>
                replace({ type: chosen, ...PROFILES[chosen].start(scene) }, refuse) }),
        (now) => now.profile.type)];
        if (type === "ies") {
            parts.push(field(selectField({ label: "File", key: "profile.file",
                options: scene.ies_files.map((file) => ({ value: file, label: file })),
                commit: set("IES file", "profile.file") }), (now) => now.profile.file));
        }
        for (const key of PROFILES[type].keys) {
            parts.push(field(numberField({ label: KEY_LABELS[key], unit: "°", key: `profile.${key}`,
                step: 1, commit: set(key, `profile.${key}`) }), (now) => now.profile[key]));
        }
        return parts;
    }
}
