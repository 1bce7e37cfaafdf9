// The map of an objective: a curve along a bar, or coloured squares for the layers of a box.

import { h, svg } from "../base/dom.js";
import { formatNumber } from "../base/numbers.js";
import { length, subtract } from "../base/vec.js";
import { linePlot } from "../numbers/line_plot.js";
import { RAMP, rampGradient } from "../picture/false_colour.js";

const AXES = ["x", "y", "z"];
const LAYER_WIDTH = 150;

/** `result`: {map: {counts, points}, before, best}; `wish` names the search. */
export function objectiveMap(result, wish, label) {
    return wish.shape === "bar" ? barMap(result, wish, label) : boxMap(result, label);
}

function barMap({ map: { points }, before, best }, wish, label) {
    const along = ({ position }) => length(subtract(position, wish.from));
    return linePlot({
        title: label, xLabel: "along the bar from its beginning [m]", yLabel: "", fromZero: false,
        curves: [{ name: "objective", class: "now", x: points.map(along),
            y: points.map((point) => (point.allowed ? point.value : null)) }],
        marks: [...(isOnBar(before, wish) ? [{ name: "now", class: "before", x: along(before),
            y: before.value }] : []), { name: "best", class: "best", x: along(best), y: best.value }],
    });
}

/** Whether a point lies on the searched line, such that it has a place on its axis. */
function isOnBar({ position }, { from, to }) {
    const detour = length(subtract(position, from)) + length(subtract(to, position));
    return detour - length(subtract(to, from)) < 0.01;
}

function colourOf(value, low, high) {
    const place = high > low ? ((value - low) / (high - low)) * (RAMP.length - 1) : 0;
    const below = Math.min(Math.floor(place), RAMP.length - 2);
    const mixed = RAMP[below].map((from, k) =>
        Math.round(255 * (from + (RAMP[below + 1][k] - from) * (place - below))));
    return `rgb(${mixed.join(" ")})`;
}

function boxMap({ map: { counts, points }, before, best }, label) {
    // The two axes with the most positions make a layer, the third the row of layers.
    const order = [0, 1, 2].sort((a, b) => counts[b] - counts[a] || a - b);
    const [across, down, layered] = [Math.min(order[0], order[1]), Math.max(order[0], order[1]),
        order[2]];
    const allowed = points.filter((point) => point.allowed).map((point) => point.value);
    const [low, high] = [Math.min(...allowed), Math.max(...allowed)];
    const strides = [1, counts[0], counts[0] * counts[1]];
    const cell = LAYER_WIDTH / counts[across];
    const layers = Array.from({ length: counts[layered] }, (_, layer) => {
        const drawing = svg("svg", { class: "layer", role: "img",
            viewBox: `0 0 ${LAYER_WIDTH} ${cell * counts[down]}`,
            "aria-label": `${label}, layer ${layer + 1} of ${counts[layered]}` });
        for (let j = 0; j < counts[down]; ++j) {
            for (let i = 0; i < counts[across]; ++i) {
                const point = points[i * strides[across] + j * strides[down] + layer * strides[layered]];
                if (!point) continue;
                const text = `${formatNumber(point.value, 4)} at ` +
                    `(${point.position.map((each) => formatNumber(each, 3)).join(", ")}) m` +
                    (point.allowed ? "" : ": too dark");
                drawing.append(svg("rect", { x: i * cell, y: j * cell, width: cell, height: cell,
                    class: point.allowed ? "" : "dark",
                    fill: point.allowed ? colourOf(point.value, low, high) : null },
                svg("title", {}, text)));
            }
        }
        const place = points.find((_, index) =>
            Math.floor(index / strides[layered]) % counts[layered] === layer)?.position[layered];
        return h("figure", {}, drawing,
            h("figcaption", {}, `${AXES[layered]} = ${formatNumber(place ?? NaN, 3)} m`));
    });
    return h("div", { class: "box-map" },
        h("p", { class: "hint" }, `${label}; ${AXES[across]} to the right, ${AXES[down]} down. ` +
            `Now ${formatNumber(before.value, 4)}, best ${formatNumber(best.value, 4)}.`),
        h("div", { class: "layers" }, layers),
        h("div", { class: "legend" }, h("span", {}, formatNumber(low, 3)),
            h("span", { class: "legend-bar", style: { background: rampGradient("to right") } }),
            h("span", {}, formatNumber(high, 3))));
}
