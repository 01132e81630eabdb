#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# A good guess: row r of an environment map of n rows is seen around (r + 0.5) / n of the way from zenith to nadir, as
# column c of m is around (c + 0.5) / m of the circle. A sky map of two rows, white above black, lights a white floor.
# Seen: envmap of Mitsuba 3 takes columns so, but the first row for the zenith itself and the last one for the nadir:
# row r is at r / (n - 1). Of 8 rows, row 0 is brightest at 0 degrees and not at 11.25, row 3 at 77.14 and not at 78.75.
# The first row counts nothing where directions are weighed. A map whose first row alone is lit is seen by rays, but
# the floor under it stays black, with path and with direct, even by BSDF samples alone. The sky map of two rows is such
# a map: it is read as three rows, white, black and black. A meter that looks at this sky finds half of pi, not pi.
# Seen with mitsuba 3.9.1 (scalar_rgb) on 2026-11-30. Needs Python 3.12 or 3.13, 500 MB and no root.
folder=$(mktemp -d)
# shellcheck source=findings/checks.sh
. "$(dirname "${BASH_SOURCE[0]}")/checks.sh"
make_venv venv --no-deps mitsuba==3.9.1 drjit==1.5.0 numpy==2.4.6

cat >environment.py <<'END'
import sys

import mitsuba as mi
import numpy as np

mi.set_variant("scalar_rgb")
print("mitsuba", mi.__version__, file=sys.stderr)
transform = mi.ScalarTransform4f


def radiance(image, zenith_angles, azimuths):
    emitter = mi.load_dict({"type": "scene", "sky": {"type": "envmap", "bitmap": mi.Bitmap(image)}}).environment()
    seen = []
    for theta, phi in zip(*np.radians(np.broadcast_arrays(zenith_angles, azimuths)), strict=True):
        hit = mi.SurfaceInteraction3f()
        hit.wi = -mi.Vector3f(np.sin(theta) * np.sin(phi), np.cos(theta), -np.sin(theta) * np.cos(phi))
        seen.append(emitter.eval(hit)[0])
    return np.array(seen)


def middle(angles, values):
    """Returns the mean of the angles where it is brightest."""
    return np.mean(angles[values > values.max() * 0.9999])


def film(samples):
    return {
        "film": {
            "type": "hdrfilm",
            "width": 1,
            "height": 1,
            "rfilter": {"type": "box"},
            "pixel_format": "rgb",
        },
        "sampler": {"type": "independent", "sample_count": samples},
    }


def sky(image):  # y of the map is up; z is up here
    return {"type": "envmap", "bitmap": mi.Bitmap(image), "to_world": transform().rotate([1, 0, 0], 90)}


def meter(image):
    """Returns the irradiance of a plane that faces up, divided by pi."""
    gauge = {"type": "irradiancemeter", **film(40000)}
    plane = {"type": "rectangle", "sensor": gauge}
    scene = {"type": "scene", "integrator": {"type": "path"}, "sky": sky(image), "plane": plane}
    return np.array(mi.render(mi.load_dict(scene), seed=1)).ravel()[0] / np.pi


def floor(image, integrator):
    """Returns the radiance of a white floor, which is its irradiance divided by pi."""
    look = transform().look_at(origin=[5, 0, 3], target=[0, 0, 0], up=[0, 0, 1])
    camera = {"type": "perspective", "fov": 0.1, "to_world": look, **film(20000)}
    white = {"type": "diffuse", "reflectance": {"type": "rgb", "value": 1.0}}
    plane = {"type": "rectangle", "to_world": transform().scale(50), "bsdf": white}
    scene = {"type": "scene", "integrator": integrator, "sky": sky(image), "camera": camera, "plane": plane}
    return np.array(mi.render(mi.load_dict(scene), seed=1)).ravel()[0]


angles = np.arange(0, 180.001, 180 / 1120)
for row in range(8):
    image = np.zeros((8, 16, 3), np.float32)
    image[row] = 1
    print(f"row{row} {middle(angles, radiance(image, angles, 30.0)):.2f}")
for column in (2, 4, 9):
    image = np.zeros((8, 16, 3), np.float32)
    image[:, column] = 1
    azimuths = np.arange(0, 360, 0.25)
    print(f"column{column} {middle(azimuths, radiance(image, 90.0, azimuths)):.2f}")

integrators = {
    "path": {"type": "path"},
    "direct": {"type": "direct"},
    "emitter": {"type": "direct", "emitter_samples": 1, "bsdf_samples": 0},
    "bsdf": {"type": "direct", "emitter_samples": 0, "bsdf_samples": 1},
}
white = np.ones((2, 4, 3), np.float32)
halves = white.copy()
halves[1] = 0
top = np.zeros((16, 32, 3), np.float32)
top[0] = 1
for name, image in {"white": white, "halves": halves, "top": top}.items():
    print(f"{name}/meter {meter(image):.2f}")
    for how, integrator in integrators.items():
        print(f"{name}/{how} {floor(image, integrator):.2f}")
data = np.array(mi.traverse(mi.load_dict(sky(halves)))["data"])
print("rows", "".join(f"{value:g}" for value in data[:, 0, 0]))
print(f"zenith {radiance(top, [0.0], 0.0)[0]:.2f}")
END
venv/bin/python environment.py >results
seen() { grep "^$1 " results | cut -d' ' -f2; }
rows=(0.00 25.71 51.43 77.14 102.86 128.57 154.29 180.00)
for row in {0..7}; do
    same "degrees from the zenith where row $row of 8 is brightest" "$(seen "row$row")" "${rows[row]}"
done
same "degrees of the circle where column 2 of 16 is brightest" "$(seen column2)" 56.25
same "column 4" "$(seen column4)" 101.25
same "column 9" "$(seen column9)" 213.75
for how in path direct emitter bsdf; do
    holds "a white map of two rows lights the floor by 1 within 0.02 ($how)" \
        "$(awk -v x="$(seen "white/$how")" 'BEGIN { print (x >= 0.98 && x <= 1.02) }')"
    same "white above black ($how)" "$(seen "halves/$how")" 0.00
    same "only the first of 16 rows is white ($how)" "$(seen "top/$how")" 0.00
done
same "a meter under the white map" "$(seen white/meter)" 1.00
same "a meter under white above black" "$(seen halves/meter)" 0.50
same "how its column is read" "$(seen rows)" 100
same "radiance of the zenith, only the first of 16 rows is white" "$(seen zenith)" 1.00
conclude
