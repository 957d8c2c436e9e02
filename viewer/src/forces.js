// Thrust at each rotor at the moment shown: command times aero factor, the factor as a number beside the arrow.

import {s, set_attributes} from "./dom.js";
import {number} from "./format.js";
import {pose_at, to_plane} from "./model.js";

/** Thrust and factor of the rotors that coincide in the plane. */
export function group_thrust(data, group, row) {
    let thrust_n = 0, factors = [];
    for (const rotor of group.rotors) {
        const command_n = data[`rotor_${rotor + 1}_cmd_n`]?.[row] ?? 0;
        const factor = data[`rotor_${rotor + 1}_aero_factor`]?.[row] ?? 1;
        thrust_n += command_n * factor;
        factors.push(factor);
    }
    return {thrust_n, factor: factors.reduce((sum, f) => sum + f, 0) / factors.length};
}

export function make_forces(model, clock, view) {
    const {data, rotor_groups, robot} = model;
    const most_n = Math.max(1, ...rotor_groups.map((group) => {
        let most = 0;
        for (let row = 0; row < model.rows; ++row) {
            most = Math.max(most, group_thrust(data, group, row).thrust_n);
        }
        return most;
    }));
    // The longest arrow is about as long as the arm, so that arrows belong to the vehicle at any zoom.
    const meters_per_n = (0.85 * robot.arm.length_m) / most_n;
    const arrows = rotor_groups.map(() => ({
                                        shaft: s("path", {class: "force"}),
                                        head: s("path", {class: "force-head"}),
                                        text: s("text", {class: "word of-force", "text-anchor": "middle"}),
                                    }));
    const element = s("g", {class: "forces"}, arrows.map(({shaft, head, text}) => s("g", null, shaft, head, text)));
    const draw = () => {
        const row = clock.row, pose = pose_at(data, row);
        rotor_groups.forEach((group, index) => {
            const {thrust_n, factor} = group_thrust(data, group, row);
            const length = thrust_n * meters_per_n;
            const from = view.to_pixels(...to_plane(pose, [group.x_m, group.z_m]));
            const to = view.to_pixels(...to_plane(pose, [group.x_m, group.z_m + length]));
            const angle = (Math.atan2(to[1] - from[1], to[0] - from[0]) * 180) / Math.PI;
            const {shaft, head, text} = arrows[index];
            shaft.setAttribute("d", `M${from[0]} ${from[1]}L${to[0]} ${to[1]}`);
            set_attributes(head, {d: "M2 0L-7 -4L-7 4Z", transform: `translate(${to[0]} ${to[1]}) rotate(${angle})`});
            // Two numbers beside each other would touch on a small screen.
            const aside = Math.sign(group.x_m) * Math.max(0, 22 - Math.abs(group.x_m) * view.pixels_per_m);
            set_attributes(text, {x: to[0] + aside, y: to[1] - 9});
            text.textContent = `×${number(factor, ".2f")}`;
        });
    };
    return {element, draw, meters_per_n, words: arrows.map(({text}) => text)};
}

/** What the arrows mean, in words. */
export function forces_note({rotor_groups}) {
    const shared = rotor_groups.filter((group) => group.rotors.length > 1)
                       .map((group) => group.rotors.map((rotor) => rotor + 1).join(" and "));
    const note = "Arrows: thrust of the rotors, command times aero factor; the number is the factor.";
    return shared.length > 0 ?
        `${note} Rotors ${shared.join("; ")} coincide in this view: one arrow for their sum, with their mean factor.` :
        note;
}
