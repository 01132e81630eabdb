"""Pictures of scenes, rays and hits: what must be seen where."""

import struct
import sys
import types
import zlib

import numpy as np
import pytest
import twinray
from conftest import cube, needed, scene_of

ORANGE, BLUE, WHITE = (213, 94, 0), (0, 114, 178), (255, 255, 255)


def front(scene, **options):
    """From +z, half a unit a quarter of the width: the cube covers the middle."""
    return scene.show(eye=(0.5, 0.5, 5), center=(0.5, 0.5, 0), size=(80, 80), fov_deg=30, **options).pixels


def decoded(png):
    """The pixels of a PNG, whose checksums hold."""
    assert png[:8] == b"\x89PNG\r\n\x1a\n"
    at, data, size = 8, b"", None
    while at < len(png):
        length, kind = struct.unpack(">I4s", png[at : at + 8])
        body = png[at + 8 : at + 8 + length]
        assert struct.unpack(">I", png[at + 8 + length : at + 12 + length])[0] == zlib.crc32(kind + body)
        if kind == b"IHDR":
            size = struct.unpack(">II", body[:8])
        data += body if kind == b"IDAT" else b""
        at += 12 + length
    rows = np.frombuffer(zlib.decompress(data), np.uint8).reshape(size[1], 1 + 3 * size[0])
    assert (rows[:, 0] == 0).all()
    return rows[:, 1:].reshape(size[1], size[0], 3)


def near(pixel, color, by=3):
    return (np.abs(pixel.astype(int) - color) <= by).all()


def test_the_scene_is_seen_where_it_is(accel, tmp_path):
    scene = scene_of(cube(), accel=accel)
    pixels = front(scene)
    assert pixels.shape == (80, 80, 3)
    assert near(pixels[2, 2], WHITE, 0) and not near(pixels[40, 40], WHITE, 60)
    covered = (pixels < 250).any(axis=2)
    half = 0.5 * 0.5 / 4 / np.tan(np.deg2rad(15)) * 80  # the face at z = 1, four away
    assert abs(covered[40].sum() - 2 * half) <= 1 and abs(covered[:, 40].sum() - 2 * half) <= 1
    picture = scene.show(size=(40, 30))
    picture.save(tmp_path / "cube.png")
    assert (decoded((tmp_path / "cube.png").read_bytes()) == picture.pixels).all()
    assert "data:image/png;base64," in picture._repr_html_()
    assert (picture.pixels[[0, 0, -1, -1], [0, -1, 0, -1]] == 255).all()  # all of it is seen


def test_rays_end_where_they_hit():
    scene = scene_of(cube(), accel="sw")
    rays = [[-3, 0.5, 0.99, 1, 0, 0], [-0.5, 1.2, 0.5, 1, 0, 0]]
    pixels = front(scene, rays=rays)
    row = int(40 - 0.5 * 80 / np.tan(np.deg2rad(15)) * 0.7 / 4.5)
    assert near(pixels[40, 3], ORANGE, 90) and near(pixels[row, 40], BLUE, 90)
    assert (pixels[40, 45] == front(scene)[40, 45]).all()  # behind the hit there is no ray
    shown = front(scene, rays=[[-0.9, 0.5, 0.99, 1, 0, 0]], t_hit=[np.inf])
    assert near(shown[40, 3], BLUE, 90)


def test_rays_near_the_camera_are_whole_lines():
    scene = scene_of(([[-50, -50, 0], [50, -50, 0], [0, 90, 0]], [[0, 1, 2]]), accel="sw")
    near_eye = [0.1, -8, 4.999, 0, 1, 0]
    pixels = scene.show([near_eye], eye=(0, -5, 5), center=(0, 0, 5), up=(0, 0, 1), size=(80, 80)).pixels
    column = pixels[:, 41:80].astype(int)
    is_blue = (column[..., 2] - column[..., 0] > 60).any(axis=1)
    rows = np.flatnonzero(is_blue)
    assert len(rows) and (np.diff(rows) == 1).all()
    columns = np.flatnonzero((pixels[..., 2].astype(int) - pixels[..., 0] > 60).any(axis=0))
    assert columns[-1] == 79 and (np.diff(columns) == 1).all()  # from the border to where it goes, without a gap


def test_values_are_colours_with_a_range():
    scene = scene_of(cube(), accel="sw")
    faces = int(scene.first_faces()[-1])
    values = np.where((cube()[0][cube()[1], 2] == 1).all(axis=1), 7.0, 2.0)
    picture = scene.show(values=values, eye=(0.5, 0.5, 5), center=(0.5, 0.5, 0), size=(80, 80))
    assert picture.value_range == (2, 7) and "7" in picture._repr_html_()
    assert near(picture.pixels[40, 40], (253, 231, 37))
    grey = scene.show(values=np.full(faces, np.nan), eye=(0.5, 0.5, 5), center=(0.5, 0.5, 0), size=(80, 80))
    assert near(grey.pixels[40, 40], (158, 158, 158))
    dots = front(scene, points=[[0.5, 0.5, 3], [0.5, 0.5, -3]], point_values=[False, True])
    assert near(dots[40, 40], (68, 1, 84), 40)  # the nearer one


