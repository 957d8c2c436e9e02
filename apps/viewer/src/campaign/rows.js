// Spreads as rows: box plots with every seed as a dot, and differences between planners on equal seeds.

import {isolated, s} from "../dom.js";
import {number} from "../format.js";
import {shown_cells} from "./model.js";
import {around, make_figure, make_panel, plain} from "../panel.js";

const row_height = 40;
const pair_height = 54;
const p_text = (p) => (p === null ? "" : p < 0.0001 ? "p < 0.0001" : `p = ${number(p, ".2g")}`);

/** Dots spread evenly across their row, the same way each time. */
const jitter = (index) => ((index * 0.6180339887498949) % 1) - 0.5;

function dots(values, y, frame, style) {
    const radius = values.length > 60 ? 1.6 : values.length > 12 ? 2.3 : 3;
    return values.map(
        (value, i) => Number.isFinite(value) ? s("circle", {
            class: `seed-dot ${style}`,
            cx: frame.x(value).toFixed(1),
            cy: (y + 12 * jitter(i)).toFixed(1),
            r: radius
        }) :
                                               []);
}

/** Middle of a row's marks, below its words. */
export const row_at = (frame, index, height) => frame.top + (index + 1) * height - 14;

const line_height = 14;
const most_lines = 3;

/** Edges of a panel with rows: their words begin where their marks do. */
export const row_edges = {
    left: 12,
    right: 16
};

/** A text in lines of so many letters at most, broken between words. */
function broken(text, letters) {
    const lines = [""];
    for (const word of text.split(" ")) {
        const last = lines[lines.length - 1], longer = last === "" ? word : `${last} ${word}`;
        if ([...longer].length <= letters || last === "") {
            lines[lines.length - 1] = longer;
        } else if (lines.length < most_lines) {
            lines.push(word);
        } else {
            lines[lines.length - 1] = longer;  // too long: it is cut off
        }
    }
    return lines.map((line) => isolated(line, letters));
}

/**
 * The words of rows in a panel of that width, and how much higher all rows are so that the longest has room.
 * @param {string[]} texts
 */
export function row_names(texts, width) {
    const letters = Math.floor((width - row_edges.left - row_edges.right) / 6.3);
    const names = texts.map((text) => broken(text, letters));
    return {names, more: line_height * (Math.max(1, ...names.map((lines) => lines.length)) - 1)};
}

/** Words of a row whose last line stands at `y`. */
export const row_name = (frame, y, lines) => lines.map(
    (line, i) =>
        s("text", {class: "row-name", x: frame.left, y: y - line_height * (lines.length - 1 - i)}, line));

function box(spread, y, frame, style) {
    const {x, right} = frame;
    const place = (value) => (Number.isFinite(value) ? x(value) : right);
    const [low, quarter, median, three, high] = ["0", "25", "50", "75", "95"].map((q) => spread[q]);
    if (!Number.isFinite(low)) {
        return [];
    }
    const title = s("title", null,
                    `least ${plain(low)}, 25 % ${plain(quarter)}, median ${plain(median)}, 75 % ${plain(three)}, ` +
                        `95 % ${plain(high)}`);
    const begin = place(quarter), end = place(three);
    return [
        s("path", {class: `whisker ${style}`, d: `M${x(low)} ${y}H${begin}M${end} ${y}H${place(high)}`}),
        // A quartile that is infinite leaves the box open.
        s("path", {
            class: `box ${style}`,
            d: Number.isFinite(three) ? `M${begin} ${y - 7}H${end}V${y + 7}H${begin}Z` :
                                        `M${end} ${y - 7}H${begin}V${y + 7}H${end}`
        },
          title)
    ];
}

/** Above the dots, which would hide it. */
const median_tick = (median, y, frame, style) =>
    Number.isFinite(median) ? s("path", {class: `median ${style}`, d: `M${frame.x(median)} ${y - 8}v16`}) : [];

function make_boxes(model, {id, title, note, measure, of_seeds, axis_of}) {
    const panels = model.experiments.map((experiment) => make_panel(model, experiment.name, (width) => {
        const cells = shown_cells(model, experiment);
        const all = cells.flatMap((cell) => [...cell.seeds[measure], ...Object.values(cell[measure])])
                        .filter((value) => Number.isFinite(value) && value > 0);
        if (all.length === 0) {
            return "None of the planners shown has a value here.";
        }
        const axis = axis_of(experiment);
        const told = cells.map(({planner, [measure]: spread}) => `${planner.name}: median ${plain(spread["50"])}`);
        const {names, more} = row_names(cells.map((cell) => {
            const {hits, attempts} = of_seeds(cell), without = attempts - hits;
            return cell.planner.name + (without > 0 ? `, ${without} of ${attempts} without` : "");
        }), width);
        return {
            label: `${title}. ${told.join("; ")}.`,
            height: 42 + (row_height + more) * cells.length + 8,
            ...row_edges,
            x: {...axis, domain: around(Math.min(...all), Math.max(...all), {is_log: axis.is_log})},
            y: null,
            draw: (frame) => cells.map((cell, index) => {
                const y = row_at(frame, index, row_height + more), {style} = cell.planner;
                return [
                    box(cell[measure], y, frame, style), dots(cell.seeds[measure], y, frame, style),
                    median_tick(cell[measure]["50"], y, frame, style), row_name(frame, y - 12, names[index])
                ];
            }),
        };
    }));
    return make_figure(id, title, note, panels);
}

