// The clearance over time as a fan: from the least over all flights to their median.

import {h, s} from "../dom.js";
import {meters, place} from "../format.js";
import {range_of} from "../numbers.js";
import {make_figure, make_panel} from "../panel.js";

const edges = [
    {key: "minimum", name: "minimum"}, {key: "p01", name: "1 %"}, {key: "p10", name: "10 %"},
    {key: "p50", name: "median"}
];

const shown_m = 0.5;

/** Far from everything the clearance does not matter: what is above the top of the panel runs along it. */
function top_of(fan) {
    const {low, high} = range_of(fan.p50);
    return Math.min(1.05 * high, Math.max(shown_m, 3 * low));
}

/** A step's least clearance stands at its middle. */
const points = (values, step_s, {x, y}) => values.map(
    (value, i) => `${x((i + 0.5) * step_s).toFixed(1)} ${y(Math.min(value, y.domain()[1])).toFixed(1)}`);

function draw_fan(fan, margin_m, frame) {
    const lines = edges.map(({key}) => points(fan[key], fan.step_s, frame));
    const bands = edges.slice(1).map(({key}, i) => s("path", {
                                         class: `fan-band to-${key}`,
                                         d: `M${lines[i].join("L")}L${[...lines[i + 1]].reverse().join("L")}Z`
                                     }));
    const limit = margin_m > 0 ?
        [
            s("path", {class: "limit", d: `M${frame.left} ${frame.y(margin_m)}H${frame.right}`}),
            s("text", {class: "limit-name", x: frame.left + 5, y: frame.y(margin_m) - 4},
              `safety margin ${meters(margin_m)}`)
        ] :
        [];
    return [
        s("rect", {class: "contact", x: frame.left, y: frame.y(0) - 1, width: frame.right - frame.left, height: 2}), bands,
        edges.map(({key}, i) => s("path", {class: `fan-line of-${key}`, d: `M${lines[i].join("L")}`})), limit
    ];
}

const has_values = (fan) => fan.minimum.length > 1 && edges.every(({key}) => fan[key].every(Number.isFinite));

/** null without a fan, or where nothing can be touched. */
export function make_clearance({clearance, limits, findings}) {
    if (!clearance || !has_values(clearance)) {
        return null;
    }
    const {low, low_row} = range_of(clearance.minimum);
    const top_m = top_of(clearance);
    const end_s = clearance.minimum.length * clearance.step_s;
    const drawing = {
        label: `Clearance over time over ${findings.runs} flights. The least is ${meters(low)} at ${
            (low_row * clearance.step_s).toFixed(1)} s.`,
        height: 280,
        x: {name: "time [s]", domain: [0, end_s]},
        y: {name: "clearance [m]", domain: [0, top_m]},
        draw: (frame) => draw_fan(clearance, limits?.safety_margin_m, frame),
    };
    const legend =
        h("p", {class: "key-line"},
          edges.map(
              ({key, name}) => h("span", {class: "entry"}, h("span", {class: `key fan-key of-${key}`, "aria-hidden": "true"}),
                                 name)));
    const figure = make_figure(
        "clearance", "Clearance over time",
        "Quantiles over all flights of the clearance at each moment. A flight that has ended keeps its last " +
            `clearance, 0 after a collision. Clearances above ${place(top_m)} are drawn there.`,
        [make_panel({}, "Clearance of all flights", () => drawing)], legend);
    figure.classList.add("wide");
    return figure;
}
