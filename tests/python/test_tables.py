# SPDX-License-Identifier: MIT
"""Rows of docs/how-to/from_trimesh_and_open3d.md that say where answers differ: ours, and theirs where they are
installed."""

import numpy as np
import pytest
import twinray
import twinray.trimesh
from conftest import cube, needed

SQUARE = np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], np.float32), np.array([[0, 1, 2], [0, 2, 3]], np.uint32)
# Points on the middles of the sides below, left, right and above, then on the corners.
BORDER = np.array([[0.5, 0], [0, 0.5], [1, 0.5], [0.5, 1], [0, 0], [1, 0], [0, 1], [1, 1]])
FROM_A_PLANE = np.array([[0.3, 0.4, 0, 0, 0, 1], [0.3, 0.4, 0, 0.3, 0.1, 1]])
TO_A_PLANE = np.array([[0.3, 0.4, 1, 0, 0, -1]])
LAYERS = np.array([[0.1, 0.3, 2, 0, 0, -1], [0.2, 0.4, 2, 0, 0, -1]])


def moved(mesh, offset):
    return mesh[0] + np.array(offset, np.float32), mesh[1]


# Two bodies, and points inside one or both of them.
BODIES = {
    "nested": ([cube(), moved(cube(0.5), [0.25] * 3)], [[0.5, 0.52, 0.55], [0.1, 0.2, 0.15]]),
    "overlapping": ([cube(), moved(cube(), [0.5, 0.25, 0.25])], [[0.7, 0.6, 0.55], [0.2, 0.3, 0.25]]),
}
INSIDE_BY_PARITY = [False, True]


def scene_of(*meshes, **options):
    scene = twinray.Scene(**options)
    for mesh in meshes:
        scene.add_triangles(*mesh)
    return scene


def open3d_scene_of(*meshes):
    o3d = pytest.importorskip("open3d")
    scene = o3d.t.geometry.RaycastingScene()
    for vertices, triangles in meshes:
        scene.add_triangles(o3d.core.Tensor(vertices), o3d.core.Tensor(np.asarray(triangles, np.uint32)))
    return scene, lambda rows: o3d.core.Tensor(np.asarray(rows, np.float32))


def trimesh_of(*meshes):
    trimesh = needed("trimesh")
    return trimesh.util.concatenate([trimesh.Trimesh(*mesh, process=False) for mesh in meshes])


def rays_down(points):
    return np.concatenate([points, np.full((len(points), 1), 2.0), np.tile([0.0, 0, -1], (len(points), 1))], axis=1)


def test_borders():
    hit = scene_of(SQUARE, accel="sw").test_occlusions(rays_down(BORDER))
    assert hit.tolist() == [True, True, False, False, True, False, False, False]
    centers = (np.stack(np.meshgrid(*[np.linspace(0, 1, 5)] * 2), axis=-1)).reshape(-1, 2)
    assert scene_of(SQUARE, accel="sw").test_occlusions(rays_down(centers)).sum() == 16  # of 25: a row and a column


def test_borders_of_open3d():
    scene, tensor = open3d_scene_of(SQUARE)
    assert scene.test_occlusions(tensor(rays_down(BORDER))).numpy().all()


def test_ends_of_intervals(accel):
    scene = scene_of(SQUARE, accel=accel)
    assert not scene.test_occlusions(FROM_A_PLANE).any()
    assert not scene.test_occlusions(TO_A_PLANE, tfar=1.0).any()
    assert scene.test_occlusions(TO_A_PLANE, tfar=1.0 + 1e-6).all()


def test_ends_of_intervals_of_open3d():
    scene, tensor = open3d_scene_of(SQUARE)
    assert scene.test_occlusions(tensor(FROM_A_PLANE)).numpy().all()
    assert scene.test_occlusions(tensor(TO_A_PLANE), 0.0, 1.0).numpy().all()


@pytest.mark.parametrize("bodies", BODIES)
def test_nested_and_overlapping_bodies(bodies):
    meshes, points = BODIES[bodies]
    scene = scene_of(*meshes)
    assert scene.compute_occupancy(points).tolist() == [1, 1]
    assert scene.compute_winding_numbers(points).tolist() == [2, 1]


@pytest.mark.parametrize("bodies", BODIES)
def test_nested_and_overlapping_bodies_of_peers(bodies):
    meshes, points = BODIES[bodies]
    mesh = trimesh_of(*meshes)
    if not needed("trimesh").ray.has_embree:
        pytest.importorskip("rtree")  # trimesh's own engine wants it
    assert mesh.contains(points).tolist() == INSIDE_BY_PARITY
    scene, tensor = open3d_scene_of(*meshes)
    assert (scene.compute_occupancy(tensor(points)).numpy() == INSIDE_BY_PARITY).all()


def test_touching_bodies():
    meshes = cube(), moved(cube(), [1, 0, 0])
    points = np.random.default_rng(1).uniform([0.05] * 3, [1.95, 0.95, 0.95], (2000, 3))
    assert (scene_of(*meshes).compute_occupancy(points) == 1).all()
    trimesh = needed("trimesh")
    mesh = trimesh_of(*meshes)
    assert twinray.trimesh.RayMeshIntersector(mesh).contains_points(points).all()
    if trimesh.ray.has_embree:
        assert mesh.contains(points).mean() < 1


def test_containment():
    outer, inner = cube(), moved(cube(0.5), [0.25] * 3)
    assert len(twinray.collide(scene_of(outer, inner))["classes"]) == 0
    assert scene_of(outer).compute_occupancy(inner[0][0]) == 1  # the recipe
    needed("trimesh")
    pytest.importorskip("fcl")
    from trimesh.collision import CollisionManager

    manager = CollisionManager()
    for name, mesh in (("outer", outer), ("inner", inner)):
        manager.add_object(name, trimesh_of(mesh))
    assert manager.in_collision_internal()


def test_triangles_without_area(accel):
    flat = np.array([[0, 0, 0], [1, 0, 0], [2, 0, 0]], np.float32), [[0, 1, 2]]
    found = scene_of(flat, accel=accel).compute_closest_points([[1, 1, 0]])
    assert found["points"].tolist() == [[1, 0, 0]] and found["primitive_normals"].tolist() == [[0, 0, 0]]
    scene, tensor = open3d_scene_of(flat)
    assert np.isnan(scene.compute_closest_points(tensor([[1, 1, 0]]))["primitive_normals"].numpy()).all()


def test_order_of_rows():
    trimesh = needed("trimesh")
    mesh = trimesh_of(cube())
    origins, directions = LAYERS[:, :3], LAYERS[:, 3:]
    _, rays, locations = twinray.trimesh.RayMeshIntersector(mesh).intersects_id(
        origins, directions, return_locations=True
    )
    assert rays.tolist() == [0, 0, 1, 1] and locations[:, 2].tolist() == [1, 0, 1, 0]
    if trimesh.ray.has_embree:
        assert mesh.ray.intersects_id(origins, directions)[1].tolist() == [0, 1, 0, 1]  # by bounce


def test_coincident_faces_give_the_lowest_geometry():
    found = scene_of(SQUARE, SQUARE, SQUARE, accel="sw").cast_rays(TO_A_PLANE)
    assert found["geometry_ids"].tolist() == [0]
