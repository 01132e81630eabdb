#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# A good guess: a rotation about its own centre changes nothing of a sphere lamp. Its normals point outwards where a ray
# meets it and where it is sampled, and a particle tracer and a path tracer make one picture of it.
# Seen: with a rotation in to_world, sample_position() of a sphere rotates its points and not its normals. After half a
# turn about z, 71 % of the points have a normal that points into the sphere, and 67 % of the rays by sample_ray() of
# its lamp start into it. Half a turn leaves a wall beside it black by "ptracer", a quarter of a turn leaves 0.4 of its
# light. "path", which samples spheres in another way, is right. Spheres that are moved and scaled are right.
# A cylinder scaled by -1 in x has its normals outwards for rays and inwards in samples: it shines at the camera with 1,
# and lights the wall by 0.1 in "direct" with samples of lamps alone, and by 1.0 with samples of the BSDF alone.
# Seen with Mitsuba 3.9.1 (scalar_rgb) on 2026-11-30. Needs Python 3.12 or 3.13 and no root.
folder=$(mktemp -d)
# shellcheck source=findings/checks.sh
. "$(dirname "${BASH_SOURCE[0]}")/checks.sh"
make_venv venv mitsuba==3.9.1 drjit==1.5.0 numpy==2.5.5

cat >lamps.py <<'END'
import mitsuba as mi
import numpy as np

mi.set_variant("scalar_rgb")
mi.set_log_level(mi.LogLevel.Error)
T = mi.ScalarTransform4f
results = open("results", "w")
lamp = {"type": "area", "radiance": {"type": "rgb", "value": 1.0}}


def sphere(name, to_world):
    shape = mi.load_dict({"type": "sphere", "to_world": to_world, "emitter": lamp})
    middle = np.array(to_world @ mi.ScalarPoint3f(0, 0, 0)).ravel()
    inward = np.zeros(2)
    side = 48
    numbers = (np.arange(side) + 0.5) / side
    random = np.random.default_rng(1)
    for u in numbers:
        for v in numbers:
            found = shape.sample_position(0.0, mi.Point2f(u, v))
            ray = shape.emitter().sample_ray(0.0, 0.5, mi.Point2f(u, v), mi.Point2f(*random.random(2)))[0]
            inward[0] += np.dot(np.array(found.n), np.array(found.p) - middle) < 0
            inward[1] += np.dot(np.array(ray.d), np.array(ray.o) - middle) < 0
    met = mi.load_dict({"type": "scene", "sphere": shape}).ray_intersect(
        mi.Ray3f(list(middle + [9, 0.1, 0.2]), [-1, 0, 0])
    )
    outside = np.dot(np.array(met.n), np.array(met.p) - middle) > 0
    shares = [f"{count / side**2:.2f}" for count in inward]
    print(name, "out" if outside else "in", *shares, sep="|", file=results)


def light(kind, to_world, integrator):
    wall = T().translate([2, 0, 0]).rotate([0, 1, 0], -90).scale(2)
    scene = mi.load_dict(
        {
            "type": "scene",
            "lamp": {"type": kind, "to_world": to_world, "emitter": lamp},
            "wall": {"type": "rectangle", "to_world": wall, "bsdf": {"type": "diffuse"}},
        }
    )
    sensor = mi.load_dict(  # between both, looks at the wall
        {
            "type": "perspective",
            "fov": 90,
            "to_world": T().look_at([1.2, 0, 0], [2, 0, 0], [0, 0, 1]),
            "film": {"type": "hdrfilm", "width": 8, "height": 8, "rfilter": {"type": "box"}},
            "sampler": {"type": "independent", "sample_count": 4096},
        }
    )
    met = scene.ray_intersect(mi.Ray3f([1.5, 0.1, 0.2], [-1, 0, 0]))
    picture = np.array(mi.render(scene, sensor=sensor, integrator=mi.load_dict(integrator), seed=1))
    return picture.mean(), met.emitter(scene).eval(met)[0]


quarter, half = T().rotate([0, 0, 1], 90), T().rotate([0, 0, 1], 180)
sphere("plain", T())
sphere("moved and scaled", T().translate([1, 2, 3]).scale(2))
sphere("quarter", quarter)
sphere("half", half)
path = {"type": "path", "max_depth": 2}
particles = {"type": "ptracer", "max_depth": 2}
plain = light("sphere", T(), path)[0]
for name, turn in {"plain": T(), "quarter": quarter, "half": half}.items():
    shares = [f"{light('sphere', turn, way)[0] / plain:.1f}" for way in (path, particles)]
    print(f"light {name}", *shares, sep="|", file=results)
lamps = {"type": "direct", "emitter_samples": 1, "bsdf_samples": 0}
bsdf = {"type": "direct", "emitter_samples": 0, "bsdf_samples": 1}
plain = light("cylinder", T(), bsdf)[0]
for name, change in {"plain": T(), "mirrored": T().scale([-1, 1, 1])}.items():
    seen = light("cylinder", change, lamps)[1]
    shares = [f"{light('cylinder', change, way)[0] / plain:.1f}" for way in (lamps, bsdf)]
    print(f"cylinder {name}", f"{seen:g}", *shares, sep="|", file=results)
END
venv/bin/python lamps.py >log # with bars of progress
column() { grep "^$1|" results | cut -d'|' -f"$2"; }
for name in plain "moved and scaled" quarter half; do
    same "sphere, $name: normal where a ray meets it" "$(column "$name" 2)" out
done
for name in plain "moved and scaled"; do
    same "sphere, $name: samples with a normal inwards" "$(column "$name" 3)" 0.00
    same "sphere, $name: rays of the lamp that start inwards" "$(column "$name" 4)" 0.00
done
same "half a turn: samples with a normal inwards" "$(column half 3)" 0.71
same "half a turn: rays of the lamp that start inwards" "$(column half 4)" 0.67
same "light on the wall by path, half a turn, of none" "$(column 'light half' 2)" 1.0
same "light by ptracer, no turn, of path's" "$(column 'light plain' 3)" 1.0
same "light by ptracer, a quarter turn" "$(column 'light quarter' 3)" 0.4
same "light by ptracer, half a turn" "$(column 'light half' 3)" 0.0
same "radiance of a plain cylinder as a ray sees it" "$(column 'cylinder plain' 2)" 1
same "radiance of a mirrored cylinder as a ray sees it" "$(column 'cylinder mirrored' 2)" 1
same "light on the wall by samples of a plain cylinder, of BSDF's" "$(column 'cylinder plain' 3)" 1.0
same "light by samples of the mirrored cylinder" "$(column 'cylinder mirrored' 3)" 0.1
same "light by samples of the BSDF, mirrored cylinder" "$(column 'cylinder mirrored' 4)" 1.0
conclude
