#!/usr/bin/env bash
# Whether pages quote the numbers that the pages of results have today.
# Usage: tests/docs/check_figures.sh ROOT
set -euo pipefail
cd "$1"

bad=0
quoted=0

# quotes PAGE TEXT: the page has this text, however it is broken into lines.
quotes() {
    quoted=$((quoted + 1))
    tr -s ' \n' ' ' <"$1" | grep -qF -e "$2" || {
        bad=$((bad + 1))
        echo "$1 does not say: $2"
    }
}

# failed PLANNER, seeds PLANNER: sums of the column "failed flight" over all problems of a campaign's page ($campaign).
failed() { column "$1" 1; }
seeds() { column "$1" 2; }
column() {
    awk -F'|' -v planner=" $1 rrt-star " -v part="$2" '
        /^## / { is_wanted = $0 == "## Success and flights" }
        is_wanted && $3 == planner { split($5, share, /[\/ ]/); sum += share[part + 1] }
        END { print sum + 0 }' "$campaign"
}

# cell PAGE ROW N: the Nth cell of the first row of a page that begins with ROW, without blanks around it.
cell() {
    awk -F'|' -v row="| $2 |" -v n="$3" '
        index($0, row) == 1 { gsub(/^ +| +$/, "", $(n + 1)); print $(n + 1); exit }' "bench/results/$1"
}

# Beside a wall, as shares of thrust T = 4 C_T rho n^2 D^4 with C_T = 0.1, and of T R.
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

# How near each law can hover under a ceiling: the shipped robot with its lag.
limit() { # ROW, N: a cell of that table, without marks
    awk -F'|' -v row="| $1 |" -v n="$2" '
        /^## / { is_wanted = /^## ars_lrm, ceiling, .*lag 50 ms/ }
        is_wanted && index($0, row) == 1 { gsub(/[ *]/, "", $(n + 1)); print $(n + 1); exit }' bench/results/law_limits.md
}
quotes docs/control.md "the model inversion needs $(limit model-inversion 2) m. The shipped robot's observer of 3 1/s takes it to $(limit '+ observer, 3 1/s' 2) m, one of 10 1/s to $(limit '+ observer, 10 1/s' 2) m"
quotes docs/control.md "to the limit of the flyable area, $(limit '+ feed-forward' 2) m"
quotes docs/control.md "3 cm wrong the feed-forward needs $(limit '+ feed-forward' 4) m, with one that is 5 cm wrong $(limit '+ feed-forward' 8) m"

# Power near surfaces, in both readings.
power() { cell power_readings.md "$1" "$2"; }
quotes docs/model.md "where K is $(power mp-arm-ada 2):"
quotes docs/model.md "| $(power mp-arm-ada 3), $(power mp-arm-da 3) | $(power mp-arm-ada 5) | $(power mp-arm-da 5) |"
quotes docs/model.md "| $(power mp-arm-ada 4), $(power mp-arm-da 4) | $(power mp-arm-ada 6) | $(power mp-arm-da 6) |"

campaign=bench/results/all.md
quotes README.md "none of the $(seeds mp-arm-ada) MP-ARM-ADA plans failed"
[[ $(failed mp-arm-ada) == 0 ]] || quotes README.md "$(failed mp-arm-ada) MP-ARM-ADA plans failed"
quotes README.md "while $(failed mp-arm-da) MP-ARM-DA plans and $(failed mp-arm) MP-ARM plans did"
share_in_worlds() { # PLANNER: of the flights in other worlds that fail, in %
    awk -F'|' -v planner=" $1 rrt-star " '
        $2 == " all " && $3 == planner && split($5, n, /[\/ ]/) { printf "%.0f", 100 * n[2] / n[3]; exit }' "$campaign"
}
quotes README.md "$(share_in_worlds mp-arm-ada) % of the flights of these MP-ARM-ADA plans fail, $(share_in_worlds mp-arm-da) % of those of MP-ARM-DA and $(share_in_worlds mp-arm) % of those of MP-ARM"

