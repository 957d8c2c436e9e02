// Obstacles, lines and the vehicle as bodies. x right, y away from the viewer, z up, as in the data.

import * as three from "three";

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

/** `paint` remembers what has which colour in which theme. */
function see_through(name, paint, opacity, flatShading = false) {
    const material = new three.MeshLambertMaterial({
        transparent: opacity < 1,
        opacity,
        side: three.DoubleSide,
        depthWrite: opacity === 1,
        polygonOffset: true,
        polygonOffsetFactor: 1,
        polygonOffsetUnits: 1,
        flatShading
    });
    paint(material, name);
    return material;
}

/** A solid with its edges, if they are wanted. */
export function draw_solid(solid, name, paint, opacity, has_edges = true) {
    const geometry = geometry_of(solid);
    const material = see_through(name, paint, opacity, Boolean(solid.mesh));
    const group = new three.Group();
    group.add(new three.Mesh(geometry, material));
    if (has_edges) {
        const edges = new three.LineBasicMaterial({transparent: true, opacity: 0.6});
        paint(edges, name === "body" ? "vehicle" : "edge");
        group.add(new three.LineSegments(new three.EdgesGeometry(geometry, 30), edges));
    }
    return place(group, solid);
}

/** Of size 1 and with few corners, to be drawn many times. */
const coarse = {
    box: new three.BoxBufferGeometry(1, 1, 1),
    cylinder: new three.CylinderBufferGeometry(1, 1, 1, 8),
    sphere: new three.SphereBufferGeometry(1, 8, 6)
};

function coarse_geometry_of(solid) {
    const {box, cylinder, sphere} = solid;
    if (box) {
        return {geometry: coarse.box, scale: box.size_m};
    }
    if (cylinder) {
        return {geometry: coarse.cylinder, scale: [cylinder.radius_m, cylinder.length_m, cylinder.radius_m]};
    }
    if (sphere) {
        return {geometry: coarse.sphere, scale: Array(3).fill(sphere.radius_m)};
    }
    return {geometry: geometry_of(solid), scale: [1, 1, 1]};
}

/** Very many solids as one body without edges: one by one they are more than a browser can turn. */
export function draw_together(solids, name, paint, opacity) {
    const positions = [], indices = [], corner = new three.Vector3();
    for (const solid of solids) {
        const {geometry, scale} = coarse_geometry_of(solid);
        const object = place(new three.Object3D(), solid);
        object.scale.set(...scale);
        object.updateMatrix();
        const {array} = geometry.getAttribute("position"), first = positions.length / 3;
        for (let i = 0; i < array.length; i += 3) {
            corner.fromArray(array, i).applyMatrix4(object.matrix);
            positions.push(corner.x, corner.y, corner.z);
        }
        geometry.index.array.forEach((index) => indices.push(first + index));
    }
    const geometry = new three.BufferGeometry();
    geometry.setAttribute("position", new three.Float32BufferAttribute(positions, 3));
    geometry.setIndex(indices);
    geometry.computeVertexNormals();
    return new three.Mesh(geometry, see_through(name, paint, opacity));
}

/** A line through points of space, one pixel wide. */
export function draw_line(points, name, paint, dashed) {
    const geometry = new three.BufferGeometry();
    geometry.setAttribute(
        "position", new three.BufferAttribute(new Float32Array(points.flat()), 3));
    const material =
        dashed ? new three.LineDashedMaterial({dashSize: 0.15, gapSize: 0.1}) : new three.LineBasicMaterial();
    paint(material, name);
    const line = new three.Line(geometry, material);
    if (dashed) {
        line.computeLineDistances();
    }
    return line;
}

/** A path as a tube of that radius: lines are too thin to be seen from afar. */
export function draw_tube(points, radius, name, paint) {
    const corners = [];
    for (const [x, y, z] of points) {
        const last = corners[corners.length - 1];
        if (!last || Math.hypot(x - last.x, y - last.y, z - last.z) > 2 * radius) {
            corners.push(new three.Vector3(x, y, z));
        }
    }
    const material = new three.MeshBasicMaterial();
    paint(material, name);
    return corners.length < 2 ?
        new three.Group() :
        new three.Mesh(
            new three.TubeBufferGeometry(new three.CatmullRomCurve3(corners, false, "centripetal"), corners.length, radius, 6),
            material);
}

export function draw_vehicle(robot, paint) {
    const {rotors, arm} = robot;
    const body = new three.Group();
    robot.bodies.filter(({solid}) => solid).forEach(({solid}) => body.add(draw_solid(solid, "body", paint, 0.5)));
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
    // Behind what one can see through, too.
    body.traverse((part) => {
        part.renderOrder = 1;
    });
    const half_x = Math.max(...rotors.positions_m.map(([x]) => Math.abs(x))) + rotors.radius_m;
    const half_y = Math.max(...rotors.positions_m.map(([, y]) => Math.abs(y))) + rotors.radius_m;
    const up = Math.max(...rotors.positions_m.map(([, , z]) => z));
    const pieces = 8;
    return {
        body,
        move({x_m, z_m, pitch_rad, arm_rad}) {
            body.position.set(x_m, 0, z_m);
            body.rotation.y = pitch_rad;
            link.rotation.y = arm_rad;
        },
        /** Groups of points: the corners of the rotors' plane, and pieces of the arm. */
        covered() {
            body.updateMatrixWorld(true);
            const corners = [-half_x, half_x].flatMap(
                (x) => [-half_y, half_y].map((y) => body.localToWorld(new three.Vector3(x, y, up))));
            const at = (i) => link.localToWorld(new three.Vector3((i / pieces) * arm.length_m, 0, 0));
            return [corners, ...Array.from({length: pieces}, (_, i) => [at(i), at(i + 1)])];
        },
    };
}

