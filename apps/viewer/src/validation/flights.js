// The player: the judge's flight, and the worst ones of the worlds.

import {make_clock} from "../clock.js";
import {h} from "../dom.js";
import {place} from "../format.js";
import {make_playback} from "../playback.js";
import {make_plots} from "../plots.js";
import {make_readout} from "../readout.js";
import {make_obstacle_table} from "../repeat.js";
import {make_scene} from "../scene.js";
import {plots_of} from "../series.js";
import {outcome_name} from "../words.js";
import {flight_model} from "./model.js";

const name_of = ({world, outcome}) => `${world === null ? "undisturbed" : `world ${world}`}: ${outcome_name(outcome)}`;

/** Where the obstacles of a world are, and how far the vehicle is beside its plane among them. */
function offset_text({world, scene_offset_m: [x_m, z_m], lateral_m}) {
    if (world === null) {
        return "Everything is as the problem says.";
    }
    const aside = `${place(Math.abs(x_m))} ${x_m < 0 ? "left" : "right"}`;
    const up = `${place(Math.abs(z_m))} ${z_m < 0 ? "below" : "above"}`;
    const beside = `${place(Math.abs(lateral_m))} to the ${lateral_m < 0 ? "right" : "left"} of its plane`;
    return `The obstacles are drawn where they are in this world: ${aside} of and ${up} where the problem has them. ` +
        `The vehicle flies ${beside} among them, which the drawing does not show.`;
}

/** @param {AbortSignal} signal ends the player */
function make_player(model, note, signal) {
    const clock = model.data ? make_clock(model.data.t_s) : null;
    const playback = clock ? make_playback(model, clock, signal) : null;
    const scene = make_scene(model, clock, playback);
    const plots = clock ? make_plots(plots_of(model), model, clock, playback) : null;
    if (clock && model.is_cut_short) {
        clock.set(clock.rows - 1);
    }
    const element =
        h("div", {class: `explore${clock ? "" : " alone"}`},
          h("div", {class: "scene-side"},
            h("div", {class: "scene-bar"}, h("h3", null, "Scene"), scene.tools), scene.element, clock ? make_readout(model, clock) : null,
            h("p", {class: "hint muted"}, note), make_obstacle_table(model)),
          plots ? h("div", {class: "plot-side"}, h("h3", null, "Over time", plots.moment), plots.element) : null);
    return {element, clock};
}

/** `show(index)` resolves when that flight is on the page; `clock` is that of the flight shown. */
export function make_flights(report) {
    const stage = h("div", {class: "flight-stage"});
    let clock = null, shown = null, leaving = new AbortController();
    const inputs = report.flights.map(
        (_, index) => h("input", {type: "radio", name: "flight", value: index, onchange: () => show(index)}));
    const show = async (index) => {
        shown = index;
        inputs[index].checked = true;
        const flight = report.flights[index];
        const model = await flight_model(report, flight);
        if (shown !== index) {
            return;
        }
        leaving.abort();
        leaving = new AbortController();
        const player = make_player(model, offset_text(flight), leaving.signal);
        clock = player.clock;
        stage.replaceChildren(player.element);
    };
    const choices = report.flights.map(
        (flight, index) =>
            h("label", {class: "choice"}, inputs[index], h("span", null, name_of(flight))));
    const element = h(
        "section", {class: "flights", id: "flights", "aria-labelledby": "flights-title"},
        h("h2", {id: "flights-title"}, report.flights.length > 1 ? "Flights" : "Flight"),
        report.flights.length > 1 ?
            h("fieldset", {class: "choices screen-only"}, h("legend", {class: "visually-hidden"}, "Flight shown"), choices) :
            null,
        stage);
    return {element, show, get clock() { return clock; }, get shown() { return shown; }};
}
