// Saves a drawing as an SVG file of its own, in light colours: it has no ground, and paper is white.

import {h, set_attributes} from "./dom.js";

const carried = [
    "fill", "fill-opacity", "stroke", "stroke-width", "stroke-dasharray", "stroke-linejoin", "opacity", "font-family",
    "font-size", "font-weight", "paint-order"
];

/** What `read` finds in the light theme; nothing is painted meanwhile. */
function in_light(read) {
    const {dataset} = document.documentElement, {theme} = dataset;
    dataset.theme = "light";
    try {
        return read();
    } finally {
        dataset.theme = theme;
    }
}

/** @param {SVGElement} svg */
function standalone(svg) {
    const copy = svg.cloneNode(true);
    const originals = svg.querySelectorAll("*");
    copy.querySelectorAll("*").forEach((element, index) => {
        const style = getComputedStyle(originals[index]);
        carried.forEach((name) => element.setAttribute(name, style.getPropertyValue(name)));
        element.removeAttribute("class");
    });
    copy.setAttribute("xmlns", "http://www.w3.org/2000/svg");
    const box = svg.getAttribute("viewBox");
    if (box) {
        const [, , width, height] = box.split(" ");
        set_attributes(copy, {width, height});
    }
    copy.removeAttribute("class");
    return new XMLSerializer().serializeToString(copy);
}

export function make_save_button(svg, title) {
    const save = () => {
        const address = URL.createObjectURL(new Blob([in_light(() => standalone(svg))], {type: "image/svg+xml"}));
        const name = title.toLowerCase().replace(/[^a-z0-9]+/g, "_").replace(/^_|_$/g, "").slice(0, 80);
        const link = h("a", {href: address, download: `${name || "figure"}.svg`});
        link.click();
        setTimeout(() => URL.revokeObjectURL(address), 1000);
    };
    return h(
        "button", {type: "button", class: "small screen-only", onclick: save, "aria-label": `Save “${title}” as SVG`},
        "SVG");
}
