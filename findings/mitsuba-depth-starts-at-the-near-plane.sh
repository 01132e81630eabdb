#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# A good guess: the depth AOV of Mitsuba 3 is the distance from the camera, as its page says ("Distance from the
# pinhole"), and near_clip only decides which surfaces are cut away.
# Seen: depth starts at the near plane. A wall 2 m in front of the camera has depth 1.99 with the default near_clip of
# 0.01, 1.5 with 0.5 and 1 with 1. A camera that is turned by 45 degrees, 2.828 m from the wall, sees 1.828 with 1. The
# depth integrator gives the same. The position AOV of the same render is right.
# Seen with mitsuba 3.9.1 (scalar_rgb) on 2026-11-30. Needs Python 3.12 or 3.13, 500 MB and no root.
folder=$(mktemp -d)
# shellcheck source=findings/checks.sh
. "$(dirname "${BASH_SOURCE[0]}")/checks.sh"
make_venv venv --no-deps mitsuba==3.9.1 drjit==1.5.0 numpy==2.4.6

cat >depth.py <<'END'
import sys

import mitsuba as mi
import numpy as np

mi.set_variant("scalar_rgb")
print("mitsuba", mi.__version__, file=sys.stderr)
transform = mi.ScalarTransform4f


def see(integrator, turn, near):
    """Renders a pixel of a camera at the origin, turned by some degrees from the axis of the wall at z = -2."""
    target = [np.tan(np.radians(turn)), 0, -1]
    camera = {
        "type": "perspective",
        "fov": 0.01,
        "to_world": transform().look_at(origin=[0, 0, 0], target=target, up=[0, 1, 0]),
        "sampler": {"type": "independent", "sample_count": 1},
        "film": {
            "type": "hdrfilm",
            "width": 1,
            "height": 1,
            "rfilter": {"type": "box"},
            "pixel_format": "rgb",
        },
    }
    if near:
        camera["near_clip"] = near
    wall = {"type": "rectangle", "to_world": transform().translate([0, 0, -2]).scale(10)}
    scene = mi.load_dict({"type": "scene", "integrator": integrator, "camera": camera, "wall": wall})
    return np.array(mi.render(scene, seed=0)).ravel()


for turn in (0, 45):
    for near in (0, 0.5, 1):
        depth, *position = see({"type": "aov", "aovs": "depth:depth,p:position"}, turn, near)
        alone = see({"type": "depth"}, turn, near)[0]
        print(f"{turn}/{near} {depth:.3f} {alone:.3f} {np.linalg.norm(position):.3f}")
END
venv/bin/python depth.py >results
row() { grep "^$1 " results | cut -d' ' -f"$2"; }
straight=(1.990 1.500 1.000)
turned=(2.818 2.328 1.828)
nears=(0 0.5 1)
for i in 0 1 2; do
    near=${nears[i]}
    same "depth AOV, near_clip $near (0: the default)" "$(row "0/$near" 2)" "${straight[i]}"
    same "depth integrator there" "$(row "0/$near" 3)" "${straight[i]}"
    same "length of the position AOV there" "$(row "0/$near" 4)" 2.000
    same "depth AOV of the turned camera, near_clip $near" "$(row "45/$near" 2)" "${turned[i]}"
    same "length of the position AOV there" "$(row "45/$near" 4)" 2.828
done
conclude
