"""Peers: rows of docs/how-to/from_trimesh_and_open3d.md that say where answers differ, ours, and theirs where they are
installed; what users of peers have reported, with the right answer, in tests with the names of the public threads."""

import numpy as np
import pytest
import twinray
import twinray.trimesh
from conftest import cube, needed, scene_of

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
    vertices, triangles = sphere()
    scene = scene_of((vertices, triangles))
    low, high = vertices.min(axis=0), vertices.max(axis=0)
    steps = np.linspace(-0.5, 1.5, 33)[:, None] * (high - low) + low  # through vertices, edges, diagonals
    points = np.stack(np.meshgrid(*steps.T, indexing="ij"), axis=-1)
    radius = np.linalg.norm(points, axis=-1)
    inside, clear = radius < 0.99, (radius < 0.99) | (radius > 1.001)
    assert ((scene.compute_signed_distance(points) < 0) == inside)[clear].all()
    assert (scene.compute_occupancy(points) == inside)[clear].all()


def test_open3d_5430_rays_from_a_surface_leave_it():
    vertices, triangles = sphere()
    scene = scene_of((vertices, triangles), accel="sw")
    middles = vertices[triangles].mean(axis=1, dtype=np.float64)
    normals = middles / np.linalg.norm(middles, axis=1, keepdims=True)
    rays = np.hstack([middles + 1e-5 * normals, normals])
    assert not scene.test_occlusions(rays).any()
