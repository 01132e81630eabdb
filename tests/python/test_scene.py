"""twinray.Scene: names, shapes and dtypes of Open3D's RaycastingScene, and right answers.

One file of more than 400 lines, since it is about one class.
"""

import copy
import doctest
import re
import threading
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import numpy as np
import pytest
import twinray
from conftest import cube, grid, needed, run_python, scene_of, write_obj
from twinray import INVALID_ID


def test_answers_have_open3ds_shapes_and_dtypes():
    scene = scene_of(cube())
    rays = np.zeros((4, 5, 6), np.float32)
    rays[..., :3], rays[..., 5] = [0.3, 0.6, -1], 1
    found = scene.cast_rays(rays)
    expected = {
        "t_hit": ((4, 5), np.float32),
        "geometry_ids": ((4, 5), np.uint32),
        "primitive_ids": ((4, 5), np.uint32),
        "primitive_uvs": ((4, 5, 2), np.float32),
        "primitive_normals": ((4, 5, 3), np.float32),
    }
    assert {name: (array.shape, array.dtype) for name, array in found.items()} == expected
    assert (found["t_hit"] == 1).all() and (found["geometry_ids"] == 0).all()
    assert (found["primitive_normals"] == [0, 0, -1]).all()
    assert scene.test_occlusions(rays).dtype == bool and scene.test_occlusions(rays).shape == (4, 5)
    counts = scene.count_intersections(rays)
    assert counts.dtype == np.int32 and (counts == 2).all()
    listed = scene.list_intersections(rays)
    assert {name: array.dtype for name, array in listed.items()} == {
        "ray_splits": np.uint32, "ray_ids": np.uint32, "t_hit": np.float32, "geometry_ids": np.uint32,
        "primitive_ids": np.uint32, "primitive_uvs": np.float32,
    }  # fmt: skip
    assert (listed["ray_splits"] == np.arange(0, 41, 2)).all()
    assert (listed["t_hit"].reshape(20, 2) == [1, 2]).all()
    closest = scene.compute_closest_points(np.full((2, 3), 0.5))
    assert closest["points"].shape == (2, 3) and closest["points"].dtype == np.float32
    assert scene.compute_distance([[2, 0.5, 0.5]]) == 1


def test_misses_are_infinite_and_invalid():
    for scene in (twinray.Scene(), scene_of(cube())):
        found = scene.cast_rays([5, 5, 5, 0, 0, 1])
        assert found["t_hit"] == np.inf and found["primitive_ids"] == INVALID_ID
        assert found["geometry_ids"] == INVALID_ID and (found["primitive_normals"] == 0).all()
    empty = twinray.Scene()
    assert empty.compute_distance([0, 0, 0]) == np.inf
    assert empty.compute_closest_points([0, 0, 0])["primitive_ids"] == INVALID_ID
    assert empty.compute_occupancy([0, 0, 0]) == 0


def test_empty_questions_have_empty_answers():
    scene = scene_of(cube())
    for rays in ([], np.zeros((0, 6)), np.zeros((3, 0, 6))):
        assert scene.cast_rays(rays)["t_hit"].size == 0
        assert scene.test_occlusions(rays).size == 0
        assert (scene.list_intersections(rays)["ray_splits"] == 0).all()
    assert scene.compute_distance(np.zeros((0, 3))).shape == (0,)


def test_only_hits_between_tnear_and_tfar_count():
    scene = scene_of(cube())
    ray = [0.3, 0.6, -1, 0, 0, 1]
    assert scene.cast_rays(ray, tnear=1.5)["t_hit"] == 2
    assert scene.cast_rays(ray, tfar=0.5)["t_hit"] == np.inf
    assert scene.cast_rays(ray, tnear=1.5, tfar=1.9)["t_hit"] == np.inf
    assert not scene.test_occlusions(ray, tfar=0.5) and scene.test_occlusions(ray, 1.5)
    assert scene.count_intersections(ray, tnear=1.5) == 1


