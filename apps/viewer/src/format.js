// Numbers as text. One place, so that the same quantity looks the same everywhere.

import {format} from "d3-format";

const thin = "\u202f";
const cache = new Map();

/** `specifier` as in d3-format; a real minus sign; a dash where there is no number. */
export function number(value, specifier) {
    if (value === null || value === undefined || !Number.isFinite(value)) {
        return "–";
    }
    if (!cache.has(specifier)) {
        cache.set(specifier, format(specifier));
    }
    const text = cache.get(specifier)(value).replace("-", "−").replace(/,/g, thin);
    return /^−0(\.0*)?$/.test(text) ? text.slice(1) : text;
}

/** A number with its unit, kept on one line. */
export function quantity(value, specifier, unit) {
    const text = number(value, specifier);
    return text === "–" || !unit ? text : `${text}\u00a0${unit}`;
}

export const meters = (value) => quantity(value, ".3f", "m");
export const place = (value) => quantity(value, ".2f", "m");
/** A point of the plane. */
export const point = (x_m, z_m) => `x\u00a0${place(x_m)}, z\u00a0${place(z_m)}`;
export const seconds = (value) => quantity(value, ".2f", "s");
export const degrees = (radians) => quantity((radians * 180) / Math.PI, ".1f", "°").replace("\u00a0", "");

/** Costs span from parts of a metre to a hundred kilojoules. */
export function cost(value, unit) { return quantity(value, Math.abs(value) >= 1000 ? ",.0f" : ".4~g", unit); }
