"""What all tests of the Python package share."""

import os
import subprocess
import sys

import numpy as np
import pytest
import twinray


@pytest.fixture(params=["sw", "hw"])
def accel(request):
    try:
        twinray.Scene(request.param)
    except twinray.Error as error:
        if "ray_tracing" in os.environ.get("TWINRAY_REQUIRE", ""):
            raise
        pytest.skip(str(error))
    return request.param


def needed(module):
    """The module, which tools/test.sh installs: where TWINRAY_REQUIRE names python it must be there, else it may."""
    if "python" in os.environ.get("TWINRAY_REQUIRE", ""):
        return __import__(module, fromlist=["_"])
    return pytest.importorskip(module)


def grid(n, seed=1):
    """A height field of n x n squares over (0, 1) x (0, 1), two triangles each."""
    height = np.random.default_rng(seed).uniform(0, 0.1, (n + 1, n + 1))
    x, y = np.meshgrid(np.linspace(0, 1, n + 1), np.linspace(0, 1, n + 1), indexing="ij")
    vertices = np.stack([x, y, height], axis=-1).reshape(-1, 3).astype(np.float32)
    i = np.arange((n + 1) * (n + 1)).reshape(n + 1, n + 1)
    a, b, c, d = i[:-1, :-1], i[1:, :-1], i[1:, 1:], i[:-1, 1:]
    triangles = np.concatenate([np.stack([a, b, c], -1).reshape(-1, 3), np.stack([a, c, d], -1).reshape(-1, 3)])
    return vertices, triangles.astype(np.uint32)


def cube(size=1.0):
    """A closed cube, fronts outward."""
    vertices = np.array([[x, y, z] for x in (0, 1) for y in (0, 1) for z in (0, 1)], np.float32) * size
    sides = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
    return vertices, np.array(sides, np.uint32)[:, [0, 1, 2, 0, 2, 3]].reshape(-1, 3)


def scene_of(*meshes, **options):
    """A scene of arrays of vertices and triangles."""
    scene = twinray.Scene(**options)
    for mesh in meshes:
        scene.add_triangles(*mesh)
    return scene


def write_obj(file, vertices, triangles, form="v {} {} {}"):
    lines = [form.format(*vertex) for vertex in vertices]
    file.write_text("\n".join([*lines, *(f"f {a + 1} {b + 1} {c + 1}" for a, b, c in triangles)]))


def run_python(code, **environment):
    """Run a program by this Python, with these variables beside those of the environment."""
    return subprocess.run(
        [sys.executable, "-c", code], env=os.environ | environment, capture_output=True, text=True, timeout=120
    )


def raster(rows=40, columns=50, seed=2, step=10.0):
    """A raster of random heights with a hole, as a DataArray whose rows go south."""
    heights = np.random.default_rng(seed).uniform(0, 4, (rows, columns))
    heights[10:14, 20:25] = np.nan
    coords = {"y": -step * np.arange(rows), "x": step * np.arange(columns)}
    return needed("xarray").DataArray(heights, dims=("y", "x"), coords=coords)


def same(a, b):
    """Whether two arrays have the same bits; NaN is equal to NaN."""
    return np.array_equal(a, b, equal_nan=a.dtype.kind == "f")
