// Colours of thrust ratios: those of the program's pictures (apps/report/color_scale.cpp), which the page brings as data.

const bytes = (color) => [1, 3, 5].map((i) => parseInt(color.slice(i, i + 2), 16));

/** The same hue on dark paper: what is dark on white stands out light, and white becomes the paper, #13171c. */
function on_dark([red, green, blue]) {
    const high = Math.max(red, green, blue), low = Math.min(red, green, blue);
    // Turning light to dark in HSL moves all three by the same amount.
    const turned = [red, green, blue].map((byte) => byte + 255 - high - low);
    return turned.map((byte, i) => [19, 23, 28][i] + byte * (1 - [19, 23, 28][i] / 255));
}

/** @returns {[number, number, number][]} red, green, blue of each class of a scale */
export function colors_of({colors}, theme) {
    return colors.map(bytes).map((color) => theme === "dark" ? on_dark(color) : color);
}

/** @returns {number} the class of a thrust ratio; those beyond the limits are in the first and the last one */
export function class_of(factor, {limits, colors}) {
    const above = limits.findLastIndex((limit) => limit <= factor);
    return Math.min(colors.length - 1, Math.max(0, above));
}
