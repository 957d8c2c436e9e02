// The 3-D view: a bundle of its own with three.js. x right, y away from the viewer, z up, as in the data.

import {OrbitControls} from "orbit-controls";
import * as three from "three";

import {pose_at} from "./model.js";
import {range_of} from "./numbers.js";

const palettes = {
    light: {
        paper: "#f7f8f9",
        obstacle: "#a9b0b8",
        edge: "#5d6770",
        vehicle: "#30363d",
        flown: "#c2510a",
        planned: "#30363d",
        tip: "#00805e",
        goal: "#a3397a"
    },
    dark: {
        paper: "#13171c",
        obstacle: "#5c6670",
        edge: "#98a4ae",
        vehicle: "#dfe5ea",
        flown: "#ff9b57",
        planned: "#dfe5ea",
        tip: "#3fd0a4",
        goal: "#f08cc8"
    },
};

function geometry_of(solid) {
    if (solid.box) {
        return new three.BoxBufferGeometry(...solid.box.size_m);
    }
    if (solid.cylinder) {
        return new three.CylinderBufferGeometry(
            solid.cylinder.radius_m, solid.cylinder.radius_m, solid.cylinder.length_m, 40);
    }
    if (solid.sphere) {
        return new three.SphereBufferGeometry(solid.sphere.radius_m, 32, 20);
    }
    const geometry = new three.BufferGeometry();
    geometry.setAttribute("position", new three.BufferAttribute(solid.mesh.vertices, 3));
    geometry.setIndex(new three.BufferAttribute(solid.mesh.indices, 1));
    geometry.computeVertexNormals();
    return geometry;
}

function place(object, solid) {
    const {box, cylinder, sphere} = solid;
    if (box) {
        const [a, b, c] = box.axes.map((axis) => new three.Vector3(...axis));
        object.quaternion.setFromRotationMatrix(new three.Matrix4().makeBasis(a, b, c));
    } else if (cylinder) {
        object.quaternion.setFromUnitVectors(
            new three.Vector3(0, 1, 0), new three.Vector3(...cylinder.axis).normalize());
    }
    const center = (box ?? cylinder ?? sphere)?.center_m;
    if (center) {
        object.position.set(...center);
    }
    return object;
}

/** A solid with its edges; `paint` remembers what has which colour in which theme. */
function draw_solid(solid, name, paint, opacity) {
    const geometry = geometry_of(solid);
    const material = new three.MeshLambertMaterial({
        transparent: opacity < 1,
        opacity,
        side: three.DoubleSide,
        depthWrite: opacity === 1,
        polygonOffset: true,
        polygonOffsetFactor: 1,
        polygonOffsetUnits: 1,
        flatShading: Boolean(solid.mesh)
    });
    const edges = new three.LineBasicMaterial({transparent: true, opacity: 0.6});
    paint(material, name);
    paint(edges, "edge");
    const group = new three.Group();
    group.add(new three.Mesh(geometry, material), new three.LineSegments(new three.EdgesGeometry(geometry, 30), edges));
    return place(group, solid);
}

function draw_line(xs, zs, name, paint, dashed) {
    const positions = new Float32Array(3 * xs.length);
    for (let i = 0; i < xs.length; ++i) {
        positions[3 * i] = xs[i];
        positions[3 * i + 2] = zs[i];
    }
    const geometry = new three.BufferGeometry();
    geometry.setAttribute("position", new three.BufferAttribute(positions, 3));
    const material =
        dashed ? new three.LineDashedMaterial({dashSize: 0.15, gapSize: 0.1}) : new three.LineBasicMaterial();
    paint(material, name);
    const line = new three.Line(geometry, material);
    if (dashed) {
        line.computeLineDistances();
    }
    return line;
}

function draw_vehicle(robot, paint) {
    const {rotors, arm} = robot;
    const body = new three.Group();
    robot.bodies.filter(({solid}) => solid).forEach(({solid}) => body.add(draw_solid(solid, "vehicle", paint, 0.25)));
    const metal = new three.MeshLambertMaterial(),
          disc = new three.MeshBasicMaterial({transparent: true, opacity: 0.55, side: three.DoubleSide});
    paint(metal, "vehicle");
    paint(disc, "flown");
    for (const [x, y, z] of rotors.positions_m) {
        const circle = new three.Mesh(new three.CircleBufferGeometry(rotors.radius_m, 36), disc);
        circle.position.set(x, y, z);
        const strut =
            new three.Mesh(new three.CylinderBufferGeometry(0.015, 0.015, Math.hypot(x, y) || 0.01, 8), metal);
        strut.quaternion.setFromUnitVectors(new three.Vector3(0, 1, 0), new three.Vector3(x, y, 0).normalize());
        strut.position.set(x / 2, y / 2, z * 0.6);
        body.add(circle, strut);
    }
    const arm_material = new three.MeshLambertMaterial();
    paint(arm_material, "flown");
    const link = new three.Group();
    const rod =
        new three.Mesh(new three.CylinderBufferGeometry(arm.radius_m, arm.radius_m, arm.length_m, 16), arm_material);
    rod.rotation.z = -Math.PI / 2;
    rod.position.x = arm.length_m / 2;
    const tip = new three.Mesh(new three.SphereBufferGeometry(1.8 * arm.radius_m, 16, 12), arm_material);
    tip.position.x = arm.length_m;
    link.add(rod, tip);
    link.position.set(arm.joint_m[0], 0, arm.joint_m[1]);
    body.add(link);
    return {
        body,
        move({x_m, z_m, pitch_rad, arm_rad}) {
            body.position.set(x_m, 0, z_m);
            body.rotation.y = pitch_rad;
            link.rotation.y = arm_rad;
        },
    };
}

