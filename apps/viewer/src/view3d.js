// The view in space is packed in the page and starts when somebody asks for it.

import {decode_triangles, inflate, Trouble} from "./decode.js";
import {h} from "./dom.js";

/** Meshes are unpacked first, as the drawing itself does not wait. */
export async function unpack_solids(solids) {
    for (const solid of solids) {
        if (solid?.triangles && !solid.mesh) {
            solid.mesh = await decode_triangles(solid.triangles);
        }
    }
}

export async function load_app() {
    if (!window.DownwashView3d) {
        const packed = document.getElementById("downwash-view3d")?.textContent ?? "";
        const code = new TextDecoder().decode(await inflate(packed, "The view in space", "gzip"));
        document.body.append(h("script", null, code));
        if (!window.DownwashView3d) {
            throw new Trouble("The view in space did not start.");
        }
    }
    return window.DownwashView3d;
}

export function has_webgl() {
    const canvas = document.createElement("canvas");
    return Boolean(canvas.getContext("webgl2") || canvas.getContext("webgl"));
}

/**
 * The choice between the view from the side and the view in space, which stand in the same place and share playback and
 * zoom buttons. What belongs to one of them only has the class `of-side` or `of-space`.
 * @returns {{choice: HTMLElement, stage: HTMLElement, options: HTMLElement, note: HTMLElement, shown: any}} `shown` has
 *     `zoom_by` and `home` while the view in space is shown, else it is null
 */
export function make_view3d(model, clock, theme) {
    const stage = h("div", {class: "stage screen-only"});
    const note = h("p", {class: "space-note muted screen-only", role: "status"});
    const options = h("div", {class: "layers of-space screen-only"});
    let app = null, is_in_space = false;

    const show = (in_space) => {
        is_in_space = in_space;
        stage.closest(".scene-side").classList.toggle("in-space", in_space);
        side.setAttribute("aria-pressed", String(!in_space));
        space.setAttribute("aria-pressed", String(in_space));
        note.textContent = in_space ? app.note : "";
        // Keys act on what is shown, and space plays.
        stage.parentElement.querySelector(in_space ? "canvas" : "svg").focus({preventScroll: true});
    };
    const start = async () => {
        if (!has_webgl()) {
            throw new Trouble(
                "This browser offers no WebGL here, which the view in space draws with. The view from the side shows " +
                "the same flight.");
        }
        await unpack_solids([...model.scene.obstacles, ...model.robot.bodies].map((owner) => owner.solid));
        app = (await load_app()).start(stage, model, clock);
        app.set_theme(document.documentElement.dataset.theme);
        theme.follow(app.set_theme);
        stage.view = app;  // for tests
        if (clock) {
            const follow = h("input", {type: "checkbox", onchange: ({target}) => app.follow(target.checked)});
            options.append(h("label", {class: "layer"}, follow, "Follow the vehicle"));
        }
    };
    const open = async () => {
        space.disabled = true;
        try {
            if (!app) {
                note.textContent = "Unpacking…";
                await start();
            }
            show(true);
            stage.dataset.state = "open";
        } catch (error) {
            note.textContent =
                error instanceof Trouble ? error.message : `The view in space cannot be shown: ${error.message}.`;
            stage.dataset.state = "failed";
        }
        space.disabled = false;
    };
    const button = (text, is_pressed, act) =>
        h("button", {type: "button", class: "small", "aria-pressed": String(is_pressed), onclick: act}, text);
    const side = button("From the side", true, () => show(false)), space = button("In space", false, open);
    space.classList.add("open-3d");
    const choice = h("div", {class: "view-choice screen-only", role: "group", "aria-label": "View"}, side, space);
    return {choice, stage, options, note, get shown() { return is_in_space ? app : null; }};
}
