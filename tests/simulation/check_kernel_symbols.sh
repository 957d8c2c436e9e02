#!/usr/bin/env bash
# Lists functions, other than its entry, that the object file of a wide kernel offers to the linker. Exit code 1 with any.
# Constants (u) are the same whatever the instructions.
set -euo pipefail
found=0
check() { # FILE ENTRY
    [[ -f $1 ]] || { echo "no $1" >&2; exit 2; }
    local offered
    offered=$(nm --defined-only --demangle "$1" | awk '$2 ~ /[A-Zvw]/' | grep -v " T .*downwash::simulation::$2[(<]" || true)
    if [[ -n $offered ]]; then
        printf '%s:\n%s\n' "$1" "$offered"
        found=1
    fi
}
for kernel in avx2 avx512; do
    check "$1/flight_kernel_$kernel.cpp.o" "${kernel}_kernel"
    for file in "$1"/space_kernel_"$kernel"_*.cpp.o; do
        check "$file" "${kernel}_space_kernel"
    done
done
exit "$found"
