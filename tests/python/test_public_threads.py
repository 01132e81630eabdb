# SPDX-License-Identifier: MIT
"""What users of peers have reported, by its kind, with the right answer: the names are of the public threads."""

import numpy as np
import twinray


def sphere(rings=24, segments=48):
    """A closed sphere with poles, as Open3D's create_sphere makes them: vertices on the axes."""
    theta = np.linspace(0, np.pi, rings + 1)[1:-1]
    phi = np.linspace(0, 2 * np.pi, segments, endpoint=False)
    ring = np.stack(
        [
            np.outer(np.sin(theta), np.cos(phi)),
            np.outer(np.sin(theta), np.sin(phi)),
            np.outer(np.cos(theta), phi * 0 + 1),
        ],
        axis=-1,
    ).reshape(-1, 3)
    vertices = np.vstack([[[0, 0, 1]], ring, [[0, 0, -1]]]).astype(np.float32)
    i = 1 + np.arange((rings - 1) * segments).reshape(rings - 1, segments)
    j = np.roll(i, -1, axis=1)
    caps = [np.stack([i[0] * 0, i[0], j[0]], -1), np.stack([i[-1] * 0 + len(vertices) - 1, j[-1], i[-1]], -1)]
    sides = [np.stack([i[:-1], i[1:], j[1:]], -1).reshape(-1, 3), np.stack([i[:-1], j[1:], j[:-1]], -1).reshape(-1, 3)]
    return vertices, np.concatenate(caps + sides).astype(np.uint32)


def test_open3d_5669_5797_signs_along_axes_do_not_flip():
    scene = twinray.Scene()
    vertices, triangles = sphere()
    scene.add_triangles(vertices, triangles)
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    steps = np.linspace(-0.5, 1.5, 33)[:, None] * (high - low) + low  # through vertices, edges, diagonals
    points = np.stack(np.meshgrid(*steps.T, indexing="ij"), axis=-1)
    radius = np.linalg.norm(points, axis=-1)
    inside, clear = radius < 0.99, (radius < 0.99) | (radius > 1.001)
    assert ((scene.compute_signed_distance(points) < 0) == inside)[clear].all()
    assert (scene.compute_occupancy(points) == inside)[clear].all()


def test_open3d_5430_rays_from_a_surface_leave_it():
    scene = twinray.Scene(accel="sw")
    vertices, triangles = sphere()
    scene.add_triangles(vertices, triangles)
    middles = vertices[triangles].mean(axis=1, dtype=np.float64)
    normals = middles / np.linalg.norm(middles, axis=1, keepdims=True)
    rays = np.hstack([middles + 1e-5 * normals, normals])
    assert not scene.test_occlusions(rays).any()
