// Puts the page of a validation together.

import d3_licence from "../../licences/d3.txt";
import {make_command} from "../command.js";
import {h} from "../dom.js";
import {make_foot} from "../foot.js";
import {make_theme_switch} from "../theme.js";
import {make_trouble} from "../trouble.js";
import {make_clearance} from "./clearance.js";
import {make_flights} from "./flights.js";
import {read_validation} from "./model.js";
import {make_sensitivity} from "./sensitivity.js";
import {make_disagreements, make_head, make_verdict} from "./verdict.js";
import {make_worlds} from "./worlds.js";

const make_repeat = ({command}) =>
    h("section", {class: "repeat", "aria-labelledby": "repeat-title"}, h("h2", {id: "repeat-title"}, "To repeat"),
      make_command(command));

const api = {};
/**
 * For tests and the curious, read-only: `ready` resolves when the page stands (with false when it shows an error
 * instead); `report` is all of the data; `flight` is the index of the flight shown, `rows` and `row` are of it, and
 * `show(index)` shows another one.
 */
Object.defineProperty(window, "downwash", {value: api});

async function run() {
    const page = document.getElementById("page");
    const theme = make_theme_switch();
    try {
        const report = read_validation(document.getElementById("downwash-data").textContent);
        const flights = make_flights(report);
        await flights.show(0);
        page.replaceChildren(
            h("a", {class: "skip screen-only", href: "#flights"}, "To the flights"), make_head(report, theme.element),
            h("main", null, make_verdict(report), make_disagreements(report), make_worlds(report),
              make_clearance(report), make_sensitivity(report), flights.element, make_repeat(report)),
            make_foot(report.version, [d3_licence]));
        document.title = `${report.problem} · Downwash validation`;
        Object.defineProperties(api, {
            report: {value: report},
            flight: {get: () => flights.shown},
            rows: {get: () => flights.clock?.rows ?? 0},
            row: {get: () => flights.clock?.row ?? null},
            show: {value: flights.show},
        });
        Object.freeze(api);
        performance.mark("downwash-ready");
        return true;
    } catch (error) {
        page.replaceChildren(h("main", null, make_trouble(error)), make_foot(null, [d3_licence]));
        return false;
    }
}

api.ready = run();
