// A robot in space as bodies: multirotor, rotors, and an arm of any number of joints. x forward, y left, z up.

import * as three from "three";

import {draw_solid} from "./solids.js";

const vector = (list) => new three.Vector3(...list);

/** A cylinder from a to b. */
function draw_rod(a, b, radius_m, material) {
    const way = b.clone().sub(a), length_m = way.length();
    const rod = new three.Mesh(new three.CylinderBufferGeometry(radius_m, radius_m, length_m || 1e-6, 14), material);
    rod.position.copy(a).addScaledVector(way, 0.5);
    rod.quaternion.setFromUnitVectors(
        new three.Vector3(0, 1, 0), length_m > 0 ? way.normalize() : new three.Vector3(0, 1, 0));
    return rod;
}

function draw_capsule({radius_m, from_m, to_m}, material) {
    const ends = [from_m, to_m].map((end) => {
        const ball = new three.Mesh(new three.SphereBufferGeometry(radius_m, 16, 12), material);
        ball.position.copy(vector(end));
        return ball;
    });
    const group = new three.Group();
    group.add(draw_rod(vector(from_m), vector(to_m), radius_m, material), ...ends);
    return group;
}

/**
 * @param {{is_ghost?: boolean}} style a ghost is faint, without edges and arrows
 * @returns `body` to be put into the world; `links`, the frames within it; `solids`; `move(pose)`; `push(thrusts_n)`
 *     sets the arrows at the rotors, as long as `meters_per_n` says; `covered()`: groups of points that names should keep
 *     off; `tip()`: where the end effector is
 */
export function draw_space_robot(robot, paint, {is_ghost = false, meters_per_n = 0} = {}) {
    const {rotors, links, rotor_radius_m} = robot;
    const share = is_ghost ? 0.3 : 1;
    const material = (name, opacity, more = {}) => {
        const made =
            new three.MeshLambertMaterial({transparent: opacity < 1, opacity, depthWrite: opacity === 1, ...more});
        paint(made, name);
        return made;
    };
    const frame = material("vehicle", share), arm = material("flown", share);
    const disc = material("flown", 0.5 * share, {side: three.DoubleSide}),
          shell = material("body", 0.5 * share, {side: three.DoubleSide});
    const size_m = Math.max(rotor_radius_m, ...rotors.map(({position_m}) => Math.hypot(...position_m)));
    const thin_m = Math.min(Math.max(0.006, 0.03 * size_m), 0.06 * size_m);

    const drawn = [];
    const draw_bodies = (bodies, name, into) => {
        for (const solid of bodies.filter((each) => each)) {
            const part = solid.capsule ?
                draw_capsule(solid.capsule, name === "body" ? shell : arm) :
                draw_solid(solid, name, paint, (name === "body" ? 0.45 : 0.9) * share, !is_ghost);
            drawn.push(part);
            into.add(part);
        }
    };
    const body = new three.Group();
    draw_bodies(robot.bodies, "body", body);
    const arrows = rotors
                       .map(({position_m, axis}) => {
                           const hub = vector(position_m), up = vector(axis).normalize();
                           const circle = new three.Mesh(new three.CircleBufferGeometry(rotor_radius_m, 36), disc);
                           circle.position.copy(hub);
                           circle.quaternion.setFromUnitVectors(new three.Vector3(0, 0, 1), up);
                           body.add(circle, draw_rod(new three.Vector3(), hub, thin_m / 2, frame));
                           if (is_ghost) {
                               return null;
                           }
                           const arrow = new three.ArrowHelper(up, hub, 1, 0.1, 0.1);
                           [arrow.line, arrow.cone].forEach((part) => paint(part.material, "force"));
                           body.add(arrow);
                           return arrow;
                       })
                       .filter((arrow) => arrow);
    // Which way is forward.
    const nose = new three.Mesh(new three.ConeBufferGeometry(2.2 * thin_m, 7 * thin_m, 14), frame);
    nose.rotation.z = -Math.PI / 2;
    nose.position.x = 0.62 * size_m;
    body.add(nose, draw_rod(new three.Vector3(), nose.position, thin_m / 2, frame));

    let mounted_on = body;
    const frames = links.map(({joint_m, axis, bodies}, i) => {
        const link = new three.Group();
        link.position.copy(vector(joint_m));
        const end = vector(i + 1 < links.length ? links[i + 1].joint_m : robot.end_effector_m);
        if (bodies.length > 0) {
            draw_bodies(bodies, "flown", link);
        } else {
            link.add(draw_rod(new three.Vector3(), end, thin_m, arm));
        }
        const hinge = new three.Mesh(new three.SphereBufferGeometry(1.5 * thin_m, 14, 10), frame);
        link.add(hinge);
        mounted_on.add(link);
        mounted_on = link;
        return {link, axis: vector(axis).normalize(), end};
    });
    const last = mounted_on;
    const tip = new three.Group();
    tip.position.copy(vector(robot.end_effector_m));
    const ball = new three.Mesh(new three.SphereBufferGeometry(1.4 * thin_m, 16, 12), material("tip", share));
    tip.add(ball);
    if (!is_ghost) {
        const pointer = new three.ArrowHelper(
            vector(robot.tool_direction).normalize(), new three.Vector3(), 0.6 * size_m, 0.16 * size_m, 0.09 * size_m);
        [pointer.line, pointer.cone].forEach((part) => paint(part.material, "tip"));
        tip.add(pointer);
    }
    last.add(tip);
    // Behind what one can see through, too.
    body.traverse((part) => {
        part.renderOrder = 1;
    });
    const half_m = size_m + rotor_radius_m;
    const up_m = Math.max(0, ...rotors.map(({position_m}) => position_m[2]));
    return {
        body,
        links: frames.map(({link}) => link),
        solids: drawn,
        arrows,
        move({position_m, attitude: [w, x, y, z], joints_rad}) {
            body.position.copy(vector(position_m));
            body.quaternion.set(x, y, z, w).normalize();
            frames.forEach(({link, axis}, i) => link.quaternion.setFromAxisAngle(axis, joints_rad[i]));
        },
        push(thrusts_n) {
            arrows.forEach((arrow, i) => {
                const length_m = Math.max(1e-3, meters_per_n * thrusts_n[i]);
                arrow.setLength(
                    length_m, Math.min(0.3 * length_m, 0.2 * size_m), Math.min(0.2 * length_m, 0.12 * size_m));
            });
        },
        covered() {
            body.updateMatrixWorld(true);
            const corners = [-half_m, half_m].flatMap(
                (x) => [-half_m, half_m].map((y) => body.localToWorld(new three.Vector3(x, y, up_m))));
            const segments =
                frames.map(({link, end}) => [link.localToWorld(new three.Vector3()), link.localToWorld(end.clone())]);
            return [corners, ...segments];
        },
        tip() {
            body.updateMatrixWorld(true);
            return tip.localToWorld(new three.Vector3()).toArray();
        },
    };
}
