// Where on a plan view a point of the world lies, and back; panning and zooming.

import { sizeFactor } from "../base/dom.js";
import { add, dot, scale } from "../base/vec.js";

const LEAST_ZOOM = 2; // pixels per metre
const MOST_ZOOM = 20000;

/** Pixels at the top, where a view's title is, and at the bottom, where its scale is. */
export const TITLE_PIXELS = 24;
const SCALE_PIXELS = 18;

export class Viewport {
    centre = [0, 0]; // metres, along right and up
    zoom = 60; // pixels per metre
    size = [1, 1]; // pixels

    constructor(axes) {
        this.axes = axes;
    }

    toPlan(point) {
        return [dot(point, this.axes.right.vector), dot(point, this.axes.up.vector)];
    }

    toScreen(point) {
        return this.planToScreen(this.toPlan(point));
    }

    planToScreen([a, b]) {
        return [this.size[0] / 2 + (a - this.centre[0]) * this.zoom,
            this.size[1] / 2 - (b - this.centre[1]) * this.zoom];
    }

    screenToPlan([x, y]) {
        return [this.centre[0] + (x - this.size[0] / 2) / this.zoom,
            this.centre[1] - (y - this.size[1] / 2) / this.zoom];
    }

    /** `point`, moved in the plane of the view by that many pixels. */
    moved(point, [dx, dy]) {
        return add(point, add(scale(this.axes.right.vector, dx / this.zoom),
            scale(this.axes.up.vector, -dy / this.zoom)));
    }

    pan([dx, dy]) {
        this.centre = [this.centre[0] - dx / this.zoom, this.centre[1] + dy / this.zoom];
    }

    /** Zooms such that what is at the pixel `at` stays there. */
    zoomAt(at, factor) {
        const fixed = this.screenToPlan(at);
        this.zoom = Math.min(Math.max(this.zoom * factor, LEAST_ZOOM), MOST_ZOOM);
        const moved = this.screenToPlan(at);
        this.centre = [this.centre[0] + fixed[0] - moved[0], this.centre[1] + fixed[1] - moved[1]];
    }

    /** Shows all of the points, with some room around them, between the title and the scale. */
    fit(points) {
        const plan = points.map((point) => this.toPlan(point));
        const low = [0, 1].map((k) => Math.min(...plan.map((each) => each[k])));
        const high = [0, 1].map((k) => Math.max(...plan.map((each) => each[k])));
        this.centre = [(low[0] + high[0]) / 2, (low[1] + high[1]) / 2];
        const [above, below] = [TITLE_PIXELS, SCALE_PIXELS].map((pixels) => pixels * sizeFactor());
        const free = [this.size[0] * 0.75, Math.max(this.size[1] - above - below, 1) * 0.9];
        const room = [0, 1].map((k) => free[k] / Math.max(high[k] - low[k], 0.2));
        this.zoom = Math.min(Math.max(Math.min(...room), LEAST_ZOOM), MOST_ZOOM);
        this.centre[1] += (above - below) / 2 / this.zoom;
    }
}
