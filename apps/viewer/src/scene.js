// The scene: what can be switched on and off, and the vehicle at the moment shown.

import {h, s} from "./dom.js";
import {opening_of, padded} from "./extents.js";
import {forces_note, make_forces} from "./forces.js";
import {point, quantity, seconds} from "./format.js";
import {draw_obstacle_names, draw_place_names, draw_snapshot_times, give_way, names_of, Placement} from "./labels.js";
import {draw_map, make_color_bar} from "./map_layer.js";
import {pose_at, reference_at} from "./model.js";
import {draw_flown, draw_planned, draw_snapshots, draw_tip, draw_tree, draw_waypoints, snapshot_rows} from "./paths.js";
import {make_pointer_text} from "./pointer.js";
import {keep_sized} from "./sizing.js";
import {draw_bounds, draw_goals, draw_obstacles, draw_start, goal_region, is_cut, make_hatches, wanted_pose} from "./surroundings.js";
import {make_vehicle, vehicle_at, vehicle_boxes} from "./vehicle.js";
import {View} from "./view.js";
import {goal_name} from "./words.js";

function describe(model) {
    const {scene, start, goals, data, rows} = model;
    const cut = scene.obstacles.filter(is_cut).length;
    const goal_texts =
        goals.map(({x_m, z_m}, index) => `${goal_name(model, index)} at ${point(x_m, z_m)}`);
    const sentences = [
        "The plane of motion to scale, seen from the side",
        `${scene.obstacles.length} obstacles, ${cut} of them cut by the plane`,
        [`Start at ${point(start.x_m, start.z_m)}`, ...goal_texts].join(", "),
        data ? `The flight takes ${seconds(model.end_s)} and ends at ${point(data.x_m[rows - 1], data.z_m[rows - 1])}` :
               "There is no flight",
        "The numbers stand in the tables of this page",
    ];
    return `${sentences.join(". ")}.`;
}

/** A cross where the flight broke off or the search was stopped. */
function draw_trouble(view, x_m, z_m) {
    const [x, y] = view.to_pixels(x_m, z_m);
    return s(
        "g", {class: "trouble-mark", transform: `translate(${x} ${y})`}, s("circle", {r: 10}),
        s("path", {d: "M-4 -4L4 4M-4 4L4 -4"}));
}

