"""Scenes in processes that a fork made, in pickles and copies, and calls that Ctrl-C ends."""

import copy
import logging
import multiprocessing
import os
import pickle
import signal
import subprocess
import sys
import threading
import time

import numpy as np
import pytest
import twinray
from conftest import cube, grid, needed, run_python, scene_of

DOWN = [[0.3, 0.6, 9, 0, 0, -1]]


def height(scene):
    return float(scene.cast_rays(DOWN)["t_hit"][0])


def answer_of_child(ask):
    """What ask() gives in a child process that a fork makes, which has a minute."""
    answers = multiprocessing.get_context("fork").SimpleQueue()

    def answer():
        try:
            answers.put(ask())
        except BaseException as error:
            answers.put(f"{type(error).__name__}: {error}")

    child = multiprocessing.get_context("fork").Process(target=answer)
    child.start()
    child.join(60)
    if child.is_alive():
        child.kill()
        pytest.fail("the child hangs")
    assert child.exitcode == 0
    return answers.get()


def test_a_child_opens_a_device_of_its_own(accel):
    scene = scene_of(cube(), accel=accel)
    assert height(scene) == 8
    assert answer_of_child(lambda: height(scene_of(cube(), accel=accel))) == 8
    assert height(scene) == 8


def test_a_scene_of_the_parent_goes_on_in_the_child(accel):
    scene = twinray.Scene(accel)
    first = scene.add_triangles(*cube())
    gone = scene.add_triangles(*cube(9))
    moved = scene.add_instance(first, [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 1, 4]])
    scene.remove(gone)
    vertices, triangles = grid(3)
    field = scene.add_triangles(vertices, triangles)
    scene.update_vertices(field, vertices - [0, 0, 7])
    expected = scene.list_intersections(DOWN)

    def ask():
        with_normals = twinray.view_factors(scene, rays=64)[0].shape
        scene.set_transform(moved, np.eye(4))
        found = scene.list_intersections(DOWN), with_normals, scene.add_triangles(*cube())
        return found

    assert height(scene) == 4
    found, shape, added = answer_of_child(ask)
    assert shape == (12 + 12 + 18,) * 2 and added == 4
    assert set(expected["geometry_ids"].tolist()) == set(found["geometry_ids"].tolist()) == {first, moved, field}
    assert found["t_hit"].min() == 8 and height(scene) == 4, "the parent's is as it was"
    assert answer_of_child(lambda: scene.list_intersections(DOWN)["t_hit"].tolist()) == expected["t_hit"].tolist()
    points = [[0.5, 0.5, 0.5], [3, 3, 3]]
    signed = scene.compute_signed_distance(points).tolist()
    assert answer_of_child(lambda: scene.compute_signed_distance(points).tolist()) == signed


def test_what_lies_on_the_parents_device_is_refused_by_name():
    scene = scene_of(cube())
    rays = scene.device_array((1, 8))
    rays.numpy()[:] = [0.3, 0.6, 9, 0, 0, 0, -1, np.inf]
    scene.trace(rays)
    told = answer_of_child(lambda: scene.trace(rays) and None)
    assert told.startswith("Error: ") and "fork" in told and "spawn" in told
    assert answer_of_child(lambda: len(scene.trace(scene.device_array((1, 8))))) == 1


def test_a_child_ends_as_any_program_does():
    code = (
        "import os, sys, twinray; s = twinray.Scene()\n"
        "s.add_triangles([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])\n"
        "ask = lambda: s.cast_rays([[0.1, 0.1, 1, 0, 0, -1]])['t_hit'][0] == 1\n"
        "ask(); child = os.fork()\n"
        "ask()\n"
        "print(os.waitpid(child, 0)[1] if child else 'right')\n"
        "sys.exit(0 if child else 3)"
    )
    ended = run_python(code)
    assert ended.returncode == 0 and ended.stdout == f"right\n{3 << 8}\n", ended