const how_to_read = (model) => `Box: quartiles and median; whiskers: least and 95 %; ${model.dots}. Quantiles are over all ` +
    "attempted seeds, those without a value counting as infinite: then a box is open to the right.";

export const make_first_solutions = (model) => make_boxes(model, {
    id: "first-solutions",
    title: "Time to the first solution",
    note: how_to_read(model),
    measure: "first_solution_s",
    of_seeds: ({solved}) => solved,
    axis_of: () => ({name: "time of the search [s]", is_log: true}),
});

export const make_flown_costs = (model) => make_boxes(model, {
    id: "flown-costs",
    title: "Executed cost",
    note: `Cost of the reported plan's flight with direct aerodynamics, where it held. ${how_to_read(model)}`,
    measure: "flown_cost",
    of_seeds: ({held}) => held,
    axis_of: ({unit}) => ({name: `executed cost${unit ? ` [${unit}]` : ""}`}),
});

/** Differences first - second of the pairs in which both have a value. */
function differences(first, second, measure) {
    const of_seed = new Map(second.seeds.seed.map((seed, i) => [seed, second.seeds[measure][i]]));
    return first.seeds.seed.map((seed, i) => first.seeds[measure][i] - (of_seed.get(seed) ?? Infinity))
        .filter(Number.isFinite);
}

function make_pairs_of(model, measure, name, unit_for) {
    return model.experiments
        .map((experiment) => {
            const compared = model.figures.comparisons.filter(
                (pair) => pair.experiment === experiment.name && pair.measure === name);
            if (compared.length === 0) {
                return null;
            }
            const cell_of = (planner) => experiment.cells.find((cell) => cell.planner.name === planner);
            return make_panel(model, experiment.name, (width) => {
                const rows = compared.map((pair) => ({pair, first: cell_of(pair.first), second: cell_of(pair.second)}))
                                 .filter(({first, second}) => model.shown.has(first.planner) &&
                                             model.shown.has(second.planner))
                                 .map((row) => ({...row, values: differences(row.first, row.second, measure)}));
                const all = rows.flatMap(({values}) => values);
                if (all.length === 0) {
                    return "No two of the planners shown both have values on a seed.";
                }
                const unit = unit_for(experiment);
                const told = rows.map(
                    ({pair}) => `${pair.first} against ${pair.second}: ${pair.first_smaller} to ${
                        pair.second_smaller} seeds, median difference ${plain(pair.median_difference)}`);
                const {names, more} = row_names(rows.map(({pair}) => `${pair.first} − ${pair.second}`), width);
                const counts = row_names(rows.map(
                    ({pair}) => `smaller ${pair.first_smaller} : ${pair.second_smaller}, ${p_text(pair.sign_test_p)}`), width);
                return {
                    label: `Differences on equal seeds. ${told.join("; ")}.`,
                    height: 42 + (pair_height + more) * rows.length + 8,
                    ...row_edges,
                    x: {
                        name: `first − second${unit ? ` [${unit}]` : ""}`,
                        domain: around(Math.min(0, ...all), Math.max(0, ...all))
                    },
                    y: null,
                    draw: (frame) => [
                        s("path", {class: "zero", d: `M${frame.x(0)} ${frame.top}V${frame.bottom}`}),
                        rows.map(({pair, first, values}, index) => {
                            const y = row_at(frame, index, pair_height + more), {style} = first.planner;
                            return [
                                dots(values, y, frame, style),
                                median_tick(pair.median_difference, y, frame, style),
                                row_name(frame, y - 27, names[index]), row_name(frame, y - 13, counts.names[index])
                            ];
                        })
                    ],
                };
            });
        })
        .filter((panel) => panel !== null);
}

export function make_pairs(model) {
    const costs = make_pairs_of(model, "flown_cost", "executed cost", ({unit}) => unit);
    const times = make_pairs_of(model, "first_solution_s", "first solution [s]", () => "s");
    if (costs.length + times.length === 0) {
        return null;
    }
    return make_figure(
        "pairs", "Differences on equal seeds",
        `${model.dots[0].toUpperCase()}${model.dots.slice(1)} on which both have a value; tick: their median. Left of zero the first planner is the cheaper or ` +
            "the faster one. The counts say on how many seeds the first, and the second, has the smaller value; no plan " +
            "loses to any plan. p is that of the two-sided sign test over them.",
        [
            costs.length > 0 ? h3("Executed cost") : null, ...costs, times.length > 0 ? h3("First solution") : null,
            ...times
        ]);
}

function h3(text) {
    const element = document.createElement("h3");
    element.className = "panels-title";
    element.textContent = text;
    return element;
}
