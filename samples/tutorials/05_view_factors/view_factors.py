# SPDX-License-Identifier: MIT
"""Tutorial 5: view factors with intervals beside a closed form, and a room lit by radiosity."""
import math
import pathlib
import sys

import numpy as np
import twinray

folder = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".")


# [squares]
def rectangle(corner, u, v, n=1):
    """Triangles (2 n n, 3, 3) of a rectangle whose front looks along cross(u, v)."""
    i, j = (grid.ravel()[:, None] for grid in np.meshgrid(np.arange(n), np.arange(n), indexing="ij"))
    corner, u, v = (np.array(vector, float) for vector in (corner, u, v))

    def at(a, b):
        return corner + a / n * u + b / n * v

    quad = at(i, j), at(i + 1, j), at(i + 1, j + 1), at(i, j + 1)
    return np.stack([quad[k] for k in (0, 1, 2, 0, 2, 3)], axis=1).reshape(-1, 3, 3)


def scene_of(panels):
    """A scene with a geometry for each panel, and the panel of each face."""
    scene = twinray.Scene(accel="sw")
    for panel in panels:
        scene.add_triangles(panel.reshape(-1, 3), np.arange(3 * len(panel)).reshape(-1, 3))
    return scene, np.repeat(np.arange(len(panels)), [len(panel) for panel in panels])


lower, upper = rectangle([0, 0, 0], [1, 0, 0], [0, 1, 0]), rectangle([0, 0, 1], [0, 1, 0], [1, 0, 0])
scene, groups = scene_of([lower, upper])
root = math.sqrt(2)
known = 2 / math.pi * (math.log(2 / math.sqrt(3)) + 2 * root * math.atan(1 / root) - 2 * math.atan(1))

# [first]
F, half_width = twinray.view_factors(scene, groups, estimator="hits")
print(f"by rays F = {F[0, 1]:.6f} +- {half_width[0, 1]:.6f}; the formula says {known:.6f}")

# [contour]
F, half_width = twinray.view_factors(scene, groups)
exact = F[0, 1]
print(f"by contours F = {exact:.6f}, off by {abs(exact - known):.1e}")
# [/contour]

held = 0
for seed in range(1, 101):
    F, half_width = twinray.view_factors(scene, groups, estimator="hits", rays=4096, seed=seed)
    held += abs(F[0, 1] - known) <= half_width[0, 1]
print(f"of 100 intervals {held} hold the truth")

# [cube]
x, y, z, o = [1, 0, 0], [0, 1, 0], [0, 0, 1], [0, 0, 0]
cube = [rectangle(*wall) for wall in ((o, x, y), (z, y, x), (o, y, z), (x, z, y), (o, z, x), (y, x, z))]
F, _ = twinray.view_factors(*scene_of(cube))
light = np.linalg.solve(np.eye(6) - 0.5 * F, np.ones(6))
print(f"each wall of the cube sends {light[0]:.7g}, by the series 2")

# [room]
room = [rectangle(*wall, n=12) for wall in ((o, x, y), (o, y, z), (x, z, y), (o, z, x), (y, x, z))]
room.append(rectangle([0.35, 0.98, 0.35], [0.3, 0, 0], [0, 0, 0.3], n=3))  # the lamp
room.append(rectangle([0.3, 0.4, 0.4], [0, 0, 0.4], [0.4, 0, 0], n=8))  # a table, from above
room.append(rectangle([0.3, 0.38, 0.4], [0.4, 0, 0], [0, 0, 0.4], n=8))  # and from below
scene, panel_of_face = scene_of(room)
F, _ = twinray.view_factors(scene, rays=2048)
is_lamp = panel_of_face == 5
reflectance = np.where(is_lamp, 0, 0.7)
B = np.linalg.solve(np.eye(len(F)) - reflectance[:, None] * F, np.where(is_lamp, 10.0, 0.0))
picture = scene.show(values=np.where(is_lamp, np.nan, B), eye=[0.5, 0.8, 2.6], center=[0.5, 0.5, 0], up=y)
picture.save(folder / "05_view_factors_python.png")
# [/room]

if abs(exact / known - 1) > 1e-6 or held < 85 or np.abs(light - 2).max() > 1e-6:
    sys.exit(1)
print("the answers hold")
