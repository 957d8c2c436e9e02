// What the plots over time of a flight in space show.

import {meters, number, quantity} from "../format.js";
import {range_of} from "../numbers.js";
import {as_degrees, in_degrees, rotor_lines} from "../series.js";

const degrees_of = (radians) => (radians * 180) / Math.PI;

/** Limits of a joint; where both are alike and far from what is flown, they stand beside the title instead. */
function joint_limits(limits_rad) {
    if (!limits_rad) {
        return [];
    }
    const [low, high] = limits_rad.map((limit) => Math.round(100 * degrees_of(limit)) / 100),
                is_even = Math.abs(low + high) < 1e-9;
    return [{name: "limit", value: low, if_near: is_even}, {name: "limit", value: high, if_near: is_even}];
}

/** A limit from above, unless it is so far away that it would flatten the line. */
function limit_above(name, value, values) {
    const {high} = range_of(values);
    return value < 2 * high ? [{name, value: Math.round(100 * value) / 100}] : [];
}

/** @returns {import("../series.js").Plot[]} */
export function space_plots(model) {
    const {data, robot, report, joints} = model;
    const {safety_margin_m: margin, max_tilt_rad: tilt} = report.limits;
    const count = robot.rotors.length;
    const plot = (id, title, unit, text, lines, more = {}) => ({id, title, unit, text, lines, ...more});
    const flown = (values) => [{name: "", values, style: "flown"}];
    const both = (values, reference) =>
        [{name: "flown", values: in_degrees(values), style: "flown"},
         {name: "reference", values: in_degrees(reference), style: "planned"}];
    const greatest = Math.min(...robot.rotors.map((rotor) => rotor.max_thrust_n));
    const least = Math.max(...robot.rotors.map((rotor) => rotor.min_thrust_n));
    const plots = [
        plot("tracking", "Position error", "m", meters, flown(data.error_m), {from_zero: true}),
        plot("tilt", "Tilt", "°", as_degrees, flown(in_degrees(data.tilt_rad)), {
            from_zero: true,
            limits: limit_above("limit of the controller", degrees_of(tilt), in_degrees(data.tilt_rad))
        }),
        plot(
            "attitude", "Roll and pitch", "°", as_degrees,
            [
                {name: "roll", values: in_degrees(data.roll_rad), style: "series-0"},
                {name: "pitch, nose down", values: in_degrees(data.pitch_rad), style: "series-1"}
            ],
            {least_span: 0.2}),
        plot("yaw", "Yaw", "°", as_degrees, both(data.yaw_rad, data.ref_yaw_rad), {least_span: 0.2}),
        ...Array.from(
            {length: joints},
            (_, i) => plot(
                `joint-${i + 1}`, joints > 1 ? `Joint ${i + 1}` : "Joint", "°", as_degrees,
                both(data[`joint_${i + 1}_rad`], data[`ref_joint_${i + 1}_rad`]),
                {limits: joint_limits(robot.links[i].limits_rad), least_span: 0.2})),
        plot(
            "thrust", "Thrust command by rotor", "N", (v) => quantity(v, ".2f", "N"),
            rotor_lines(model.commands, count),
            {limits: [{name: "greatest", value: greatest}, {name: "least", value: least}]}),
        plot("factor", "Thrust ratio K by rotor", "1", (v) => number(v, ".3f"), rotor_lines(model.factors, count)),
        plot(
            "clearance", "Clearance", "m", meters, flown(data.clearance_m),
            {from_zero: true, limits: margin > 0 ? [{name: "safety margin", value: margin}] : []}),
        plot("speed", "Speed", "m/s", (v) => quantity(v, ".2f", "m/s"), flown(data.speed_m_s), {
            from_zero: true,
            limits: limit_above("limit of the reference", report.limits.max_speed_m_s, data.speed_m_s)
        }),
        plot("power", "Power", "W", (v) => quantity(v, ".0f", "W"), data.power_w ? flown(data.power_w) : []),
        plot("energy", "Energy", "J", (v) => quantity(v, ",.0f", "J"), flown(data.energy_j), {from_zero: true}),
    ];
    return plots.filter(({lines}) => lines.some(({values}) => values.some(Number.isFinite)));
}
