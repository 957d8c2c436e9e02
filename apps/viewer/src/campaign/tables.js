// The figures as tables, for those who want numbers; the same as in the Markdown report.

import {foreign, h} from "../dom.js";
import {meters, number} from "../format.js";
import {kind_of} from "./model.js";
import {plain} from "../panel.js";

const share = ({hits, attempts, low, high}) =>
    `${hits}/${attempts} [${number(100 * low, ".1f")}, ${number(100 * high, ".1f")} %]`;
export const percent_text = ({hits, attempts, low, high}) =>
    `${number((100 * hits) / attempts, ".1f")} % [${number(100 * low, ".1f")}, ${number(100 * high, ".1f")}]`;
const seconds = (value) => !Number.isFinite(value) ? "none" :
    value < 1 ? `${number(1e3 * value, ".3~g")} ms` : `${number(value, ".3~g")} s`;
const cost = (value) => (Number.isFinite(value) ? plain(value) : "none");
const distance = (metres) => metres.length === 0 ?
    "" :
    `, ${number(Math.min(...metres), ".3~g")} to ${number(Math.max(...metres), ".3~g")} m from the goal region`;
const p_value = (p) => (p === null ? "–" : p < 0.0001 ? "< 0.0001" : number(p, ".2g"));

/** @param {string[]} names of columns; the first `texts` hold words */
function table(title, names, texts, rows) {
    const cell = (content, index) => index === 0 ? h("th", {scope: "row", class: "foreign-name"}, foreign(content)) :
                                                   h("td", {class: index < texts ? "words" : null}, foreign(content));
    return h(
        "div", {class: "scroll", tabindex: "0", role: "region", "aria-label": title},
        h("table", {class: "numbers campaign-table"},
          h("thead", null, h("tr", null, names.map((name, i) => h("th", {
                                                       scope: "col",
                                                       class: i < texts ? "words" : null
                                                   },
                                                                  name)))),
          h("tbody", null, rows.map((row) => h("tr", null, row.map(cell))))));
}

const folded = (title, content) => h("details", null, h("summary", null, title), content);

function cells_of(model) {
    return model.experiments.flatMap(
        (experiment) => experiment.cells.map((cell) => ({cell, place: [experiment.name, cell.planner.name]})));
}

const causes = (counts) => Object.entries(counts).map(([cause, count]) => `${cause} ${count}`).join(", ") || "none";

function flights_table(model) {
    return table(
        "Flights",
        [
            "problem", "planner", "flight held", "found a plan", "its flight failed", "least clearance", "discarded",
            "failures by cause"
        ],
        2,
        cells_of(model).map(
            ({cell, place}) =>
                [...place, share(cell.held), share(cell.solved), share(cell.failed_flights),
                 cell.least_clearance_m === null ? "–" : meters(cell.least_clearance_m), String(cell.discarded),
                 causes(cell.failures_by_cause)]));
}

/** What becomes of plans in other worlds than the nominal one; null where nobody has tried. */
function worlds_table(model) {
    const rows = cells_of(model).filter(({cell}) => cell.in_worlds);
    return rows.length === 0 ? null : table(
        "In other worlds",
        ["problem", "planner", "plans flown", "failed", "certified", "first certified, median", "95 %"], 2,
        rows.map(({cell: {in_worlds: figures}, place}) =>
                     [...place, String(figures.flown), figures.flown > 0 ? share(figures.failed) : "none",
                      figures.tested > 0 ? share(figures.certified) : "not tested",
                      seconds(figures.first_certified_s["50"]), seconds(figures.first_certified_s["95"])]));
}

/** The parameters that make plans fail alone. */
function parameters_table(model) {
    const rows = cells_of(model).flatMap(
        ({cell, place}) => (cell.in_worlds?.alone ?? [])
                               .filter((of) => of.failed_low + of.failed_high > 0)
                               .map((of) => [...place, of.parameter, `${of.failed_low}/${of.plans}`,
                                             `${of.failed_high}/${of.plans}`]));
    return rows.length === 0 ? null : table(
        "One parameter alone at the ends of its spread: plans that fail",
        ["problem", "planner", "parameter", "at 2 %", "at 98 %"], 3, rows);
}

const quantiles = (spread, text) => ["25", "50", "75", "95"].map((q) => text(spread[q]));

function times_table(model) {
    return table(
        "Time to the first solution",
        [
            "problem", "planner", "25 %", "median", "75 %", "95 %", "verified, median", "95 %", "whole run, median",
            "95 %"
        ],
        2,
        cells_of(model).map(
            ({cell, place}) =>
                [...place, ...quantiles(cell.first_solution_s, seconds), seconds(cell.verified_s["50"]),
                 seconds(cell.verified_s["95"]), seconds(cell.whole_run_s["50"]), seconds(cell.whole_run_s["95"])]));
}

function costs_table(model) {
    const moments = model.experiments[0]?.cells[0]?.cost_over_time ?? [];
    const text = (spread) => Number.isFinite(spread["25"]) ?
        `${cost(spread["50"])} [${cost(spread["25"])}, ${cost(spread["75"])}]` :
        "none";
    return table(
        "Costs, median and quartiles",
        ["problem", "planner", ...moments.map(({time_s}) => `after ${seconds(time_s)}`), "executed", "minimum executed"], 2,
        cells_of(model).map(
            ({cell, place}) =>
                [...place, ...cell.cost_over_time.map((at) => text(at.cost)), text(cell.flown_cost),
                 cost(cell.flown_cost["0"])]));
}

