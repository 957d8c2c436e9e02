// What the page of a flight in space works on: the data, checked and decoded once.

import {decode_flight, Trouble} from "../decode.js";
import {read_embedded} from "../embedded.js";
import {objective_text, rotor_lines} from "../model.js";

export const schema = "downwash/space-report/v1";

export function read_report(text) {
    return read_embedded(text, schema, "flight", ["scene", "robot", "start", "goals", "limits"]);
}

const needed_columns = [
    "t_s", "ref_x_m", "ref_y_m", "ref_z_m", "ref_yaw_rad", "x_m",         "y_m",    "z_m",    "qw",     "qx",
    "qy",  "qz",      "vx_m_s",  "vy_m_s",  "vz_m_s",      "clearance_m", "ee_x_m", "ee_y_m", "ee_z_m", "energy_j"
];

/** Roll, pitch and yaw of R = Rz(yaw) Ry(pitch) Rx(roll), and the angle between the body's z and the vertical. */
export function angles_of(w, x, y, z) {
    const sine = Math.max(-1, Math.min(1, 2 * (w * y - z * x)));
    return {
        roll: Math.atan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y)),
        pitch: Math.asin(sine),
        yaw: Math.atan2(2 * (w * z + x * y), 1 - 2 * (y * y + z * z)),
        tilt: 2 * Math.asin(Math.min(1, Math.hypot(x, y))),
    };
}

/** Columns that follow from those of the flight. Yaw goes on beyond half a turn, from near its reference. */
function derived(data, rows) {
    const made = Object.fromEntries(["roll_rad", "pitch_rad", "yaw_rad", "tilt_rad", "error_m", "speed_m_s"].map(
        (name) => [name, new Float64Array(rows)]));
    let near = data.ref_yaw_rad[0];
    for (let i = 0; i < rows; ++i) {
        const {roll, pitch, yaw, tilt} = angles_of(data.qw[i], data.qx[i], data.qy[i], data.qz[i]);
        made.roll_rad[i] = roll;
        made.pitch_rad[i] = pitch;
        made.yaw_rad[i] = near = yaw + 2 * Math.PI * Math.round((near - yaw) / (2 * Math.PI));
        made.tilt_rad[i] = tilt;
        made.error_m[i] =
            Math.hypot(data.x_m[i] - data.ref_x_m[i], data.y_m[i] - data.ref_y_m[i], data.z_m[i] - data.ref_z_m[i]);
        made.speed_m_s[i] = Math.hypot(data.vx_m_s[i], data.vy_m_s[i], data.vz_m_s[i]);
    }
    return made;
}

/**
 * Where the reference stays for half a second or more, with the number of the goal of each stay where there is one for
 * each goal of several.
 */
function hovers_of(data, rows, columns, {goals, goal_order}) {
    const hovers = [];
    let from = 0;
    for (let i = 1; i <= rows; ++i) {
        if (i === rows || columns.some((column) => column[i] !== column[i - 1])) {
            if (data.t_s[i - 1] - data.t_s[from] >= 0.5) {
                hovers.push({from_s: data.t_s[from], to_s: data.t_s[i - 1]});
            }
            from = i;
        }
    }
    const count = Math.max(0, ...goals.map(({number}) => number));
    const is_of_goals = goal_order === "in_turn" && hovers.length === count;
    return hovers.map((hover, i) => ({...hover, goal: is_of_goals ? i + 1 : null}));
}

/** How large the robot is: as far as rotors and arm reach at most, or the goal would be hidden by it. */
function size_of({rotors, rotor_radius_m, facts}) {
    const width_m = rotor_radius_m + Math.max(0, ...rotors.map(({position_m}) => Math.hypot(...position_m)));
    return Math.max(width_m, Math.min(facts.reach_m, 1.5 * width_m));
}

/** @param {any} report */
export async function build_model(report) {
    const given = report.flight ? await decode_flight(report.flight) : null;
    const rows = given ? report.flight.rows : 0;
    const {robot} = report, joints = robot.links.length, rotors = robot.rotors.length;
    const joint_names = Array.from({length: joints}, (_, i) => `joint_${i + 1}_rad`);
    if (given) {
        const needed = [...needed_columns, ...joint_names, ...joint_names.map((name) => `ref_${name}`)];
        const missing = needed.filter((name) => !given[name]);
        if (missing.length > 0 || rows < 1) {
            throw new Trouble(`The flight of this page lacks ${missing.join(", ") || "rows"}.`);
        }
    }
    const data = given ? {...given, ...derived(given, rows)} : null;
    const references = data ?
        [
            data.ref_x_m, data.ref_y_m, data.ref_z_m, data.ref_yaw_rad,
            ...joint_names.map((name) => data[`ref_${name}`])
        ] :
        [];
    const solution = report.solution ?? {};
    const outcome = solution.execution?.outcome ?? null;
    const of_rotors = (suffix) => Array.from({length: rotors}, (_, i) => data[`rotor_${i + 1}_${suffix}`]);
    const commands = data ? of_rotors("cmd_n") : [], factors = data ? of_rotors("aero_factor") : [];
    return {
        report,
        solution,
        robot,
        joints,
        data,
        columns: given,
        rows,
        scene: report.scene,
        goals: report.goals,
        start: report.start,
        outcome,
        objective: objective_text(solution.objective),
        cost_unit: report.cost_unit,
        is_cut_short: data !== null && ["collision", "unstable", "left_flyable_area"].includes(outcome),
        hovers: data ? hovers_of(data, rows, references, report) : [],
        commands: data ? rotor_lines(data, rotors, "cmd_n") : [],
        factors: data ? rotor_lines(data, rotors, "aero_factor") : [],
        end_s: data ? data.t_s[rows - 1] : 0,
        size_m: size_of(robot),
        position_at: (row) => [data.x_m[row], data.y_m[row], data.z_m[row]],
        wanted_at: (row) => [data.ref_x_m[row], data.ref_y_m[row], data.ref_z_m[row]],
        tip_at: (row) => [data.ee_x_m[row], data.ee_y_m[row], data.ee_z_m[row]],
        pose_at: (row) => ({
            position_m: [data.x_m[row], data.y_m[row], data.z_m[row]],
            attitude: [data.qw[row], data.qx[row], data.qy[row], data.qz[row]],
            joints_rad: joint_names.map((name) => data[name][row]),
        }),
        /** Thrust of each rotor: its command, or what its lag has reached, times K. */
        thrusts_at: (row) => commands.map((command, i) => {
            const lag = data[`rotor_${i + 1}_lag_n`] ?? command;
            return (lag?.[row] ?? 0) * (factors[i]?.[row] ?? 1);
        }),
    };
}
