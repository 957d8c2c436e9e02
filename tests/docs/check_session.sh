#!/usr/bin/env bash
# Whether a page quotes what the program prints: follows the page in a scratch folder.
# Usage: tests/docs/check_session.sh DOWNWASH PAGE
#   A fence that begins with "$ " and a command is run. Its lines have to appear in the output in their order; "..." stands for any lines.
#   The command has to end with 0 or, in a fence "text exit N", with N. In a fence "text about" numbers may differ: those of a search in
#   space change with the planner, and times with the machine.
#   A fence "yaml file NAME" is a file, and fences "yaml add" are its continuation. Lines of a fence "yaml" go into the last such file, or into my.yaml:
#   "- {name: N" replaces that obstacle or is added after the fence's line before, "key: value" replaces the line of that key.
#   Those of a fence "yaml once" hold for the next command only.
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
ln -s "$root/tests" "$folder/tests"
cd "$folder"

checked=0
bad=0
edited=my.yaml # the file that fences "yaml" change
complain() {
    bad=$((bad + 1))
    printf '%s\n' "${page#"$root/"}: $1" "${@:2}" >&2
}

# put LINE LINE_BEFORE: LINE into the file, as the head of this file says.
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
        END { exit done ? 0 : 1 }' "$edited" >edited.new ||
        LINE=$1 BEFORE=$2 awk '{ print } $0 == ENVIRON["BEFORE"] { print ENVIRON["LINE"]; done = 1 } END { exit done ? 0 : 1 }' \
            "$edited" >edited.new || complain "nowhere to put '$1' in $edited"
    mv edited.new "$edited"
}

# compare COMMAND OUTPUT QUOTED [about]: every quoted line appears in the output, in the same order.
compare() {
    QUOTED=$3 ABOUT=${4:-} awk '
        function shape(line) {
            if (ENVIRON["ABOUT"] != "") gsub(/[-+]?[0-9]+(\.[0-9]+)?(e[-+]?[0-9]+)?/, "0", line)
            return line
        }
        BEGIN { count = split(ENVIRON["QUOTED"], quoted, "\n"); next_one = 1 }
        { while (next_one <= count && (quoted[next_one] == "..." || quoted[next_one] ~ /^ *\.\.\.$/ || quoted[next_one] == "")) ++next_one }
        next_one <= count && shape($0) == shape(quoted[next_one]) { ++next_one }
        END {
            while (next_one <= count && quoted[next_one] == "") ++next_one
            if (next_one <= count) { print quoted[next_one]; exit 1 }
        }' <<<"$2" >missing || complain "$1 does not print '$(cat missing)' but" "$2"
}

run() { # COMMAND-LINE QUOTED EXIT-CODE [about]
    local output code=0
    checked=$((checked + 1))
    output=$(bash -c "$1" 2>&1) || code=$?
    [[ $code == "$3" ]] || complain "$1 ends with $code, not $3" "$output"
    compare "$1" "$output" "$2" "${4:-}"
    if [[ -e kept.yaml ]]; then
        mv kept.yaml "$edited"
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

kind='' quoted='' command='' before='' code=0 about=''
while IFS= read -r line; do
    case $kind,$line in
        ,'```yaml file '*) kind='file' && edited=${line#'```yaml file '} && : >"$edited" ;;
        ,'```yaml add') kind='file' ;;
        ,'```yaml once') kind=yaml && cp "$edited" kept.yaml && before='' ;;
        ,'```yaml') kind=yaml && before='' ;;
        ,'```'*)
            kind=session command='' quoted='' code=0 about=''
            [[ ! $line =~ 'exit '([0-9]+) ]] || code=${BASH_REMATCH[1]}
            [[ $line != *about* ]] || about=about
            ;;
        file,'```' | yaml,'```') kind='' ;;
        file,*) printf '%s\n' "$line" >>"$edited" ;;
        session,'```')
            kind=''
            [[ -z $command ]] || run "$command" "$quoted" "$code" "$about"
            ;;
        yaml,*' {'*'}'* | yaml,'  '[a-z]*': '*)
            grep -qxF -e "$line" "$edited" || put "$line" "$before"
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
