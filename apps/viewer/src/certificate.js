// The certificate of a plan: how it flew in worlds that the search had not seen.

import {h} from "./dom.js";
import {meters, number} from "./format.js";
import {given_percent, make_probability_bar} from "./probability_bar.js";
import {outcome_name, outcome_text} from "./words.js";
import {make_worst_worlds} from "./worst_worlds.js";

const causes_of = ({causes}) => Object.entries(causes).sort((a, b) => b[1] - a[1]);

const worlds_text = ({failures, worlds}) =>
    `${number(failures, ",d")} of ${number(worlds, ",d")} ${worlds === 1 ? "world" : "worlds"} failed`;

/** What the certificate says, in one sentence; null without one. */
export function certificate_sentence({certificate}) {
    if (!certificate) {
        return null;
    }
    const {given, worlds, max_failure_probability, confidence, failure_probability} = certificate;
    if (given) {
        return `Certified: ${worlds_text(certificate)}; the failure probability is at most ` +
            `${given_percent(max_failure_probability)} with ${given_percent(confidence)} confidence.`;
    }
    if (worlds === 0) {
        return "Not certified: the search ended before its first flights.";
    }
    const causes = causes_of(certificate).map(([cause, count]) => `${outcome_name(cause)} ${number(count, ",d")}`);
    const is_open = failure_probability.low <= max_failure_probability;
    return `Not certified: ${worlds_text(certificate)}${causes.length > 0 ? ` (${causes.join(", ")})` : ""}` +
        `${is_open ? ", but these are too few worlds to tell" : ""}.`;
}

function make_probability({certificate}) {
    const {worlds, failure_probability, confidence, max_failure_probability, attempts} = certificate;
    const probability = worlds > 0 ? failure_probability : {...failure_probability, estimate: NaN};
    return h(
        "div", {class: "card"}, h("h3", null, "Failure probability"),
        make_probability_bar(
            probability, "Failure probability", confidence, {name: "allowed", value: max_failure_probability}),
        attempts > 1 ? h("p", {class: "muted"},
                         `${number(attempts, ",d")} plans of this search asked for a certificate; they share the error.`) :
                       null);
}

function make_quantiles({certificate}) {
    const {p01, p10, p50} = certificate.clearance_m;
    const row = (name, value) => h("tr", null, h("th", {scope: "row"}, name), h("td", null, value));
    const causes = causes_of(certificate);
    const most = causes[0]?.[1] ?? 1;
    return h(
        "div", {class: "card"}, h("h3", null, "Minimum clearance of the flights"),
        h("table", {class: "numbers"},
          h("tbody", null, row("99 % keep at least", meters(p01)), row("90 % keep at least", meters(p10)),
            row("half keep at least", meters(p50)))),
        h("h3", {class: "second"}, "Failures by cause"),
        causes.length > 0 ?
            h("table", {class: "bars"},
              h("tbody", null,
                causes.map(
                    ([cause, count]) =>
                        h("tr", null, h("th", {scope: "row"}, outcome_text(cause)),
                          h("td", {class: "count"}, number(count, ",d")),
                          h("td", {class: "bar-cell", "aria-hidden": "true"},
                            h("span", {class: "bar", style: `width: ${((100 * count) / most).toFixed(2)}%`})))))) :
            h("p", null, certificate.worlds > 0 ? "No flight failed." : "The search ended before the first flights."));
}

function make_worst({certificate}) {
    const {worst} = certificate;
    if (worst.length === 0) {
        return null;
    }
    const {world} = worst[0];
    return make_worst_worlds(
        worst, `To fly world ${world} again; put the number of another world there:`,
        `downwash execute effective.yaml --plan solution.json --world ${world} --out world-${world}`);
}

/** The panel of the certificate; null without one. */
export function make_certificate({solution}) {
    if (!solution.certificate) {
        return null;
    }
    return h(
        "section", {class: "certificate", "aria-labelledby": "certificate-title"},
        h("h2", {id: "certificate-title"}, "Certificate"),
        h("div", {class: "cards"}, make_probability(solution), make_quantiles(solution), make_worst(solution)));
}
