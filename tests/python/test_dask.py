"""twinray.dask: the same bits for any chunks, workers and restarts."""

import os
import re
import signal
import subprocess
import sys
import threading
import time
from pathlib import Path

import numpy as np
import pytest
import twinray
from conftest import grid, needed, raster, same, scene_of

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


@pytest.mark.parametrize("chunk", [500, 77])
def test_rays_are_those_of_a_scene(accel, rays, chunk):
    scene = scene_of(grid(20), accel=accel)
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
    scene = scene_of(grid(20))
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
    scene = scene_of(grid(4))
    found = td.illumination(grid(4), da.from_array(directions, chunks=(2, 3)), side=50, seed=3)
    for i, direction in enumerate(directions):
        wanted = twinray.illumination(scene, direction, side=50, seed=3)
        assert all(same(found[name][i].compute(), wanted[name]) for name in wanted)


@pytest.mark.parametrize("estimator", ["auto", "hits"])
def test_rows_of_view_factors(estimator):
    scene = scene_of(grid(8))
    groups = np.arange(128) // 2 if estimator == "hits" else None
    options = {"groups": groups, "rays": 256, "estimator": estimator, "seed": 5}
    wanted = twinray.view_factors(scene, **options)
    for chunk in (1, 17, 1000):
        assert all(map(same, dask.compute(*td.view_factors(grid(8), chunk=chunk, **options)), wanted))
    blocks = td.view_factors(grid(8), chunk=17, sparse=True, **options)[0]
    assert same(blocks.compute().toarray(), wanted[0])
    parts = dask.compute(*blocks.to_delayed().ravel())
    assert [type(part).__name__ for part in parts] == ["csr_matrix"] * len(blocks.chunks[0])


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


def test_workers_share_out_gpus(monkeypatch):
    monkeypatch.delenv("SLURM_LOCALID", raising=False)
    kinds = ["discrete GPU", "CPU", "discrete GPU"]
    assert [_workers._dealt(kinds, name, "tcp://host:1") for name in (0, 1, 2)] == ["0", "2", "0"]
    assert _workers._dealt(kinds, "a-name", "tcp://host:40001") == "2"
    assert _workers._dealt(kinds, "SLURMCluster-3", "tcp://host:2") == "2"
    assert _workers._dealt(["CPU"], 0, "tcp://host:1") is None
    assert _workers._dealt(["integrated GPU", "discrete GPU"], 0, "tcp://host:1") is None
    monkeypatch.setenv("SLURM_LOCALID", "1")
    assert _workers._dealt(kinds, "a-name", "tcp://host:40002") == "2"


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
    scene = scene_of(([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]))
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
