#!/bin/sh
# SPDX-License-Identifier: MIT
# Draws both pictures of the tutorial by gnuplot (Debian: gnuplot-nox) from what the programs have written to FOLDER.
# Without gnuplot it says so and ends with status 77. Usage: draw.sh FOLDER
set -eu
if ! command -v gnuplot > /dev/null; then
    echo "draw.sh: gnuplot is not installed; the figures are in $1/*.csv" >&2
    exit 77
fi
said=$(gnuplot -e "folder = '$1'" "$(dirname "$0")/draw.gp" 2>&1) || true
if [ -n "$said" ]; then
    echo "draw.gp: $said" >&2
    exit 1
fi
