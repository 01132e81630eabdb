# SPDX-License-Identifier: MIT
"""twinray.dask and twinray.terrain: the same bits for any chunks, workers and restarts."""

import os
import re
import signal
import subprocess
import sys
import threading
import time
import warnings
from pathlib import Path

import numpy as np
import pytest
import twinray
from conftest import grid, needed

dask = needed("dask")
da = needed("dask.array")
needed("distributed")
xr = needed("xarray")
from twinray import _workers, terrain  # noqa: E402
from twinray import dask as td  # noqa: E402


@pytest.fixture
def rays():
    rng = np.random.default_rng(1)
    origins = np.concatenate([rng.uniform(0, 1, (500, 2)), np.full((500, 1), 2)], axis=1)
    return np.concatenate([origins, rng.normal(size=(500, 3)) - [0, 0, 2]], axis=1)


def raster(rows=40, columns=50, seed=2, step=10.0):
    heights = np.random.default_rng(seed).uniform(0, 4, (rows, columns))
    heights[10:14, 20:25] = np.nan
    coords = {"y": -step * np.arange(rows), "x": step * np.arange(columns)}
    return xr.DataArray(heights, dims=("y", "x"), coords=coords)


def same(a, b):
    return np.array_equal(a, b, equal_nan=a.dtype.kind == "f")


@pytest.mark.parametrize("chunk", [500, 77])
def test_rays_are_those_of_a_scene(accel, rays, chunk):
    scene = twinray.Scene(accel)
    scene.add_triangles(*grid(20))
    spec = td.SceneSpec(grid(20), accel=accel)
    chunked = da.from_array(rays, chunks=(chunk, 3))
    wanted, got = scene.cast_rays(rays), dask.compute(td.cast_rays(spec, chunked))[0]
    assert set(got) == set(wanted)
    assert all(same(got[name], wanted[name]) for name in wanted)
    assert got["t_hit"].dtype == np.float64
    assert same(td.test_occlusions(spec, chunked, 0.5, 3).compute(), scene.test_occlusions(rays, 0.5, 3).numpy())
    points = chunked[:, :3]
    assert same(td.compute_distance(spec, points).compute(), scene.compute_distance(rays[:, :3]).numpy())


def test_far_rays_have_one_dtype_in_all_chunks():
    far = np.array([[0.5, 0.5, 1e6, 0, 0, -1], [0.5, 0.5, 2, 0, 0, -1]])
    spec = td.SceneSpec(grid(4))
    whole = td.cast_rays(spec, da.from_array(far, chunks=(2, 6)))["t_hit"].compute()
    parts = td.cast_rays(spec, da.from_array(far, chunks=(1, 6)))["t_hit"].compute()
    assert same(whole, parts) and whole.dtype == np.float64


@pytest.mark.parametrize("has_normals", [False, True])
def test_sensors_see_the_same_in_any_chunks(has_normals):
    points = grid(20)[0] + np.float32([0, 0, 0.01])
    normals = np.tile(np.float32([0, 0.1, 1]), (len(points), 1)) if has_normals else None
    spec = td.SceneSpec(grid(20))
    directions, angles = twinray.sky_patches()
    scene = twinray.Scene()
    scene.add_triangles(*grid(20))
    seen = twinray.visible(points, directions, normals, scene=scene)
    views = []
    for chunk in (441, 100, 7):
        chunked = da.from_array(points, chunks=(chunk, 3))
        assert same(td.visible(spec, chunked, directions, normals).compute(), seen)
        views.append(td.sky_view(spec, chunked, normals).compute())
    assert all(same(view, views[0]) for view in views) and 0.5 < views[0].mean() < 1
    cosines = directions[:, 2] if normals is None else np.maximum(directions @ normals[0] / np.hypot(0.1, 1), 0)
    light = cosines * angles
    assert np.abs(views[0] - seen @ light / light.sum()).max() < 1e-6
    hours = td.sun_hours(spec, chunked, [[1, 0, 0.3], [0, 0, 1], [0, 0, -1]], [2, 3, 4], normals).compute()
    assert set(hours) <= {0, 2, 3, 5} and hours.max() == 5


