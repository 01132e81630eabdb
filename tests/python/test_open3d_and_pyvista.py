"""Open3D and PyVista, where they are installed: the same questions to Open3D have answers of the same names, shapes,
dtypes and values, and meshes of both are taken as they are. Open3D's wheel has 400 MB, which CI goes without."""

import numpy as np
import pytest
import twinray
from conftest import grid

RANDOM = np.random.default_rng(0)
RAYS = np.hstack([RANDOM.uniform(-1, 2, (1000, 3)), RANDOM.normal(size=(1000, 3))]).reshape(10, 100, 6)
POINTS = RANDOM.uniform(-1, 2, (20, 30, 3))
QUESTIONS = {
    "cast_rays": RAYS, "test_occlusions": RAYS, "count_intersections": RAYS, "list_intersections": RAYS,
    "compute_closest_points": POINTS, "compute_distance": POINTS,
}  # fmt: skip


@pytest.fixture(scope="module")
def o3d():
    return pytest.importorskip("open3d")


@pytest.fixture(scope="module")
def pyvista():
    return pytest.importorskip("pyvista")


@pytest.fixture(scope="module")
def scenes(o3d):
    vertices, triangles = (o3d.core.Tensor(a) for a in grid(20))
    theirs, ours = o3d.t.geometry.RaycastingScene(), twinray.Scene()
    assert theirs.add_triangles(vertices, triangles) == ours.add_triangles(vertices, triangles)
    return theirs, ours


@pytest.mark.parametrize("question", QUESTIONS)
def test_answers_are_alike(o3d, scenes, question):
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


def test_meshes_and_cameras(o3d):
    legacy = o3d.geometry.TriangleMesh.create_sphere()
    tensor = o3d.t.geometry.TriangleMesh.from_legacy(legacy)
    for mesh in (legacy, tensor):
        scene = twinray.Scene()
        scene.add_triangles(mesh)
        assert abs(scene.compute_distance([0, 0, 3]) - 2) < 1e-6
    camera = {"fov_deg": 70, "center": [0, 0, 2], "eye": [2, 3, 0], "up": [0, 1, 0], "width_px": 64, "height_px": 48}
    theirs = o3d.t.geometry.RaycastingScene.create_rays_pinhole(**camera).numpy()
    assert np.abs(theirs - twinray.Scene.create_rays_pinhole(**camera)).max() < 1e-5


MESHES = {
    "cylinder": lambda pyvista: pyvista.Cylinder(),  # quads between polygons
    "cone": lambda pyvista: pyvista.Cone(),
    "clip": lambda pyvista: pyvista.Box().clip(normal=(1, 1, 1)),
    "sphere": lambda pyvista: pyvista.Sphere(),
    "quads": lambda pyvista: pyvista.Box(),
    "strips": lambda pyvista: pyvista.Sphere().strip(),
    "faces and lines": lambda pyvista: pyvista.Sphere() + pyvista.Line(),
    "a triangle and a quad": lambda pyvista: pyvista.PolyData(
        np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [2, 0, 0]], float), [3, 1, 4, 2, 4, 0, 1, 2, 3]
    ),
    "nothing": lambda pyvista: pyvista.PolyData(),
}


@pytest.mark.parametrize("name", MESHES)
def test_meshes_load(pyvista, name):
    mesh = MESHES[name](pyvista)
    scene = twinray.Scene()
    scene.add_triangles(mesh)
    triangles = scene.world_triangles().reshape(-1, 3, 3)
    areas = np.linalg.norm(np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]), axis=1) / 2
    assert areas.sum() == pytest.approx(mesh.area, rel=1e-5)
    assert len(triangles) == len(mesh.triangulate().faces) // 4


def test_a_cylinder_is_closed(pyvista):
    scene = twinray.Scene()
    scene.add_triangles(pyvista.Cylinder(radius=1, height=2))
    assert scene.compute_occupancy([[0, 0, 0], [0.9, 0, 0], [2, 0, 0]]).tolist() == [1, 1, 0]


@pytest.mark.parametrize("make", ["ImageData", "UnstructuredGrid"])
def test_grids_are_refused_with_what_to_do(pyvista, make):
    voxels = pyvista.ImageData(dimensions=(3, 3, 3))
    voxels = voxels if make == "ImageData" else voxels.cast_to_unstructured_grid()
    with pytest.raises(TypeError, match=rf"{make}.*extract_surface\(\)"):
        twinray.Scene().add_triangles(voxels)