/** @param {HTMLElement} stage */
export function start(stage, model, clock) {
    const {data, scene, robot, goals} = model;
    const painted = [];
    const paint = (material, name) => painted.push([material, name]);
    const renderer = new three.WebGLRenderer({antialias: true});
    renderer.setPixelRatio(Math.min(2, window.devicePixelRatio || 1));
    const canvas = renderer.domElement;
    canvas.tabIndex = 0;
    canvas.setAttribute("role", "img");
    canvas.setAttribute(
        "aria-label", "The scene and the flight in three dimensions; the numbers stand in the tables of this page.");
    stage.replaceChildren(canvas);

    const world = new three.Scene();
    world.add(new three.HemisphereLight(0xffffff, 0x8a9099, 0.85));
    const sun = new three.DirectionalLight(0xffffff, 0.45);
    sun.position.set(-6, -14, 18);
    world.add(sun);
    for (const {solid, section, projection} of scene.obstacles) {
        if (solid) {
            world.add(draw_solid(solid, "obstacle", paint, 0.42));
        } else {
            // Too large a mesh for a page: its outline in the plane of motion stands for it.
            for (const ring of section.length > 0 ? section : projection) {
                const closed = [...ring, ring[0]];
                world.add(draw_line(closed.map(([x]) => x), closed.map(([, z]) => z), "edge", paint, false));
            }
        }
    }
    for (const goal of goals) {
        const radius = Math.max(0.06, goal.tolerance_x_m ?? 0.1);
        const material = new three.MeshBasicMaterial({transparent: true, opacity: 0.6});
        paint(material, "goal");
        const ball = new three.Mesh(new three.SphereBufferGeometry(radius, 24, 16), material);
        ball.position.set(goal.x_m ?? 0, 0, goal.z_m ?? 0);
        world.add(ball);
    }
    const vehicle = draw_vehicle(robot, paint);
    vehicle.move({pitch_rad: 0, ...(model.solution.planning?.obstruction ?? model.start)});
    world.add(vehicle.body);
    if (data) {
        world.add(
            draw_line(data.x_m, data.z_m, "flown", paint, false),
            draw_line(data.ref_x_m, data.ref_z_m, "planned", paint, true),
            draw_line(data.ee_x_m, data.ee_z_m, "tip", paint, false));
    }

    const extent = (values) => [range_of(values).low, range_of(values).high];
    const xs = data ? extent(data.x_m) : scene.bounds.x_m, zs = data ? extent(data.z_m) : scene.bounds.z_m;
    const target = new three.Vector3((xs[0] + xs[1]) / 2, 0, (zs[0] + zs[1]) / 2);
    const far = 0.75 * Math.max(6, xs[1] - xs[0], zs[1] - zs[0]);
    const camera = new three.PerspectiveCamera(45, 2, 0.05, 40 * far);
    camera.up.set(0, 0, 1);
    const controls = new OrbitControls(camera, canvas);
    controls.enableKeys = false;
    controls.minDistance = 0.5;
    controls.maxDistance = 20 * far;
    const home = () => {
        camera.position.copy(target).add(new three.Vector3(-0.45, -1.15, -0.3).multiplyScalar(far));
        controls.target.copy(target);
        controls.update();
    };

    let is_waiting = false;
    const render = () => {
        if (!is_waiting) {
            is_waiting = true;
            requestAnimationFrame(() => {
                is_waiting = false;
                renderer.render(world, camera);
            });
        }
    };
    controls.addEventListener("change", render);
    // The controls know keys for moving only; turning by key goes round the target in steps.
    canvas.addEventListener("keydown", (pressed) => {
        const turns = {a: [-0.12, 0], d: [0.12, 0], w: [0, -0.1], s: [0, 0.1]};
        const key = pressed.key.toLowerCase();
        const offset = camera.position.clone().sub(controls.target);
        if (pressed.ctrlKey || pressed.metaKey || pressed.altKey) {
            return;
        }
        if (turns[key]) {
            const [around, down] = turns[key];
            offset.applyAxisAngle(camera.up, around);
            const side = new three.Vector3().crossVectors(camera.up, offset).normalize();
            const polar = offset.angleTo(camera.up) + down;
            if (polar > 0.05 && polar < Math.PI - 0.05) {
                offset.applyAxisAngle(side, down);
            }
        } else if (key === "+" || key === "=" || key === "-") {
            offset.multiplyScalar(key === "-" ? 1.15 : 1 / 1.15);
        } else if (key === "0") {
            home();
            return;
        } else {
            return;
        }
        pressed.preventDefault();
        camera.position.copy(controls.target).add(offset);
        controls.update();
        render();
    });
    new ResizeObserver(() => {
        const width = stage.clientWidth, height = stage.clientHeight;
        if (width > 0 && height > 0) {
            renderer.setSize(width, height, false);
            camera.aspect = width / height;
            camera.updateProjectionMatrix();
            render();
        }
    }).observe(stage);
    home();
    clock?.follow((row) => {
        vehicle.move(pose_at(data, row));
        render();
    });
    return {
        set_theme(theme) {
            world.background = new three.Color(palettes[theme].paper);
            painted.forEach(([material, name]) => material.color.set(palettes[theme][name]));
            render();
        },
        /** Where the end effector is drawn, for tests. */
        tip() {
            const point = new three.Vector3(robot.arm.length_m, 0, 0);
            vehicle.body.updateMatrixWorld(true);
            const link = vehicle.body.children[vehicle.body.children.length - 1];
            return link.localToWorld(point).toArray();
        },
    };
}
