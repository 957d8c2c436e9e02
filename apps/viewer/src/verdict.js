// The head of the page: the result and the key figures.

import {certificate_sentence} from "./certificate.js";
import {foreign, h} from "./dom.js";
import {cost, degrees, meters, number, place, point, quantity, seconds} from "./format.js";
import {order_list} from "./order_list.js";
import {cause_text, knowledge, numbered_goal_name, outcome_text, variants} from "./words.js";

/** How, where and when the flight of a plan fails. */
function failure_lines(model, how) {
    const {solution, outcome, data, rows} = model;
    const lines = [];
    if (model.is_cut_short) {
        const last = rows - 1;
        const of = (column) => data[column][last];
        const error_m = Math.hypot(of("x_m") - of("ref_x_m"), of("z_m") - of("ref_z_m"));
        const clearance = Number.isFinite(of("clearance_m")) ? `${meters(of("clearance_m"))} of clearance and ` : "";
        lines.push(
            `${how} breaks off after ${seconds(of("t_s"))}: the vehicle at ${point(of("x_m"), of("z_m"))}, ` +
            `the end effector at ${point(of("ee_x_m"), of("ee_z_m"))}, ` +
            `with ${clearance}a tracking error of ${meters(error_m)}.`);
    } else if (outcome === "goal_missed") {
        const error = `${meters(solution.execution.goal_error_m)}${tolerance_text(model)}`;
        lines.push(`${how} ends with a goal error of ${error}, the maximum over the last second.`);
    } else {
        lines.push(`${how} ${outcome_text(outcome)}.`);
    }
    if (knowledge[solution.variant]) {
        lines.push(`The search, ${solution.variant.toUpperCase()}, considered ${knowledge[solution.variant]}.`);
    }
    return lines;
}

/** The world of the flight and where it has the vehicle, unless it is the nominal one. */
function world_text({world, lateral_m}) {
    const beside =
        lateral_m ? `, ${place(Math.abs(lateral_m))} to the ${lateral_m < 0 ? "right" : "left"} of its plane` : "";
    return world ? `, in world ${world.index} of seed ${world.seed}${beside}` : "";
}

/** Whether what a solution says of worlds is about the way to a goal before the last. */
function is_of_part({solution: {planning, certificate, execution}}) {
    const cause = planning?.obstruction?.cause;
    const goals = execution?.goals?.length ?? 0;
    return (cause === "certificate" || cause === "unfinished_certificate") && (!certificate || planning.goal < goals);
}

/** Names of obstacles as a list of words. */
function quoted(names) {
    const words = names.map((name) => `'${name}'`);
    return words.length > 1 ? `${words.slice(0, -1).join(", ")} and ${words.at(-1)}` : words.join("");
}

/** The name with the greatest count, and the count. */
const most_of = (counts) => Object.entries(counts ?? {}).sort((a, b) => b[1] - a[1])[0] ?? ["", 0];

/** What blocked a search without a plan. */
function blocked_lines(model) {
    const {solution, outcome} = model;
    const {certificate, execution, planning, status, interrupted} = solution;
    const nearest = planning?.nearest_approach_m, stop = planning?.obstruction;
    const goal = planning?.goal ? numbered_goal_name(model, planning.goal) : "the goal";
    const region = planning?.goal ? `the region of ${goal}` : "the goal region";
    const is_screened = is_of_part(model);
    const failed = stop?.cause === "certificate";
    const lines = [];
    if (interrupted) {
        lines.push("The search was interrupted.");
    }
    if (stop?.cause === "closed_plane") {
        return [
            ...lines,
            `${quoted(stop.obstacles ?? [])} ${(stop.obstacles ?? []).length === 1 ? "closes" : "close"} ` +
                `every way to ${goal} within the bounds: the vehicle does not get past at any pitch or arm angle.`
        ];
    }
    if (status === "approximate" && outcome === "ok" && (solution.order?.left_out ?? []).length > 0) {
        return [
            ...lines,
            "No flight was found to some targets. The page shows one to the others, which counts as no solution."
        ];
    }
    if (status === "approximate") {
        const flight = execution ? ` Its execution ${outcome_text(outcome)}.` : "";
        const shown = is_screened && failed ? `a way to ${goal} that fails too often in other worlds` :
            is_screened ? `a way to ${goal} that was not flown in enough worlds` :
            certificate ? "a plan that reaches the goal without a certificate" :
                          `an approximate plan: it ends near ${goal}`;
        lines.push(`The page shows ${shown}, which counts as no solution.${is_screened ? "" : flight}`);
    }
    if (Number.isFinite(nearest) && !is_screened) {
        lines.push(`The vehicle came within ${meters(nearest)} of ${region}.`);
    }
    if (stop?.cause === "direct_flight") {
        lines.push(
            "The planner discarded every plan: executed with direct aerodynamics, the last one failed or came nearer to an " +
            "obstacle than the margin, " +
            `at ${point(stop.x_m, stop.z_m)}, arm ${degrees(stop.arm_rad)}.`);
    } else if (stop?.cause === "unfinished_flight") {
        lines.push(`The planner found a way to ${
            goal}, but the time was over before its flight with direct aerodynamics was.`);
    } else if (stop?.cause === "unfinished_certificate") {
        lines.push(`The planner found a way to ${goal}, but the time was over before it was flown in enough worlds.`);
    } else if (stop?.cause === "certificate") {
        lines.push(`The planner discarded every plan to ${
            goal}: in worlds that the search had not seen, each failed too often.`);
    } else if (stop) {
        lines.push(
            `The planner rejected the nearest path into ${region} because it ${cause_text(stop.cause)}` +
            `${stop.obstacles?.length > 0 ? ` (${quoted(stop.obstacles)})` : ""}, ` +
            `at ${point(stop.x_m, stop.z_m)}, arm ${degrees(stop.arm_rad)}, ` +
            `${place(stop.goal_distance_m)} from ${region}.`);
    }
    const [obstacle, stopped] = most_of(planning?.stopped_by);
    if (stopped > 0) {
        lines.push(`${quoted([obstacle])} stopped most edges that collided: ${number(stopped, ",d")}.`);
    }
    if (lines.length === 0) {
        const [cause, count] = most_of(planning?.rejected);
        const times = `${number(count, ",d")} ${count === 1 ? "time" : "times"}`;
        lines.push(
            count > 0 ? `The most frequent reason for rejection: the flight ${cause_text(cause)}, ${times}.` :
                        "No flight was rejected: the search may need more time.");
    }
    return lines;
}

