// The frame of the scene: equal axes in metres, zoom and pan, a group in metres and one in pixels above it.

import {axisBottom, axisLeft} from "d3-axis";
import {scaleLinear} from "d3-scale";
import {event, select} from "d3-selection";
import {zoom, zoomIdentity} from "d3-zoom";

import {once_a_frame, s, set_attributes} from "./dom.js";

const margin = {
    left: 46,
    right: 10,
    top: 10,
    bottom: 38
};
const most_zoom = 60;

/** Of the window: what stands above and, with a flight, the playback below have room in the same screen. */
const most_of_window = {with_playback: 0.42, alone: 0.56};

/** @typedef {{x_m: [number, number], z_m: [number, number]}} Extent */

/** The least extent of `inner`'s place that has the shape of the frame. */
function with_shape(inner, width, height) {
    const size_x = inner.x_m[1] - inner.x_m[0], size_z = inner.z_m[1] - inner.z_m[0];
    const scale = Math.min(width / size_x, height / size_z);
    const middle_x = (inner.x_m[0] + inner.x_m[1]) / 2, middle_z = (inner.z_m[0] + inner.z_m[1]) / 2;
    return {scale, middle_x, middle_z};
}

export class View {
    /**
     * @param {Extent} everything what one may pan over
     * @param {Extent} opening what is shown first
     * @param {string} description for those who do not see the picture
     * @param {boolean} has_playback whether a playback stands below
     */
    constructor(everything, opening, description, has_playback) {
        this.most_of_window = has_playback ? most_of_window.with_playback : most_of_window.alone;
        this.everything = everything;
        this.opening = opening;
        this.followers = [];
        this.raster = s("g", {class: "raster"});
        this.world = s("g", {class: "world"});
        this.overlay = s("g", {class: "overlay"});
        this.clip = s("rect");
        this.grid = s("g", {class: "grid"});
        this.axis_x = s("g", {class: "axis"});
        this.axis_z = s("g", {class: "axis"});
        this.frame = s("rect", {class: "frame"});
        this.name_x = s("text", {class: "axis-name", "text-anchor": "middle"}, "x [m]");
        this.name_z = s("text", {class: "axis-name", "text-anchor": "middle"}, "z [m]");
        this.svg =
            s("svg", {class: "scene-svg", tabindex: "0", role: "img", "aria-label": description},
              s("defs", null, s("clipPath", {id: "scene-clip"}, this.clip)),
              s("g", {"clip-path": "url(#scene-clip)"}, this.raster, this.grid, this.world, this.overlay), this.frame,
              this.axis_x, this.axis_z, this.name_x, this.name_z);
        this.transform = zoomIdentity;
        this.redraw_soon = once_a_frame(() => this.redraw());
        this.zoom = zoom().filter(() => this.#may_handle(event)).on("zoom", () => {
            this.transform = event.transform;
            this.svg.classList.toggle("zoomed", event.transform.k > 1.01);
            this.redraw_soon();
        });
        select(this.svg).call(this.zoom).on("dblclick.zoom", null);
        this.svg.style.touchAction = "";
        this.svg.addEventListener("keydown", (pressed) => this.#key(pressed));
    }

