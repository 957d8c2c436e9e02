// A flight in space: a bundle of its own with three.js. World axes as in the data: x right, y away, z up.

import * as three from "three";

import {isolated} from "../dom.js";
import {number, place} from "../format.js";
import {are_many} from "../surroundings.js";

import {axis_names, draw_floor, floor_of} from "./floor.js";
import {make_picture} from "./picture.js";
import {draw_line, draw_solid, draw_together, draw_tube} from "./solids.js";
import {draw_goal, place_of, reach_of} from "./space_goals.js";
import {draw_space_robot} from "./space_robot.js";

const vector = (list) => new three.Vector3(...list);
const axes = [0, 1, 2];

/** What matters: start, goals and flight with the reach of the robot; all of the bounds where nothing flew. */
function opening_of(model) {
    const {bounds} = model.scene;
    if (!model.data) {
        return {low: [...bounds.low_m], high: [...bounds.high_m]};
    }
    const reach_m = model.size_m;
    const low = [Infinity, Infinity, Infinity], high = [-Infinity, -Infinity, -Infinity];
    const include = (point, around_m) => axes.forEach((k) => {
        low[k] = Math.min(low[k], point[k] - around_m);
        high[k] = Math.max(high[k], point[k] + around_m);
    });
    include(model.start.position_m, reach_m);
    model.goals.forEach((goal) => include(place_of(goal, model.scene), Math.max(reach_of(goal), 0.5 * reach_m)));
    for (let row = 0; row < model.rows; row += 5) {
        include(model.position_at(row), reach_m);
    }
    return {low, high};
}

/** The box in which the centre of mass may be. */
function draw_bounds({low_m, high_m}, paint) {
    const size = axes.map((k) => high_m[k] - low_m[k]);
    const material = new three.LineDashedMaterial(
        {dashSize: 0.02 * Math.max(...size), gapSize: 0.02 * Math.max(...size), transparent: true, opacity: 0.6});
    paint(material, "edge");
    const box = new three.LineSegments(new three.EdgesGeometry(new three.BoxBufferGeometry(...size)), material);
    box.computeLineDistances();
    box.position.copy(vector(axes.map((k) => (low_m[k] + high_m[k]) / 2)));
    return box;
}

/** Obstacles, seen through. Of meshes that are too large for a page, the box around them. */
function draw_obstacles(obstacles, paint) {
    const group = new three.Group(), solids = obstacles.map(({solid, low_m, high_m}) => solid ?? {
        box: {
            size_m: axes.map((k) => high_m[k] - low_m[k]),
            center_m: axes.map((k) => (low_m[k] + high_m[k]) / 2),
            axes: [[1, 0, 0], [0, 1, 0], [0, 0, 1]]
        }
    });
    if (are_many(obstacles)) {
        group.add(draw_together(solids, "section", paint, 0.4));
    } else {
        solids.forEach((solid) => group.add(draw_solid(solid, "section", paint, 0.38)));
    }
    return group;
}

/** Points of the flight, or of the problem, that one wants to see. */
function wanted_points(model) {
    const points = [vector(model.start.position_m), ...model.goals.map((goal) => vector(place_of(goal, model.scene)))];
    const count = model.data ? 12 : 0;
    for (let i = 0; i < count; ++i) {
        const row = Math.round(((i + 1) / count) * (model.rows - 1));
        points.push(vector(model.position_at(row)), vector(model.tip_at(row)));
    }
    return points.slice(0, 40);
}

/**
 * From where most of the flight is in sight: the camera looks along it. Of equal ones the first, from the right and
 * above.
 */
function clear_direction(model, obstacles) {
    const candidates =
        [-0.42, -0.12, 0.3].flatMap((up) => [0.35, -0.35, 1, -1, 2.2, -2.2, 3.5, -3.5].map((turn) => ({turn, up})));
    const directions =
        candidates.map(({turn, up}) => new three.Vector3(Math.sin(turn), Math.cos(turn), up).normalize());
    const meshes = [];
    let triangles = 1;
    obstacles.traverse((part) => {
        if (part.isMesh) {
            meshes.push(part);
            triangles += (part.geometry.index ?? part.geometry.getAttribute("position")).count / 3;
        }
    });
    const points = wanted_points(model);
    const most_points = Math.max(2, Math.floor(4e6 / triangles / directions.length));
    const every = Math.ceil(points.length / most_points);
    const caster = new three.Raycaster();
    obstacles.updateMatrixWorld(true);
    const seen = directions.map(
        (direction) => points
                           .filter((point, i) => {
                               if (i % every !== 0) {
                                   return false;
                               }
                               caster.set(point, direction.clone().negate());
                               return caster.intersectObjects(meshes, false).length === 0;
                           })
                           .length);
    return directions[seen.indexOf(Math.max(...seen))];
}

