// What the camera of the view in space sees, and how keys move it.

import {OrbitControls} from "orbit-controls";
import * as three from "three";

import {extent_of} from "../numbers.js";

/** How far from `target` a camera that looks along `direction` sees all the points. */
function distance_for(points, target, direction, camera) {
    const up = Math.tan((camera.fov * Math.PI) / 360), across = up * camera.aspect;
    const right_axis = new three.Vector3().crossVectors(direction, camera.up).normalize();
    const up_axis = new three.Vector3().crossVectors(right_axis, direction);
    return Math.max(...points.map((point) => {
        const from = point.clone().sub(target);
        return Math.max(Math.abs(from.dot(right_axis)) / across, Math.abs(from.dot(up_axis)) / up) - from.dot(direction);
    }));
}

/** Whether something hangs over most of the extent, so that it is seen best from below. */
function is_covered({x_m, z_m}, obstacles) {
    const middle = (z_m[0] + z_m[1]) / 2;
    const covered = obstacles.some(({section}) => {
        const over = section.length > 0 ? extent_of(section) : null;
        return over && over.z_m[0] > middle && over.x_m[0] < x_m[0] + (x_m[1] - x_m[0]) / 4 &&
            over.x_m[1] > x_m[1] - (x_m[1] - x_m[0]) / 4;
    });
    return covered;
}

/**
 * What is seen first of the plane of motion.
 * @param {{x_m: [number, number], z_m: [number, number]}} extent
 * @param {number} width_m of the vehicle across the plane
 */
export function planar_view(extent, width_m, obstacles) {
    const {x_m, z_m} = extent;
    return {
        target: new three.Vector3((x_m[0] + x_m[1]) / 2, 0, (z_m[0] + z_m[1]) / 2),
        size: Math.max(x_m[1] - x_m[0], z_m[1] - z_m[0]),
        corners: x_m.flatMap(
            (x) => z_m.flatMap((z) => [-width_m / 2, width_m / 2].map((y) => new three.Vector3(x, y, z)))),
        direction: new three.Vector3(0.22, 1, is_covered(extent, obstacles) ? 0.2 : -0.32).normalize(),
    };
}

/**
 * @param {{target: three.Vector3, size: number, corners: three.Vector3[], direction: three.Vector3}} first what is seen
 *     first: its middle, its size in metres, what has to be in the picture, and where the camera looks
 */
export function make_camera(canvas, {target, size, corners, direction}, render) {
    const camera = new three.PerspectiveCamera(40, 2, Math.min(0.05, 0.02 * size), 60 * size);
    camera.up.set(0, 0, 1);
    const controls = new OrbitControls(camera, canvas);
    controls.enableKeys = false;
    controls.minDistance = Math.min(0.5, 0.3 * size);
    controls.maxDistance = 20 * size;
    controls.addEventListener("change", render);

    const look_at = (point, distance, along = direction) => {
        controls.target.copy(point);
        camera.position.copy(point).addScaledVector(along, -distance);
        controls.update();
        render();
    };
    /** All that is seen first, along another direction. */
    const look_along = (along) => look_at(target, 1.04 * distance_for(corners, target, along, camera), along);
    const home = () => look_along(direction);
    const move_to = (point) => {
        const by = point.clone().sub(controls.target);
        camera.position.add(by);
        controls.target.add(by);
        controls.update();
        render();
    };
    const zoom_by = (factor) => {
        const offset = camera.position.clone().sub(controls.target);
        camera.position.copy(controls.target).addScaledVector(offset, 1 / factor);
        controls.update();
        render();
    };
    // The controls know keys for moving only; turning by key goes round the target in steps.
    canvas.addEventListener("keydown", (pressed) => {
        const turns = {a: [-0.12, 0], d: [0.12, 0], w: [0, -0.1], s: [0, 0.1]};
        const key = pressed.key.toLowerCase();
        const offset = camera.position.clone().sub(controls.target);
        if (pressed.ctrlKey || pressed.metaKey || pressed.altKey) {
            return;
        }
        if (turns[key]) {
            const [around, down] = turns[key];
            offset.applyAxisAngle(camera.up, around);
            const side = new three.Vector3().crossVectors(camera.up, offset).normalize();
            const polar = offset.angleTo(camera.up) + down;
            if (polar > 0.05 && polar < Math.PI - 0.05) {
                offset.applyAxisAngle(side, down);
            }
        } else if (key === "+" || key === "=" || key === "-") {
            zoom_by(key === "-" ? 1 / 1.15 : 1.15);
            return;
        } else if (key === "0") {
            home();
            return;
        } else {
            return;
        }
        pressed.preventDefault();
        camera.position.copy(controls.target).add(offset);
        controls.update();
        render();
    });
    return {camera, home, look_along, look_at, move_to, zoom_by};
}
