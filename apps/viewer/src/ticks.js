// Where the axes of figures have ticks.

import {scaleLinear} from "d3-scale";

const is_decade = (value) => Math.abs(Math.log10(value) - Math.round(Math.log10(value))) < 1e-9;
const is_first_two_or_five = (value) => /^[125]/.test(value.toExponential());

/**
 * Ticks with a number on a logarithmic axis: decades where it has two of them, below that 1, 2 and 5 of each, and equal
 * steps where even of these there are fewer than three.
 * @param {number} count of ticks in equal steps, about
 */
export function log_ticks(scale, count) {
    const all = scale.ticks();
    const decades = all.filter(is_decade), some = all.filter(is_first_two_or_five);
    if (decades.length >= 2) {
        return decades;
    }
    return some.length >= 3 ? some : scaleLinear().domain(scale.domain()).ticks(Math.max(3, count));
}
