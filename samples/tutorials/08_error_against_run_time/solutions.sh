#!/bin/sh
# SPDX-License-Identifier: MIT
# The solution of exercise 2. Usage: solutions.sh TWINRAY FOLDER
set -eu
program=$1
twinray() { "$program" "$@"; }
rm -rf "$2/broken_driver"
mkdir -p "$2/broken_driver"
cd "$2/broken_driver"

# [exercise2]
twinray report --only W02 -o right --quiet
# Pretend that SwTlas found triangles that are not there, each time that it was right.
sed '/"backend":"sw"/ s/"AGREE":/"SW_FALSE":/' right/report.jsonl > broken.jsonl
if twinray report --compare right broken.jsonl; then
    echo "nobody would have noticed" >&2
    exit 1
fi
# [/exercise2]
