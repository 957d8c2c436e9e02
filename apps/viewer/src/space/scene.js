// The view in space of a flight.

import {legend_entry, make_stage} from "../view3d_stage.js";

function solids_of({scene, robot}) {
    return [...scene.obstacles.map(({solid}) => solid), ...robot.bodies, ...robot.links.flatMap(({bodies}) => bodies)];
}

function layers_of({data, scene}) {
    const of_flight = data ?
        [
            ["planned", "Planned", "planned"], ["flown", "Flown", "flown"], ["tip", "End effector", "tip"],
            ["snapshots", "Snapshots", "snapshots"], ["forces", "Thrust", "forces"]
        ] :
        [];
    return [
        ...of_flight, ...(scene.obstacles.length > 0 ? [["obstacles", "Obstacles", "section"]] : []),
        ["bounds", "Bounds", "bounds-key"], ["names", "Names", "names"]
    ];
}

function legend_of(model) {
    return [
        model.data ?
            [
                legend_entry("flown", "flown path"), legend_entry("planned", "planned path"),
                legend_entry("tip", "end-effector path")
            ] :
            null,
        legend_entry("goal", "goal, as large as its tolerance"),
        model.is_cut_short ? legend_entry("trouble", "where the flight breaks off") : null,
        model.hovers.some(({goal}) => goal !== null) ? legend_entry("hover", "hover at a goal, by its number") : null
    ].flat();
}

/** See make_stage(). */
export function make_scene(model, clock, playback, theme) {
    return make_stage(
        {
            solids: solids_of(model),
            layers: layers_of(model),
            home: model.data ? ["Flight", "Fit the flight"] : ["Fit", "Fit the bounds"],
            legend: legend_of(model),
            playback,
            can_follow: Boolean(model.data),
            start: (bundle, stage) => bundle.start(stage, model, clock),
        },
        theme);
}