/** @returns {{kind: "good"|"bad"|"none", mark: string, title: string, lines: (string | (string|Node)[])[]}} */
export function verdict_of(model) {
    const {solution, outcome} = model;
    const {execution} = solution;
    if (solution.status === "unplanned") {
        const line = [
            "The page shows the problem as ", h("code", null, "downwash check"),
            " read it. The vehicle stands at its start."
        ];
        return {kind: "none", mark: "○", title: "Not planned yet", lines: [line]};
    }
    if (solution.status !== "solved") {
        const title = solution.status === "approximate" && solution.certificate && !is_of_part(model) ?
            "A plan was found, but it is not certified" :
            solution.planning?.obstruction?.cause === "closed_plane" ? "No way leads to the goal in this plane" :
                                                                       "No plan within the limits";
        return {kind: "none", mark: "∅", title, lines: blocked_lines(model)};
    }
    const stopped = solution.interrupted ? "Interrupted; the best so far. " : "";
    if (!execution) {
        const lines = stopped ? [stopped] : [];
        return {kind: "none", mark: "?", title: "A plan was found, but it was not executed", lines};
    }
    const medium = execution.aero === false ? "in free air" : "with aerodynamics evaluated directly";
    const air = medium + world_text(execution);
    if (outcome === "ok") {
        const line = `${stopped}Executed ${air}, the plan ${outcome_text(outcome)}.`;
        return {kind: "good", mark: "✓", title: "Solved, and the plan flies", lines: [line]};
    }
    const title = `A plan was found, but its flight ${outcome_text(outcome)}`;
    return {kind: "bad", mark: "✕", title, lines: failure_lines(model, `${stopped}Executed ${air}, it`)};
}

function tolerance_text({goals}) {
    const goal = goals[0];
    if (goals.length !== 1 || !Number.isFinite(goal.tolerance_x_m)) {
        return "";
    }
    return goal.tolerance_x_m === goal.tolerance_z_m ?
        ` of ${place(goal.tolerance_x_m)} allowed` :
        ` of ${place(goal.tolerance_x_m)} in x and ${place(goal.tolerance_z_m)} in z allowed`;
}

