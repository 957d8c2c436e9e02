// Lines over the time of the plan.

import {h, s} from "../dom.js";
import {range_of} from "../numbers.js";
import {around, make_figure, make_panel, plain} from "../panel.js";
import {axes, is_flat} from "./model.js";

/** A path through values, broken where there is none. */
function path_of(t_s, values, {x, y}) {
    let path = "", is_on = false;
    for (let i = 0; i < values.length; ++i) {
        if (!Number.isFinite(values[i])) {
            is_on = false;
            continue;
        }
        path += `${is_on ? "L" : "M"}${x(t_s[i]).toFixed(1)} ${y(values[i]).toFixed(1)}`;
        is_on = true;
    }
    return path;
}

/** The area between two lists of values. */
function band_of(t_s, low, high, {x, y}) {
    const there = [...t_s.keys()].filter((i) => Number.isFinite(low[i]) && Number.isFinite(high[i]));
    const points = (values, rows) => rows.map((i) => `${x(t_s[i]).toFixed(1)} ${y(values[i]).toFixed(1)}`);
    return there.length < 2 ? "" : `M${points(low, there).join("L")}L${points(high, there.reverse()).join("L")}Z`;
}

function domain_of(lists, from_zero) {
    const ranges = lists.map(range_of).filter(({low, high}) => low <= high);
    if (ranges.length === 0) {
        return null;
    }
    const low = Math.min(...ranges.map((range) => range.low)), high = Math.max(...ranges.map((range) => range.high));
    return from_zero ? [Math.min(0, low), 1.05 * high || 1] : around(low, high);
}

/**
 * @param {{name: string, values: Float64Array, style: string}[]} lines
 * @param {{low: Float64Array, high: Float64Array}} [band]
 * @param {{outside?: {begin_s: number, end_s: number}[], jumps?: {at_s: number}[], limit?: {name: string, value: number}, from_zero?: boolean}} more
 */
function make_curves(title, unit, t_s, lines, band, {outside = [], jumps = [], limit, from_zero} = {}) {
    const shown = band ? [...lines.map(({values}) => values), band.low, band.high] : lines.map(({values}) => values);
    const y = domain_of(shown, from_zero);
    return make_panel({}, title, () => y === null ? "The log has nothing of it." : {
        label: `${title} over time: ${lines.map(({name, values}) => {
            const {low, high} = range_of(values);
            return `${name} from ${plain(low)} to ${plain(high)} ${unit}`;
        }).join(", ")}.`,
        height: 230,
        x: {name: "time of the plan [s]", domain: [0, t_s[t_s.length - 1] || 1]},
        y: {name: `${title} [${unit}]`, domain: y},
        draw: (frame) => [
            outside.map(({begin_s, end_s}) => s("rect", {
                            class: "outside",
                            x: frame.x(begin_s),
                            width: Math.max(1, frame.x(end_s) - frame.x(begin_s)),
                            y: frame.top,
                            height: frame.bottom - frame.top
                        })),
            jumps.map(({at_s}) => s("path", {class: "jump", d: `M${frame.x(at_s)} ${frame.top}V${frame.bottom}`})),
            band ? s("path", {class: "band", d: band_of(t_s, band.low, band.high, frame)}) : [],
            limit && limit.value >= y[0] && limit.value <= y[1] ?
                [
                    s("path", {class: "limit", d: `M${frame.left} ${frame.y(limit.value)}H${frame.right}`}),
                    s("text", {class: "limit-name", x: frame.left + 5, y: frame.y(limit.value) - 4}, limit.name)
                ] :
                [],
            lines.map(({values, style}) => s("path", {class: `line ${style}`, d: path_of(t_s, values, frame)}))
        ],
    });
}

function make_key(lines, others) {
    return h(
        "p", {class: "key-line"},
        lines.map(([name, style]) => h("span", {class: "entry"}, h("span", {class: `key ${style}`, "aria-hidden": "true"}),
                                       name)),
        others.map(([name, style]) => h("span", {class: "entry"}, h("span", {class: `area ${style}`, "aria-hidden": "true"}),
                                        name)));
}