    /** The wheel scrolls the page until the scene has been clicked; one finger scrolls it until the scene is zoomed. */
    #may_handle(happened) {
        if (happened.type === "wheel") {
            return happened.ctrlKey || happened.metaKey || document.activeElement === this.svg;
        }
        if (happened.touches) {
            return happened.touches.length > 1 || this.transform.k > 1.01;
        }
        return !happened.ctrlKey && !happened.button;
    }

    #key(pressed) {
        if (pressed.ctrlKey || pressed.metaKey || pressed.altKey) {
            return;
        }
        const step = 60;
        const moves = {a: [step, 0], d: [-step, 0], w: [0, step], s: [0, -step]};
        const key = pressed.key.toLowerCase();
        if (moves[key]) {
            const [x, y] = moves[key];
            select(this.svg).call(this.zoom.translateBy, x / this.transform.k, y / this.transform.k);
        } else if (key === "+" || key === "=") {
            this.zoom_by(1.4);
        } else if (key === "-") {
            this.zoom_by(1 / 1.4);
        } else if (key === "0") {
            this.show(this.opening);
        } else {
            return;
        }
        pressed.preventDefault();
    }

    zoom_by(factor) { select(this.svg).call(this.zoom.scaleBy, factor); }

    /** @param {Extent} extent */
    show(extent) {
        const fit = with_shape(extent, this.inner_width, this.inner_height);
        const k = fit.scale / this.base.scale;
        const x = this.center[0] - k * (this.center[0] + (fit.middle_x - this.base.middle_x) * this.base.scale);
        const y = this.center[1] - k * (this.center[1] - (fit.middle_z - this.base.middle_z) * this.base.scale);
        select(this.svg).call(this.zoom.transform, zoomIdentity.translate(x, y).scale(k));
    }

    /** `width` in pixels; the height follows from the extent. Keeps what is shown. */
    resize(width) {
        const shown = this.width ? {k: this.transform.k, at: this.to_plane(...this.center)} : null;
        const shape = (this.opening.z_m[1] - this.opening.z_m[0]) / (this.opening.x_m[1] - this.opening.x_m[0]);
        this.width = width;
        this.inner_width = width - margin.left - margin.right;
        const most = Math.min(640, Math.max(240, this.most_of_window * window.innerHeight));
        this.inner_height =
            Math.round(Math.min(most, Math.max(200, this.inner_width * Math.min(1, Math.max(0.42, shape)))));
        this.height = this.inner_height + margin.top + margin.bottom;
        this.center = [margin.left + this.inner_width / 2, margin.top + this.inner_height / 2];
        this.base = with_shape(this.opening, this.inner_width, this.inner_height);
        const right = margin.left + this.inner_width, bottom = margin.top + this.inner_height;
        const {x_m, z_m} = this.everything;
        const at = (x, z) =>
            [this.center[0] + (x - this.base.middle_x) * this.base.scale,
             this.center[1] - (z - this.base.middle_z) * this.base.scale];
        const far = Math.max(x_m[1] - x_m[0], z_m[1] - z_m[0]) / 4;
        const k_of_everything =
            with_shape(this.everything, this.inner_width, this.inner_height).scale / this.base.scale;
        const box = {x: margin.left, y: margin.top, width: this.inner_width, height: this.inner_height};
        this.zoom.scaleExtent([Math.min(0.5, 0.9 * k_of_everything), most_zoom])
            .extent([[margin.left, margin.top], [right, bottom]])
            .translateExtent([at(x_m[0] - far, z_m[1] + far), at(x_m[1] + far, z_m[0] - far)]);
        this.svg.setAttribute("viewBox", `0 0 ${width} ${this.height}`);
        set_attributes(this.clip, box);
        set_attributes(this.frame, box);
        set_attributes(this.axis_x, {transform: `translate(0 ${bottom})`});
        set_attributes(this.axis_z, {transform: `translate(${margin.left} 0)`});
        set_attributes(this.name_x, {x: this.center[0], y: this.height - 4});
        set_attributes(this.name_z, {transform: `translate(12 ${this.center[1]}) rotate(-90)`});
        if (shown) {
            const {k} = shown;
            const [x, y] = at(...shown.at);
            select(this.svg).call(
                this.zoom.transform, zoomIdentity.translate(this.center[0] - k * x, this.center[1] - k * y).scale(k));
        }
        this.redraw();
    }

    /** Pixels of the picture for a point of the plane. */
    to_pixels(x_m, z_m) {
        return [
            this.transform.applyX(this.center[0] + (x_m - this.base.middle_x) * this.base.scale),
            this.transform.applyY(this.center[1] - (z_m - this.base.middle_z) * this.base.scale),
        ];
    }

    to_plane(x, y) {
        return [
            this.base.middle_x + (this.transform.invertX(x) - this.center[0]) / this.base.scale,
            this.base.middle_z - (this.transform.invertY(y) - this.center[1]) / this.base.scale,
        ];
    }

    get pixels_per_m() { return this.base.scale * this.transform.k; }

    /** The extent that is seen now. */
    get shown() {
        const [x_low, z_low] = this.to_plane(margin.left, margin.top + this.inner_height);
        const [x_high, z_high] = this.to_plane(margin.left + this.inner_width, margin.top);
        return {x_m: [x_low, x_high], z_m: [z_low, z_high]};
    }

    /** In pixels: [left, top, right, bottom] of the area inside the axes. */
    get inside() { return [margin.left, margin.top, margin.left + this.inner_width, margin.top + this.inner_height]; }

    follow(follow) { this.followers.push(follow); }

    redraw() {
        const scale = this.pixels_per_m;
        const [x0, y0] = this.to_pixels(0, 0);
        const transform = `matrix(${scale} 0 0 ${- scale} ${x0} ${y0})`;
        this.world.setAttribute("transform", transform);
        this.raster.setAttribute("transform", transform);
        const {x_m, z_m} = this.shown;
        const [left, top, right, bottom] = this.inside;
        const x = scaleLinear().domain(x_m).range([left, right]);
        const z = scaleLinear().domain(z_m).range([bottom, top]);
        const ticks_x = Math.max(3, Math.round(this.inner_width / 75)),
              ticks_z = Math.max(3, Math.round(this.inner_height / 55));
        const minus = (scale_of, count) => (value) => scale_of.tickFormat(count)(value).replace("-", "−");
        select(this.axis_x).call(axisBottom(x).ticks(ticks_x).tickFormat(minus(x, ticks_x)).tickSize(4).tickPadding(4));
        select(this.axis_z).call(axisLeft(z).ticks(ticks_z).tickFormat(minus(z, ticks_z)).tickSize(4).tickPadding(4));
        const lines = [
            ...x.ticks(ticks_x).map((value) => `M${x(value)} ${top}V${bottom}`),
            ...z.ticks(ticks_z).map((value) => `M${left} ${z(value)}H${right}`),
        ];
        this.grid.replaceChildren(s("path", {d: lines.join("")}));
        this.followers.forEach((follow) => follow(this));
    }
}
