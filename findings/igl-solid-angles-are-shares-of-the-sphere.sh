#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# A good guess: igl.solid_angle(A, B, C, P) is in steradians. Its docstring says "signed solid angle in steradians". The
# triangle of the three unit points, seen from the origin, fills an octant: pi / 2 = 1.5708.
# Seen: 0.125, the octant's share of the sphere, which is what igl.winding_number gives for a mesh of this triangle. A
# triangle that almost fills the hemisphere gives 0.5000 for 6.2832. A factor of 4 pi is missing. The sign is there: the
# same corners in the other order give -0.125.
# Seen with libigl 2.6.3 on 2026-11-30. Needs Python 3.12 or 3.13, 300 MB and no root.
folder=$(mktemp -d)
# shellcheck source=findings/checks.sh
. "$(dirname "${BASH_SOURCE[0]}")/checks.sh"
make_venv venv libigl==2.6.3 numpy==2.4.6 scipy==1.17.1

cat >angle.py <<'END'
import igl
import numpy as np

row = lambda *point: np.array([point], float)
eye = row(0, 0, 0)
a, b, c = row(1, 0, 0), row(0, 1, 0), row(0, 0, 1)
print("octant", f"{igl.solid_angle(a, b, c, eye):.4f}")
print("turned", f"{igl.solid_angle(a, c, b, eye):.4f}")
print("winding", f"{igl.winding_number(np.vstack([a, b, c]), np.array([[0, 1, 2]]), eye)[0]:.4f}")
low = 1e-3
hemisphere = row(-1e3, -1e3, low), row(2e3, -1e3, low), row(-1e3, 2e3, low)
print("hemisphere", f"{igl.solid_angle(*hemisphere, eye):.4f}")
print("steradians", igl.solid_angle.__doc__.count("signed solid angle in steradians"))
END
venv/bin/python angle.py >results
row() { grep "^$1 " results | cut -d' ' -f2; }
same "libigl" "$(venv/bin/pip list --disable-pip-version-check 2>/dev/null | awk '$1 == "libigl" { print $2 }')" 2.6.3
same "the octant" "$(row octant)" 0.1250
same "the octant, turned round" "$(row turned)" -0.1250
same "the winding number of its mesh" "$(row winding)" 0.1250
same "almost the hemisphere" "$(row hemisphere)" 0.5000
same "the docstring says 'signed solid angle in steradians'" "$(row steradians)" 1
conclude
