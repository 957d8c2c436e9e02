// Puts the page of a robot together.

import d3_licence from "../../licences/d3.txt";
import three_licence from "../../licences/three.txt";
import {h} from "../dom.js";
import {make_foot} from "../foot.js";
import {make_theme_switch} from "../theme.js";
import {make_trouble} from "../trouble.js";

import {make_facts, make_figures, make_head, make_warnings} from "./facts.js";
import {build_model, make_pose, read_report} from "./model.js";
import {make_scene, make_sliders} from "./scene.js";

const licences = [d3_licence, three_licence];

function assemble(page, model, theme) {
    const pose = make_pose(model);
    const scene = make_scene(model, pose, theme);
    page.replaceChildren(
        h("a", {class: "skip screen-only", href: "#scene"}, "To the scene"), make_head(model, theme.element),
        h("main", {class: "of-run robot-page"}, make_warnings(model),
          h("section", {class: "explore alone", "aria-label": "Robot"},
            h("div", {class: "scene-side", id: "scene"},
              h("div", {class: "scene-bar"}, h("h2", null, "Robot"), scene.tools), scene.element,
              make_sliders(model, pose), make_figures(model, pose))),
          make_facts(model, pose)),
        make_foot(model.report.version, licences));
    document.title = `${model.robot.name} · Downwash`;
    return {pose, scene};
}

const api = {};
/**
 * For tests and the curious: `ready` resolves when the page stands with its picture (with false when it shows an error
 * instead); `report` has all of the data; `state` is what follows from the pose that is shown; `view` is the view in
 * space, null without one.
 */
Object.defineProperty(window, "downwash", {value: api});

async function run() {
    const page = document.getElementById("page");
    const theme = make_theme_switch();
    let model, parts;
    try {
        model = build_model(read_report(document.getElementById("downwash-data").textContent));
        parts = assemble(page, model, theme);
    } catch (error) {
        page.replaceChildren(
            h("header", {class: "head"},
              h("div", {class: "head-line"}, h("div", {class: "brand"}, "Downwash"), theme.element)),
            h("main", null, make_trouble(error)), make_foot(null, licences));
        return false;
    }
    const {pose, scene} = parts;
    await scene.ready;
    Object.defineProperties(api, {
        report: {value: model.report},
        state: {get: () => pose.state},
        layers: {get: () => ({...scene.shown})},
        view: {value: scene.app},
    });
    Object.freeze(api);
    performance.mark("downwash-ready");
    return true;
}

api.ready = run();
