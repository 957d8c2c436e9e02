// Thrust at each rotor at the moment shown: command times thrust ratio, the ratio as a number above the arrow.

import {s, set_attributes} from "./dom.js";
import {number} from "./format.js";
import {pose_at, to_plane} from "./model.js";

/** Thrust and mean thrust ratio of the rotors that coincide in the plane. */
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

/** Width of a thrust ratio with the room around it, in pixels. */
const label_width = 42;

/**
 * Middles of things `width` wide, in the order of the places that they would like: side by side where these are nearer to
 * each other, and within `left` and `right` where there is room.
 */
export function spread(wanted, width, left, right) {
    // Things that touch form a block, which stands where its members want it on average.
    const blocks = [];
    for (const place of wanted) {
        let block = {sum: place, count: 1};
        for (let last = blocks.at(-1); last && end_of(last, width) > start_of(block, width); last = blocks.at(-1)) {
            blocks.pop();
            block = {sum: last.sum + block.sum, count: last.count + block.count};
        }
        blocks.push(block);
    }
    return blocks.flatMap((block) => {
        const half = (block.count * width) / 2;
        const middle = Math.max(left + half, Math.min(right - half, block.sum / block.count));
        return Array.from({length: block.count}, (_, i) => middle + (i - (block.count - 1) / 2) * width);
    });
}

const start_of = ({sum, count}, width) => sum / count - (count * width) / 2;
const end_of = ({sum, count}, width) => sum / count + (count * width) / 2;

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
    const leftmost_first = rotor_groups.map((group, index) => [group.x_m, index]).sort((a, b) => a[0] - b[0]);
    const draw = () => {
        const row = clock.row, pose = pose_at(data, row);
        const tips = [];
        rotor_groups.forEach((group, index) => {
            const {thrust_n, factor} = group_thrust(data, group, row);
            const length = thrust_n * meters_per_n;
            const from = view.to_pixels(...to_plane(pose, [group.x_m, group.z_m]));
            const to = view.to_pixels(...to_plane(pose, [group.x_m, group.z_m + length]));
            const angle = (Math.atan2(to[1] - from[1], to[0] - from[0]) * 180) / Math.PI;
            const {shaft, head, text} = arrows[index];
            shaft.setAttribute("d", `M${from[0]} ${from[1]}L${to[0]} ${to[1]}`);
            set_attributes(head, {d: "M2 0L-7 -4L-7 4Z", transform: `translate(${to[0]} ${to[1]}) rotate(${angle})`});
            text.textContent = `×${number(factor, ".2f")}`;
            tips.push(to);
        });
        // In one row above all arrows, in their order: numbers beside each other would touch on a small screen.
        const [left, top, right] = view.inside;
        const y = Math.max(top + 8, Math.min(...tips.map((tip) => tip[1])) - 9);
        const places = spread(leftmost_first.map(([, index]) => tips[index][0]), label_width, left, right);
        leftmost_first.forEach(([, index], i) => set_attributes(arrows[index].text, {x: places[i], y}));
    };
    return {element, draw, meters_per_n, words: arrows.map(({text}) => text)};
}

/** What the arrows mean, in words. */
export function forces_note({rotor_groups}) {
    const shared = rotor_groups.filter((group) => group.rotors.length > 1)
                       .map((group) => group.rotors.map((rotor) => rotor + 1).join(" and "));
    const note = "Arrows: thrust of the rotors, command times thrust ratio K; the number is K.";
    return shared.length > 0 ?
        `${note} Rotors ${shared.join("; ")} coincide in this view: one arrow for their sum, with their mean K.` :
        note;
}
