#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Makes files with the tools that people have and shows how twinray reads them: triangles, areas, hits (exporters.py).
# Tools come from npm and PyPI into FOLDER, several GB, and from apt (assimp-utils); it names missing ones. Not in CI.
#   tests/files/exporters.sh FOLDER [BIN]    BIN: the folder of path_tracer, build/release/bin if not given
set -euo pipefail
if (($# < 1)); then
    sed -n '5s/^# *//p' "${BASH_SOURCE[0]}" >&2
    exit 2
fi
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
bin=$(realpath "${2-$here/../../build/release/bin}")
mkdir -p "$1"
cd "$1"

# One at a time: a tool that does not install leaves the others in place.
install() { # venv version-of-numpy package...
    if [[ ! -x $1/bin/python ]]; then python3 -m venv "$1"; fi
    local package
    for package in "${@:3}"; do
        "$1/bin/pip" install --quiet --disable-pip-version-check "numpy==$2" "$package" ||
            echo "$package does not install"
    done
}

npm install --silent --no-audit --no-fund --prefix . @gltf-transform/cli@4.5.1 gltfpack@1.3.0 ||
    echo "npm does not install gltf-transform and gltfpack"
install venv 2.4.6 trimesh==5.2.0 rtree==1.4.1 scipy==1.17.1 pillow==13.0.0 openexr==3.5.3 open3d==0.20.0 \
    meshio==5.3.5 pyvista==0.49.1 pymeshlab==2025.7.post1 build123d==0.13.0 cascadio==0.1.1 \
    ifcopenshell==0.9.0.post1 pyradiance==1.3.1 "$here/../.."
install blender 1.26.4 bpy==5.0.1
if python3.13 -c "" 2>/dev/null && [[ ! -x newer_blender/bin/python ]]; then python3.13 -m venv newer_blender; fi
install newer_blender 2.4.6 bpy==5.2.3
PATH=$PWD/node_modules/.bin:$PATH exec venv/bin/python "$here/exporters.py" "$bin"
