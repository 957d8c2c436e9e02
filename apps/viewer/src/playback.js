// Slider, play, speed, keys and taps.

import {h} from "./dom.js";
import {seconds} from "./format.js";

const speeds = [0.25, 0.5, 1, 2, 4];

/** Keys act on the whole page, except where a control has its own use for them. */
function has_own_use(target, key) {
    if (!(target instanceof Element)) {
        return false;
    }
    if (target.closest("select, textarea, input[type=text], [data-own-keys]")) {
        return true;
    }
    // Text in a box of its own is scrolled by keys.
    if (target.closest("pre, .scroll, .description") && key !== " ") {
        return true;
    }
    return (key === " " || key === "Enter") &&
        target.closest("button, summary, a, input[type=checkbox], input[type=radio]") !== null ||
        (key.startsWith("Arrow") && target.closest("input[type=radio]") !== null);
}

/** A short touch of one finger that stays where it is; fingers that move or pinch are for the picture. */
function when_tapped(element, act) {
    const most_ms = 350, most_pixels = 10;
    let tap = null;
    element.addEventListener("pointerdown", (touched) => {
        const is_first = touched.pointerType === "touch" && touched.isPrimary;
        tap = is_first ? {at_ms: touched.timeStamp, x: touched.clientX, y: touched.clientY} : null;
    });
    element.addEventListener("pointercancel", () => { tap = null; });
    element.addEventListener("pointerup", (lifted) => {
        if (tap && lifted.timeStamp - tap.at_ms < most_ms &&
            Math.hypot(lifted.clientX - tap.x, lifted.clientY - tap.y) < most_pixels) {
            act();
        }
        tap = null;
    });
}

/** @param {AbortSignal} [signal] ends what keys do on the page */
export function make_playback(model, clock, signal) {
    const slider = h("input", {
        type: "range",
        class: "time",
        id: "time",
        min: 0,
        max: clock.rows - 1,
        step: 1,
        value: 0,
        "aria-label": "Time of the flight"
    });
    const readout = h("span", {class: "time-text"});
    const play = h("button", {type: "button", class: "play", "aria-label": "Play"});
    const speed =
        h("select", {"aria-label": "Speed"},
          speeds.map((value) => h("option", {value, selected: value === 1}, `${value}×`)));
    let playing = null;

    const show_state = () => {
        play.textContent = playing ? "❚❚" : "▶";
        play.setAttribute("aria-label", playing ? "Pause" : "Play");
    };
    const pause = () => {
        if (playing) {
            cancelAnimationFrame(playing.frame);
            playing = null;
            show_state();
        }
    };
    const advance = (now) => {
        // Seconds of flight, counted from where it was started: rounding to rows does not add up.
        playing.time_s += ((now - playing.last_ms) / 1000) * Number(speed.value);
        playing.last_ms = now;
        clock.set(clock.row_at(playing.time_s));
        if (playing.time_s >= clock.times_s[clock.rows - 1]) {
            pause();
        } else {
            playing.frame = requestAnimationFrame(advance);
        }
    };
    const start = () => {
        if (clock.row === clock.rows - 1) {
            clock.set(0);
        }
        playing = {time_s: clock.time_s, last_ms: performance.now(), frame: requestAnimationFrame(advance)};
        show_state();
    };
    const toggle = () => (playing ? pause() : start());
    const go = (row) => {
        pause();
        clock.set(row);
    };

    play.addEventListener("click", toggle);
    slider.addEventListener("input", () => go(Number(slider.value)));
    document.addEventListener("keydown", (pressed) => {
        if (pressed.ctrlKey || pressed.metaKey || pressed.altKey || has_own_use(pressed.target, pressed.key)) {
            return;
        }
        const second = pressed.shiftKey;
        const later = (direction) => second ? clock.row_at(clock.time_s + direction) : clock.row + direction;
        const acts = {
            " ": toggle,
            ArrowRight: () => go(later(1)),
            ArrowUp: () => go(later(1)),
            ArrowLeft: () => go(later(-1)),
            ArrowDown: () => go(later(-1)),
            Home: () => go(0),
            End: () => go(clock.rows - 1),
        };
        // Up and down scroll the page unless the slider itself has the focus.
        const is_scrolling = ["ArrowUp", "ArrowDown"].includes(pressed.key) && pressed.target !== slider;
        if (acts[pressed.key] && !is_scrolling) {
            pressed.preventDefault();
            acts[pressed.key]();
        }
    }, {signal});
    signal?.addEventListener("abort", pause);
    clock.follow((row) => {
        slider.value = String(row);
        slider.setAttribute("aria-valuetext", `${seconds(clock.time_s)} of ${seconds(model.end_s)}`);
        slider.style.setProperty("--share", clock.rows > 1 ? row / (clock.rows - 1) : 0);
        readout.textContent = seconds(clock.time_s);
    });
    show_state();

    const part = (time_s) => (time_s / (model.end_s || 1)).toFixed(5);
    const share = (time_s) => `left: calc(var(--thumb) / 2 + (100% - var(--thumb)) * ${part(time_s)})`;
    const shortest_named_s = 0.15 * model.end_s;  // so much of the bar has room for the word on a small screen
    const marks = model.hovers.map(
        ({from_s, to_s, goal}) =>
            h("span",
              {class: "mark hover", style: `${share(from_s)}; width: calc((100% - var(--thumb)) * ${part(to_s - from_s)})`},
              h("span", null, goal !== null ? String(goal) : to_s - from_s > shortest_named_s ? "hover" : "")));
    if (model.is_cut_short) {
        marks.push(h("span", {class: "mark failure", style: share(model.end_s)}, "✕"));
    }
    const element =
        h("div", {class: "playback screen-only", role: "group", "aria-label": "Playback"}, play,
          h("div", {class: "time-track"}, slider, h("div", {class: "marks", "aria-hidden": "true"}, marks)),
          h("span", {class: "time-box"}, readout, h("span", {class: "muted"}, ` / ${seconds(model.end_s)}`)),
          h("label", {class: "speed"}, h("span", {class: "visually-hidden"}, "Speed"), speed));
    return {
        element,
        slider,
        toggle,
        pause,
        plays_on_tap: (picture) => when_tapped(picture, toggle),
        get is_playing() { return playing !== null; },
    };
}
