// The numbers of a robot as tables; those of a hover follow the pose that is shown.

import {foreign, h} from "../dom.js";
import {degrees, meters, number, quantity} from "../format.js";
import {make_joints, scrolled, triple} from "../space/facts.js";

const percent = (share) => `${number(100 * share, ".0f")}\u00a0%`;

/** A cell whose text follows the pose. */
function live(pose, text_of) {
    const element = h("span", null);
    pose.follow((state) => {
        element.textContent = text_of(state);
    });
    return element;
}

const turning = (spin) => spin === 0 ? "–" : spin > 0 ? "left ↺" : "right ↻";

function make_rotors({robot}, pose) {
    return h(
        "div", {class: "card"}, h("h3", null, "Rotors, radius ", meters(robot.rotor_radius_m)),
        scrolled(
            "Rotors", ["no.", "place [m]", "axis", "turns", "thrust [N]", "hover [N]", "of its greatest"],
            robot.rotors.map(
                (rotor, k) =>
                    [String(k + 1), triple(rotor.position_m), triple(rotor.axis), turning(rotor.spin),
                     `${number(rotor.min_thrust_n, ".3~f")} to ${number(rotor.max_thrust_n, ".3~f")}`,
                     live(pose, ({thrusts_n}) => number(thrusts_n[k], ".3~f")),
                     live(pose, ({shares}) => percent(shares[k]))])));
}

function make_masses({robot, facts, report}, pose) {
    const inertia = (body) => body.inertia_kg_m2 ?
        triple([0, 1, 2].map((k) => body.inertia_kg_m2[k][k]), (value) => number(value, ".3~g")) :
        `pitch ${number(body.pitch_inertia_kg_m2, ".3~g")}`;
    const rows = [
        ["multirotor", quantity(robot.multirotor.mass_kg, ".4~g", "kg"), "0, 0, 0", inertia(robot.multirotor)],
        ...robot.links.map(
            (link, i) =>
                [robot.links.length > 1 ? `link ${i + 1}` : "arm", quantity(link.mass_kg, ".4~g", "kg"),
                 live(pose, ({centers_m}) => triple(centers_m[i])), inertia(link)]),
        ["whole", quantity(facts.mass_kg, ".4~g", "kg"), live(pose, ({whole_m}) => triple(whole_m)), "–"]
    ];
    return h(
        "div", {class: "card"}, h("h3", null, "Masses"),
        scrolled(
            "Masses", ["of", "mass", "centre [m]", report.is_planar ? "inertia [kg m²]" : "ixx, iyy, izz [kg m²]"], rows),
        h("p", {class: "muted"}, "From the multirotor's centre of mass: x forward, y left, z up."));
}

export function make_facts(model, pose) {
    return h(
        "section", {class: "facts-of-space", "aria-labelledby": "facts-title"},
        h("h2", {id: "facts-title"}, "Numbers"),
        h("div", {class: "space-cards"}, make_rotors(model, pose), make_masses(model, pose), make_joints(model)));
}

export function make_figures({facts, joints}, pose) {
    const figure = (name, value, note = "") => h(
        "div", null, h("dt", null, name),
        h("dd", null, h("span", {class: "figure"}, value), note ? h("span", {class: "muted"}, note) : null));
    const worst = facts.hover_joints_rad;
    return h(
        "dl", {class: "figures"}, figure("Mass, with arm", quantity(facts.mass_kg, ".4~g", "kg")),
        figure("Thrust over weight", number(facts.thrust_to_weight, ".2f")),
        joints > 0 ? figure("Reach", meters(facts.reach_m), "from the multirotor's centre of mass") : null,
        figure(
            "Hover, as shown", live(pose, ({shares}) => percent(Math.max(...shares))), "of the weakest rotor's thrust"),
        figure(
            "Hover, worst pose", percent(facts.hover_share),
            `rotor ${facts.hover_rotor + 1}${
                worst.length > 0 ? `, joints at ${worst.map((angle) => degrees(angle)).join(", ")}` : ""}`));
}

export function make_head({report, robot, joints}, theme_switch) {
    const fact = (key, value) => h("span", {class: "fact"}, h("span", {class: "muted"}, key), " ", value);
    return h(
        "header", {class: "head"}, h("div", {class: "head-line"}, h("div", {class: "brand"}, "Downwash"), theme_switch),
        h("h1", null, foreign(robot.name)),
        h("p", {class: "facts"}, fact("file", foreign(report.file)), fact("rotors", String(robot.rotors.length)),
          fact("joints", String(joints)), fact("flies in", report.is_planar ? "a vertical plane" : "space")));
}

export function make_warnings({report: {warnings}}) {
    if (warnings.length === 0) {
        return null;
    }
    return h(
        "section", {class: "robot-warnings"},
        h("h2", null, warnings.length === 1 ? "⚠ A warning" : `⚠ ${warnings.length} warnings`),
        h("ul", null, warnings.map((text) => h("li", null, foreign(text)))));
}