def test_nothing_and_what_is_not_finite_are_shown_too():
    assert (twinray.Scene().show(size=(8, 8)).pixels == 255).all()
    scene = scene_of(cube(), accel="sw")
    scene.show([[np.nan] * 6, [0, 0, 0, 0, 0, 0]], points=[[np.inf, 0, 0]], size=(8, 8))


@pytest.mark.parametrize(
    "options, message",
    [
        ({"values": [1.0]}, "values: shape"),
        ({"points": [[0, 0, 0]], "point_values": [1, 2]}, "point_values: 2 numbers, of points 1"),
        ({"rays": [[0, 0, 0, 1, 0, 0]], "t_hit": [1, 2]}, "t_hit: 2 numbers, of rays 1"),
        ({"size": (0, 4)}, "size: "),
        ({"fov_deg": 180}, "fov_deg: "),
        ({"up": (0, 0, 1), "eye": (0, 0, 9), "center": (0, 0, 0)}, "up: "),
        ({"eye": (0, np.nan, 9)}, "eye: "),
        ({"eye": (1, 2, 3), "center": (1, 2, 3)}, "eye: "),
    ],
)
def test_bad_arguments_are_named(options, message):
    with pytest.raises(ValueError, match=message):
        scene_of(cube(), accel="sw").show(**options)


def test_interactive_shows_in_what_is_installed(monkeypatch):
    trimesh = needed("trimesh")
    monkeypatch.setitem(sys.modules, "pyvista", None)
    monkeypatch.setattr(trimesh.Scene, "show", lambda scene: scene)
    shown = scene_of(cube(), accel="sw").show([[-3, 0.5, 0.5, 1, 0, 0]], values=np.arange(12.0), interactive=True)
    assert len(shown.geometry) == 2
    monkeypatch.setitem(sys.modules, "trimesh", None)
    with pytest.raises(ImportError, match="PyVista or trimesh"):
        scene_of(cube(), accel="sw").show(interactive=True)


def test_pyvista_gets_all_of_it(monkeypatch):
    pyvista = types.SimpleNamespace(calls=[])

    class Plotter:
        def __getattr__(self, name):
            return lambda *args, **options: pyvista.calls.append((name, args)) or self

    pyvista.Plotter = Plotter
    pyvista.PolyData = types.SimpleNamespace(from_regular_faces=lambda points, faces: (points, faces))
    monkeypatch.setitem(sys.modules, "pyvista", pyvista)
    rays = [[-3, 0.5, 0.5, 1, 0, 0], [0, 9, 0, 1, 0, 0]]
    scene_of(cube(), accel="sw").show(rays, points=[[0, 0, 2]], interactive=True)
    assert [name for name, _ in pyvista.calls] == ["add_mesh", "add_lines", "add_lines", "add_points", "show"]
    assert pyvista.calls[0][1][0][0].shape == (36, 3)


def test_progress_is_shown_by_tqdm(capsys, monkeypatch):
    needed("tqdm")
    scene = scene_of(cube(), accel="sw")
    points = np.random.default_rng(1).uniform(1, 2, (500, 3))
    vectors = np.random.default_rng(2).normal(size=(20, 3))
    shown = twinray.visible(points, vectors, scene=scene, progress=True)
    assert (shown == twinray.visible(points, vectors, scene=scene)).all()
    assert "visible" in capsys.readouterr().err
    factors, _ = twinray.view_factors(scene, progress=True, rays=1000)
    assert (factors == twinray.view_factors(scene, rays=1000)[0]).all()
    monkeypatch.setitem(sys.modules, "tqdm.auto", None)
    with pytest.raises(ImportError, match="tqdm"):
        twinray.visible(points, vectors, scene=scene, progress=True)


def test_view_gives_the_scene_to_the_command(tmp_path, monkeypatch):
    command = tmp_path / "command"
    command.write_text('#!/bin/sh\ncp "$2" "$(dirname "$0")/seen.ply"\necho "$@" > "$(dirname "$0")/words"\n')
    command.chmod(0o755)
    monkeypatch.setenv("TWINRAY_COMMAND", str(command))
    assert scene_of(cube(), accel="sw").view("--layer", "steps").wait() == 0
    words = (tmp_path / "words").read_text().split()
    assert words[0] == "view" and words[2:] == ["--layer", "steps"]
    again = twinray.Scene(accel="sw")
    again.add_file(tmp_path / "seen.ply")
    assert again._core.triangle_count() == 12 and again.bounds().tolist() == [[0, 0, 0], [1, 1, 1]]
    monkeypatch.setenv("TWINRAY_COMMAND", str(tmp_path / "nothing"))
    with pytest.raises(FileNotFoundError, match="TWINRAY_COMMAND"):
        scene_of(cube(), accel="sw").view()