const jump_key = ["the log jumps", "jump-key"];
const key_lines = [["flown", "series-1"], ["planned flight", "series-0"]];

/** How far the vehicle was from its reference, axis by axis, with the envelope of the worlds. */
export function make_places({series, findings}) {
    const shown = axes.map((_, axis) => axis).filter((axis) => !is_flat(series, axis));
    const panels = shown.map((axis) => {
        const off = (values) => values.map((value, i) => value - series.reference_m[axis][i]);
        const outside = (findings.envelope?.outside ?? []).filter((time) => time.axis === axes[axis]);
        const band = series.low_m ? {low: off(series.low_m[axis]), high: off(series.high_m[axis])} : undefined;
        return make_curves(
            `${axes[axis]} from the reference`, "m", series.t_s,
            [
                {name: "planned flight", values: off(series.planned_m[axis]), style: "series-0"},
                {name: "flown", values: off(series.flown_m[axis]), style: "series-1"}
            ],
            band, {outside, jumps: findings.jumps});
    });
    const note = findings.envelope ?
        `The band spans where the vehicle is in ${findings.envelope.worlds} worlds of the plan's uncertainty; red marks ` +
            "times at which the flown vehicle is outside of it, most of all along that axis." :
        "Along the axes of the problem.";
    const areas = [
        ...(findings.envelope ? [["worlds", "band-key"], ["outside", "outside-key"]] : []),
        ...(findings.jumps.length > 0 ? [jump_key] : [])
    ];
    const figure = make_figure("places", "Tracking, axis by axis", note, panels, make_key(key_lines, areas));
    figure.classList.add("wide");
    return figure;
}

/** How far it was from its reference. */
export function make_errors({series, findings}) {
    const distances = (places_m) => series.t_s.map((_, i) => Math.hypot(
        ...axes.map((_, axis) => places_m[axis][i] - series.reference_m[axis][i])));
    return make_figure(
        "errors", "Distance from the reference",
        "The planned flight is that of the simulation in the nominal world.",
        [make_curves("distance", "m", series.t_s,
                     [
                         {name: "planned flight", values: distances(series.planned_m), style: "series-0"},
                         {name: "flown", values: distances(series.flown_m), style: "series-1"}
                     ],
                     undefined, {from_zero: true, jumps: findings.jumps})],
        make_key(key_lines, findings.jumps.length > 0 ? [jump_key] : []));
}

/** null without obstacles. */
export function make_clearance({series, findings}) {
    if (findings.clearance.planned.min_m === null) {
        return null;
    }
    const margin_m = findings.clearance.safety_margin_m;
    return make_figure(
        "clearance", "Clearance",
        "The smallest distance of the robot to an obstacle of the problem, where the log says that it was.",
        [make_curves("clearance", "m", series.t_s,
                     [
                         {name: "planned flight", values: series.planned_clearance_m, style: "series-0"},
                         {name: "flown", values: series.clearance_m, style: "series-1"}
                     ],
                     undefined, {from_zero: true, limit: {name: "safety margin", value: margin_m}})],
        make_key(key_lines, []));
}

/** null without commands of rotors in the log. */
export function make_thrust({series, findings}) {
    if (!findings.thrust) {
        return null;
    }
    return make_figure(
        "thrust", "Thrust of all rotors",
        "Commands of the log beside those of the planned flight, with surface effects and in free air. Commands without a unit " +
            "are scaled to fit.",
        [make_curves("thrust", "N", series.t_s, [
            {name: "in free air", values: series.free_air_thrust_n, style: "series-2"},
            {name: "planned flight", values: series.planned_thrust_n, style: "series-0"},
            {name: "flown", values: series.thrust_n, style: "series-1"}
        ])],
        make_key([...key_lines, ["in free air", "series-2"]], []));
}
