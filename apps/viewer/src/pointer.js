// What is under the pointer: place and thrust ratio.

import {h} from "./dom.js";
import {number, point} from "./format.js";

/**
 * @returns {number | null | undefined} the thrust ratio at the nearest point, null where it is not flyable, undefined
 *     outside
 */
function factor_at(map, x_m, z_m) {
    const column = Math.round((x_m - map.x_low_m) / map.cell_m), row = Math.round((z_m - map.z_low_m) / map.cell_m);
    if (column < 0 || row < 0 || column >= map.columns || row >= map.rows) {
        return undefined;
    }
    const level = map.levels[row * map.columns + column];
    return level === 255 ? null : map.factor_low + (level / 254) * (map.factor_high - map.factor_low);
}

export function make_pointer_text(view, map) {
    const element = h("div", {class: "pointer-text screen-only", "aria-hidden": "true"});
    view.svg.addEventListener("pointermove", (happened) => {
        if (happened.pointerType === "touch") {
            return;
        }
        const box = view.svg.getBoundingClientRect(), scale = view.width / box.width;
        const x = (happened.clientX - box.left) * scale, y = (happened.clientY - box.top) * scale;
        const [left, top, right, bottom] = view.inside;
        if (x < left || x > right || y < top || y > bottom) {
            element.textContent = "";
            return;
        }
        const [x_m, z_m] = view.to_plane(x, y);
        const factor = map ? factor_at(map, x_m, z_m) : undefined;
        const words = factor === undefined ? "" :
            factor === null                ? ", not flyable" :
                                             `, K ${number(factor, ".2f")}`;
        element.textContent = point(x_m, z_m) + words;
    });
    view.svg.addEventListener("pointerleave", () => {
        element.textContent = "";
    });
    return element;
}
