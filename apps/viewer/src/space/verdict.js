// The head of the page: the result, and the key figures of the flight.

import {certificate_sentence} from "../certificate.js";
import {foreign, h} from "../dom.js";
import {cost, degrees, meters, number, place, quantity, seconds} from "../format.js";
import {range_of} from "../numbers.js";
import {order_list} from "../order_list.js";
import {cause_text, outcome_text} from "../words.js";

const point = (at) => ["x", "y", "z"].map((axis, k) => `${axis}\u00a0${place(at[k])}`).join(", ");

function world_text({world}) { return world ? `, in world ${world.index} of seed ${world.seed}` : ""; }

function failure_line(model, how) {
    const {data, rows, solution} = model;
    const last = rows - 1;
    if (model.is_cut_short) {
        const clearance =
            Number.isFinite(data.clearance_m[last]) ? `${meters(data.clearance_m[last])} of clearance, ` : "";
        return `${how} breaks off after ${seconds(model.end_s)}: the vehicle at ${
                   point(model.position_at(last))}, the end ` +
            `effector at ${point(model.tip_at(last))}, with ${clearance}a position error of ${
                   meters(data.error_m[last])} ` +
            `and a tilt of ${degrees(data.tilt_rad[last])}.`;
    }
    const error = solution.execution?.goal_error_m;
    return `${how} ${outcome_text(model.outcome)}${
        Number.isFinite(error) ? `; the goal error is ${meters(error)}` : ""}.`;
}

/** Why a search has no plan that counts. */
function search_lines({solution, outcome}) {
    const {planning, certificate, execution, status, interrupted} = solution;
    const {nearest_approach_m: nearest, obstruction, goal} = planning;
    const target = goal ? `goal ${goal}` : "the goal";
    const lines = interrupted ? ["The search was interrupted."] : [];
    if (status === "approximate") {
        lines.push(`The page shows ${
            certificate ? "a plan without a certificate" : `a plan that ends near ${target}`}, which counts as no ` +
                   `solution.${execution ? ` Its execution ${outcome_text(outcome)}.` : ""}`);
    }
    if (Number.isFinite(nearest)) {
        lines.push(`The vehicle came within ${meters(nearest)} of ${target}.`);
    }
    if (obstruction) {
        const {cause, obstacles = []} = obstruction;
        lines.push(`What stopped it: ${cause_text(cause)}${obstacles.length > 0 ? ` near ${obstacles.join(", ")}` : ""}.`);
    }
    return lines;
}

/** What the flight did; without one, what the page shows. */
function result_of(model) {
    const {solution, outcome, data, report} = model;
    const {execution} = solution;
    if (!data && !report.solution) {
        return {
            kind: "none",
            mark: "○",
            title: "Not planned yet",
            lines: ["The page shows the problem as `downwash check` read it. The vehicle stands at its start."]
        };
    }
    if (solution.planning && solution.status !== "solved") {
        const title = solution.status === "approximate" && solution.certificate ?
            "A plan was found, but it is not certified" :
            "No plan within the limits";
        return {kind: "none", mark: "∅", title, lines: search_lines(model)};
    }
    if (!data) {
        return {kind: "none", mark: "∅", title: "Nothing was flown", lines: []};
    }
    const medium = execution?.aero === false ? "in free air" : "with aerodynamics evaluated directly";
    const how = execution ? `Executed ${medium}${world_text(execution)}, the plan` : "The flight";
    if (outcome === "ok") {
        return {kind: "good", mark: "✓", title: "The plan flies", lines: [`${how} ${outcome_text(outcome)}.`]};
    }
    if (outcome === null) {
        return {kind: "none", mark: "?", title: "A flight without an outcome", lines: []};
    }
    return {kind: "bad", mark: "✕", title: `The flight ${outcome_text(outcome)}`, lines: [failure_line(model, how)]};
}

/** One sentence on what an independent judge found; null without one. */
function judge_line({report: {findings}}) {
    if (!findings) {
        return null;
    }
    const {outcome, disagreements = [], runs, failures} = findings;
    const claims = disagreements.length > 0 ? `, and contradicts the file in ${number(disagreements.length, ",d")} ` +
            `${disagreements.length === 1 ? "place" : "places"}` :
                                              "";
    const worlds =
        runs !== undefined ? ` In ${number(runs, ",d")} worlds ${number(failures, ",d")} flights failed.` : "";
    return `The judge's flight ${outcome_text(outcome)}${claims}.${worlds}`;
}

