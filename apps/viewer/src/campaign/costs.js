// Cost of the best plan so far over time: median and quartiles over all attempted seeds.

import {s} from "../dom.js";
import {shown_cells} from "./model.js";
import {around, make_figure, make_panel, plain} from "../panel.js";

function points(curve, quantile) {
    return curve.filter(({cost}) => Number.isFinite(cost[quantile])).map(({time_s, cost}) => [time_s, cost[quantile]]);
}

/** A search has a cost until it finds a cheaper plan: corners of the steps between the points, the first point first. */
function stairs(list) {
    return list.flatMap(([time_s, cost], i) => i > 0 ? [[time_s, list[i - 1][1]], [time_s, cost]] : [[time_s, cost]]);
}

function joined(list, {x, y}) {
    return list.map(([time_s, cost]) => `${x(time_s).toFixed(1)} ${y(cost).toFixed(1)}`).join("L");
}

function draw_curve({cost_curve, planner}, frame) {
    const [low, median, high] = ["25", "50", "75"].map((quantile) => stairs(points(cost_curve, quantile)));
    const parts = [];
    if (high.length > 0) {
        const from = high[0][0];
        const lower = low.filter(([time_s]) => time_s >= from).reverse();
        parts.push(
            s("path", {class: `band ${planner.style}`, d: `M${joined(high, frame)}L${joined(lower, frame)}Z`}));
    }
    if (median.length > 0) {
        parts.push(s("path", {class: `line ${planner.style}`, d: `M${joined(median, frame)}`}));
    }
    return parts;
}

export function make_costs(model) {
    if (model.figures.stop_at_first_solution) {
        return null;
    }
    const panels = model.experiments.map((experiment) => make_panel(model, experiment.name, () => {
        const cells = shown_cells(model, experiment).filter((cell) => points(cell.cost_curve, "50").length > 0);
        if (cells.length === 0) {
            return "None of the planners shown has solved half of its seeds.";
        }
        const costs = cells.flatMap(
            ({cost_curve}) => ["25", "50", "75"].flatMap((q) => points(cost_curve, q).map(([, cost]) => cost)));
        const times = cells.flatMap(({cost_curve}) => cost_curve.map(({time_s}) => time_s));
        const told = cells.map(({planner, cost_curve}) => {
            const median = points(cost_curve, "50"), last = median[median.length - 1];
            return `${planner.name}: median ${plain(median[0][1])} at ${plain(median[0][0])} s, ` +
                `${plain(last[1])} at ${plain(last[0])} s`;
        });
        return {
            label: `Cost of the best plan over the time of the search. ${told.join("; ")}.`,
            x: {
                name: "time of the search [s]",
                domain: [Math.min(...times), Math.max(Math.max(...times), 1.5 * Math.min(...times))],
                is_log: true
            },
            y: {
                name: `cost${experiment.unit ? ` [${experiment.unit}]` : ""}`,
                domain: around(Math.min(...costs), Math.max(...costs))
            },
            draw: (frame) => cells.map((cell) => draw_curve(cell, frame)),
        };
    }));
    return make_figure(
        "costs", "Cost over time",
        "Of the best plan so far: median and quartiles over all attempted seeds, those without a plan counting as " +
            "infinite. It is the executed cost or, where plans are not executed before they count, the planned " +
            "cost. Planned costs differ in physics: compare the variants by executed cost, above.",
        panels);
}
