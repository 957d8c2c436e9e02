// Vehicle and arm as a drawing in metres.

import {s} from "./dom.js";
import {to_plane} from "./model.js";

/** The body frame (a forward, c up) turned and moved: pitch is positive nose down. */
function frame_transform({x_m, z_m, pitch_rad}) {
    const cos = Math.cos(pitch_rad), sin = Math.sin(pitch_rad);
    return `matrix(${[cos, -sin, sin, cos, x_m, z_m].join(" ")})`;
}

function arm_transform([x, z], arm_rad) {
    const cos = Math.cos(arm_rad), sin = Math.sin(arm_rad);
    return `matrix(${[cos, -sin, sin, cos, x, z].join(" ")})`;
}

export const ring = (points) => `M${points.map(([x, z]) => `${x} ${z}`).join("L")}Z`;

/**
 * @param {any} robot
 * @param {string} style class of the group: "flown", "planned", ...
 * @returns {{element: SVGElement, move: (pose: {x_m: number, z_m: number, pitch_rad: number, arm_rad: number}) =>
 *     void}}
 */
export function make_vehicle(robot, rotor_groups, style) {
    const {arm, rotors} = robot;
    const tip = s("circle", {class: "tip", cx: arm.length_m, cy: 0, r: Math.max(0.035, 1.6 * arm.radius_m)});
    const arm_group = s("g", null, s("path", {class: "arm", d: `M0 0H${arm.length_m}`}), tip);
    const discs =
        rotor_groups.map(({x_m, z_m}) => `M${x_m - rotors.radius_m} ${z_m}H${x_m + rotors.radius_m}`).join("");
    const masts = rotor_groups.map(({x_m, z_m}) => `M${x_m} ${z_m}V${z_m - 0.06}`).join("");
    const element = s(
        "g", {class: `vehicle ${style}`}, robot.bodies.map((body) => s("path", {class: "body", d: ring(body.outline)})),
        s("path", {class: "mast", d: masts}), s("path", {class: "disc", d: discs}), arm_group,
        s("circle", {class: "joint", cx: arm.joint_m[0], cy: arm.joint_m[1], r: Math.max(0.03, 1.2 * arm.radius_m)}));
    return {
        element,
        move(pose) {
            element.setAttribute("transform", frame_transform(pose));
            arm_group.setAttribute("transform", arm_transform(arm.joint_m, pose.arm_rad));
        },
    };
}

export function vehicle_at(robot, rotor_groups, style, pose) {
    const vehicle = make_vehicle(robot, rotor_groups, style);
    vehicle.move(pose);
    return vehicle.element;
}

/**
 * What a vehicle covers, as boxes [left, top, right, bottom] in pixels: bodies, rotors, and the arm, if its angle is known, as
 * a row of small ones.
 * @param {import("./view.js").View} view
 */
export function vehicle_boxes(view, {arm, bodies, rotors}, rotor_groups, pose) {
    const room = 2;
    const box_around = (points) => {
        const pixels = points.map((point) => view.to_pixels(...to_plane(pose, point)));
        const x = pixels.map(([x]) => x), y = pixels.map(([, y]) => y);
        return [Math.min(...x) - room, Math.min(...y) - room, Math.max(...x) + room, Math.max(...y) + room];
    };
    const count = Number.isFinite(pose.arm_rad) ? Math.min(40, Math.ceil((arm.length_m * view.pixels_per_m) / 8)) : 0;
    const along = (i) => {
        const length_m = (arm.length_m * i) / count;
        return [
            arm.joint_m[0] + length_m * Math.cos(pose.arm_rad), arm.joint_m[1] - length_m * Math.sin(pose.arm_rad)
        ];
    };
    return [
        ...bodies.map(({outline}) => box_around(outline)),
        ...rotor_groups.map(
            ({x_m, z_m}) => box_around([[x_m - rotors.radius_m, z_m], [x_m + rotors.radius_m, z_m - 0.06]])),
        ...Array.from({length: count}, (_, i) => box_around([along(i), along(i + 1)]))
    ];
}
