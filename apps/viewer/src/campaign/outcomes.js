// What became of the plans: flights in worlds; flights that held, flights that failed, searches without a plan.

import {h, s} from "../dom.js";
import {number} from "../format.js";
import {around, make_figure, make_panel} from "../panel.js";
import {shown_cells} from "./model.js";
import {percent_text} from "./tables.js";
import {row_at, row_edges, row_name, row_names} from "./rows.js";

const row_height = 46;
const bar_height = 13;
const percent = (share) => number(share, ".0%");

/** Of all attempted seeds; together they are all of them. */
function parts_of({held, failed_flights, solved}) {
    const not_flown = solved.hits - held.hits - failed_flights.hits;
    return [
        {kind: "held", text: "flight held", count: held.hits},
        {kind: "failed", text: "flight failed", count: failed_flights.hits + not_flown},
        {kind: "without", text: "no plan", count: solved.attempts - solved.hits},
    ];
}

const told_of = (cell) => parts_of(cell)
                              .filter(({kind, count}) => kind === "held" || count > 0)
                              .map(({text, count}) => `${text} ${number(count, ",d")}`)
                              .join(", ");

/** The interval of a share as a line with ends. */
function interval({low, high}, y, {x}) {
    const [from, to] = [x(low).toFixed(1), x(high).toFixed(1)];
    return s("path", {class: "interval", d: `M${from} ${y - 4}v8M${from} ${y}H${to}M${to} ${y - 4}v8`});
}

function outcome_row(cell, name, y, frame) {
    let from = 0;
    const bars = parts_of(cell).map(({kind, text, count}) => {
        const left = frame.x(from / cell.solved.attempts);
        from += count;
        return s(
            "rect", {
                class: `outcome ${kind} ${cell.planner.style}`,
                x: left.toFixed(1),
                y: y - bar_height / 2,
                width: (frame.x(from / cell.solved.attempts) - left).toFixed(1),
                height: bar_height
            },
            s("title", null, `${text}: ${count} of ${cell.solved.attempts}`));
    });
    return [bars, interval(cell.held, y, frame), row_name(frame, y - 12, name)];
}

const key = (kind, text) =>
    h("span", {class: "entry"}, h("span", {class: `key outcome-key ${kind}`, "aria-hidden": "true"}), text);

export function make_outcomes(model) {
    const panels = model.experiments.map((experiment) => make_panel(model, experiment.name, (width) => {
        const cells = shown_cells(model, experiment);
        if (cells.length === 0) {
            return "None of the planners shown has run here yet.";
        }
        const told = cells.map((cell) => `${cell.planner.name}: ${told_of(cell)}, of ${cell.solved.attempts} seeds`);
        const {names, more} = row_names(cells.map((cell) => `${cell.planner.name}: ${told_of(cell)}`), width);
        const height = row_height + more;
        return {
            label: `What became of the seeds. ${told.join("; ")}.`,
            height: 42 + height * cells.length,
            ...row_edges,
            x: {name: "share of seeds", domain: [0, 1], text: percent},
            y: null,
            draw: (frame) =>
                cells.map((cell, index) => outcome_row(cell, names[index], row_at(frame, index, height), frame)),
        };
    }));
    return make_figure(
        "outcomes", model.has_worlds ? "Flights in the nominal world" : "Flights that held",
        "Of all attempted seeds: those whose plan, executed with direct aerodynamics, reached the goal and hovered there. " +
            "The line is the 95 % Wilson interval of that share. “Flight failed” means that the search found a plan that " +
            "obeys what its variant knows, and that this plan failed when executed." +
            (model.has_worlds ? " A flight that holds here may fail in other worlds: see above." : ""),
        [
            h("p", {class: "panels-title key-line"}, key("held", "flight held, in the planner's colour"),
              key("failed", "a plan was found, but its flight failed"), key("without", "no plan was found")),
            ...panels
        ]);
}

const certified_text = ({hits, attempts}) => `certified ${number(hits, ",d")} of ${number(attempts, ",d")} seeds`;

function worlds_text({planner, in_worlds: {failed, flown, tested, certified}}) {
    const plans = `${number(flown, ",d")} ${flown === 1 ? "plan" : "plans"}`;
    return [
        `${planner.name}: ${percent_text(failed)}`, `${plans} flown`, ...(tested > 0 ? [certified_text(certified)] : [])
    ].join(", ");
}

function worlds_row({planner, in_worlds: {failed}}, y, frame) {
    const at = frame.x(failed.hits / failed.attempts).toFixed(1);
    return [interval(failed, y, frame), s("circle", {class: `dot ${planner.style}`, cx: at, cy: y, r: 4.5})];
}

/** Null where no plan was flown in worlds. */
export function make_worlds(model) {
    const flown_in = (experiment) =>
        shown_cells(model, experiment).filter(({in_worlds}) => in_worlds && in_worlds.flown > 0);
    if (!model.has_worlds) {
        return null;
    }
    const panels = model.experiments.map((experiment) => make_panel(model, experiment.name, (width) => {
        const cells = flown_in(experiment);
        if (cells.length === 0) {
            return "No plan of the planners shown was flown in worlds.";
        }
        const told = cells.map(
            ({planner, in_worlds: {failed}}) => `${planner.name}: ${failed.hits} of ${failed.attempts} flights failed`);
        const without = shown_cells(model, experiment).filter((cell) => !cells.includes(cell));
        const not_flown = without.map(({planner}) => `${planner.name}: no plan to fly`);
        told.push(...not_flown);
        const {names, more} = row_names([...cells.map(worlds_text), ...not_flown], width);
        const height = row_height + more;
        const most = Math.max(...cells.map(({in_worlds}) => in_worlds.failed.high));
        return {
            label: `Flights in worlds. ${told.join("; ")}.`,
            height: 42 + height * names.length,
            ...row_edges,
            x: {name: "share of flights that failed", domain: [0, around(0, most)[1]], text: (v) => number(v, ".2~%")},
            y: null,
            draw: (frame) => [
                ...cells.map((cell, index) => worlds_row(cell, row_at(frame, index, height), frame)),
                ...names.map((name, index) => row_name(frame, row_at(frame, index, height) - 12, name))
            ],
        };
    }));
    return make_figure(
        "worlds", "Failures in worlds",
        "Share of the flights of the reported plans that failed in worlds which no search had seen: where surface effects, " +
            "scene, vehicle, sensors and wind differ from the nominal world. Lines are 95 % intervals of Clopper and Pearson.",
        panels);
}
