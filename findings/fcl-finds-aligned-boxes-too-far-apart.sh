#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# A good guess: fcl.distance of two boxes of 1 x 1 x 1, whose centres are 3 apart along an axis, is 2 along each axis,
# to the tolerance of its solver. That of the same boxes as meshes (BVHModel) is 2.
# Seen: it is 2 along x and 2.2361 along y and along z, without an error. At 10 along z it is 9.0554 for 9, and aside by
# (0.5, 0.5) it is 2.1213 for 2. Two cylinders of radius 0.5 and length 1, one above the other, are 2.2361 apart, too.
# It is right at 2 along z (1), and aside by 0.001 (2.0000). Both solvers, GST_LIBCCD and GST_INDEP, say the same, and
# meshes are right everywhere.
# Seen with python-fcl 0.7.0.11 and 0.7.0.8 on 2026-11-30. Needs Python 3.12 or 3.13, 300 MB and no root.
folder=$(mktemp -d)
# shellcheck source=findings/checks.sh
. "$(dirname "${BASH_SOURCE[0]}")/checks.sh"
for version in 0.7.0.11 0.7.0.8; do
    make_venv "$version" --only-binary :all: "python-fcl==$version" \
        numpy==2.4.6
done

cat >apart.py <<'END'
import itertools

import fcl
import numpy as np

corners = np.array(list(itertools.product([-0.5, 0.5], repeat=3)))
faces = np.array([[0, 1, 3], [0, 3, 2], [4, 6, 7], [4, 7, 5], [0, 4, 5], [0, 5, 1], [2, 3, 7], [2, 7, 6], [0, 2, 6],
                  [0, 6, 4], [1, 5, 7], [1, 7, 3]])
mesh = fcl.BVHModel()
mesh.beginModel(len(corners), len(faces))
mesh.addSubModel(corners, faces)
mesh.endModel()
shapes = {"box": fcl.Box(1, 1, 1), "mesh": mesh, "cylinder": fcl.Cylinder(0.5, 1)}


def distance(name, offset, solver):
    first = fcl.CollisionObject(shapes[name], fcl.Transform())
    second = fcl.CollisionObject(shapes[name], fcl.Transform(np.array(offset, float)))
    return fcl.distance(first, second, fcl.DistanceRequest(gjk_solver_type=solver), fcl.DistanceResult())


for offset in ((3, 0, 0), (0, 3, 0), (0, 0, 3), (0, 0, 10), (0.5, 0.5, 3), (0, 0, 2), (0.001, 0, 3)):
    for name in shapes:
        found = {f"{distance(name, offset, solver):.4f}"
                 for solver in (fcl.GJKSolverType.GST_LIBCCD, fcl.GJKSolverType.GST_INDEP)}
        print(name, ",".join(map(str, offset)), *found)
END
for version in 0.7.0.11 0.7.0.8; do
    "$version/bin/python" apart.py >"results-$version"
    row() { grep "^$1 " "results-$version" | cut -d' ' -f3-; }
    for offset in 3,0,0 0,3,0 0,0,3 0.5,0.5,3 0.001,0,3; do
        same "$version: meshes, $offset" "$(row "mesh $offset")" 2.0000
    done
    same "$version: meshes, 0,0,10" "$(row "mesh 0,0,10")" 9.0000
    same "$version: meshes, 0,0,2" "$(row "mesh 0,0,2")" 1.0000
    same "$version: boxes, 3,0,0" "$(row "box 3,0,0")" 2.0000
    same "$version: boxes, 0,3,0" "$(row "box 0,3,0")" 2.2361
    same "$version: boxes, 0,0,3" "$(row "box 0,0,3")" 2.2361
    same "$version: boxes, 0,0,10" "$(row "box 0,0,10")" 9.0554
    same "$version: boxes, 0.5,0.5,3" "$(row "box 0.5,0.5,3")" 2.1213
    same "$version: boxes, 0,0,2" "$(row "box 0,0,2")" 1.0000
    same "$version: boxes, 0.001,0,3" "$(row "box 0.001,0,3")" 2.0000
    same "$version: cylinders, 0,0,3" "$(row "cylinder 0,0,3")" 2.2361
    same "$version: cylinders, 0,0,2" "$(row "cylinder 0,0,2")" 1.0000
done
conclude
