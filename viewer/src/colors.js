// Colours of the aero map. Free air (factor 1) is the paper itself; more thrust goes to blue, less to ochre,
// steps of equal lightness, told apart by people who do not tell red from green.

const ramps = {
    light: {
        more: ["#ffffff", "#d3e6f3", "#9dc7e4", "#5b9fd0", "#2a73b3", "#0c4a8a", "#082c5c"],
        less: ["#ffffff", "#f2d9a8", "#d9a441", "#9a6a12"],
    },
    dark: {
        more: ["#13171c", "#173247", "#1c5379", "#2a7aab", "#55a4d4", "#96cbed", "#dcf0fd"],
        less: ["#13171c", "#4a3710", "#96702a", "#e0b565"],
    },
};

function mix(stops, share) {
    const at = Math.min(1, Math.max(0, share)) * (stops.length - 1);
    const index = Math.min(stops.length - 2, Math.floor(at));
    const part = (color, i) => parseInt(color.slice(1 + 2 * i, 3 + 2 * i), 16);
    return [0, 1, 2].map(
        (i) => part(stops[index], i) + (at - index) * (part(stops[index + 1], i) - part(stops[index], i)));
}

/** @returns {[number, number, number]} red, green, blue of a thrust factor */
export function color_of(factor, {factor_low, factor_high}, theme) {
    if (factor >= 1) {
        // The square root spreads the small factors, which are most of the map.
        return mix(ramps[theme].more, Math.sqrt((factor - 1) / Math.max(1e-9, factor_high - 1)));
    }
    return mix(ramps[theme].less, (1 - factor) / Math.max(0.1, 1 - factor_low));
}
