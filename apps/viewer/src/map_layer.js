// The thrust ratio K: a raster under the scene, and its colour bar.

import {class_of, colors_of} from "./factor_colors.js";
import {h, s} from "./dom.js";
import {number, place} from "./format.js";

const not_flyable = 255;

/** The thrust ratios as a picture, a pixel for a point; on request clear where they are as in free air. */
export function draw_ratios(map, theme, {is_free_air_clear = false} = {}) {
    const {columns, rows, levels, factor_low, factor_high} = map;
    const canvas = document.createElement("canvas");
    canvas.width = columns;
    canvas.height = rows;
    const context = canvas.getContext("2d");
    const image = context.createImageData(columns, rows);
    const colors = colors_of(map.scale, theme);
    const free_air = is_free_air_clear ? class_of(1, map.scale) : -1;
    const palette = Array.from({length: not_flyable}, (_, level) => {
        const own = class_of(factor_low + (level / 254) * (factor_high - factor_low), map.scale);
        return [...colors[own], own === free_air ? 0 : 255];
    });
    for (let row = 0; row < rows; ++row) {
        for (let column = 0; column < columns; ++column) {
            const level = levels[row * columns + column];
            const at = 4 * ((rows - 1 - row) * columns + column);
            if (level !== not_flyable) {
                image.data.set(palette[level], at);
            }
        }
    }
    context.putImageData(image, 0, 0);
    return canvas;
}

/** Both themes are drawn, so that a page in dark prints light without a script having to run. */
export function draw_map(map) {
    // Levels are of points: each is the middle of its cell.
    const x = map.x_low_m - map.cell_m / 2, width = map.columns * map.cell_m;
    const z = map.z_low_m - map.cell_m / 2, height = map.rows * map.cell_m;
    const place_of = {x, y: -z - height, width, height, preserveAspectRatio: "none", transform: "scale(1 -1)"};
    return s(
        "g", {class: "map"}, s("rect", {class: "blocked", x, y: z, width, height}),
        ["light", "dark"].map((theme) => s("image", {...place_of, class: `only-${theme}`, href: draw_ratios(map, theme).toDataURL("image/png")})));
}

/** The colour bar: the classes in equal widths, with their limits. */
export function make_color_bar(map) {
    const {limits, colors} = map.scale;
    const share = (i) => (100 * i) / colors.length;
    const bar = (theme) => {
        const stops = colors_of(map.scale, theme)
                          .map((color, i) => `rgb(${color.map(Math.round).join(" ")}) ${share(i)}% ${share(i + 1)}%`);
        return h(
            "div", {class: `bar only-${theme}`, style: `background: linear-gradient(to right, ${stops.join(", ")})`});
    };
    // Numbers have room for eight classes; 1, or the class around it, keeps its own.
    const every = Math.ceil(colors.length / 8), first = class_of(1, map.scale) % every;
    const ticks = limits.map((limit, i) => [limit, i]).filter(([, i]) => i % every === first);
    const label = `Colours of thrust ratios from ${number(limits[0], ".2~f")} to ${number(limits.at(-1), ".2~f")}; ` +
        "free air, 1, has the colour of the paper";
    return h(
        "div", {class: "color-bar"}, h("div", {class: "color-bar-name"},
                                  `Thrust ratio K of rotor ${map.rotor}, ${place(map.lateral_m)} beside the plane of motion: ` +
                                      "thrust over thrust in free air"),
        h("div", {class: "color-bar-scale", role: "img", "aria-label": label}, bar("light"), bar("dark"),
          ticks.map(([limit, i]) => h("span", {class: "tick", style: `left: ${share(i)}%`}, number(limit, ".2~f")))),
        h("div", {class: "color-bar-note"}, h("span", {class: "swatch blocked"}), "not flyable there"));
}