function figures_of(model) {
    const {solution, report, cost_unit} = model;
    const {execution, planning} = solution;
    const list = [];
    const add = (name, value, note) => list.push({name, value, note});
    if (solution.plan) {
        add(`Cost, ${model.objective}`, cost(execution ? execution.cost : solution.cost, cost_unit),
            execution ? `planned ${cost(solution.cost, cost_unit)}` : "planned");
    }
    if (execution) {
        // What is the cost already is not shown again.
        if (model.objective !== "time") {
            add("Duration", seconds(execution.duration_s),
                model.reference_s !== null ? `reference ${seconds(model.reference_s)}` : "");
        }
        if (model.objective !== "energy") {
            add("Energy", quantity(execution.energy_j, ",.0f", "J"), "rotors and arm");
        }
        add("Minimum clearance", meters(execution.min_clearance_m),
            model.scene.obstacles.length === 0     ? "no obstacles" :
                report.limits?.safety_margin_m > 0 ? `margin ${place(report.limits.safety_margin_m)}` :
                                                     "");
        add("Goal error", meters(execution.goal_error_m), tolerance_text(model).trim() || "largest at the end");
        if (execution.contact) {
            add("Contact force", quantity(execution.contact.force_n, ".2f", "N"),
                `off by ${quantity(execution.contact.force_error_n, ".2f", "N")} at most`);
        }
        if (Number.isFinite(execution.unseen_share)) {
            add("Unseen space", `${number(100 * execution.unseen_share, ".1f")} %`, "of the flight's ticks");
        }
        add("Max. tracking error", meters(execution.max_tracking_error_m), "position");
        add("Saturation", number(execution.max_saturation, ".2f"),
            execution.max_saturation > 1 ? "clipped: above 1" : "demand over limit");
    }
    if (Number.isFinite(planning?.nearest_approach_m)) {
        add("Nearest approach", meters(planning.nearest_approach_m),
            planning.goal ? `to the region of ${numbered_goal_name(model, planning.goal)}` : "to the goal region");
    }
    const first = planning?.first_solution_wall_s;
    add("First solution after", Number.isFinite(first) ? quantity(first, ".3f", "s") : "none",
        `search ${seconds(planning?.wall_s)}`);
    if (Number.isFinite(planning?.first_certified_wall_s)) {
        add("First certified after", quantity(planning.first_certified_wall_s, ".3f", "s"));
    }
    return list;
}

/** Key figures in rows of equal length, as far as their number allows; null before the problem is planned. */
export function make_figures(model) {
    if (model.solution.status === "unplanned") {
        return null;
    }
    const figures = figures_of(model);
    const columns = (most) => Math.ceil(figures.length / Math.ceil(figures.length / most));
    return h(
        "dl", {class: "figures of-run", style: `--wide: ${columns(9)}; --narrow: ${columns(5)}`},
        figures.map(
            ({name, value, note}) => h(
                "div", null, h("dt", null, name),
                h("dd", null, h("span", {class: "figure"}, value), note ? h("span", {class: "muted"}, note) : null))));
}

const orders = {
    any_of: "any of them",
    any_order: "in any order"
};

function goals_list(model) {
    const visits = model.solution.execution?.goals ?? [];
    if (visits.length < 2) {
        return null;
    }
    return h(
        "ul", {class: "goal-visits"},
        visits.map(
            ({met, error_m}, i) =>
                h("li", null,
                  `${numbered_goal_name(model, i + 1)}: ${met ? "met" : "not met"}, error ${meters(error_m)}`)));
}

/** What reading the problem warned of, folded to a line; null where there is nothing. */
function warnings_list({solution}) {
    const warnings = solution.warnings ?? [];
    if (warnings.length === 0) {
        return null;
    }
    const count = `${warnings.length} ${warnings.length === 1 ? "warning" : "warnings"}`;
    return h(
        "details", {class: "warnings"},
        h("summary", null, h("span", {class: "warnings-count"}, `⚠ ${count}`), " ", foreign(warnings[0].message)),
        h("ul", null,
          warnings.map(
              ({file, line, message}) =>
                  h("li", null, h("code", null, foreign(`${file}:${line}`)), " ", foreign(message)))));
}

export function make_head(model, theme_switch) {
    const {solution, report} = model;
    const name = solution.problem?.name ?? "unnamed problem";
    const fact = (key, value) => h("span", {class: "fact"}, h("span", {class: "muted"}, key), " ", value);
    return h(
        "header", {class: "head"}, h("div", {class: "head-line"}, h("div", {class: "brand"}, "Downwash"), theme_switch),
        h("h1", null, foreign(name)),
        report.description ? h("p", {class: "description", tabindex: report.description.length > 400 ? "0" : null},
                               foreign(report.description)) :
                             null,
        h("p", {class: "facts"},
          fact(
              "variant",
              h("span", {title: variants[solution.variant] ?? null}, String(solution.variant).toUpperCase())),
          fact("algorithm", solution.algorithm), fact("objective", model.objective),
          fact("seed", String(solution.seed)),
          model.goals.length > 1 ? fact("goals", `${model.goals.length}, ${orders[report.goal_order] ?? "in turn"}`) :
                                   null));
}

export function make_verdict(model) {
    const {kind, mark, title, lines} = verdict_of(model);
    const certificate = certificate_sentence(model.solution);
    return h(
        "section", {class: `verdict ${kind}`, "aria-labelledby": "verdict-title"},
        h("div", {class: "verdict-text"}, h("span", {class: "verdict-mark", "aria-hidden": "true"}, mark),
          h("div", null, h("h2", {id: "verdict-title"}, title), lines.map((text) => h("p", null, text)),
            certificate ? h("p", {class: "certificate-line"}, certificate) : null, order_list(model), goals_list(model),
            warnings_list(model))));
}
