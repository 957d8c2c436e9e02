// The head of the page: what campaign it is, and what came of it.

import {foreign, h} from "../dom.js";
import {number} from "../format.js";

const counted = (count, one, many) => `${number(count, ",d")} ${count === 1 ? one : many}`;

/** @returns {{kind: "good"|"bad"|"none", mark: string, title: string, lines: string[]}} */
export function verdict_of(model) {
    const {bars, failures, runs_done, runs_planned} = model.figures;
    const without = failures.reduce((sum, {count}) => sum + count, 0);
    const held = `${counted(runs_done, "run", "runs")}: ${number(runs_done - without, ",d")} ended with a flight that ` +
        `held${model.has_worlds ? " in the nominal world" : ""}, ${number(without, ",d")} did not.`;
    const missed = bars.filter((bar) => !bar.kept);
    if (model.is_unfinished) {
        return {
            kind: "none",
            mark: "…",
            title: `Not finished: ${number(runs_done, ",d")} of ${number(runs_planned, ",d")} runs`,
            lines: [held, "All figures are of the runs so far; targets cannot be judged yet."]
        };
    }
    if (bars.length === 0) {
        return {kind: "none", mark: "–", title: "Finished; the campaign sets no targets", lines: [held]};
    }
    if (missed.length === 0) {
        return {kind: "good", mark: "✓", title: `Targets met: ${bars.length} of ${bars.length}`, lines: [held]};
    }
    const told = missed.slice(0, 5).map(
        ({experiment, planner, bar, found}) => `${experiment}, ${planner}: ${bar}; found ${found}.`);
    if (missed.length > told.length) {
        told.push(`And ${missed.length - told.length} more.`);
    }
    return {
        kind: "bad",
        mark: "✕",
        title: `Targets missed: ${missed.length} of ${bars.length}`,
        lines: [held, ...told]
    };
}

export function make_head(model, theme_switch) {
    const {settings, stop_at_first_solution, machines, processor_models} = model.figures;
    const fact = (key, value) => h("span", {class: "fact"}, h("span", {class: "muted"}, key), " ", foreign(value));
    const limits = [
        settings.time_limit_s === null ? null : `${settings.time_limit_s} s`,
        settings.max_iterations === null ? null : `${settings.max_iterations} iterations`,
        stop_at_first_solution ? "up to the first solution" : null
    ].filter((limit) => limit !== null);
    return h(
        "header", {class: "head"},
        h("div", {class: "head-line"}, h("div", {class: "brand"}, "Downwash campaign"), theme_switch),
        h("h1", null, foreign(settings.campaign ?? "unnamed campaign")),
        settings.description && settings.description !== "none" ?
            h("p", {class: "description"}, foreign(settings.description)) :
            null,
        h("p", {class: "facts"}, fact("a search", limits.join(", ") || "without limits"), fact("seeds", settings.seeds),
          fact("searches at a time", settings.jobs), fact("on", settings.processor ?? (processor_models === 1 ? machines[0].processor : `${processor_models} models of processors`)),
          fact("commit", settings.commit)),
        processor_models > 1 ?
            h("p", {class: "facts", role: "note"},
              `All times are of ${processor_models} models of processors together: do not compare them with other times.`) :
            null);
}

const percent = (share) => number(100 * share, ".1f");
const of = (hits, attempts) => `${number(hits, ",d")} of ${number(attempts, ",d")}`;

/**
 * What a planner's tile says: one figure and lines below it. What matters most comes first: flights in other worlds,
 * then certificates, then flights in the nominal world.
 */
function tile_of({held, failed_flights, in_worlds}) {
    const {failed, flown, certified, tested} = in_worlds ?? {flown: 0, tested: 0};
    if (flown === 0) {
        return [
            ...(tested > 0 ? [of(certified.hits, certified.attempts), "certified plans"] : []),
            ...(tested > 0 ? [`flights that held: ${of(held.hits, held.attempts)}`] :
                             [of(held.hits, held.attempts), "flights that held"]),
            failed_flights.attempts > 0 ? `failed flights: ${number(failed_flights.hits, ",d")}, 95 % interval ${
                                              percent(failed_flights.low)} to ${percent(failed_flights.high)} %` :
                                          "not run yet"
        ];
    }
    return [
        of(failed.attempts - failed.hits, failed.attempts),
        `flights in other worlds held, of ${counted(flown, "plan", "plans")}`,
        `failed: ${percent(failed.hits / failed.attempts)} %, 95 % interval ${percent(failed.low)} to ${
            percent(failed.high)} %`,
        ...(tested > 0 ? [`certified plans: ${of(certified.hits, certified.attempts)} seeds`] : []),
        `held in the nominal world: ${of(held.hits, held.attempts)} seeds`
    ];
}

export function make_verdict(model) {
    const {kind, mark, title, lines} = verdict_of(model);
    const tile = ({name, totals}) => {
        const [figure, ...others] = tile_of(totals);
        return h(
            "div", null, h("dt", null, foreign(name)),
            h("dd", null, h("span", {class: "figure"}, figure),
              others.map((line) => h("span", {class: "muted"}, line))));
    };
    return h(
        "section", {class: `verdict ${kind}`, "aria-labelledby": "verdict-title"},
        h("div", {class: "verdict-text"}, h("span", {class: "verdict-mark", "aria-hidden": "true"}, mark),
          h("div", null, h("h2", {id: "verdict-title"}, title),
            lines.map((text) => h("p", null, foreign(text))))),
        h("dl", {class: "figures of-planners"}, model.planners.map(tile)));
}
