#!/bin/sh
# SPDX-License-Identifier: MIT
# Commands of the tutorial, on a part of the suite, in a folder of their own. Usage: commands.sh WHICH TWINRAY FOLDER
#   commands     those of the steps
#   ci           a job of continuous integration
#   solutions    the solution of exercise 2
#   picture      draws the plot of lost rays for the tutorial's page; without gnuplot the status is 77
set -eu
program=$(realpath "$2")
twinray() { "$program" "$@"; }
folder=$(cd "$3" && pwd)
if [ "$1" != picture ]; then
    rm -rf "$folder/report_$1"
    mkdir -p "$folder/report_$1"
    cd "$folder/report_$1"
fi

case $1 in
commands)
    # [part]
    twinray report --only 'W02,L01,V01' -o monday
    # [/part]
    grep -q '"case":"W02".*"backend":"sw","level":"watertight".*"pass":true' monday/report.jsonl
    grep -q "Error of t against run time" monday/report.html

    # [compare]
    twinray report --only 'W02,L01,V01' -o tuesday --quiet
    twinray report --compare monday tuesday
    # [/compare]

    if ls monday/replays/W02-*.json > /dev/null 2>&1; then
        # [replay]
        set -- monday/replays/W02-*.json # $1 is the first
        twinray verify --replay "$1" --reproducer for_the_tracker > steps.txt
        # [/replay]
        grep -q "no fault of twinray" steps.txt
        grep -q "## The scene" for_the_tracker/report.md
        test -s for_the_tracker/reproducer.c
    else
        echo "case W02 has found no fault of this driver"
    fi
    ;;
ci)
    # [qualify]
    twinray qualify --only 'W0?,K0?' --junit qualify.xml --tap qualify.tap --sarif qualify.sarif -o qualified
    # [/qualify]
    grep -q '<testcase classname="W01" name="W01 sw watertight"/>' qualify.xml
    grep -q "^ok .* W01 sw watertight on " qualify.tap
    grep -q '"version": "2.1.0"' qualify.sarif
    ;;
solutions)
    # [exercise2]
    twinray report --only W02 -o right --quiet
    # Pretend that SwTlas found triangles that are not there, each time that it was right.
    sed '/"backend":"sw"/ s/"AGREE":/"SW_FALSE":/' right/report.jsonl > broken.jsonl
    if twinray report --compare right broken.jsonl; then
        echo "nobody would have noticed" >&2
        exit 1
    fi
    # [/exercise2]
    ;;
picture)
    command -v gnuplot > /dev/null || exit 77
    report=$(mktemp -d)
    trap 'rm -rf "$report"' EXIT
    twinray report --only 'W*' -o "$report" --quiet > "$report/verdict.txt"
    cp "$report/plots/leaks.svg" "$folder/08_report_leaks.svg"
    ;;
esac
