#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# A good guess: quaternions in OpenUSD have the real part first, (w, x, y, z). Gf.Quatf(1, 2, 3, 4) has the real part 1,
# it prints so, and .usda files have that order. So an array of rows (1, 0, 0, 0) sets no turn.
# Seen: NumPy arrays have the real part last. Vt.QuatfArray.FromNumpy([[1, 0, 0, 0]]) is a half turn about x, and so is
# that array in Set() of a PointInstancer's orientations, without an error; the file then says (0, 1, 0, 0).
# np.array(Vt.QuatfArray([Gf.Quatf(1, 2, 3, 4)])) is [[2, 3, 4, 1]]. Quath, Quatd and dual quaternions do the same.
# Vectors keep their order. A row of numbers for a quaternion means one turn in Gf and in files, another in NumPy.
# Seen with usd-core 26.11 and NumPy 2.5.5 on 2026-11-30. Needs Python 3.12 or 3.13 and no root.
folder=$(mktemp -d)
# shellcheck source=findings/checks.sh
. "$(dirname "${BASH_SOURCE[0]}")/checks.sh"
make_venv venv usd-core==26.11 numpy==2.5.5

cat >quaternions.py <<'END'
import re

import numpy as np
from pxr import Gf, Usd, UsdGeom, Vt


def words(values):
    return " ".join(f"{value:g}" for value in np.asarray(values, float).ravel() + 0.0)


quaternion = Gf.Quatf(1, 2, 3, 4)
print(f"real|{quaternion.real:g}")
print(f"printed|{quaternion}")
for kind in ("Quath", "Quatf", "Quatd"):
    print(f"{kind}|{words(Vt.__dict__[kind + 'Array']([Gf.__dict__[kind](1, 2, 3, 4)]))}")
dual = Gf.DualQuatf(Gf.Quatf(1, 2, 3, 4), Gf.Quatf(5, 6, 7, 8))
print(f"dual|{words(Vt.DualQuatfArray([dual]))}")
rows = np.array([[1, 0, 0, 0]], np.float32)
print(f"given|{Vt.QuatfArray.FromNumpy(rows)[0].real:g}")

stage = Usd.Stage.CreateInMemory()
instancer = UsdGeom.PointInstancer.Define(stage, "/instancer")
UsdGeom.Cube.Define(stage, "/instancer/cube")
instancer.CreatePrototypesRel().SetTargets(["/instancer/cube"])
instancer.CreateProtoIndicesAttr([0])
instancer.CreatePositionsAttr([(0, 0, 0)])
orientations = instancer.CreateOrientationsfAttr()


def turned():
    return words(instancer.ComputeInstanceTransformsAtTime(0, 0)[0].Transform(Gf.Vec3d(1, 2, 3)))


print(f"set|{orientations.Set(rows)}")
print(f"point by an array|{turned()}")
print(f"file|{re.search('orientationsf = (.*)', stage.GetRootLayer().ExportToString()).group(1)}")
orientations.Set([Gf.Quatf(1, 0, 0, 0)])
print(f"point by Gf|{turned()}")
orientations.Set(np.array([[0, 0, 0, 1]], np.float32))
print(f"point, real part last|{turned()}")
print(f"vectors|{words(Vt.Vec4fArray([Gf.Vec4f(1, 2, 3, 4)]))}")
END
venv/bin/python quaternions.py >results
row() { grep "^$1|" results | cut -d'|' -f2; }
same "real part of Gf.Quatf(1, 2, 3, 4)" "$(row real)" 1
same "it is printed as" "$(row printed)" "(1, 2, 3, 4)"
for kind in Quath Quatf Quatd; do
    same "a ${kind}Array of it in NumPy" "$(row "$kind")" "2 3 4 1"
done
same "an array of dual quaternions (1, 2, 3, 4), (5, 6, 7, 8) in NumPy" "$(row dual)" "2 3 4 1 6 7 8 5"
same "an array of Gf.Vec4f(1, 2, 3, 4) in NumPy" "$(row vectors)" "1 2 3 4"
same "real part of FromNumpy([[1, 0, 0, 0]])" "$(row given)" 0
same "orientations.Set(numpy [[1, 0, 0, 0]]) returns" "$(row set)" True
same "the file says" "$(row file)" "[(0, 1, 0, 0)]"
same "the instance's (1, 2, 3) is at" "$(row 'point by an array')" "1 -2 -3"
same "with [Gf.Quatf(1, 0, 0, 0)] it is at" "$(row 'point by Gf')" "1 2 3"
same "with numpy [[0, 0, 0, 1]] it is at" "$(row 'point, real part last')" "1 2 3"
conclude
