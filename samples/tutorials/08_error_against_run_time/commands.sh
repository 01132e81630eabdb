#!/bin/sh
# SPDX-License-Identifier: MIT
# The commands of the tutorial on a part of the suite, in a folder of their own. Usage: commands.sh TWINRAY FOLDER
set -eu
program=$1
twinray() { "$program" "$@"; }
rm -rf "$2/report_of_a_driver"
mkdir -p "$2/report_of_a_driver"
cd "$2/report_of_a_driver"

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
