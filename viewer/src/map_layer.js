// The aero map: a raster under the scene, and its colour bar.

import {scaleLinear} from "d3-scale";

import {color_of} from "./colors.js";
import {h, s} from "./dom.js";
import {number, place} from "./format.js";

const not_flyable = 255;

function raster(map, theme) {
    const {columns, rows, levels, factor_low, factor_high} = map;
    const canvas = document.createElement("canvas");
    canvas.width = columns;
    canvas.height = rows;
    const context = canvas.getContext("2d");
    const image = context.createImageData(columns, rows);
    const palette = Array.from(
        {length: not_flyable},
        (_, level) => color_of(factor_low + (level / 254) * (factor_high - factor_low), map, theme));
    for (let row = 0; row < rows; ++row) {
        for (let column = 0; column < columns; ++column) {
            const level = levels[row * columns + column];
            const at = 4 * ((rows - 1 - row) * columns + column);
            if (level !== not_flyable) {
                const [r, g, b] = palette[level];
                image.data.set([r, g, b, 255], at);
            }
        }
    }
    context.putImageData(image, 0, 0);
    return canvas.toDataURL("image/png");
}

/** Both themes are drawn, so that a page in dark prints light without a script having to run. */
export function draw_map(map) {
    // Levels are of points: each is the middle of its cell.
    const x = map.x_low_m - map.cell_m / 2, width = map.columns * map.cell_m;
    const z = map.z_low_m - map.cell_m / 2, height = map.rows * map.cell_m;
    const place_of = {x, y: -z - height, width, height, preserveAspectRatio: "none", transform: "scale(1 -1)"};
    return s(
        "g", {class: "map"}, s("rect", {class: "blocked", x, y: z, width, height}),
        ["light", "dark"].map((theme) => s("image", {...place_of, class: `only-${theme}`, href: raster(map, theme)})));
}

/** The colour bar, with numbers. */
export function make_color_bar(map) {
    const {factor_low, factor_high} = map;
    const steps = 48;
    const share = scaleLinear().domain([factor_low, factor_high]).range([0, 100]);
    const gradient = (theme) => {
        const stops = Array.from({length: steps + 1}, (_, i) => {
            const factor = factor_low + (i / steps) * (factor_high - factor_low);
            return `rgb(${color_of(factor, map, theme).map(Math.round).join(" ")}) ${((100 * i) / steps).toFixed(1)}%`;
        });
        return h(
            "div", {class: `bar only-${theme}`, style: `background: linear-gradient(to right, ${stops.join(", ")})`});
    };
    const is_apart = (tick) => Math.min(tick - factor_low, factor_high - tick) > 0.12 * (factor_high - factor_low);
    const ticks = [...new Set([factor_low, ...share.ticks(5).filter(is_apart), factor_high])];
    const is_coarse = (tick) => Math.abs(10 * tick - Math.round(10 * tick)) < 1e-6;
    const digits = ticks.every(is_coarse) ? ".1f" : ".2f";
    const label = `Colours from factor ${number(factor_low, ".2f")} to ${number(factor_high, ".2f")}; ` +
        "free air, 1, has the colour of the paper";
    return h(
        "div", {class: "color-bar"}, h("div", {class: "color-bar-name"}, "Aero factor: thrust over thrust in free air"),
        h("div", {class: "color-bar-scale", role: "img", "aria-label": label}, gradient("light"), gradient("dark"),
          ticks.map((tick) => h("span", {class: "tick", style: `left: ${share(tick)}%`}, number(tick, digits)))),
        h("div", {class: "color-bar-note"}, h("span", {class: "swatch blocked"}), "not flyable",
          h("span", {class: "muted"},
            `of rotor ${map.rotor} there, ${place(map.lateral_m)} beside the plane of motion`)));
}
