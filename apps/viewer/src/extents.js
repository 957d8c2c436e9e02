// What part of the plane of motion is seen first.

import {range_of} from "./numbers.js";
import {goal_region} from "./surroundings.js";

/**
 * What matters: start, goals, flight, or all of the bounds where nothing flew. With the reach of the arm: bounds are
 * those of the centre of mass, and a ground or wall at them belongs to the picture.
 */
export function opening_of(model) {
    const {bounds} = model.scene;
    const reach = model.robot.arm.length_m;
    const wider = ([low, high]) => [low - 1.25 * reach, high + 1.25 * reach];
    if (!model.data) {
        return {x_m: wider(bounds.x_m), z_m: wider(bounds.z_m)};
    }
    const regions = model.goals.map((goal) => goal_region(goal, bounds));
    const x = [model.start.x_m, ...regions.map((r) => r.x_m)], z = [model.start.z_m, ...regions.map((r) => r.z_m)];
    for (let row = 0; row < model.rows; row += 5) {
        x.push(model.data.x_m[row]);
        z.push(model.data.z_m[row]);
    }
    const around = (values) => {
        const {low, high} = range_of(values);
        return wider([low, high]);
    };
    return {x_m: around(x), z_m: around(z)};
}

export function padded({x_m, z_m}) {
    const pad = 0.04 * Math.max(x_m[1] - x_m[0], z_m[1] - z_m[0]);
    return {x_m: [x_m[0] - pad, x_m[1] + pad], z_m: [z_m[0] - pad, z_m[1] + pad]};
}
