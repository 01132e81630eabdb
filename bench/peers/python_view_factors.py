"""View factors of packages of Python at equal time, in a room in which a cabinet hides cells from each other:

    python_view_factors.py [--cells 4] [--parts 1 2 3] [--rounds 5] [--steps 32] [-o FILE.json]

Each wall has cells * cells rectangles, the cabinet four on each side; the same room is asked for by rectangles and by
triangles. The truth is view_factor_truth.py's, in float64 and by no rays. pyViewFactor takes a pair for all visible or
for all hidden and is the more exact, the finer the cells: it gets each cell in 1, 4 and 9 parts, and the others the
rays that take as long. A time is that of a call from arrays to a dense matrix, all structures made anew, after a first
call, the shortest of all rounds; first calls are timed in processes of their own. Packages that are not installed are
left out: twinray, pyviewfactor, raystrack (whose "vulkan" wants taichi)."""

import argparse
import importlib.metadata
import json
import os
import statistics
import subprocess
import sys
import tempfile
import time
import warnings
from dataclasses import dataclass, replace

import numpy as np

os.environ.setdefault("NUMBA_THREADING_LAYER", "omp")  # calls of TBB 2021 get slower with each call
warnings.simplefilter("ignore")

ROOM, CABINET, MIDDLE, TURN = (4, 3, 2.5), (1.2, 0.6, 1.8), (1.7, 1.3, 0.15), np.radians(20)
SEEN = 1e-4
APART, RAYS_APART = {"raystrack vulkan"}, 4096  # Taichi keeps memory of each row: a process ends after some 20 calls


@dataclass
class Room:
    cells: np.ndarray  # (n, 4, 3); the last vertex of a triangle is its first
    counts: np.ndarray
    sides: np.ndarray  # cells of one of these do not see each other
    walls: int  # the number of the room's cells; the others are the cabinet's
    box: np.ndarray

    def mesh(self):
        """Vertices and triangles, and of which cell each triangle is."""
        n = len(self.cells)
        first = np.arange(n)[:, None] * 4
        if self.counts[0] == 3:
            return self.cells.reshape(-1, 3), first + [[0, 1, 2]], np.arange(n)
        both = np.stack([first + [[0, 1, 2]], first + [[0, 2, 3]]], axis=1).reshape(-1, 3)
        return self.cells.reshape(-1, 3), both, np.repeat(np.arange(n), 2)


def sides_of(size):
    """Corner and two edges of each side of a box, whose cross product points outwards."""
    x, y, z = np.diag(np.array(size, float))
    o = 0 * x
    return [(o, y, x), (o, z, y), (o, x, z), (z, x, y), (x, y, z), (y, z, x)]


def grid(corner, u, v, n):
    steps = np.arange(n)
    at = corner + (steps[:, None, None] * u + steps[None, :, None] * v).reshape(-1, 3) / n
    return np.stack([at, at + u / n, at + (u + v) / n, at + v / n], axis=1)


def turned(cells):
    c, s = np.cos(TURN), np.sin(TURN)
    away = np.array([CABINET[0] / 2, CABINET[1] / 2, 0])
    return (cells - away) @ np.array([[c, s, 0], [-s, c, 0], [0, 0, 1]]) + MIDDLE


def rectangles(n):
    walls = np.concatenate([grid(o, v, u, n) for o, u, v in sides_of(ROOM)])
    cabinet, box = (turned(np.concatenate([grid(*side, k) for side in sides_of(CABINET)])) for k in (2, 1))
    cells = np.concatenate([walls, cabinet]).astype(np.float32).astype(np.float64)
    sides = np.append(np.repeat(np.arange(6), n * n), np.full(len(cabinet), 6))
    return Room(cells, np.full(len(cells), 4), sides, len(walls), box.astype(np.float32).astype(np.float64))


def triangles(n):
    room = rectangles(n)
    cells = room.cells[:, [[0, 1, 2, 0], [0, 2, 3, 0]]].reshape(-1, 4, 3)
    return Room(cells, np.full(len(cells), 3), np.repeat(room.sides, 2), 2 * room.walls, room.box)


