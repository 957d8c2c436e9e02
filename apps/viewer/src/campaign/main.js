// Puts the page of a campaign together.

import d3_licence from "../../licences/d3.txt";
import {foreign, h} from "../dom.js";
import {make_foot} from "../foot.js";
import {make_theme_switch} from "../theme.js";
import {make_trouble} from "../trouble.js";
import {make_costs} from "./costs.js";
import {make_margins} from "./margins.js";
import {build_model, read_figures} from "./model.js";
import {make_outcomes, make_worlds} from "./outcomes.js";
import {make_first_solutions, make_flown_costs, make_pairs} from "./rows.js";
import {make_cost_shares, make_success} from "./success.js";
import {make_settings, make_tables} from "./tables.js";
import {make_head, make_verdict} from "./verdict.js";

/** Which line is whose; switching a planner off takes it out of all figures. */
function make_legend({planners, shown}) {
    return h(
        "fieldset", {class: "planners"}, h("legend", null, "Planners"),
        planners.map((planner) => h(
                         "label", {class: "planner"}, h("input", {
                             type: "checkbox",
                             checked: shown.has(planner),
                             onchange: (event) => shown.set(planner, event.target.checked)
                         }),
                         h("span", {class: `key ${planner.style}`, "aria-hidden": "true"}), foreign(planner.name))));
}

function assemble(page, model, theme) {
    // What a plan does in worlds that no search has seen matters most.
    const figures = [
        make_worlds(model), make_outcomes(model), make_flown_costs(model), make_cost_shares(model), make_success(model),
        make_costs(model), make_first_solutions(model), make_pairs(model)
    ];
    page.replaceChildren(
        h("a", {class: "skip screen-only", href: `#${model.has_worlds ? "worlds" : "outcomes"}`}, "To the figures"),
        make_head(model, theme.element),
        h("main", null, make_verdict(model), make_margins(model), make_legend(model),
          h("div", {class: `campaign-figures of-${Math.min(3, model.experiments.length)}`}, figures), make_tables(model),
          make_settings(model)),
        make_foot(model.figures.settings.version, [d3_licence]));
    document.title = `${model.figures.settings.campaign ?? "Campaign"} · Downwash`;
}

/** @returns {object|null} the figures shown; null when the page shows an error instead */
function run() {
    const page = document.getElementById("page");
    const theme = make_theme_switch();
    try {
        const model = build_model(read_figures(document.getElementById("downwash-data").textContent));
        assemble(page, model, theme);
        performance.mark("downwash-ready");
        return model.figures;
    } catch (error) {
        page.replaceChildren(h("main", null, make_trouble(error)), make_foot(null, [d3_licence]));
        return null;
    }
}

const figures = run();
// For tests and the curious: whether the page stands, and its data.
Object.defineProperty(window, "downwash", {value: Object.freeze({ready: Promise.resolve(figures !== null), figures})});