def test_weights_choose_patches():
    spec, weights = td.SceneSpec(grid(4)), np.zeros(145)
    weights[144] = 5
    assert td.sky_view(spec, [[0.5, 0.5, 1], [0.5, 0.5, -1]], weights=weights).compute().tolist() == [1, 0]


def test_light_of_directions():
    directions = np.array([[0, 0, -1], [0.5, 0, -1], [0, 0.5, -1]])
    scene = twinray.Scene()
    scene.add_triangles(*grid(4))
    found = td.illumination(grid(4), da.from_array(directions, chunks=(2, 3)), side=50, seed=3)
    for i, direction in enumerate(directions):
        wanted = twinray.illumination(scene, direction, side=50, seed=3)
        assert all(same(found[name][i].compute(), wanted[name]) for name in wanted)


@pytest.mark.parametrize("estimator", ["auto", "hits"])
def test_rows_of_view_factors(estimator):
    scene = twinray.Scene()
    scene.add_triangles(*grid(8))
    groups = np.arange(128) // 2 if estimator == "hits" else None
    options = {"groups": groups, "rays": 256, "estimator": estimator, "seed": 5}
    wanted = twinray.view_factors(scene, **options)
    for chunk in (1, 17, 1000):
        assert all(map(same, dask.compute(*td.view_factors(grid(8), chunk=chunk, **options)), wanted))
    blocks = td.view_factors(grid(8), chunk=17, sparse=True, **options)[0]
    assert same(blocks.compute().toarray(), wanted[0])
    assert [type(b).__name__ for b in dask.compute(*blocks.to_delayed().ravel())] == ["csr_matrix"] * len(
        blocks.chunks[0]
    )


def test_data_arrays_keep_their_coordinates(rays):
    coords = {"sweep": [10, 20], "beam": np.arange(250), "when": ("sweep", [0.5, 1.5])}
    labelled = xr.DataArray(rays.reshape(2, 250, 6), dims=("sweep", "beam", "part"), coords=coords)
    found = td.cast_rays(grid(20), labelled.chunk({"sweep": 1}))
    assert found["primitive_uvs"].dims == ("sweep", "beam", "uv")
    assert found["t_hit"].sel(sweep=20).shape == (250,) and found.coords["when"].values.tolist() == [0.5, 1.5]
    seen = td.visible(grid(20), labelled[..., :3], [[0, 0, 1]])
    assert seen.dims == ("sweep", "beam", "vector") and seen.dtype == np.uint8


def test_scenes_are_known_by_their_content(tmp_path):
    vertices, triangles = grid(3)
    keys = {td.SceneSpec((vertices, triangles)).key, td.SceneSpec((vertices.copy(), triangles.tolist())).key}
    assert len(keys) == 1
    assert td.SceneSpec((vertices * 2, triangles)).key not in keys
    assert td.SceneSpec((vertices, triangles), level="refined").key not in keys
    file = tmp_path / "triangle.obj"
    file.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")
    spec = td.SceneSpec(file)
    assert spec.face_count() == 1 and td.SceneSpec(str(file)).key == spec.key
    rays = da.from_array(np.float32([[0.2, 0.2, 1, 0, 0, -1]]), chunks=(1, 6))
    assert td.test_occlusions(spec, rays).compute().tolist() == [True]
    file.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 1\nf 1 2 3\n")
    _workers.forget_scenes()
    with pytest.raises(twinray.Error, match="another one than when"):
        td.test_occlusions(spec, rays).compute()


