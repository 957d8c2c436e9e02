#!/usr/bin/env bash
# Simulates searches for certificates and writes bench/results/certificate_test.md. Some seconds.
set -euo pipefail
cd -P "$(dirname "${BASH_SOURCE[0]}")/.."

./dev build --target bench_certificate_test >&2
mkdir -p bench/results
build/bench/bench_certificate_test >bench/results/certificate_test.md.new
mv bench/results/certificate_test.md.new bench/results/certificate_test.md
cat bench/results/certificate_test.md
