// The search: cost over time, rejections, counts.

import {scaleLinear, scaleLog} from "d3-scale";

import {h, s} from "./dom.js";
import {cost, meters, number, quantity, seconds} from "./format.js";
import {range_of} from "./numbers.js";
import {keep_sized} from "./sizing.js";
import {log_ticks} from "./ticks.js";
import {cause_text} from "./words.js";

const margin = {
    left: 62,
    right: 12,
    top: 10,
    bottom: 34
};
const height = 220;

function draw_costs(svg, model, width) {
    const {planning} = model.solution;
    // A time of nothing has no place on a logarithmic axis.
    const least_s = 1e-4;
    const steps = planning.improvements.map((step) => ({...step, wall_s: Math.max(least_s, step.wall_s)}));
    const bottom = height - margin.bottom, right = width - margin.right;
    const first = Math.max(least_s, planning.first_solution_wall_s ?? steps[0].wall_s);
    const end = Math.max(planning.wall_s, steps[steps.length - 1].wall_s, 2 * least_s);
    const x = scaleLog().domain([Math.min(first, steps[0].wall_s) / 1.5, end]).range([margin.left, right]);
    const costs = steps.map((step) => step.cost);
    const {low, high} = range_of(costs), pad = 0.08 * (high - low) || 0.05 * high || 1;
    const y = scaleLinear().domain([Math.max(0, low - pad), high + pad]).range([bottom, margin.top]).nice(4);
    const shown_x = log_ticks(x, 4);
    let d = `M${x(steps[0].wall_s)} ${y(costs[0])}`;
    steps.slice(1).forEach((step) => {
        d += `H${x(step.wall_s)}V${y(step.cost)}`;
    });
    d += `H${right}`;
    const minor = x.ticks().map((t) => `M${x(t)} ${bottom}v3`).join("");
    svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
    svg.replaceChildren(
        s("path", {
            class: "grid-lines",
            d: [
                ...shown_x.map((t) => `M${x(t)} ${margin.top}V${bottom}`),
                ...y.ticks(4).map((v) => `M${margin.left} ${y(v)}H${right}`)
            ].join("")
        }),
        s("path", {class: "grid-lines strong", d: minor}),
        ...shown_x.map(
            (t) => s("text", {class: "tick", x: x(t), y: bottom + 15, "text-anchor": "middle"}, number(t, ".3~r"))),
        ...y.ticks(4).map(
            (v) =>
                s("text", {class: "tick", x: margin.left - 6, y: y(v), dy: "0.32em", "text-anchor": "end"},
                  number(v, v >= 1000 ? ",.0f" : "~r"))),
        s("text", {class: "axis-name", x: (margin.left + right) / 2, y: height - 4, "text-anchor": "middle"},
          "wall time of the search [s], logarithmic"),
        s("text", {
            class: "axis-name",
            transform: `translate(11 ${(margin.top + bottom) / 2}) rotate(-90)`,
            "text-anchor": "middle"
        },
          `cost${model.cost_unit ? ` [${model.cost_unit}]` : ""}`),
        s("path", {class: "first", d: `M${x(first)} ${margin.top}V${bottom}`}),
        s("text", {class: "limit-name", x: x(first) + 5, y: bottom - 6}, "first solution"),
        s("path", {class: "line flown", d}),
        ...steps.map((step) => s("circle", {class: "dot flown", cx: x(step.wall_s), cy: y(step.cost), r: 2.5})));
}

function make_costs(model) {
    const {planning} = model.solution;
    const steps = planning.improvements ?? [];
    if (steps.length === 0) {
        return h(
            "div", {class: "card"}, h("h3", null, "Cost over time"),
            h("p", {class: "muted"},
              "No plan was found, so there is no cost to show. What blocked it stands at the top and is marked in the scene."));
    }
    const last = steps[steps.length - 1];
    const told = (step) => `${cost(step.cost, model.cost_unit)} after ${seconds(step.wall_s)}`;
    const label = "Cost of the best plan over the wall time of the search: " +
        `${told(steps[0])}, ${told(last)}, in ${steps.length} steps.`;
    const svg = s("svg", {class: "plot-svg cost-svg", role: "img", "aria-label": label});
    const card =
        h("div", {class: "card"}, h("h3", null, "Cost over time"), svg,
          h("details", null, h("summary", null, `The ${steps.length} steps as a table`),
            h("table", {class: "numbers"},
              h("thead", null,
                h("tr", null, h("th", {scope: "col"}, "after"), h("th", {scope: "col"}, "iteration"),
                  h("th", {scope: "col"}, "cost"))),
              h("tbody", null,
                steps.map(
                    (step) =>
                        h("tr", null, h("td", null, quantity(step.wall_s, ".3f", "s")),
                          h("td", null, number(step.iteration, ",d")),
                          h("td", null, cost(step.cost, model.cost_unit))))))));
    keep_sized(svg, 330, (width) => draw_costs(svg, model, width));
    return card;
}

function make_rejections({solution}) {
    const entries = Object.entries(solution.planning.rejected ?? {}).sort((a, b) => b[1] - a[1]);
    const met = entries.filter(([, count]) => count > 0), never = entries.filter(([, count]) => count === 0);
    const most = met[0]?.[1] ?? 1;
    return h(
        "div", {class: "card"}, h("h3", null, "Rejections by cause"),
        met.length > 0 ?
            h("table", {class: "bars"},
              h("tbody", null,
                met.map(
                    ([cause, count]) =>
                        h("tr", null, h("th", {scope: "row"}, cause_text(cause)),
                          h("td", {class: "count"}, number(count, ",d")),
                          h("td", {class: "bar-cell", "aria-hidden": "true"},
                            h("span", {class: "bar", style: `width: ${((100 * count) / most).toFixed(2)}%`})))))) :
            h("p", null, "Nothing was rejected."),
        never.length > 0 ? h("p", {class: "muted"}, `Never: ${never.map(([cause]) => cause_text(cause)).join(", ")}.`) :
                           null);
}

function make_counts({solution, tree}) {
    const {planning} = solution;
    const row = (name, value) => h("tr", null, h("th", {scope: "row"}, name), h("td", null, value));
    return h(
        "div", {class: "card"}, h("h3", null, "Counts"),
        h("table", {class: "numbers"},
          h("tbody", null, row("iterations", number(planning.iterations, ",d")),
            row("edges flown", number(planning.edges_simulated, ",d")),
            row("flight simulated", quantity(planning.simulated_s, ",.0f", "s")),
            row("states checked", number(planning.states_checked, ",d")),
            tree ? row("nodes of the tree shown", number(tree.nodes, ",d")) : null,
            row("search", seconds(planning.wall_s)), row("aero map", seconds(planning.map_wall_s)),
            row("flight of the plan", seconds(planning.flight_wall_s)), row("threads", String(solution.threads ?? "–")),
            Number.isFinite(planning.nearest_approach_m) ?
                row("nearest to the goal region", meters(planning.nearest_approach_m)) :
                null)));
}

/** The panel of the search; null before there was one. */
export function make_search(model) {
    if (!model.solution.planning) {
        return null;
    }
    return h(
        "section", {class: "search", "aria-labelledby": "search-title"}, h("h2", {id: "search-title"}, "Search"),
        h("div", {class: "cards"}, make_costs(model), make_rejections(model), make_counts(model)));
}
