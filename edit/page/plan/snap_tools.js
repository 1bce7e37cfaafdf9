// What dragged lamps snap to.

import { h } from "../base/dom.js";
import { parseNumber } from "../base/numbers.js";

const CHOICES = { none: "Free", grid: "Grid", bar: "Bar" };

export function makeSnapTools(place, settings) {
    const buttons = Object.entries(CHOICES).map(([snap, label]) => h("button", { type: "button",
        title: { none: "Lamps are dragged freely", grid: "Lamps snap to a grid",
            bar: "Lamps snap to the bar, whose ends can be dragged" }[snap],
        onclick: () => settings.update({ snap }) }, label));
    const grid = h("input", { type: "text", class: "number", inputmode: "decimal",
        "aria-label": "Grid, metres", onchange: () => {
            const value = parseNumber(grid.value);
            if (value > 0) settings.update({ grid: value });
            grid.value = settings.value.grid;
        } });
    place.append(h("span", { class: "unit" }, "Snap"), h("div", { class: "segments" }, ...buttons),
        grid, h("span", { class: "unit" }, "m"));
    settings.observe(({ snap, grid: metres }) => {
        Object.keys(CHOICES).forEach((choice, index) =>
            buttons[index].setAttribute("aria-pressed", String(choice === snap)));
        if (document.activeElement !== grid) grid.value = metres;
        grid.disabled = snap !== "grid";
    });
}