def test_wrong_arguments_are_told_before_work():
    spec = td.SceneSpec(grid(3))
    for wrong, name in [
        (lambda: td.cast_rays(spec, np.zeros((3, 5))), r"rays: shape \(3, 5\)"),
        (lambda: td.visible(spec, np.zeros((3, 3)), [[0, 0, 1]], np.zeros((2, 3))), "normals: shape"),
        (lambda: td.sky_view(spec, np.zeros((3, 3)), weights=[1, 2]), "weights: shape"),
        (lambda: td.view_factors(spec, chunk=0), "chunk: 0"),
        (lambda: td.view_factors(spec, sides="back"), "sides: 'back'"),
        (lambda: terrain.sky_view(np.zeros((3, 3))), "spacing: an array"),
        (lambda: terrain.sky_view(np.zeros(3), 1), "heights: shape"),
        (lambda: terrain.sky_view(np.zeros((3, 3)), 0), "spacing: 0"),
        (lambda: terrain.horizon(np.zeros((3, 3)), 1, azimuths=0), "azimuths: 0"),
        (lambda: terrain.horizon(np.zeros((3, 3)), 1, relief=np.inf), "relief: inf"),
        (lambda: terrain.horizon(np.eye(3), 1, relief=0.5).compute(), "relief: 0.5; heights of this tile differ by 1"),
        (lambda: terrain.horizon(raster().transpose()), r"dimensions \('x', 'y'\)"),
        (lambda: terrain.horizon(raster().rename(x="lon", y="lat")), "coordinates are degrees"),
        (lambda: terrain.horizon(np.zeros((3, 3)), 1, lowest=90), "lowest: 90"),
        (lambda: terrain.sky_view(np.zeros((3, 3)), 1, weights=[1]), "weights: they are of patches"),
        (lambda: terrain.visible(np.zeros((3, 3)), [[0, 0, -1]], 1), "vectors: not all"),
        (lambda: terrain.sky_view(raster().assign_coords(x=np.arange(50.0) ** 2)), "'x' are not evenly spaced"),
    ]:
        with pytest.raises(ValueError, match=name):
            wrong()
    with pytest.raises(TypeError, match="a Scene is of one process"):
        td.cast_rays(twinray.Scene(), np.zeros((3, 6)))
    with pytest.raises(TypeError, match="unknown options"):
        terrain.sky_view(np.zeros((3, 3)), 1, sides="front")


@pytest.mark.parametrize("failures", [1, 2])
def test_a_device_that_fails_is_asked_once_more(monkeypatch, rays, failures):
    left = [failures]
    asked = twinray.Scene.test_occlusions

    def failing(scene, *arguments):
        if left[0]:
            left[0] -= 1
            raise twinray.Error("the device was lost")
        return asked(scene, *arguments)

    chunked = da.from_array(rays, chunks=(250, 6))
    spec = td.SceneSpec(grid(20))
    wanted = td.test_occlusions(spec, chunked).compute()
    monkeypatch.setattr(twinray.Scene, "test_occlusions", failing)
    work = td.test_occlusions(spec, chunked)
    if failures == 1:
        assert same(work.compute(scheduler="sync"), wanted)
    else:
        with pytest.raises(
            twinray.Error, match=r"occluded of chunk \[(0:250|250:500)\], on device '.+': the device was lost"
        ):
            work.compute(scheduler="sync")


def test_workers_take_turns_on_gpus(monkeypatch):
    monkeypatch.delenv("SLURM_LOCALID", raising=False)
    kinds = ["discrete GPU", "CPU", "discrete GPU"]
    assert [_workers._dealt(kinds, name, "tcp://host:1") for name in (0, 1, 2)] == ["0", "2", "0"]
    assert _workers._dealt(kinds, "a-name", "tcp://host:40001") == "2"
    assert _workers._dealt(kinds, "SLURMCluster-3", "tcp://host:2") == "2"
    assert _workers._dealt(["CPU"], 0, "tcp://host:1") is None
    assert _workers._dealt(["integrated GPU", "discrete GPU"], 0, "tcp://host:1") is None
    monkeypatch.setenv("SLURM_LOCALID", "1")
    assert _workers._dealt(kinds, "a-name", "tcp://host:40002") == "2"


# Terrain


