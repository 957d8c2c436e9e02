// The worlds in which a plan flew worst.

import {make_command} from "./command.js";
import {h} from "./dom.js";
import {meters} from "./format.js";
import {outcome_name} from "./words.js";

/** A card with the worlds, and below it a command that flies one of them again. */
export function make_worst_worlds(worst, advice, command) {
    return h(
        "div", {class: "card worst"}, h("h3", null, "Worst worlds"),
        h("div", {class: "scroll", tabindex: "0", role: "region", "aria-label": "Worst worlds"},
          h("table", {class: "numbers worst-worlds"},
            h("thead", null,
              h("tr", null, ["world", "outcome", "min. clearance"].map((name) => h("th", {scope: "col"}, name)))),
            h("tbody", null,
              worst.map(
                  ({world, outcome, min_clearance_m}) =>
                      h("tr", null, h("th", {scope: "row"}, String(world)), h("td", null, outcome_name(outcome)),
                        h("td", null, meters(min_clearance_m))))))),
        h("div", null, h("p", {class: "muted"}, advice), make_command(command)));
}
