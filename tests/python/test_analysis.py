"""What rays tell of scenes, against what is known of them."""

import re

import numpy as np
import pytest
import twinray
from conftest import cube, grid, needed, scene_of


def room():
    """A closed cube seen from inside: fronts inward."""
    vertices, triangles = cube()
    return scene_of((vertices, triangles[:, ::-1]))


def test_view_factors_of_a_cube():
    groups = np.repeat(np.arange(6), 2)  # its sides
    factors, half = twinray.view_factors(room(), groups)
    opposite, beside = 0.199825, 0.200044  # Howell's catalog, C-11 and C-14
    expected = np.full((6, 6), beside) - np.eye(6) * beside
    for i, j in ((0, 1), (2, 3), (4, 5)):
        expected[i, j] = expected[j, i] = opposite
    assert factors.shape == half.shape == (6, 6) and np.abs(factors - expected).max() < 1e-5
    by_hits, width = twinray.view_factors(room(), groups, estimator="hits", rays=4096)
    assert (np.abs(by_hits - expected) <= 1.5 * width)[expected > 0].mean() > 0.9 and (width[expected > 0] > 0).all()
    assert np.allclose(by_hits.sum(axis=1), 1)
    each, _ = twinray.view_factors(room())
    assert each.shape == (12, 12) and np.allclose(each.sum(axis=1), 1, atol=1e-4)


def test_sparse_is_the_same():
    scipy = needed("scipy.sparse")
    dense, _ = twinray.view_factors(room(), estimator="hits", rays=1024)
    sparse, _ = twinray.view_factors(room(), estimator="hits", rays=1024, sparse=True)
    assert scipy.issparse(sparse) and (sparse.toarray() == dense).all()


def test_a_shadow_takes_its_part_of_the_light():
    halves = [[0, 1, 2], [0, 2, 3]]
    ground, roof = [[0, 0, 0], [4, 0, 0], [4, 4, 0], [0, 4, 0]], [[1, 1, 1], [2, 1, 1], [2, 2, 1], [1, 2, 1]]
    scene = scene_of((ground, halves), (roof, halves))
    light = twinray.illumination(scene, [0, 0, -1], groups=[0, 0, 1, 1], side=500)
    assert np.abs(light["area"] - [15, 1]).max() < 0.05
    assert (light["low"] <= [15, 1]).all() and (light["high"] >= [15, 1]).all()
    assert (light["surface"] == [16, 1]).all() and light["unobstructed"].tolist() == [16, 1]
    value, low, high = twinray.sky_light(scene)
    assert value.shape == (4,) and (value[2:] == 1).all() and (value[:2] < 1).all()
    assert (low <= value).all() and (value <= high).all()
    mean, error = twinray.centroid(scene, [0, 0, -1], side=300)
    assert np.abs(mean - [2, 2, 1 / 16]).max() < 0.02 and (error > 0).any()
    assert twinray.centroid(twinray.Scene(), [0, 0, 1]) == (None, None)


def test_collisions_are_exact():
    vertices, triangles = cube()
    scene = scene_of(cube())
    scene.remove(scene.add_triangles(vertices, triangles))
    scene.add_triangles(vertices, triangles, transform=[[1, 0, 0, 1], [0, 1, 0, 0], [0, 0, 1, 0]])
    touch = twinray.collide(scene)
    assert set(map(tuple, touch["geometry_ids"].tolist())) == {(0, 2)}
    names = {twinray.PAIR_CLASSES[i] for i in touch["classes"]}
    assert "coplanar_overlap" in names and "crossing" not in names
    scene.set_transform(2, [[1, 0, 0, 0.5], [0, 1, 0, 0.25], [0, 0, 1, 0.125]])
    crossed = twinray.collide(scene, segments=True)
    is_crossing = crossed["classes"] == twinray.PAIR_CLASSES.index("crossing")
    assert is_crossing.sum() > 5 and crossed["segments"].shape == (len(is_crossing), 2, 3)
    assert (np.linalg.norm(np.diff(crossed["segments"], axis=1), axis=(1, 2))[is_crossing] > 0).all()
    scene.set_transform(2, [[1, 0, 0, 1 + 2**-20], [0, 1, 0, 0], [0, 0, 1, 0]])
    assert len(twinray.collide(scene)["classes"]) == 0


def test_hits_are_verified():
    scene = scene_of(grid(12), accel="sw")
    scene.add_triangles(*cube(), transform=[[0.1, 0.02, 0, 0.4], [0, 0.1, 0, 0.4], [0, 0, 0.1, 0.2]])
    result = twinray.verify(scene, count=20_000)
    assert result["faults"] == 0 and result["bound_95"] < 1e-3 and result["classes"].shape == (20_000,)
    assert sum(result["counts"].values()) == 20_000 and result["counts"]["AGREE"] > 15_000
    assert tuple(result["counts"]) == twinray.HIT_CLASSES and result["rays"].shape == (20_000, 6)
    one = twinray.verify(scene, [[0.5, 0.5, 3, 0, 0, -1]])
    assert len(one["classes"]) == 1 and twinray.HIT_CLASSES[one["classes"][0]] in ("AGREE", "TIE", "BOUNDARY")