function warnings_list({report: {warnings}, solution}) {
    const list = solution.warnings ?? warnings ?? [];
    if (list.length === 0) {
        return null;
    }
    return h(
        "details", {class: "warnings"},
        h("summary", null,
          h("span", {class: "warnings-count"}, `⚠ ${list.length} ${list.length === 1 ? "warning" : "warnings"}`), " ",
          foreign(list[0].message)),
        h("ul", null,
          list.map(
              ({file, line, message}) =>
                  h("li", null, h("code", null, foreign(`${file}:${line}`)), " ", foreign(message)))));
}

export function make_head({report, solution, goals, robot, joints}, theme_switch) {
    const fact = (key, value) => h("span", {class: "fact"}, h("span", {class: "muted"}, key), " ", value);
    const {description} = report;
    return h(
        "header", {class: "head"}, h("div", {class: "head-line"}, h("div", {class: "brand"}, "Downwash"), theme_switch),
        h("h1", null, foreign(report.name)),
        description ?
            h("p", {class: "description", tabindex: description.length > 400 ? "0" : null}, foreign(description)) :
            null,
        h("p", {class: "facts"}, fact("robot", foreign(robot.name)), fact("rotors", String(robot.rotors.length)),
          fact("joints", String(joints)),
          solution.variant ? fact("variant", String(solution.variant).toUpperCase()) : null,
          goals.length > 1 ? fact("goals", `${goals.length}`) : null));
}

export function make_verdict(model) {
    const {kind, mark, title, lines} = result_of(model), judge = judge_line(model);
    const certificate = certificate_sentence(model.solution);
    return h(
        "section", {class: `verdict ${kind}`, "aria-labelledby": "verdict-title"},
        h("div", {class: "verdict-text"}, h("span", {class: "verdict-mark", "aria-hidden": "true"}, mark),
          h("div", null, h("h2", {id: "verdict-title"}, title), lines.map((text) => h("p", null, text)),
            certificate ? h("p", {class: "certificate-line"}, certificate) : null,
            judge ? h("p", {class: "judge-line"}, judge) : null, order_list(model), warnings_list(model))));
}

/** Key figures of the flight; null where nothing was flown. */
export function make_figures(model) {
    const {data, rows, solution, report} = model;
    if (!data) {
        return null;
    }
    const {execution} = solution;
    const {safety_margin_m: margin, max_tilt_rad: tilt} = report.limits;
    const list = [];
    const add = (name, value, note = "") => list.push({name, value, note});
    const clearance = range_of(data.clearance_m), greatest = (column) => range_of(data[column]).high;
    if (Number.isFinite(execution?.cost)) {
        add(`Cost${model.objective ? `, ${model.objective}` : ""}`, cost(execution.cost, report.cost_unit));
    }
    add("Duration", seconds(model.end_s));
    add("Energy", quantity(data.energy_j[rows - 1], ",.0f", "J"), "rotors and arm");
    add("Minimum clearance", meters(clearance.low),
        !Number.isFinite(clearance.low) ? "no obstacles" :
            margin > 0                  ? `margin ${place(margin)}` :
                                          "");
    add("Max. position error", meters(greatest("error_m")));
    add("Max. tilt", degrees(greatest("tilt_rad")), `controller ${degrees(tilt)}`);
    add("Max. speed", quantity(greatest("speed_m_s"), ".2f", "m/s"));
    if (Number.isFinite(execution?.goal_error_m)) {
        add("Goal error", meters(execution.goal_error_m));
    }
    if (Number.isFinite(execution?.max_saturation)) {
        add("Saturation", number(execution.max_saturation, ".2f"),
            execution.max_saturation > 1 ? "clipped: above 1" : "demand over limit");
    }
    const columns = (most) => Math.ceil(list.length / Math.ceil(list.length / most));
    return h(
        "dl", {class: "figures of-run", style: `--wide: ${columns(9)}; --narrow: ${columns(5)}`},
        list.map(
            ({name, value, note}) => h(
                "div", null, h("dt", null, name),
                h("dd", null, h("span", {class: "figure"}, value), note ? h("span", {class: "muted"}, note) : null))));
}
