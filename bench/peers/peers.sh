#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Installs the packages that compare.py measures beside twinray into a folder of their own, and runs it.
#   bench/peers/peers.sh FOLDER TWINRAY [option of compare.py...]
set -euo pipefail
if (($# < 2)); then
    sed -n '3,4s/^# *//p' "${BASH_SOURCE[0]}" >&2
    exit 2
fi
folder=$1
shift
if [[ ! -x $folder/bin/python ]]; then python3 -m venv "$folder"; fi
"$folder/bin/pip" install --quiet numpy trimesh python-fcl rtree embreex pyvista pyviewfactor
"$folder/bin/python" "$(dirname "${BASH_SOURCE[0]}")/compare.py" "$@"
