// What is needed to get the same run again, and the obstacles as a table.

import {make_command} from "./command.js";
import {foreign, h} from "./dom.js";
import {number, place} from "./format.js";
import {extent_of} from "./numbers.js";
import {is_cut} from "./surroundings.js";
import {variants} from "./words.js";

function range_text([low, high]) { return `${place(low)} to ${place(high)}`; }

function table_of(obstacles) {
    const most = 1000, left_out = obstacles.length - most;
    return h(
        "div", {class: "scroll", tabindex: "0", role: "region", "aria-label": "Obstacles"},
        h("table", {class: "numbers obstacle-table"},
          h("thead", null,
            h("tr", null,
              ["name", "kind", "plane of motion", "x, whole", "z, whole"].map(
                  (name) => h("th", {scope: "col"}, name)))),
          h("tbody", null, obstacles.slice(0, most).map((obstacle) => {
              const {x_m, z_m} = extent_of(obstacle.projection);
              return h(
                  "tr", null, h("th", {scope: "row", class: "foreign-name"}, foreign(obstacle.name)),
                  h("td", null, obstacle.kind), h("td", null, is_cut(obstacle) ? "cuts it" : "beside it"),
                  h("td", null, range_text(x_m)), h("td", null, range_text(z_m)));
          }))),
        left_out > 0 ? h("p", {class: "muted"}, `and ${number(left_out, ",d")} more`) : null);
}

/** The table is made when it is opened. */
export function make_obstacle_table({scene: {obstacles}}) {
    if (obstacles.length === 0) {
        return h("p", {class: "muted"}, "There are no obstacles.");
    }
    const details = h("details", null, h("summary", null, `The ${obstacles.length} obstacles as a table`));
    details.addEventListener("toggle", () => details.append(table_of(obstacles)), {once: true});
    return details;
}

/** From what plan a run took over. */
function takeover_text({plan, t_s, rest}) {
    return [`at ${number(t_s, ".2f")} s of `, foreign(plan), `, whose rest ends ${rest.outcome} here, cost ${number(rest.cost, ".6g")}`];
}

export function make_repeat(model) {
    const {report, solution} = model;
    const row = (name, value) => h("div", null, h("dt", null, name), h("dd", null, value));
    const title = solution.status === "unplanned" ? "Problem and settings" : "To repeat";
    return h(
        "section", {class: "repeat", "aria-labelledby": "repeat-title"}, h("h2", {id: "repeat-title"}, title),
        report.command ? make_command(report.command) : null,
        report.command_note ? h("p", {class: "muted"}, foreign(report.command_note)) : null,
        h("dl", {class: "pairs"}, row("version", `downwash ${report.version ?? solution.version}`),
          solution.replanned ? row("starts", takeover_text(solution.replanned)) : null,
          row("seed", String(solution.seed)),
          row("variant", `${solution.variant}${variants[solution.variant] ? `: ${variants[solution.variant]}` : ""}`),
          row("algorithm", solution.algorithm), row("objective", model.objective),
          row("problem", foreign(solution.problem?.file ?? solution.problem?.name ?? "–")),
          row("SHA-256 of the problem", h("code", {class: "hash"}, solution.problem?.sha256 ?? "–"))),
        report.effective_yaml ?
            h("details", {class: "yaml"}, h("summary", null, "Effective parameters, every default filled in"),
              h("pre", {tabindex: "0", role: "region", "aria-label": "Effective parameters"},
                h("code", null, foreign(report.effective_yaml)))) :
            null);
}
