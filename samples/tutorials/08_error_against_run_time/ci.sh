#!/bin/sh
# SPDX-License-Identifier: MIT
# A job of continuous integration. Usage: ci.sh TWINRAY FOLDER
set -eu
program=$1
twinray() { "$program" "$@"; }
rm -rf "$2/job"
mkdir -p "$2/job"
cd "$2/job"

# [qualify]
twinray qualify --only 'W0?,K0?' --junit qualify.xml --tap qualify.tap --sarif qualify.sarif -o qualified
# [/qualify]
grep -q '<testcase classname="W01" name="W01 sw watertight"/>' qualify.xml
grep -q "^ok .* W01 sw watertight on " qualify.tap
grep -q '"version": "2.1.0"' qualify.sarif
