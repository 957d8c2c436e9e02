// The view in space: a bundle of its own with three.js. x right, y away from the viewer, z up, as in the data.

import * as three from "three";

import {opening_of} from "../extents.js";
import {number} from "../format.js";
import {pose_at} from "../model.js";
import {are_many, goal_region, is_cut} from "../surroundings.js";
import {planar_view} from "./camera.js";
import {names_of} from "./names.js";
import {make_picture} from "./picture.js";
import {draw_grid, draw_sheet, grid_around} from "./plane.js";
import {draw_line, draw_solid, draw_together, draw_tube, draw_vehicle} from "./solids.js";

const opacities = {
    section: 0.6,
    projection: 0.25
};

/** Of more triangles than these a ray would meet too many at every turn of the view. */
const most_met_triangles = 2000;

const in_space = (points) => points.map(([x, z]) => [x, 0, z]);

/** @returns {Map<object, three.Object3D>} the bodies of the obstacles that are hardly seen through */
function draw_obstacles(world, obstacles, paint) {
    const bodies = new Map();
    const together = {section: [], projection: []};
    for (const obstacle of obstacles) {
        const {solid, section, projection} = obstacle;
        const name = is_cut(obstacle) ? "section" : "projection";
        if (solid && are_many(obstacles)) {
            together[name].push(solid);
        } else if (solid) {
            const body = draw_solid(solid, name, paint, opacities[name]);
            world.add(body);
            if (name === "section" && !(solid.mesh?.indices.length > 3 * most_met_triangles)) {
                bodies.set(obstacle, body.children[0]);
            }
        } else {
            // Too large a mesh for a page: its outline in the plane of motion stands for it.
            for (const ring of section.length > 0 ? section : projection) {
                world.add(draw_line(in_space([...ring, ring[0]]), "edge", paint, false));
            }
        }
    }
    for (const [name, solids] of Object.entries(together)) {
        if (solids.length > 0) {
            world.add(draw_together(solids, name, paint, opacities[name]));
        }
    }
    return bodies;
}

/** As large as in the scene: a ball for a disc, flat in the plane of motion where x and z are judged one by one. */
function draw_goal(goal, bounds, paint) {
    const {x_m, z_m, half_x, half_z, shape} = goal_region(goal, bounds);
    const has_size = half_x > 0 && half_z > 0, is_flat = has_size && shape === "rectangle";
    const seen = (half) => Math.max(0.06, has_size ? half : 0.08);
    const geometry = is_flat ? new three.BoxBufferGeometry(2 * seen(half_x), 0.02, 2 * seen(half_z)) :
                               new three.SphereBufferGeometry(seen(half_x), 24, 16);
    const material =
        new three.MeshBasicMaterial({transparent: true, opacity: is_flat ? 0.4 : 0.6, depthWrite: !is_flat});
    paint(material, "goal");
    const body = new three.Mesh(geometry, material);
    body.position.set(x_m, 0, z_m);
    return body;
}

function draw_paths(world, {data}, size_m, paint) {
    const points = (x_m, z_m) => Array.from(x_m, (x, i) => [x, 0, z_m[i]]);
    const radius = Math.min(0.03, 0.0018 * size_m);
    world.add(
        draw_tube(points(data.x_m, data.z_m), radius, "flown", paint),
        draw_tube(points(data.ee_x_m, data.ee_z_m), 0.6 * radius, "tip", paint),
        draw_line(points(data.ref_x_m, data.ref_z_m), "planned", paint, true));
}

/** @param {HTMLElement} stage */
export function start(stage, model, clock) {
    const {data, scene, robot} = model;
    const picture = make_picture();
    const {world, paint, render} = picture;
    const grid = grid_around(data ? opening_of(model) : scene.bounds);
    const ends = (list) => [list[0], list[list.length - 1]];
    const extent = {x_m: ends(grid.x_m), z_m: ends(grid.z_m)};
    const size_m = Math.max(extent.x_m[1] - extent.x_m[0], extent.z_m[1] - extent.z_m[0]);

    world.add(draw_grid(grid, paint));
    const sheet = model.map ? draw_sheet(model.map, grid) : null;
    if (sheet) {
        world.add(sheet.sheet);
    }
    const bodies = draw_obstacles(world, scene.obstacles, paint);
    const goals = model.goals.map((goal) => draw_goal(goal, scene.bounds, paint));
    world.add(...goals);
    const vehicle = draw_vehicle(robot, paint);
    vehicle.move({pitch_rad: 0, ...(model.solution.planning?.obstruction ?? model.start)});
    world.add(vehicle.body);
    if (data) {
        draw_paths(world, model, size_m, paint);
    }

    const {radius_m, positions_m} = robot.rotors;
    const width_m = 2 * (radius_m + Math.max(...positions_m.map(([, y]) => Math.abs(y))));
    const view = picture.frame(
        stage, planar_view(extent, width_m, scene.obstacles), names_of(model, grid, extent), vehicle.covered, bodies);
    new ResizeObserver(() => {
        const width = stage.clientWidth, height = stage.clientHeight;
        if (width > 0 && height > 0) {
            picture.controls.resize(width, height, false);
        }
    }).observe(stage);

    let is_following = false;
    const reach_m = robot.arm.length_m + width_m;
    const follow = (is_on) => {
        is_following = is_on;
        if (is_on) {
            view.look_at(vehicle.body.position, 2.2 * reach_m);
        } else {
            view.home();
        }
    };
    clock?.follow((row) => {
        vehicle.move(pose_at(data, row));
        if (is_following) {
            view.move_to(vehicle.body.position);
        }
        render();
    });
    return {
        ...picture.controls,
        follow,
        note: `The grid lies in the plane of motion; its squares are ${number(grid.step_m, "~r")}\u00a0m wide. ` +
            "Obstacles that the plane cuts are darker than those beside it.",
        set_theme(theme) {
            sheet?.set_theme(theme);
            picture.controls.set_theme(theme);
        },
        /** Where the end effector is drawn, for tests. */
        tip() {
            const point = new three.Vector3(robot.arm.length_m, 0, 0);
            vehicle.body.updateMatrixWorld(true);
            const link = vehicle.body.children[vehicle.body.children.length - 1];
            return link.localToWorld(point).toArray();
        },
        /** Least and greatest corner of every goal as it is drawn, for tests. */
        goals: () => goals.map((body) => new three.Box3().setFromObject(body))
                         .map(({min, max}) => [min.toArray(), max.toArray()]),
        /** Where a point of the plane of motion is seen, from 0 to 1 from left to right and from top to bottom, for tests. */
        seen_at(x_m, z_m) {
            const {x, y} = new three.Vector3(x_m, 0, z_m).project(view.camera);
            return [0.5 + x / 2, 0.5 - y / 2];
        },
    };
}
