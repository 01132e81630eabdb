# SPDX-License-Identifier: MIT
"""Solutions of the exercises of tutorial 5. Exits with 1 unless each gives what is known."""
import math
import sys

import numpy as np
import twinray

# [corner]
corners = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [0, 1, 1], [0, 0, 1]], float)
scene = twinray.Scene(accel="sw")
scene.add_triangles(corners, [[0, 1, 2], [0, 2, 3], [0, 3, 4], [0, 4, 5]])  # the floor, then a wall at x = 0
F, _ = twinray.view_factors(scene, groups=[0, 0, 1, 1])
root = math.sqrt(2)
known = (2 * math.atan(1) - root * math.atan(1 / root) + math.log(3 / 4) / 4) / math.pi
# [/corner]
corner = F[0, 1]
print(f"1: F = {corner:.7f}, by the formula {known:.7f}")


# [spheres]
def sphere(radius, around=64, down=32):
    polar, turn = np.meshgrid(np.linspace(0, np.pi, down + 1), np.linspace(0, 2 * np.pi, around + 1), indexing="ij")
    points = radius * np.stack([np.sin(polar) * np.cos(turn), np.sin(polar) * np.sin(turn), np.cos(polar)], axis=-1)
    a = (np.arange(down)[:, None] * (around + 1) + np.arange(around)).ravel()
    b, c, d = a + 1, a + around + 1, a + around + 2
    return points.reshape(-1, 3), np.concatenate([np.stack([a, c, d], -1), np.stack([a, d, b], -1)])


scene = twinray.Scene(accel="sw")
points, triangles = sphere(1)
scene.add_triangles(points, triangles)
scene.add_triangles(2 * points, triangles[:, ::-1])  # looks inwards
groups = np.repeat([0, 1], len(triangles))
F, half_width = twinray.view_factors(scene, groups, rays=1 << 21)
# [/spheres]
outer = F[1, 1]
print(f"2: F = {outer:.5f} +- {half_width[1, 1]:.5f}, by the formula 0.75")

# [project]
points = np.array([[x, y, z] for x in (0, 1) for y in (0, 2) for z in (0, 3)], float)
sides = [[0, 3, 1], [0, 2, 3], [4, 7, 6], [4, 5, 7], [0, 5, 4], [0, 1, 5],
         [2, 7, 3], [2, 6, 7], [0, 6, 2], [0, 4, 6], [1, 7, 5], [1, 3, 7]]  # fmt: skip
scene = twinray.Scene(accel="sw")
scene.add_triangles(points, sides)
F, _ = twinray.view_factors(scene, estimator="hits", rays=4096)
a, b, c = np.moveaxis(points[sides], 1, 0)
areas = np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2
exchanges = areas[:, None] * F
counted = np.abs(exchanges - exchanges.T).max()
balanced = (exchanges + exchanges.T) / 2 / areas[:, None]
closure = np.abs(balanced.sum(axis=1) - 1).max()
# [/project]
print(f"3: reciprocity is off by {counted:.2g}; after averaging, rows no longer add up to 1, by {closure:.2g}")

if abs(corner / known - 1) > 1e-6 or abs(outer - 0.75) > 0.001 or counted < 1e-6 or not 1e-6 < closure < 0.1:
    sys.exit(1)
print("the solutions hold")
