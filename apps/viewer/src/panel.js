// One panel of a figure: axes and a grid, and within them what the figure draws.

import {scaleLinear, scaleLog} from "d3-scale";

import {foreign, h, s} from "./dom.js";
import {number} from "./format.js";
import {keep_sized} from "./sizing.js";
import {make_save_button} from "./save.js";
import {log_ticks} from "./ticks.js";

const paper_width = 330;

/**
 * @typedef {{name: string, domain: [number, number], is_log?: boolean, text?: (value: number) => string}} Axis
 * @typedef {{x: any, y: any, left: number, right: number, top: number, bottom: number}} Frame scales and edges, in pixels
 * @typedef {{title: string, label: string, x: Axis, y: Axis|null, height?: number, left?: number, right?: number,
 *            draw: (frame: Frame) => any[]}} Drawing `y` null: rows that the figure names itself
 */

function ticks_of(axis, scale, count) {
    if (!axis.is_log) {
        return {named: scale.ticks(count), minor: []};
    }
    return {named: log_ticks(scale, count), minor: scale.ticks()};
}

export const plain = (value) => number(value, Math.abs(value) >= 1000 ? ",.0f" : ".4~g");

function scale_of(axis, range) {
    return (axis.is_log ? scaleLog() : scaleLinear()).domain(axis.domain).range(range);
}

function draw_axes(drawing, frame, width, height) {
    const {x, y, left, right, top, bottom} = frame;
    const across = ticks_of(drawing.x, x, Math.max(3, Math.round((right - left) / 80)));
    const x_text = drawing.x.text ?? plain, y_text = drawing.y?.text ?? plain;
    const up = y ? ticks_of(drawing.y, y, 4).named : [];
    return [
        s("path", {
            class: "grid-lines",
            d: [...across.named.map((t) => `M${x(t)} ${top}V${bottom}`), ...up.map((v) => `M${left} ${y(v)}H${right}`)]
                   .join("")
        }),
        s("path", {class: "grid-lines strong", d: across.minor.map((t) => `M${x(t)} ${bottom}v3`).join("")}),
        across.named.map(
            (t) => s("text", {class: "tick", x: x(t), y: bottom + 15, "text-anchor": "middle"}, x_text(t))),
        up.map(
            (v) => s("text", {class: "tick", x: left - 6, y: y(v), dy: "0.32em", "text-anchor": "end"}, y_text(v))),
        s("text", {class: "axis-name", x: (left + right) / 2, y: height - 4, "text-anchor": "middle"}, drawing.x.name),
        drawing.y ? s("text", {
            class: "axis-name",
            transform: `translate(11 ${(top + bottom) / 2}) rotate(-90)`,
            "text-anchor": "middle"
        },
                      drawing.y.name) :
                    [],
    ].flat();
}

/**
 * `drawing_of(width)` is asked anew for whatever is shown; a text instead of a drawing says why there is none.
 * @param {{shown?: {follow: (changed: () => void) => void}}} model `shown`: what the reader may switch on and off
 */
export function make_panel(model, title, drawing_of) {
    const svg = s("svg", {class: "plot-svg panel-svg", role: "img"});
    const nothing = h("p", {class: "muted", hidden: true});
    const save = make_save_button(svg, title);
    let last_width = 0;
    const draw = (width) => {
        last_width = width;
        const drawing = drawing_of(width);
        nothing.hidden = typeof drawing !== "string";
        [svg, save].forEach((element) => element.toggleAttribute("hidden", !nothing.hidden));
        if (!nothing.hidden) {
            nothing.textContent = drawing;
            return;
        }
        const height = drawing.height ?? 210;
        const frame = {left: drawing.left ?? 66, right: width - (drawing.right ?? 14), top: 8, bottom: height - 34};
        frame.x = scale_of(drawing.x, [frame.left, frame.right]);
        frame.y = drawing.y ? scale_of(drawing.y, [frame.bottom, frame.top]) : null;
        svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
        svg.setAttribute("aria-label", drawing.label);
        svg.replaceChildren(...draw_axes(drawing, frame, width, height), ...drawing.draw(frame).flat(Infinity));
    };
    model.shown?.follow(() => {
        if (last_width > 0) {
            draw(last_width);
        }
    });
    const figure =
        h("figure", {class: "panel"},
          h("figcaption", null, h("span", {class: "plot-title"}, foreign(title)), save), svg, nothing);
    keep_sized(figure, paper_width, draw);
    return figure;
}

/** A figure of the page: a heading, what to know of it, and a panel for every experiment. */
export function make_figure(id, title, note, panels, ...others) {
    return h(
        "section", {class: "figure", id, "aria-labelledby": `${id}-title`}, h("h2", {id: `${id}-title`}, title),
        h("p", {class: "muted note"}, note), h("div", {class: "panels"}, panels), others);
}

/** Within a domain that has some room around. */
export function around(low, high, {is_log = false, share = 0.05} = {}) {
    if (is_log) {
        return [low / 1.3, Math.max(high * 1.1, low * 1.5)];
    }
    const pad = share * (high - low) || 0.05 * Math.abs(high) || 1;
    return [low - pad, high + pad];
}
