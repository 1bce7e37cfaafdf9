// Questions, asked in a dialogue of the page.

import { h } from "../base/dom.js";

/** Asks; the answer is the `value` of the button pressed, null for Escape. */
export function ask(title, text, buttons) {
    return new Promise((resolve) => {
        let answer = null;
        const dialog = h("dialog", { class: "question", "aria-label": title,
            onclose: () => {
                dialog.remove();
                resolve(answer);
            } },
        h("h2", {}, title), h("p", {}, text),
        h("div", { class: "dialog-buttons" }, buttons.map(({ label, value, primary }) =>
            h("button", { type: "button", class: primary ? "primary" : "", onclick: () => {
                answer = value;
                dialog.close();
            } }, label))));
        document.body.append(dialog);
        dialog.showModal();
    });
}

/** Asks for a line of text; null for Cancel. */
export function askText(title, label, text, action) {
    return new Promise((resolve) => {
        let answer = null;
        const input = h("input", { type: "text", class: "text", "aria-label": label, value: text,
            spellcheck: "false", autocomplete: "off" });
        const dialog = h("dialog", { class: "question", "aria-label": title,
            onclose: () => {
                dialog.remove();
                resolve(answer);
            } },
        h("form", { method: "dialog", onsubmit: () => { answer = input.value.trim(); } },
            h("h2", {}, title), h("label", { class: "stacked" }, label, input),
            h("div", { class: "dialog-buttons" },
                h("button", { type: "button", onclick: () => dialog.close() }, "Cancel"),
                h("button", { type: "submit", class: "primary" }, action))));
        document.body.append(dialog);
        dialog.showModal();
        input.select();
    });
}
