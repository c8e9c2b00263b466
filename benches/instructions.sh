#!/usr/bin/env bash
# Instructions a toss (launch, block of random numbers), counted by valgrind's callgrind. Unlike
# times, counts are the same on a busy machine, so a few per cent are visible.
#
#   benches/instructions.sh            prints a table
#   benches/instructions.sh --check    and fails where a count is more than 3 % above the baseline
#   benches/instructions.sh --update   and writes the baseline, benches/instructions.csv
#
# Counts depend on the compiler: the baseline names the one it was made with. Without valgrind
# nothing is counted, which is said, and is no failure.
#
#   COUNT       how often each piece of work is done      [4000]; tosses in space a tenth as often
#   TOLERANCE   per cent above the baseline that pass     [3]
set -euo pipefail
cd "$(dirname "${BASH_SOURCE[0]}")/.."

mode=${1:-}
case $mode in
'' | --check | --update) ;;
*)
    echo "usage: benches/instructions.sh [--check | --update]" >&2
    exit 2
    ;;
esac

if ! command -v valgrind >/dev/null; then
    echo "SKIPPED: valgrind is not installed"
    exit 0
fi

baseline=benches/instructions.csv
count=${COUNT:-4000}
tolerance=${TOLERANCE:-3}
compiler=$(rustc --version)
target=$(rustc --version --verbose | sed -n 's/^host: //p')

cargo build --quiet --release --package coinmc-bench
directory=$(cargo metadata --format-version 1 --no-deps |
    sed -n 's/.*"target_directory":"\([^"]*\)".*/\1/p')
program=$directory/release/coinmc-bench

instructions() { # name, count
    local log
    if ! log=$(valgrind --tool=callgrind --callgrind-out-file=/dev/null \
        "$program" work "$1" --count "$2" 2>&1); then
        echo "$log" >&2
        return 1
    fi
    # "==123== Collected : 456"
    sed -n 's/^==[0-9]*== Collected : \([0-9]*\)$/\1/p' <<<"$log"
}

recorded=
if [[ -e $baseline ]]; then
    recorded=$(sed -n 's/^# //p' "$baseline")
fi
header="$compiler, $target"
echo "compiler  $header"
echo "baseline  ${recorded:-none}"
if [[ -n $recorded && $recorded != "$header" ]]; then
    echo "note: the baseline was made with another compiler; differences may be the compiler's"
fi
printf '%-55s %12s %12s %8s\n' work instructions baseline change

rows=() failed=0
while IFS= read -r name; do
    # what is done before and after the work does not count
    start=$(instructions "$name" 0)
    times=$count
    # in space: tens of times the work
    case $name in 'toss clean '* | 'toss table1 '* | 'toss hand '*) times=$((count / 10)) ;; esac
    whole=$(instructions "$name" "$times")
    each=$(awk -v a="$whole" -v b="$start" -v n="$times" 'BEGIN { printf "%.1f", (a - b) / n }')
    before=
    if [[ -e $baseline ]]; then
        before=$(awk -F, -v name="$name" '$1 == name { print $2 }' "$baseline")
    fi
    change=
    if [[ -n $before ]]; then
        change=$(awk -v a="$each" -v b="$before" 'BEGIN { printf "%+.1f%%", 100 * (a / b - 1) }')
    fi
    mark=
    if [[ $mode == --check ]]; then
        if [[ -z $before ]]; then
            mark='  NOT IN THE BASELINE' failed=1
        elif awk -v a="$each" -v b="$before" -v t="$tolerance" \
            'BEGIN { exit !(a > b * (1 + t / 100)) }'; then
            mark='  TOO MANY' failed=1
        fi
    fi
    printf '%-55s %12s %12s %8s%s\n' "$name" "$each" "$before" "$change" "$mark"
    rows+=("$name,$each")
done < <("$program" work)

if [[ $mode == --update ]]; then
    {
        echo "# $header"
        echo "work,instructions"
        printf '%s\n' "${rows[@]}"
    } >"$baseline"
    echo "wrote $baseline"
fi
if ((failed)); then
    echo "FAILED: above the baseline by more than $tolerance %, or not in it (--update accepts)"
    exit 1
fi