def parts_of(room, k):
    """Each cell as k * k alike, in order."""
    a, u, v = room.cells[:, 0], room.cells[:, 1] - room.cells[:, 0], room.cells[:, 2] - room.cells[:, 1]
    parts = [
        (i + x0, j + y0, i + x1, j + y1, i + x2, j + y2, i + x3, j + y3)
        for i in range(k)
        for j in range(k)
        for x0, y0, x1, y1, x2, y2, x3, y3 in _shapes(room.counts[0], i, j)
    ]
    at = np.array(parts).reshape(len(parts), 4, 2) / k
    cells = a[:, None, None] + at[None, ..., :1] * u[:, None, None] + at[None, ..., 1:] * v[:, None, None]
    return replace(room, cells=cells.reshape(-1, 4, 3), counts=np.full(len(a) * len(parts), room.counts[0]))


def _shapes(count, i, j):
    if count == 4:
        return [(0, 0, 1, 0, 1, 1, 0, 1)]
    lower, upper = (0, 0, 1, 0, 1, 1, 0, 0), (0, 0, 1, 1, 0, 1, 0, 0)
    return [lower, upper] if j < i else [lower] if j == i else []


class Twinray:
    """Effort: rays of a row."""

    least = 64

    def __init__(self, estimator):
        import twinray

        self.twinray, self.estimator = twinray, estimator
        backend = twinray.Scene().backend
        self.about = f"{twinray.__version__}, {backend['path']} on {backend['device']}, estimator {estimator}"

    def ask(self, room, effort):
        vertices, faces, cells = room.mesh()
        scene = self.twinray.Scene()
        scene.add_triangles(vertices.astype(np.float32), faces.astype(np.uint32))
        groups = None if len(faces) == len(room.cells) else cells
        return self.twinray.view_factors(scene, groups, rays=effort, estimator=self.estimator)


class Pyviewfactor:
    """Effort: each cell in effort * effort parts."""

    least = 1

    def __init__(self, strict):
        import pyviewfactor
        import pyvista

        self.pvf, self.pv, self.strict = pyviewfactor, pyvista, strict
        version = importlib.metadata.version("pyviewfactor")
        self.about = f"{version}, obstacle the cabinet, {'all corners' if strict else 'middles'} must see each other"

    def polygons(self, cells, count):
        rows = np.arange(len(cells) * 4).reshape(-1, 4)[:, :count]
        return self.pv.PolyData(cells.reshape(-1, 3), np.insert(rows, 0, count, axis=1).ravel())

    def ask(self, room, effort):
        parts = parts_of(room, effort) if effort > 1 else room
        mesh, cabinet = self.polygons(parts.cells, parts.counts[0]), self.polygons(room.box, 4)
        found = self.pvf.compute_viewfactor_matrix(mesh, obstacles=[cabinet], strict_obstruction=self.strict)
        n, each = len(room.cells), len(parts.cells) // len(room.cells)  # the parts of a cell have equal areas
        return found.reshape(n, each, n, each).sum(axis=1).mean(axis=2).T, None


