// A level grid below what is seen, and the numbers along its sides.

import {ticks} from "d3-array";
import * as three from "three";

import {place} from "../format.js";

export const ends = (list) => [list[0], list[list.length - 1]];

/** A level grid below all that is seen first, on whole numbers of steps. */
export function floor_of({low, high}) {
    const lines = ticks(0, Math.max(high[0] - low[0], high[1] - low[1]), 10), step_m = lines[1] - lines[0];
    const along = (k) => {
        const first = Math.floor(low[k] / step_m), last = Math.ceil(high[k] / step_m);
        return Array.from({length: last - first + 1}, (_, i) => (first + i) * step_m);
    };
    return {step_m, x_m: along(0), y_m: along(1), z_m: low[2]};
}

export function draw_floor({x_m, y_m, z_m}, paint) {
    const [left, right] = ends(x_m), [near, far] = ends(y_m);
    const points =
        [...x_m.flatMap((x) => [x, near, z_m, x, far, z_m]), ...y_m.flatMap((y) => [left, y, z_m, right, y, z_m])];
    const geometry = new three.BufferGeometry();
    geometry.setAttribute("position", new three.BufferAttribute(new Float32Array(points), 3));
    const material = new three.LineBasicMaterial({transparent: true, opacity: 0.28, depthWrite: false});
    paint(material, "edge");
    return new three.LineSegments(geometry, material);
}

/** Numbers of axes along the sides of the floor that are near, as names in space. */
export function axis_names(floor, {low, high}, direction, most_ticks) {
    const tick = (value) => place(value).replace(/[.]?0+(?=\u00a0)/, "");
    const along = (name, values, at) => {
        const every = Math.ceil(values.length / most_ticks);
        return values.filter((_, i) => i % every === 0)
            .map((value) => ({kind: "of-axis", text: `${name} ${tick(value)}`, at: new three.Vector3(...at(value))}));
    };
    const sides = (values, is_from_low) => is_from_low ? ends(values) : ends(values).reverse();
    const [near_x] = sides(floor.x_m, direction.x > 0), [near_y, far_y] = sides(floor.y_m, direction.y > 0);
    return [
        ...along("x", floor.x_m, (x) => [x, near_y, floor.z_m]),
        ...along("y", floor.y_m.slice(1), (y) => [near_x, y, floor.z_m]),
        ...along("z", ticks(low[2], high[2], Math.min(4, most_ticks)), (z) => [near_x, far_y, z])
    ];
}