def test_tiles_and_chunks_do_not_change_terrain():
    heights = raster()
    views = [
        terrain.sky_view(each, tile=tile) for each, tile in [(heights, 64), (heights, 16), (heights.chunk(13), 16)]
    ]
    assert views[0].dims == ("y", "x") and same(views[0].coords["x"].values, heights.coords["x"].values)
    assert len(views[1].chunks[0]) == 3
    values = [view.compute().values for view in views]
    assert all(same(each, values[0]) for each in values[1:]) and values[0].dtype == np.float32
    assert same(np.isnan(values[0]), np.isnan(heights.values))
    assert 0.8 < np.nanmin(values[0]) < np.nanmax(values[0]) <= 1


def test_terrain_against_a_scene_of_all():
    heights = raster()
    heights[:] = np.nan_to_num(heights)
    there = np.ones(heights.shape, bool)
    x, y = np.meshgrid(heights.x, heights.y)
    vertices = np.stack([x, y, heights], axis=-1)
    scene = twinray.Scene()
    scene.add_triangles(vertices.reshape(-1, 3), terrain.triangles_of(there))
    directions, _ = twinray.sky_patches()
    points = vertices.reshape(-1, 3) + [0, 0, 10 / 1024]
    wanted = twinray.visible(points, directions, scene=scene, tnear=1e-9).reshape(*there.shape, -1)
    found = terrain.visible(heights, directions, tile=16).compute()
    assert (found != wanted).mean() < 1e-4  # rays within rounding of an edge


