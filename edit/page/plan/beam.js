// A lamp's beam as it lies on a plan view: the hull of the apex and of the circle at its end.

import { add, along, normalize, perpendiculars, scale } from "../base/vec.js";

const CORNERS = 32;
const WIDEST = 85; // degrees from the axis to which a beam is drawn as a cone

/** Corners of the beam's outline in plan coordinates; empty of lamps that have no beam. */
export function beamOutline(lamp, viewport, metres) {
    if (lamp.half_angle === null) return [];
    const angle = (Math.min(lamp.half_angle, WIDEST) * Math.PI) / 180;
    const axis = normalize(lamp.world_direction);
    const [first, second] = perpendiculars(axis);
    const middle = along(lamp.world_position, axis, metres * Math.cos(angle));
    const radius = metres * Math.sin(angle);
    const points = [lamp.world_position];
    for (let i = 0; i < CORNERS; ++i) {
        const turn = (i / CORNERS) * 2 * Math.PI;
        points.push(add(middle, add(scale(first, radius * Math.cos(turn)),
            scale(second, radius * Math.sin(turn)))));
    }
    return convexHull(points.map((point) => viewport.toPlan(point)));
}

/** Counter-clockwise (Andrew's monotone chain). */
function convexHull(points) {
    const sorted = [...points].sort((a, b) => a[0] - b[0] || a[1] - b[1]);
    const turns = (o, a, b) => (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0]);
    const chain = (ordered) => {
        const hull = [];
        for (const point of ordered) {
            while (hull.length > 1 && turns(hull.at(-2), hull.at(-1), point) <= 0) hull.pop();
            hull.push(point);
        }
        return hull.slice(0, -1);
    };
    return [...chain(sorted), ...chain(sorted.reverse())];
}
