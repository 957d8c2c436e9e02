#!/usr/bin/env bash
# Installs a build of Downwash into a temporary prefix and uses it from outside: compiles every installed header alone,
# builds and runs these examples plainly and with -march=native, runs OMPL's planners and benchmark on our flights
# (docs/examples/ompl), flies the missions (docs/examples/mission), and calls the installed program and its completion.
# Usage: docs/examples/embed/run_consumer_test.sh [build folder, default: build]
set -euo pipefail

root=$(cd -P "$(dirname "${BASH_SOURCE[0]}")/../../.." && pwd)
build=$(cd -P "${1:-$root/build}" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
prefix=$work/installed

cmake --install "$build" --prefix "$prefix" >"$work/install.log" || {
    cat "$work/install.log"
    exit 1
}

echo "installed headers stand alone and show no library but the standard one"
others='/(eigen3|Eigen|ompl[^/]*|fcl|yaml-cpp|boost|nlohmann|spdlog|fmt|ceres|glog|gflags|octomap)/'
mapfile -t headers < <(cd "$prefix/include" && find . -name '*.hpp' ! -path './downwash/ompl/*' -printf '%P\n' | LC_ALL=C sort)
[[ ${#headers[@]} -gt 0 ]] || {
    echo "no header was installed"
    exit 1
}
# shellcheck disable=SC2016 # expanded by the inner shell
printf '%s\0' "${headers[@]}" | include=$prefix/include others=$others xargs -0 -n 8 -P "$(nproc)" bash -c '
    set -euo pipefail
    for header in "$@"; do
        read_by_it=$(g++ -std=c++20 -Wall -Wextra -Wpedantic -Werror -fsyntax-only -I "$include" -MD -MF - -x c++ - <<<"#include <$header>")
        if grep -nE "$others" <<<"$read_by_it"; then
            echo "$header brings the header above into programs that use it"
            exit 1
        fi
    done' check
echo "    ${#headers[@]} headers"

problem=$prefix/share/downwash/problems/bridge_inspection.yaml
for flags in '' '-march=native'; do
    echo "the examples, built with '${flags:-no flags of its own}'"
    rm -rf "$work/embed"
    {
        cmake -S "$root/docs/examples/embed" -B "$work/embed" -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_FLAGS="$flags" \
            -DCMAKE_PREFIX_PATH="$prefix" &&
            cmake --build "$work/embed"
    } >"$work/log" || {
        cat "$work/log"
        exit 1
    }
    "$work/embed/embed"
    "$work/embed/in_space"
done

echo "programs whose containers have another layout do not compile, with a reason"
compiles() {
    g++ -std=c++20 "$@" -fsyntax-only -I "$prefix/include" "$root/docs/examples/embed/main.cpp" 2>"$work/log"
}
for flag in -D_GLIBCXX_DEBUG -D_GLIBCXX_USE_CXX11_ABI=0; do
    if compiles "$flag" || ! grep -q '#error "Downwash ' "$work/log"; then
        echo "$flag: expected #error"
        exit 1
    fi
done
compiles -D_GLIBCXX_ASSERTIONS -D_FORTIFY_SOURCE=2 -O2 -funsigned-char

if command -v pkg-config >/dev/null; then
    echo "the example, built by way of pkg-config"
    read -ra flags < <(PKG_CONFIG_PATH=$prefix/lib/pkgconfig pkg-config --cflags --libs downwash)
    g++ -std=c++20 "$root/docs/examples/embed/main.cpp" "${flags[@]}" -Wl,-rpath,"$prefix/lib" -o "$work/embed_pkg_config"
    "$work/embed_pkg_config"
fi

echo "OMPL's planners on our flights, and ours, by OMPL's benchmark"
{
    cmake -S "$root/docs/examples/ompl" -B "$work/ompl" -DCMAKE_BUILD_TYPE=Release -DCMAKE_PREFIX_PATH="$prefix" &&
        cmake --build "$work/ompl"
} >"$work/log" 2>&1 || {
    cat "$work/log"
    exit 1
}
(cd "$work" && ompl/flights_with_ompl "$problem" 1 2)

if [[ -f $prefix/include/downwash/judge/simulated_vehicle.hpp ]]; then
    echo "a mission planner and the vehicle that it commands (docs/examples/mission)"
    "$root/docs/examples/mission/run_mission_test.sh" "$prefix" "$work"
fi

if [[ ! -x $prefix/bin/downwash ]]; then
    echo "this build has no program"
    exit 0
fi
echo "the installed program"
"$prefix/bin/downwash" --version
"$prefix/bin/downwash" check "$problem"

echo "its manual pages and completions"
grep -qF '.TH DOWNWASH-AEROMAP-PLOT 1' "$prefix/share/man/man1/downwash-aeromap-plot.1"
bash -c '
    source "$1"
    COMP_WORDS=(downwash aeromap pl) COMP_CWORD=2
    _downwash
    [[ ${COMPREPLY[*]} == plot ]]' completes "$prefix/share/bash-completion/completions/downwash"
grep -qF "complete -c downwash -n 'test (__downwash_command) = \"downwash aeromap\"' -f -a 'plot'" \
    "$prefix/share/fish/vendor_completions.d/downwash.fish"
[[ $(head -n 1 "$prefix/share/zsh/site-functions/_downwash") == '#compdef downwash' ]]
