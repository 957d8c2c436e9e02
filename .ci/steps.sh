# shellcheck shell=bash
# Steps of a check, each run to its end whatever the others say, their sum, and how long each took. Sourced by run and full.

ctest_passed=0
failed=0
durations=()

# took NAME SECONDS: a line for the table of finish.
took() {
    durations+=("$(printf '%7d s  %s' "$2" "$1")")
}

# step NAME COMMAND...: the command's success or failure as one entry of the sum.
step() {
    local name=$1 begin=$SECONDS
    shift
    printf '\n=== %s\n' "$name"
    if "$@"; then
        printf '=== %s: ok (%d s)\n' "$name" $((SECONDS - begin))
    else
        printf '=== %s: FAILED (%d s)\n' "$name" $((SECONDS - begin))
        failed=$((failed + 1))
    fi
    took "$name" $((SECONDS - begin))
}

# ctest_step NAME COMMAND...: the same for a command that ends in CTest's report, whose tests are counted one by one.
ctest_step() {
    local name=$1 begin=$SECONDS log code=0 report bad=0 all=0
    shift
    printf '\n=== %s\n' "$name"
    log=$(mktemp)
    "$@" 2>&1 | tee "$log" || code=$?
    report=$(grep -E 'tests passed, [0-9]+ tests? failed out of [0-9]+' "$log" | tail -n 1 || true)
    rm -f "$log"
    if [[ $report =~ ([0-9]+)\ tests?\ failed\ out\ of\ ([0-9]+) ]]; then
        bad=${BASH_REMATCH[1]}
        all=${BASH_REMATCH[2]}
    fi
    ctest_passed=$((ctest_passed + all - bad))
    failed=$((failed + bad))
    if [[ $code -ne 0 && $bad -eq 0 ]]; then
        failed=$((failed + 1))
    fi
    printf '=== %s: exit code %d (%d s)\n' "$name" "$code" $((SECONDS - begin))
    took "$name" $((SECONDS - begin))
}

# Tests that passed are CTest's; what failed are those of CTest and failed steps. Ends the script.
finish() {
    printf '\n'
    printf '%s\n' "${durations[@]}"
    printf '%7d s  in all\n' "$SECONDS"
    printf '\n%d passed, %d failed\n' "$ctest_passed" "$failed"
    [[ $failed -eq 0 ]] && exit 0
    exit 1
}
