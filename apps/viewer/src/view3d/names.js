// Names in space: words over the picture that keep their size, the more important ones first, none on another or on the
// vehicle.

import * as three from "three";

import {h, isolated} from "../dom.js";
import {place} from "../format.js";
import {Placement} from "../labels.js";
import {extent_of} from "../numbers.js";
import {are_many, goal_region, is_cut} from "../surroundings.js";
import {goal_name} from "../words.js";

/** The middle of what two ranges share; of ranges apart, the end of the first that is nearer to the second. */
function shared_middle([low, high], [other_low, other_high]) {
    const from = Math.max(low, other_low), to = Math.min(high, other_high);
    return from <= to ? (from + to) / 2 : high < other_low ? high : low;
}

/** The middle of the part of an obstacle that is seen first. */
function anchor_of(obstacle, extent) {
    const {x_m, z_m} = extent_of(obstacle.projection);
    const {box, cylinder, sphere} = obstacle.solid ?? {};
    const y = is_cut(obstacle) ? 0 : (box ?? cylinder ?? sphere)?.center_m[1] ?? 0;
    return new three.Vector3(shared_middle(x_m, extent.x_m), y, shared_middle(z_m, extent.z_m));
}

/** @returns {{kind: string, text: string, at: three.Vector3, obstacle?: object}[]} the most important ones first */
export function names_of(model, grid, extent) {
    const {goals, scene, start} = model;
    const names = goals.map((goal, i) => {
        const {x_m, z_m} = goal_region(goal, scene.bounds);
        return {kind: "of-goal", text: goal_name(model, i), at: new three.Vector3(x_m, 0, z_m)};
    });
    names.push({kind: "of-start", text: "start", at: new three.Vector3(start.x_m, 0, start.z_m)});
    const low = grid.z_m[0], left = grid.x_m[0];
    const tick = (value) => place(value).replace(/[.]?0+(?=\u00a0)/, "");
    const every = Math.ceil(grid.x_m.length / 8);
    names.push(
        ...grid.x_m.filter((_, i) => i % every === 0)
            .map((x) => ({kind: "of-axis", text: `x ${tick(x)}`, at: new three.Vector3(x, 0, low)})),
        ...grid.z_m.filter((_, i) => i > 0 && i % every === 0)
            .map((z) => ({kind: "of-axis", text: `z ${tick(z)}`, at: new three.Vector3(left, 0, z)})));
    const named = are_many(scene.obstacles) ? [] : scene.obstacles.filter(({name}) => name);
    const obstacles = named.map((obstacle) => ({
        kind: is_cut(obstacle) ? "of-section" : "of-projection",
        text: isolated(obstacle.name.replace(/\s+/g, " "), 26),
        at: anchor_of(obstacle, extent),
        obstacle,
    }));
    return [...names, ...obstacles];
}

/**
 * What points cover in a picture, as a box [left, top, right, bottom] in pixels.
 * @param {three.Vector3[]} points
 */
function box_around(points, camera, width, height) {
    const seen = points.map((point) => point.clone().project(camera));
    const x = seen.map((at) => (0.5 + at.x / 2) * width), y = seen.map((at) => (0.5 - at.y / 2) * height);
    return [Math.min(...x), Math.min(...y), Math.max(...x), Math.max(...y)];
}

/**
 * Whether the camera sees a point through another obstacle than its own.
 * @param {Map<object, three.Object3D>} bodies of the obstacles that are hardly seen through
 */
function is_behind({at, obstacle}, bodies, camera) {
    const way = at.clone().sub(camera.position), far = way.length();
    const ray = new three.Raycaster(camera.position, way.normalize(), 0, far);
    return [...bodies].some(([other, body]) => other !== obstacle && ray.intersectObject(body).length > 0);
}

/**
 * Keeps the words where their points are, off what `covered()` gives: groups of points. Goals have a ring besides, since
 * they are small and often behind something. Words of what is behind something are faint and get out of the way.
 * @param {Map<object, three.Object3D>} bodies of the obstacles that are hardly seen through
 * @returns {{element: HTMLElement, draw: (camera, width, height) => void}}
 */
export function make_names(names, covered, bodies = new Map()) {
    const words = names.map(({kind, text}) => h("span", {class: `name3d ${kind}`}, text));
    const rings = names.map(({kind}) => (kind === "of-goal" ? h("span", {class: "goal-ring3d"}) : null));
    const element = h("div", {class: "names3d", "aria-hidden": "true"}, rings, words);
    const draw = (camera, width, height) => {
        const placement = new Placement([0, 0, width, height]);
        covered().forEach((points) => placement.reserve(box_around(points, camera, width, height)));
        const behind = names.map((name) => Boolean(name.obstacle) && is_behind(name, bodies, camera));
        const in_turn = names.map((_, i) => i).sort((a, b) => behind[a] - behind[b] || a - b);
        in_turn.forEach((i) => {
            const {kind, text, at} = names[i];
            const seen = at.clone().project(camera);
            const x = (0.5 + seen.x / 2) * width, y = (0.5 - seen.y / 2) * height;
            if (rings[i]) {
                rings[i].style.display = Math.abs(seen.z) < 1 ? "" : "none";
                rings[i].style.transform = `translate(-50%, -50%) translate(${x}px, ${y}px)`;
            }
            words[i].classList.toggle("behind", behind[i]);
            // Obstacles have room within for their names, points have it beside them.
            const off = rings[i] ? 18 : 14;
            const around = [...(kind.startsWith("of-section") ? [[x, y]] : []),
                            [x, y - off], [x, y + off], [x, y - 28], [x, y + 28]];
            const found = Math.abs(seen.z) < 1 ? placement.find(text, around) : null;
            words[i].style.display = found ? "" : "none";
            if (found) {
                words[i].style.transform = `translate(-50%, -50%) translate(${found[0]}px, ${found[1]}px)`;
            }
        });
    };
    return {element, draw};
}
