// What the time plots show.

import {degrees, meters, number, quantity} from "./format.js";

export const in_degrees = (values) => values.map((v) => (v * 180) / Math.PI);

function names_of(rotors, count) {
    const numbers = rotors.map((rotor) => rotor + 1);
    if (numbers.length === count && count > 1) {
        return "all";
    }
    return numbers.join(", ");
}

/** A number of degrees as text. */
export const as_degrees = (value) => degrees((value * Math.PI) / 180);

/** Lines of rotors, alike ones together: see build_model(). */
export const rotor_lines = (lines, count) =>
    lines.map(({rotors, values}, index) => ({name: names_of(rotors, count), values, style: `series-${index % 8}`}));

/**
 * @typedef {{name: string, values: Float64Array, style: string}} Line
 * @typedef {{name: string, value: number, if_near?: boolean}} Limit one that is `if_near` may not flatten the line
 * @typedef {{id: string, title: string, unit: string, lines: Line[], limits?: Limit[], from_zero?: boolean,
 *            least_span?: number,
 *            text: (value: number) => string}} Plot
 * @returns {Plot[]}
 */
export function plots_of(model) {
    const {data, rows, robot, report} = model;
    const count = robot.rotors.positions_m.length;
    const error_m = new Float64Array(rows);
    for (let i = 0; i < rows; ++i) {
        error_m[i] = Math.hypot(data.x_m[i] - data.ref_x_m[i], data.z_m[i] - data.ref_z_m[i]);
    }
    const tilt = report.limits?.max_tilt_rad;
    const margin = report.limits?.safety_margin_m;
    const plots = [
        {
            id: "tracking",
            title: "Tracking error, position",
            unit: "m",
            from_zero: true,
            text: meters,
            lines: [{name: "", values: error_m, style: "flown"}]
        },
        {
            id: "pitch",
            title: "Pitch, nose down",
            unit: "°",
            text: as_degrees,
            lines: [{name: "", values: in_degrees(data.pitch_rad), style: "flown"}],
            limits: Number.isFinite(tilt) ?
                [
                    {name: "limit", value: (tilt * 180) / Math.PI, if_near: true},
                    {name: "limit", value: (-tilt * 180) / Math.PI, if_near: true}
                ] :
                []
        },
        {
            id: "arm",
            title: "Arm, 90° is down",
            unit: "°",
            text: as_degrees,
            lines: [
                {name: "flown", values: in_degrees(data.arm_rad), style: "flown"},
                {name: "reference", values: in_degrees(data.ref_arm_rad), style: "planned"}
            ]
        },
        {
            id: "thrust",
            title: "Thrust command by rotor",
            unit: "N",
            text: (v) => quantity(v, ".2f", "N"),
            lines: rotor_lines(model.commands, count),
            limits: [
                {name: "greatest", value: robot.rotors.max_thrust_n}, {name: "least", value: robot.rotors.min_thrust_n}
            ]
        },
        {
            id: "factor",
            title: "Thrust ratio K by rotor",
            unit: "1",
            text: (v) => number(v, ".3f"),
            lines: rotor_lines(model.factors, count)
        },
        {
            id: "clearance",
            title: "Clearance",
            unit: "m",
            from_zero: true,
            text: meters,
            lines: [{name: "", values: data.clearance_m, style: "flown"}],
            limits: margin > 0 ? [{name: "safety margin", value: margin}] : []
        },
        {
            id: "power",
            title: "Power",
            unit: "W",
            text: (v) => quantity(v, ".0f", "W"),
            lines: data.power_w ? [{name: "", values: data.power_w, style: "flown"}] : []
        },
        {
            id: "energy",
            title: "Energy",
            unit: "J",
            from_zero: true,
            text: (v) => quantity(v, ",.0f", "J"),
            lines: [{name: "", values: data.energy_j, style: "flown"}]
        },
    ];
    return plots.filter((plot) => plot.lines.some((line) => line.values.some(Number.isFinite)));
}
