// What matters: how often flights fail by the value of each parameter of the worlds.

import {foreign, h, s} from "../dom.js";
import {number} from "../format.js";
import {make_figure, make_panel} from "../panel.js";
import {ranked} from "./model.js";

const most_panels = 6;
const percent = (share) => number(share, ".0%");
const correlation = (value) => number(value, "+.2f");

function draw_shares(shares, mean, {x, y}) {
    return [
        shares.map((share, i) => s("rect", {
                                 class: "share-bar",
                                 x: x(i / shares.length) + 1,
                                 width: x(1 / shares.length) - x(0) - 2,
                                 y: y(share),
                                 height: y(0) - y(share)
                             },
                                   s("title", null, `${percent(share)} of tenth ${i + 1}`))),
        s("path", {class: "zero", d: `M${x(0)} ${y(mean)}H${x(1)}`})
    ];
}

function make_shares({parameter, rank_correlation, failure_share_by_decile: shares}, mean, greatest) {
    return make_panel({}, `${parameter}, correlation ${correlation(rank_correlation)}`, () => ({
        label: `Failures by ${parameter}: ${percent(shares[0])} in the tenth of the worlds with the least values, ${
            percent(shares[shares.length - 1])} in that with the greatest.`,
        height: 170,
        x: {name: "worlds, by rising value", domain: [0, 1], text: percent},
        y: {name: "failures", domain: [0, 1.05 * greatest], text: percent},
        draw: (frame) => draw_shares(shares, mean, frame),
    }));
}

function make_table(parameters) {
    return h(
        "details", null, h("summary", null, `All ${parameters.length} parameters as a table`),
        h("div", {class: "scroll", tabindex: "0", role: "region", "aria-label": "Parameters"},
          h("table", {class: "numbers"},
            h("thead", null,
              h("tr", null,
                ["parameter", "rank correlation", "failures, least tenth", "failures, greatest tenth"].map(
                    (name) => h("th", {scope: "col"}, name)))),
            h("tbody", null,
              parameters.map(
                  ({parameter, rank_correlation, failure_share_by_decile: shares}) =>
                      h("tr", null, h("th", {scope: "row", class: "foreign-name"}, foreign(parameter)),
                        h("td", null, correlation(rank_correlation)),
                        h("td", null, shares ? percent(shares[0]) : "–"),
                        h("td", null, shares ? percent(shares[shares.length - 1]) : "–")))))));
}

/** null without flights in worlds, or where no parameter matters. */
export function make_sensitivity({findings}) {
    const parameters = ranked(findings.sensitivity ?? []);
    if (parameters.length === 0) {
        return null;
    }
    const shown = parameters.slice(0, most_panels).filter((each) => each.failure_share_by_decile);
    const greatest = Math.max(...shown.flatMap((each) => each.failure_share_by_decile), 0);
    const mean = findings.failures / findings.runs;
    const chance = number(2 / Math.sqrt(findings.runs), ".2f");
    const note = `Failures in each tenth of the worlds, by rising value of a parameter; the dashed line is the mean. The ` +
        "parameters are sorted by the rank correlation of their value with the clearance, from −1 to 1. Below " +
        `${chance} it may be chance.`;
    const panels = greatest > 0 ? shown.map((each) => make_shares(each, mean, greatest)) :
                                  h("p", null, findings.failures > 0 ? "There are too few flights for tenths." : "No flight failed.");
    return make_figure("sensitivity", "What matters most", note, panels, make_table(parameters));
}
