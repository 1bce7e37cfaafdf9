// What a drag in the picture does to a lamp: the change to ask the server for.

import { add, along, dot, length, scale, subtract } from "../base/vec.js";

const LEAST_DEPTH = 5; // metres as if at which a lamp beside or behind the camera is dragged
const METRES_PER_PIXEL_IN_DEPTH = 0.005;
const PIXELS_TO_DOUBLE_DISTANCE = 150;

function metresPerPixel(scene, world) {
    const { camera, image } = scene;
    const depth = dot(subtract(world, camera.position), camera.forward);
    // The frustum's corners are given one metre into the water.
    const [first, second] = camera.frustum;
    return (length(subtract(second, first)) / image.width) * Math.max(depth, LEAST_DEPTH);
}

/** Moves a lamp by (du, dv) pixels of the image, in the plane that the image shows. */
export function moveInPlane(scene, lamp, du, dv) {
    if (lamp.handle.inside) {
        const [u, v] = lamp.handle.pixel;
        return { op: "move_lamp", lamp: lamp.name, pixel: [u + du, v + dv], keep: "z" };
    }
    const metres = metresPerPixel(scene, lamp.world_position);
    const { right, up } = scene.camera;
    const world = add(lamp.world_position, add(scale(right, du * metres), scale(up, -dv * metres)));
    return { op: "move_lamp", lamp: lamp.name, world };
}

/** Moves a lamp away from the camera (dv upwards, negative) or nearer to it. */
export function moveInDepth(scene, lamp, dv) {
    const { position, forward } = scene.camera;
    if (lamp.handle.inside) {
        const distance = length(subtract(lamp.world_position, position));
        return {
            op: "move_lamp", lamp: lamp.name,
            distance: distance * 2 ** (-dv / PIXELS_TO_DOUBLE_DISTANCE),
        };
    }
    return {
        op: "move_lamp", lamp: lamp.name,
        world: along(lamp.world_position, forward, -dv * METRES_PER_PIXEL_IN_DEPTH),
    };
}

/** Points a lamp's axis at what is seen at a pixel. */
export function aimAt(scene, lamp, [u, v]) {
    const { width, height } = scene.image;
    const inside = (value, size) => Math.min(Math.max(value, 0.5), size - 0.5);
    return { op: "aim_lamp", lamp: lamp.name, pixel: [inside(u, width), inside(v, height)] };
}
