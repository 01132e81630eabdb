#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Installs Mitsuba 3 and what renderers.py needs beside it into a folder of their own, and runs it.
#   bench/peers/renderers.sh FOLDER references|check|times TARGET [option of renderers.py...]
set -euo pipefail
if (($# < 3)); then
    sed -n '3,4s/^# *//p' "${BASH_SOURCE[0]}" >&2
    exit 2
fi
folder=$1
shift
if [[ ! -x $folder/bin/python ]]; then python3 -m venv "$folder"; fi
"$folder/bin/pip" install --quiet numpy scipy mitsuba
"$folder/bin/python" "$(dirname "${BASH_SOURCE[0]}")/renderers.py" "$@"