def test_a_scene_that_others_hold_at_the_end_says_nothing():
    code = (
        "import ctypes, twinray; scene = twinray.Scene(); "
        "ctypes.pythonapi.Py_IncRef(ctypes.py_object(scene)); ctypes.pythonapi.Py_IncRef(ctypes.py_object(scene._core))"
    )
    ended = run_python(code)
    assert ended.returncode == 0 and "leak" not in ended.stderr, ended


def test_a_fork_while_another_thread_works_never_hangs():
    scene = scene_of(cube())
    rays = np.repeat(DOWN, 1_000_000, 0)
    thread = threading.Thread(target=lambda: [scene.cast_rays(rays) for _ in range(8)])
    thread.start()
    time.sleep(0.2)
    told = answer_of_child(lambda: height(scene))
    assert told == 8 or "spawn" in told
    assert answer_of_child(lambda: height(scene_of(cube()))) == 8
    thread.join()


def test_pools_of_processes():
    scene = scene_of(cube())
    assert height(scene) == 8
    for method in ("fork", "spawn"):
        with multiprocessing.get_context(method).Pool(2) as pool:
            assert pool.map_async(height, [scene] * 3).get(100) == [8] * 3


def copies(scene):
    yield pickle.loads(pickle.dumps(scene))
    yield copy.deepcopy(scene)
    yield copy.copy(scene)


def test_scenes_are_pickled_and_copied(accel):
    scene = twinray.Scene(accel, level="refined" if accel == "sw" else "watertight")
    first = scene.add_triangles(*cube())
    gone = scene.add_triangles(*cube(9))
    instance = scene.add_instance(first, [[1, 0, 0, 0], [0, 1, 0, 0], [0, 0, 2, 4]])
    scene.remove(gone)
    rays = np.random.default_rng(1).uniform(-1, 2, (500, 6)).astype(np.float32)
    expected = scene.cast_rays(rays)
    for copied in copies(scene):
        assert copied.backend == scene.backend
        found = copied.cast_rays(rays)
        assert all((found[name] == expected[name]).all() for name in expected)
        copied.set_transform(instance, np.eye(4))
        copied.update_vertices(first, cube(2)[0])
        assert copied.add_triangles(*cube()) == 3
    assert (scene.cast_rays(rays)["t_hit"] == expected["t_hit"]).all() and len(scene) == 2


def test_copies_far_from_the_origin():
    far = np.array([5e5, 5e6, 100])
    scene = twinray.Scene()
    scene.add_triangles(cube()[0].astype(np.float64) + far, cube()[1])
    for copied in copies(scene):
        assert (copied.origin == scene.origin).all() and (copied.bounds() == scene.bounds()).all()
        copied.add_triangles(cube()[0].astype(np.float64) + far + [0, 0, 1], cube()[1])
        assert copied.bounds()[1, 2] == 102
    assert scene.bounds()[1, 2] == 101


def test_scenes_end_while_another_thread_uses_the_device():
    code = """
import logging, threading, time, numpy as np, twinray
logging.disable()
scene = twinray.Scene("sw")
scene.add_triangles(np.random.rand(3000, 3), np.arange(3000).reshape(-1, 3))
held = [twinray.Scene("sw"), twinray.Scene("sw"), scene.device_array(64, np.uint8), scene.device_array(64, np.uint8)]
rays = np.random.rand(100_000, 6).astype(np.float32)  # for longer than a look at signals waits
stop = threading.Event()

def trace():
    while not stop.is_set():
        scene.cast_rays(rays)

thread = threading.Thread(target=trace)
thread.start()
while held:
    time.sleep(0.1)
    held.pop()
stop.set()
thread.join()
print("ended")
"""
    assert run_python(code).stdout == "ended\n"


