// A view in space that is the picture of a page, with what moves it: layers, zoom and directions.

import {Trouble} from "./decode.js";
import {h} from "./dom.js";
import {keep_sized} from "./sizing.js";
import {has_webgl, load_app, unpack_solids} from "./view3d.js";

/** Of the window: what stands above and the playback below have room in the same screen. */
const height_for = (width) =>
    Math.round(Math.min((width < 500 ? 0.95 : 0.62) * width, Math.max(300, 0.56 * window.innerHeight), 640));
const height_on_paper = 380;

/**
 * The picture cannot be drawn without WebGL; the rest of the page stands all the same.
 * @param {{solids: object[], layers: string[][], home: [string, string], legend: (HTMLElement | HTMLElement[])[],
 *     playback?: any, can_follow?: boolean, start: (bundle: any, stage: HTMLElement) => any}} parts `layers` are [id,
 *     name, swatch]; `home` is what the last button fits, and how it says so; `start` begins to draw
 * @returns {{element: HTMLElement, tools: HTMLElement, shown: Record<string, boolean>, ready: Promise<void>, app: any}}
 */
export function make_stage({solids, layers, home, legend, playback = null, can_follow = false, start}, theme) {
    const stage = h("div", {class: "stage alone"});
    const note = h("p", {class: "space-note muted", role: "status"}, "Unpacking…");
    const shown = {};
    let app = null;
    const switches = layers.map(([id, name, swatch]) => {
        shown[id] = true;
        const change = ({target}) => {
            shown[id] = target.checked;
            app?.show(id, target.checked);
        };
        return h(
            "label", {class: "layer"},
            h("input", {type: "checkbox", "data-toggle": id, checked: true, onchange: change}),
            h("span", {class: `key ${swatch}`, "aria-hidden": "true"}), name);
    });
    if (can_follow) {
        const follow = ({target}) => app?.follow(target.checked);
        switches.push(
            h("label", {class: "layer"}, h("input", {type: "checkbox", "data-toggle": "follow", onchange: follow}),
              "Follow the vehicle"));
    }
    const button = (text, label, act) =>
        h("button", {type: "button", class: "small", title: label, "aria-label": label, onclick: act}, text);
    const tools =
        h("div", {class: "zoom-tools screen-only", role: "group", "aria-label": "View"},
          button("Top", "From above, y upwards", () => app?.look_along(0, 0.001, -1)),
          button("Side", "From the side, x to the right", () => app?.look_along(0, 1, 0)),
          button("Front", "From the front, y to the right", () => app?.look_along(-1, 0, 0)),
          button("+", "Zoom in", () => app?.zoom_by(1.4)), button("−", "Zoom out", () => app?.zoom_by(1 / 1.4)),
          button(...home, () => app?.home()));
    playback?.plays_on_tap(stage);
    const element =
        h("figure", {class: "scene"}, stage, playback?.element,
          h("fieldset", {class: "layers screen-only"}, h("legend", {class: "visually-hidden"}, "Layers of the scene"),
            switches),
          note, h("figcaption", null, h("div", {class: "legend"}, legend)));

    const begin = async () => {
        if (!has_webgl()) {
            throw new Trouble(
                "This browser offers no WebGL here, which the view in space draws with. Plots and tables have the numbers.");
        }
        await unpack_solids(solids);
        app = start(await load_app(), stage);
        app.set_theme(document.documentElement.dataset.theme);
        theme.follow(app.set_theme);
        stage.view = app;  // for tests
        // Before keep_sized() listens, which asks for the width on paper.
        let on_paper = false;
        addEventListener("beforeprint", () => {
            on_paper = true;
        });
        addEventListener("afterprint", () => {
            on_paper = false;
        });
        keep_sized(stage, 690, (width) => {
            const height = on_paper ? height_on_paper : height_for(width);
            stage.style.height = `${height}px`;
            stage.style.width = on_paper ? `${width}px` : "";
            app.resize(width, height, on_paper);
        });
        note.textContent = app.note;
        stage.dataset.state = "open";
    };
    const ready = begin().catch((error) => {
        stage.classList.add("failed");
        stage.dataset.state = "failed";
        note.textContent =
            error instanceof Trouble ? error.message : `The view in space cannot be shown: ${error.message}.`;
    });
    return {element, tools, shown, ready, get app() { return app; }};
}

/** An entry of the legend. */
export const legend_entry = (key, text) =>
    h("span", {class: "entry"}, h("span", {class: `key ${key}`, "aria-hidden": "true"}), text);
