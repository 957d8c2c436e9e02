// What stands in place of a page that cannot be shown.

import {Trouble} from "./decode.js";
import {h} from "./dom.js";

export function make_trouble(error) {
    const text = error instanceof Trouble ?
        error.message :
        `The data of this page cannot be shown: it does not have the expected shape (${error.message}).`;
    return h("p", {class: "page-trouble", role: "alert"}, text);
}
