// What lies behind the lamps in a plan view: grid and metres, outlines of the surfaces, bounds of the
// volumes, the camera with its frustum in the water.

import { sizeFactor } from "../base/dom.js";
import { ticks } from "../base/numbers.js";
import { along, normalize, subtract } from "../base/vec.js";

const FRUSTUM_METRES = 4;
const BOX_EDGES = [
    [0, 1], [0, 2], [0, 4], [1, 3], [1, 5], [2, 3], [2, 6], [3, 7], [4, 5], [4, 6], [5, 7], [6, 7],
];

export const boxCorners = ({ min: low, max: high }) => Array.from({ length: 8 }, (_, i) =>
    [i & 1 ? high[0] : low[0], i & 2 ? high[1] : low[1], i & 4 ? high[2] : low[2]]);

/** The far corners of what the camera sees, as far as it is drawn. */
export const frustumEnds = ({ position, frustum }) => frustum.map((corner) =>
    along(position, normalize(subtract(corner, position)), FRUSTUM_METRES));

function colours(element) {
    const style = getComputedStyle(element);
    const of = (name) => style.getPropertyValue(name).trim();
    return {
        grid: of("--plan-grid"), axis: of("--plan-axis"), text: of("--text-soft"),
        outline: of("--plan-outline"), volume: of("--plan-volume"), camera: of("--plan-camera"),
        back: of("--plan-back"), font: style.fontFamily,
    };
}

export class Backdrop {
    #canvas;
    #context;

    constructor(canvas) {
        this.#canvas = canvas;
        this.#context = canvas.getContext("2d");
    }

    draw(viewport, scene, outlines) {
        const context = this.#context;
        const [width, height] = viewport.size;
        const pixels = viewport.size.map((size) => Math.round(size * devicePixelRatio));
        if (this.#canvas.width !== pixels[0]) this.#canvas.width = pixels[0];
        if (this.#canvas.height !== pixels[1]) this.#canvas.height = pixels[1];
        context.setTransform(devicePixelRatio, 0, 0, devicePixelRatio, 0, 0);
        const colour = colours(this.#canvas);
        context.fillStyle = colour.back;
        context.fillRect(0, 0, width, height);
        this.#lines(viewport, colour);
        this.#segments(viewport, outlines, colour.outline);
        for (const { bounds } of scene.volumes) {
            if (bounds) this.#box(viewport, bounds, colour.volume);
        }
        this.#camera(viewport, scene.camera, colour.camera);
        this.#labels(viewport, colour);
    }

    /** Calls back with the world's coordinate along an axis and the pixel it lies at. */
    #eachTick(viewport, axis, visit) {
        const [width, height] = viewport.size;
        const across = axis === "right";
        const count = Math.max((across ? width : height) / (60 * sizeFactor()), 2);
        const [first, last] = [viewport.screenToPlan([0, height]), viewport.screenToPlan([width, 0])];
        const k = across ? 0 : 1;
        const sign = viewport.axes[axis].name.startsWith("−") ? -1 : 1;
        for (const tick of ticks(first[k], last[k], count)) {
            const at = viewport.planToScreen(across ? [tick, 0] : [0, tick])[k];
            visit(tick * sign, Math.round(at) + 0.5);
        }
    }

    #lines(viewport, colour) {
        const context = this.#context;
        const [width, height] = viewport.size;
        context.lineWidth = 1;
        for (const axis of ["right", "up"]) {
            this.#eachTick(viewport, axis, (value, at) => {
                context.strokeStyle = value === 0 ? colour.axis : colour.grid;
                context.beginPath();
                context.moveTo(axis === "right" ? at : 0, axis === "right" ? 0 : at);
                context.lineTo(axis === "right" ? at : width, axis === "right" ? height : at);
                context.stroke();
            });
        }
    }

    #labels(viewport, colour) {
        const context = this.#context;
        const [width, height] = viewport.size;
        const size = sizeFactor();
        context.font = `${10 * size}px ${colour.font}`;
        context.fillStyle = colour.text;
        context.strokeStyle = colour.back;
        context.lineWidth = 3 * size;
        context.lineJoin = "round";
        const write = (text, x, y) => {
            context.strokeText(text, x, y);
            context.fillText(text, x, y);
        };
        context.textAlign = "center";
        this.#eachTick(viewport, "right", (value, at) => {
            if (at > 34 * size && at < width - 48 * size) {
                write(String(Object.is(value, -0) ? 0 : value), at, height - 5 * size);
            }
        });
        context.textAlign = "left";
        this.#eachTick(viewport, "up", (value, at) => {
            if (at > 24 * size && at < height - 18 * size) {
                write(String(Object.is(value, -0) ? 0 : value), 4 * size, at + 3.5 * size);
            }
        });
        context.textAlign = "right";
        write(`${viewport.axes.right.name.replace("−", "")} [m]`, width - 4 * size, height - 5 * size);
        context.textAlign = "left";
        write(`${viewport.axes.up.name.replace("−", "")} [m]`, 4 * size, 12 * size);
    }

    #segments(viewport, segments, colour) {
        const context = this.#context;
        context.strokeStyle = colour;
        context.lineWidth = 1;
        context.beginPath();
        for (const [x0, y0, z0, x1, y1, z1] of segments) {
            context.moveTo(...viewport.toScreen([x0, y0, z0]));
            context.lineTo(...viewport.toScreen([x1, y1, z1]));
        }
        context.stroke();
    }

    #box(viewport, bounds, colour) {
        const corners = boxCorners(bounds).map((corner) => viewport.toScreen(corner));
        const context = this.#context;
        context.strokeStyle = colour;
        context.setLineDash([5, 4]);
        context.beginPath();
        for (const [from, to] of BOX_EDGES) {
            context.moveTo(...corners[from]);
            context.lineTo(...corners[to]);
        }
        context.stroke();
        context.setLineDash([]);
    }

    #camera(viewport, camera, colour) {
        const context = this.#context;
        const eye = viewport.toScreen(camera.position);
        const ends = frustumEnds(camera).map((end) => viewport.toScreen(end));
        context.strokeStyle = colour;
        context.fillStyle = colour;
        context.lineWidth = 1;
        context.beginPath();
        for (const end of ends) {
            context.moveTo(...eye);
            context.lineTo(...end);
        }
        context.moveTo(...ends.at(-1));
        for (const end of ends) context.lineTo(...end);
        context.globalAlpha = 0.75;
        context.stroke();
        context.globalAlpha = 1;
        context.fillRect(eye[0] - 4, eye[1] - 4, 8, 8);
    }
}
