// What the page of a robot works on: the data, and what of it depends on the pose of the arm.

import {read_embedded} from "../embedded.js";

export const schema = "downwash/robot-report/v1";

export function read_report(text) { return read_embedded(text, schema, "robot", ["robot", "pose", "hover", "facts"]); }

const plus = (a, b) => a.map((value, k) => value + b[k]);
const times = (factor, a) => a.map((value) => factor * value);
const dot = (a, b) => a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

/** The rotation about an axis, by Rodrigues' formula. */
function rotation(axis, angle_rad) {
    const unit = times(1 / Math.hypot(...axis), axis), cosine = Math.cos(angle_rad), sine = Math.sin(angle_rad);
    return (v) => plus(
        plus(times(cosine, v), times(sine, cross(unit, v))), times((1 - cosine) * dot(unit, v), unit));
}

/** How large the robot is: as far as its rotors or its arm reach. */
function size_of({links, rotors, rotor_radius_m}, {reach_m}) {
    const width_m = rotor_radius_m + Math.max(...rotors.map(({position_m}) => Math.hypot(...position_m)));
    return Math.max(links.length > 0 ? reach_m : 0, width_m);
}

/** @param {any} report */
export function build_model(report) {
    const {robot, facts, hover} = report, {links, rotors} = robot;
    /** Where masses are and what rotors give in a hover with the joints at some angles; in the multirotor's frame. */
    const at = (joints_rad) => {
        let turn = (v) => v, joint_m = [0, 0, 0], moment = [0, 0, 0];
        const centers_m = links.map((link, i) => {
            const before = turn, turned = rotation(link.axis, joints_rad[i]);
            joint_m = plus(joint_m, before(link.joint_m));
            turn = (v) => before(turned(v));
            const center_m = plus(joint_m, turn(link.center_of_mass_m));
            moment = plus(moment, times(link.mass_kg, center_m));
            return center_m;
        });
        const whole_m = times(1 / facts.mass_kg, moment);
        const thrusts_n = rotors.map(
            (_, k) => hover.middle_n[k] + whole_m[0] * hover.forward_n_m[k] + whole_m[1] * hover.left_n_m[k]);
        return {
            joints_rad,
            centers_m,
            whole_m,
            tip_m: plus(joint_m, turn(robot.end_effector_m)),
            thrusts_n,
            shares: thrusts_n.map((thrust_n, k) => thrust_n / rotors[k].max_thrust_n),
        };
    };
    return {report, robot, facts, hover, joints: links.length, size_m: size_of(robot, facts), at};
}

/** The pose that is shown: whoever follows it is told of every change. */
export function make_pose(model) {
    const followers = [];
    let state = model.at(model.report.pose.joints_rad);
    const set = (joints_rad) => {
        state = model.at(joints_rad);
        followers.forEach((follower) => follower(state));
    };
    return {
        get state() { return state; },
        follow(follower) {
            followers.push(follower);
            follower(state);
        },
        set,
        turn: (joint, angle_rad) => set(state.joints_rad.map((old, i) => i === joint ? angle_rad : old)),
    };
}