def true_slope(z, row, column, way, bend=0.0):
    """In float64, by all edges of the triangles: the steepest crossing with a line of columns and rows per length."""
    corners = terrain.triangles_of(np.isfinite(z)).astype(np.int64)
    p, q = np.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]]).T
    places = [np.column_stack([each % z.shape[1] - column, each // z.shape[1] - row]) for each in (p, q)]
    off = [xy[:, 0] * way[1] - xy[:, 1] * way[0] for xy in places]
    off = [np.where(np.abs(each) < 1e-9 * np.abs(way).max(), 0, each) for each in off]  # vertices on the line
    crosses = (off[0] * off[1] <= 0) & (off[0] != off[1])
    part = off[0][crosses] / (off[0] - off[1])[crosses]
    along = ((places[0][crosses].T * (1 - part) + places[1][crosses].T * part).T @ way) / (way @ way)
    heights = z.ravel()[p][crosses] * (1 - part) + z.ravel()[q][crosses] * part
    ahead = along > 1e-9
    slopes = (heights[ahead] - z[row, column]) / along[ahead] - bend * along[ahead] / 2
    return max(0.0, slopes.max(initial=0.0))


# Some ways lead along rows, columns and diagonals, from cells at the border and beside holes.
@pytest.mark.parametrize(("curvature", "azimuths", "oblong"), [(0.0, 9, 1.5), (1.0, 9, 1.5), (0.0, 2, 1), (0.0, 4, 1)])
def test_the_horizon_is_exact(curvature, azimuths, oblong):
    heights = np.round(raster(rows=30, columns=41, step=512.0) * 1600) / 16  # with holes; terrain rounds as much
    heights = heights.assign_coords(y=heights.y * oblong)
    options = {"azimuths": azimuths, "lowest": 0.1, "curvature": curvature}
    found = terrain.horizon(heights, tile=16, **options).compute().values
    assert same(found, terrain.horizon(heights, tile=64, **options).compute().values)
    largest = 0.0
    cells = [
        *np.random.default_rng(3).integers(0, (30, 41), (40, 2)),
        (0, 7),
        (29, 9),
        (11, 0),
        (5, 40),
        (9, 22),
        (12, 19),
    ]
    for row, column in cells:
        if np.isnan(heights.values[row, column]):
            assert np.isnan(found[row, column]).all()
            continue
        for k in range(azimuths):
            angle = (k + 0.5) * 2 * np.pi / azimuths
            way = np.array([np.sin(angle) / 512, -np.cos(angle) / (512 * oblong)])
            wanted = true_slope(heights.values, row, column, way, curvature / terrain.EARTH_RADIUS)
            largest = max(largest, abs(np.degrees(np.arctan(wanted)) - found[row, column, k]))
    assert largest < 1e-5
    assert np.nanmax(found) > 10


def test_tiles_round_high_mountains_alike():
    heights = raster(step=1.0)
    heights[:, 20:] += 5000.3  # 5,000 cells high
    options = {"azimuths": 8, "lowest": 40.0}
    found = [terrain.horizon(heights, tile=tile, **options).compute().values for tile in (64, 16, 7)]
    assert all(same(each, found[0]) for each in found[1:])


def test_the_sky_is_what_is_above_the_horizon():
    heights = raster()
    options = {"azimuths": 8, "lowest": 0.5}
    found = terrain.horizon(heights, tile=16, **options).compute()
    assert found.dims == ("y", "x", "azimuth") and found.attrs["units"] == "degrees" and found.name == "horizon"
    view = terrain.sky_view(heights, tile=64, **options).compute().values
    assert np.nanmax(np.abs(view - (np.cos(np.radians(found.values)) ** 2).mean(axis=2))) < 1e-6
    assert same(np.isnan(view), np.isnan(heights.values))
    whole = terrain.sky_view(heights, tile=64, measure="solid_angle", **options).compute().values
    assert np.nanmax(np.abs(whole - (1 - np.sin(np.radians(found.values))).mean(axis=2))) < 1e-6
    wall = np.zeros((3, 64))
    wall[:, 40:] = 1000.0
    east = terrain.horizon(wall, 10.0, azimuths=2).compute()[:, 30, 0]
    assert np.abs(east - np.degrees(np.arctan(1000 / 100))).max() < 1e-5
    assert (terrain.horizon(wall[:, :30], 10.0).compute() == 0).all()
    assert (terrain.horizon(wall[:1], 10.0).compute() == 0).all()  # a row has no surface


def test_a_night_has_no_sun():
    heights = raster()
    for found in (terrain.sun_hours(heights, [[0, 0, -1]]), terrain.sun_hours(heights, np.zeros((0, 3)), [])):
        assert np.nanmax(found.compute().values) == 0
    points = np.zeros((5, 3))
    assert td.sun_hours(grid(3), points, [[0, 0, -1]]).compute().tolist() == [0] * 5


def test_values_that_say_no_height_are_holes():
    heights = raster()
    filled = heights.fillna(-9999).assign_attrs(_FillValue=-9999.0)
    assert same(terrain.sky_view(filled).compute().values, terrain.sky_view(heights).compute().values)


def test_a_wall_hides_what_it_must():
    heights = np.zeros((64, 64))
    heights[:, 40:] = 30.0  # a step of 30 m, with cells of 10 m
    sun = [[1.0, 0, slope] for slope in (0.25, 0.5, 1.0)]
    hours = terrain.sun_hours(heights, sun, [1, 10, 100], 10.0, tile=16).compute()
    # At 100 m before the edge it rises by 0.3, at 190 m by 0.16.
    assert hours[30, 30] == 110 and hours[30, 20] == 111 and hours[30, 36] == 100
    assert terrain.sun_hours(heights, sun, 1, (10.0, 10.0), tile=16, height=40).compute().min() == 3


def test_a_curved_earth_hides_less_of_the_sky():
    heights = np.zeros((8, 400))
    heights[:, 300:] = 500.0  # 200 cells of 100 m off: 20 km, over which the earth falls by 31 m
    sun = [[1, 0, 484 / 20000], [1, 0, 463 / 20000]]
    flat, curved = (
        terrain.sun_hours(heights, sun, 1, 100.0, curvature=c, tile=512).compute()[4, 100] for c in (0.0, 1.0)
    )
    assert (flat, curved) == (0, 1)


def test_degrees_are_refused():
    needed("rioxarray")
    heights = raster().rio.write_crs("EPSG:4326")
    with pytest.raises(ValueError, match="coordinates are degrees"):
        terrain.sky_view(heights)
    assert terrain.sky_view(heights, 30.0).shape == heights.shape


def test_a_map_goes_to_zarr(tmp_path):
    zarr = needed("zarr")
    view = terrain.sky_view(raster(), tile=16)
    view.data.to_zarr(str(tmp_path / "view.zarr"))
    assert same(zarr.open(str(tmp_path / "view.zarr"))[:], view.compute().values)


def test_a_geotiff_becomes_a_map(tmp_path):
    needed("rioxarray")
    heights = raster().rio.write_crs("EPSG:25832")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        heights.rio.write_nodata(np.nan).rio.to_raster(tmp_path / "heights.tif")
    found = terrain.sun_hours(tmp_path / "heights.tif", [[1, 0, 0.1], [0, 0, 1]], tile=32)
    wanted = terrain.sun_hours(raster(), [[1, 0, 0.1], [0, 0, 1]])
    assert same(found.compute().values, wanted.compute().values)


# Workers


def slow(block):
    time.sleep(0.1)
    return block


def test_a_killed_worker_changes_no_bit():
    from distributed import Client, LocalCluster

    points = grid(60)[0] + np.float32([0, 0, 0.01])
    wanted = td.sky_view(grid(60), points).compute()
    heights = raster()
    with (
        dask.config.set({"distributed.scheduler.allowed-failures": 10}),
        LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster,
        Client(cluster) as client,
    ):
        chunked = da.from_array(points, chunks=(100, 3)).map_blocks(slow, dtype=points.dtype)
        future = client.compute(td.sky_view(grid(60), chunked))
        pids = client.run(os.getpid)
        assert len(set(pids.values())) == 2

        def kill():
            os.kill(next(iter(pids.values())), signal.SIGKILL)

        threading.Timer(1.0, kill).start()
        assert same(future.result(timeout=120), wanted)
        assert set(client.run(os.getpid).values()) != set(pids.values())
        over_workers = client.compute(terrain.sky_view(heights, tile=16)).result(timeout=120)
    assert same(over_workers.values, terrain.sky_view(heights, tile=64).compute().values)


# Pages


def blocks_of(page, mark):
    """The blocks of Python of a page whose fence says so."""
    text = (Path(__file__).resolve().parents[2] / "docs" / page).read_text(encoding="utf-8")
    return re.findall(rf"```python [^\n]*{mark}[^\n]*\n(.*?)```", text, re.DOTALL)


def run_in(folder, block):
    path = Path(twinray.__file__).parents[1]
    environment = os.environ | {"PYTHONPATH": str(path), "MPLBACKEND": "Agg", "PYTHONWARNINGS": "ignore"}
    file = folder / "block.py"
    file.write_text(block)
    done = subprocess.run([sys.executable, file], cwd=folder, env=environment, capture_output=True, text=True)
    assert done.returncode == 0, done.stdout + done.stderr
    return done.stdout


def test_the_example_of_ray(tmp_path):
    pytest.importorskip("ray")
    (block,) = blocks_of("python.md", "needs Ray")
    assert len(block.strip().splitlines()) <= 24
    scene = twinray.Scene()
    scene.add_triangles([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    rays = np.random.default_rng(1).uniform(-1, 1, (100_000, 6))
    assert run_in(tmp_path, block).strip().endswith(str(scene.test_occlusions(rays).mean()))


def test_the_page_of_sun_hours(tmp_path):
    needed("rioxarray")
    needed("matplotlib")
    blocks = blocks_of("how-to/sun_hours_of_a_raster.md", "dask")
    assert len(blocks) == 2
    out = [run_in(tmp_path, block) for block in blocks]
    low, high = map(float, re.findall(r"[\d.]+", out[1]))
    assert 0 < low < high <= 16
    assert (tmp_path / "hours.tif").exists() and (tmp_path / "hours.png").exists()
