// What the rest of the page works on: the data, checked and decoded once.

import {decode_flight, decode_map, decode_tree, Trouble} from "./decode.js";
import {read_embedded} from "./embedded.js";

export const schema = "downwash/report/v1";

/** The run of this page, or a Trouble that says why there is none. */
export function read_report(text) {
    return read_embedded(text, schema, "run", ["solution", "scene", "robot", "start", "goals"]);
}

const needed_columns = [
    "t_s",
    "ref_x_m",
    "ref_z_m",
    "ref_arm_rad",
    "x_m",
    "z_m",
    "pitch_rad",
    "arm_rad",
    "clearance_m",
    "ee_x_m",
    "ee_z_m",
    "energy_j",
];

/** Rotors that coincide in the plane of motion, as indices into the robot's list. */
function group_rotors(positions) {
    const groups = new Map();
    positions.forEach(([x, , z], index) => {
        const key = `${x} ${z}`;
        if (!groups.has(key)) {
            groups.set(key, {x_m: x, z_m: z, rotors: []});
        }
        groups.get(key).rotors.push(index);
    });
    return [...groups.values()];
}

/** Equal but for rounding, as of rotors on either side of the plane of motion. */
function are_alike(a, b) {
    return a === b || a.every((value, i) => Math.abs(value - b[i]) <= 1e-9 * Math.abs(value) || Object.is(value, b[i]));
}

/** What each rotor's columns are, alike ones put together: lines that would cover each other are one line. */
export function rotor_lines(data, count, suffix) {
    const lines = [];
    for (let rotor = 0; rotor < count; ++rotor) {
        const values = data[`rotor_${rotor + 1}_${suffix}`];
        if (!values) {
            continue;
        }
        const twin = lines.find((line) => are_alike(line.values, values));
        if (twin) {
            twin.rotors.push(rotor);
        } else {
            lines.push({rotors: [rotor], values});
        }
    }
    return lines;
}

export function objective_text(objective) {
    return typeof objective === "string" ?
        objective :
        Object.entries(objective ?? {}).map(([name, weight]) => `${weight} × ${name}`).join(" + ");
}

/**
 * Where the reference stays at a place, up to the end of the flight, with the goal of each stay: its number among several
 * goals, null where there is only one or where stays are not those of the goals.
 * @returns {{from_s: number, to_s: number, goal: number|null}[]}
 */
function hovers_of(knots, {goals, goal_order}, end_s) {
    const is_same = (a, b) => a.x_m === b.x_m && a.z_m === b.z_m && a.arm_rad === b.arm_rad;
    const hovers = [];
    knots.forEach((knot, i) => {
        const next = knots[i + 1];
        if (!next || is_same(knot, next)) {
            hovers.push({from_s: knot.t_s, to_s: next ? next.t_s : end_s});
        }
    });
    const held = goals.map((goal, i) => [goal, i + 1]).filter(([goal]) => goal.hold_s !== 0);
    const is_of_goals = goal_order === "in_turn" && held.length === hovers.length;
    return hovers.map((hover, i) => ({...hover, goal: is_of_goals ? held[i][1] : null}))
        .filter(({from_s}) => from_s < end_s)
        .map((hover) => ({...hover, to_s: Math.min(hover.to_s, end_s)}));
}

/** @param {any} report */
export async function build_model(report) {
    const [data, tree, levels] = await Promise.all([
        report.flight ? decode_flight(report.flight) : null,
        report.tree ? decode_tree(report.tree) : null,
        report.map ? decode_map(report.map) : null,
    ]);
    const rows = data ? report.flight.rows : 0;
    if (data) {
        const missing = needed_columns.filter((name) => !data[name]);
        if (missing.length > 0 || rows < 1) {
            throw new Trouble(`The flight of this page lacks ${missing.join(", ") || "rows"}.`);
        }
    }
    const {solution, robot} = report;
    const knots = solution.plan?.reference ?? [];
    const outcome = solution.execution?.outcome ?? null;
    const end_s = data ? data.t_s[rows - 1] : 0;
    return {
        report,
        solution,
        robot,
        data,
        rows,
        tree,
        scene: report.scene,
        map: levels ? {...report.map, levels} : null,
        goals: report.goals,
        start: report.start,
        outcome,
        is_good: solution.status === "solved" && outcome === "ok",
        /** The flight ended before its time: its last row is the offending one. */
        is_cut_short: data !== null && ["collision", "unstable", "left_flyable_area"].includes(outcome),
        reference_s: knots.length > 0 ? knots[knots.length - 1].t_s : null,
        hovers: hovers_of(knots, report, end_s),
        cost_unit: report.cost_unit,
        objective: objective_text(solution.objective),
        rotor_groups: group_rotors(robot.rotors.positions_m),
        commands: data ? rotor_lines(data, robot.rotors.positions_m.length, "cmd_n") : [],
        factors: data ? rotor_lines(data, robot.rotors.positions_m.length, "aero_factor") : [],
        end_s,
    };
}

/** Vehicle, arm and reference in row `row`. */
export function pose_at(data, row) {
    return {x_m: data.x_m[row], z_m: data.z_m[row], pitch_rad: data.pitch_rad[row], arm_rad: data.arm_rad[row]};
}

/** The reference has no pitch: it is drawn level. */
export function reference_at(data, row) {
    return {x_m: data.ref_x_m[row], z_m: data.ref_z_m[row], pitch_rad: 0, arm_rad: data.ref_arm_rad[row]};
}

/** A point (a, c) of the body frame in the plane of motion. */
export function to_plane(pose, [a, c]) {
    const cos = Math.cos(pose.pitch_rad), sin = Math.sin(pose.pitch_rad);
    return [pose.x_m + a * cos + c * sin, pose.z_m - a * sin + c * cos];
}
