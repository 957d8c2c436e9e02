// What the page of a comparison works on.

import {read_embedded} from "../embedded.js";

const schema = "downwash/comparison-report/v1";
const needed = ["findings", "series"];

export const axes = ["x", "y", "z"];

/** A list of JSON has null where there is no number. */
const numbers = (list) => Float64Array.from(list, (value) => value ?? NaN);
const places = (lists) => lists.map(numbers);

export function read_comparison(text) {
    const report = read_embedded(text, schema, "comparison", needed);
    const {series} = report;
    const of = {};
    for (const [name, list] of Object.entries(series)) {
        of[name] = Array.isArray(list[0]) ? places(list) : numbers(list);
    }
    return {...report, series: of};
}

/** An axis along which nothing ever differs, as beside a plane. */
export const is_flat = ({reference_m, flown_m}, axis) =>
    [reference_m, flown_m].every((lists) => lists[axis].every((value) => Number.isNaN(value) || value === lists[axis][0]));