/** Rows at equal steps of motion. */
function snapshot_rows(model) {
    const way = new Float64Array(model.rows);
    for (let i = 1; i < model.rows; ++i) {
        const from = vector(model.position_at(i - 1));
        way[i] = way[i - 1] + from.distanceTo(vector(model.position_at(i)));
    }
    const whole = way[model.rows - 1], steps = Math.min(8, Math.max(1, Math.floor(whole / (2.2 * model.size_m))));
    const rows = [];
    for (let step = 0, row = 0; step <= steps; ++step) {
        while (row < model.rows - 1 && way[row] < (whole * step) / steps) {
            ++row;
        }
        rows.push(row);
    }
    return [...new Set(rows)];
}

/** Names in space, the most important ones first; numbers of axes along the sides of the floor that are near. */
function names_of(model, floor, opening, direction, most_ticks) {
    const {goals, scene, start} = model;
    const names = goals.map((goal) => ({kind: "of-goal", text: goal.name, at: vector(place_of(goal, scene))}));
    names.push({kind: "of-start", text: "start", at: vector(start.position_m)});
    names.push(...axis_names(floor, opening, direction, most_ticks));
    const most_names = 60;
    const size_m = ({low_m, high_m}) => Math.hypot(...axes.map((k) => high_m[k] - low_m[k]));
    const named = are_many(scene.obstacles) ? [] : scene.obstacles.filter(({name}) => name);
    const largest = [...named].sort((a, b) => size_m(b) - size_m(a)).slice(0, most_names);
    const shared_middle = (low, high, k) => {
        const from = Math.max(low, opening.low[k]), to = Math.min(high, opening.high[k]);
        return from <= to ? (from + to) / 2 : high < opening.low[k] ? high : low;
    };
    return [
        ...names, ...largest.map(({name, low_m, high_m}) => ({
                                     kind: "of-section",
                                     text: isolated(name.replace(/\s+/g, " "), 26),
                                     at: vector(axes.map((k) => shared_middle(low_m[k], high_m[k], k)))
                                 }))
    ];
}

function draw_cross(at, size_m, paint) {
    // Seen through the vehicle.
    const material = new three.MeshBasicMaterial({depthTest: false, transparent: true, opacity: 0.85});
    paint(material, "bad");
    const group = new three.Group();
    for (const way of [[1, 1, 1], [1, -1, 1], [1, 1, -1], [-1, 1, 1]]) {
        const bar = new three.Mesh(
            new three.CylinderBufferGeometry(0.045 * size_m, 0.045 * size_m, 1.4 * size_m, 10), material);
        bar.quaternion.setFromUnitVectors(new three.Vector3(0, 1, 0), vector(way).normalize());
        bar.renderOrder = 2;
        group.add(bar);
    }
    group.position.copy(at);
    return group;
}

