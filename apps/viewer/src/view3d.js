// The 3-D view is packed in the page and starts when somebody asks for it.

import {decode_triangles, inflate, Trouble} from "./decode.js";
import {h} from "./dom.js";

/** Meshes are unpacked first, as the drawing itself does not wait. */
async function unpack_solids(model) {
    const solids = [...model.scene.obstacles, ...model.robot.bodies].map((owner) => owner.solid);
    for (const solid of solids) {
        if (solid?.triangles && !solid.mesh) {
            solid.mesh = await decode_triangles(solid.triangles);
        }
    }
}

async function load_app() {
    if (!window.DownwashView3d) {
        const packed = document.getElementById("downwash-view3d")?.textContent ?? "";
        const code = new TextDecoder().decode(await inflate(packed, "The 3-D view", "gzip"));
        document.body.append(h("script", null, code));
        if (!window.DownwashView3d) {
            throw new Trouble("The 3-D view did not start.");
        }
    }
    return window.DownwashView3d;
}

function has_webgl() {
    const canvas = document.createElement("canvas");
    return Boolean(canvas.getContext("webgl2") || canvas.getContext("webgl"));
}

export function make_view3d(model, clock, theme) {
    const stage = h("div", {class: "stage"});
    const status = h("p", {class: "muted", role: "status"});
    const button = h("button", {type: "button", class: "open-3d"}, "Open the 3-D view");
    button.addEventListener("click", async () => {
        button.disabled = true;
        status.textContent = "Unpacking…";
        try {
            if (!has_webgl()) {
                throw new Trouble(
                    "This browser offers no WebGL here, which the 3-D view draws with. " +
                    "The scene above shows the same flight.");
            }
            await unpack_solids(model);
            const app = (await load_app()).start(stage, model, clock);
            app.set_theme(document.documentElement.dataset.theme);
            theme.follow(app.set_theme);
            stage.view = app;  // for tests
            const follow = h("input", {type: "checkbox", onchange: ({target}) => app.follow(target.checked)});
            button.replaceWith(h(
                "div", {class: "view3d-bar"}, clock ? h("label", {class: "layer"}, follow, "Follow the vehicle") : null));
            status.textContent = `${app.note} Drag to turn, wheel or pinch to come nearer, right button or two fingers to move. ` +
                `With the view in focus: W A S D turn, + and − come nearer, 0 goes back.`;
            stage.dataset.state = "open";
            stage.querySelector("canvas").focus({preventScroll: true});
        } catch (error) {
            button.disabled = false;
            status.textContent =
                error instanceof Trouble ? error.message : `The 3-D view cannot be shown: ${error.message}.`;
            stage.dataset.state = "failed";
        }
    });
    return h(
        "section", {class: "view3d screen-only", "aria-labelledby": "view3d-title"},
        h("h2", {id: "view3d-title"}, "In three dimensions"), button, stage, status);
}
