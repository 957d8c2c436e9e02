// Robot, goals and obstacles as tables, and what makes the page again.

import {make_command} from "../command.js";
import {foreign, h} from "../dom.js";
import {degrees, number, place, quantity, seconds} from "../format.js";

export const triple = (list, as = (value) => number(value, ".3~f")) =>
    list.map((value) => value === null ? "free" : as (value)).join(", ");

export function scrolled(name, heads, rows, more = null) {
    return h(
        "div", {class: "scroll", tabindex: "0", role: "region", "aria-label": name},
        h("table", {class: "numbers fact-table"},
          h("thead", null, h("tr", null, heads.map((head) => h("th", {scope: "col"}, head)))),
          h("tbody", null,
            rows.map(
                ([first, ...cells]) =>
                    h("tr", null, h("th", {scope: "row", class: "foreign-name"}, first),
                      cells.map((cell) => h("td", null, cell)))))),
        more);
}

/** The table is made when it is opened. */
export function make_obstacle_table({scene: {obstacles}}) {
    if (obstacles.length === 0) {
        return h("p", {class: "muted"}, "There are no obstacles.");
    }
    const most = 1000, left_out = obstacles.length - most;
    const details = h("details", null, h("summary", null, `The ${obstacles.length} obstacles as a table`));
    const range = ({low_m, high_m}, k) => `${place(low_m[k])} to ${place(high_m[k])}`;
    details.addEventListener(
        "toggle",
        () => details.append(scrolled(
            "Obstacles", ["name", "kind", "x", "y", "z"],
            obstacles.slice(0, most).map(
                (each) => [foreign(each.name), each.kind, ...[0, 1, 2].map((k) => range(each, k))]),
            left_out > 0 ? h("p", {class: "muted"}, `and ${number(left_out, ",d")} more`) : null)),
        {once: true});
    return details;
}

const kinds = {
    end_effector: "end effector at a point",
    pose: "end effector with an attitude",
    camera: "camera that looks at a point",
    configuration: "vehicle and arm",
    contact: "touch",
};

/** What a goal asks for beside its place. */
function demand_of(goal) {
    const cone = (direction, angle) =>
        direction ? `along (${triple(direction)}) within ${degrees(angle)}` : "any direction";
    switch (goal.kind) {
        case "end_effector":
            return cone(goal.direction, goal.direction_tolerance_rad);
        case "pose":
            return `roll, pitch, yaw ${triple(goal.rpy_rad, degrees)} within ${degrees(goal.tolerance_rad)}`;
        case "camera":
            return `from ${place(goal.distance_m[0])} to ${place(goal.distance_m[1])}, ${
                       cone(goal.direction, goal.view_cone_rad)}` +
                `${goal.sees ? ", in sight" : ""}`;
        case "contact":
            return [quantity(goal.force_n, "~r", "N"), " against ", foreign(goal.obstacle)];
        default:
            return [
                goal.yaw_rad !== null ? `yaw ${degrees(goal.yaw_rad)}` : "any yaw",
                goal.joints_rad ? `, joints ${triple(goal.joints_rad, degrees)}` : ""
            ];
    }
}

const orders = {
    in_turn: "visited in this order",
    any_order: "in any order"
};

function make_goals({goals, report}) {
    return h(
        "div", {class: "card"}, h("h3", null, goals.length > 1 ? "Goals" : "Goal"),
        scrolled(
            "Goals", ["goal", "kind", "place [m]", "tolerance", "demands", "held for"],
            goals.map(
                (goal) =>
                    [goal.name, kinds[goal.kind], goal.position_m ? triple(goal.position_m) : "anywhere",
                     goal.tolerance_m !== undefined ? place(goal.tolerance_m) : "–", demand_of(goal),
                     goal.number > 0 ? seconds(goal.hold_s) : "–"])),
        orders[report.goal_order] ? h("p", {class: "muted"}, orders[report.goal_order]) : null);
}

function make_robot({robot}) {
    const {facts} = robot;
    const row = (name, value) => h("tr", null, h("th", {scope: "row"}, name), h("td", null, value));
    return h(
        "div", {class: "card"}, h("h3", null, "Robot ", foreign(robot.name)),
        h("table", {class: "numbers"},
          h("tbody", null, row("mass, with arm", quantity(facts.mass_kg, ".3~f", "kg")),
            row("thrust over weight", number(facts.thrust_to_weight, ".2f")),
            row("reach of the end effector", place(facts.reach_m)),
            row("greatest share of thrust in a hover", `${number(100 * facts.hover_share, ".0f")} %`))));
}

function make_rotors({robot}) {
    const is_up = ({axis}) => axis[0] === 0 && axis[1] === 0 && axis[2] > 0;
    const has_axes = !robot.rotors.every(is_up);
    return h(
        "div", {class: "card"}, h("h3", null, "Rotors, radius ", place(robot.rotor_radius_m)),
        scrolled(
            "Rotors", ["no.", "place [m]", ...(has_axes ? ["axis"] : []), "turns", "thrust [N]"],
            robot.rotors.map(
                (rotor, i) =>
                    [String(i + 1), triple(rotor.position_m), ...(has_axes ? [triple(rotor.axis)] : []),
                     rotor.spin > 0 ? "left" : "right",
                     `${number(rotor.min_thrust_n, ".3~f")} to ${number(rotor.max_thrust_n, ".3~f")}`])));
}

/** The joints of an arm, also for the page of a robot. */
export function make_joints({robot}) {
    if (robot.links.length === 0) {
        return null;
    }
    return h(
        "div", {class: "card"}, h("h3", null, "Joints"),
        scrolled(
            "Joints", ["no.", "place [m]", "axis", "limits", "torque"],
            robot.links.map(
                (link, i) =>
                    [String(i + 1), triple(link.joint_m), triple(link.axis),
                     link.limits_rad ? link.limits_rad.map(degrees).join(" to ") : "none",
                     quantity(link.max_torque_nm, ".3~f", "N m")])));
}

export function make_facts(model) {
    return h(
        "section", {class: "facts-of-space", "aria-labelledby": "facts-title"},
        h("h2", {id: "facts-title"}, "Goals and robot"),
        h("div", {class: "space-cards"}, make_goals(model), make_robot(model), make_joints(model), make_rotors(model)));
}

export function make_repeat({report, solution}) {
    const row = (name, value) => h("div", null, h("dt", null, name), h("dd", null, value));
    const {problem} = solution;
    return h(
        "section", {class: "repeat", "aria-labelledby": "repeat-title"},
        h("h2", {id: "repeat-title"}, report.command ? "To repeat" : "Problem and settings"),
        report.command ? make_command(report.command) : null,
        h("dl", {class: "pairs"}, row("version", `downwash ${report.version ?? "–"}`),
          problem?.file ? row("problem", foreign(problem.file)) : null,
          problem?.sha256 ? row("SHA-256 of the problem", h("code", {class: "hash"}, foreign(problem.sha256))) : null),
        report.effective_yaml ?
            h("details", {class: "yaml"}, h("summary", null, "Effective parameters, every default filled in"),
              h("pre", {tabindex: "0", role: "region", "aria-label": "Effective parameters"},
                h("code", null, foreign(report.effective_yaml)))) :
            null);
}
