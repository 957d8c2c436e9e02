// What the page of a validation works on.

import {read_embedded} from "../embedded.js";
import {build_model} from "../model.js";

const schema = "downwash/validation-report/v1";
const needed = ["findings", "plan", "flights", "scene", "robot", "start", "goals"];

export function read_validation(text) { return read_embedded(text, schema, "validation", needed); }

/** The scene as it stands in a world: all obstacles moved [m]. */
function moved_scene(scene, [x_m, z_m]) {
    const move = (rings) => (rings ?? []).map((ring) => ring.map(([x, z]) => [x + x_m, z + z_m]));
    const obstacles = scene.obstacles.map((obstacle) => ({
                                              ...obstacle,
                                              section: move(obstacle.section),
                                              section_lines: move(obstacle.section_lines),
                                              projection: move(obstacle.projection),
                                          }));
    return {...scene, obstacles};
}

/** The flight of a judge in the shape that the player of a run has. */
export function flight_model(report, {outcome, scene_offset_m, flight}) {
    const [x_m, z_m] = scene_offset_m;
    const {map, plan, robot, start, goals, goal_order, limits} = report;
    return build_model({
        solution: {status: "solved", plan, execution: {outcome}},
        scene: moved_scene(report.scene, scene_offset_m),
        map: map ? {...map, x_low_m: map.x_low_m + x_m, z_low_m: map.z_low_m + z_m} : null,
        robot,
        start,
        goals,
        goal_order,
        limits,
        flight,
    });
}

/** Parameters that have a correlation, those that matter most first. */
export function ranked(sensitivity) {
    return sensitivity.filter(({rank_correlation}) => rank_correlation !== null)
        .sort((a, b) => Math.abs(b.rank_correlation) - Math.abs(a.rank_correlation));
}
