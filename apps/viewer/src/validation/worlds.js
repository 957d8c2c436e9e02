// Flights in many worlds: how often they fail, how near they come, and which are the worst.

import {h} from "../dom.js";
import {meters, quantity} from "../format.js";
import {make_probability_bar} from "../probability_bar.js";
import {make_worst_worlds} from "../worst_worlds.js";

const confidence = 0.95;

function make_quantiles({clearance_m, tracking_error_m, run_energy_j}) {
    const row = (name, values) =>
        h("tr", null, h("th", {scope: "row"}, name), values.map((value) => h("td", null, value)));
    const table = (names, ...rows) =>
        h("table", {class: "numbers"},
          h("thead", null, h("tr", null, h("td"), names.map((name) => h("th", {scope: "col"}, name)))),
          h("tbody", null, rows));
    const upper = ({p50, p90, p99}, as) => [p50, p90, p99].map(as);
    const joules = (value) => quantity(value, ",.0f", "J");
    return h(
        "div", {class: "card"}, h("h3", null, "Quantiles over the flights"),
        table(
            ["1 %", "10 %", "median"],
            row("min. clearance", [clearance_m.p01, clearance_m.p10, clearance_m.p50].map(meters))),
        h("div", {class: "second-table"},
          table(
              ["median", "90 %", "99 %"], row("tracking error", upper(tracking_error_m, meters)),
              row("energy", upper(run_energy_j, joules)))),
        h("p", {class: "muted"}, "Energies include flights that ended early."));
}

function make_worst({findings: {worst}, command}) {
    return make_worst_worlds(
        worst, "The judge flies one of them again with", command.replace(/ --runs \d+/, ` --world ${worst[0].world}`));
}

/** null without flights in worlds. */
export function make_worlds(report) {
    const {findings} = report;
    if (findings.runs === undefined) {
        return null;
    }
    return h(
        "section", {class: "worlds", "aria-labelledby": "worlds-title"},
        h("h2", {id: "worlds-title"}, "In many worlds"),
        h("div", {class: "cards"},
          h("div", {class: "card"}, h("h3", null, "Failure probability"),
            make_probability_bar(findings.failure_probability, "Failure probability", confidence),
            h("h3", {class: "second"}, "Collision probability"),
            make_probability_bar(findings.collision_probability, "Collision probability", confidence),
            findings.lateral_collisions > 0 ?
                h("p", {class: "muted"},
                  `${findings.lateral_collisions} of ${findings.collisions} only because the vehicle is beside its plane.`) :
                null),
          make_quantiles(findings), make_worst(report)));
}
