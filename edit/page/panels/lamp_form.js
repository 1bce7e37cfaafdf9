// Everything about the chosen lamp, to be typed.

import { h } from "../base/dom.js";
import { hasPlace } from "../base/lamps.js";
import { rounded } from "../base/numbers.js";
import { add, along, dot, normalize, scale } from "../base/vec.js";
import { newGroup } from "../server/editing.js";
import { brightnessFields } from "./brightness_fields.js";
import { numberField, numbersField, selectField, textField } from "./fields.js";
import { bound, Form } from "./form.js";

const PROFILES = {
    isotropic: { label: "isotropic", keys: [], start: () => ({}) },
    spot: { label: "spot", keys: ["beam", "edge"], start: () => ({ beam: 60, edge: 5 }) },
    cosine: { label: "cosine", keys: ["fwhm"], start: () => ({ fwhm: 120 }) },
    table: {
        label: "table", keys: [],
        start: () => ({ angles: [0, 20, 40, 60], values: [1, 0.9, 0.4, 0] }),
    },
    ies: {
        label: "IES file", keys: ["rotate", "tilt"],
        start: (scene) => ({ file: scene.ies_files[0] }),
    },
    line: {
        label: "laser line", keys: ["angle", "width", "rotate"],
        start: () => ({ angle: 60, width: 0.5 }),
    },
    image: { label: "image", keys: ["fov", "rotate"] },
};

/** What the scene has files for, or what the lamp is already. */
const isOffered = (name, type, scene) => name === type ||
    (name === "ies" ? scene.ies_files.length > 0 : name !== "image");

const KEY_LABELS = {
    beam: "Beam", edge: "Edge", fwhm: "Full width at half", rotate: "Rotate", tilt: "Tilt",
    angle: "Fan", width: "Width at half", fov: "Width of the image",
};

const EXTENT_STEPS = { radius: 0.01, width: 0.01, height: 0.01, rotate: 1, samples: 1 };

const KINDS = ["point", "rectangle", "disk", "sphere", "sun"];

/** Where a sun and the lamp that takes its place are as bright: so far before the camera and from the lamp [m]. */
const SUBJECT_DISTANCE = 2;
/** How far above the camera the water's surface is put in a scene that has none [m]. */
const SURFACE_HEIGHT = 5;
const LEAST_COSINE_OF_SUN = Math.cos((89 * Math.PI) / 180); // from straight down

const kindOf = ({ extent, sun }) => extent?.type ?? (sun ? "sun" : "point");

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
        return lamp && [lamp.name, lamp.profile.type, lamp.why_not, kindOf(lamp), lamp.sun?.angle > 0,
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
        if (lamp.profile.type === "volume") return parts;
        parts.push(field(textField({ label: "Name", key: "name", commit:
            (value, refuse) => this.#rename(lamp.name, value, refuse) }), (now) => now.name));
        const direction = field(numbersField({ label: "Direction", key: "direction",
            names: ["x", "y", "z"], step: 0.01, commit: set("direction", "direction") }),
        (now) => now.direction);
        const brightness = brightnessFields(scene, lamp, this.#editing, this.#picture);
        parts.push(field(selectField({ label: "Kind", key: "type",
            options: KINDS.map((kind) => ({ value: kind, label: kind })),
            commit: (kind, refuse) => this.#setKind(scene, lamp, kind, refuse) }), kindOf));
        if (!hasPlace(lamp)) {
            return [...parts, direction, ...this.#discParts(lamp, field, set), "Brightness",
                ...brightness, hint("The water's surface is changed in the scene file.")];
        }
        parts.push(
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
    #setKind(scene, lamp, kind, onRefusal) {
        const { name, extent } = lamp;
        const { radius = 0.1, width = 2 * radius, height = width } = extent ?? {};
        const round = { type: kind, width: null, height: null, rotate: null,
            radius: Math.min(width, height) / 2 };
        const sized = {
            point: { type: null, width: null, height: null, rotate: null, radius: null, samples: null },
            rectangle: { type: kind, width, height, radius: null },
            disk: round,
            sphere: round,
        }[kind];
        const keys = kind === "sun" ? sunOf(scene, lamp)
            : lamp.sun ? { ...placedLampOf(scene, lamp), ...sized, samples: null } : sized;
        const changes = Object.entries(keys).map(([key, value]) =>
            ({ op: "set", path: `lamps.${name}.${key}`, value }));
        if (kind === "sun" && !scene.water.keys?.surface) {
            changes.unshift({ op: "set", path: `${scene.water.path}.surface`,
                value: surfaceAbove(scene.camera) });
        }
        return this.#editing.edit(`kind of ${name}`, changes, { onRefusal });
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
            ...(extent.type === "rectangle" ? [number("Width", "m", "width"),
                number("Height", "m", "height"), number("Rotate", "°", "rotate")]
                : [number("Radius", "m", "radius")]),
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
            .filter(([name]) => isOffered(name, type, scene))
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

/** A plane above the camera, level with the axis of the world that points up most. */
function surfaceAbove({ position, up }) {
    const axis = up.reduce((best, part, k) => (Math.abs(part) > Math.abs(up[best]) ? k : best), 0);
    const normal = [0, 0, 0].map((_, k) => (k === axis ? Math.sign(up[axis]) : 0));
    return { point: along(position, normal, SURFACE_HEIGHT).map(rounded), normal };
}

/** The keys of a sun in the place of a lamp that has one: it shines the same way, if that is down. */
function sunOf(scene, { world_direction: direction, brightness, band_intensity: intensity }) {
    const { normal } = scene.water.keys?.surface ?? surfaceAbove(scene.camera);
    const down = scale(normalize(normal), -1);
    const isDown = dot(direction, down) > LEAST_COSINE_OF_SUN;
    return {
        type: "sun", position: null, profile: null, frame: null, trajectory: null,
        width: null, height: null, rotate: null, radius: null, samples: null,
        intensity: null, power: null, lumens: null,
        direction: (isDown ? direction : down).map(rounded),
        irradiance: valueOf(brightness, intensity, SUBJECT_DISTANCE ** -2),
    };
}

/** The keys of a lamp in the place of a sun, which shines at what is before the camera. */
function placedLampOf({ camera }, { world_direction: direction, brightness, band_intensity: irradiance }) {
    const subject = along(camera.position, camera.forward, SUBJECT_DISTANCE);
    return {
        angle: null, irradiance: null, lux: null, frame: "world",
        position: along(subject, direction, -SUBJECT_DISTANCE).map(rounded),
        direction: direction.map(rounded),
        intensity: valueOf(brightness, irradiance, SUBJECT_DISTANCE ** 2),
    };
}

/** A lamp's light as a value of a key: one per band, or with a spectrum the sum of them. */
function valueOf({ spectrum }, bands, factor) {
    const values = bands.map((value) => rounded(factor * value));
    return spectrum === null ? values : rounded(values.reduce((total, value) => total + value, 0));
}
