// The data that the program has put into a page.

import {Trouble} from "./decode.js";

/** The object between the tags, or a Trouble that says why there is none. */
export function read_embedded(text, schema, what, needed) {
    let data;
    try {
        data = JSON.parse(text);
    } catch (error) {
        throw new Trouble(`The data of this page cannot be read: the file is damaged (${error.message}).`);
    }
    if (data?.downwash === "nothing") {
        throw new Trouble(`This page is an empty template: no ${what} was put into it.`);
    }
    if (data?.schema !== schema) {
        throw new Trouble(
            `The data of this page is “${data?.schema ?? "without a schema"}”; this page shows ${schema}.`);
    }
    for (const key of needed) {
        if (typeof data[key] !== "object" || data[key] === null) {
            throw new Trouble(`The data of this page is incomplete: “${key}” is missing.`);
        }
    }
    return data;
}