def test_geometries_move_go_and_are_repeated(accel):
    scene = twinray.Scene(accel)
    vertices, triangles = cube()
    first = scene.add_triangles(vertices, triangles)
    moved = scene.add_triangles(vertices, triangles, transform=[[1, 0, 0, 5], [0, 1, 0, 0], [0, 0, 1, 0], [0, 0, 0, 1]])
    again = scene.add_instance(moved, np.diag([-2.0, 2, 2, 1]) + [[0, 0, 0, 12], [0] * 4, [0] * 4, [0] * 4])
    assert (first, moved, again) == (0, 1, 2) and len(scene) == 3

    def seen(x):
        return int(scene.cast_rays([x, 0.6, -1, 0, 0, 1])["geometry_ids"])

    assert [seen(x) for x in (0.3, 5.3, 11.3, 8)] == [0, 1, 2, INVALID_ID]
    assert (
        scene.cast_rays([11.3, 0.6, -1, 0, 0, 1])["primitive_normals"] == [0, 0, -1]
    ).all()  # mirrored: fronts stay fronts
    assert scene.compute_closest_points([11, 1, -3])["geometry_ids"] == 2
    scene.remove(first)
    assert seen(0.3) == INVALID_ID and scene.compute_closest_points([0, 0, -3])["geometry_ids"] == 1
    scene.set_transform(moved, [[1, 0, 0, 8], [0, 1, 0, 0], [0, 0, 1, 0]])
    assert [seen(5.3), seen(8.3)] == [INVALID_ID, 1]
    scene.update_vertices(moved, vertices + [0, 0, 3])
    assert scene.cast_rays([8.3, 0.6, -1, 0, 0, 1])["t_hit"] == 4
    assert scene.add_triangles(vertices, triangles) == 3
    with pytest.raises(twinray.Error, match="geometry 0 is not in the scene"):
        scene.remove(first)


def test_files_are_added(tmp_path):
    write_obj(tmp_path / "cube.obj", *cube())
    scene = twinray.Scene()
    assert scene.add_file(tmp_path / "cube.obj") == [0]
    assert scene.count_intersections([0.3, 0.6, -1, 0, 0, 1]) == 2
    with pytest.raises(twinray.Error, match="nothing.glb"):
        scene.add_file(tmp_path / "nothing.glb")


def aimed_rays(vertices, triangles, seed):
    """Through vertices and points of edges, from above."""
    random = np.random.default_rng(seed)
    edges = np.concatenate([triangles[:, [0, 1]], triangles[:, [1, 2]], triangles[:, [2, 0]]])
    along = random.uniform(0, 1, (len(edges), 1)).astype(np.float32)
    targets = np.concatenate([vertices, vertices[edges[:, 0]] * (1 - along) + vertices[edges[:, 1]] * along])
    origins = np.float32([0.4, 0.7, 3]) + random.uniform(-0.1, 0.1, targets.shape).astype(np.float32)
    return np.hstack([origins, targets - origins])


def test_edges_and_vertices_are_met_once():
    vertices, triangles = grid(40)
    vertices[:, 2] *= 0.02  # so flat that no ray of these meets it twice
    scene = scene_of((vertices, triangles), accel="sw")
    rays = aimed_rays(vertices, triangles, 3)
    at = rays[:, :2] + rays[:, 3:5]
    rays = rays[(np.abs(at - 0.5) < 0.49).all(axis=1)]  # not those at the border
    assert len(rays) > 5000
    assert (scene.count_intersections(rays) == 1).all()
    assert np.isfinite(scene.cast_rays(rays)["t_hit"]).all()


@pytest.mark.parametrize("offset", [(0, 0, 0), (500000.25, 5600000.5, 120)])  # the latter in metres of UTM
def test_any_first_and_all_agree(offset):
    vertices, triangles = grid(30)
    random = np.random.default_rng(5)
    scattered = np.hstack([random.uniform(-0.5, 1.5, (20000, 3)), random.normal(size=(20000, 3))])
    rays = np.concatenate([scattered, aimed_rays(vertices, triangles, 4)]).astype(np.float64)
    rays[:, :3] += offset
    scene = scene_of((vertices + np.float64(offset), triangles), accel="sw")
    assert scene.origin.any() == bool(np.any(offset))
    any_hit = scene.test_occlusions(rays)
    first = scene.cast_rays(rays)
    listed = scene.list_intersections(rays)
    counts = np.diff(listed["ray_splits"].astype(int))
    assert (any_hit == np.isfinite(first["t_hit"])).all()
    assert (any_hit == (counts > 0)).all()
    assert (scene.count_intersections(rays) == counts).all()
    begins = listed["ray_splits"][:-1][counts > 0]
    assert (listed["t_hit"][begins] == first["t_hit"][any_hit]).all()
    assert (np.diff(listed["t_hit"])[np.diff(listed["ray_ids"]) == 0] >= 0).all()