/** @param space the view in space, of a page that has one */
export function make_scene(model, clock, playback, space = null) {
    const {data, robot, rotor_groups, scene, solution} = model;
    const view = new View(padded(scene.bounds), opening_of(model), describe(model), playback !== null);
    make_hatches(view);
    const rows = data ? snapshot_rows(model) : [];
    const obstruction = solution.planning?.obstruction ?? null;
    const names = names_of(scene.obstacles);

    const surroundings = s("g", null, draw_bounds(scene.bounds), draw_obstacles(scene.obstacles));
    const current = s("g", {class: "current"});
    const words = s("g", {class: "words"}), moving_words = s("g", {class: "moving-words"});
    view.overlay.append(words, moving_words);

    /**
     * @type {{id: string, name: string, swatch: string, on: boolean, draw: () => SVGElement | SVGElement[], into:
     *     SVGElement}[]}
     */
    const layers = [];
    const under = s("g"), over = s("g");
    const layer = (id, name, swatch, on, draw, into = over) => layers.push({id, name, swatch, on, draw, into});
    if (model.map) {
        layer("map", "Thrust ratio", "map", true, () => draw_map(model.map), view.raster);
    }
    if (model.tree) {
        layer("tree", "Tree", "tree", !data, () => draw_tree(model), under);
    }
    let forces = null;
    if (data || solution.plan) {
        layer("planned", "Planned", "planned", true, () => [draw_planned(model), ...draw_waypoints(model)]);
    }
    if (data) {
        layer("flown", "Flown", "flown", true, () => draw_flown(model));
        layer("tip", "End effector", "tip", true, () => draw_tip(model));
        layer("snapshots", "Snapshots", "snapshots", true, () => draw_snapshots(model, rows));
        if (model.commands.length > 0) {
            forces = make_forces(model, clock, view);
            layer("forces", "Thrust", "forces", true, () => forces.element, moving_words);
        }
    }
    if (scene.obstacles.length > 0) {
        layer("names", "Names", "names", true, () => s("g"), words);
    }
    view.world.append(surroundings, under, draw_start(model), draw_goals(model), over, current);

    const shown = {};
    const groups = {};
    const switches = layers.map(({id, name, swatch, on, draw, into}) => {
        groups[id] = s("g", {"data-layer": id});
        into.append(groups[id]);
        const show = (is_on) => {
            shown[id] = is_on;
            if (is_on && !groups[id].hasChildNodes()) {
                groups[id].append(...[draw()].flat());
            }
            groups[id].style.display = is_on ? "" : "none";
        };
        show(on);
        return h(
            "label", {class: "layer"}, h("input", {
                type: "checkbox",
                "data-toggle": id,
                checked: on,
                onchange: ({target}) => {
                    show(target.checked);
                    view.redraw_soon();
                }
            }),
            h("span", {class: `key ${swatch}`, "aria-hidden": "true"}), name);
    });

    const flown = data ? make_vehicle(robot, rotor_groups, "flown now") : null;
    const ghost = data ? make_vehicle(robot, rotor_groups, "planned now") : null;
    if (data) {
        current.append(ghost.element, flown.element);
    } else if (obstruction) {
        current.append(vehicle_at(
            robot, rotor_groups, "obstructed",
            {x_m: obstruction.x_m, z_m: obstruction.z_m, pitch_rad: 0, arm_rad: obstruction.arm_rad}));
    }

    const boxes_at = (pose) => vehicle_boxes(view, robot, rotor_groups, pose);
    view.follow(() => {
        const scale = view.pixels_per_m;
        view.svg.style.setProperty("--arm-width", `${Math.max(2.2, 2 * robot.arm.radius_m * scale)}px`);
        view.svg.style.setProperty("--disc-width", `${Math.min(4, Math.max(1.6, 0.035 * scale))}px`);
        const placement = new Placement(view.inside);
        const marks = [];
        const trouble = model.is_cut_short ? [data.x_m[model.rows - 1], data.z_m[model.rows - 1]] :
            !data && obstruction           ? [obstruction.x_m, obstruction.z_m] :
                                             null;
        if (trouble) {
            marks.push(draw_trouble(view, ...trouble));
            const [x, y] = view.to_pixels(...trouble);
            placement.reserve([x - 12, y - 12, x + 12, y + 12]);
        }
        // Words stay off all vehicles that stand still.
        const wanted = model.goals.map((goal) => wanted_pose(goal, goal_region(goal, scene.bounds)));
        const stopped = data ? null : obstruction;
        [model.start, stopped, ...wanted, ...(shown.snapshots ? rows : []).map((row) => pose_at(data, row))]
            .filter((pose) => pose)
            .flatMap((pose) => boxes_at({pitch_rad: 0, ...pose}))
            .forEach((box) => placement.reserve(box));
        marks.push(...draw_place_names(view, model, placement));
        if (shown.snapshots) {
            marks.push(...draw_snapshot_times(view, model, rows, placement));
        }
        if (shown.names) {
            groups.names.replaceChildren(...draw_obstacle_names(view, names, placement));
        }
        words.replaceChildren(...marks, ...(groups.names ? [groups.names] : []));
        move_words();
    });
    const move_words = () => {
        forces?.draw();
        give_way(words, shown.forces && forces ? forces.words : [], data ? boxes_at(pose_at(data, clock.row)) : []);
    };
    clock?.follow((row) => {
        flown.move(pose_at(data, row));
        ghost.move(reference_at(data, row));
        if (view.width) {
            move_words();
        }
    });

    const button = (text, label, act, where = "") => h(
        "button", {type: "button", class: `small ${where}`, title: label, "aria-label": label, onclick: act}, text);
    const everything = padded(scene.bounds);
    const tools =
        h("div", {class: "zoom-tools screen-only", role: "group", "aria-label": "Zoom"},
          button("+", "Zoom in", () => (space?.shown ?? view).zoom_by(1.4)),
          button("−", "Zoom out", () => (space?.shown ?? view).zoom_by(1 / 1.4)),
          button(
              data ? "Flight" : "Fit", data ? "Fit the flight" : "Fit the bounds",
              () => space?.shown ? space.shown.home() : view.show(view.opening)),
          data ? button("All", "Fit the bounds", () => view.show(everything), "of-side") : null);
    const frame = h("div", {class: "scene-frame"}, view.svg, make_pointer_text(view, model.map), space?.stage);
    playback?.plays_on_tap(frame);
    const element =
        h("figure", {class: "scene"}, frame, playback?.element,
          h("fieldset", {class: "layers of-side screen-only"}, h("legend", {class: "visually-hidden"}, "Layers of the scene"),
            switches),
          space?.options, space?.note,
          h("figcaption", null, model.map ? make_color_bar(model.map) : null, make_legend(model, forces)));
    keep_sized(frame, 690, (width) => view.resize(width));
    return {element, tools, view, shown, flown};
}

function make_legend(model, forces) {
    const entry = (key, text, where = "") =>
        h("span", {class: `entry ${where}`}, h("span", {class: `key ${key}`, "aria-hidden": "true"}), text);
    const beside = model.scene.obstacles.some((obstacle) => !is_cut(obstacle));
    const cut = model.scene.obstacles.some(is_cut);
    return h(
        "div", {class: "legend of-side"},
        model.data ?
            [
                model.hovers.some(({goal}) => goal !== null) ?
                    entry("hover", "hover at a goal, by its number", "screen-only") :
                    null,
                entry("snapshots", "flown, vehicle and arm"),
                entry("snapshots planned", "planned: the reference, drawn level"),
                // On screens these stand beside their switches.
                entry("flown", "flown path", "print-only"), entry("planned", "planned path", "print-only"),
                entry("tip", "end-effector path", "print-only")
            ] :
            null,
        model.tree ? entry("tree", "search tree", "print-only tree-entry") : null,
        cut ? entry("section", "obstacle, cut") : null,
        beside ? entry("projection", "obstacle beside the plane") : null, entry("goal", "goal region"),
        model.is_cut_short || (!model.data && model.solution.planning?.obstruction) ?
            entry("trouble", model.data ? "where the flight breaks off" : "nearest path to the goal, rejected here") :
            null,
        forces ? h("span", {class: "note"}, forces_note(model), ` ${quantity(10, "d", "N")} are `,
                   `${quantity(10 * forces.meters_per_n, ".2f", "m")} long.`) :
                 null);
}
