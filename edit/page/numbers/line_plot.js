// A plot of curves over a common axis, as SVG: metres or seconds below, values at the left, what the
// pointer is at in words.

import { h, newId, setText, svg } from "../base/dom.js";
import { formatNumber, ticks } from "../base/numbers.js";

const SIZE = [300, 132];
const MARGIN = { left: 42, right: 8, top: 8, bottom: 26 };

/**
 * `curves`: [{name, class, x: [...], y: [...]}]; `marks`: [{name, x, y}]; `logarithmic`: of y;
 * `fromZero`: a linear axis begins at zero. Values
 * that are null or infinite interrupt a curve.
 */
export function linePlot({ title, xLabel, yLabel, curves, marks = [], logarithmic = false,
    fromZero = true }) {
    const shown = (y) => Number.isFinite(y) && y !== null && (!logarithmic || y > 0);
    const xs = curves.flatMap((curve) => curve.x);
    const ys = curves.flatMap((curve) => curve.y.filter(shown));
    const [x0, x1] = [Math.min(...xs), Math.max(...xs)];
    const of = logarithmic ? Math.log10 : (y) => y;
    let y0 = logarithmic ? Math.floor(of(Math.min(...ys))) : Math.min(...(fromZero ? [0] : []), ...ys);
    let y1 = logarithmic ? Math.ceil(of(Math.max(...ys))) : Math.max(...ys);
    if (logarithmic && y1 - y0 > 8) y0 = y1 - 8;
    if (!(y1 > y0)) y1 = y0 + 1;
    const [width, height] = SIZE;
    const toX = (x) => MARGIN.left +
        ((x - x0) / (x1 - x0 || 1)) * (width - MARGIN.left - MARGIN.right);
    const toY = (y) => height - MARGIN.bottom -
        ((of(y) - y0) / (y1 - y0)) * (height - MARGIN.top - MARGIN.bottom);
    const yTicks = logarithmic
        ? ticks(y0, y1, 4).filter(Number.isInteger).map((power) => 10 ** power)
        : ticks(y0, y1, 4);
    const titleId = newId("plot");
    const drawing = svg("svg", { viewBox: `0 0 ${width} ${height}`, class: "plot", role: "img",
        "aria-labelledby": titleId });
    for (const y of yTicks) {
        drawing.append(svg("line", { class: "grid", x1: MARGIN.left, x2: width - MARGIN.right,
            y1: toY(y), y2: toY(y) }),
        svg("text", { class: "tick", x: MARGIN.left - 5, y: toY(y) + 3, "text-anchor": "end" },
            formatNumber(y, 3)));
    }
    for (const x of ticks(x0, x1, 6)) {
        drawing.append(svg("line", { class: "grid", x1: toX(x), x2: toX(x), y1: MARGIN.top,
            y2: height - MARGIN.bottom }),
        svg("text", { class: "tick", x: toX(x), y: height - MARGIN.bottom + 11,
            "text-anchor": "middle" }, formatNumber(x, 3)));
    }
    drawing.append(svg("text", { class: "tick", x: width - MARGIN.right, y: height - 3,
        "text-anchor": "end" }, xLabel));
    for (const curve of curves) {
        let pen = false;
        const path = curve.x.map((x, i) => {
            if (!shown(curve.y[i])) {
                pen = false;
                return "";
            }
            const step = `${pen ? "L" : "M"}${toX(x).toFixed(1)},${toY(curve.y[i]).toFixed(1)}`;
            pen = true;
            return step;
        }).join("");
        drawing.append(svg("path", { class: `curve ${curve.class}`, d: path }));
    }
    for (const mark of marks) {
        if (!shown(mark.y)) continue;
        drawing.append(svg("circle", { class: `mark ${mark.class}`, cx: toX(mark.x),
            cy: toY(mark.y), r: 3.5 }, svg("title", {}, mark.name)));
    }
    const readout = h("span", { class: "readout" });
    const cursor = svg("line", { class: "cursor", y1: MARGIN.top, y2: height - MARGIN.bottom,
        visibility: "hidden" });
    drawing.append(cursor);
    drawing.addEventListener("pointermove", (event) => {
        const room = drawing.getBoundingClientRect();
        const at = x0 + (((event.clientX - room.left) / room.width) * width - MARGIN.left) /
            (width - MARGIN.left - MARGIN.right) * (x1 - x0);
        const texts = curves.map((curve) => {
            const nearest = curve.x.reduce((best, x, i) =>
                Math.abs(x - at) < Math.abs(curve.x[best] - at) ? i : best, 0);
            cursor.setAttribute("x1", toX(curve.x[nearest]));
            cursor.setAttribute("x2", toX(curve.x[nearest]));
            return `${curve.name} ${formatNumber(curve.y[nearest], 3)} at ` +
                formatNumber(curve.x[nearest], 3);
        });
        cursor.setAttribute("visibility", "visible");
        setText(readout, texts.join(" · "));
    });
    drawing.addEventListener("pointerleave", () => {
        cursor.setAttribute("visibility", "hidden");
        setText(readout, "");
    });
    return h("figure", { class: "plot-figure" },
        h("figcaption", {}, h("span", { id: titleId }, title), " ",
            h("span", { class: "unit" }, yLabel), readout), drawing);
}
