// The numbers of the moment shown, as tables.

import {h} from "../dom.js";
import {degrees, meters, number, quantity} from "../format.js";

const row_of = (name, ...cells) => h("tr", null, h("th", {scope: "row"}, name), cells);

export function make_readout(model, clock) {
    const {data, robot, joints} = model;
    const updates = [];
    const cell = (text_at) => {
        const element = h("td");
        updates.push((row) => {
            element.textContent = text_at(row);
        });
        return element;
    };
    const of = (column, as) => cell((row) => as (data[column][row]));
    const none = () => h("td", {class: "none"}, "");
    const head = (...names) =>
        h("thead", null, h("tr", null, h("td"), names.map((name) => h("th", {scope: "col"}, name))));
    const table = (caption, ...parts) => h("table", {class: "numbers"}, h("caption", null, caption), parts);
    const arm = Array.from(
        {length: joints},
        (_, i) => row_of(
            joints > 1 ? `joint ${i + 1}` : "joint", of(`joint_${i + 1}_rad`, degrees),
            of(`ref_joint_${i + 1}_rad`, degrees)));
    const state = table(
        "State", head("flown", "reference"),
        h("tbody", null,
          ["x", "y", "z"].map((axis) => row_of(axis, of(`${axis}_m`, meters), of(`ref_${axis}_m`, meters))),
          row_of("yaw", of("yaw_rad", degrees), of("ref_yaw_rad", degrees)),
          row_of("roll", of("roll_rad", degrees), none()), row_of("pitch", of("pitch_rad", degrees), none()), arm));
    const flight = table(
        "Margins, energy",
        h("tbody", null, row_of("position error", of("error_m", meters)), row_of("tilt", of("tilt_rad", degrees)),
          row_of("clearance", of("clearance_m", meters)),
          row_of("speed", of("speed_m_s", (v) => quantity(v, ".2f", "m/s"))),
          data.power_w ? row_of("power", of("power_w", (v) => quantity(v, ".0f", "W"))) : null,
          row_of("energy so far", of("energy_j", (v) => quantity(v, ",.0f", "J"))),
          ["x", "y", "z"].map((axis) => row_of(`end effector ${axis}`, of(`ee_${axis}_m`, meters)))));
    const has_rotors = data.rotor_1_cmd_n && data.rotor_1_aero_factor;
    const rotors = has_rotors ?
        table(
            "Rotors",
            h("thead", null,
              h("tr", null, ["no.", "command", "K", "thrust"].map((name) => h("th", {scope: "col"}, name)))),
            h("tbody", null,
              robot.rotors.map(
                  (_, i) => row_of(
                      String(i + 1), of(`rotor_${i + 1}_cmd_n`, (v) => quantity(v, ".2f", "N")),
                      of(`rotor_${i + 1}_aero_factor`, (v) => number(v, ".3f")),
                      cell((row) => quantity(model.thrusts_at(row)[i], ".2f", "N")))))) :
        null;
    clock.follow((row) => updates.forEach((update) => update(row)));
    return h(
        "div", {class: "readout screen-only", role: "group", "aria-label": "Numbers of the moment shown"}, state,
        flight, rotors);
}
