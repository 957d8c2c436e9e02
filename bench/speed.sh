#!/usr/bin/env bash
# Times ticks and look-ups beside what others would use, in one run, and writes bench/results/speed.md: medians of seven
# repetitions in random order, lest what disturbs one benchmark disturbs all of its repetitions, and their ratios. Some ten
# minutes, and five to build; close everything else first.
set -euo pipefail
cd -P "$(dirname "${BASH_SOURCE[0]}")/.."

./dev build --target bench_micro bench_tick_operations >&2
# A peer may have the same instructions: where the processor has AVX2 the ODESolver is compiled for it as well.
peers=(true)
if grep -qw avx2 /proc/cpuinfo; then
    cmake -S . -B build-x86-64-v3 -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_FLAGS=-march=x86-64-v3 \
        -DDOWNWASH_BUILD_TESTS=OFF >&2
    cmake --build build-x86-64-v3 --target bench_micro -j "$(nproc)" >&2
    peers=(build-x86-64-v3/bench/bench_micro --benchmark_filter=ode)
fi
options=(--benchmark_repetitions=7 --benchmark_enable_random_interleaving=true --benchmark_report_aggregates_only=true --benchmark_format=csv "$@")
commit=$(bench/source_commit.sh)
processor=$(sed -n 's/^model name[^:]*: *//p' /proc/cpuinfo | head -n 1)
operations=$(build/bench/bench_tick_operations problems/bridge_inspection.yaml | tr '\n' ';')
mkdir -p bench/results
{
    build/bench/bench_micro --benchmark_filter='tick_with|batch|search|ode|mujoco|map_look_up|peak' "${options[@]}"
    "${peers[@]}" "${options[@]}" | sed 's#/\([a-z]*_[a-z]*\)_#/\1_avx2_#'
} |
    awk -F, -v commit="$commit" -v processor="$processor" -v operations="$operations" '
        function rate(name) { return name in items ? items[name] * 1e-6 : 0 }
        # The rate of the slowest of a group.
        function slowest(group, i, found) {
            for (i = 1; i <= n; ++i) {
                if (index(names[i], group) == 1 && (found == 0 || items[names[i]] < found)) { found = items[names[i]] }
            }
            return found + 0
        }
        function ratio(a, b) { return b > 0 ? a / b : 0 }
        function bound(text, value, least, unit) {
            if (value > 0) {
                printf "| %s | %.2f%s | %s |\n", text, value, unit, (value >= least ? "kept" : "**not kept**")
            }
        }
        # The widest that this processor has.
        function best(variant) {
            if (rate("batch/" variant "_avx512") > 0) { return "batch/" variant "_avx512" }
            if (rate("batch/" variant "_avx2") > 0) { return "batch/" variant "_avx2" }
            return "batch/" variant "_baseline"
        }
        # How near the ticks of a kind come to the peak of their instructions.
        function share(kind, variant, set, line, i, n, counts) {
            n = split(operations, line, ";")
            for (i = 1; i <= n; ++i) {
                split(line[i], counts, " ")
                if (counts[1] == kind && rate("batch/" variant "_" set) > 0 && rate("peak/" set) > 0) {
                    printf "| %s | %s | %d | %d | %d | %d | %.0f %% |\n", kind, set, counts[2], counts[3], counts[4], counts[5],
                           100 * (counts[2] + counts[3] + counts[4]) * rate("batch/" variant "_" set) / rate("peak/" set)
                }
            }
        }
        { gsub(/"/, ""); gsub(/\/(repeats:[0-9]+|real_time)/, "") }
        /_median,/ { sub(/_median/, "", $1); items[$1] = $7; names[++n] = $1 }
        END {
            printf "# Speed\n\nCommit %s; %s; medians of seven repetitions (three of searches) in one run, in random order. Per second; a tick is 10 ms of flight, those of ", commit, processor
            print "`ode_solver` and `mujoco_rk4` the same step of what a practitioner would use.\n`bench/speed.sh` writes this page.\n"
            print "| benchmark | million per second |\n| --- | --: |"
            fflush()
            for (i = 1; i <= n; ++i) { printf "| %s | %.4g |\n", names[i], rate(names[i]) | "LC_ALL=C sort" }
            close("LC_ALL=C sort")
            ada = best("aerodynamics_aware")
            print "\n| bound | found | |\n| --- | --: | --- |"
            bound("single ticks with the map, at least 2.5 M/s", rate("tick_with_map"), 2.5, " M/s")
            set = ada
            sub(/.*_/, "", set)
            bound("batched ticks with the map, " set ", at least 10 M/s", rate(ada), 10, " M/s")
            if (set == "avx512") { bound("batched ticks with the map, avx2, at least 10 M/s", rate("batch/aerodynamics_aware_avx2"), 10, " M/s") }
            bound("a single tick with the map costs at most 1.5 without: speed at least 0.667 of it", ratio(rate("tick_with_map"), rate("tick_without_effect")), 2 / 3, "")
            bound("batched, " set ", over an OMPL ODESolver with baseline instructions, at least 8", ratio(rate(ada), rate("ode_solver/with_map")), 8, " times")
            bound("batched over an ODESolver with avx2 for both, at least 8", ratio(rate("batch/aerodynamics_aware_avx2"), rate("ode_solver/with_map_avx2")), 8, " times")
            bound("batched over an ODESolver with baseline instructions for both, at least 8", ratio(rate("batch/aerodynamics_aware_baseline"), rate("ode_solver/with_map")), 8, " times")
            bound("batched over RK4 of MuJoCo, at least 25", ratio(rate(ada), rate("mujoco_rk4")), 25, " times")
            bound("two threads over one, edges of a search of ten seconds, at least 1.8", ratio(rate("search/two_threads"), rate("search/one_thread")), 1.8, " times")
            bound("two threads over one, edges of the first few seconds, at least 1.8", ratio(rate("search/first_seconds_two_threads"), rate("search/first_seconds_one_thread")), 1.8, " times")
            bound("two threads over one, 512 edges at a time, at least 1.8", ratio(rate("batch/aerodynamics_aware_two_threads"), rate(ada)), 1.8, " times")
            bound("searches limited to 0.1 s, the slowest algorithm, at least 1 per second", slowest("limited_search/"), 1, " per second")
            if (rate("search/two_at_once") > 0) { printf "\nTwo searches at once, of one thread each, fly %.2f times the edges of one: what two of these processors give.\n", ratio(rate("search/two_at_once"), rate("search/one_thread")) }
            print "\nHow near batched ticks come to what the processor gives: operations of a tick (`bench/tick_operations`), and the share of the peak that sums, products and"
            print "quotients (divisions and square roots, each as one) make. The peak is `peak/`: sums and products of one thread without contraction. Choices are comparisons, selections,"
            print "minima and maxima; they and looking up the map take the same units, and a division takes as long as eight sums and more.\n"
            print "| tick | instructions | sums | products | quotients | choices | share of the peak |\n| --- | --- | --: | --: | --: | --: | --: |"
            share("nominal", "aerodynamics_aware", "avx512")
            share("in_world", "in_worlds", "avx512")
            share("nominal", "aerodynamics_aware", "avx2")
            share("in_world", "in_worlds", "avx2")
            share("nominal", "aerodynamics_aware", "baseline")
            share("in_world", "in_worlds", "baseline")
            printf "\nBatched ticks with the map run at %.2f of the speed of those without.\n", ratio(rate(ada), rate(best("dynamics_aware")))
        }' >bench/results/speed.md.new
mv bench/results/speed.md.new bench/results/speed.md
bench/bars.sh --write
cat bench/results/speed.md