LONG = {
    "view_factors": "twinray.view_factors(scene, rays=1 << 20, groups=np.arange(len(faces)) % 50)",
    "view_factors with a bar": "twinray.view_factors(scene, rays=1 << 20, progress=True)",
    "illumination": "twinray.illumination(scene, [0.3, 0.2, -1], side=60_000)",
    "visible": "twinray.visible(np.random.rand(4_000_000, 3), twinray.sky_patches('reinhart2305')[0], scene=scene)",
    "verify": "twinray.verify(scene, count=1 << 26)",
    "signed distances": "scene.compute_signed_distance(np.random.rand(8_000_000, 3))",
    "waiting for another thread": "threading.Thread(target=twinray.sky_light, args=(scene,), "
    "kwargs={'samples': 1 << 20}, daemon=True).start(), time.sleep(0.5), scene.remove(0)",
}


# It is interrupted even where a shell's background jobs ignore that.
INTERRUPTIBLE = f"""
import logging, os, signal, sys, threading, time
signal.signal(signal.SIGINT, signal.default_int_handler)
sys.path.insert(0, {os.path.dirname(__file__)!r})
import numpy as np, twinray
from concurrent.futures import ThreadPoolExecutor
from conftest import grid, scene_of
logging.disable()
vertices, faces = grid(70)
scene = scene_of((vertices, faces))
"""


def interrupted(code, seconds):
    """A program that printed "begun" and got Ctrl-C so much later, and when it got it."""
    program = subprocess.Popen([sys.executable, "-c", code], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    assert program.stdout.readline() == "begun\n", program.communicate()
    time.sleep(seconds)
    program.send_signal(signal.SIGINT)
    return program, time.monotonic()


@pytest.mark.parametrize("call", LONG)
def test_ctrl_c_ends_a_call(call):
    code = f"""
scene.cast_rays([[0.3, 0.6, 9, 0, 0, -1]])
print("begun", flush=True)
try:
    {LONG[call]}
    print("done")
except KeyboardInterrupt:
    print("interrupted", flush=True)
    if "thread" not in {call!r}:
        print(np.isfinite(scene.cast_rays([[0.3, 0.6, 9, 0, 0, -1]])["t_hit"]).all(), flush=True)
os._exit(0)
"""
    program, begun = interrupted(INTERRUPTIBLE + code, 2)
    try:
        answer = program.stdout.readline()
        seconds = time.monotonic() - begun
        rest = program.communicate(timeout=60)
    finally:
        program.kill()
    # It takes a tenth of a second where nobody else works.
    assert answer == "interrupted\n" and seconds < 5, (answer, seconds, rest)
    assert "thread" in call or rest[0] == "True\n", rest


@pytest.mark.parametrize("has_dask", [False, True])
def test_ctrl_c_ends_the_calls_of_other_threads(has_dask):
    if has_dask:
        needed("dask.array")
    call = (
        "terrain.sky_view(heights, 10.0, relief=2, patches='reinhart2305', tile=512).compute()"
        if has_dask
        else "list(ThreadPoolExecutor(2).map(lambda tile: twinray.sky_light(scene, samples=1 << 20), range(2)))"
    )
    code = f"""
{"from twinray import terrain" if has_dask else ""}
heights = np.random.default_rng(1).random((1024, 1024))
print("begun", flush=True)
{call}
"""
    program, begun = interrupted(INTERRUPTIBLE + code, 3)
    try:
        rest = program.communicate(timeout=60)
    finally:
        program.kill()
    assert program.returncode == -signal.SIGINT and time.monotonic() - begun < 5, rest


def test_what_the_engine_says_goes_to_the_logger(tmp_path, caplog):
    file = tmp_path / "two.obj"
    file.write_text("v 0 0 0\nv 1 0 0\nv 0 1 0\nv nan 0 0\nf 1 2 3\nf 1 2 4\n")
    with caplog.at_level(logging.WARNING, "twinray"):
        twinray.Scene().add_file(file)
    assert "inactive" in caplog.text
