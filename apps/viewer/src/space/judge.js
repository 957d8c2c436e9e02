// What `validate` found: the judge's own flight, where it contradicts the file, and flights in many worlds.

import {h} from "../dom.js";
import {meters, quantity, seconds} from "../format.js";
import {make_probability_bar} from "../probability_bar.js";
import {make_disagreements} from "../validation/verdict.js";
import {outcome_name} from "../words.js";

const confidence = 0.95;

const table = (...rows) => h("table", {class: "numbers"}, h("tbody", null, rows));
const row = (name, value) => h("tr", null, h("th", {scope: "row"}, name), h("td", null, value));

function make_flight({outcome, duration_s, energy_j, min_clearance_m, goal_error_m}) {
    return h(
        "div", {class: "card"}, h("h3", null, "The judge's flight"),
        table(
            row("outcome", outcome_name(outcome)), row("duration", seconds(duration_s)),
            row("energy", quantity(energy_j, ",.0f", "J")), row("minimum clearance", meters(min_clearance_m)),
            row("goal error", meters(goal_error_m))));
}

function make_probabilities({failure_probability, collision_probability}) {
    const bar = (title, probability) =>
        probability ? [h("h3", null, title), make_probability_bar(probability, title, confidence)] : null;
    return h(
        "div", {class: "card"}, bar("Failure probability", failure_probability),
        bar("Collision probability", collision_probability));
}

function make_worst(worst) {
    return h(
        "div", {class: "card"}, h("h3", null, "Worst worlds"),
        h("div", {class: "scroll", tabindex: "0", role: "region", "aria-label": "Worst worlds"},
          h("table", {class: "numbers worst-worlds"},
            h("thead", null,
              h("tr", null, ["world", "outcome", "min. clearance"].map((name) => h("th", {scope: "col"}, name)))),
            h("tbody", null,
              worst.map(
                  ({world, outcome, min_clearance_m}) =>
                      h("tr", null, h("th", {scope: "row"}, String(world)), h("td", null, outcome_name(outcome)),
                        h("td", null, meters(min_clearance_m))))))));
}

function make_clearances({p01, p10, p50}) {
    return h(
        "div", {class: "card"}, h("h3", null, "Minimum clearance of the flights"),
        table(
            row("99 % keep at least", meters(p01)), row("90 % keep at least", meters(p10)),
            row("half keep at least", meters(p50))));
}

/** null where nothing was judged. */
export function make_judge({report: {findings}}) {
    if (!findings) {
        return null;
    }
    const has_worlds = findings.runs !== undefined;
    return h(
        "section", {class: "judge", "aria-labelledby": "judge-title"},
        h("h2", {id: "judge-title"}, has_worlds ? "An independent judge, also in many worlds" : "An independent judge"),
        h("div", {class: "judge-cards"}, make_flight(findings), has_worlds ? make_probabilities(findings) : null,
          findings.clearance_m ? make_clearances(findings.clearance_m) : null,
          findings.worst?.length > 0 ? make_worst(findings.worst) : null),
        make_disagreements({findings: {disagreements: [], ...findings}}));
}
