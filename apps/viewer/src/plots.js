// Time plots one below the other, with one cursor.

import {scaleLinear} from "d3-scale";

import {h, once_a_frame, s, set_attributes} from "./dom.js";
import {number, seconds} from "./format.js";
import {range_of} from "./numbers.js";
import {keep_sized} from "./sizing.js";

const margin = {
    left: 46,
    right: 10,
    top: 6,
    bottom: 18
};
const height = 92;

/** Of the rows in a column of pixels only first, least, greatest and last can be seen. */
function line(values, x_of, y_of) {
    let d = "", pen_is_down = false;
    const put = (i) => {
        d += `${pen_is_down ? "L" : "M"}${x_of(i).toFixed(1)} ${y_of(values[i]).toFixed(1)}`;
        pen_is_down = true;
    };
    for (let i = 0; i < values.length;) {
        if (!Number.isFinite(values[i])) {
            pen_is_down = false;
            ++i;
            continue;
        }
        const column = Math.floor(x_of(i));
        let end = i, least = i, greatest = i;
        while (end + 1 < values.length && Math.floor(x_of(end + 1)) === column && Number.isFinite(values[end + 1])) {
            ++end;
            least = values[end] < values[least] ? end : least;
            greatest = values[end] > values[greatest] ? end : greatest;
        }
        [...new Set([i, Math.min(least, greatest), Math.max(least, greatest), end])].forEach(put);
        i = end + 1;
    }
    return d;
}

function describe(plot, model) {
    const ranges = plot.lines.map((each) => {
        const {low, high, low_row, high_row} = range_of(each.values);
        return `${each.name ? `${each.name}: ` : ""}from ${plot.text(low)} at ${seconds(model.data.t_s[low_row])} ` +
            `to ${plot.text(high)} at ${seconds(model.data.t_s[high_row])}`;
    });
    const limits =
        (plot.limits ?? []).filter((limit) => limit.name).map((limit) => `${limit.name} ${plot.text(limit.value)}`);
    return `${plot.title} over time. ${[...ranges, ...limits].join("; ")}.`;
}

class TimePlot {
    constructor(plot, model) {
        this.plot = plot;
        this.model = model;
        const ranges = plot.lines.map((each) => range_of(each.values));
        const greatest = Math.max(...ranges.flatMap(({low, high}) => [Math.abs(low), Math.abs(high)]));
        this.limits = (plot.limits ?? []).filter(({value, if_near}) => !if_near || Math.abs(value) < 2 * greatest);
        const all = [
            ...ranges.flatMap(({low, high}) => [low, high]), ...this.limits.map((limit) => limit.value),
            ...(plot.from_zero ? [0] : [])
        ].filter(Number.isFinite);
        const far = (plot.limits ?? []).filter((limit) => !this.limits.includes(limit)).map((limit) => limit.value);
        this.values = plot.lines.map(() => h("span", {class: "value"}));
        this.crossed = h("span", {class: "entry muted"});
        this.cursor = s("path", {class: "cursor"});
        this.dots = plot.lines.map((each) => s("circle", {class: `dot ${each.style}`, r: 3}));
        this.still = s("g");
        this.svg =
            s("svg", {class: "plot-svg", role: "img", "aria-label": describe(plot, model)}, this.still, this.cursor,
              this.dots);
        this.element = h(
            "figure", {class: "plot", "data-plot": plot.id},
            h("figcaption", null,
              h("span", {class: "plot-title"}, plot.title,
                h("span", {class: "unit"}, plot.unit === "1" ? "" : ` [${plot.unit}]`)),
              far.length > 0 ?
                  h("span", {class: "muted"}, `limit ±${number(Math.abs(far[0]), "~r")}${plot.unit}, beyond the plot`) :
                  null,
              this.crossed,
              plot.lines.map(
                  (each, index) =>
                      h("span", {class: "entry"},
                        plot.lines.length > 1 ? h("span", {class: `key ${each.style}`, "aria-hidden": "true"}) : null,
                        each.name ? h("span", {class: "name"}, each.name) : null, this.values[index]))),
            this.svg);
        const low = Math.min(...all), high = Math.max(...all);
        const span = high - low, is_noise = span < (plot.least_span ?? 0);
        const pad = is_noise ? (plot.least_span - span) / 2 : span > 0 ? 0.05 * span : Math.max(0.05 * Math.abs(high), 0.5);
        this.domain = [plot.from_zero && low === 0 ? 0 : low - pad, high + pad];
    }

