#!/usr/bin/env bash
# Whether docs/aeromap.md quotes what the measurements beside a wall say.
# Usage: tests/docs/check_walls.sh ROOT
set -euo pipefail
cd "$1"

bad=0

# quotes PAGE TEXT: the page has this text, however it is broken into lines.
quotes() {
    tr -s ' \n' ' ' <"$1" | grep -qF -e "$2" || {
        bad=$((bad + 1))
        echo "$1 does not say: $2"
    }
}

# Shares of thrust T = 4 C_T rho n^2 D^4 with C_T = 0.1, and of T R.
wall() { # FACILITY or all, least distance: mean force in %, greatest force in %, greatest moment
    awk -F, -v facility="$1" -v from="$2" '
        /^#/ || /^facility/ || (facility != "all" && $1 != facility) || $4 < from { next }
        {
            thrust = 4 * 0.1 * 1.225 * ($3 / 60) ^ 2 * 0.3048 ^ 4
            force = 100 * $5 / thrust
            moment = $6 / (thrust * 0.1524)
            sum += force
            ++n
            if (force * force > f * f) { f = force }
            if (moment * moment > m * m) { m = moment }
        }
        END { printf "%.1f %.1f %.3f\n", sum / n, f < 0 ? -f : f, m < 0 ? -m : m }' aeromap/effects/measurements/walls/wall_effect.csv
}
read -r _ force moment_touching < <(wall all 0)
read -r _ _ moment < <(wall all 1.5)
read -r pulls _ _ < <(wall DU2SRI 0)
read -r pushes _ _ < <(wall txc 0)
quotes docs/aeromap.md "the force is at most $force % of the thrust"
quotes docs/aeromap.md "$pulls % on average in one and +$pushes % in the other"
quotes docs/aeromap.md "the moment is at most $moment_touching T R with a disc that touches the wall, and $moment T R from"
((bad == 0))
