// The numbers of the moment shown, as tables.

import {h} from "./dom.js";
import {degrees, meters, number, quantity} from "./format.js";

function row_of(name, ...cells) { return h("tr", null, h("th", {scope: "row"}, name), cells); }

export function make_readout(model, clock) {
    const {data, rotor_groups, robot} = model;
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
    const state =
        h("table", {class: "numbers"}, h("caption", null, "State"),
          h("thead", null,
            h("tr", null, h("td"), h("th", {scope: "col"}, "flown"), h("th", {scope: "col"}, "reference"))),
          h("tbody", null, row_of("x", of("x_m", meters), of("ref_x_m", meters)),
            row_of("z", of("z_m", meters), of("ref_z_m", meters)),
            row_of("arm", of("arm_rad", degrees), of("ref_arm_rad", degrees)),
            row_of("pitch", of("pitch_rad", degrees), none()), row_of("end effector x", of("ee_x_m", meters), none()),
            row_of("end effector z", of("ee_z_m", meters), none())));
    const error_at = (row) => Math.hypot(data.x_m[row] - data.ref_x_m[row], data.z_m[row] - data.ref_z_m[row]);
    const flight =
        h("table", {class: "numbers"}, h("caption", null, "Margins, energy"),
          h("tbody", null, row_of("tracking error", cell((row) => meters(error_at(row)))),
            row_of("clearance", of("clearance_m", meters)),
            row_of("speed", cell((row) => quantity(Math.hypot(data.vx_m_s?.[row], data.vz_m_s?.[row]), ".2f", "m/s"))),
            data.power_w ? row_of("power", of("power_w", (v) => quantity(v, ".0f", "W"))) : null,
            row_of("energy so far", of("energy_j", (v) => quantity(v, ",.0f", "J")))));
    const count = robot.rotors.positions_m.length;
    const rotors = model.commands.length === 0 ?
        null :
        h("table", {class: "numbers"}, h("caption", null, "Rotors"),
          h("thead", null,
            h("tr", null, h("th", {scope: "col"}, "no."), h("th", {scope: "col"}, "command"),
              h("th", {scope: "col"}, "K"), h("th", {scope: "col"}, "thrust"))),
          h("tbody", null,
            rotor_groups.flatMap((group) => group.rotors)
                .filter((rotor) => rotor < count)
                .sort((a, b) => a - b)
                .map((rotor) => {
                    const command = data[`rotor_${rotor + 1}_cmd_n`], factor = data[`rotor_${rotor + 1}_aero_factor`];
                    if (!command || !factor) {
                        return null;
                    }
                    return h(
                        "tr", null, h("th", {scope: "row"}, String(rotor + 1)),
                        cell((row) => quantity(command[row], ".2f", "N")), cell((row) => number(factor[row], ".3f")),
                        cell((row) => quantity(command[row] * factor[row], ".2f", "N")));
                })));
    clock.follow((row) => updates.forEach((update) => update(row)));
    return h(
        "div", {class: "readout screen-only", role: "group", "aria-label": "Numbers of the moment shown"}, state,
        flight, rotors);
}