class Raystrack:
    """Effort: rays of a row. Rows one by one, as `Query.matrix` begins with chunks of 1, 2, 4 ... rays a row."""

    least = 64

    def __init__(self, device="cpu", reciprocity="none"):
        import raystrack

        if not (device == "cpu" or raystrack.available_devices()["taichi"]["available"]):
            raise RuntimeError("taichi is not installed")
        self.rt, self.device, self.reciprocity = raystrack, device, reciprocity
        rows = "rows one by one" if reciprocity == "none" else f"all rows at once, reciprocity {reciprocity}"
        self.about = f"{importlib.metadata.version('raystrack')}, device {device}, bvh builtin, {rows}"

    def options(self, effort):
        rt = self.rt
        return rt.SolveOptions(
            sampling=rt.Sampling(density=1, rays_per_cell=effort // 16),  # 16 cells of samples each surface
            accuracy=rt.Accuracy(max_replicates=1, min_replicates=1, tolerance=0.0),
            postprocessing=rt.Postprocessing(self.reciprocity),
            batch_size=1 << 20,
        )

    def ask(self, room, effort):
        rt, options = self.rt, self.options(effort)
        faces = np.array([[0, 1, 2], [0, 2, 3]][: room.counts[0] - 2])
        scene = rt.Scene.from_meshes((str(i), rt.Mesh(cell, faces)) for i, cell in enumerate(room.cells))
        with rt.Solver(scene, device=self.device, bvh="builtin", auto_tune=False) as solver:
            if self.reciprocity == "none":
                results = [solver.solve(rt.Query.row(name), options) for name in scene.surface_ids]
            else:
                results = [solver.solve(rt.Query.matrix(), options)]
        front = [i for i, c in enumerate(results[0].channels) if c.kind == "surface" and c.side == "front"]
        return np.concatenate([result.dense() for result in results])[:, front], None


PACKAGES = {
    "pyviewfactor": lambda: Pyviewfactor(False),
    "pyviewfactor strict": lambda: Pyviewfactor(True),
    "twinray": lambda: Twinray("auto"),
    "twinray hits": lambda: Twinray("hits"),
    "raystrack": Raystrack,
    "raystrack reciprocal": lambda: Raystrack(reciprocity="bidirectional"),
    "raystrack vulkan": lambda: Raystrack(device="vulkan"),
}


def timed(package, room, effort):
    wall, cpu = time.perf_counter(), time.process_time()
    answer = package.ask(room, effort)
    return time.perf_counter() - wall, time.process_time() - cpu, answer


def effort_for(package, room, seconds):
    """What takes about as long, between the last two of a doubling; or the least, where that takes longer."""
    before, effort = (0, 0.0), package.least
    while True:
        now = min(timed(package, room, effort)[0] for _ in range(3))
        if now >= seconds:
            break
        before, effort = (effort, now), effort * 2
    share = (seconds - before[1]) / (now - before[1])
    return max(package.least, round((before[0] + share * (effort - before[0])) / 64) * 64)


def score(found, half, truth, error, kinds, effort):
    off = found - truth
    partly = kinds == 2
    result = {
        "rms": float(np.sqrt(np.mean(off**2))),
        "rms_partly_hidden": float(np.sqrt(np.mean(off[partly] ** 2))),
        "max": float(np.abs(off).max()),
        "row_sums_mean_off": float(np.abs(found.sum(axis=1) - 1).mean()),
        "lost": int(np.count_nonzero((found == 0) & (truth > SEEN))),
        "invented": int(np.count_nonzero((found > SEEN) & (truth == 0))),
    }
    if half is not None:
        held, told = np.abs(off) <= half + error + 1e-8, (found > 0) | (half > 0)
        result |= {
            "half_width_median_partly_hidden": float(np.median(half[partly & told])),
            "inside": float(held[told].mean()),
            "inside_partly_hidden": float(held[told & partly].mean()),
            "told_nothing": int(np.count_nonzero(~told & (truth > 0))),
            "told_nothing_within": float((truth[~told] <= 3.7 / effort).mean()),
        }
    return result


def calls_apart(name):
    """Of a process of its own: the first call from the import on, with empty caches on disk and with those that left,
    and a second call."""
    with tempfile.TemporaryDirectory() as folder:
        places = ("XDG_CACHE_HOME", "MESA_SHADER_CACHE_DIR", "NUMBA_CACHE_DIR")
        environment = os.environ | {place: os.path.join(folder, place) for place in places}
        command = [sys.executable, __file__, "--apart", name]
        told = [subprocess.run(command, env=environment, capture_output=True, text=True) for _ in range(2)]
    if any(each.returncode for each in told):
        return {"package": name, "left_out": told[0].stderr.strip().splitlines()[-1]}
    (first, _), (first_cached, second) = (map(float, each.stdout.split()[-2:]) for each in told)
    effort = 1 if "pyviewfactor" in name else RAYS_APART
    return {"package": name, "first_call_seconds": round(first, 2), "first_call_seconds_cached": round(first_cached, 2),
            "second_call_effort": effort, "second_call_seconds": round(second, 3)}  # fmt: skip


def call_apart(name):
    room, start = rectangles(4), time.perf_counter()
    package = PACKAGES[name]()
    package.ask(room, package.least)
    print(time.perf_counter() - start, timed(package, room, 1 if package.least == 1 else RAYS_APART)[0])


def installed():
    for name, make in PACKAGES.items():
        if name not in APART:
            try:
                yield name, make()
            except Exception as error:  # not installed
                print(f"{name}: left out: {error}")


def versions():
    names = ("numpy", "numba", "pyvista", "taichi")
    found = {each.metadata["Name"].lower(): each.version for each in importlib.metadata.distributions()}
    return {"python": sys.version.split()[0]} | {name: found[name] for name in names if name in found}


def plan(packages, room, parts):
    """Of each package the efforts and the times they are for, which are those of pyViewFactor."""
    pyviewfactor = packages["pyviewfactor"]
    times = [min(timed(pyviewfactor, room, k)[0] for _ in range(3)) for k in parts]
    tasks = [("pyviewfactor", k, target) for k, target in zip(parts, times)]
    for name, package in packages.items():
        if name == "pyviewfactor strict":
            tasks.append((name, 1, None))
        elif name != "pyviewfactor":
            efforts = {effort_for(package, room, target): target for target in (times[0] / 10, *times)}
            tasks += [(name, effort, target) for effort, target in efforts.items()]
    return tasks


def compare(packages, scene, room, options):
    import view_factor_truth

    truth, error, kinds, known = view_factor_truth.view_factors(room, options.steps)
    record = {"scene": scene, "cells": len(room.cells), "truth": known | checked(packages, room, truth, kinds)}
    for i, kind in enumerate(("never_facing", "hidden", "partly_hidden", "open")):
        record[f"pairs_{kind}"] = int(np.count_nonzero(kinds == i))
    yield record
    for package in packages.values():
        package.ask(room, package.least)
    tasks = plan(packages, room, options.parts)
    rounds = [[timed(packages[name], room, effort) for name, effort, _ in tasks] for _ in range(options.rounds)]
    for (name, effort, target), each in zip(tasks, zip(*rounds)):
        yield {"scene": scene, "package": name, "about": packages[name].about, "effort": effort,
               "seconds_wanted": target and round(target, 3),
               "seconds": round(min(wall for wall, _, _ in each), 3),
               "seconds_median": round(statistics.median(wall for wall, _, _ in each), 3),
               "cpu_seconds": round(min(cpu for _, cpu, _ in each), 3),
               **score(*each[0][2], truth, error, kinds, effort)}  # fmt: skip


def checked(packages, room, truth, kinds):
    """The truth beside two other ways: segments between some cells, and very many rays."""
    from view_factor_truth import by_segments

    i, j = np.nonzero((kinds == 2) & (truth > SEEN))
    some = np.random.default_rng(3).choice(len(i), 50, replace=False)
    off = [by_segments(room, i[k], j[k]) - truth[i[k], j[k]] for k in some]
    known = {"segments_max_off": float(np.abs(off).max())}
    if "twinray hits" in packages:
        off = packages["twinray hits"].ask(room, 1 << 20)[0] - truth
        known["twinray_hits_of_2^20_rays_rms_off"] = float(np.sqrt(np.mean(off**2)))
    return known


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--cells", type=int, default=4)
    parser.add_argument("--parts", type=int, nargs="+", default=[1, 2, 3])
    parser.add_argument("--rounds", type=int, default=5)
    parser.add_argument("--steps", type=int, default=32)
    parser.add_argument("--apart", help=argparse.SUPPRESS)
    parser.add_argument("-o", "--output")
    options = parser.parse_args()
    if options.apart:
        return call_apart(options.apart)
    packages = dict(installed())
    records = [{"cpus": os.cpu_count(), "numba_threads": os.environ["NUMBA_THREADING_LAYER"]} | versions()]
    for scene, room in (("rectangles", rectangles(options.cells)), ("triangles", triangles(options.cells))):
        for record in compare(packages, scene, room, options):
            records.append(record)
            print(record, flush=True)
    for name in PACKAGES:
        records.append(calls_apart(name))
        print(records[-1], flush=True)
    if options.output:
        with open(options.output, "w", encoding="utf-8") as file:
            json.dump(records, file, indent=1)


main()