def test_float64_far_from_0_keeps_its_precision(accel, caplog):
    offset = np.array([500000.25, 5600000.5, 120])
    vertices, triangles = cube()
    near, far = scene_of((vertices, triangles), accel=accel), scene_of((vertices + offset, triangles), accel=accel)
    rays = np.hstack([[[0.3, 0.6, -1]], [[0.1, 0.05, 1]]])
    moved = rays + np.concatenate([offset, np.zeros(3)])
    assert far.cast_rays(moved)["t_hit"] == pytest.approx(near.cast_rays(rays)["t_hit"], abs=1e-6)
    points = np.array([[0.5, 0.5, 0.4], [2, 0.25, 0.5]])
    signed = far.compute_signed_distance(points + offset)
    assert signed == pytest.approx([-0.4, 1.0], abs=1e-6)
    closest = far.compute_closest_points(points + offset)["points"]
    assert closest.dtype == np.float64
    assert closest[1] - offset == pytest.approx([1, 0.25, 0.5], abs=1e-9)
    matrix = np.eye(4)
    matrix[:3, 3] = offset + [2, 0, 0]
    caplog.clear()
    assert near.add_instance(0, matrix) == 1  # is where float32 puts it: this scene counts from 0
    assert re.search("geometry 1 is so far .* float32 moves it by up to 0.33; give Scene an", caplog.text)
    turned = np.eye(4)
    turned[:3, :3] = [[0, -1, 0], [1, 0, 0], [0, 0, 1]]
    turned[:3, 3] = offset - turned[:3, :3] @ offset  # about the corner at the offset
    far.set_transform(0, turned)
    assert far.bounds() - offset == pytest.approx(np.array([[-1, 0, 0], [0, 1, 1]]), abs=1e-6)
    far.update_vertices(0, 2 * vertices + offset)
    assert far.bounds() - offset == pytest.approx(np.array([[-2, 0, 0], [0, 2, 2]]), abs=1e-6)
    assert far.to_trimesh().bounds == pytest.approx(far.bounds(), abs=1e-6)
    eye = offset + [0.5, 0.5, 4]
    pixels = far.create_rays_pinhole(30, offset + [-0.5, 0.5, 1], eye, [0, 1, 0], 8, 8, dtype=np.float64)
    assert np.isfinite(far.cast_rays(pixels)["t_hit"]).any()


def test_rays_from_far_off_meet_what_their_lines_do(accel):
    scene = scene_of(grid(20), accel=accel)
    random = np.random.default_rng(3)
    near = np.concatenate([random.uniform(0.1, 0.9, (500, 2)), np.full((500, 1), 0.5)], axis=1)
    directions = np.concatenate([random.normal(0, 0.1, (500, 2)), np.full((500, 1), -1.0)], axis=1)
    beside = scene.cast_rays(np.concatenate([near, directions], axis=1))
    rays = np.concatenate([near - 1e6 * directions, directions], axis=1)
    found = scene.cast_rays(rays)
    assert beside["t_hit"].dtype == np.float32 and found["t_hit"].dtype == np.float64
    assert (found["primitive_ids"] == beside["primitive_ids"]).mean() > 0.99  # others are met beside their edges
    assert found["t_hit"] - 1e6 == pytest.approx(beside["t_hit"], abs=1e-5)
    listed = scene.list_intersections(rays)
    assert listed["t_hit"].dtype == np.float64 and (listed["t_hit"][listed["ray_splits"][:-1]] > 1e6 - 1).all()
    assert scene.test_occlusions(rays).all() and not scene.test_occlusions(rays, tfar=1e6 - 1).any()
    assert (scene.cast_rays(rays, tnear=1e6 + 2)["t_hit"] == np.inf).all()
    assert (scene.count_intersections(rays) >= 1).all()
    mixed = scene.cast_rays([rays[0], np.concatenate([near[1], directions[1]])])["t_hit"]
    assert mixed == pytest.approx([found["t_hit"][0], beside["t_hit"][1]], abs=1e-5)
    assert scene.cast_rays(rays.astype(np.float32))["t_hit"].dtype == np.float32


