// Where a dragged lamp comes to rest.

import { roundTo } from "../base/numbers.js";
import { nearestOnSegment } from "../base/vec.js";

/** `point` on the grid (in the plane of `axes` alone), on the bar, or where it is. */
export function snapped(point, axes, { snap, grid, bar }) {
    if (snap === "bar" && bar) return nearestOnSegment(point, bar.from, bar.to);
    if (snap !== "grid") return point;
    return point.map((value, k) => {
        const inPlane = axes.right.vector[k] !== 0 || axes.up.vector[k] !== 0;
        return inPlane ? roundTo(value, grid) : value;
    });
}
