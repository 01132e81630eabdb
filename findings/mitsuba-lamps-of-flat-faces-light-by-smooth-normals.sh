#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# A good guess: a lamp that is a PLY mesh without normals lights a floor as its flat faces do, and sampling the lamp or
# sampling the floor's BSDF gives the same light, only with more or less noise.
# Seen: Mitsuba 3 makes smooth normals for a mesh that has none, and a lamp's share of light hangs on them. A regular
# octahedron of radiance 1 above a white floor should give it a radiance of 0.1366 (the contour integral of its lower
# faces). The direct integrator gives 0.162 by emitter samples and 0.109 by BSDF samples, path gives 0.130. With
# face_normals all of them give 0.137. Samples of the lamp are weighed by the angle to the smooth normal, and a
# face that looks at the floor, but whose smooth normal does not, is seen dark.
# Seen with mitsuba 3.9.1 (scalar_rgb) on 2026-11-30. Needs Python 3.12 or 3.13, 500 MB and no root.
folder=$(mktemp -d)
# shellcheck source=findings/checks.sh
. "$(dirname "${BASH_SOURCE[0]}")/checks.sh"
make_venv venv --no-deps mitsuba==3.9.1 drjit==1.5.0 numpy==2.4.6

cat >lamp.py <<'END'
import sys

import mitsuba as mi
import numpy as np

mi.set_variant("scalar_rgb")
print("mitsuba", mi.__version__, file=sys.stderr)
transform = mi.ScalarTransform4f
corners = np.array([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]])
faces = [[0, 2, 4], [2, 1, 4], [1, 3, 4], [3, 0, 4], [2, 0, 5], [1, 2, 5], [3, 1, 5], [0, 3, 5]]
with open("lamp.ply", "w") as file:
    file.write("ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float z\n")
    file.write("element face 8\nproperty list uchar int vertex_indices\nend_header\n")
    for corner in corners:
        file.write(" ".join(map(str, corner)) + "\n")
    for face in faces:
        file.write("3 " + " ".join(map(str, face)) + "\n")

# Lambert's contour integral for the faces that look at the origin: radiance of a white floor there.
exact = 0
for face in faces:
    a, b, c = corners[face] + [0, 0, 2]
    if np.dot(np.cross(b - a, c - a), a) >= 0:
        continue
    for p, q in ((a, c), (c, b), (b, a)):  # clockwise as seen from below
        across = np.cross(p, q)
        angle = np.arctan2(np.linalg.norm(across), np.dot(p, q))
        exact += angle * across[2] / np.linalg.norm(across) / (2 * np.pi)
print(f"exact {abs(exact):.4f}")


def floor(integrator, flat):
    look = transform().look_at(origin=[5, 0, 0.5], target=[0, 0, 0], up=[0, 0, 1])
    camera = {
        "type": "perspective",
        "fov": 0.1,
        "to_world": look,
        "sampler": {"type": "independent", "sample_count": 400000},
        "film": {
            "type": "hdrfilm",
            "width": 1,
            "height": 1,
            "rfilter": {"type": "box"},
            "pixel_format": "rgb",
        },
    }
    white = {"type": "diffuse", "reflectance": {"type": "rgb", "value": 1.0}}
    black = {"type": "diffuse", "reflectance": {"type": "rgb", "value": 0.0}}
    lamp = {
        "type": "ply",
        "filename": "lamp.ply",
        "face_normals": flat,
        "to_world": transform().translate([0, 0, 2]),
        "bsdf": black,
        "emitter": {"type": "area", "radiance": {"type": "rgb", "value": 1.0}},
    }
    scene = {
        "type": "scene",
        "integrator": integrator,
        "camera": camera,
        "floor": {"type": "rectangle", "to_world": transform().scale(50), "bsdf": white},
        "lamp": lamp,
    }
    return np.array(mi.render(mi.load_dict(scene), seed=1)).ravel()[0]


for name, flat in (("made", False), ("flat", True)):
    emitter = floor({"type": "direct", "emitter_samples": 1, "bsdf_samples": 0}, flat)
    bsdf = floor({"type": "direct", "emitter_samples": 0, "bsdf_samples": 1}, flat)
    path = floor({"type": "path"}, flat)
    print(f"{name} {emitter:.4f} {bsdf:.4f} {path:.4f}")
END
venv/bin/python lamp.py >results
cat results
near() { # what, seen, stated
    holds "$1 within 2 %" "$(awk -v x="$2" -v y="$3" 'BEGIN { print (x > 0.98 * y && x < 1.02 * y) }')"
}
seen() { grep "^$1 " results | cut -d' ' -f"$2"; }
same "exact radiance of the floor" "$(seen exact 2)" 0.1366
near "no normals in the file, emitter samples: 0.162" "$(seen made 2)" 0.162
near "BSDF samples: 0.109" "$(seen made 3)" 0.109
near "path: 0.130" "$(seen made 4)" 0.130
near "face_normals, emitter samples: 0.1366" "$(seen flat 2)" 0.1366
near "BSDF samples: 0.1366" "$(seen flat 3)" 0.1366
near "path: 0.1366" "$(seen flat 4)" 0.1366
conclude
