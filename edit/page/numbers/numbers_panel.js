// The numbers a designer decides by, of the picture at hand and of the snapshot, each with its
// definition; and how they change with the distance of a target.

import { h, setText } from "../base/dom.js";
import { formatNumber } from "../base/numbers.js";
import { numberField } from "../panels/fields.js";
import { linePlot } from "./line_plot.js";

const percent = (value) => (value === null ? "–" : `${formatNumber(value * 100, 3)} %`);
const plain = (value) => formatNumber(value, 3);

// A ratio over nothing is null: infinite, unless there is no light at all.
const ratio = (value, numbers) =>
    value === null && numbers.signal > 0 ? "∞" : plain(value);

const PATCH = "patch";
const IMAGE = "image";

const ROWS = [
    { of: PATCH, label: "Contrast", read: (n) => n.contrast, show: plain,
        meaning: "Michelson, (bright − dark) / (bright + dark) of the total light in tiles of the patch: " +
            "bright is the mean of the quarter of the pixels whose surface reflects most, dark of " +
            "that which reflects least; without a pattern, of the brightest and darkest quarters" },
    { of: PATCH, label: "… without water", read: (n) => n.clean_contrast, show: plain,
        meaning: "the same contrast of the clean picture: the most that any rig could keep" },
    { of: PATCH, label: "Signal to backscatter", read: (n) => n.signal_to_backscatter, show: ratio,
        meaning: "mean light from surfaces (direct and forward) over mean backscatter" },
    { of: IMAGE, label: "Signal to backscatter", read: (n) => n.signal_to_backscatter, show: ratio,
        meaning: "the same of the whole picture" },
    { of: IMAGE, label: "Share above the ratio", read: (n) => n.share_above, show: percent,
        meaning: "pixels whose signal to backscatter is at least the ratio below" },
    { of: IMAGE, label: "Evenness", read: (n) => n.evenness?.least_to_mean ?? null, show: plain,
        meaning: "least over mean irradiance of the surfaces seen (U₀ of lighting engineers)" },
    { of: IMAGE, label: "… 5th percentile", read: (n) => n.evenness?.percentile5_to_mean ?? null,
        show: plain, meaning: "5th percentile over mean irradiance, which a single dark corner " +
            "does not decide" },
    { of: IMAGE, label: "Mean irradiance", read: (n) => n.evenness?.mean ?? null, show: plain,
        unit: "W/m²", meaning: "of the surfaces seen, mean of the bands" },
    { of: IMAGE, label: "Light lost to water", read: (n) => n.lost_to_water, show: percent,
        meaning: "1 − signal / clean: what the water takes on the way to the surfaces and back" },
];

const CURVES = [
    { key: "contrast", title: "Contrast of a black and white target", unit: "", logarithmic: false },
    { key: "signal_to_backscatter", title: "Signal to backscatter", unit: "", logarithmic: true },
    { key: "irradiance", title: "Irradiance on the target", unit: "W/m²", logarithmic: true },
];

export class NumbersPanel {
    #cells = [];
    #note;
    #plots;
    #patchNote;
    #kept = null;
    #now = null;
    #ratio;
    #settings;
    #wholeButton;
    #chooseButton;

