// What this window shows and how. It is no part of the scene, and it survives a reload of the page.

import { Observable } from "../base/observable.js";

const KEY = "uwvdb.settings";

const DEFAULTS = {
    look: "total",
    onlyLamp: null, // name of the lamp whose light alone is looked at
    solo: null, // name of the lamp that alone is on, here
    stops: null, // exposure; null until the first picture has chosen it
    selected: null, // name of the lamp that the form shows
    split: { on: false, at: 0.5 },
    tab: "lamp",
    snap: "none", // none, grid or bar
    grid: 0.1, // metres
    bar: null, // {from, to} in the world; null until the camera is known
    planHeight: 230,
    patch: null, // [x0, y0, x1, y1] in pixels of the image; null: the server chooses
    choosingPatch: false, // the next drag over the picture chooses it
    ratio: 1, // signal to backscatter that counts as good
};

export function makeSettings() {
    const stored = sessionStorage.getItem(KEY);
    const settings = new Observable({ ...DEFAULTS, ...(stored ? JSON.parse(stored) : {}) });
    settings.observe((value) => {
        sessionStorage.setItem(KEY, JSON.stringify({ ...value, choosingPatch: false }));
    });
    return settings;
}
