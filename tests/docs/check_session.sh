#!/usr/bin/env bash
# Whether a page quotes what the program prints: follows the page in a scratch folder.
# Usage: tests/docs/check_session.sh DOWNWASH PAGE
#   A fence that begins with "$ " and a command is run. Its lines have to appear in the output in their order; "..." stands for any lines.
#   Lines of a fence "yaml" go into my.yaml: "- {name: N" replaces that obstacle or is added after the fence's line before,
#   "key: value" replaces the line of that key. Those of a fence "yaml once" hold for the next command only.
#   A row "| `VARIANT` | first line | planned | executed | exit code |" is compared with what the page's command for that variant prints.
set -euo pipefail

program=$(realpath "$1")
root=$(cd -P "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)
page=$root/$2
folder=$(mktemp -d)
trap 'rm -rf "$folder"' EXIT
export XDG_CACHE_HOME=$folder/cache
mkdir "$folder/build"
ln -s "$program" "$folder/build/downwash"
ln -s "$root/problems" "$folder/problems"
cd "$folder"

checked=0
bad=0
complain() {
    bad=$((bad + 1))
    printf '%s\n' "${page#"$root/"}: $1" "${@:2}" >&2
}

# put LINE LINE_BEFORE: LINE into my.yaml, as the head of this file says.
put() {
    local key
    if [[ $1 =~ ^\ *-\ \{name:\ ([^,]+), ]]; then
        key="- {name: ${BASH_REMATCH[1]},"
    else
        key="${1%%:*}:"
    fi
    LINE=$1 BEFORE=$2 KEY=$key awk '
        index($0, ENVIRON["KEY"]) && !done { print ENVIRON["LINE"]; done = 1; next }
        { lines[NR] = $0; print }
        $0 == ENVIRON["BEFORE"] { after = NR }
        END { exit done ? 0 : 1 }' my.yaml >my.yaml.new ||
        LINE=$1 BEFORE=$2 awk '{ print } $0 == ENVIRON["BEFORE"] { print ENVIRON["LINE"]; done = 1 } END { exit done ? 0 : 1 }' \
            my.yaml >my.yaml.new || complain "nowhere to put '$1' in my.yaml"
    mv my.yaml.new my.yaml
}

# compare COMMAND OUTPUT QUOTED: every quoted line appears in the output, in the same order.
compare() {
    QUOTED=$3 awk '
        BEGIN { count = split(ENVIRON["QUOTED"], quoted, "\n"); next_one = 1 }
        { while (next_one <= count && (quoted[next_one] == "..." || quoted[next_one] ~ /^ *\.\.\.$/ || quoted[next_one] == "")) ++next_one }
        next_one <= count && $0 == quoted[next_one] { ++next_one }
        END {
            while (next_one <= count && quoted[next_one] == "") ++next_one
            if (next_one <= count) { print quoted[next_one]; exit 1 }
        }' <<<"$2" >missing || complain "$1 does not print '$(cat missing)' but" "$2"
}

run() { # COMMAND-LINE QUOTED
    local output
    checked=$((checked + 1))
    output=$(bash -c "$1" 2>&1) || true
    compare "$1" "$output" "$2"
    if [[ -e my.yaml.kept ]]; then
        mv my.yaml.kept my.yaml
    fi
}

variant() { # VARIANT FIRST-LINE PLANNED EXECUTED EXIT-CODE
    local output code=0
    checked=$((checked + 1))
    local solve
    solve=$(grep -xE "build/downwash solve problems/bridge_inspection.yaml --variant $1 .*" "$page")
    output=$(bash -c "$solve" 2>&1) || code=$?
    compare "$1" "$output" "$2"
    [[ $code == "$5" ]] || complain "$1 ends with $code, not $5"
    grep -qE "^  cost +${3%% J*} J planned, ${4%% J*} J " <<<"$output" || complain "$1 costs" "$(grep '^  cost' <<<"$output")"
}

build/downwash init my.yaml >/dev/null
kind='' quoted='' command='' before=''
while IFS= read -r line; do
    case $kind,$line in
        ,'```yaml once') kind=yaml && cp my.yaml my.yaml.kept && before='' ;;
        ,'```yaml') kind=yaml && before='' ;;
        ,'```'*) kind=session && command='' && quoted='' ;;
        yaml,'```') kind='' ;;
        session,'```')
            kind=''
            [[ -z $command ]] || run "$command" "$quoted"
            ;;
        yaml,*' {'*'}'* | yaml,'  '[a-z]*': '*)
            grep -qxF -e "$line" my.yaml || put "$line" "$before"
            before=$line
            ;;
        session,'$ '*) command=${line#"$ "} ;;
        session,*) quoted+=$line$'\n' ;;
        ,'| `mp-arm'*'` | '*' J'*)
            row=${line#"| "}
            IFS='|' read -r name first planned executed code _ <<<"${row//" | "/|}"
            code=${code%% *}
            variant "${name//\`/}" "$first" "$planned" "$executed" "$code"
            ;;
    esac
done <"$page"

((checked > 0)) || complain "no commands found"
echo "$checked commands, $bad of them differ"
((bad == 0))
