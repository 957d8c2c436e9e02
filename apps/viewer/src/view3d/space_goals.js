// Goals in space: where the end effector or the vehicle has to be, and which way it has to point.

import * as three from "three";

import {draw_space_robot} from "./space_robot.js";

const vector = (list) => new three.Vector3(...list);

/** Where a goal is; free coordinates are in the middle of the bounds. A touch without a place is at its obstacle. */
export function place_of(goal, {bounds, obstacles}) {
    const middle = bounds.low_m.map((low, k) => (low + bounds.high_m[k]) / 2);
    if (goal.kind === "contact" && !goal.position_m) {
        const touched = obstacles.find(({name}) => name === goal.obstacle);
        return touched ? touched.low_m.map((low, k) => (low + touched.high_m[k]) / 2) : middle;
    }
    return middle.map((value, k) => goal.position_m?.[k] ?? value);
}

/** How far a goal reaches around its place. */
export const reach_of = (goal) => goal.kind === "camera" ? goal.distance_m[1] : goal.tolerance_m;

function draw_ball(radius_m, paint, opacity) {
    const material = new three.MeshBasicMaterial({transparent: true, opacity, depthWrite: false});
    paint(material, "goal");
    return new three.Mesh(new three.SphereBufferGeometry(radius_m, 24, 16), material);
}

function draw_arrow(from, way, length_m, paint) {
    const arrow = new three.ArrowHelper(way, from, length_m, 0.22 * length_m, 0.12 * length_m);
    [arrow.line, arrow.cone].forEach((part) => paint(part.material, "goal"));
    return arrow;
}

/** Where a camera may stand: a cone that opens against the direction of view, or all around. */
function draw_view(goal, paint) {
    const [, farthest_m] = goal.distance_m;
    const material = new three.MeshBasicMaterial({wireframe: true, transparent: true, opacity: 0.16});
    paint(material, "goal");
    if (!goal.direction) {
        return new three.Mesh(new three.SphereBufferGeometry(farthest_m, 18, 10), material);
    }
    const half = Math.min(goal.view_cone_rad, 1.5);
    const cone = new three.Mesh(
        new three.ConeBufferGeometry(farthest_m * Math.sin(half), farthest_m * Math.cos(half), 24, 1, true), material);
    // Its top is at the target, its bottom where the camera is.
    const group = new three.Group();
    cone.position.y = (-farthest_m * Math.cos(half)) / 2;
    group.add(cone);
    group.quaternion.setFromUnitVectors(new three.Vector3(0, 1, 0), vector(goal.direction).normalize());
    return group;
}

/** The direction of the tool that a goal asks for, in the world; null where it is free. */
function wanted_direction(goal, robot) {
    if (goal.kind === "pose") {
        const [roll, pitch, yaw] = goal.rpy_rad;
        return vector(robot.tool_direction).applyEuler(new three.Euler(roll, pitch, yaw, "ZYX"));
    }
    return goal.direction ? vector(goal.direction).normalize() : null;
}

/** @param {number} size_m of the vehicle */
export function draw_goal(goal, scene, robot, size_m, paint) {
    const group = new three.Group();
    group.position.copy(vector(place_of(goal, scene)));
    const is_configuration = goal.kind === "configuration";
    const ball = draw_ball(
        Math.max(0.04 * size_m, goal.kind === "camera" ? 0.1 * size_m : goal.tolerance_m), paint,
        is_configuration ? 0.25 : 0.5);
    group.add(ball);
    if (is_configuration) {
        const ghost = draw_space_robot(robot, (material) => paint(material, "goal"), {is_ghost: true});
        const half = (goal.yaw_rad ?? 0) / 2;
        ghost.move({
            position_m: [0, 0, 0],
            attitude: [Math.cos(half), 0, 0, Math.sin(half)],
            joints_rad: goal.joints_rad ?? robot.links.map(() => 0)
        });
        group.add(ghost.body);
    }
    if (goal.kind === "camera") {
        group.add(draw_view(goal, paint));
    }
    const direction = wanted_direction(goal, robot);
    if (direction) {
        group.add(draw_arrow(direction.clone().multiplyScalar(-1.2 * size_m), direction, 1.2 * size_m, paint));
    }
    return {group, ball};
}
