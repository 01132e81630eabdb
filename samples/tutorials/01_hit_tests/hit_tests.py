# SPDX-License-Identifier: MIT
"""Tutorial 1: one triangle, one ray, then a batch of them; what a hit holds and any hits."""
# [imports]
import pathlib
import sys

import numpy as np
import twinray

# [/imports]

folder = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".")

# [triangle]
scene = twinray.Scene(accel="sw")
corners, triangles = [[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]
near = scene.add_triangles(corners, triangles)

# [ray]
ray = [0.25, 0.5, 2, 0, 0, -1]  # origin, direction
found = scene.cast_rays(ray)
u, v = found["primitive_uvs"]
print(
    f"the ray meets geometry {found['geometry_ids']}, triangle {found['primitive_ids']}"
    f" at t = {found['t_hit']:g}, u = {u:g}, v = {v:g}"
)

# [miss]
t = scene.cast_rays(ray, tfar=1.5)["t_hit"]
print(f"the same ray up to t = 1.5 {'hits' if np.isfinite(t) else 'misses'}, t = {t:g}")

# [second]
far = scene.add_triangles(corners, triangles, transform=[[1, 0, 0, 0.2], [0, 1, 0, 0.3], [0, 0, 1, -1], [0, 0, 0, 1]])

# [batch]
width, height = 640, 480
x = -0.4 + 2.0 * (np.arange(width) + 0.5) / width
y = 1.4 - 1.5 * (np.arange(height) + 0.5) / height
rays = np.zeros((height, width, 6), np.float32)
rays[..., 0], rays[..., 1] = np.meshgrid(x, y)
rays[..., 2], rays[..., 5] = 2, -1
found = scene.cast_rays(rays)
is_hit = found["geometry_ids"] != twinray.INVALID_ID
print(f"{is_hit.sum()} of {is_hit.size} rays hit: an area of {is_hit.mean() * 3:.6g}, by geometry 0.875")

# [picture]
u, v = found["primitive_uvs"][..., 0], found["primitive_uvs"][..., 1]
weights = np.stack([1 - u - v, u, v], axis=-1)
white = np.where(found["geometry_ids"] == far, 0.6, 0.1)[..., None]
colors = np.where(is_hit[..., None], white + (1 - white) * weights, 1)
twinray.Picture((255 * colors**0.45).astype(np.uint8)).save(folder / "01_hit_tests_python.png")

# [any]
print(f"blocked, by any hits: {scene.test_occlusions(rays).sum()}")

# [behind]
behind = scene.cast_rays(ray, tnear=2.5)
print(f"behind t = 2.5 it meets geometry {behind['geometry_ids']} at t = {behind['t_hit']:g}")
