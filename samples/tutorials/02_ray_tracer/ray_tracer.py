# SPDX-License-Identifier: MIT
"""Tutorial 2: a ray tracer by NumPy: shading, shadows, reflections."""
import pathlib
import sys

import numpy as np
import twinray


# [scene]
def sphere(around=256, down=128):
    """Triangles of a sphere about the origin, of radius 1."""
    polar, turn = np.meshgrid(np.linspace(0, np.pi, down + 1), np.linspace(0, 2 * np.pi, around + 1), indexing="ij")
    points = np.stack([np.sin(polar) * np.cos(turn), np.cos(polar), -np.sin(polar) * np.sin(turn)], axis=-1)
    a = (np.arange(down)[:, None] * (around + 1) + np.arange(around)).ravel()
    b, c, d = a + 1, a + around + 1, a + around + 2
    return points.reshape(-1, 3), np.concatenate([np.stack([a, c, d], -1), np.stack([a, d, b], -1)])


middles = np.array([[0, 0, 0], [-2.1, 1, 0], [0, 1, -0.6], [2.1, 1, 0]])  # by number of geometry; 0 is the floor


def make_scene():
    scene = twinray.Scene(accel="sw")
    scene.add_triangles([[-9, 0, 9], [9, 0, 9], [9, 0, -9], [-9, 0, -9]], [[0, 1, 2], [0, 2, 3]])
    places = np.tile(np.eye(4), (4, 1, 1))
    places[:, :3, 3] = middles
    ball = scene.add_triangles(*sphere(), transform=places[1])
    scene.add_instance(ball, places[2])
    scene.add_instance(ball, places[3])
    return scene

# [materials]
colors = np.array([[0.8, 0.8, 0.75], [0.9, 0.2, 0.1], [0.95, 0.95, 0.95], [0.1, 0.3, 0.8]])
mirrors = np.array([0.1, 0.15, 0.8, 0.15])  # the part of light that is reflected as by a mirror
sun = np.array([0.6, 1, 0.5]) / np.sqrt(1.61)  # the direction to it


def sky(directions):
    up = np.maximum(0, directions[:, 1:2])
    return (1 - up) * 0.9 + up * [0.35, 0.55, 0.9]
    # [/materials]


def camera_rays(width, height):
    """(n, 6): a ray for each pixel, with a direction of length 1."""
    fov = 2 * np.rad2deg(np.arctan(np.tan(np.deg2rad(24)) * width / height))  # from left to right
    down = [0, -1, 0]  # what create_rays_pinhole calls up is where rows count to
    rays = twinray.Scene.create_rays_pinhole(fov, [0, 0.7, 0], [0, 2.2, 6.5], down, width, height, dtype=np.float64)
    rays = np.array(rays).reshape(-1, 6)
    rays[:, 3:] /= np.linalg.norm(rays[:, 3:], axis=1, keepdims=True)
    return rays


# [leave]
NEAR = 0.001  # hits below it are of the surface that a ray has left


def normals_of(positions, geometries):
    """Of the balls they go from the middle to the place, as if the balls were round."""
    from_middle = positions - middles[geometries]
    from_middle[geometries == 0] = [0, 1, 0]
    return from_middle / np.linalg.norm(from_middle, axis=1, keepdims=True)


def reflected(directions, normals):
    return directions - 2 * np.sum(directions * normals, axis=1, keepdims=True) * normals
    # [/leave]


def bounce(scene, to_sun, rays, pixels, weights, picture):
    """Adds to the picture what the rays bring, and gives the rays that are left, their pixels and their weights."""
    found = scene.cast_rays(rays, tnear=NEAR, normals=False)
    is_hit = found["t_hit"].isfinite()
    missed = ~is_hit
    picture[pixels[missed]] += weights[missed, None] * sky(rays[missed, 3:])

    rays, pixels, weights = rays[is_hit], pixels[is_hit], weights[is_hit]
    geometries = np.asarray(found["geometry_ids"])[is_hit]
    directions = rays[:, 3:]
    positions = rays[:, :3] + np.asarray(found["t_hit"])[is_hit, None] * directions
    normals = normals_of(positions, geometries)
    shadow_rays = np.concatenate([positions, np.broadcast_to(to_sun, positions.shape)], axis=1)
    is_lit = ~np.asarray(scene.test_occlusions(shadow_rays, tnear=NEAR))
    light = 0.2 + 0.8 * is_lit * np.maximum(0, normals @ to_sun)
    mirror = mirrors[geometries]
    picture[pixels] += (weights * (1 - mirror) * light)[:, None] * colors[geometries]
    return np.concatenate([positions, reflected(directions, normals)], axis=1), pixels, weights * mirror


def save(light, width, height, file):
    linear = np.clip(light.reshape(height, width, 3), 0, 1)
    srgb = np.where(linear < 0.0031308, 12.92 * linear, 1.055 * linear ** (1 / 2.4) - 0.055)
    twinray.Picture((255 * srgb + 0.5).astype(np.uint8)).save(file)


def main():
    folder = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else ".")
    # [loop]
    width, height = 640, 480
    scene = make_scene()
    rays = camera_rays(width, height)
    picture = np.zeros((len(rays), 3))
    pixels, weights = np.arange(len(rays)), np.ones(len(rays))
    for depth in range(4):
        print(f"bounce {depth}: {len(rays)} rays")
        rays, pixels, weights = bounce(scene, sun, rays, pixels, weights, picture)
    save(picture, width, height, folder / "02_ray_tracer_python.png")
    # [/loop]
    # From a point above the floor towards the sun: the middle of the red ball is in the way.
    is_dark = scene.test_occlusions([-2.625, 0.125, -0.4375, *sun])
    print(f"the shadow is dark: {'yes' if is_dark else 'no'}")


if __name__ == "__main__":
    main()
