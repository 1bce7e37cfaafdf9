// The keys that work everywhere, and the page that lists them.

import { h } from "../base/dom.js";
import { LOOKS } from "../picture/mix.js";

const LIST = [
    ["Ctrl S", "save"], ["Ctrl Z, Ctrl Shift Z", "undo, redo"],
    ["1 … 7", Object.values(LOOKS).map(({ label }) => label.toLowerCase()).join(", ")],
    ["A", "choose the exposure anew"], ["[ and ]", "darker, brighter by a third of a stop"],
    ["K", "keep a snapshot"], ["V", "split view"], ["P", "choose a patch in the picture"],
    ["N", "next lamp"], ["O", "lamp on or off"], ["S", "this lamp alone"],
    ["D, M, Delete", "duplicate, mirror, delete the lamp"],
    ["Tab, arrow keys", "on a handle: move it; with Shift in larger steps"],
    ["Page Up, Page Down", "on a lamp in the picture: farther, nearer"],
    ["Shift and drag", "a lamp in the picture: in depth"],
    ["+, −, Home", "on a plan view: zoom, show everything"], ["F1", "this list"],
];

const takesText = (element) =>
    element.matches("input[type=text], textarea, select") || element.isContentEditable;

/** `actions` by key, as given to Toolbar and by the lamp list. */
export function listenToKeys(settings, actions) {
    const byKey = {
        a: actions.chooseExposure, k: actions.keepSnapshot, n: actions.nextLamp,
        o: actions.toggleOn, s: actions.toggleSolo, d: actions.duplicate, m: actions.mirror,
        Delete: actions.remove,
        v: () => settings.update({ split: { ...settings.value.split, on: !settings.value.split.on } }),
        p: () => settings.update({ choosingPatch: !settings.value.choosingPatch }),
        "[": () => settings.update({ stops: settings.value.stops - 1 / 3 }),
        "]": () => settings.update({ stops: settings.value.stops + 1 / 3 }),
        Escape: () => settings.update({ choosingPatch: false }),
    };
    Object.keys(LOOKS).forEach((look, index) => {
        byKey[String(index + 1)] = () => settings.update({ look });
    });
    addEventListener("keydown", (event) => {
        const { target } = event;
        if (document.querySelector("dialog[open]") || event.altKey) return;
        if (event.key === "F1") {
            event.preventDefault();
            showKeys();
            return;
        }
        if (event.ctrlKey || event.metaKey) {
            withControl(event, target, actions);
            return;
        }
        if (takesText(target)) return;
        const action = byKey[event.key.length === 1 ? event.key.toLowerCase() : event.key];
        if (!action) return;
        event.preventDefault();
        action();
    });
}

function withControl(event, target, actions) {
    const key = event.key.toLowerCase();
    // What is being typed is undone by the browser, until it is taken over.
    const typing = takesText(target) && target.value !== target.defaultValue;
    let action = null;
    if (key === "s") action = actions.save;
    else if (key === "z" && !typing) action = event.shiftKey ? actions.redo : actions.undo;
    else if (key === "y" && !typing) action = actions.redo;
    if (!action) return;
    event.preventDefault();
    if (key === "s") target.blur?.();
    action();
}

export function showKeys() {
    const dialog = h("dialog", { class: "question keys", "aria-label": "Keys",
        onclose: () => dialog.remove() },
    h("h2", {}, "Keys"),
    h("dl", {}, LIST.flatMap(([keys, meaning]) => [h("dt", {}, keys), h("dd", {}, meaning)])),
    h("div", { class: "dialog-buttons" }, h("button", { type: "button", class: "primary",
        onclick: () => dialog.close() }, "Close")));
    document.body.append(dialog);
    dialog.showModal();
}
