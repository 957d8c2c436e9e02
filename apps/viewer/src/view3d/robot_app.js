// A robot in space: a bundle of its own with three.js. Axes of its multirotor: x forward, y left, z up.

import * as three from "three";

import {number, place, quantity} from "../format.js";
import {axis_names, draw_floor, floor_of} from "./floor.js";
import {make_picture} from "./picture.js";
import {draw_line} from "./solids.js";
import {draw_space_robot} from "./space_robot.js";

const vector = (list) => new three.Vector3(...list);
const axes = [0, 1, 2];

/** The greatest thrust in a hover is as long as this share of the vehicle's width. */
const thrust_share = 0.8;

/** The ends of rotor discs, thrusts and all that the end effector gets to: what has to be in the picture. */
function outermost_points({robot, facts, joints, report}, width_m) {
    const {rotors, rotor_radius_m: radius_m} = robot;
    // The directions to the neighbours of a cube.
    const steps = [-1, 0, 1], ways = steps.flatMap((x) => steps.flatMap((y) => steps.map((z) => [x, y, z])));
    const reached = ways.filter(([x, y, z]) => joints > 0 && (x || y || z) && (y === 0 || !report.is_planar))
                        .map((way) => way.map((value) => (value * facts.reach_m) / Math.hypot(...way)));
    const discs = rotors.flatMap(({position_m, axis}) => {
        const [x, y, z] = position_m, outward = 1 + radius_m / Math.hypot(x, y, 1e-9);
        const thrust_m = (thrust_share * width_m) / Math.hypot(...axis);
        return [
            [x - radius_m, y, z], [x + radius_m, y, z], [x, y - radius_m, z], [x, y + radius_m, z],
            [outward * x, outward * y, z], position_m.map((place, k) => place + thrust_m * axis[k])
        ];
    });
    return [...reached, ...discs, [0, 0, -0.4 * width_m]];
}

/** Balls of a size on the screen would hide small robots: as large as a part of the robot. */
function draw_mass(radius_m, name, paint, opacity = 1) {
    const material = new three.MeshBasicMaterial({transparent: true, opacity, depthTest: false});
    paint(material, name);
    const ball = new three.Mesh(new three.SphereBufferGeometry(radius_m, 20, 14), material);
    ball.renderOrder = 3;
    return ball;
}

/** An arc over the disc of a rotor, in the direction in which it turns. */
function draw_spin({position_m, axis, spin}, radius_m, paint) {
    const group = new three.Group();
    group.position.copy(vector(position_m));
    group.quaternion.setFromUnitVectors(new three.Vector3(0, 0, 1), vector(axis).normalize());
    const arc = 0.62 * radius_m, lift = 0.02 * radius_m, steps = 40, turn = 1.5 * Math.PI;
    const at = (angle) => [arc * Math.cos(angle), arc * Math.sin(angle), lift];
    const points = Array.from({length: steps + 1}, (_, i) => at((spin * turn * i) / steps));
    group.add(draw_line(points, "vehicle", paint, false));
    const end = spin * turn, way = new three.Vector3(-Math.sin(end), Math.cos(end), 0).multiplyScalar(spin);
    const head = new three.Mesh(
        new three.ConeBufferGeometry(0.09 * radius_m, 0.26 * radius_m, 12), new three.MeshBasicMaterial());
    paint(head.material, "vehicle");
    head.position.copy(vector(at(end)));
    head.quaternion.setFromUnitVectors(new three.Vector3(0, 1, 0), way);
    group.add(head);
    return group;
}

/** How far the end effector gets: a sphere in space, a circle in the plane of motion. */
function draw_reach({facts, report}, paint) {
    if (report.is_planar) {
        const circle = Array.from({length: 73}, (_, i) => {
            const angle = (i * Math.PI) / 36;
            return [facts.reach_m * Math.cos(angle), 0, facts.reach_m * Math.sin(angle)];
        });
        return draw_line(circle, "edge", paint, true);
    }
    const material = new three.MeshBasicMaterial({wireframe: true, transparent: true, opacity: 0.1, depthWrite: false});
    paint(material, "edge");
    const sphere = new three.Mesh(new three.SphereBufferGeometry(facts.reach_m, 24, 14), material);
    sphere.rotation.x = Math.PI / 2;
    return sphere;
}

