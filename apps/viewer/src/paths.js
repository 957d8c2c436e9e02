// Paths of plan, flight and end effector, the search tree, and the snapshot diagram.

import {s} from "./dom.js";
import {pose_at, reference_at} from "./model.js";
import {between_knots, range_of} from "./numbers.js";
import {vehicle_at} from "./vehicle.js";

/** Rows that a line needs: one per millimetre of way. */
function line(x_m, z_m) {
    let d = "", last_x = NaN, last_z = NaN;
    for (let i = 0; i < x_m.length; ++i) {
        const is_far = !(Math.abs(x_m[i] - last_x) < 1e-3 && Math.abs(z_m[i] - last_z) < 1e-3);
        if (is_far || i === x_m.length - 1) {
            d += `${d ? "L" : "M"}${x_m[i].toFixed(4)} ${z_m[i].toFixed(4)}`;
            last_x = x_m[i];
            last_z = z_m[i];
        }
    }
    return d;
}

/** Where a flight broke off, the rest of the plan is taken from its knots. */
export function draw_planned({data, solution, end_s}) {
    const knots = solution.plan?.reference ?? [];
    const from_s = data ? end_s : -Infinity;
    const x_m = [], z_m = [];
    for (let i = 1; i < knots.length; ++i) {
        const start_s = Math.max(from_s, knots[i - 1].t_s);
        for (let step = 0; step <= 60 && start_s < knots[i].t_s; ++step) {
            const [x, z] = between_knots(knots[i - 1], knots[i], start_s + (step / 60) * (knots[i].t_s - start_s));
            x_m.push(x);
            z_m.push(z);
        }
    }
    return s("path", {class: "path planned", d: (data ? line(data.ref_x_m, data.ref_z_m) : "") + line(x_m, z_m)});
}
export const draw_flown = ({data}) => s("path", {class: "path flown", d: line(data.x_m, data.z_m)});
export const draw_tip = ({data}) => s("path", {class: "path tip", d: line(data.ee_x_m, data.ee_z_m)});

export function draw_waypoints({solution}) {
    const points = solution.plan?.waypoints ?? [];
    return points.map(({x_m, z_m}) => s("circle", {class: "waypoint", cx: x_m, cy: z_m, r: 0.05}));
}

export function draw_tree({tree}) {
    const at = (node) => `${tree.x_m[node].toFixed(3)} ${tree.z_m[node].toFixed(3)}`;
    let d = "";
    for (let i = 0; i < tree.nodes; ++i) {
        const parent = tree.parent[i];
        if (parent >= 0 && parent < tree.nodes) {
            d += `M${at(parent)}L${at(i)}`;
        }
    }
    return s("path", {class: "tree", d});
}

/**
 * Rows at equal steps of motion, not of time: a hold would pile drawings on each other.
 * The last row is the flight's last.
 */
export function snapshot_rows({data, rows, robot}) {
    const half_arm = robot.arm.length_m / 2;
    const way = new Float64Array(rows);
    for (let i = 1; i < rows; ++i) {
        way[i] = way[i - 1] +
            Math.hypot(
                data.ref_x_m[i] - data.ref_x_m[i - 1], data.ref_z_m[i] - data.ref_z_m[i - 1],
                half_arm * (data.ref_arm_rad[i] - data.ref_arm_rad[i - 1]));
    }
    const reach = range_of(robot.bodies.flatMap((body) => body.outline.map(([x]) => x)));
    const width = Math.max(0.3, reach.high - reach.low);
    const steps = Math.min(9, Math.max(1, Math.round(way[rows - 1] / (1.5 * width))));
    const picked = [];
    for (let step = 0, row = 0; step <= steps; ++step) {
        while (row < rows - 1 && way[row] < (way[rows - 1] * step) / steps) {
            ++row;
        }
        picked.push(row);
    }
    picked[0] = 0;
    return [...new Set(picked)];
}

export function draw_snapshots(model, rows) {
    const {robot, rotor_groups, data} = model;
    const draw = (style, pose) => vehicle_at(robot, rotor_groups, `${style} snapshot`, pose);
    return s(
        "g", {class: "snapshots"}, rows.map((row) => draw("planned", reference_at(data, row))),
        rows.map((row) => draw("flown", pose_at(data, row))));
}
