// The view in space of a robot, and the sliders of its joints.

import {h} from "../dom.js";
import {degrees} from "../format.js";
import {legend_entry, make_stage} from "../view3d_stage.js";

/** See make_stage(). */
export function make_scene(model, pose, theme) {
    const {robot, joints} = model;
    return make_stage(
        {
            solids: [...robot.bodies, ...robot.links.flatMap(({bodies}) => bodies)],
            layers: [
                ["solids", "Bodies", "section"], ["masses", "Centres of mass", "goal"],
                ["forces", "Thrust axes", "forces"], ["spins", "Spins", "planned"],
                ...(joints > 0 ? [["reach", "Reach", "bounds-key"]] : []), ["names", "Names", "names"]
            ],
            home: ["Fit", "Fit the robot"],
            legend: [
                legend_entry("goal", "centre of mass: of the whole, filled; of multirotor and links, smaller"),
                legend_entry("forces", "thrust in a hover, along its axis"),
                joints > 0 ? legend_entry("bounds-key", "reach of the end effector") : null
            ],
            start: (bundle, stage) => bundle.start(stage, model, pose),
        },
        theme);
}

const radians = (angle_deg) => (angle_deg * Math.PI) / 180;
const whole_degrees = (angle_rad) => (angle_rad * 180) / Math.PI;

/** null for a robot without joints. */
export function make_sliders(model, pose) {
    if (model.joints === 0) {
        return null;
    }
    const rows = model.robot.links.map(({limits_rad}, i) => {
        const [low, high] = limits_rad ?? [-Math.PI, Math.PI];
        const shown = h("output", null);
        const slider = h("input", {
            type: "range",
            min: whole_degrees(low),
            max: whole_degrees(high),
            step: "any",
            "data-joint": i,
            "aria-label": `Angle of joint ${i + 1}`,
            oninput: ({target}) => pose.turn(i, radians(Number(target.value))),
        });
        pose.follow(({joints_rad}) => {
            slider.value = String(whole_degrees(joints_rad[i]));
            shown.textContent = degrees(joints_rad[i]);
        });
        return h("label", {class: "joint-slider"}, h("span", null, `joint ${i + 1}`), slider, shown);
    });
    const back = h(
        "button", {type: "button", class: "small", onclick: () => pose.set(model.report.pose.joints_rad)},
        "Reset");
    return h("div", {class: "joint-sliders screen-only", role: "group", "aria-label": "Joints"}, rows, back);
}
