# SPDX-License-Identifier: MIT
"""What users of peers have reported, by its kind, with the right answer: the names are of the public threads."""

import numpy as np
import pytest
import twinray
from conftest import cube, grid, needed


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


@pytest.mark.parametrize("mesh", [cube(), sphere()], ids=["cube", "sphere"])
def test_open3d_5105_5669_5797_signs_along_axes_do_not_flip(mesh):
    scene = twinray.Scene()
    scene.add_triangles(*mesh)
    vertices, _ = mesh
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    steps = np.linspace(-0.5, 1.5, 33)[:, None] * (high - low) + low  # through vertices, edges, diagonals
    points = np.stack(np.meshgrid(*steps.T, indexing="ij"), axis=-1)
    signed = scene.compute_signed_distance(points)
    if len(vertices) == 8:
        inside = ((points > low) & (points < high)).all(axis=-1)
        clear = np.abs(signed) > 1e-6
    else:
        radius = np.linalg.norm(points, axis=-1)
        inside, clear = radius < 0.99, (radius < 0.99) | (radius > 1.001)
    assert ((signed < 0) == inside)[clear].all()
    assert (scene.compute_occupancy(points) == inside)[clear].all()


def test_open3d_6919_scenes_of_several_meshes_have_an_inside():
    scene = twinray.Scene()
    vertices, triangles = cube()
    for x in (0, 3, 6):
        scene.add_triangles(vertices + np.float32([x, 0, 0]), triangles)
    assert scene.compute_occupancy([[x + 0.5, 0.5, 0.5] for x in range(8)]).tolist() == [1, 0, 0, 1, 0, 0, 1, 0]


def test_open3d_5870_rays_have_intervals():
    scene = twinray.Scene()
    scene.add_triangles(*cube())
    rays = np.tile([0.3, 0.6, -1, 0, 0, 1], (3, 1))
    assert scene.cast_rays(rays, tnear=1.5, tfar=1.9)["t_hit"].tolist() == [np.inf] * 3


def test_open3d_5430_rays_from_a_surface_leave_it():
    scene = twinray.Scene(accel="sw")
    vertices, triangles = sphere()
    scene.add_triangles(vertices, triangles)
    middles = vertices[triangles].mean(axis=1, dtype=np.float64)
    normals = middles / np.linalg.norm(middles, axis=1, keepdims=True)
    rays = np.hstack([middles + 1e-5 * normals, normals])
    assert not scene.test_occlusions(rays).any()


trimesh = needed("trimesh")
from twinray.trimesh import RayMeshIntersector  # noqa: E402


def test_trimesh_242_rays_through_vertices_hit():
    mesh = trimesh.creation.icosphere(3)
    directions = np.vstack([mesh.vertices, mesh.vertices[mesh.edges_unique].mean(axis=1)])
    ray = RayMeshIntersector(mesh, accel="sw")
    _, rays = ray.intersects_id(np.zeros_like(directions), directions)
    assert (np.bincount(rays, minlength=len(directions)) == 1).all()


def test_trimesh_2245_any_and_first_agree():
    mesh = trimesh.creation.icosphere(2)
    random = np.random.default_rng(3)
    origins, directions = random.normal(size=(20_000, 3)) * 2, random.normal(size=(20_000, 3)) * 1e-3
    ray = RayMeshIntersector(mesh)
    assert (ray.intersects_any(origins, directions) == (ray.intersects_first(origins, directions) >= 0)).all()


def test_trimesh_2324_a_rescaled_mesh_is_hit():
    mesh = trimesh.creation.box(extents=[64, 64, 64])
    mesh.ray = RayMeshIntersector(mesh)
    assert mesh.ray.intersects_any([[0, 0, 100]], [[0, 0, -1]]).all()
    mesh.apply_scale(1 / 64)
    assert len(mesh.ray.intersects_location([[0.1, 0.2, -2.0]], [[0, 0, 1]])[0]) == 2


def test_trimesh_1097_points_are_inside_whatever_the_direction():
    mesh = trimesh.creation.icosphere(4)
    points = np.random.default_rng(5).normal(size=(5000, 3))
    points *= (np.random.default_rng(6).uniform(0, 0.99, (5000, 1))) / np.linalg.norm(points, axis=1, keepdims=True)
    assert RayMeshIntersector(mesh).contains_points(points).all()


def test_pyvista_hits_at_grid_lines_are_found():
    vertices, triangles = grid(10)
    vertices[:, 2] = 0
    scene = twinray.Scene(accel="sw")
    scene.add_triangles(vertices, triangles)
    x = np.linspace(0.05, 0.95, 19)  # on lines and between them
    points = np.stack(np.meshgrid(x, x), axis=-1).reshape(-1, 2).astype(np.float32)
    rays = np.hstack([points, np.full((len(points), 1), 2), np.tile([0, 0, -1], (len(points), 1))])
    assert (scene.count_intersections(rays) == 1).all()
