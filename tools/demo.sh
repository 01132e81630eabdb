#!/usr/bin/env bash
# Goes from a checkout to a picture: installs the packages, builds path_tracer and what it links, renders a scene with
# the faster accelerator of this device, and lets the other one check its rays.
#   tools/demo.sh [SCENE]         SCENE: .gltf, .glb, .obj, .ply or .stl; without it a sunflower of beads, made by formula
#   TWINRAY_DEMO_SECONDS=N        how long to render, default 100; a coarse picture exists after seconds
set -euo pipefail

bin=build/release/bin
out=out
picture=$out/demo.png
report=$out/demo_cross_check.txt
seconds=${TWINRAY_DEMO_SECONDS-100}

scene=builtin:sunflower
if [[ $# -gt 1 || ${1-} == -* ]]; then
    echo "usage: tools/demo.sh [SCENE]" >&2
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

build demo demo
mkdir -p "$out"

section "Render $(basename "$scene") for $seconds s"
"$bin/path_tracer" "$scene" -o "$picture" --width 960 --height 540 --time "$seconds" --seed 1 \
    --write-partial-images 30

section "Cross-check: every ray of a small picture by both accelerators, differences against float64"
fault=0
"$bin/path_tracer" "$scene" -o "$out/demo_small.png" --width 240 --height 135 --spp 2 --seed 1 \
    --cross-check "$report" || fault=1

section "Results after $SECONDS s"
cat <<END
picture                 $PWD/$picture
cross-check             $PWD/$report
small pictures of both  $PWD/$out/demo_small_hw.png, demo_small_sw.png, demo_small_difference.png
END
if ((fault)); then
    echo "demo: the cross-check found a fault" >&2
    exit 1
fi
