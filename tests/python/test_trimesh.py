"""twinray.trimesh.RayMeshIntersector in place of trimesh's own."""

import copy
import pickle

import numpy as np
import pytest
from conftest import needed

trimesh = needed("trimesh")

from twinray.trimesh import RayMeshIntersector, use  # noqa: E402


@pytest.fixture
def ball():
    mesh = trimesh.creation.icosphere(3)
    mesh.ray = RayMeshIntersector(mesh)
    return mesh


def random_rays(count, seed=1):
    random = np.random.default_rng(seed)
    return random.uniform(-2, 2, (count, 3)), random.normal(size=(count, 3))


def test_dtypes_and_order(ball):
    origins, directions = random_rays(500)
    triangles, rays = ball.ray.intersects_id(origins, directions)
    assert triangles.dtype == rays.dtype == np.int64 and (np.diff(rays) >= 0).all()
    locations, rays_again, triangles_again = ball.ray.intersects_location(origins, directions)
    assert locations.dtype == np.float64 and locations.shape == (len(rays), 3)
    assert (rays_again == rays).all() and (triangles_again == triangles).all()
    depth = np.einsum("ij,ij->i", locations - origins[rays], directions[rays])
    assert (np.diff(depth)[np.diff(rays) == 0] >= 0).all()
    first, any_hit = ball.ray.intersects_first(origins, directions), ball.ray.intersects_any(origins, directions)
    assert first.dtype == np.int32 and any_hit.dtype == bool
    assert ((first >= 0) == any_hit).all() and (np.isin(np.arange(500), rays) == any_hit).all()
    one_each = ball.ray.intersects_id(origins, directions, multiple_hits=False)
    assert (one_each[0] == first[any_hit]).all() and (one_each[1] == np.flatnonzero(any_hit)).all()
    assert len(ball.ray.intersects_id(origins, directions, max_hits=1)[0]) == any_hit.sum()


def test_empty(ball):
    nothing = np.zeros((0, 3))
    locations, rays, triangles = ball.ray.intersects_location(nothing, nothing)
    assert locations.shape == (0, 3) and rays.shape == triangles.shape == (0,)
    assert ball.ray.intersects_first(nothing, nothing).shape == (0,)
    far = ball.ray.intersects_location([[9, 9, 9]], [[0, 0, 1]])
    assert [len(a) for a in far] == [0, 0, 0]


def test_locations_are_float64s(ball):
    far = 1e6 + np.array([0.123456789, 0, 0])
    ball.apply_translation(far)
    origins, directions = random_rays(300)
    locations, rays, triangles = ball.ray.intersects_location(origins + far, directions)
    assert len(rays) > 50
    corners = ball.triangles[triangles]
    normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals /= np.linalg.norm(normals, axis=1, keepdims=True)
    assert np.abs(np.einsum("ij,ij->i", locations - corners[:, 0], normals)).max() < 1e-8
    off_ray = np.cross(locations - (origins + far)[rays], directions[rays])
    assert np.linalg.norm(off_ray, axis=1).max() < 1e-7


def test_follows_the_mesh(ball):
    assert ball.ray.intersects_any([[0, 0, 4]], [[0, 0, -1]]).all()
    ball.apply_translation([5, 0, 0])
    assert not ball.ray.intersects_any([[0, 0, 4]], [[0, 0, -1]]).any()
    assert ball.ray.intersects_any([[5, 0, 4]], [[0, 0, -1]]).all()


def test_is_pickled_and_copied(ball):
    for copied in (pickle.loads(pickle.dumps(ball.ray)), copy.deepcopy(ball.ray)):
        assert copied.intersects_any([[0, 0, 4]], [[0, 0, -1]]).all()


def test_contains(ball):
    points = np.random.default_rng(2).uniform(-1.5, 1.5, (2000, 3))
    radius = np.linalg.norm(points, axis=1)
    inside = ball.ray.contains_points(points)
    assert inside[radius < 0.98].all() and not inside[radius > 1].any()
    assert (ball.contains(points) == inside).all()


def test_scales_and_lengths_do_not_matter():
    origins, directions = random_rays(300)
    expected = None
    for scale in (1e-9, 1e-3, 1, 1e6, 1e12):
        mesh = trimesh.creation.icosphere(2, radius=scale)
        found = RayMeshIntersector(mesh).intersects_first(origins * scale, directions * 1e-20)
        expected = found if expected is None else expected
        assert (found == expected).mean() > 0.995  # float32's rounding moves a few to a neighbour
        assert ((found >= 0) == (expected >= 0)).mean() > 0.995


def engines(*meshes):
    return [type(mesh.ray) is RayMeshIntersector for mesh in meshes]


def test_use_makes_it_the_engine_of_all_new_meshes():
    before = trimesh.creation.box()
    with use(level="refined") as used:
        boxes = trimesh.util.concatenate([before, trimesh.creation.box(transform=[[1, 0, 0, 5], *np.eye(4)[1:]])])
        parts = [before.copy(), copy.deepcopy(before), boxes.submesh([[0, 1, 2]], append=True), *boxes.split()]
        assert len(parts) == 5 and all(engines(boxes, *parts)) and not any(engines(before))
        assert all(part.ray.scene.backend["level"] == "refined" for part in parts[:2])
        assert boxes.contains([[5, 0, 0], [9, 0, 0]]).tolist() == [True, False]
        pickled = pickle.loads(pickle.dumps(boxes))
        with use(level="fast"):
            assert trimesh.creation.box().ray.scene.backend["level"] == "fast"
        assert trimesh.creation.box().ray.scene.backend["level"] == "refined"
    after = trimesh.creation.box()
    assert not any(engines(after, before.copy(), boxes.copy())) and all(engines(boxes, pickled))
    used.undo()
    once = use()
    assert all(engines(trimesh.creation.box()))
    once.undo()
    assert not any(engines(trimesh.creation.box()))


def test_meshes_are_pickled_and_copied_with_their_engine(ball):
    ball.ray.intersects_any([[0, 0, 4]], [[0, 0, -1]])
    pickled = pickle.loads(pickle.dumps(ball))
    assert engines(pickled) == [True] and pickled.ray.mesh is pickled
    assert pickled.ray.intersects_any([[0, 0, 4]], [[0, 0, -1]]).all()