campaign=bench/results/certified.md
certified() { # N: a cell of the row of all problems
    awk -F'|' -v n="$1" '$2 == " all " { gsub(/^ +| +$/, "", $(n + 1)); print $(n + 1); exit }' "$campaign"
}
given=$(certified 5)
given=${given%% *}
failures=$(certified 4)
failures=${failures%%/*}
flights=$(certified 4 | awk -F'[/ ]' '{ printf "%.0f,000", $2 / 1000 }')
quotes README.md "[${given%%/*} of ${given##*/}](bench/results/certified.md) came to a plan with a certificate"
quotes README.md "$failures of $flights flights of these plans failed"
quotes docs/robustness.md "${given%%/*} of ${given##*/} searches have a certified plan"
quotes docs/robustness.md "In $flights flights in fresh worlds the certified plans failed $failures times"

safe=$(sed -n 's/^\*\*mp-arm rrt-star\*\*: safe on all problems from a margin of \([0-9.]* m\) on.*/\1/p' bench/results/margins.md)

# goals TEXT: how many rows of MP-ARM's table of inflated obstacles match it.
goals() {
    awk -v text="$1" '
        /^\*\*/ { is_wanted = /^\*\*mp-arm rrt-star\*\*/ }
        /^## / && !/Inflated obstacles/ { exit }
        is_wanted && /^\| .*, energy / && $0 ~ text { n++ }
        END { split("one two three four five six seven eight", words, " "); print n ? words[n] : "none" }' bench/results/margins.md
}
quotes README.md "safe everywhere from a margin of $safe on, and reaches $(goals '\| [1-9][0-9]*/[0-9]+ [^|]*\|[^|]*\|$') of the $(goals '') goals."
[[ $(goals 'before it is safe') == none ]] || quotes README.md "$(goals 'before it is safe' | sed 's/./\u&/') of the other goals are already out of reach"

hover=hover_flights.md
unstable=$(cell $hover all 4)
stable=$(cell $hover all 5)
of=${unstable#*/}
quotes docs/hold.md "Of ${of%% *} flights called unstable, ${unstable%%/*} grew."
quotes docs/hold.md "All ${stable%%/*} flights called stable decayed."
[[ $stable =~ ^([0-9]+)/${stable%%/*}\  ]] || quotes docs/hold.md "${stable%% *} flights called stable decayed"
quotes docs/hold.md "$(cell $hover all 6) flights had growth rates within 0.05 1/s of zero"

# seconds CELL: a time in ms as the docs write it.
seconds() { awk -v ms="$1" 'BEGIN { printf ms < 1000 ? "%.3f s" : "%.1f s", ms / 1000 }'; }
ours=$(tac bench/results/ompl_user.md | sed -n '/^| downwash rrt-star/{p;q}')
rival='RandUP-RRT, ODESolver, FCL (a user'"'"'s)'
quotes docs/robustness.md "in every search, after $(seconds "$(awk -F'|' '{ print $6 }' <<<"$ours")") at the median"
quotes docs/robustness.md "found one in $(cell ompl_user.md "$rival" 2 | sed 's,/, of ,'), after $(seconds "$(cell ompl_user.md "$rival" 5)") at the median"
times=$(sed -n 's/.*| \([0-9.]*\) times, 95 % interval \([0-9.]*\) to \([0-9.]*\) |.*/\1 \2 \3/p' bench/results/ompl_user.md | tail -n 1)
read -r ratio low high <<<"$times"
quotes docs/robustness.md "That is ${ratio%.*} times sooner (95 % interval: $(printf '%.0f to %.0f' "$low" "$high")"

# The extremes of a column of the first table of aero_map.md, in ns.
look_ups() {
    awk -F'|' -v column="$1" '
        /^\| problem \| build/ { is_wanted = 1; next }
        is_wanted && !/^\|/ { exit }
        is_wanted && /ns/ { ns = $(column + 1) + 0; if (low == 0 || ns < low) low = ns; if (ns > high) high = ns }
        END { print low, high }' bench/results/aero_map.md
}
read -r _ in_flight <<<"$(look_ups 8)"
read -r direct_low direct_high <<<"$(look_ups 9)"
quotes docs/embedding.md "within $(printf '%.0f' "$in_flight") ns instead of $direct_low to $direct_high ns"

echo "$quoted quotations, $bad of them differ"
((bad == 0))