/** @param {HTMLElement} stage */
export function start(stage, model, clock) {
    const {data, scene, robot} = model;
    const picture = make_picture();
    const {world, paint, render} = picture;
    const opening = opening_of(model), floor = floor_of(opening);
    const size_m = Math.max(...axes.map((k) => opening.high[k] - opening.low[k]));

    const layers = {};
    const layer = (id, ...parts) => {
        layers[id] = new three.Group();
        layers[id].add(...parts);
        world.add(layers[id]);
    };
    const obstacles = draw_obstacles(scene.obstacles, paint);
    const direction = clear_direction(model, obstacles);
    world.add(draw_floor(floor, paint));
    layer("bounds", draw_bounds(scene.bounds, paint));
    layer("obstacles", obstacles);
    const goals = model.goals.map((goal) => draw_goal(goal, scene, robot, model.size_m, paint));
    world.add(...goals.map(({group}) => group));
    // Hovering thrust is about as long as the vehicle.
    const hover_n = (robot.facts.mass_kg * 9.81) / robot.rotors.length;
    const vehicle = draw_space_robot(robot, paint, {meters_per_n: (0.6 * model.size_m) / hover_n});
    vehicle.move(model.start);
    vehicle.arrows.forEach((arrow) => {
        arrow.visible = data !== null;
    });
    world.add(vehicle.body);

    let drop = null;
    if (data) {
        const points = (x, y, z) => Array.from(x, (_, i) => [x[i], y[i], z[i]]);
        const radius_m = Math.min(0.03, 0.0018 * size_m, 0.035 * model.size_m);
        const shadow = draw_line(points(data.x_m, data.y_m, data.z_m.map(() => floor.z_m)), "edge", paint, false);
        drop = new three.Line(
            new three.BufferGeometry().setFromPoints([new three.Vector3(), new three.Vector3(0, 0, -1)]),
            new three.LineBasicMaterial({transparent: true, opacity: 0.5}));
        paint(drop.material, "edge");
        layer("planned", draw_line(points(data.ref_x_m, data.ref_y_m, data.ref_z_m), "planned", paint, true));
        layer("flown", draw_tube(points(data.x_m, data.y_m, data.z_m), radius_m, "flown", paint));
        layer("shadow", shadow, drop);
        layer("tip", draw_tube(points(data.ee_x_m, data.ee_y_m, data.ee_z_m), 0.6 * radius_m, "tip", paint));
        layer("snapshots", ...snapshot_rows(model).map((row) => {
            const ghost = draw_space_robot(robot, paint, {is_ghost: true});
            ghost.move(model.pose_at(row));
            return ghost.body;
        }));
        layer(
            "wanted",
            new three.Mesh(new three.SphereBufferGeometry(0.07 * model.size_m, 16, 12), new three.MeshBasicMaterial()));
        paint(layers.wanted.children[0].material, "planned");
        if (model.is_cut_short) {
            world.add(draw_cross(vector(model.position_at(model.rows - 1)), model.size_m, paint));
        }
    }

    const corners = [0, 1, 2, 3, 4, 5, 6, 7].map(
        (i) => vector(axes.map((k) => ((i >> k) & 1) === 0 ? opening.low[k] : opening.high[k])));
    const target = vector(axes.map((k) => (opening.low[k] + opening.high[k]) / 2));
    const view = picture.frame(
        stage, {target, size: size_m, corners, direction},
        names_of(model, floor, opening, direction, stage.clientWidth < 500 ? 3 : 6), vehicle.covered);

    let is_following = false;
    const show_row = (row) => {
        vehicle.move(model.pose_at(row));
        vehicle.push(model.thrusts_at(row));
        layers.wanted.position.copy(vector(model.wanted_at(row)));
        const [x, y, z] = model.position_at(row);
        drop.geometry.setFromPoints([new three.Vector3(x, y, z), new three.Vector3(x, y, floor.z_m)]);
        if (is_following) {
            view.move_to(vehicle.body.position);
        }
        render();
    };
    clock?.follow(show_row);
    return {
        ...picture.controls,
        step_m: floor.step_m,
        floor_m: floor.z_m,
        note:
            `The grid is level at z ${place(floor.z_m)}; its squares are ${number(floor.step_m, "~r")}\u00a0m wide. ` +
            (data ? "The thin line on it is the flight seen from above." : ""),
        follow(is_on) {
            is_following = is_on;
            if (is_on) {
                view.look_at(vehicle.body.position, 4.5 * model.size_m);
            } else {
                view.home();
            }
        },
        show(id, is_on) {
            if (id === "names") {
                picture.show_names(is_on);
                return;
            }
            (id === "forces" ? vehicle.arrows : [layers[id]]).forEach((part) => {
                part.visible = is_on;
            });
            render();
        },
        tip: vehicle.tip,
        goals: () =>
            goals.map(({ball}) => new three.Box3().setFromObject(ball)).map(({min,
                                                                              max}) => [min.toArray(), max.toArray()]),
        /** Where a point is seen, from 0 to 1 from left to right and from top to bottom, for tests. */
        seen_at(...point) {
            const {x, y} = vector(point).project(view.camera);
            return [0.5 + x / 2, 0.5 - y / 2];
        },
    };
}
