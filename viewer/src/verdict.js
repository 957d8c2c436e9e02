// The head of the page: what came of it, and the key figures.

import {foreign, h} from "./dom.js";
import {cost, degrees, meters, number, place, point, quantity, seconds} from "./format.js";
import {cause_text, knowledge, outcome_text, variants} from "./words.js";

/** @returns {{kind: "good"|"bad"|"none", mark: string, title: string, lines: string[]}} */
export function verdict_of(model) {
    const {solution, outcome, data, rows} = model;
    const {execution, planning} = solution;
    const stopped = solution.interrupted ? "Interrupted; the best so far. " : "";
    const flown = execution?.aero === false ? " in free air" : "";
    if (solution.status === "solved" && outcome === "ok") {
        return {kind: "good", mark: "✓", title: "Solved, and it flies",
            lines: [`${stopped}The flight of the plan${flown} ${outcome_text(outcome)}.`]};
    }
    if (solution.status === "solved" && !execution) {
        return {kind: "none", mark: "?", title: "A plan was found, but it was not flown", lines: stopped ? [stopped] : []};
    }
    if (solution.status === "solved") {
        const lines = [];
        const how = `${stopped}Flown${flown || " with aerodynamics evaluated directly"}, it`;
        if (model.is_cut_short) {
            const last = rows - 1;
            const clearance = Number.isFinite(data.clearance_m[last]) ? `${meters(data.clearance_m[last])} of clearance and ` : "";
            lines.push(`${how} breaks off after ${seconds(data.t_s[last])}: the vehicle at ${point(data.x_m[last], data.z_m[last])}, ` +
                `the end effector at ${point(data.ee_x_m[last], data.ee_z_m[last])}, with ${clearance}` +
                `${meters(Math.hypot(data.x_m[last] - data.ref_x_m[last], data.z_m[last] - data.ref_z_m[last]))} off its reference.`);
        } else if (outcome === "goal_missed") {
            lines.push(`${how} ends with a goal error of ${meters(execution.goal_error_m)}${tolerance_text(model)}, worst over the last second.`);
        } else {
            lines.push(`${how} ${outcome_text(outcome)}.`);
        }
        if (knowledge[solution.variant]) {
            lines.push(`The search, ${String(solution.variant).toUpperCase()}, reckoned with ${knowledge[solution.variant]}.`);
        }
        return {kind: "bad", mark: "✕", title: `A plan was found, but its flight ${outcome_text(outcome)}`, lines};
    }
    const lines = [];
    if (solution.status === "approximate") {
        lines.push(`${stopped}What is shown is an approximate plan: it ends near the goal, which counts as no solution.` +
            (execution ? ` Flown, it ${outcome_text(outcome)}.` : ""));
    } else if (stopped) {
        lines.push("The search was interrupted.");
    }
    const nearest = planning?.nearest_approach_m, stop = planning?.obstruction;
    if (Number.isFinite(nearest)) {
        lines.push(`The vehicle was brought within ${meters(nearest)} of the goal region.`);
    }
    if (stop) {
        lines.push(`Of the ways into the goal region the nearest was refused because it ${cause_text(stop.cause)}, ` +
            `at ${point(stop.x_m, stop.z_m)}, arm ${degrees(stop.arm_rad)}, ${place(stop.goal_distance_m)} before the goal region.`);
    }
    if (lines.length === 0) {
        const most = Object.entries(planning?.rejected ?? {}).sort((a, b) => b[1] - a[1])[0];
        lines.push(most?.[1] > 0
            ? `Most ways were refused because they led to this: ${cause_text(most[0])} (${number(most[1], ",d")} times).`
            : "No way was refused: the search may have needed more time.");
    }
    return {kind: "none", mark: "∅", title: "No plan within the limits", lines};
}

function tolerance_text({goals}) {
    const goal = goals[0];
    if (goals.length !== 1 || !Number.isFinite(goal.tolerance_x_m)) {
        return "";
    }
    return goal.tolerance_x_m === goal.tolerance_z_m
        ? ` of ${place(goal.tolerance_x_m)} allowed`
        : ` of ${place(goal.tolerance_x_m)} in x and ${place(goal.tolerance_z_m)} in z allowed`;
}

