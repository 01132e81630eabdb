# SPDX-License-Identifier: MIT
"""Solutions of the exercises of tutorial 2. Exits with 1 unless each gives what is known."""
import sys

import numpy as np
from ray_tracer import NEAR, bounce, camera_rays, make_scene, middles, normals_of, reflected, sun

scene = make_scene()


def light_of(rays):
    """The loop of the tutorial: what one ray a pixel brings, (n, 3)."""
    picture = np.zeros((len(rays), 3))
    pixels, weights = np.arange(len(rays)), np.ones(len(rays))
    for _ in range(4):
        rays, pixels, weights = bounce(scene, sun, rays, pixels, weights, picture)
    return picture


def several_rays(width, height, side):
    """Means over squares of side x side pixels of a picture that is so many times larger."""
    light = light_of(camera_rays(side * width, side * height))
    return light.reshape(height, side, width, side, 3).mean(axis=(1, 3))


converged = several_rays(120, 90, 8)
errors = [np.sqrt(np.mean((several_rays(120, 90, side) - converged) ** 2)) for side in (1, 2, 4)]
for side, error in zip((1, 2, 4), errors):
    print(f"1: {side * side} rays a pixel: RMS error {error:.6f}")


# [sun]
aside = np.cross(sun, [0, 1, 0]) / np.linalg.norm(np.cross(sun, [0, 1, 0]))


def points_of_sun(n, radius=0.08):
    """Directions to points of a sun of some size, on a spiral as seeds of a sunflower: each has the same area."""
    from_middle, turn = radius * np.sqrt((np.arange(n) + 0.5) / n), 2.399963 * np.arange(n)
    offsets = np.cos(turn)[:, None] * aside + np.sin(turn)[:, None] * np.cross(aside, sun)
    directions = sun + from_middle[:, None] * offsets
    return directions / np.linalg.norm(directions, axis=1, keepdims=True)
    # [/sun]


def hidden_part(distance):
    """How much of the sun the red ball hides from where the ray to the sun's middle passes it at a distance."""
    place = middles[1] - sun * (middles[1][1] / sun[1]) + aside * distance
    directions = points_of_sun(1000)
    rays = np.concatenate([np.broadcast_to(place, directions.shape), directions], axis=1)
    return float(np.mean(scene.test_occlusions(rays, tnear=0.125)))


hidden = [hidden_part(distance) for distance in (0.75, 1, 1.25)]
print("2: hidden within the shadow {:g}, at its edge {:g}, outside {:g}".format(*hidden))


def pass_through_glass(rays, index=1.5):
    """Rays that meet the ball in the middle pass through it and go on where they leave it."""
    for _ in range(2):  # into the ball, out of the ball
        found = scene.cast_rays(rays, tnear=NEAR, normals=False)
        met = np.asarray(found["geometry_ids"]) == 2
        directions = rays[met, 3:]
        positions = rays[met, :3] + np.asarray(found["t_hit"])[met, None] * directions
        normals = normals_of(positions, np.full(len(positions), 2))
        leaves = np.sum(directions * normals, axis=1, keepdims=True) > 0
        normals = np.where(leaves, -normals, normals)
        # Snell: what is along the surface is scaled by the ratio; what is left of length 1 goes through it.
        along = directions - np.sum(directions * normals, axis=1, keepdims=True) * normals
        along *= np.where(leaves, index, 1 / index)
        through = 1 - np.sum(along**2, axis=1, keepdims=True)
        refracted = along - np.sqrt(np.maximum(0, through)) * normals
        rays = rays.copy()
        onward = np.where(through > 0, refracted, reflected(directions, normals))
        rays[met] = np.concatenate([positions, onward], axis=1)
    return rays


turn = 2 * np.pi * np.arange(64) / 64
rays = np.zeros((64, 6))
rays[:, :3] = middles[2] + np.stack([0.0625 * np.cos(turn), 0.0625 * np.sin(turn), np.full(64, 3)], axis=1)
rays[:, 5] = -1
rays = pass_through_glass(rays)
from_axis, slope = rays[:, :2] - middles[2][:2], rays[:, 3:5]
t = -np.sum(from_axis * slope, axis=1) / np.sum(slope**2, axis=1)
focus = float(np.mean(middles[2][2] - (rays[:, 2] + t * rays[:, 5])))
print(f"3: the glass ball has its focus at {focus:.5f}, by the formula 1.5")

is_smoother = errors[1] < 0.6 * errors[0] and errors[2] < 0.6 * errors[1]
is_soft = hidden[0] == 1 and hidden[2] == 0 and abs(hidden[1] - 0.5) < 0.125
if not is_smoother or not is_soft or abs(focus / 1.5 - 1) > 0.02:
    sys.exit(1)
print("the solutions hold")
