#!/bin/sh
# SPDX-License-Identifier: MIT
# The commands of the tutorial. Usage: commands.sh TWINRAY FOLDER, in which robust_rays has written body.obj
set -eu
program=$1
twinray() { "$program" "$@"; }
cd "$2"

# [leaks]
twinray leaks body.obj --accel sw --ray-count 200000
# [verify]
twinray verify body.obj --level fast --replays faulty --quiet
# [replay]
twinray verify --replay faulty/edge-SW_LEAK-1.json > replay.txt
# [/replay]
grep -q "SW_LEAK of sw at level fast" replay.txt
if twinray leaks body.obj --accel sw --level fast --ray-count 20000 > fast.txt; then
    echo "level fast did not leak" >&2
    exit 1
fi
