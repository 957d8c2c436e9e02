// A probability with its interval, as a bar on a scale from zero.

import {scaleLinear} from "d3-scale";

import {h} from "./dom.js";
import {quantity} from "./format.js";

/** In percent, with the digits that matter: 0.09 %, 0.9 %, 12 %. */
export function percent(share) {
    const value = 100 * share;
    return quantity(value, value > 0 && value < 10 ? ".2~r" : ".3~r", "%");
}

/** What somebody has set, with all of its digits: a rounded promise is another one. */
export const given_percent = (share) => quantity(100 * share, ".7~r", "%");

/**
 * @param {{estimate: number, low: number, high: number}} probability no number as estimate: there is none
 * @param {string} of what it is the probability, for those who do not see the bar
 * @param {number} confidence of the interval
 * @param {{name: string, value: number}|null} limit a line to hold the interval against
 */
export function make_probability_bar(probability, of, confidence, limit = null) {
    const {estimate, low, high} = probability;
    const end = Math.min(1, 1.25 * Math.max(high, limit?.value ?? 0)) || 1;
    const place = scaleLinear().domain([0, end]).range([0, 100]);
    const interval = `${given_percent(confidence)} interval ${percent(low)} to ${percent(high)}`;
    const limit_text = limit ? `${limit.name}: ${given_percent(limit.value)}` : "";
    const ticks = place.ticks(4);
    return h(
        "div", {class: "probability"},
        h("p", null, h("span", {class: "figure"}, percent(estimate)), " ", h("span", {class: "muted"}, interval)),
        h("div", {
            class: "probability-track",
            role: "img",
            "aria-label": `${of}: ${percent(estimate)}, ${interval}${limit ? `; ${limit_text}` : ""}`
        },
          h("span", {
              class: `probability-interval${!limit ? "" : high <= limit.value ? " within" : " beyond"}`,
              style: `left: ${place(low)}%; width: ${place(high) - place(low)}%`
          }),
          Number.isFinite(estimate) ?
              h("span", {class: "probability-estimate", style: `left: ${place(estimate)}%`}) :
              null,
          limit ? h("span", {class: "probability-limit", style: `left: ${place(limit.value)}%`}) : null),
        h("div", {class: "probability-ticks", "aria-hidden": "true"},
          ticks.map((tick) => h("span", {style: `left: ${place(tick)}%`}, percent(tick)))),
        limit ?
            h("p", {class: "muted"}, h("span", {class: "key limit", "aria-hidden": "true"}), ` ${limit_text}`) :
            null);
}
