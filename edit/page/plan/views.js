// The three plan views. Each looks along an axis of the world: up, forward and right are those of the
// camera, as nearly as the world's axes have them.

import { dot } from "../base/vec.js";

const AXES = [
    { vector: [1, 0, 0], name: "x" }, { vector: [-1, 0, 0], name: "−x" },
    { vector: [0, 1, 0], name: "y" }, { vector: [0, -1, 0], name: "−y" },
    { vector: [0, 0, 1], name: "z" }, { vector: [0, 0, -1], name: "−z" },
];

const nearest = (direction, axes) => axes.reduce((best, axis) =>
    dot(axis.vector, direction) > dot(best.vector, direction) ? axis : best);

/** The world's axes on paper: `right` and `up`, each {vector, name}. */
export function viewAxes(camera) {
    const up = nearest(camera.up, AXES);
    const level = AXES.filter((axis) => dot(axis.vector, up.vector) === 0);
    const forward = nearest(camera.forward, level);
    const across = level.filter((axis) => dot(axis.vector, forward.vector) === 0);
    const right = nearest(camera.right, across);
    return {
        top: { right, up: forward },
        side: { right: forward, up },
        front: { right, up },
    };
}

export const VIEW_LABELS = {
    top: "Top", side: "Side", front: "Front",
};
