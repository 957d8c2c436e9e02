#!/usr/bin/env bash
# Checks how many files the changes of docs/extending touch: the table of its README has these numbers, and a kind of goal and
# an uncertainty stay as cheap as they are. Usage: tests/docs/check_extending.sh [root of the tree]
set -euo pipefail

root=$(cd "${1:-$(dirname "${BASH_SOURCE[0]}")/../..}" && pwd)
pages=$root/docs/extending
declare -A most=([goal_kind]=4 [uncertainty]=5)  # product files
errors=0

error() {
    printf '%s\n' "check_extending: $*" >&2
    errors=$((errors + 1))
}

for page in "$pages"/*.md; do
    name=$(basename "$page" .md)
    [[ $name != README ]] || continue
    mapfile -t files < <(sed -n 's|^diff --git a/\([^ ]*\) .*|\1|p' "$page" | LC_ALL=C sort -u)
    mapfile -t product < <(printf '%s\n' "${files[@]}" | grep -vE '^(tests|docs)/|\.md$' || true)
    row=$(grep -F "| [$name.md]($name.md) |" "$pages/README.md" || true)
    [[ -n $row ]] || { error "the table has no row for $name.md" && continue; }
    # | page | the example | files | of the product | before |
    said=$(awk -F ' *[|] *' '{ print $4 " " $5 }' <<<"$row")
    [[ $said == "${#files[@]} ${#product[@]}" ]] ||
        error "$name.md touches ${#files[@]} files, ${#product[@]} of the product; the table says $said"
    [[ ${#product[@]} -le ${most[$name]:-1000} ]] ||
        error "$name.md touches ${#product[@]} files of the product: expected at most ${most[$name]} (${product[*]})"
done
exit $((errors > 0))
