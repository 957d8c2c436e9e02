#!/usr/bin/env bash
# Flies 500 random references of robots in space by the execution and by the judge, and writes
# bench/results/space_agreement.md. Half an hour.
set -euo pipefail
cd -P "$(dirname "${BASH_SOURCE[0]}")/.."

./dev build --target bench_space_agreement >&2
robots=(problems/robots/{ars_lrm_space,hexa370_arm3,snu_f550_arm2}.yaml bench/dynobench/quadrotor_v{0,1}.yaml)
mkdir -p bench/results
build/bench/bench_space_agreement "${robots[@]}" "$@" >bench/results/space_agreement.md.new
mv bench/results/space_agreement.md.new bench/results/space_agreement.md
cat bench/results/space_agreement.md
