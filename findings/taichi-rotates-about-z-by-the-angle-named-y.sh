#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# A good guess: taichi.math has one convention. rotation2d rotates counter-clockwise, translate moves column vectors, so
# rot_by_axis((0, 0, 1), angle) @ v rotates counter-clockwise, too; and rotation3d's arguments ang_x, ang_y, ang_z are,
# as its documentation says, angles around X, Y and Z.
# Seen: rotation2d takes (1, 0) to (0, 1) for 90 degrees, and rot_by_axis about +z takes (1, 0, 0) to (0, -1, 0): it is
# the inverse. rotation3d exchanges two of its angles: ang_y rotates about z, and ang_z about y, both clockwise as well;
# ang_x rotates about x, clockwise. So rotation3d(0, 0, angle) leaves y where it is and moves z.
# Seen with taichi 1.7.4, and quadrants 1.3.3, a fork of it, on 2026-11-30. Needs Python 3.12 or 3.13,
# 800 MB and no root.
folder=$(mktemp -d)
# shellcheck source=findings/checks.sh
. "$(dirname "${BASH_SOURCE[0]}")/checks.sh"
make_venv venv taichi==1.7.4 quadrants==1.3.3 numpy==2.5.5 \
    colorama==0.4.6 dill==0.4.1 rich==15.0.0 pydantic==2.14.4 cffi==2.1.1 setuptools==84.2.1

cat >rotations.py <<'END'
import importlib
import sys

import numpy as np

ti = importlib.import_module(sys.argv[1])
tm = ti.math

ti.init(arch=ti.cpu, log_level=ti.ERROR, offline_cache=False)


@ti.kernel
def in_the_plane(angle: ti.f32) -> tm.vec2:
    return tm.rotation2d(angle) @ tm.vec2(1, 0)


@ti.kernel
def about(axis: tm.vec3, angle: ti.f32) -> tm.mat4:
    return tm.rot_by_axis(axis, angle)


@ti.kernel
def by_angles(x: ti.f32, y: ti.f32, z: ti.f32) -> tm.mat4:
    return tm.rotation3d(x, y, z)


@ti.kernel
def moved() -> tm.vec4:
    return tm.translate(1.0, 2.0, 3.0) @ tm.vec4(0, 0, 0, 1)


def right_handed(axis, angle):  # Rodrigues' formula, for column vectors
    x, y, z = axis
    cross = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * cross + (1 - np.cos(angle)) * cross @ cross


def name(matrix):
    for k, label in enumerate("xyz"):
        for sign in (1, -1):
            if np.allclose(matrix, right_handed(np.eye(3)[k], sign * angle), atol=1e-5):
                return f"about {label}, " + ("counter-clockwise" if sign > 0 else "clockwise")
    return "else"


def points(vector):
    return " ".join(str(round(float(c))) for c in vector)


angle = np.pi / 2
print("version", *ti.__version__)
print("plane", points(in_the_plane(angle)))
print("moved", points(moved()))
rotated = about(tm.vec3(0, 0, 1), angle).to_numpy() @ np.array([1, 0, 0, 1])
print("rotated", points(rotated[:3]))
for k, label in enumerate("xyz"):
    axis = np.eye(3)[k]
    print("axis_" + label, name(about(tm.vec3(*axis.tolist()), angle).to_numpy()[:3, :3]))
    print("ang_" + label, name(by_angles(*(angle * axis).tolist()).to_numpy()[:3, :3]))
END
row() { grep "^$1 " results | cut -d' ' -f2-; }
for library in taichi quadrants; do
    venv/bin/python rotations.py "$library" >results
    if [[ $library == taichi ]]; then version="1 7 4"; else version="1 3 3"; fi
    same "version of $library" "$(row version)" "$version"
    same "rotation2d(90 degrees) @ (1, 0)" "$(row plane)" "0 1"
    same "translate(1, 2, 3) @ (0, 0, 0, 1)" "$(row moved)" "1 2 3 1"
    same "rot_by_axis((0, 0, 1), 90 degrees) @ (1, 0, 0, 1)" "$(row rotated)" "0 -1 0"
    same "rot_by_axis((1, 0, 0), 90 degrees) rotates" "$(row axis_x)" "about x, clockwise"
    same "rot_by_axis((0, 1, 0), 90 degrees) rotates" "$(row axis_y)" "about y, clockwise"
    same "rot_by_axis((0, 0, 1), 90 degrees) rotates" "$(row axis_z)" "about z, clockwise"
    same "rotation3d(90 degrees, 0, 0) rotates" "$(row ang_x)" "about x, clockwise"
    same "rotation3d(0, 90 degrees, 0) rotates" "$(row ang_y)" "about z, clockwise"
    same "rotation3d(0, 0, 90 degrees) rotates" "$(row ang_z)" "about y, clockwise"
done
conclude
