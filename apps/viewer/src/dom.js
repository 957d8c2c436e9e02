// Elements with little writing. Text of others only ever enters as text nodes.

const svg_namespace = "http://www.w3.org/2000/svg";

function fill(element, attributes, children) {
    for (const [name, value] of Object.entries(attributes ?? {})) {
        if (value === null || value === undefined || value === false) {
            continue;
        }
        if (name.startsWith("on")) {
            element.addEventListener(name.slice(2), value);
        } else {
            element.setAttribute(name, value === true ? "" : String(value));
        }
    }
    element.append(...children.flat().filter((child) => child !== null && child !== undefined && child !== false));
    return element;
}

/** @returns {HTMLElement} */
export function h(tag, attributes, ...children) { return fill(document.createElement(tag), attributes, children); }

/** @returns {SVGElement} */
export function s(tag, attributes, ...children) {
    return fill(document.createElementNS(svg_namespace, tag), attributes, children);
}

/** Text of others: isolated, so that its direction of writing stays its own. */
export function foreign(text) { return h("bdi", null, String(text)); }

/** In SVG, where there is no <bdi>: Unicode's isolates. */
export function isolated(text, most = 200) {
    const characters = [...String(text)];
    const shown = characters.length > most ? characters.slice(0, most - 1).join("") + "…" : characters.join("");
    return `\u2068${shown}\u2069`;
}

export function set_attributes(element, attributes) {
    for (const [name, value] of Object.entries(attributes)) {
        element.setAttribute(name, value);
    }
}

/** Calls `task` once in the next frame, however often it was asked for. */
export function once_a_frame(task) {
    let is_waiting = false;
    return () => {
        if (!is_waiting) {
            is_waiting = true;
            requestAnimationFrame(() => {
                is_waiting = false;
                task();
            });
        }
    };
}
