// Puts the page together.

import d3_licence from "../licences/d3.txt";
import three_licence from "../licences/three.txt";

import {make_certificate} from "./certificate.js";
import {make_clock} from "./clock.js";
import {h} from "./dom.js";
import {make_foot} from "./foot.js";
import {build_model, read_report} from "./model.js";
import {make_playback} from "./playback.js";
import {make_plots} from "./plots.js";
import {make_readout} from "./readout.js";
import {make_obstacle_table, make_repeat} from "./repeat.js";
import {make_scene} from "./scene.js";
import {make_search} from "./search.js";
import {plots_of} from "./series.js";
import {make_theme_switch} from "./theme.js";
import {make_trouble} from "./trouble.js";
import {make_figures, make_head, make_verdict} from "./verdict.js";
import {make_view3d} from "./view3d.js";

const licences = [d3_licence, three_licence];

function show_trouble(page, error, theme) {
    page.replaceChildren(
        h("header", {class: "head"},
          h("div", {class: "head-line"}, h("div", {class: "brand"}, "Downwash"), theme.element)),
        h("main", null, make_trouble(error)), make_foot(null, licences));
}

function assemble(page, model, theme) {
    const clock = model.data ? make_clock(model.data.t_s) : null;
    const playback = clock ? make_playback(model, clock) : null;
    const space = make_view3d(model, clock, theme);
    const scene = make_scene(model, clock, playback, space);
    const plots = clock ? make_plots(plots_of(model), model, clock, playback) : null;
    page.replaceChildren(
        h("a", {class: "skip screen-only", href: "#scene"}, "To the scene"), make_head(model, theme.element),
        h("main", {class: "of-run"}, make_verdict(model), make_figures(model),
          h("section", {class: `explore${clock ? "" : " alone"}`, "aria-label": "Scene and plots"},
            h("div", {class: "scene-side", id: "scene"},
              h("div", {class: "scene-bar"}, h("h2", null, clock ? "Flight" : "Scene"), space.choice, scene.tools),
              scene.element,
              clock ? make_readout(model, clock) : null,
              h("p", {class: "hint for-keys muted screen-only"},
                clock ? "Space plays; ← → move by a tick, with shift by a second; Home and End go to the ends. " : "",
                h("span", {class: "of-side"},
                  "Drag moves the scene; the wheel zooms it once it has been clicked, or with Ctrl; " +
                      "in focus: + − 0 and W A S D."),
                h("span", {class: "of-space"},
                  "Drag turns the view, the wheel comes nearer, the right button moves; " +
                      "in focus: W A S D turn, + and − come nearer, 0 goes back.")),
              h("p", {class: "hint for-fingers muted screen-only"},
                clock ? "A tap on the picture plays and pauses. " : "",
                h("span", {class: "of-side"}, "Two fingers zoom and move the scene."),
                h("span", {class: "of-space"}, "A finger turns the view; two fingers zoom and move it."),
                clock ? " A finger along a plot moves the vehicle." : ""),
              make_obstacle_table(model)),
            plots ? h("div", {class: "plot-side"}, h("h2", null, "Over time", plots.moment), plots.element) : null),
          make_certificate(model), make_search(model), make_repeat(model)),
        make_foot(model.report.version, licences));
    document.title = `${model.solution.problem?.name ?? "Run"} · Downwash`;
    if (clock && model.is_cut_short) {
        clock.set(clock.rows - 1);
    }
    return {clock, playback, scene};
}

/** One frame after everything is in place: what a reader waits for. */
const painted = () => new Promise((done) => {
    const timeout = setTimeout(done, 1000);
    requestAnimationFrame(() => requestAnimationFrame(() => {
                              clearTimeout(timeout);
                              done();
                          }));
});

const api = {};
/**
 * For tests and the curious, read-only but for `time`: `ready` resolves when the page stands (with false when it shows
 * an error instead); `data` has the columns of trajectory.csv by name, `solution` is solution.json, `report` all of the
 * data; `row` and `time` are the moment shown, and setting `time` moves the slider; `layers` says which are on;
 * `pixels(x, z)` are the client coordinates of a point of the plane in the scene.
 */
Object.defineProperty(window, "downwash", {value: api});

async function run() {
    const page = document.getElementById("page");
    const theme = make_theme_switch();
    let model, parts;
    try {
        const report = read_report(document.getElementById("downwash-data").textContent);
        model = await build_model(report);
        parts = assemble(page, model, theme);
    } catch (error) {
        show_trouble(page, error, theme);
        return false;
    }
    const {clock, playback, scene} = parts;
    Object.defineProperties(api, {
        data: {value: model.data},
        solution: {value: model.solution},
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
        pixels: {
            value: (x_m, z_m) => {
                const box = scene.view.svg.getBoundingClientRect();
                const [x, y] = scene.view.to_pixels(x_m, z_m), scale = box.width / scene.view.width;
                return [box.left + x * scale, box.top + y * scale];
            }
        },
    });
    Object.freeze(api);
    await painted();
    performance.mark("downwash-ready");
    return true;
}

api.ready = run();
