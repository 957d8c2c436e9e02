#!/usr/bin/env bash
# Unpacks arm64 packages of Debian 12, and what they depend on, into a folder. The system itself is left as it is.
# Usage: sysroot.sh FOLDER PACKAGE...
set -euo pipefail

folder=$1
shift
packages=$(printf '%s,' libc6-dev libstdc++-12-dev "$@")

if [[ -e $folder/packages && $(<"$folder/packages") == "$packages" ]]; then
    exit 0
fi
rm -rf "$folder"
mkdir -p "$(dirname "$folder")"
mmdebstrap --quiet --variant=extract --architectures=arm64 --include="${packages%,}" \
    --aptopt='Apt::Install-Recommends "false"' bookworm "$folder"
folder=$(realpath "$folder")
libraries=$folder/usr/lib/aarch64-linux-gnu

# Packages are unpacked only, not set up: the alternatives of BLAS and LAPACK are chosen here.
for name in blas lapack; do
    for suffix in .so .so.3; do
        provided=$(find "$libraries" -mindepth 2 -name "lib$name$suffix" | LC_ALL=C sort | head -n 1)
        [[ -z $provided ]] || ln -sfr "$provided" "$libraries/lib$name$suffix"
    done
done
# Absolute links and paths mean this folder, not the system.
find "$folder/usr" "$folder/lib" -type l -lname '/*' | while read -r link; do
    ln -sfr "$folder$(readlink "$link")" "$link"
done
find "$folder/usr/share/ompl" "$libraries/ccd" "$libraries/cmake" -name '*.cmake' -print0 |
    xargs -r0 sed -i -E "s#([ ;\"])(/usr/(lib/aarch64-linux-gnu/lib|include))#\1$folder\2#g"
printf '%s' "$packages" >"$folder/packages"
