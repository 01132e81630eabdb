# SPDX-License-Identifier: MIT
"""Solutions of the exercises of tutorial 1. Exits with 1 unless each gives what is known."""
import math
import sys

import numpy as np
import twinray


def sphere(radius, around=256, down=128):
    """Triangles of a sphere about the origin."""
    polar, turn = np.meshgrid(np.linspace(0, np.pi, down + 1), np.linspace(0, 2 * np.pi, around + 1), indexing="ij")
    points = radius * np.stack([np.sin(polar) * np.cos(turn), np.sin(polar) * np.sin(turn), np.cos(polar)], axis=-1)
    a = (np.arange(down)[:, None] * (around + 1) + np.arange(around)).ravel()
    b, c, d = a + 1, a + around + 1, a + around + 2
    return points.reshape(-1, 3), np.concatenate([np.stack([a, c, d], -1), np.stack([a, d, b], -1)])


# [culling]
scene = twinray.Scene(accel="sw")
scene.add_triangles([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])  # its front looks to +z
rays = np.array([[0.3, 0.2, 1, 0, 0, -1], [0.3, 0.2, -1, 0, 0, 1]])
found = scene.cast_rays(rays)
against = np.sum(found["primitive_normals"] * rays[:, 3:], axis=-1) < 0
fronts = int(np.sum(found["t_hit"].isfinite() & against))
# [/culling]
print(f"1: {fronts} of two rays meets a front")

# [area]
scene = twinray.Scene(accel="sw")
scene.add_triangles(*sphere(0.5))
side = (np.arange(500) + 0.5) / 500 - 0.5
rays = np.zeros((500, 500, 6), np.float32)
rays[..., 0], rays[..., 1] = np.meshgrid(side, side)
rays[..., 2], rays[..., 5] = 1, -1
area = float(np.mean(scene.test_occlusions(rays)))
# [/area]
print(f"2: the outline has an area of {area:.5f}, by the formula {math.pi / 4:.5f}")

# [all]
scene = twinray.Scene(accel="sw")
for z in (-3, -6):
    scene.add_triangles(*sphere(1), transform=[[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, z], [0, 0, 0, 1]])
distances = scene.list_intersections([[0.1, 0.2, 0, 0, 0, -1]])["t_hit"]
# [/all]
print("3: hits at t =", *distances)

# A ray at a distance d from the middle of a unit sphere enters sqrt(1 - d^2) before it.
enters = len(distances) == 4 and abs(distances[0] - (3 - math.sqrt(0.95))) < 0.001
if fronts != 1 or abs(area / (math.pi / 4) - 1) > 0.002 or not enters:
    sys.exit(1)
print("the solutions hold")
