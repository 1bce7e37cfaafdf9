// The water, the particles of the volumes, and the camera's port.

import { h } from "../base/dom.js";
import { checkField, numberField, numbersField, selectField } from "./fields.js";
import { bound, Form } from "./form.js";

const PORTS = { none: "none: in the water", flat: "flat", dome: "dome" };
const GLASSES = ["bk7", "fused-silica", "sapphire", "pmma", "polycarbonate"];
const WATERS = ["seawater", "freshwater"];
const PORT_STARTS = {
    flat: { type: "flat", distance: 0.02, thickness: 0.01 },
    dome: { type: "dome", radius: 0.08, thickness: 0.01 },
};

/** Fields that set one key of the scene each. */
const setter = (editing) => (label, path) => (value, onRefusal) =>
    editing.edit(label, [{ op: "set", path, value }], { group: `typed-${path}`, onRefusal });

export class WaterForm {
    #form;
    #set;

    constructor(place, editing) {
        this.#set = setter(editing);
        this.#form = new Form(place,
            (scene) => [scene.water.presets, scene.volumes.map((volume) =>
                [volume.file, Object.keys(volume.concentrations),
                    Object.values(volume.concentrations).map(Object.keys)]),
            scene.camera.port?.type ?? null, scene.camera.port?.path, scene.camera.port?.materials],
            (scene) => this.#build(scene));
    }

    update(scene) {
        this.#form.update(scene);
    }

    #build(scene) {
        return [...this.#water(scene), ...scene.volumes.flatMap((volume) => this.#volume(volume)),
            ...this.#port(scene)];
    }

    #number(label, unit, path, read, options = {}) {
        return bound(numberField({ label, unit, key: path, optional: true, ...options,
            commit: this.#set(label.toLowerCase(), path) }), read);
    }

    #water(scene) {
        const presets = [{ value: null, label: "none" },
            ...scene.water.presets.map((value) => ({ value, label: value }))];
        return [
            "Water",
            bound(selectField({ label: "Preset", key: "water.preset", options: presets,
                commit: this.#set("preset", "water.preset") }), (now) => now.water.preset),
            this.#number("Small particles", "ppm", "water.particles.small",
                (now) => now.water.particles.small),
            this.#number("Large particles", "ppm", "water.particles.large",
                (now) => now.water.particles.large),
            this.#number("Salinity", "PSU", "water.salinity", (now) => now.water.salinity),
        ];
    }

    #volume(volume) {
        const parts = [`Volume ${volume.file.split("/").at(-1)}`];
        for (const [grid, keys] of Object.entries(volume.concentrations)) {
            for (const key of Object.keys(keys)) {
                parts.push(this.#number(`${grid}, ${key}`, "ppm",
                    `${volume.path}.grids.${grid}.${key}`,
                    (now) => now.volumes[volume.index]?.concentrations[grid]?.[key] ?? null));
            }
        }
        if (parts.length === 1) {
            parts.push({ element: h("p", { class: "hint" },
                "Given by its coefficients, which are changed in the file."), update: () => {} });
        }
        return parts;
    }

    /** An index by material or by number. */
    #index(scene, label, key, materials) {
        const path = `camera.port.${key}`;
        const current = (now) => now.camera.port?.materials[key] ?? null;
        const words = current(scene) === null || materials.includes(current(scene))
            ? materials : [...materials, current(scene)];
        const commit = this.#set(label.toLowerCase(), path);
        const field = bound(selectField({ label, key: `${path}.material`,
            options: [{ value: null, label: "index as a number" },
                ...words.map((value) => ({ value, label: value }))],
            commit: (value, refuse) =>
                commit(value ?? Number(scene.camera.port[key].toFixed(4)), refuse) }), current);
        if (current(scene) !== null) return [field];
        return [field, this.#number(`Index of ${label.toLowerCase()}`, null, path,
            (now) => now.camera.port?.[key] ?? null, { optional: false })];
    }

    #port(scene) {
        const type = scene.camera.port?.type ?? "none";
        const read = (key) => (now) => now.camera.port?.[key] ?? null;
        const number = (label, unit, key) =>
            this.#number(label, unit, `camera.port.${key}`, read(key), { optional: false });
        const vector = (label, unit, key) => bound(numbersField({ label, unit, key: `camera.port.${key}`,
            names: ["x", "y", "z"], commit: this.#set(label.toLowerCase(), `camera.port.${key}`) }),
        (now) => now.camera.port?.[key] ?? [0, 0, 0]);
        const parts = ["Port", bound(selectField({ label: "Type", key: "camera.port.type",
            options: Object.entries(PORTS).map(([value, label]) => ({ value, label })),
            commit: (value, refuse) =>
                this.#set("port", "camera.port")(PORT_STARTS[value] ?? null, refuse) }),
        (now) => now.camera.port?.type ?? "none")];
        if (type === "none") return parts;
        parts.push(...(type === "flat"
            ? [number("Distance", "m", "distance"), vector("Normal", null, "normal")]
            : [number("Inner radius", "m", "radius"), vector("Centre", "m", "center")]),
        number("Thickness", "m", "thickness"), number("Index of air", null, "n_air"),
        ...this.#index(scene, "Glass", "n_glass", GLASSES),
        ...this.#index(scene, "Water", "n_water", WATERS),
        bound(checkField({ label: "Fresnel losses at the glass", key: "camera.port.fresnel",
            commit: this.#set("fresnel", "camera.port.fresnel") }), (now) => now.camera.port.fresnel));
        return parts;
    }
}