    constructor(place, settings) {
        this.#settings = settings;
        const heading = (text) => h("tr", {},
            h("th", { scope: "rowgroup", colspan: 3, class: "group" }, text));
        const table = h("table", { class: "numbers" },
            h("thead", {}, h("tr", {}, h("td"), h("th", { scope: "col" }, "now"),
                h("th", { scope: "col" }, "snapshot"))),
            h("tbody", {}, ROWS.flatMap(({ of, label, meaning, unit }, index) => {
                const cells = { now: h("td"), kept: h("td") };
                this.#cells.push(cells);
                const row = h("tr", { title: meaning }, h("th", { scope: "row" }, label,
                    unit ? h("span", { class: "unit" }, unit) : null), cells.now, cells.kept);
                return of === ROWS[index - 1]?.of ? [row]
                    : [heading(of === PATCH ? "In the patch" : "In the whole picture"), row];
            })));
        this.#note = h("p", { class: "hint", role: "status" }, "No numbers yet.");
        this.#patchNote = h("span", {});
        this.#chooseButton = h("button", { type: "button", title: "Drag over the picture (P)",
            onclick: () => settings.update({ choosingPatch: !settings.value.choosingPatch }) },
        "Choose patch");
        this.#wholeButton = h("button", { type: "button", title: "Where the surfaces are patterned most",
            onclick: () => settings.update({ patch: null }) }, "Automatic");
        this.#ratio = numberField({ label: "Ratio", key: "ratio",
            commit: (value, refuse) => (value > 0 ? settings.update({ ratio: value })
                : refuse(new Error("the ratio must be above 0"))) });
        this.#plots = h("div", { class: "plots" });
        place.append(table, h("div", { class: "tools" }, this.#chooseButton, this.#wholeButton,
            this.#patchNote), this.#ratio.element, this.#note, this.#plots,
        h("details", { class: "definitions" }, h("summary", {}, "What the numbers mean"),
            h("dl", {}, ROWS.flatMap(({ label, meaning }) => [h("dt", {}, label),
                h("dd", {}, meaning)]),
            h("dt", {}, "Target"), h("dd", {}, "flat, half white and half black, across the " +
                "camera's axis, alone in the scene's water; contrast (white − black) / (white + black)"))));
        settings.observe(() => this.#showSettings());
    }

    #showSettings() {
        const { patch, choosingPatch, ratio: least } = this.#settings.value;
        this.#ratio.update(least);
        this.#chooseButton.setAttribute("aria-pressed", String(choosingPatch));
        this.#wholeButton.disabled = patch === null;
    }

    /** `numbers`: the server's, of the picture at hand. */
    show(numbers) {
        // Curves take longer, and are not asked for of every picture: until then the last ones stay.
        this.#now = { ...numbers, curves: numbers.curves ?? this.#now?.curves };
        this.#draw();
    }

    keepSnapshot() {
        this.#kept = this.#now;
        this.#draw();
    }

    dropSnapshot() {
        this.#kept = null;
        this.#draw();
    }

    #draw() {
        ROWS.forEach(({ of, read, show }, index) => {
            const text = (numbers) => (numbers ? show(read(numbers[of]), numbers[of]) : "");
            setText(this.#cells[index].now, text(this.#now));
            setText(this.#cells[index].kept, text(this.#kept));
        });
        if (!this.#now) return;
        const { patch, quality, curves } = this.#now;
        const [x0, y0, x1, y1] = patchPixels(this.#now).map(Math.round);
        const kinds = { pixels: "chosen", checkerboard: "most patterned", image: "whole picture" };
        setText(this.#patchNote, `${kinds[patch.kind]}: ${x1 - x0} × ${y1 - y0} at ${x0}, ${y0}`);
        setText(this.#note, quality === "first" ? "Measured in light that is scattered once; all " +
            "light follows." : `Measured in the ${quality} picture.`);
        if (!curves) return;
        this.#plots.replaceChildren(h("h3", {}, "How far the rig sees"),
            h("p", { class: "hint" }, "Of light that is scattered once, whatever the picture shows."),
            ...CURVES.map(({ key, title, unit, logarithmic }) => linePlot({
                title, xLabel: "distance of the target [m]", yLabel: unit, logarithmic,
                curves: [
                    ...(this.#kept?.curves ? [{ name: "snapshot", class: "kept",
                        x: this.#kept.curves.distance, y: this.#kept.curves[key] }] : []),
                    { name: "now", class: "now", x: curves.distance, y: curves[key] },
                ],
            })));
    }
}

/** Where the numbers of the patch were measured: [x0, y0, x1, y1] in pixels of the full image. */
export const patchPixels = ({ patch: { window: { x0, y0, x1, y1 } } }) => [x0, y0, x1, y1];
