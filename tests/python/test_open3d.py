# SPDX-License-Identifier: MIT
"""The same questions to Open3D, where it is installed: names, shapes, dtypes, values. Its wheel has 400 MB, which CI
goes without."""

import numpy as np
import pytest

o3d = pytest.importorskip("open3d")

import twinray  # noqa: E402
from conftest import grid  # noqa: E402

RANDOM = np.random.default_rng(0)
RAYS = np.hstack([RANDOM.uniform(-1, 2, (1000, 3)), RANDOM.normal(size=(1000, 3))]).reshape(10, 100, 6)
POINTS = RANDOM.uniform(-1, 2, (20, 30, 3))
QUESTIONS = {
    "cast_rays": RAYS, "test_occlusions": RAYS, "count_intersections": RAYS, "list_intersections": RAYS,
    "compute_closest_points": POINTS, "compute_distance": POINTS,
}  # fmt: skip


@pytest.fixture(scope="module")
def scenes():
    vertices, triangles = (o3d.core.Tensor(a) for a in grid(20))
    theirs, ours = o3d.t.geometry.RaycastingScene(), twinray.Scene()
    assert theirs.add_triangles(vertices, triangles) == ours.add_triangles(vertices, triangles)
    return theirs, ours


@pytest.mark.parametrize("question", QUESTIONS)
def test_answers_are_alike(scenes, question):
    asked = o3d.core.Tensor(QUESTIONS[question].astype(np.float32))
    theirs, ours = (getattr(scene, question)(asked) for scene in scenes)
    if not isinstance(ours, dict):
        theirs, ours = {"": theirs}, {"": ours}
    assert set(theirs) == set(ours)
    for name in theirs:
        a, b = theirs[name].numpy(), ours[name].numpy()
        assert a.shape == b.shape and a.dtype == b.dtype, name
        if name in ("", "t_hit", "points", "geometry_ids", "ray_ids", "ray_splits"):
            both = np.isfinite(a) & np.isfinite(b)
            assert (both == np.isfinite(a)).mean() > 0.999, name
            assert np.abs(a[both].astype(float) - b[both]).max() < 1e-4, name


def test_meshes_and_cameras():
    legacy = o3d.geometry.TriangleMesh.create_sphere()
    tensor = o3d.t.geometry.TriangleMesh.from_legacy(legacy)
    for mesh in (legacy, tensor):
        scene = twinray.Scene()
        scene.add_triangles(mesh)
        assert abs(scene.compute_distance([0, 0, 3]) - 2) < 1e-6
    camera = {"fov_deg": 70, "center": [0, 0, 2], "eye": [2, 3, 0], "up": [0, 1, 0], "width_px": 64, "height_px": 48}
    theirs = o3d.t.geometry.RaycastingScene.create_rays_pinhole(**camera).numpy()
    assert np.abs(theirs - twinray.Scene.create_rays_pinhole(**camera)).max() < 1e-5
