#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# Installs the packages, builds, renders one scene with both accelerators and lets them check each other.
#   tools/demo.sh [SCENE.gltf]
# Without a scene it takes 2CylinderEngine.glb, a glTF model of the package assimp-testmodels; on systems without
# that package, the same file or else the first glTF file below $TWINRAY_ASSETS.
set -euo pipefail

bin=build/release/bin
out=out
render=("$bin/path_tracer" --width 640 --height 480 --spp 16 --seed 1)   # SCENE -o PICTURE --cross-check REPORT
verify=("$bin/twinray" verify --random 100000 --aimed 10000 --seed 1)     # SCENE
default_scene=2CylinderEngine.glb

installed_scene() { dpkg -L assimp-testmodels 2>/dev/null | grep "/$default_scene\$" || true; }
asset_scene() { find -L "${TWINRAY_ASSETS:-/nonexistent}" -type f "$@" 2>/dev/null | sort | sed -n 1p; }

choose_scene() {
    local scene
    scene=$(installed_scene)
    scene=${scene:-$(asset_scene -name "$default_scene")}
    scene=${scene:-$(asset_scene -name '*.gl[bt]*')}
    if [[ -z $scene ]]; then
        echo "demo: no scene found: install assimp-testmodels, set TWINRAY_ASSETS, or run tools/demo.sh SCENE.gltf" >&2
        exit 1
    fi
    echo "$scene"
}

scene=
if [[ $# -gt 1 || ${1-} == -* ]]; then
    echo "usage: tools/demo.sh [SCENE.gltf]" >&2
    exit 2
elif [[ $# == 1 ]]; then
    if [[ ! -r $1 ]]; then
        echo "demo: cannot read '$1'" >&2
        exit 1
    fi
    scene=$(realpath "$1")
fi

cd "$(dirname "${BASH_SOURCE[0]}")/.."
. tools/lib.sh

build release path_tracer twinray_cli
scene=${scene:-$(choose_scene)}
mkdir -p "$out"

fault=0
section "Render $(basename "$scene") with both accelerators, and compare every ray"
"${render[@]}" "$scene" -o "$out/demo.png" --cross-check "$out/demo_cross_check.txt" || fault=1

section "Verify: random and aimed rays, both accelerators against float64"
"${verify[@]}" "$scene" | tee "$out/demo_verify.txt" || fault=1

section "Results after $SECONDS s"
cat <<END
scene                   $scene
hardware picture        $PWD/$out/demo_hw.png
software picture        $PWD/$out/demo_sw.png
difference              $PWD/$out/demo_difference.png
verify                  $PWD/$out/demo_verify.txt
cross-check             $PWD/$out/demo_cross_check.txt
END
if ((fault)); then
    echo "demo: the checks above found a fault" >&2
    exit 1
fi
