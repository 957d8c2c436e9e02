// The plane of motion in space: the thrust ratios as in the scene, and a grid whose squares are a length to go by.

import {ticks} from "d3-array";
import * as three from "three";

import {draw_ratios} from "../map_layer.js";

/** The part of the plane between whole lines of a grid that holds the extent, with the lines and their distance. */
export function grid_around({x_m, z_m}) {
    const step = (at) => at[1] - at[0];
    const lines = ticks(0, Math.max(x_m[1] - x_m[0], z_m[1] - z_m[0]), 10);
    const step_m = step(lines);
    const along = ([low, high]) => {
        const first = Math.floor(low / step_m), last = Math.ceil(high / step_m);
        return Array.from({length: last - first + 1}, (_, i) => (first + i) * step_m);
    };
    return {step_m, x_m: along(x_m), z_m: along(z_m)};
}

const ends = (list) => [list[0], list[list.length - 1]];

export function draw_grid(grid, paint) {
    const [left, right] = ends(grid.x_m), [low, high] = ends(grid.z_m);
    const points = [
        ...grid.x_m.flatMap((x) => [x, 0, low, x, 0, high]), ...grid.z_m.flatMap((z) => [left, 0, z, right, 0, z])
    ];
    const geometry = new three.BufferGeometry();
    geometry.setAttribute("position", new three.BufferAttribute(new Float32Array(points), 3));
    const material = new three.LineBasicMaterial({transparent: true, opacity: 0.28, depthWrite: false});
    paint(material, "edge");
    return new three.LineSegments(geometry, material);
}

/** The thrust ratios within the grid; `set_theme` colours them. */
export function draw_sheet(map, grid) {
    const [left, right] = ends(grid.x_m), [low, high] = ends(grid.z_m);
    const x_m = map.x_low_m - map.cell_m / 2, z_m = map.z_low_m - map.cell_m / 2;
    const width_m = map.columns * map.cell_m, height_m = map.rows * map.cell_m;
    const from = [Math.max(left, x_m), Math.max(low, z_m)];
    const to = [Math.min(right, x_m + width_m), Math.min(high, z_m + height_m)];
    const material = new three.MeshBasicMaterial(
        {transparent: true, opacity: 0.75, side: three.DoubleSide, depthWrite: false});
    const sheet = new three.Mesh(new three.PlaneBufferGeometry(to[0] - from[0], to[1] - from[1]), material);
    sheet.rotation.x = Math.PI / 2;
    sheet.position.set((from[0] + to[0]) / 2, 0, (from[1] + to[1]) / 2);
    const set_theme = (theme) => {
        const texture = new three.CanvasTexture(draw_ratios(map, theme, {is_free_air_clear: true}));
        // Between a colour and what is clear, filters would find the black that clear pixels have.
        texture.minFilter = texture.magFilter = three.NearestFilter;
        texture.generateMipmaps = false;
        texture.offset.set((from[0] - x_m) / width_m, (from[1] - z_m) / height_m);
        texture.repeat.set((to[0] - from[0]) / width_m, (to[1] - from[1]) / height_m);
        material.map?.dispose();
        material.map = texture;
        material.needsUpdate = true;
    };
    return {sheet, set_theme};
}
