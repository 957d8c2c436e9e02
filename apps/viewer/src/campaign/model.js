// What the page of a campaign works on: its figures by experiment and planner.

import {read_embedded} from "../embedded.js";

const lists = ["settings", "totals", "cells", "comparisons", "margins", "failures", "bars", "left_out", "machines"];

export function read_figures(text) { return read_embedded(text, "downwash/campaign-report/v1", "campaign", lists); }

/** Planners that differ by their margin only. */
export const kind_of = ({variant, algorithm, parameters}) =>
    [`${variant} ${algorithm}`, ...Object.entries(parameters ?? {}).map((each) => each.join(" "))].join(", ");

/** null stands for what is infinite: a seed that has no solution. */
const values = (list) => list.map((value) => value ?? Infinity);
const spread = (quantiles) => Object.fromEntries(Object.entries(quantiles).map(([q, v]) => [q, v ?? Infinity]));

/** What a hidden planner changes is drawn anew. */
function make_shown(planners) {
    // A sweep has many planners: the first margin alone can still be told apart.
    const first = (planner) => planners.length <= 8 || planner.margin_m === planners[0].margin_m;
    const names = new Set(planners.filter(first).map((planner) => planner.name));
    const followers = [];
    return {
        has: (planner) => names.has(planner.name),
        set: (planner, is_shown) => {
            names[is_shown ? "add" : "delete"](planner.name);
            followers.forEach((follow) => follow());
        },
        follow: (follow) => followers.push(follow),
    };
}

export function build_model(figures) {
    const kinds = [...new Set(figures.totals.map(kind_of))];
    const planners = figures.totals.map((totals, index) => ({
                                            name: totals.planner,
                                            kind: kind_of(totals),
                                            margin_m: totals.margin_m,
                                            style: `series-${index % 8}`,
                                            kind_style: `series-${kinds.indexOf(kind_of(totals)) % 8}`,
                                            totals,
                                        }));
    const experiments = [];
    figures.cells.forEach((cell, index) => {
        const planner = planners[index % planners.length];
        if (index % planners.length === 0) {
            experiments.push({
                name: `${cell.problem}, ${cell.objective}`,
                unit: cell.cost_unit,
                cells: [],
            });
        }
        const {seeds} = cell;
        experiments[experiments.length - 1].cells.push({
            ...cell,
            planner,
            first_solution_s: spread(cell.first_solution_s),
            verified_s: spread(cell.verified_s),
            whole_run_s: spread(cell.whole_run_s),
            flown_cost: spread(cell.flown_cost),
            seeds: {
                seed: seeds.seed,
                cause: seeds.cause,
                first_solution_s: values(seeds.first_solution_s),
                flown_cost: values(seeds.flown_cost),
            },
            cost_curve: cell.cost_curve.map(({time_s, cost}) => ({time_s, cost: spread(cost)})),
            cost_over_time: cell.cost_over_time.map(({time_s, cost}) => ({time_s, cost: spread(cost)})),
        });
    });
    return {
        figures,
        planners,
        experiments,
        kinds,
        shown: make_shown(planners),
        /** Whether planners with several margins are among them. */
        is_sweep: figures.margins.length > 0,
        /** "dots: seeds" of a small campaign; a large one shows some of its seeds only. */
        dots: figures.seed_step > 1 ? `dots: every ${figures.seed_step}th seed` : "dots: seeds",
        /** Whether plans were flown in other worlds than the nominal one. */
        has_worlds: figures.cells.some(({in_worlds}) => in_worlds && in_worlds.flown > 0),
        is_unfinished: figures.runs_done < figures.runs_planned,
        time_limit_s: figures.time_limit_s,
    };
}

/** Of an experiment, the cells to be drawn. */
export const shown_cells = (model, experiment) =>
    experiment.cells.filter((cell) => model.shown.has(cell.planner) && cell.solved.attempts > 0);