def test_more_rays_than_a_block_answer_as_fewer_do():
    scene = scene_of(grid(10), accel="sw")
    rays = np.tile([[0.3, 0.4, 2, 0, 0, -1.0], [0.6, 0.6, 2, 0, 0, -1], [3, 3, 3, 0, 0, 1]], ((1 << 20) // 3 + 5, 1))
    rays[-1, :3] = [0.3, 0.4, 1e6]
    rays[-1, 5] = -1
    few, many = scene.cast_rays(rays[:3]), scene.cast_rays(rays)
    assert np.array_equal(many["t_hit"][:-3], np.tile(few["t_hit"], len(rays) // 3 - 1))
    assert np.array_equal(many["primitive_ids"][:-1], np.tile(few["primitive_ids"], len(rays) // 3)[:-1])
    assert many["primitive_ids"][-1] == few["primitive_ids"][0]
    assert many["t_hit"][-1] - 1e6 == pytest.approx(few["t_hit"][0] - 2, abs=1e-5)
    assert np.array_equal(scene.test_occlusions(rays), np.isfinite(many["t_hit"]))
    assert np.array_equal(scene.count_intersections(rays), np.isfinite(many["t_hit"]))
    listed = scene.list_intersections(rays)
    assert np.array_equal(listed["ray_ids"], np.flatnonzero(np.isfinite(many["t_hit"])))
    assert np.array_equal(listed["t_hit"], many["t_hit"][listed["ray_ids"]])


def memory_in_use(field):
    status = Path("/proc/self/status").read_text()
    return 1024 * int(re.search(rf"{field}:\s+(\d+)", status).group(1))


@pytest.mark.skipif(not Path("/proc/self/status").exists(), reason="the system does not tell")
def test_memory_of_many_rays_is_that_of_a_block():
    scene = scene_of(grid(10), accel="sw")
    rays = np.full((1 << 22, 6), 0.5)
    rays[:, 3:] = [0, 0, 1]
    scene.cast_rays(rays[: 1 << 21])  # a block's memory is there
    Path("/proc/self/clear_refs").write_text("5")  # the peak begins anew
    before = memory_in_use("VmRSS")
    results = sum(array.nbytes for array in scene.cast_rays(rays).values())
    assert memory_in_use("VmHWM") - before - results < 32 * len(rays)
    assert memory_in_use("VmRSS") - before < 16 * len(rays)


def test_an_edge_is_counted_once_whatever_traces(accel):
    scene = scene_of(cube(), accel=accel)
    assert scene.backend["lists"] == "sw"
    corners = [[-1, -1, -1, 1, 1, 1], [2, -1, 2, -1, 1, -1]]
    diagonals = [[0.5, 0.5, -1, 0, 0, 1], [-1, 0.25, 0.25, 1, 0, 0], [-1, 0.25, 0.75, 1, 0, 0]]
    rays = np.array(corners + diagonals, np.float64)
    assert (scene.count_intersections(rays) == 2).all()
    moved = scene.add_instance(0, [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 5]])
    assert scene.count_intersections(rays).tolist() == [2, 2, 4, 2, 2]
    scene.set_transform(moved, [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, -5]])
    assert scene.count_intersections(rays).tolist() == [2] * 5
    scene.set_transform(moved, [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 2]])
    assert scene.list_intersections(rays)["geometry_ids"].tolist() == [0] * 6 + [1, 1] + [0] * 4
    scene.update_vertices(0, cube(2)[0])
    assert scene.list_intersections(rays[2:3])["t_hit"].tolist() == [1, 3, 3, 5]
    scene.remove(moved)
    assert scene.count_intersections(rays).tolist() == [2] * 5


def test_fronts_stay_fronts_where_a_transform_mirrors(accel):
    scene = twinray.Scene(accel)
    scene.add_triangles(*cube(), transform=np.diag([-1.0, 1, 1, 1]))
    rays = [[-0.3, 0.6, -1, 0, 0, 1], [1, 0.6, 0.3, -1, 0, 0]]
    outward = [[0, 0, -1], [1, 0, 0]]
    assert np.array_equal(scene.cast_rays(rays)["primitive_normals"], outward)
    assert np.array_equal(scene.compute_closest_points(np.array(rays)[:, :3])["primitive_normals"], outward)
    listed = scene.list_intersections(rays, normals=True)["primitive_normals"]
    assert np.array_equal(listed[::2], outward) and np.array_equal(listed[1::2], -np.array(outward))
    a, b, c = scene.world_triangles().reshape(-1, 3, 3).transpose(1, 0, 2)
    assert np.einsum("ij,ij->i", a, np.cross(b, c)).sum() / 6 == pytest.approx(1)  # a volume; -1 inside out


def test_bounds_are_those_of_the_triangles(accel):
    scene = twinray.Scene(accel)
    assert np.isinf(scene.bounds()).all()
    octahedron = np.concatenate([np.eye(3), -np.eye(3)])
    faces = [[i, j, k] for i in (0, 3) for j in (1, 4) for k in (2, 5)]
    s = np.sqrt(0.5)
    turn = np.array([[s, -s, 0], [s, s, 0], [0, 0, 1]])
    place = np.eye(4)
    place[:3, :3] = turn @ turn.T[[1, 2, 0]] @ turn
    geometry = scene.add_triangles(octahedron, faces, transform=place)
    corners = scene.world_triangles()
    assert scene.bounds() == pytest.approx(np.array([corners.min(0), corners.max(0)]), abs=1e-6)
    place[:3, :3] = turn
    scene.set_transform(geometry, place)
    assert scene.bounds() == pytest.approx(np.array([[-s, -s, -1], [s, s, 1]]), abs=1e-6)
    scene.update_vertices(geometry, 2 * octahedron)
    assert scene.bounds() == pytest.approx(np.array([[-s, -s, -1], [s, s, 1]]) * 2, abs=1e-6)
    scene.remove(geometry)
    assert np.isinf(scene.bounds()).all()


def test_poses_far_from_the_origin_are_told_once(tmp_path, caplog):
    pose = np.eye(4)
    pose[:3, 3] = [5e5, 5.6e6, 120]
    told = "is so far from"
    for size in (1, 1000):
        scene = scene_of(cube(size), accel="sw")
        caplog.clear()
        for _ in range(2):
            scene.set_transform(0, pose)
        (message,) = caplog.messages
        assert told in message
    vertices, triangles = cube()
    write_obj(tmp_path / "far.obj", vertices + pose[:3, 3], triangles)
    caplog.clear()
    scene_of(cube(), accel="sw").add_file(tmp_path / "far.obj")
    (message,) = caplog.messages
    assert told in message
    caplog.clear()
    twinray.Scene(accel="sw").add_file(tmp_path / "far.obj")
    near = twinray.Scene(accel="sw", origin=pose[:3, 3])
    near.add_triangles(*cube(), transform=pose)
    parts = scene_of(cube(), accel="sw")
    for place in (1, 100, 1000):  # a small part in a large scene
        parts.add_instance(0, np.diag([0.1, 0.1, 0.1, 1]) + [[0, 0, 0, place], [0] * 4, [0] * 4, [0] * 4])
    assert not caplog.messages


def test_files_far_from_0_keep_their_precision(tmp_path):
    offset = np.array([500000.25, 5600000.5, 120])
    vertices, triangles = cube()
    write_obj(tmp_path / "cube.obj", vertices + offset, triangles, "v {:.4f} {:.4f} {:.4f}")
    scene = twinray.Scene(accel="sw")
    assert scene.add_file(tmp_path / "cube.obj") == [0]
    found = scene.cast_rays(np.concatenate([offset + [0.3, 0.6, -1], [0, 0, 1]]))
    assert found["t_hit"] == pytest.approx(1, abs=1e-6)
    bounds = np.array([offset, offset + 1])
    scene.set_transform(0, np.eye(4))
    assert scene.bounds() == pytest.approx(bounds, abs=1e-6)
    moved = np.eye(4)
    moved[:3, 3] = [0, 0, 5]
    assert scene.add_instance(0, moved) == 1
    assert scene.bounds() == pytest.approx(bounds + [[0, 0, 0], [0, 0, 5]], abs=1e-6)
    scene.remove(1)
    scene.update_vertices(0, vertices + offset)
    assert scene.bounds() == pytest.approx(bounds, abs=1e-6)


def test_threads_agree_on_the_origin():
    offset = np.array([500000.25, 5600000.5, 120])
    vertices, triangles = cube()
    for _ in range(5):
        scene = twinray.Scene(accel="sw")
        with ThreadPoolExecutor(4) as pool:
            list(pool.map(lambda i: scene.add_triangles(vertices + offset + [300 * i, 0, 0], triangles), range(8)))
        assert scene.bounds() == pytest.approx(np.array([offset, offset + [2101, 1, 1]]), abs=1e-3)


def test_winding_numbers_of_a_cube_without_its_lid():
    vertices, triangles = cube()
    lid = (vertices[triangles, 2] == 1).all(axis=1)
    scene = scene_of((vertices, triangles[~lid]))
    middle, outside, nothing = scene.compute_winding_numbers([[0.5, 0.5, 0.5], [5, 0.5, -9], [np.nan, 0, 0]])
    assert middle == pytest.approx(5 / 6, abs=1e-12)
    assert abs(outside) < 0.01
    assert np.isnan(nothing)
    assert scene.compute_occupancy([[0.5, 0.5, 0.25], [0.5, 0.5, 1.1], [0.5, 0.5, 2]]).tolist() == [1, 0, 0]


def test_signs_do_not_flip_next_to_edges_and_diagonals():
    # Signs by counting the hits of one ray flip here: behind edges and vertices as the ray sees them.
    scene = scene_of(cube())
    steps = np.linspace(-0.5, 1.5, 41)
    points = np.stack(np.meshgrid(steps, steps, steps, indexing="ij"), axis=-1)
    inside = ((points > 0) & (points < 1)).all(axis=-1)
    on_surface = ((points >= 0) & (points <= 1)).all(axis=-1) & ~inside
    signed = scene.compute_signed_distance(points)
    assert signed.shape == (41, 41, 41)
    assert ((signed < 0) == inside)[~on_surface].all()
    assert (scene.compute_occupancy(points)[~on_surface] == inside[~on_surface]).all()
    outside = np.maximum(np.maximum(-points, points - 1), 0)
    expected = np.where(inside, -np.minimum(points, 1 - points).min(axis=-1), np.linalg.norm(outside, axis=-1))
    assert np.abs(signed - expected).max() < 1e-6


def test_signs_hold_on_open_and_on_touching_meshes():
    vertices, triangles = cube()
    opened = scene_of((vertices, triangles[1:]))
    inside = opened.compute_occupancy([[0.5, 0.5, 0.5], [0.9, 0.9, 0.9], [3, 3, 3], [0.5, 0.5, 2]])
    assert inside.tolist() == [1, 1, 0, 0]
    two = scene_of((vertices, triangles), (vertices + [1, 0, 0], triangles))  # they share a face
    assert two.compute_occupancy([[0.5, 0.5, 0.5], [1.5, 0.5, 0.5], [2.5, 0.5, 0.5]]).tolist() == [1, 1, 0]


def test_pinhole_rays_are_open3ds():
    rays = twinray.create_rays_pinhole(90, [0, 0, 0], [0, 0, -2], [0, 1, 0], 4, 2)
    assert rays.shape == (2, 4, 6) and rays.dtype == np.float32
    assert (rays[..., :3] == [0, 0, -2]).all()
    assert np.allclose(rays[0, 0, 3:], [-0.75, -0.25, 1]) and np.allclose(rays[1, 3, 3:], [0.75, 0.25, 1])
    same = twinray.create_rays_pinhole(
        [[2, 0, 2], [0, 2, 1], [0, 0, 1]], [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 2], [0, 0, 0, 1]], 4, 2
    )
    assert np.allclose(rays, same)


def test_wrong_arguments_are_named():
    scene = scene_of(cube())
    rays = np.zeros((1, 6))
    for call, kind, name in [
        (lambda: scene.cast_rays(np.zeros((3, 5))), ValueError, r"rays: shape \(3, 5\)"),
        (lambda: scene.cast_rays("rays"), TypeError, "rays: dtype"),
        (lambda: scene.cast_rays(rays * 1j), TypeError, "rays: dtype complex128"),
        (lambda: scene.cast_rays([[1, 2], [3]]), ValueError, "rays"),
        (lambda: scene.cast_rays(rays, tnear=-1), ValueError, "tnear: -1.0"),
        (lambda: scene.cast_rays(rays, tfar=np.nan), ValueError, "tfar: nan"),
        (lambda: scene.test_occlusions(rays, "near"), TypeError, "tnear: 'near'"),
        (lambda: scene.compute_distance([1, 2]), ValueError, "query_points: shape"),
        (lambda: scene.add_triangles(np.zeros((3, 2)), [[0, 1, 2]]), ValueError, "vertex_positions: shape"),
        (lambda: scene.add_triangles(np.zeros((3, 3)), [[0, 1, 2.5]]), TypeError, "triangle_indices: dtype float64"),
        (lambda: scene.add_triangles(np.zeros((3, 3)), [[0, 1, -1]]), ValueError, "triangle_indices: indices from -1"),
        (lambda: scene.add_triangles(np.zeros((3, 3)), [[0, 1, 3]]), twinray.Error, "3"),
        (lambda: scene.add_triangles(object()), TypeError, "object is not a mesh"),
        (lambda: scene.add_triangles(*cube(), transform=np.eye(3)), ValueError, r"transform: shape \(3, 3\)"),
        (lambda: scene.add_triangles(*cube(), transform=np.zeros((4, 4))), ValueError, "transform: its last row"),
        (lambda: scene.add_triangles(*cube(), transform=np.zeros((3, 4))), twinray.Error, "singular"),
        (lambda: scene.set_transform(7, np.eye(4)), twinray.Error, "geometry 7"),
        (lambda: scene.remove(-1), ValueError, "geometry: -1"),
        (lambda: scene.remove("0"), TypeError, "geometry: '0'"),
        (lambda: scene.update_vertices(0, np.zeros((3, 3))), twinray.Error, "3 positions for its 8 vertices"),
        (lambda: twinray.Scene(level="high"), twinray.Error, "level 'high'"),
        (lambda: twinray.Scene(accel="gpu"), twinray.Error, "gpu"),
        (lambda: twinray.Scene(device="no such device"), twinray.Error, "no such device"),
    ]:
        with pytest.raises(kind, match=name):
            call()
    assert len(scene) == 1 and scene.cast_rays([0.3, 0.6, -1, 0, 0, 1])["t_hit"] == 1


def test_what_is_not_finite_meets_nothing():
    scene = scene_of(cube())
    bad = np.array([[np.nan, 0, 0, 0, 0, 1], [0, 0, -1, 0, 0, 0], [np.inf, 0, 0, 1, 0, 0], [0.3, 0.6, -1, 0, np.nan, 1],
                    [1e300, 0, 0, -1, 0, 0]])  # fmt: skip
    assert not np.isfinite(scene.cast_rays(bad)["t_hit"]).any()
    assert scene.compute_distance([[np.nan, 0, 0], [np.inf, 0, 0]]).tolist() == [np.inf, np.inf]


def test_threads_ask_while_others_move():
    scene = scene_of(cube())
    walker = scene.add_triangles(*cube(), transform=np.eye(4))
    rays = np.tile(np.float32([0.3, 0.6, -1, 0, 0, 1]), (500, 1))
    wrong = []

    def ask():
        for _ in range(30):
            found = scene.cast_rays(rays)
            if not (found["t_hit"] == 1).all():
                wrong.append(found)

    def move():
        for i in range(60):
            scene.set_transform(walker, [[1, 0, 0, 5 + i], [0, 1, 0, 0], [0, 0, 1, 0]])
            extra = scene.add_triangles(*cube(), transform=[[1, 0, 0, 0], [0, 1, 0, 5], [0, 0, 1, 0]])
            scene.remove(extra)

    scene.set_transform(walker, [[1, 0, 0, 5], [0, 1, 0, 0], [0, 0, 1, 0]])
    threads = [threading.Thread(target=call) for call in (ask, ask, move)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert not wrong and len(scene) == 2


def test_without_vulkan_the_first_scene_says_so():
    ended = run_python(
        "import twinray\ntry: twinray.Scene()\nexcept twinray.Error as error: print('told:', error)",
        VK_DRIVER_FILES="/nowhere", VK_ICD_FILENAMES="/nowhere",
    )  # fmt: skip
    assert ended.returncode == 0 and ended.stdout.startswith("told: create a Vulkan instance"), ended


def test_a_cpu_driver_is_told_once():
    code = "import twinray; s = [twinray.Scene() for _ in range(3)]; print(s[0].backend['kind'])"
    ended = run_python(code, PYTHONWARNINGS="error")
    assert ended.returncode == 0 and ended.stderr.count("runs on a CPU") == (ended.stdout == "CPU\n"), ended


def test_a_python_without_its_lock_is_refused():
    ended = run_python("import sys; sys._is_gil_enabled = lambda: False; import twinray")
    assert ended.returncode == 1 and "ImportError: twinray needs the GIL" in ended.stderr, ended


def test_the_backend_is_told():
    backend = twinray.Scene("sw").backend
    assert set(backend) == {"device", "driver", "kind", "accel", "why", "path", "level", "lists", "note"}
    assert bool(backend["note"]) == (backend["kind"] == "CPU")
    assert backend["accel"] == "sw" and backend["level"] == "watertight" and backend["device"]
    assert any(device["name"] == backend["device"] for device in twinray.devices())


ROOT = Path(__file__).parents[2]


def test_what_notebooks_show():
    scene = scene_of(cube())
    assert "<th>triangles</th><td>12</td>" in scene._repr_html_()
    trimesh = needed("trimesh")
    moved = scene.add_instance(0, [[1, 0, 0, 3], [0, 1, 0, 0], [0, 0, 1, 0]])
    mesh = scene.to_trimesh()
    assert (
        isinstance(mesh, trimesh.Trimesh) and len(mesh.faces) == 24 and mesh.bounds.tolist() == [[0, 0, 0], [4, 1, 1]]
    )
    scene.remove(moved)
    assert len(scene.to_trimesh().faces) == 12


def test_examples_of_the_documentation():
    for results in (doctest.testmod(twinray), doctest.testfile(str(ROOT / "docs/python.md"), module_relative=False)):
        assert results.attempted > 0 and results.failed == 0


def test_the_five_lines_of_the_readme(capsys):
    [lines] = re.findall(r"```python\n(.*?)```", (ROOT / "README.md").read_text(), re.S)
    exec(lines, {})
    assert capsys.readouterr().out == "[2.] [0]\n" and len(lines.splitlines()) == 5


def test_a_transform_that_flattens_leaves_what_is_left():
    scene = twinray.Scene()
    flat = scene.add_triangles(*cube(), transform=np.diag([2, 1, 0, 1]))
    found = scene.cast_rays([[1.5, 0.5, 3, 0, 0, -1], [2.5, 0.5, 3, 0, 0, -1]])
    assert np.isclose(found["t_hit"][0], 3, atol=1e-6) and np.isinf(found["t_hit"][1])
    for flattened in (scene, copy.deepcopy(scene)):
        for call in (
            lambda: flattened.set_transform(flat, np.eye(4)),
            lambda: flattened.add_instance(flat),
            lambda: flattened.update_vertices(flat, cube()[0]),
        ):
            with pytest.raises(twinray.Error, match="geometry 0 was flattened by its transform; add its mesh again"):
                call()
    whole = scene.add_triangles(*cube(), transform=np.array([[1, 0, 0, 10], [0, 1, 0, 0], [0, 0, 1, 0]]))
    scene.add_instance(whole, np.array([[1, 0, 0, 20], [0, 0, 0, 0], [0, 0, 1, 0]]))
    assert np.isclose(scene.cast_rays([20.5, -3, 0.5, 0, 1, 0])["t_hit"], 3, atol=1e-6)
    assert len(scene) == 3


@pytest.mark.parametrize(("accel", "level"), [("sw", "certified"), ("sw", "refined"), ("hw", "refined")])
def test_ends_of_rays_are_decided_by_float64(accel, level):
    random = np.random.default_rng(7)
    count = 500
    corners = random.integers(-512, 512, (count, 3, 3)) / 64
    corners += 64 * np.stack([np.arange(count), 0 * np.arange(count), 0 * np.arange(count)], axis=1)[:, None]
    on_plane = corners[:, 0] / 4 + corners[:, 1] / 4 + corners[:, 2] / 2  # exact in float32, as rays are
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    step = (normal / np.linalg.norm(normal, axis=1, keepdims=True) * 256).round() / 256
    rays = np.hstack([on_plane - step, step]).astype(np.float32)
    mesh = corners.reshape(-1, 3), np.arange(3 * count).reshape(-1, 3)
    scene = scene_of(mesh, accel=accel, level=level, origin=[0, 0, 0])
    own = np.arange(count)
    last_before, next_after = np.nextafter(np.float32(1), np.float32([0, 2]))
    for near, far, is_hit in ((0, 1, False), (0, next_after, True), (1, 2, False), (last_before, 2, True)):
        found = scene.cast_rays(rays, tnear=near, tfar=far)["primitive_ids"]
        assert ((found == own) == is_hit).all(), (near, far)
        blocked = scene.test_occlusions(rays, tnear=near, tfar=min(far, next_after))
        assert (blocked == is_hit).all(), (near, far)
