#!/usr/bin/env bash
# Builds the page of a run, one HTML file without data: viewer/build.sh OUT.html
# Needs esbuild ($ESBUILD may name it), node-d3 and libjs-three of Debian; the same sources and packages give the same bytes.
set -euo pipefail

if [[ $# -ne 1 ]]; then
    echo "usage: viewer/build.sh OUT.html" >&2
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
bundle src/main.js --loader:.txt=text --outfile="$parts/page.js"
bundle src/page.css --outfile="$parts/page.css"
bundle src/view3d_app.js --global-name=DownwashView3d --outfile="$parts/view3d.js" \
    --alias:three="$three/build/three.module.js" \
    --alias:orbit-controls="$three/examples/jsm/controls/OrbitControls.js"

# esbuild writes these harmlessly; should that change, a broken page must not be built.
if grep -qiE '</?script|<!--' "$parts/page.js" || grep -qi '</style' "$parts/page.css"; then
    echo "viewer/build.sh: the bundle holds text that would end its own element" >&2
    exit 1
fi
gzip -9n <"$parts/view3d.js" | base64 -w 0 >"$parts/view3d.txt"
echo >>"$parts/view3d.txt"

# `r` copies files as they are: nothing in them is taken for a pattern.
sed -e "/^@css@\$/{r $parts/page.css" -e 'd}' \
    -e "/^@view3d@\$/{r $parts/view3d.txt" -e 'd}' \
    -e "/^@script@\$/{r $parts/page.js" -e 'd}' page.html >"$parts/page.html"
mkdir -p "$(dirname "$out")"
mv "$parts/page.html" "$out"
chmod a+r "$out"
