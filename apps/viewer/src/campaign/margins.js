// Inflated obstacles: what a growing margin buys and what it costs.

import {h, s} from "../dom.js";
import {number} from "../format.js";
import {make_figure, make_panel, plain} from "../panel.js";

function curve(cells, share_name, frame, style) {
    const {x, y} = frame;
    const at = ({planner}) => x(planner.margin_m).toFixed(1);
    const up = (value) => y(value).toFixed(1);
    const share = (cell) => cell[share_name];
    const ratio = (cell) => share(cell).hits / share(cell).attempts;
    const high = cells.map((cell) => `${at(cell)} ${up(share(cell).high)}`);
    const low = cells.map((cell) => `${at(cell)} ${up(share(cell).low)}`).reverse();
    return [
        s("path", {class: `band ${style}`, d: `M${[...high, ...low].join("L")}Z`}),
        s("path", {class: `line ${style}`, d: `M${cells.map((cell) => `${at(cell)} ${up(ratio(cell))}`).join("L")}`}),
        cells.map((cell) => s("circle", {class: `dot ${style}`, cx: at(cell), cy: up(ratio(cell)), r: 2.5}))
    ];
}

function panels_of(model, share_name, axis_name) {
    return model.experiments.map((experiment) => make_panel(model, experiment.name, () => {
        const kinds = model.kinds
                          .map((kind) => experiment.cells
                                             .filter(
                                                 ({planner, solved}) => planner.kind === kind &&
                                                     planner.margin_m !== null && solved.attempts > 0)
                                             .sort((a, b) => a.planner.margin_m - b.planner.margin_m))
                          .filter((cells) => cells.length > 1);
        const margins = kinds.flat().map(({planner}) => planner.margin_m);
        if (margins.length === 0) {
            return "Nothing has run here yet.";
        }
        const told = kinds.map(
            (cells) => `${cells[0].planner.kind}: ${
                cells.map((cell) => `${cell[share_name].hits} of ${cell[share_name].attempts} at ${
                                         plain(cell.planner.margin_m)} m`).join(", ")}`);
        return {
            label: `${axis_name} over the margin. ${told.join("; ")}.`,
            x: {name: "safety margin [m]", domain: [0, 1.02 * Math.max(...margins)]},
            y: {name: axis_name, domain: [0, 1.02], text: (share) => number(share, ".0%")},
            draw: (frame) => kinds.map((cells) => curve(cells, share_name, frame, cells[0].planner.kind_style)),
        };
    }));
}

export function make_margins(model) {
    if (!model.is_sweep) {
        return null;
    }
    const key = model.kinds.map(
        (kind) => h(
            "span", {class: "entry"},
            h("span", {
                class: `key ${model.planners.find((planner) => planner.kind === kind).kind_style}`,
                "aria-hidden": "true"
            }),
            kind));
    return make_figure(
        "margins", "Inflated obstacles",
        "What a growing safety margin buys, flights that do not fail, and what it costs, problems that are no longer " +
            "solved. Bands are 95 % Wilson intervals.",
        [
            h("p", {class: "panels-title key-line"}, key), h("h3", {class: "panels-title"}, "Flights that failed"),
            ...panels_of(model, "failed_flights", "share of seeds"), h("h3", {class: "panels-title"}, "Plans found"),
            ...panels_of(model, "solved", "share of seeds")
        ]);
}
