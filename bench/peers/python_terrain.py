#!/usr/bin/env python3
"""Sky and view factors on workers of Dask, in figures:

    python_terrain.py workers [--side 1024] [--tile 256] [--rounds 3]    one process against two on the same cores,
                                                                         and with a worker that is killed
    python_terrain.py packages [--side 256] [--xrspatial PYTHON]         beside Open3D, and xarray-spatial in a Python
                                                                         that has it; errors against float64
    python_terrain.py out-of-core [--side 10000] [--tile 1000]           hours of sun of 10^8 cells, into FILE.zarr
    python_terrain.py factors [--faces 20000] [--rays 1024]              view factors in chunks of 100 and 1,000 rows

All take [-o FILE.json] and append a line. Terrain is a sum of waves, so that any part of it can be made by itself."""

import argparse
import hashlib
import json
import os
import pathlib
import resource
import signal
import statistics
import subprocess
import sys
import tempfile
import threading
import time
import warnings

import dask
import dask.array as da
import numpy as np

warnings.simplefilter("ignore")
CELL = 30.0  # metres
WAVES = 24


def heights_at(rows, columns, seed=1):
    """Heights (rows, columns) float32 in metres of cells by their numbers: ridges of all sizes."""
    random = np.random.default_rng(seed)
    x, y = columns[None, :] * CELL, rows[:, None] * CELL
    total = np.zeros((len(rows), len(columns)))
    for i in range(WAVES):
        length = 12_000 * 0.8**i
        angle, phase = random.uniform(0, 2 * np.pi, 2)
        wave = (np.cos(angle) * x + np.sin(angle) * y) * (2 * np.pi / length) + phase
        total += length * 0.02 * (1 - 2 * np.abs(np.sin(wave)))
    return total.astype(np.float32)


def raster(side, chunk):
    """A lazy raster (side, side)."""

    def part(block, block_info=None):
        (r0, r1), (c0, c1) = block_info[None]["array-location"]
        return heights_at(np.arange(r0, r1), np.arange(c0, c1))

    return da.map_blocks(part, da.zeros((side, side), chunks=chunk, dtype=np.float32), dtype=np.float32)


def peak_mib():
    return resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 1024


def cpu_seconds():
    used = resource.getrusage(resource.RUSAGE_SELF)
    return used.ru_utime + used.ru_stime


def timed(rounds, work):
    """The median of the seconds, and what is found."""
    times = []
    for _ in range(rounds):
        start = time.perf_counter()
        found = work()
        times.append(time.perf_counter() - start)
    return statistics.median(times), found


def digest(values):
    return hashlib.sha256(np.ascontiguousarray(values).tobytes()).hexdigest()[:16]


