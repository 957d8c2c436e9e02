// The foot of a page.

import {h} from "./dom.js";

/** @param {string[]} licences of the libraries in the page, as texts */
export function make_foot(version, licences) {
    return h(
        "footer", {class: "foot"},
        h("p", null, `Made by Downwash ${version ?? ""}. The page needs no network and sends nothing anywhere.`),
        h("details", {class: "licences screen-only"}, h("summary", null, "Licences of the libraries in this page"),
          licences.map((text) => h("pre", {tabindex: "0"}, text))));
}