def test_visible_is_what_occlusion_rays_say():
    scene = scene_of(grid(20))
    random = np.random.default_rng(1)
    points = np.hstack([random.uniform(0, 1, (300, 2)), np.full((300, 1), 0.05)])
    vectors, _ = twinray.sky_patches("reinhart577")
    free = twinray.visible(points, vectors, scene=scene)
    assert free.shape == (300, 577) and free.dtype == np.uint8 and 0.05 < free.mean() < 0.95
    rays = np.concatenate([np.repeat(points, 577, axis=0), np.tile(vectors, (300, 1))], axis=1)
    assert (free == ~scene.test_occlusions(rays).reshape(300, 577)).all()
    near = twinray.visible(points, vectors, scene=scene, tnear=0.01, tfar=0.1)
    assert (near == ~scene.test_occlusions(rays, 0.01, 0.1).reshape(300, 577)).all()
    assert near.mean() > free.mean() + 0.01
    with pytest.raises(twinray.Error, match="t_far 0 must be above 0"):
        twinray.visible(points, vectors, scene=scene, tfar=0)
    east = twinray.visible(points, vectors, np.tile([1.0, 0, 0], (300, 1)), scene=scene)
    assert (east == free * (vectors[:, 0] > 0)).all()
    with pytest.raises(ValueError, match="normals: 2 rows"):
        twinray.visible(points, vectors, points[:2], scene=scene)


@pytest.mark.parametrize("accel", ["sw", "hw"])
@pytest.mark.parametrize("size, place", [(1, 0), (100, 0), (1, 1000), (30, -5000.3)])
def test_sensors_on_a_roof_see_the_sky(accel, size, place, caplog):
    roof = np.array([[0, 0, 1], [1, 0, 1], [1, 1, 1.7], [0, 1, 1.7]]) * size + place
    scene = scene_of((roof, [[0, 1, 2], [0, 2, 3]]), accel=accel, origin=[0, 0, 0.0])
    caplog.clear()  # the origin is asked for
    across, along = roof[1] - roof[0], roof[3] - roof[0]
    normal = np.cross(across, along) / np.linalg.norm(np.cross(across, along))
    share = np.random.default_rng(2).uniform(0.05, 0.95, (800, 2))
    points = roof[0] + share[:, :1] * across + share[:, 1:] * along
    vectors, _ = twinray.sky_patches("tregenza145")
    seen = twinray.visible(points, vectors, np.tile(3 * normal, (800, 1)), scene=scene)
    assert (seen == (vectors @ normal > 0)).all()
    assert not caplog.messages
    twinray.visible(points, vectors, scene=scene)
    (message,) = caplog.messages
    assert re.search("lie on the scene, .* pass normals or tnear", message)
    caplog.clear()
    inside = points - 0.1 * size * normal
    assert not twinray.visible(inside, [normal], scene=scene).any()
    assert not caplog.messages


@pytest.mark.parametrize("name, count", [("tregenza145", 145), ("reinhart577", 577), ("reinhart2305", 2305)])
def test_skies_are_radiances(name, count):
    directions, angles = twinray.sky_patches(name)
    assert directions.shape == (count, 3) and np.allclose(np.linalg.norm(directions, axis=1), 1)
    assert np.isclose(angles.sum(), 2 * np.pi) and (directions[-1] == [0, 0, 1]).all()
    assert np.isclose((angles * directions[:, 2]).sum(), np.pi, rtol=1 / count)  # of a uniform sky
    if count == 145:
        assert np.isclose(np.rad2deg(np.arcsin(directions[0, 2])), 6)
        assert np.allclose(directions[1, :2] / np.cos(np.deg2rad(6)), [np.sin(np.deg2rad(12)), np.cos(np.deg2rad(12))])
    within, _ = twinray.sky_patches(name, samples=64)
    assert within.shape == (64, count, 3) and np.allclose(np.linalg.norm(within, axis=2), 1)
    assert (within[..., 2] >= 0).all() and (within == twinray.sky_patches(name, samples=64, seed=1)[0]).all()
    away = np.arccos(np.einsum("snk,nk->sn", within, directions).clip(-1, 1))
    assert (away.max(axis=0) < 1.7 * np.sqrt(angles)).all() and (away.max(axis=0) > 0.3 * np.sqrt(angles)).all()
    assert np.isclose((angles * within[..., 2].mean(axis=0)).sum(), np.pi, rtol=5e-3)
    with pytest.raises(twinray.Error, match="sky 'cie'"):
        twinray.sky_patches("cie")
    with pytest.raises(ValueError, match="samples: 0"):
        twinray.sky_patches(name, samples=0)


def test_sensor_files_of_radiance(tmp_path):
    (tmp_path / "grid.pts").write_text("0 0 1  0 0 1\n1.5 0 1\t0 0 1\n")
    points, normals = twinray.read_sensors(tmp_path / "grid.pts")
    assert points.tolist() == [[0, 0, 1], [1.5, 0, 1]] and normals.tolist() == [[0, 0, 1]] * 2


def test_wrong_arguments_are_named():
    scene = room()
    for call, name in [
        (lambda: twinray.view_factors(scene, [0, 1]), "groups: shape"),
        (lambda: twinray.view_factors(scene, rays=0), "rays: 0"),
        (lambda: twinray.view_factors(scene, sides="back"), "sides: 'back'"),
        (lambda: twinray.illumination(scene, [0, 1]), "direction: shape"),
        (lambda: twinray.illumination(scene, [0, 0, 1], side=2.5), "side: 2.5"),
        (lambda: twinray.collide(scene, shared="edge"), "shared: 'edge'"),
    ]:
        with pytest.raises(ValueError, match=name):
            call()
    with pytest.raises(twinray.Error, match="estimator 'best'"):
        twinray.view_factors(scene, estimator="best")
    with pytest.raises(twinray.Error, match="direction"):
        twinray.centroid(scene, [0, 0, 0])
