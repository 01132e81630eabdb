"""Ten thousand calls that nobody should make, while another thread moves and removes: each gives a value, or one
exception that names the argument."""

import gc
import resource
import threading

import numpy as np
import twinray
from conftest import cube, grid, scene_of

CALLS = 10_000


def hostile_array(random, columns):
    """Of any shape, dtype and content."""
    shapes = [(3, columns), (0, columns), (columns,), (2, 2, columns), (columns, 3), (), (3, columns + 1)]
    kind = random.integers(16)
    shape = shapes[random.integers(7)]
    values = random.normal(size=shape) * 10.0 ** random.integers(-300, 300)
    made = {
        0: lambda: None,
        1: lambda: "an array",
        2: lambda: [[1, 2], [3]],
        3: lambda: object(),
        4: lambda: values.astype(complex),
        5: lambda: values.astype(str),
        6: lambda: (values > 0).astype(bool),
        7: lambda: np.full(shape, [np.nan, np.inf, -np.inf, 1e308, 1e-310, -0.0][random.integers(6)]),
        8: lambda: (random.uniform(-100, 100, shape)).astype(np.int8),
        9: lambda: np.asfortranarray(random.normal(size=shape).astype(np.float32)),
        10: lambda: random.normal(size=(8, columns))[::-2],
        11: lambda: {1: 2},
    }
    dtypes = [np.float16, np.float32, np.float64, np.longdouble]
    return made.get(kind, lambda: random.normal(size=shape).astype(dtypes[random.integers(4)]))()


def hostile_number(random):
    return [0, 1, -1, 2**32, 2**70, np.nan, "0", None, 1.5, 10**9][random.integers(10)]


def memory():
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


def test_ten_thousand_hostile_calls():
    random = np.random.default_rng(7)
    scene = scene_of(cube(), accel="sw")
    stop = threading.Event()

    def disturb():
        vertices, triangles = grid(4)
        while not stop.is_set():
            geometry = scene.add_triangles(vertices + [5, 0, 0], triangles)
            scene.set_transform(geometry, np.eye(3, 4) * 2)
            scene.update_vertices(geometry, vertices)
            scene.remove(geometry)

    calls = {
        "rays": [
            lambda: scene.cast_rays(hostile_array(random, 6)),
            lambda: scene.test_occlusions(hostile_array(random, 6), hostile_number(random), hostile_number(random)),
            lambda: scene.count_intersections(hostile_array(random, 6)),
            lambda: scene.list_intersections(hostile_array(random, 6), normals=True),
        ],
        "query_points": [
            lambda: scene.compute_distance(hostile_array(random, 3)),
            lambda: scene.compute_closest_points(hostile_array(random, 3)),
        ],
        "vertex_positions": [
            lambda: scene.add_triangles(hostile_array(random, 3), hostile_array(random, 3)),
            lambda: scene.update_vertices(hostile_number(random), hostile_array(random, 3)),
        ],
        "transform": [lambda: scene.set_transform(0, hostile_array(random, 4))],
        "geometry": [lambda: scene.remove(hostile_number(random)), lambda: scene.add_instance(hostile_number(random))],
    }
    argument_names = (*calls, "triangle_indices", "tnear", "tfar")
    thread = threading.Thread(target=disturb)
    thread.start()
    answered, told, half = 0, 0, None
    try:
        for i in range(CALLS):
            argument = list(calls)[random.integers(len(calls))]
            call = calls[argument][random.integers(len(calls[argument]))]
            try:
                call()
                answered += 1
            except (TypeError, ValueError, twinray.Error) as error:
                told += 1
                assert any(name in str(error) for name in argument_names) or "triangle" in str(error), error
            if i == CALLS // 2:
                gc.collect()
                half = memory()
    finally:
        stop.set()
        thread.join()
    assert answered > 1000 and told > 1000
    assert memory() < half + 100, "megabytes at the most, and at half of the calls"
    assert scene_of(cube(), accel="sw").cast_rays([0.3, 0.6, -1, 0, 0, 1])["t_hit"] == 1
