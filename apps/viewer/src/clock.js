// The one moment that scene, plots, read-out and view in space show: a row of the flight.

/** @param {Float64Array} times_s */
export function make_clock(times_s) {
    const followers = [];
    let row = 0;
    return {
        times_s,
        rows: times_s.length,
        get row() { return row; },
        get time_s() { return times_s[row]; },
        set(wanted) {
            const next = Math.min(times_s.length - 1, Math.max(0, Math.round(wanted)));
            if (next !== row) {
                row = next;
                followers.forEach((follow) => follow(row));
            }
        },
        /** The last row that is not later: commands hold until the next one. */
        row_at(time_s) {
            let low = 0, high = times_s.length - 1;
            while (low < high) {
                const middle = (low + high + 1) >> 1;
                if (times_s[middle] <= time_s + 1e-9) {
                    low = middle;
                } else {
                    high = middle - 1;
                }
            }
            return low;
        },
        /** `follow(row)` now and whenever the moment changes. */
        follow(follow) {
            followers.push(follow);
            follow(row);
        },
    };
}
