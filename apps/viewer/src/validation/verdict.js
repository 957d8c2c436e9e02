// The head of the page: whether the plan is valid, and the figures of the judge's flight.

import {foreign, h} from "../dom.js";
import {meters, number, quantity, seconds} from "../format.js";
import {percent} from "../probability_bar.js";
import {outcome_text} from "../words.js";

const places = (count) => `${number(count, ",d")} ${count === 1 ? "place" : "places"}`;

function lines_of({findings, has_flight_claims, seed}) {
    const {outcome, disagreements, world, runs, failures, failure_probability: probability} = findings;
    const where = world === undefined ? "" : ` in world ${world} of seed ${seed}`;
    const claims = disagreements.length > 0 ? `, and the file is contradicted in ${places(disagreements.length)}` :
        has_flight_claims                   ? ", as the file says" :
                                              "";
    const lines = [`The judge's flight${where} ${outcome_text(outcome)}${claims}.`];
    if (!has_flight_claims) {
        lines.push("The file says nothing about a flight; only its plan was checked.");
    }
    if (runs !== undefined) {
        lines.push(
            `${number(failures, ",d")} of ${number(runs, ",d")} worlds failed: the failure probability is ` +
            `${percent(probability.low)} to ${percent(probability.high)} (95 % interval).`);
    }
    return lines;
}

function figures_of({findings}) {
    const list = [
        {name: "Duration", value: seconds(findings.duration_s)},
        {name: "Energy", value: quantity(findings.energy_j, ",.0f", "J")},
        {
            name: "Minimum clearance",
            value: meters(findings.min_clearance_m),
            note: findings.min_clearance_m === null ? "no obstacles" : ""
        },
        {name: "Goal error", value: meters(findings.goal_error_m)},
        {name: "Disagreements", value: number(findings.disagreements.length, ",d"), note: "with the file"},
    ];
    if (findings.runs !== undefined) {
        const of_runs = `of ${number(findings.runs, ",d")} worlds`;
        list.push(
            {name: "Failures", value: number(findings.failures, ",d"), note: of_runs},
            {name: "Collisions", value: number(findings.collisions, ",d"), note: of_runs});
    }
    return list;
}

export function make_head({problem, description, findings, seed}, theme_switch) {
    const fact = (key, value) => h("span", {class: "fact"}, h("span", {class: "muted"}, key), " ", value);
    return h(
        "header", {class: "head"},
        h("div", {class: "head-line"}, h("div", {class: "brand"}, "Downwash validation"), theme_switch),
        h("h1", null, foreign(problem)),
        description ? h("p", {class: "description", tabindex: description.length > 400 ? "0" : null},
                        foreign(description)) :
                      null,
        h("p", {class: "facts"}, fact("worlds", number(findings.runs ?? 0, ",d")), fact("seed", String(seed))));
}

export function make_verdict(report) {
    const {is_valid} = report;
    return h(
        "section", {class: `verdict ${is_valid ? "good" : "bad"}`, "aria-labelledby": "verdict-title"},
        h("div", {class: "verdict-text"},
          h("span", {class: "verdict-mark", "aria-hidden": "true"}, is_valid ? "✓" : "✕"),
          h("div", null, h("h2", {id: "verdict-title"}, is_valid ? "The plan is valid" : "The plan is not valid"),
            lines_of(report).map((text) => h("p", null, text)))),
        h("dl", {class: "figures"},
          figures_of(report).map(
              ({name, value, note}) =>
                  h("div", null, h("dt", null, name),
                    h("dd", null, h("span", {class: "figure"}, value),
                      note ? h("span", {class: "muted"}, note) : null)))));
}

function value_text(value) { return typeof value === "number" ? number(value, ".6~g") : foreign(value); }

/** Where the file and the judge differ; null where they do not. */
export function make_disagreements({findings}) {
    if (findings.disagreements.length === 0) {
        return null;
    }
    return h(
        "section", {class: "disagreements", "aria-labelledby": "disagreements-title"},
        h("h2", {id: "disagreements-title"}, "Disagreements with the file"),
        h("div", {class: "scroll", tabindex: "0", role: "region", "aria-label": "Disagreements"},
          h("table", {class: "numbers"},
            h("thead", null,
              h("tr", null, ["what", "the file says", "the judge finds"].map((name) => h("th", {scope: "col"}, name)))),
            h("tbody", null,
              findings.disagreements.map(
                  ({what, file, judge}) =>
                      h("tr", null, h("th", {scope: "row", class: "foreign-name"}, foreign(what)),
                        h("td", null, value_text(file)), h("td", null, value_text(judge))))))));
}
