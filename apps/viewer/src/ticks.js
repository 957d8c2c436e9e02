// Where the axes of figures have ticks.

import {scaleLinear} from "d3-scale";

const is_decade = (value) => Math.abs(Math.log10(value) - Math.round(Math.log10(value))) < 1e-9;
const is_first_two_or_five = (value) => /^[125]/.test(value.toExponential());

/** Between the middles of two numbers on an axis, in pixels. */
const least_room = 46;

/**
 * Ticks with a number on a logarithmic axis, as many as have room: decades, then 2 and 5 of each; the other digits where
 * these are fewer than three; and equal steps where even of those there are fewer than three.
 * @param {number} count of ticks in equal steps, about
 */
export function log_ticks(scale, count) {
    const all = scale.ticks(), kept = [];
    const keep = (list) => list.forEach((value) => {
        if (kept.every((other) => Math.abs(scale(value) - scale(other)) >= least_room)) {
            kept.push(value);
        }
    });
    keep(all.filter(is_decade));
    keep(all.filter(is_first_two_or_five));
    if (kept.length < 3) {
        keep(all);
    }
    return kept.length >= 3 ? kept.sort((a, b) => a - b) :
                              scaleLinear().domain(scale.domain()).ticks(Math.max(3, count));
}