def workers(options):
    """Rays a second of one process with two threads of its driver, and of two with one each, by turns."""
    from distributed import Client, LocalCluster
    from twinray import terrain

    heights = raster(options.side, options.tile)
    rays = heights.size * 145
    low, high = dask.compute(heights.min(), heights.max(), scheduler="threads")
    relief = float(high - low)
    sky = {"relief": relief, "patches": "tregenza145"}

    def measured(count, threads, kill_after=None):
        environment = {"LP_NUM_THREADS": str(threads)}
        with (
            dask.config.set({"distributed.nanny.pre-spawn-environ": environment}),
            LocalCluster(n_workers=count, threads_per_worker=1, dashboard_address=None, env=environment) as cluster,
            Client(cluster) as client,
        ):
            small = terrain.sky_view(heights[:64, :64], CELL, tile=32, **sky)
            client.compute([small] * count)[0].result()  # pipelines are there
            pids = client.run(os.getpid)
            before = client.run(cpu_seconds)
            start = time.perf_counter()
            future = client.compute(terrain.sky_view(heights, CELL, tile=options.tile, **sky))
            if kill_after:
                threading.Timer(kill_after, lambda: os.kill(next(iter(pids.values())), signal.SIGKILL)).start()
            found = future.result()
            took = time.perf_counter() - start
            worked = [seconds - before.get(worker, 0) for worker, seconds in client.run(cpu_seconds).items()]
            print("seconds of CPU by worker:", *(f"{seconds:.1f}" for seconds in worked), flush=True)
            worked = sum(worked)
            return took, worked, digest(found), max(client.run(peak_mib).values())

    seconds, work, digests, peaks = {1: [], 2: []}, {1: [], 2: []}, set(), {1: 0, 2: 0}
    for turn in range(options.rounds):
        for count in (1, 2) if turn % 2 == 0 else (2, 1):
            took, worked, bits, peak = measured(count, 2 // count)
            seconds[count].append(took)
            work[count].append(worked)
            digests.add(bits)
            peaks[count] = max(peaks[count], peak)
            speed = f"{rays / took / 1e6:.2f} million rays a second, {rays / worked / 1e6:.2f} a second of CPU"
            print(f"{count} process(es): {took:.1f} s, {speed}", flush=True)
    median = {count: statistics.median(times) for count, times in seconds.items()}
    killed, _, bits, _ = measured(2, 1, kill_after=median[2] / 2)
    digests.add(bits)
    print(f"a worker killed: {killed:.1f} s")
    return {
        "cells": heights.size,
        "rays": rays,
        "seconds_one": seconds[1],
        "seconds_two": seconds[2],
        "efficiency": median[1] / median[2],
        "efficiency_by_cpu_seconds": statistics.median(work[1]) / statistics.median(work[2]),
        "mrays_one": rays / median[1] / 1e6,
        "mrays_two": rays / median[2] / 1e6,
        "peak_mib_of_a_worker": peaks,
        "seconds_with_a_kill": killed,
        "seconds_lost": killed - median[2],
        "same_bits": len(digests) == 1,
    }


def true_view(heights, rows, columns, azimuths=720):
    """In float64: the parts of a uniform sky's light and of the hemisphere, (cells, 2), by the horizon of the surface
    of triangles along each azimuth, at the crossings with its edges."""
    size = heights.shape[0]
    answers = np.zeros((len(rows), 2))
    for i, (row, column) in enumerate(zip(rows, columns, strict=True)):
        angle = (np.arange(azimuths) + 0.5) * (2 * np.pi / azimuths)
        dx, dy = np.cos(angle), np.sin(angle)
        slope = np.zeros(azimuths)
        for step_x, step_y in ((1, 0), (0, 1), (1, -1)):  # edges along y, along x, and diagonals x - y = constant
            speed = dx * step_x + dy * step_y
            k = np.arange(1, size)
            with np.errstate(divide="ignore", invalid="ignore"):
                t = k[None, :] / np.abs(speed)[:, None]
                x, y = column + t * dx[:, None], row + t * dy[:, None]
                is_inside = (x >= 0) & (x <= size - 1) & (y >= 0) & (y <= size - 1)
            x, y = np.where(is_inside, x, 0), np.where(is_inside, y, 0)
            if step_y == 0:
                u = np.rint(x).astype(int)
                v = np.minimum(y.astype(int), size - 2)
                f = y - v
            elif step_x == 0:
                v = np.rint(y).astype(int)
                u = np.minimum(x.astype(int), size - 2)
                f = x - u
            else:
                u = np.minimum(x.astype(int), size - 2)
                v = np.minimum(np.rint(y - (x - u)).astype(int), size - 2)
                f = x - u
            z = heights[v, u] * (1 - f) + heights[v + abs(step_x), u + abs(step_y)] * f
            steep = np.where(is_inside, (z - heights[row, column]) / (t * CELL), 0)
            slope = np.maximum(slope, steep.max(axis=1))
        answers[i] = np.mean(1 / (1 + slope**2)), np.mean(1 - slope / np.hypot(1, slope))  # cos^2 and 1 - sin of it
    return answers


# xarray-spatial has wheels of a recent version for newer Pythons only, so it runs in a process of its own.
SKY_OF_XRSPATIAL = """
import sys, time
import numpy as np, xarray, xrspatial
heights, cell, rounds, directions = np.load(sys.argv[1]), *map(float, sys.argv[2:4]), int(sys.argv[4])
y, x = (np.arange(count) * cell for count in heights.shape)
raster = xarray.DataArray(heights, dims=("y", "x"), coords={"y": -y, "x": x})
def find():
    return xrspatial.sky_view_factor(raster, max_radius=max(heights.shape), n_directions=directions).values
find()  # compiled
times = []
for _ in range(int(rounds)):
    start = time.perf_counter()
    found = find()
    times.append(time.perf_counter() - start)
np.save(sys.argv[1], found)
print(xrspatial.__version__, sorted(times)[len(times) // 2])
"""


def sky_of_xrspatial(python, heights, rounds, directions):
    """Version, seconds and the part of the hemisphere."""
    with tempfile.TemporaryDirectory() as folder:
        file = os.path.join(folder, "heights.npy")
        np.save(file, heights)
        words = [python, "-c", SKY_OF_XRSPATIAL, file, str(CELL), str(rounds), str(directions)]
        version, seconds = subprocess.run(words, check=True, capture_output=True, text=True).stdout.split()
        return version, float(seconds), np.load(file)


def packages(options):
    """Seconds of all cells, and errors at some, of the sky by twinray, Open3D and xarray-spatial."""
    import twinray
    from twinray import terrain

    heights = heights_at(np.arange(options.side), np.arange(options.side)).astype(np.float64)
    random = np.random.default_rng(2)
    rows, columns = random.integers(0, options.side, (2, options.cells))
    start = time.perf_counter()
    light, solid_angle = true_view(heights, rows, columns).T
    record = {"cells": heights.size, "cells_of_reference": options.cells}
    print(f"reference: {options.cells} cells, {time.perf_counter() - start:.1f} s, mean {light.mean():.4f}", flush=True)

    def tell(name, took, found, true=light):
        error = found[rows, columns] - true
        record[name] = {
            "seconds": took,
            "rms_error": float(np.sqrt(np.mean(error**2))),
            "mean_error": float(error.mean()),
            "largest_error": float(np.abs(error).max()),
        }
        print(name, record[name], flush=True)

    for name, true, what in (
        ("horizon", light, {}),
        ("horizon, solid angle", solid_angle, {"measure": "solid_angle"}),
        ("tregenza145", light, {"patches": "tregenza145"}),
        ("reinhart577", light, {"patches": "reinhart577"}),
    ):

        def ours(what=what):
            return terrain.sky_view(heights, CELL, tile=options.side, **what).compute(scheduler="sync")

        ours()
        tell(f"twinray {name}", *timed(options.rounds, ours), true)
    for directions in (16, 64) if options.xrspatial else ():
        version, took, found = sky_of_xrspatial(options.xrspatial, heights, options.rounds, directions)
        tell(f"xarray-spatial {version}, {directions} directions, solid angle", took, found, solid_angle)
    try:
        import open3d
    except ImportError:
        print("open3d is not installed", file=sys.stderr)
        return record
    x, y = np.meshgrid(np.arange(options.side) * CELL, np.arange(options.side) * -CELL)
    vertices = np.stack([x, y, heights], axis=-1).reshape(-1, 3).astype(np.float32)
    triangles = terrain.triangles_of(np.ones(heights.shape, bool))
    for patches in ("tregenza145", "reinhart577"):
        directions, angles = twinray.sky_patches(patches)
        weights = np.asarray(angles * directions[:, 2])

        def theirs(directions=directions, weights=weights):
            scene = open3d.t.geometry.RaycastingScene()
            scene.add_triangles(open3d.core.Tensor(vertices), open3d.core.Tensor(triangles))
            seen = np.zeros(heights.size)
            rays = np.empty((heights.size, 6), np.float32)
            rays[:, :3] = vertices + np.float32([0, 0, CELL / 1024])
            for direction, weight in zip(directions, weights, strict=True):
                rays[:, 3:] = direction
                seen += weight * ~scene.test_occlusions(open3d.core.Tensor(rays)).numpy()
            return (seen / weights.sum()).reshape(heights.shape)

        tell(f"Open3D {patches}", *timed(options.rounds, theirs))
    return record


def out_of_core(options):
    """Hours of sun at three heights of the sun, from a lazy raster straight into Zarr."""
    from distributed import Client, LocalCluster
    from twinray import terrain

    file = pathlib.Path(options.folder) / "hours.zarr"
    angles = np.radians([15, 30, 50])
    suns = [
        [np.cos(a) * np.sin(b), -np.cos(a) * np.cos(b), np.sin(a)] for a, b in zip(angles, (-1, -0.5, 0), strict=True)
    ]
    heights = raster(options.side, options.tile)
    with LocalCluster(n_workers=1, threads_per_worker=1, dashboard_address=None) as cluster, Client(cluster) as client:
        start = time.perf_counter()
        hours = terrain.sun_hours(heights, suns, [2, 3, 4], CELL, relief=options.relief, tile=options.tile)
        hours.to_zarr(str(file), overwrite=True)
        took = time.perf_counter() - start
        peak = max(client.run(peak_mib).values())
    if options.picture:
        import matplotlib

        matplotlib.use("Agg")
        import matplotlib.pyplot as plt

        step = max(1, options.side // 1000)
        plt.imsave(options.picture, da.from_zarr(str(file))[::step, ::step].compute(), cmap="inferno")
    cells = options.side**2
    return {
        "cells": cells,
        "rays": 3 * cells,
        "seconds": took,
        "cells_a_second": cells / took,
        "peak_mib_of_a_worker": peak,
        "peak_mib_of_this": peak_mib(),
    }


def box(faces):
    """A room of about so many triangles that looks inwards, and a box in it that looks outwards."""
    n = round((faces / 24) ** 0.5)
    quads = []
    for size, corner, is_inward in ((1.0, 0.0, True), (0.4, 0.3, False)):
        s = np.linspace(corner, corner + size, n + 1)
        for axis in range(3):
            for side in (0, 1):
                u, v = np.meshgrid(s, s, indexing="ij")
                points = np.empty((n + 1, n + 1, 3))
                points[..., axis] = corner + side * size
                points[..., (axis + 1) % 3], points[..., (axis + 2) % 3] = u, v
                quads.append((points.reshape(-1, 3), (side == 0) == is_inward))
    i = np.arange((n + 1) ** 2).reshape(n + 1, n + 1)
    a, b, c, d = i[:-1, :-1].ravel(), i[1:, :-1].ravel(), i[1:, 1:].ravel(), i[:-1, 1:].ravel()
    front = np.concatenate([np.stack([a, b, c], -1), np.stack([a, c, d], -1)])
    triangles = [(front if kept else front[:, ::-1]) + k * i.size for k, (_, kept) in enumerate(quads)]
    return np.concatenate([points for points, _ in quads]), np.concatenate(triangles)


def factors(options):
    """Closure, reciprocity and bits of CSR blocks."""
    import scipy.sparse
    import twinray.dask

    vertices, triangles = box(options.faces)
    a, b, c = (vertices[triangles[:, k]] for k in range(3))
    areas = np.linalg.norm(np.cross(b - a, c - a), axis=1) / 2
    record, found = {"faces": len(triangles), "rays_of_a_row": options.rays}, {}
    for chunk in (100, 1000):
        start = time.perf_counter()
        F, half = twinray.dask.view_factors(
            (vertices, triangles), chunk=chunk, rays=options.rays, estimator="hits", sparse=True
        )
        parts = dask.compute(*zip(F.to_delayed().ravel(), half.to_delayed().ravel(), strict=True), scheduler="sync")
        found[chunk] = [scipy.sparse.vstack([part[k] for part in parts]).tocsr() for k in (0, 1)]
        record[f"seconds_{chunk}"] = time.perf_counter() - start
        print(f"chunks of {chunk}: {record[f'seconds_{chunk}']:.1f} s", flush=True)
    F, half = found[100]
    flows, widths = scipy.sparse.diags(areas) @ F, scipy.sparse.diags(areas) @ half
    difference = abs(flows - flows.T)
    room = difference.max() / areas.max()
    both = flows.multiply(flows.T > 0)
    is_within = abs(both - both.T) - (widths + widths.T).multiply(both > 0)
    return record | {
        "entries": int(F.nnz),
        "same_bits": all(
            np.array_equal(getattr(x, name), getattr(y, name))
            for x, y in zip(found[100], found[1000], strict=True)
            for name in ("data", "indices", "indptr")
        ),
        "closure_largest": float(np.abs(np.asarray(F.sum(axis=1)).ravel() - 1).max()),
        "reciprocity_largest": float(room),
        "pairs_within_both_intervals": float(1 - (is_within.data > 0).sum() / max(1, both.nnz)),
        "mean_half_width": float(half.data.mean()),
    }


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("what", choices=["workers", "packages", "out-of-core", "factors"])
    parser.add_argument("--side", type=int)
    parser.add_argument("--tile", type=int)
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--cells", type=int, default=10_000, help="of the reference")
    parser.add_argument("--xrspatial", metavar="PYTHON", help="a Python that has xarray-spatial")
    parser.add_argument("--relief", type=float, help="of the terrain out of core; it is read once without it")
    parser.add_argument("--faces", type=int, default=20_000)
    parser.add_argument("--rays", type=int, default=1024)
    parser.add_argument("--folder", default=".")
    parser.add_argument("--picture")
    parser.add_argument("-o", "--output")
    options = parser.parse_args()
    sides = {"workers": (1024, 256), "packages": (256, 256), "out-of-core": (10_000, 1000), "factors": (0, 0)}
    options.side, options.tile = options.side or sides[options.what][0], options.tile or sides[options.what][1]
    record = {"what": options.what} | globals()[options.what.replace("-", "_")](options)
    print(json.dumps(record, indent=1))
    if options.output:
        with open(options.output, "a") as file:
            file.write(json.dumps(record) + "\n")


if __name__ == "__main__":
    main()
