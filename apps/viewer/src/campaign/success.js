// Shares of seeds over time and over cost, with the band of their Wilson interval.

import {s} from "../dom.js";
import {number, quantity} from "../format.js";
import {shown_cells} from "./model.js";
import {around, make_figure, make_panel, plain} from "../panel.js";

const percent = (share) => number(share, ".0%");
const share_axis = {
    name: "share of seeds",
    domain: [0, 1.02],
    text: percent
};

/** Right-continuous steps through [value, {low, share, high}], from the left edge of the frame to its right one. */
function stepped(steps, frame, style) {
    const {x, y, left, right} = frame;
    const edge = (name) => {
        let d = `M${left} ${y(0)}`;
        steps.forEach((step) => {
            d += `H${x(step.at).toFixed(1)}V${y(step[name]).toFixed(1)}`;
        });
        return `${d}H${right}`;
    };
    // The lower edge walked backwards closes the band.
    const low = [`L${right} ${y(steps.length > 0 ? steps[steps.length - 1].low : 0).toFixed(1)}`];
    for (let i = steps.length - 1; i >= 0; --i) {
        low.push(`H${x(steps[i].at).toFixed(1)}V${y(i > 0 ? steps[i - 1].low : 0).toFixed(1)}`);
    }
    return [
        s("path", {class: `band ${style}`, d: `${edge("high")}${low.join("")}Z`}),
        s("path", {class: `line ${style}`, d: edge("share")})
    ];
}

const time_steps = (cell) => cell.solved_over_time.map(
    ({time_s, solved}) => ({at: time_s, share: solved.hits / solved.attempts, low: solved.low, high: solved.high}));

export function make_success(model) {
    const panels = model.experiments.map((experiment) => make_panel(model, experiment.name, () => {
        const cells = shown_cells(model, experiment).map((cell) => ({cell, steps: time_steps(cell)}));
        const times = cells.flatMap(({steps}) => steps.map((step) => step.at)).filter((time) => time > 0);
        if (times.length === 0) {
            return "None of the planners shown has found a plan here.";
        }
        const end = model.time_limit_s ?? Math.max(...times);
        const told = cells.map(
            ({cell}) => `${cell.planner.name}: a plan for ${cell.solved.hits} of ${cell.solved.attempts} seeds, for half of all seeds within ${
                quantity(cell.first_solution_s["50"], ".3~g", "s")}`);
        return {
            label: `Share of seeds with a plan over the time of the search. ${told.join("; ")}.`,
            x: {
                name: "time of the search [s]",
                domain: around(Math.min(...times), Math.max(end, ...times), {is_log: true}),
                is_log: true
            },
            y: share_axis,
            draw: (frame) => cells.map(({cell, steps}) => stepped(steps, frame, cell.planner.style)),
        };
    }));
    return make_figure(
        "success", "First plan over time",
        "Share of all attempted seeds with a first plan that the planner accepted by what its variant knows: MP-ARM the " +
            "geometry, MP-ARM-DA the flight in free air, MP-ARM-ADA the flight near surfaces. Such a plan " +
            "may fail when executed: the flights above say what became of the reported ones. Bands are 95 % Wilson intervals.",
        panels);
}

/** Shares of all attempted seeds whose flight held and cost no more. */
export function make_cost_shares(model) {
    const panels = model.experiments.map((experiment) => make_panel(model, experiment.name, () => {
        const cells = shown_cells(model, experiment).map((cell) => {
            return {cell, steps: cell.held_over_cost.map(({cost, held}) => {
                        const share = held / cell.held.attempts;
                        return {at: cost, share, low: share, high: share};
                    })};
        });
        const all = cells.flatMap(({cell, steps}) => steps.length > 0 ? [cell.flown_cost["0"], ...steps.map(({at}) => at)] : []);
        if (all.length === 0) {
            return "No flight of the planners shown held.";
        }
        const told = cells.map(
            ({cell, steps}) => `${cell.planner.name}: ${cell.held.hits} of ${cell.held.attempts} flights held` +
                (steps.length > 0 ? `, costs ${plain(cell.flown_cost["0"])} to ${plain(steps[steps.length - 1].at)}` : ""));
        return {
            label: `Share of seeds whose flight held and cost no more. ${told.join("; ")}.`,
            x: {
                name: `executed cost${experiment.unit ? ` [${experiment.unit}]` : ""}`,
                domain: around(Math.min(...all), Math.max(...all))
            },
            y: share_axis,
            draw: (frame) => cells.map(({cell, steps}) => stepped(steps, frame, cell.planner.style)[1]),
        };
    }));
    return make_figure(
        "cost-shares", "Distribution of executed costs",
        "Empirical distribution over all attempted seeds: a line that ends below 100 % has seeds without a flight " +
            "that held.",
        panels);
}
