// Extents of long lists: spread into Math.min they would be too many arguments.

/** Least and greatest finite value, and where. */
export function range_of(values) {
    let low = Infinity, high = -Infinity, low_row = 0, high_row = 0;
    for (let i = 0; i < values.length; ++i) {
        if (values[i] < low) {
            low = values[i];
            low_row = i;
        }
        if (values[i] > high) {
            high = values[i];
            high_row = i;
        }
    }
    return {low, high, low_row, high_row};
}

/** Extent of rings. */
export function extent_of(rings) {
    const points = rings.flat();
    const x = range_of(points.map((p) => p[0])), z = range_of(points.map((p) => p[1]));
    return {x_m: [x.low, x.high], z_m: [z.low, z.high]};
}

/**
 * Quintic Hermite interpolation between two knots of a reference.
 * @returns {[number, number, number]} x, z, arm at `t_s`
 */
export function between_knots(from, to, t_s) {
    const h = to.t_s - from.t_s, s = (t_s - from.t_s) / h;
    const s2 = s * s, s3 = s2 * s, s4 = s3 * s, s5 = s4 * s;
    const end = 10 * s3 - 15 * s4 + 6 * s5;
    const rates = [s - 6 * s3 + 8 * s4 - 3 * s5, -4 * s3 + 7 * s4 - 3 * s5];
    const bends = [(s2 - 3 * s3 + 3 * s4 - s5) / 2, (s3 - 2 * s4 + s5) / 2];
    const along = (value, rate, bend) => from[value] * (1 - end) + to[value] * end +
        h * ((from[rate] ?? 0) * rates[0] + (to[rate] ?? 0) * rates[1]) +
        h * h * ((from[bend] ?? 0) * bends[0] + (to[bend] ?? 0) * bends[1]);
    return [
        along("x_m", "vx_m_s", "ax_m_s2"), along("z_m", "vz_m_s", "az_m_s2"),
        along("arm_rad", "arm_rate_rad_s", "arm_acceleration_rad_s2")
    ];
}