function figures_of(model) {
    const {solution, report, cost_unit} = model;
    const {execution, planning} = solution;
    const list = [];
    const add = (name, value, note) => list.push({name, value, note});
    if (solution.plan) {
        // Where the objective is one of the other figures, the cost alone says which.
        add(`Cost, ${model.objective}`, cost(execution ? execution.cost : solution.cost, cost_unit),
            execution ? `flown; ${cost(solution.cost, cost_unit)} planned` : "planned");
    }
    if (execution) {
        add("Duration", seconds(execution.duration_s), model.hold_from_s !== null ? `reference ${seconds(model.hold_from_s)}` : "");
        add("Energy", quantity(execution.energy_j, ",.0f", "J"), "rotors and arm");
        add("Least clearance", meters(execution.min_clearance_m),
            model.scene.obstacles.length === 0 ? "no obstacles" : report.limits?.safety_margin_m > 0 ? `margin in planning ${place(report.limits.safety_margin_m)}` : "");
        add("Goal error", meters(execution.goal_error_m), tolerance_text(model).trim() || "worst over the last second");
        add("Max. tracking error", meters(execution.max_tracking_error_m), "position");
        add("Saturation", number(execution.max_saturation, ".2f"), execution.max_saturation > 1 ? "clipped: above 1" : "demand over limit");
    }
    if (Number.isFinite(planning?.nearest_approach_m)) {
        add("Nearest approach", meters(planning.nearest_approach_m), "to the goal region");
    }
    const first = planning?.first_solution_wall_s;
    add("First solution after", Number.isFinite(first) ? quantity(first, ".3f", "s") : "none", `search ${seconds(planning?.wall_s)}`);
    add("Iterations", number(planning?.iterations, ",d"),
        planning?.edges_simulated > 0 ? `${number(planning.edges_simulated, ",d")} edges flown` : "");
    return list;
}

function goals_list({solution, goals}) {
    const visits = solution.execution?.goals ?? [];
    if (visits.length < 2) {
        return null;
    }
    return h("ul", {class: "goal-visits"}, visits.map(({met, error_m}, i) =>
        h("li", null, `goal ${goals.length > 1 ? i + 1 : ""}: ${met ? "met" : "not met"}, error ${meters(error_m)}`)));
}

export function make_head(model, theme_switch) {
    const {solution, report} = model;
    const name = solution.problem?.name ?? "unnamed problem";
    const fact = (key, value) => h("span", {class: "fact"}, h("span", {class: "muted"}, key), " ", value);
    return h("header", {class: "head"},
        h("div", {class: "head-line"},
            h("div", {class: "brand"}, "Downwash"), theme_switch),
        h("h1", null, foreign(name)),
        report.description ? h("p", {class: "description", tabindex: report.description.length > 400 ? "0" : null}, foreign(report.description)) : null,
        h("p", {class: "facts"},
            fact("variant", h("span", {title: variants[solution.variant] ?? null}, String(solution.variant).toUpperCase())),
            fact("algorithm", solution.algorithm), fact("objective", model.objective), fact("seed", String(solution.seed)),
            model.goals.length > 1 ? fact("goals", `${model.goals.length}, ${report.goal_order === "any_of" ? "any of them" : "in turn"}`) : null));
}

export function make_verdict(model) {
    const {kind, mark, title, lines} = verdict_of(model);
    return h("section", {class: `verdict ${kind}`, "aria-labelledby": "verdict-title"},
        h("div", {class: "verdict-text"},
            h("span", {class: "verdict-mark", "aria-hidden": "true"}, mark),
            h("div", null, h("h2", {id: "verdict-title"}, title), lines.map((text) => h("p", null, text)), goals_list(model))),
        h("dl", {class: "figures"}, figures_of(model).map(({name, value, note}) =>
            h("div", null, h("dt", null, name), h("dd", null, h("span", {class: "figure"}, value), note ? h("span", {class: "muted"}, note) : null)))));
}