/** @param {HTMLElement} stage */
export function start(stage, model, pose) {
    const {robot, size_m, joints, facts} = model;
    const picture = make_picture("The robot in three dimensions; its numbers stand in the tables of this page.");
    const {world, paint, render} = picture;
    const width_m = Math.max(robot.rotor_radius_m, ...robot.rotors.map(({position_m}) => Math.hypot(...position_m)));
    const points = outermost_points(model, width_m);
    const opening = {
        low: axes.map((k) => Math.min(...points.map((point) => point[k]))),
        high: axes.map((k) => Math.max(...points.map((point) => point[k])))
    };
    const floor = floor_of(opening);
    const direction = new three.Vector3(-0.75, 0.5, -0.42).normalize();

    world.add(draw_floor(floor, paint));
    const layers = {masses: new three.Group(), spins: new three.Group(), reach: new three.Group()};
    const hover_n = Math.max(...pose.state.thrusts_n);
    const vehicle = draw_space_robot(robot, paint, {meters_per_n: (thrust_share * width_m) / hover_n});
    world.add(vehicle.body);
    const own = draw_mass(0.035 * width_m, "vehicle", paint), whole = draw_mass(0.06 * width_m, "goal", paint, 0.85);
    const of_links = robot.links.map(() => draw_mass(0.035 * width_m, "goal", paint));
    layers.masses.add(own, whole, ...of_links);
    robot.rotors.filter(({spin}) => spin !== 0)
        .forEach((rotor) => layers.spins.add(draw_spin(rotor, robot.rotor_radius_m, paint)));
    if (joints > 0) {
        layers.reach.add(draw_reach(model, paint));
    }
    world.add(...Object.values(layers));

    const names = [];
    const kilograms = (mass_kg) => quantity(mass_kg, ".3~g", "kg");
    robot.rotors.forEach(({position_m, spin}, k) => {
        const turning = spin === 0 ? "" : spin > 0 ? " ↺" : " ↻";
        names.push({kind: "of-rotor", text: `${k + 1}${turning}`, at: vector(position_m)});
    });
    const whole_name = {kind: "of-mass", text: `whole ${kilograms(facts.mass_kg)}`, at: new three.Vector3()};
    const link_names = robot.links.map(
        ({mass_kg}, i) =>
            ({kind: "of-mass", text: `link ${i + 1} ${kilograms(mass_kg)}`, at: new three.Vector3()}));
    names.push(
        ...(joints > 0 ?
                [whole_name, ...link_names,
                 {kind: "of-mass", text: `multirotor ${kilograms(robot.multirotor.mass_kg)}`, at: new three.Vector3()}] :
                [whole_name]),
        ...axis_names(floor, opening, direction, 3));

    const target = vector(axes.map((k) => (opening.low[k] + opening.high[k]) / 2));
    picture.frame(stage, {target, size: 2 * size_m, corners: points.map(vector), direction}, names, () => []);

    pose.follow(({joints_rad, centers_m, whole_m, thrusts_n}) => {
        vehicle.move({position_m: [0, 0, 0], attitude: [1, 0, 0, 0], joints_rad});
        vehicle.push(thrusts_n);
        whole.position.copy(vector(whole_m));
        whole_name.at.copy(whole.position);
        of_links.forEach((ball, i) => {
            ball.position.copy(vector(centers_m[i]));
            link_names[i].at.copy(ball.position);
        });
        render();
    });
    return {
        ...picture.controls,
        note: `The grid is level at z ${place(floor.z_m)}; its squares are ${number(floor.step_m, "~r")}\u00a0m wide.`,
        show(id, is_on) {
            if (id === "names") {
                picture.show_names(is_on);
            } else {
                const parts = {forces: vehicle.arrows, solids: vehicle.solids}[id] ?? [layers[id]];
                parts.forEach((part) => {
                    part.visible = is_on;
                });
                render();
            }
        },
        tip: vehicle.tip,
        /** Where the whole centre of mass is drawn, for tests. */
        center: () => whole.position.toArray(),
    };
}
