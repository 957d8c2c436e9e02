// A picture in three dimensions: its canvas, camera, names and colours. Who makes one draws its world, then frames it.

import * as three from "three";

import {make_camera} from "./camera.js";
import {lights, make_canvas, palettes} from "./look.js";
import {make_names} from "./names.js";

/** @param {string} [label] what the picture shows, for readers of screens */
export function make_picture(label) {
    // The buffer stays for prints.
    const renderer = new three.WebGLRenderer({antialias: true, preserveDrawingBuffer: true});
    const canvas = make_canvas(renderer);
    if (label) {
        canvas.setAttribute("aria-label", label);
    }
    const world = new three.Scene(), painted = [];
    world.add(...lights());
    let stage = null, names = null, view = null, has_names = true;
    const draw_now = (width, height) => {
        renderer.render(world, view.camera);
        names.element.style.display = has_names ? "" : "none";
        if (has_names) {
            names.draw(view.camera, width, height);
        }
    };
    let is_waiting = false;
    const render = () => {
        if (!is_waiting) {
            is_waiting = true;
            requestAnimationFrame(() => {
                is_waiting = false;
                draw_now(stage.clientWidth, stage.clientHeight);
            });
        }
    };
    const draw_theme = (theme) => {
        world.background = new three.Color(palettes[theme].paper);
        painted.forEach(([material, name]) => material.color.set(palettes[theme][name]));
    };
    let theme = "light", is_framed = false;
    return {
        world,
        render,
        /** A material takes a colour of the palettes, by its name. */
        paint: (material, name) => painted.push([material, name]),
        /**
         * Puts the picture into its place in the page.
         * @param {object} framing of make_camera()   @param {object[]} texts of make_names()
         * @param {[() => any[], Map<object, three.Object3D>?]} hiding what hides names, as of make_names()
         * @returns the view of make_camera()
         */
        frame(into, framing, texts, ...hiding) {
            stage = into;
            view = make_camera(canvas, framing, render);
            names = make_names(texts, ...hiding);
            stage.replaceChildren(canvas, names.element);
            return view;
        },
        show_names(is_on) {
            has_names = is_on;
            render();
        },
        /** What a page moves every picture with. */
        controls: {
            home: () => view.home(),
            zoom_by: (factor) => view.zoom_by(factor),
            look_along: (x, y, z) => view.look_along(new three.Vector3(x, y, z).normalize()),
            set_theme(next) {
                theme = next;
                draw_theme(theme);
                render();
            },
            /** @param {boolean} on_paper draws at once, in light colours */
            resize(width, height, on_paper) {
                renderer.setPixelRatio(on_paper ? 2 : Math.min(2, window.devicePixelRatio || 1));
                renderer.setSize(width, height, false);
                view.camera.aspect = width / height;
                view.camera.updateProjectionMatrix();
                if (!is_framed) {
                    is_framed = true;
                    view.home();
                }
                draw_theme(on_paper ? "light" : theme);
                draw_now(width, height);
            },
        },
    };
}
