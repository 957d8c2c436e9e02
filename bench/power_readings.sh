#!/usr/bin/env bash
# What a deck saves under two readings of power (docs/model.md 3), and writes bench/results/power_readings.md. Two minutes.
set -euo pipefail
cd -P "$(dirname "${BASH_SOURCE[0]}")/.."

seeds=5
iterations=1500
./dev build --target downwash >&2
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
sed "s#robots/ars_lrm#$PWD/problems/robots/ars_lrm#; s/^uncertainty: {}/uncertainty: none/" \
    problems/along_the_deck.yaml >"$work/as_believed.yaml"

# flown VARIANT SEED: thrust ratio and power of the last 30 s, energy of the flight, in both readings.
flown() {
    build/downwash solve "$work/as_believed.yaml" --variant "$1" --seed "$2" --max-iterations "$iterations" --quiet \
        --force --out "$work/run" >/dev/null
    awk -F, '
        /^#/ { next }
        !names {
            for (i = 1; i <= NF; ++i) {
                at[$i] = i
                rotors += $i ~ /_aero_factor$/ && $i ~ /^rotor_/
            }
            names = 1
            next
        }
        {
            free = acting = k = 0
            for (i = 1; i <= rotors; ++i) {
                thrust = $at["rotor_" i "_lag_n"]
                factor = $at["rotor_" i "_aero_factor"]
                free += thrust ^ 1.5
                acting += (factor * thrust) ^ 1.5
                k += factor / rotors
            }
            if (!coefficient) { coefficient = $at["power_w"] / free }  # the arm rests at the start
            time[++n] = $at["t_s"]
            power[n] = coefficient * free
            power_of_thrust[n] = coefficient * acting
            ratio[n] = k
        }
        END {
            step = time[2] - time[1]
            for (i = 1; i <= n; ++i) {
                energy += step * power[i]
                energy_of_thrust += step * power_of_thrust[i]
                if (time[i] > time[n] - 30) { ++m; k_sum += ratio[i]; p += power[i]; q += power_of_thrust[i] }
            }
            printf "%.4f %.1f %.1f %.2f %.2f\n", k_sum / m, p / m, q / m, energy / 1000, energy_of_thrust / 1000
        }' "$work/run/trajectory.csv"
}

# median COLUMN FILE
median() { cut -d' ' -f"$1" "$2" | sort -g | sed -n "$(((seeds + 1) / 2))p"; }

for variant in mp-arm-ada mp-arm-da; do
    for ((seed = 1; seed <= seeds; ++seed)); do
        flown "$variant" "$seed"
    done >"$work/$variant"
done
{
    echo "# What a deck saves, under two readings of power"
    echo
    echo "\`problems/along_the_deck.yaml\` in the nominal world; medians of seeds 1 to $seeds, $iterations iterations each; commit $(git describe --always --dirty)."
    echo "Made by \`bench/power_readings.sh\`. [model.md 3](../../docs/model.md#3-rotors-commands-and-power) explains the readings."
    echo
    echo "| planner | K in the last 30 s | power there, K_P K^-1.5 | power there, K_P | energy, K_P K^-1.5 | energy, K_P |"
    echo "| --- | ---: | ---: | ---: | ---: | ---: |"
    for variant in mp-arm-ada mp-arm-da; do
        row="$work/$variant"
        printf '| %s | %.3f | %.1f W | %.1f W | %.1f kJ | %.1f kJ |\n' "$variant" "$(median 1 "$row")" "$(median 2 "$row")" \
            "$(median 3 "$row")" "$(median 4 "$row")" "$(median 5 "$row")"
    done
} >bench/results/power_readings.md.new
mv bench/results/power_readings.md.new bench/results/power_readings.md
cat bench/results/power_readings.md
