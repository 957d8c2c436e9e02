// Obstacles, bounds, goals and the start: what stands still.

import {s} from "./dom.js";
import {ring, vehicle_at} from "./vehicle.js";

const rings = (list) => list.map(ring).join("");

/** Hatching keeps its width in pixels whatever the zoom. */
export function make_hatches(view) {
    const hatch = (id, step, angle) =>
        s("pattern", {id, width: step, height: step, patternUnits: "userSpaceOnUse"},
          s("path", {class: id, d: `M0 ${step / 2}H${step}`}));
    const beside = hatch("hatch-beside", 6), blocked = hatch("hatch-blocked", 5);
    view.svg.querySelector("defs").append(beside, blocked);
    view.follow(() => {
        const unit = 1 / view.pixels_per_m;
        beside.setAttribute("patternTransform", `scale(${unit}) rotate(45)`);
        blocked.setAttribute("patternTransform", `scale(${unit}) rotate(-45)`);
    });
}

/** Open surfaces have no inside: where the plane meets them there are lines. */
const open_lines = (obstacle) =>
    (obstacle.section_lines ?? []).map((line) => `M${line.map(([x, z]) => `${x} ${z}`).join("L")}`).join("");

export const is_cut = (obstacle) => obstacle.section.length > 0 || (obstacle.section_lines ?? []).length > 0;

/** So many that a browser cannot move an element for each. */
export const are_many = (obstacles) => obstacles.length > 2000;

/** An element for each of the obstacles, or one for all of very many, in which those that overlap are no holes. */
export function draw_obstacles(obstacles) {
    const is_one = are_many(obstacles), rule = is_one ? "nonzero" : "evenodd";
    const drawn = (list, draw) => (is_one ? [list] : list.map((obstacle) => [obstacle])).map(draw);
    const joined = (list, part) => list.map(part).join("");
    const beside = drawn(
        obstacles,
        (list) => s(
            "path", {class: "projection", "fill-rule": rule, d: joined(list, ({projection}) => rings(projection))}));
    const cut = drawn(
        obstacles.filter(is_cut),
        (list) => s(
            "g", null,
            s("path", {class: "section", "fill-rule": rule, d: joined(list, ({section}) => rings(section))}),
            s("path", {class: "section-line", d: joined(list, open_lines)})));
    return s("g", {class: "obstacles"}, beside, cut);
}

export function draw_bounds({x_m, z_m}) {
    return s("rect", {class: "bounds", x: x_m[0], y: z_m[0], width: x_m[1] - x_m[0], height: z_m[1] - z_m[0]});
}

/** Where a goal is, free coordinates drawn over the whole extent; null where it has no tolerance. */
export function goal_region(goal, bounds) {
    if (goal.outline) {
        const corners = goal.outline.flat(), x = corners.map(([x_m]) => x_m), z = corners.map(([, z_m]) => z_m);
        const [low_x, high_x, low_z, high_z] = [Math.min(...x), Math.max(...x), Math.min(...z), Math.max(...z)];
        return {
            x_m: (low_x + high_x) / 2, z_m: (low_z + high_z) / 2,
            half_x: (high_x - low_x) / 2, half_z: (high_z - low_z) / 2, shape: "outline", outline: goal.outline};
    }
    const is_free_x = !Number.isFinite(goal.x_m), is_free_z = !Number.isFinite(goal.z_m);
    const half_x = is_free_x ? (bounds.x_m[1] - bounds.x_m[0]) / 2 : goal.tolerance_x_m;
    const half_z = is_free_z ? (bounds.z_m[1] - bounds.z_m[0]) / 2 : goal.tolerance_z_m;
    const x_m = is_free_x ? (bounds.x_m[0] + bounds.x_m[1]) / 2 : goal.x_m;
    const z_m = is_free_z ? (bounds.z_m[0] + bounds.z_m[1]) / 2 : goal.z_m;
    const shape = goal.is_disc ?? half_x === half_z ? "disc" : "rectangle";
    return {x_m, z_m, half_x, half_z, shape: is_free_x || is_free_z ? "rectangle" : shape};
}

function draw_region({x_m, z_m, half_x, half_z, shape, outline}) {
    if (shape === "outline") {
        return s("path", {class: "goal-region", "fill-rule": "evenodd", d: rings(outline)});
    }
    if (!(half_x > 0) || !(half_z > 0)) {
        return s("circle", {class: "goal-region", cx: x_m, cy: z_m, r: 0.08});
    }
    return shape === "disc" ?
        s("circle", {class: "goal-region", cx: x_m, cy: z_m, r: half_x}) :
        s("rect", {class: "goal-region", x: x_m - half_x, y: z_m - half_z, width: 2 * half_x, height: 2 * half_z});
}

/** The way an end effector has to point at the goal: a shaft that ends at the centre. */
function draw_direction({x_m, z_m, direction_rad}) {
    const x = Math.cos(direction_rad), z = -Math.sin(direction_rad);
    return s("path", {class: "goal-direction", d: `M${x_m - 0.7 * x} ${z_m - 0.7 * z}L${x_m} ${z_m}`});
}

/** How a goal wants the vehicle, without `arm_rad` where any will do; null for a goal of the end effector. */
export const wanted_pose = (goal, {x_m, z_m}) =>
    goal.kind === "state" ? {x_m, z_m, pitch_rad: 0, arm_rad: goal.arm_rad} : null;

export function draw_goals(model) {
    const {goals, robot, rotor_groups} = model;
    return s("g", {class: "goals"}, goals.map((goal) => {
        const region = goal_region(goal, model.scene.bounds);
        const parts = [draw_region(region)];
        const pose = wanted_pose(goal, region);
        if (pose) {
            parts.push(vehicle_at(
                robot, rotor_groups, Number.isFinite(pose.arm_rad) ? "wanted" : "wanted armless",
                {...pose, arm_rad: pose.arm_rad ?? 0}));
        } else if (Number.isFinite(goal.direction_rad)) {
            parts.push(draw_direction(goal));
        }
        return s("g", null, parts);
    }));
}

export function draw_start({start, robot, rotor_groups}) {
    return s(
        "g", {class: "start"},
        vehicle_at(
            robot, rotor_groups, "wanted at-start",
            {x_m: start.x_m, z_m: start.z_m, pitch_rad: 0, arm_rad: start.arm_rad}));
}