    resize(width) {
        const {model, plot} = this;
        const bottom = height - margin.bottom;
        this.x = scaleLinear().domain([0, model.end_s || 1]).range([margin.left, width - margin.right]);
        this.y = scaleLinear().domain(this.domain).range([bottom, margin.top]);
        const {x, y} = this;
        const t_s = model.data.t_s;
        const ticks_x = x.ticks(Math.max(3, Math.round(width / 90))), ticks_y = y.ticks(3);
        const text_y = (v) => y.tickFormat(3)(v).replace("-", "−").replace(/,/g, "\u202f");
        const parts = [], names = [];
        parts.push(...model.hovers.map(
            ({from_s, to_s}) => s("rect", {
                class: "hover-band",
                x: x(from_s),
                y: margin.top,
                width: x(to_s) - x(from_s),
                height: bottom - margin.top
            })));
        parts.push(s("path", {
            class: "grid-lines",
            d: [
                ...ticks_x.map((t) => `M${x(t)} ${margin.top}V${bottom}`),
                ...ticks_y.map((v) => `M${margin.left} ${y(v)}H${width - margin.right}`)
            ].join("")
        }));
        parts.push(...ticks_x.map((t, i) => {
            const is_last = i === ticks_x.length - 1, is_at_edge = is_last && width - x(t) < 20;
            const anchor = i === 0 ? "start" : is_at_edge ? "end" : "middle";
            return s(
                "text", {class: "tick", x: is_at_edge ? width : x(t), y: bottom + 13, "text-anchor": anchor},
                is_last ? `${t} s` : String(t));
        }));
        parts.push(...ticks_y.map(
            (v) => s(
                "text", {class: "tick", x: margin.left - 6, y: y(v), dy: "0.32em", "text-anchor": "end"}, text_y(v))));
        this.crossed.replaceChildren();
        for (const limit of this.limits) {
            parts.push(s("path", {class: "limit", d: `M${margin.left} ${y(limit.value)}H${width - margin.right}`}));
            if (limit.name) {
                const is_high = y(limit.value) < margin.top + 14, base = y(limit.value) + (is_high ? 11 : -4);
                const text =
                    `${limit.name} ${number(limit.value, "~r")}${plot.unit === "°" ? "" : "\u00a0"}${plot.unit}`;
                const left = this.#clear_place(base, 6.2 * text.length, width);
                if (left === null) {
                    this.crossed.append(h("span", {class: "key of-limit", "aria-hidden": "true"}), text);
                } else {
                    names.push(s("text", {class: "limit-name", x: left, y: base}, text));
                }
            }
        }
        plot.lines.forEach(
            (each) => parts.push(s("path", {class: `line ${each.style}`, d: line(each.values, (i) => x(t_s[i]), y)})));
        if (model.is_cut_short) {
            parts.push(s("path", {class: "failure-line", d: `M${x(model.end_s)} ${margin.top}V${bottom}`}));
        }
        this.svg.setAttribute("viewBox", `0 0 ${width} ${height}`);
        this.still.replaceChildren(...parts, ...names);
    }

