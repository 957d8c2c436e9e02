// Puts the page of a flight in space together.

import d3_licence from "../../licences/d3.txt";
import three_licence from "../../licences/three.txt";
import {make_certificate} from "../certificate.js";
import {make_clock} from "../clock.js";
import {h} from "../dom.js";
import {make_foot} from "../foot.js";
import {make_playback} from "../playback.js";
import {make_plots} from "../plots.js";
import {make_search} from "../search.js";
import {make_theme_switch} from "../theme.js";
import {make_trouble} from "../trouble.js";

import {make_facts, make_obstacle_table, make_repeat} from "./facts.js";
import {make_judge} from "./judge.js";
import {build_model, read_report} from "./model.js";
import {make_readout} from "./readout.js";
import {make_scene} from "./scene.js";
import {space_plots} from "./series.js";
import {make_figures, make_head, make_verdict} from "./verdict.js";

const licences = [d3_licence, three_licence];

function make_hints(clock) {
    return [
        h("p", {class: "hint for-keys muted screen-only"},
          clock ? "Space plays; ← → move by a tick, with shift by a second; Home and End go to the ends. " : "",
          "Drag turns the view, the wheel comes nearer, the right button moves; in focus: W A S D turn, + and − come nearer, 0 goes back."),
        h("p", {class: "hint for-fingers muted screen-only"}, clock ? "A tap on the picture plays and pauses. " : "",
          "A finger turns the view; two fingers zoom and move it.",
          clock ? " A finger along a plot moves the vehicle." : "")
    ];
}

function assemble(page, model, theme) {
    const clock = model.data ? make_clock(model.data.t_s) : null;
    const playback = clock ? make_playback(model, clock) : null;
    const scene = make_scene(model, clock, playback, theme);
    const plots = clock ? make_plots(space_plots(model), model, clock, playback) : null;
    page.replaceChildren(
        h("a", {class: "skip screen-only", href: "#scene"}, "To the scene"), make_head(model, theme.element),
        h("main", {class: "of-run"}, make_verdict(model),
          h("section", {class: `explore${clock ? "" : " alone"}`, "aria-label": "Scene and plots"},
            h("div", {class: "scene-side", id: "scene"},
              h("div", {class: "scene-bar"}, h("h2", null, clock ? "Flight" : "Scene"), scene.tools), scene.element,
              make_figures(model), clock ? make_readout(model, clock) : null, make_hints(clock),
              make_obstacle_table(model)),
            plots ? h("div", {class: "plot-side"}, h("h2", null, "Over time", plots.moment), plots.element) : null),
          make_judge(model), make_certificate(model), make_search(model), make_facts(model), make_repeat(model)),
        make_foot(model.report.version, licences));
    document.title = `${model.report.name} · Downwash`;
    if (clock && model.is_cut_short) {
        clock.set(clock.rows - 1);
    }
    return {clock, playback, scene};
}

const api = {};
/**
 * For tests and the curious, read-only but for `time`: `ready` resolves when the page stands with its picture (with
 * false when it shows an error instead); `data` has the columns of the flight by name, `report` all of the data; `row`
 * and `time` are the moment shown, and setting `time` moves the slider; `layers` says which are on; `view` is the view
 * in space, null without one.
 */
Object.defineProperty(window, "downwash", {value: api});

async function run() {
    const page = document.getElementById("page");
    const theme = make_theme_switch();
    let model, parts;
    try {
        model = await build_model(read_report(document.getElementById("downwash-data").textContent));
        parts = assemble(page, model, theme);
    } catch (error) {
        page.replaceChildren(
            h("header", {class: "head"},
              h("div", {class: "head-line"}, h("div", {class: "brand"}, "Downwash"), theme.element)),
            h("main", null, make_trouble(error)), make_foot(null, licences));
        return false;
    }
    const {clock, playback, scene} = parts;
    await scene.ready;
    Object.defineProperties(api, {
        data: {value: model.columns},
        report: {value: model.report},
        rows: {value: model.rows},
        row: {get: () => clock?.row ?? null},
        time: {
            get: () => clock?.time_s ?? null,
            set: (time_s) => {
                if (clock) {
                    playback.slider.value = String(clock.row_at(time_s));
                    playback.slider.dispatchEvent(new Event("input"));
                }
            },
        },
        is_playing: {get: () => playback?.is_playing ?? false},
        layers: {get: () => ({...scene.shown})},
        view: {value: scene.app},
    });
    Object.freeze(api);
    performance.mark("downwash-ready");
    return true;
}

api.ready = run();
