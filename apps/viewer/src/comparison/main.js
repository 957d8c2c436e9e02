// Puts the page of a comparison together.

import d3_licence from "../../licences/d3.txt";
import {make_command} from "../command.js";
import {h} from "../dom.js";
import {make_foot} from "../foot.js";
import {make_theme_switch} from "../theme.js";
import {make_trouble} from "../trouble.js";
import {make_clearance, make_errors, make_places, make_thrust} from "./curves.js";
import {read_comparison} from "./model.js";
import {make_head, make_phases, make_verdict} from "./verdict.js";

const make_repeat = ({command}) =>
    h("section", {class: "repeat", "aria-labelledby": "repeat-title"}, h("h2", {id: "repeat-title"}, "To repeat"),
      make_command(command));

const api = {};
/** For tests and the curious, read-only: `ready` is whether the page stands, `report` all of the data. */
Object.defineProperty(window, "downwash", {value: api});

function run() {
    const page = document.getElementById("page");
    const theme = make_theme_switch();
    try {
        const report = read_comparison(document.getElementById("downwash-data").textContent);
        page.replaceChildren(
            h("a", {class: "skip screen-only", href: "#places"}, "To the figures"), make_head(report, theme.element),
            h("main", null, make_verdict(report), make_phases(report), make_places(report), make_errors(report),
              make_clearance(report), make_thrust(report), make_repeat(report)),
            make_foot(report.version, [d3_licence]));
        document.title = `${report.problem} · Downwash comparison`;
        Object.defineProperty(api, "report", {value: report});
        performance.mark("downwash-ready");
        return true;
    } catch (error) {
        page.replaceChildren(h("main", null, make_trouble(error)), make_foot(null, [d3_licence]));
        return false;
    }
}

api.ready = Promise.resolve(run());
