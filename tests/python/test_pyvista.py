# SPDX-License-Identifier: MIT
"""Meshes of PyVista, as they are."""

import numpy as np
import pytest
import twinray

pyvista = pytest.importorskip("pyvista")

MESHES = {
    "cylinder": lambda: pyvista.Cylinder(),  # quads between polygons
    "cone": lambda: pyvista.Cone(),
    "clip": lambda: pyvista.Box().clip(normal=(1, 1, 1)),
    "sphere": lambda: pyvista.Sphere(),
    "quads": lambda: pyvista.Box(),
    "strips": lambda: pyvista.Sphere().strip(),
    "faces and lines": lambda: pyvista.Sphere() + pyvista.Line(),
    "a triangle and a quad": lambda: pyvista.PolyData(
        np.array([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0], [2, 0, 0]], float), [3, 1, 4, 2, 4, 0, 1, 2, 3]
    ),
    "nothing": lambda: pyvista.PolyData(),
}


@pytest.mark.parametrize("name", MESHES)
def test_meshes_load(name):
    mesh = MESHES[name]()
    scene = twinray.Scene()
    scene.add_triangles(mesh)
    triangles = scene.world_triangles().reshape(-1, 3, 3)
    areas = np.linalg.norm(np.cross(triangles[:, 1] - triangles[:, 0], triangles[:, 2] - triangles[:, 0]), axis=1) / 2
    assert areas.sum() == pytest.approx(mesh.area, rel=1e-5)
    assert len(triangles) == len(mesh.triangulate().faces) // 4


def test_a_cylinder_is_closed():
    scene = twinray.Scene()
    scene.add_triangles(pyvista.Cylinder(radius=1, height=2))
    assert scene.compute_occupancy([[0, 0, 0], [0.9, 0, 0], [2, 0, 0]]).tolist() == [1, 1, 0]


@pytest.mark.parametrize("make", ["ImageData", "UnstructuredGrid"])
def test_grids_are_refused_with_what_to_do(make):
    grid = pyvista.ImageData(dimensions=(3, 3, 3))
    grid = grid if make == "ImageData" else grid.cast_to_unstructured_grid()
    with pytest.raises(TypeError, match=rf"{make}.*extract_surface\(\)"):
        twinray.Scene().add_triangles(grid)
