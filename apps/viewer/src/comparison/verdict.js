// The head of the page, and the figures of the comparison.

import {foreign, h} from "../dom.js";
import {meters, number, quantity, seconds} from "../format.js";
import {axes} from "./model.js";

const millimetres = (value) => value === null ? "–" : quantity(1000 * value, ",.0f", "mm");
const degrees = (value) => quantity((180 / Math.PI) * value, ".2f", "°");

export function make_head({problem, findings}, theme_switch) {
    const fact = (key, value) => h("span", {class: "fact"}, h("span", {class: "muted"}, key), " ", value);
    return h(
        "header", {class: "head"},
        h("div", {class: "head-line"}, h("div", {class: "brand"}, "Downwash comparison"), theme_switch),
        h("h1", null, foreign(problem)),
        h("p", {class: "facts"}, fact("log", foreign(findings.log.files.join(", "))),
          fact("format", foreign(findings.log.format)), fact("length", seconds(findings.log.duration_s))));
}

function figures_of({tracking, clearance, envelope, thrust}) {
    const list = [
        {name: "From the reference", value: millimetres(tracking.rms_m.distance), note: "root mean square"},
        {name: "At most", value: millimetres(tracking.max_m.distance), note: `at ${seconds(tracking.max_at_s)}`},
        {
            name: "Least clearance",
            value: meters(clearance.flown.min_m),
            note: clearance.flown.min_m === null ? "no obstacles" : `planned ${meters(clearance.planned.min_m)}`
        },
    ];
    if (envelope) {
        list.push({
            name: "Outside the worlds",
            value: number(envelope.share_outside, ".1%"),
            note: `of the time, ${number(envelope.worlds, ",d")} worlds`
        });
    }
    if (thrust) {
        list.push({
            name: "Thrust off by",
            value: quantity(thrust.rms_from_planned_n, ".2f", "N"),
            note: `${quantity(thrust.rms_from_free_air_n, ".2f", "N")} in free air`
        });
    }
    return list;
}

/** What the log's jumps are, and what they add to the errors; null without any. */
function make_jumps({jumps, tracking_apart_from_jumps: apart}) {
    if (jumps.length === 0) {
        return null;
    }
    const by = ({step_m, turn_rad}) => {
        const step = Math.hypot(...step_m);
        return step > 0 ? ` by ${millimetres(step)}` : turn_rad === 0 ? "" : ` by ${degrees(turn_rad)}`;
    };
    return h(
        "div", {class: "jumps"},
        h("p", null,
          "In flight the log jumps, as by a reset of the estimator. All errors on this page contain that. Without two " +
              `seconds behind each jump, the vehicle was ${millimetres(apart.rms_m.distance)} from its reference, ${
                  millimetres(apart.max_m.distance)} at most.`),
        h("ul", null,
          jumps.map((jump) => h("li", null, `${seconds(jump.at_s)}: ${jump.what}${by(jump)} (`, foreign(jump.source), ")"))));
}

export function make_verdict({findings}) {
    const {alignment, log, remarks} = findings;
    const lines = [
        `The plan begins at ${seconds(alignment.offset_s)} of the log` +
            (alignment.is_time_fitted ? ` (correlation of speeds ${number(alignment.correlation, ".3f")}).` : ", as given."),
        alignment.is_frame_fitted ?
            `The log's axes (${log.axes === "ned" ? "NED" : "z up"}, ${log.axes_source}) are turned by ${
                degrees(alignment.yaw_rad)} and moved; ${millimetres(alignment.residual_m)} are left from the planned flight.` :
            "The log's places are taken as those of the problem's world.",
        `It covers ${number(alignment.covered, ".1%")} of the plan.`,
    ];
    return h(
        "section", {class: "verdict", "aria-labelledby": "verdict-title"},
        h("div", {class: "verdict-text"},
          h("div", null, h("h2", {id: "verdict-title"}, "The flight beside its plan"),
            lines.map((text) => h("p", null, text)), make_jumps(findings),
            remarks.length > 0 ? h("ul", {class: "muted"}, remarks.map((text) => h("li", null, foreign(text)))) : null)),
        h("dl", {class: "figures"},
          figures_of(findings).map(
              ({name, value, note}) => h("div", null, h("dt", null, name),
                                         h("dd", null, h("span", {class: "figure"}, value),
                                           note ? h("span", {class: "muted"}, note) : null)))));
}

/** Errors by phase and axis. */
export function make_phases({findings}) {
    const columns = [...axes, "distance"];
    const row = (name, {rms_m, max_m}, duration_s, clearance_m) =>
        h("tr", null, h("th", {scope: "row"}, name), h("td", null, seconds(duration_s)),
          columns.map((axis) => h("td", null, millimetres(rms_m[axis]))),
          columns.map((axis) => h("td", null, millimetres(max_m[axis]))), h("td", null, meters(clearance_m)));
    const names = [
        "phase", "lasts", ...columns.map((axis) => `rms ${axis}`), ...columns.map((axis) => `max ${axis}`), "least clearance"
    ];
    return h(
        "section", {class: "phases", "aria-labelledby": "phases-title"}, h("h2", {id: "phases-title"}, "Tracking by phase"),
        h("div", {class: "scroll", tabindex: "0", role: "region", "aria-label": "Tracking by phase"},
          h("table", {class: "numbers"},
            h("thead", null, h("tr", null, names.map((name) => h("th", {scope: "col"}, name)))),
            h("tbody", null,
              findings.phases.map((phase) => row(phase.phase, phase, phase.duration_s, phase.min_clearance_m)),
              row("all", findings.tracking, findings.duration_s, findings.clearance.flown.min_m)))));
}