function pairs_table({figures}) {
    return table(
        "Paired comparisons",
        [
            "problem", "first", "second", "measure", "first smaller", "second smaller", "equal", "sign test p", "pairs",
            "median difference", "signed rank p"
        ],
        4,
        figures.comparisons.map(
            (pair) =>
                [pair.experiment, pair.first, pair.second, pair.measure, String(pair.first_smaller),
                 String(pair.second_smaller), String(pair.equal), p_value(pair.sign_test_p), String(pair.pairs),
                 cost(pair.median_difference ?? NaN), p_value(pair.signed_rank_p)]));
}

function margins_tables({figures}) {
    return figures.margins.map((finding) => [
        h("p", null,
          `${kind_of(finding)}: `,
          finding.safe_margin_m === null ?
              "no margin that was tried is safe on all problems." :
              `safe on all problems from a margin of ${plain(finding.safe_margin_m)} m on.`),
        table(
            "Margins",
            ["problem", "safe there from", "with which it solves", "solved with the margin that is safe everywhere"], 1,
            finding.experiments.map(
                ({experiment, safe_margin_m, solved_when_safe: alone, solved_when_safe_everywhere: everywhere}) =>
                    [experiment, safe_margin_m === null ? "no margin tried" : `${plain(safe_margin_m)} m`,
                     alone === null ? "none" : share(alone), everywhere === null ? "none" : share(everywhere)]))
    ]);
}

function bars_table({figures}) {
    return table(
        "Targets", ["problem", "planner", "target", "found", ""], 4,
        figures.bars.map(
            ({experiment, planner, bar, found, kept}) => [experiment, planner, bar, found, kept ? "met" : "missed"]));
}

function failures_list({figures}) {
    if (figures.failures.length === 0) {
        return h("p", null, "Every run has a flight that held.");
    }
    return table(
        "Failures", ["problem", "planner", "cause", "count", "seeds"], 3,
        figures.failures.map(
            ({experiment, planner, cause, count, seeds, nearest_approach_m}) =>
                [experiment, planner, cause + distance(nearest_approach_m), String(count),
                 seeds.join(" ") + (count > seeds.length ? " …" : "")]));
}

export function make_tables(model) {
    const {figures} = model;
    const count = figures.failures.reduce((sum, failure) => sum + failure.count, 0);
    const worlds = worlds_table(model), parameters = parameters_table(model);
    return h(
        "section", {class: "tables", id: "tables", "aria-labelledby": "tables-title"},
        h("h2", {id: "tables-title"}, "Tables"),
        h("p", {class: "muted note"},
          "Shares are of all attempted seeds, with 95 % Wilson intervals. A search found a plan if the planner accepted it by " +
              "what its variant knows. A flight has failed if the reported plan, executed " +
              "with direct aerodynamics up to the end of the hover at the goal, collided, left the flyable area, became " +
              "unstable or missed the goal. Discarded are plans that failed so, came nearer than the margin " +
              "or got no certificate, and were not reported. Verified is the time to the first plan that has passed these " +
              "checks."),
        worlds === null ? null : [h("h3", null, "In other worlds"), worlds, h("h3", null, "In the nominal world")],
        flights_table(model), figures.bars.length > 0 ? folded(`Targets (${figures.bars.length})`, bars_table(model)) : null,
        parameters === null ? null : folded("Parameters that decide alone", parameters),
        folded("Time to the first solution", times_table(model)), folded("Costs", costs_table(model)),
        figures.comparisons.length > 0 ? folded("Paired comparisons", pairs_table(model)) : null,
        figures.margins.length > 0 ? folded("Margins", margins_tables(model).flat()) : null,
        folded(`The ${number(count, ",d")} runs without a flight that held`, failures_list(model)),
        figures.left_out.length > 0 ?
            h("p", {class: "muted"}, "Left out, since it does not exist: ", foreign(figures.left_out.join("; "))) :
            null);
}

/** Where the runs were made; null where that was not recorded. */
function machines_table({machines}) {
    return machines.length === 0 ? null : table(
        "Machines", ["host", "processor", "instruction set", "runs", "median load", "maximum load"], 3,
        machines.slice(0, 100).map(
            ({host, processor, instruction_set, runs, median_load, max_load}) =>
                [host, processor, instruction_set, String(runs), plain(median_load), plain(max_load)]));
}

export function make_settings({figures}) {
    return h(
        "section", {class: "repeat", "aria-labelledby": "settings-title"},
        h("h2", {id: "settings-title"}, "What was run"),
        h("dl", {class: "pairs"},
          Object.entries(figures.settings)
              .map(([name, value]) => h("div", null, h("dt", null, foreign(name)),
                                        h("dd", {class: /^[0-9a-f]{64}$/.test(value) ? "hash" : null},
                                          foreign(value ?? "none"))))),
        machines_table(figures));
}
