// Words in the scene, in pixels above the drawing: they keep their size and get out of each other's way.

import {isolated, s} from "./dom.js";
import {extent_of} from "./numbers.js";
import {goal_region} from "./surroundings.js";
import {goal_name} from "./words.js";

const line_height = 14;
const name_length = 26;
const most_names = 200;

const ruler = document.createElement("canvas").getContext("2d");
ruler.font = "600 11.5px system-ui, sans-serif";  // the bolder one of the words' fonts
const widths = new Map();

/** Of a word, in pixels. */
function width_of(text) {
    if (!widths.has(text)) {
        widths.set(text, ruler.measureText(text).width);
    }
    return widths.get(text);
}

function overlaps(a, b) { return a[0] < b[2] && b[0] < a[2] && a[1] < b[3] && b[1] < a[3]; }

/** Places words one after the other; those that find no room stay away (their names stand in the table below). */
export class Placement {
    constructor(inside) {
        this.inside = inside;
        this.taken = [];
    }

    reserve(box) { this.taken.push(box); }

    /** @returns {[number, number] | null} the middle of the first candidate with room */
    find(text, candidates) {
        const half_x = width_of(text) / 2 + 3, half_y = line_height / 2;
        for (const [x, y] of candidates) {
            const box = [x - half_x, y - half_y, x + half_x, y + half_y];
            const [left, top, right, bottom] = this.inside;
            const fits = box[0] >= left && box[1] >= top && box[2] <= right && box[3] <= bottom;
            if (fits && !this.taken.some((other) => overlaps(box, other))) {
                this.taken.push(box);
                return [x, y];
            }
        }
        return null;
    }
}

/**
 * What moves has the right of way: words that stand still vanish below it.
 * @param {SVGElement[]} moving words   @param {number[][]} boxes of other things, in pixels
 */
export function give_way(words, moving, boxes) {
    const box_of = (element) => {
        const x = Number(element.getAttribute("x")), y = Number(element.getAttribute("y"));
        const half = width_of(element.textContent) / 2;
        return [x - half, y - line_height / 2, x + half, y + line_height / 2];
    };
    const taken = [...moving.map(box_of), ...boxes];
    for (const element of words.querySelectorAll(".word")) {
        const box = box_of(element);
        element.style.visibility = taken.some((other) => overlaps(box, other)) ? "hidden" : "";
    }
}

const word = (kind, x, y, text, title) =>
    s("text", {class: `word ${kind}`, x, y, dy: "0.35em", "text-anchor": "middle"}, text,
      title && title !== text ? s("title", null, title) : null);

/** The names of obstacles and the extents that they stand for; of very many obstacles, the largest ones only. */
export function names_of(obstacles) {
    const names = obstacles.filter(({name}) => name).map(({name, section, projection}) => {
        const is_filled = section.length > 0;
        return {name, is_filled, whole: extent_of(is_filled ? section : projection)};
    });
    const size_m = ({whole: {x_m, z_m}}) => x_m[1] - x_m[0] + z_m[1] - z_m[0];
    return names.length > most_names ? names.sort((a, b) => size_m(b) - size_m(a)).slice(0, most_names) : names;
}

/** @param {ReturnType<typeof names_of>} names */
export function draw_obstacle_names(view, names, placement) {
    const shown = view.shown;
    const marks = [];
    for (const {name, is_filled, whole} of names) {
        const seen = {
            x_m: [Math.max(whole.x_m[0], shown.x_m[0]), Math.min(whole.x_m[1], shown.x_m[1])],
            z_m: [Math.max(whole.z_m[0], shown.z_m[0]), Math.min(whole.z_m[1], shown.z_m[1])],
        };
        if (seen.x_m[0] >= seen.x_m[1] || seen.z_m[0] >= seen.z_m[1]) {
            continue;
        }
        const text = isolated(name.replace(/\s+/g, " "), name_length);
        const [left, top] = view.to_pixels(seen.x_m[0], seen.z_m[1]);
        const [right, bottom] = view.to_pixels(seen.x_m[1], seen.z_m[0]);
        const x = (left + right) / 2, y = (top + bottom) / 2, half = width_of(text) / 2 + 6;
        // Inside first, from the middle outwards; then around.
        const shares = [0, -0.25, 0.25, -0.5, 0.5, -0.75, 0.75];
        const room = Math.max(0, (right - left) / 2 - half);
        const inside =
            [0, -0.3, 0.3].flatMap((up) => shares.map((share) => [x + share * room, y + up * (bottom - top)]));
        const around = [[x, top - 9], [x, bottom + 9], [right + half, y], [left - half, y]];
        const candidates =
            right - left > 2 * half - 12 && bottom - top > line_height ? [...inside, ...around] : [...around, [x, y]];
        const found = placement.find(text, candidates);
        if (found) {
            const is_inside = found[1] > top && found[1] < bottom && found[0] > left && found[0] < right;
            marks.push(word(
                `${is_filled ? "of-section" : "of-projection"}${is_inside ? " inside" : ""}`, ...found, text,
                text.endsWith("…\u2069") ? name : null));
        }
    }
    return marks;
}

/** Goals and start; several goals carry their number. */
export function draw_place_names(view, model, placement) {
    const around = ([x, y], reach, text) => {
        const half = width_of(text) / 2 + 4;
        return [
            [x, y - reach - 9], [x, y + reach + 9], [x - reach - half, y], [x + reach + half, y], [x, y - reach - 22],
            [x, y + reach + 22], [x - half, y + reach + 12], [x + half, y + reach + 12]
        ];
    };
    const marks = [];
    model.goals.forEach((goal, index) => {
        const region = goal_region(goal, model.scene.bounds);
        const text = goal_name(model, index);
        const reach = Math.min(30, (Number(region.half_z) || 0.08) * view.pixels_per_m);
        const found = placement.find(text, around(view.to_pixels(region.x_m, region.z_m), reach, text));
        if (found) {
            marks.push(word("of-goal", ...found, text));
        }
    });
    const reach = 0.15 * view.pixels_per_m;
    const found = placement.find("start", around(view.to_pixels(model.start.x_m, model.start.z_m), reach, "start"));
    if (found) {
        marks.push(word("of-start", ...found, "start"));
    }
    return marks;
}

/** Times of snapshots on the side that the arm does not point to. */
export function draw_snapshot_times(view, {data}, rows, placement) {
    const marks = [];
    for (const row of rows) {
        const text = `${data.t_s[row].toFixed(1)} s`;
        const [x, y] = view.to_pixels(data.x_m[row], data.z_m[row]);
        const away = 0.2 * view.pixels_per_m + 9;
        const sides = data.ee_z_m[row] < data.z_m[row] - 0.1 ? [-1, 1] : [1, -1];
        const found =
            placement.find(
                text,
                [0, -24, 24].flatMap(
                    (aside) => sides.flatMap(
                        (side) => [0, 12].map((more) => [x + aside, y + side * (away + more)]))));
        if (found) {
            marks.push(word("of-time", ...found, text));
        }
    }
    return marks;
}
