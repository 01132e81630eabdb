#!/bin/sh
# SPDX-License-Identifier: MIT
# The plot of lost rays of a short report, for the tutorial's page. Without gnuplot, which draws it, the status is 77.
# Usage: draw_report.sh TWINRAY FOLDER
set -eu
command -v gnuplot > /dev/null || exit 77
report=$(mktemp -d)
trap 'rm -rf "$report"' EXIT
"$1" report --only 'W*' -o "$report" --quiet > "$report/verdict.txt"
cp "$report/plots/leaks.svg" "$2/08_report_leaks.svg"