    /** Where words of that length on that base line are farthest from the lines; null where they would be crossed. */
    #clear_place(base, length, width) {
        const t_s = this.model.data.t_s, letters = {top: base - 9, bottom: base + 2};
        let best = null, farthest = 0;
        for (let step = 0; step <= 8; ++step) {
            const left = margin.left + 5 + (step / 8) * (width - margin.right - margin.left - 9 - length);
            let least = Infinity;
            for (let i = 0; i < t_s.length; i += 5) {
                const at = this.x(t_s[i]);
                if (at >= left - 4 && at <= left + length + 4) {
                    this.plot.lines.filter(({values}) => Number.isFinite(values[i])).forEach(({values}) => {
                        const y = this.y(values[i]);
                        least = Math.min(least, Math.max(letters.top - y, y - letters.bottom));
                    });
                }
            }
            if (least > 1.02 * farthest) {
                farthest = least;
                best = left;
            }
        }
        return best;
    }

    show(row) {
        const {plot, model} = this;
        plot.lines.forEach((each, index) => {
            this.values[index].textContent = plot.text(each.values[row]);
        });
        if (!this.x) {
            return;
        }
        const at = this.x(model.data.t_s[row]);
        this.cursor.setAttribute("d", `M${at} ${margin.top}V${height - margin.bottom}`);
        plot.lines.forEach((each, index) => {
            const is_there = Number.isFinite(each.values[row]);
            set_attributes(
                this.dots[index],
                {cx: at, cy: is_there ? this.y(each.values[row]) : 0, visibility: is_there ? "visible" : "hidden"});
        });
    }

    /** Seconds under a pointer. */
    time_at(happened) {
        const box = this.svg.getBoundingClientRect();
        const scale = this.svg.viewBox.baseVal.width / box.width;
        return this.x.invert((happened.clientX - box.left) * scale);
    }
}

/** Twenty-one rows of the flight for those who read tables. */
function make_table(plots, model, clock) {
    const rows = Array.from({length: 21}, (_, i) => clock.row_at((i / 20) * model.end_s));
    const columns = plots.flatMap(({plot}) => plot.lines.map((each) => ({plot, each})));
    return h(
        "details", {class: "table-of-plots"}, h("summary", null, "The plots as a table"),
        h("div", {class: "scroll", tabindex: "0", role: "region", "aria-label": "The plots as a table"},
          h("table", {class: "numbers"},
            h("thead", null,
              h("tr", null, h("th", {scope: "col"}, "time"),
                columns.map(
                    ({plot, each}) =>
                        h("th", {scope: "col"}, `${plot.title.split(",")[0]}${each.name ? `, ${each.name}` : ""}`)))),
            h("tbody", null,
              [...new Set(rows)].map(
                  (row) =>
                      h("tr", null, h("th", {scope: "row"}, seconds(model.data.t_s[row])),
                        columns.map(({plot, each}) => h("td", null, plot.text(each.values[row])))))))));
}

/** @param {import("./series.js").Plot[]} shown */
export function make_plots(shown, model, clock, playback) {
    const plots = shown.map((plot) => new TimePlot(plot, model));
    const spoken = h("p", {class: "visually-hidden", role: "status"});
    const stack =
        h("div", {
            class: "plot-stack",
            tabindex: "0",
            role: "group",
            "aria-label":
                "Time plots. Arrow keys move the cursor by a tick, with shift by a second; Home and End go to the ends."
        },
          plots.map((plot) => plot.element));
    const element = h("div", {class: "plots"}, stack, spoken, make_table(plots, model, clock));
    let dragged = null;
    for (const plot of plots) {
        const go = (happened) => {
            playback.pause();
            clock.set(clock.row_at(plot.time_at(happened)));
        };
        plot.svg.addEventListener("pointerdown", (happened) => {
            if (happened.button === 0) {
                dragged = plot;
                plot.svg.setPointerCapture(happened.pointerId);
                go(happened);
            }
        });
        plot.svg.addEventListener("pointermove", (happened) => dragged === plot && go(happened));
        plot.svg.addEventListener("pointerup", () => {
            dragged = null;
        });
        plot.svg.addEventListener("pointercancel", () => {
            dragged = null;
        });
    }
    keep_sized(plots[0].svg, 330, (width) => plots.forEach((plot) => {
        plot.resize(width);
        plot.show(clock.row);
    }));
    const show = once_a_frame(() => plots.forEach((plot) => plot.show(clock.row)));
    let speak_later = 0;
    const moment = h("span", {class: "moment screen-only"});
    clock.follow(() => {
        show();
        moment.textContent = `at ${seconds(clock.time_s)}`;
        // Screen readers get the numbers when the cursor has come to rest in the plots.
        clearTimeout(speak_later);
        speak_later = setTimeout(() => {
            if (document.activeElement === stack && !playback.is_playing) {
                spoken.textContent = `${seconds(clock.time_s)}: ` +
                    plots
                        .map(({plot,
                               values}) => `${plot.title.split(",")[0]} ${values.map((v) => v.textContent).join(", ")}`)
                        .join("; ");
            }
        }, 400);
    });
    return {element, plots, moment};
}
