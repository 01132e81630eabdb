#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# A good guess: mj_multiRay(..., cutoff) is a sensor of that range. Its docstring in 4.0.0 says "Geoms further than
# cutoff are ignored", so a hit is never further than the cutoff, and a ball that hides the floor from mj_ray hides it
# here too.
# Seen: a ray goes down from z = 10 to a ball whose top is 5.5 away and to a plane that is 10 away. With a cutoff of 3,
# MuJoCo 4.0.0 takes the ball away and keeps the plane: the ray passes through the ball, and the plane at 10 is the hit.
# 3.17.0 says -1, no hit. In both versions the cutoff is no greatest distance: a slab of 20 x 20 x 0.2 that is 11.9
# away is hit at 11.9 with a cutoff of 1.
# Seen with mujoco 4.0.0 and 3.17.0 on 2026-11-30. Needs Python 3.12 or 3.13, 500 MB and no root.
folder=$(mktemp -d)
# shellcheck source=findings/checks.sh
. "$(dirname "${BASH_SOURCE[0]}")/checks.sh"
for version in 4.0.0 3.17.0; do
    make_venv "$version" "mujoco==$version" numpy==2.4.6 glfw==2.11.0 PyOpenGL==3.1.10
done

cat >cutoff.py <<'END'
import mujoco
import numpy as np

print("docstring", mujoco.mj_multiRay.__doc__.count("Geoms further than cutoff are ignored"))
geoms = {
    "ball": '<geom name="floor" type="plane" size="0 0 1"/><geom name="ball" type="sphere" size=".5" pos="0 0 4"/>',
    "slab": '<geom name="slab" type="box" size="10 10 .1"/>',
}
origin = {"ball": np.array([0.0, 0, 10]), "slab": np.array([0.0, 0, 12])}
down = np.array([0.0, 0, -1])
for scene, text in geoms.items():
    model = mujoco.MjModel.from_xml_string(f"<mujoco><worldbody>{text}</worldbody></mujoco>")
    data = mujoco.MjData(model)
    mujoco.mj_forward(model, data)
    geom, distance = np.full(1, -1, np.int32), np.zeros(1)
    name = lambda: model.geom(geom[0]).name if geom[0] >= 0 else "none"
    found = mujoco.mj_ray(model, data, origin[scene], down, None, 1, -1, geom)
    print(scene, "ray", name(), f"{found:g}")
    for cutoff in (1e10, 6, 3, 1):
        geom[:] = -1
        mujoco.mj_multiRay(model, data, origin[scene], down, None, 1, -1, geom, distance, None, 1, cutoff)
        print(scene, f"{cutoff:g}", name(), f"{distance[0]:g}")
END
for version in 4.0.0 3.17.0; do
    "$version/bin/python" cutoff.py >"results-$version"
    row() { grep "^$1 " "results-$version" | cut -d' ' -f3-; }
    if [[ $version == 4.0.0 ]]; then
        same "$version: the docstring says 'Geoms further than cutoff are ignored'" \
            "$(grep "^docstring" results-4.0.0 | cut -d" " -f2)" 1
    fi
    same "$version, ball: mj_ray" "$(row "ball ray")" "ball 5.5"
    same "$version, ball: no cutoff" "$(row "ball 1e+10")" "ball 5.5"
    same "$version, ball: cutoff 6" "$(row "ball 6")" "ball 5.5"
    seen="floor 10"
    if [[ $version == 3.17.0 ]]; then seen="none -1"; fi
    same "$version, ball: cutoff 3" "$(row "ball 3")" "$seen"
    same "$version, ball: cutoff 1" "$(row "ball 1")" "$seen"
    same "$version, slab: mj_ray" "$(row "slab ray")" "slab 11.9"
    same "$version, slab: cutoff 1" "$(row "slab 1")" "slab 11.9"
done
conclude
