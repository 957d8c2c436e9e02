#!/usr/bin/env bash
# Lists symbols, other than its entry, that the object file of a wide kernel offers to the linker. Exit code 1 with any.
set -euo pipefail
found=0
for kernel in avx2 avx512; do
    file=$1/flight_kernel_$kernel.cpp.o
    [[ -f $file ]] || { echo "no $file" >&2; exit 2; }
    offered=$(nm --defined-only --demangle "$file" | awk '$2 ~ /[A-Zuvw]/' | grep -v " T downwash::simulation::${kernel}_kernel(" || true)
    if [[ -n $offered ]]; then
        printf '%s:\n%s\n' "$file" "$offered"
        found=1
    fi
done
exit "$found"
