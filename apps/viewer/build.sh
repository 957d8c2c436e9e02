#!/usr/bin/env bash
# Builds the pages, each an HTML file without data: DIR/run.html, space.html, robot.html, campaign.html, comparison.html
# and validation.html. Usage: apps/viewer/build.sh DIR
# Needs esbuild ($ESBUILD, or the one on the path), node-d3 and libjs-three of Debian; the same sources and packages give
# the same bytes.
set -euo pipefail

if [[ $# -ne 1 ]]; then
    echo "usage: apps/viewer/build.sh DIR" >&2
    exit 2
fi
out=$(realpath -m -- "$1")
cd -P "$(dirname "${BASH_SOURCE[0]}")"
three=/usr/share/javascript/three

parts=$(mktemp -d)
trap 'rm -rf "$parts"' EXIT

# Browsers of early 2023: the first that can inflate in Firefox and Safari.
bundle() {
    NODE_PATH=/usr/share/nodejs "${ESBUILD:-esbuild}" "$@" --bundle --minify --charset=utf8 --legal-comments=none \
        --log-level=warning --format=iife --target=chrome110,firefox113,safari16.4
}

# page NAME TITLE SCRIPT STYLE: what is in $parts/extra goes before the script.
page() {
    bundle "$3" --loader:.txt=text --outfile="$parts/page.js"
    bundle "$4" --outfile="$parts/page.css"
    # esbuild writes these harmlessly; should that change, a broken page must not be built.
    if grep -qiE '</?script|<!--' "$parts/page.js" || grep -qi '</style' "$parts/page.css"; then
        echo "apps/viewer/build.sh: the bundle holds text that would end its own element" >&2
        exit 1
    fi
    # `r` copies files as they are: nothing in them is taken for a pattern.
    sed -e "s/@title@/$2/" \
        -e "/^@css@\$/{r $parts/page.css" -e 'd}' \
        -e "/^@extra@\$/{r $parts/extra" -e 'd}' \
        -e "/^@script@\$/{r $parts/page.js" -e 'd}' page.html >"$parts/page.html"
    mv "$parts/page.html" "$out/$1.html"
    chmod a+r "$out/$1.html"
}

mkdir -p "$out"
: >"$parts/extra"
page campaign 'Downwash campaign' src/campaign/main.js src/campaign/page.css
page comparison 'Downwash comparison' src/comparison/main.js src/comparison/page.css
page validation 'Downwash validation' src/validation/main.js src/validation/page.css

# view3d SCRIPT: a bundle with three.js, packed, into $parts/extra.
view3d() {
    bundle "$1" --global-name=DownwashView3d --outfile="$parts/view3d.js" \
        --alias:three="$three/build/three.module.js" \
        --alias:orbit-controls="$three/examples/jsm/controls/OrbitControls.js"
    {
        echo '<script type="text/plain" id="downwash-view3d">'
        gzip -9n <"$parts/view3d.js" | base64 -w 0
        printf '\n</script>\n'
    } >"$parts/extra"
}

view3d src/view3d/app.js
page run 'Downwash run' src/main.js src/page.css
view3d src/view3d/space_app.js
page space 'Downwash flight in space' src/space/main.js src/space/page.css
view3d src/view3d/robot_app.js
page robot 'Downwash robot' src/robot/main.js src/robot/page.css
