#!/usr/bin/env python3
"""Rays a second of twinray and of other packages, and how many of a million answers are wrong, in one run:

    python_rays.py [--rays 1000000] [--subdivisions 8] [--instances 1000] [--mesh FILE] [--rounds 3] [--cuda]
                   [--only PART,...] [--seconds S] [--programs FOLDER] [-o FILE.json]

Speed: rays of a camera, and rays from where those hit in random directions, for the closest hit and for any, at a
sphere of 20 * 4**subdivisions triangles, at as many spheres as there are instances, and at a mesh, say the Stanford
bunny. Rays lie in the memory of the device before the clock starts. Wrong answers: rays from inside a sphere, aimed at
its vertices and at points of its edges, must hit at t = 1; those from inside the mesh, whose holes are closed first,
somewhere. Packages that are not installed are named and left out: twinray, embreex, open3d, warp-lang, mitsuba, and
the programs that bench/peers/programs.sh makes. With --cuda Warp, Mitsuba and the programs use the GPU, and CuPy moves
twinray's rays. After --seconds nothing more is begun."""

import argparse
import json
import pathlib
import statistics
import sys
import time
import warnings

import numpy as np
from ray_packages import Twinray, backends_of

warnings.simplefilter("ignore")

KINDS = {"camera": False, "random": False, "occlusion": True}  # whether any hit is enough


def sphere(subdivisions):
    import trimesh

    mesh = trimesh.creation.icosphere(subdivisions)
    return np.array(mesh.vertices, np.float32), np.array(mesh.faces, np.uint32)


def camera(count):
    side = int(count**0.5)
    x, y = np.meshgrid(np.linspace(-0.4, 0.4, side), np.linspace(-0.4, 0.4, side))
    directions = np.stack([x, y, np.full_like(x, -1)], axis=-1).reshape(-1, 3)
    return np.hstack([np.tile([0, 0, 3.0], (len(directions), 1)), directions]).astype(np.float32)


def scattered(rays, t, seed=3):
    """From a little before where the rays hit, in random directions; rays that missed begin where they did."""
    hit = np.isfinite(t) & (t > 0) & (t < 1e30)
    directions = np.random.default_rng(seed).normal(size=(len(rays), 3))
    directions /= np.linalg.norm(directions, axis=1, keepdims=True)
    origins = rays[:, :3] + np.where(hit, t * 0.999, 0)[:, None] * rays[:, 3:]
    return np.hstack([origins, directions]).astype(np.float32)


def aimed(vertices, triangles, count, seed=1):
    """From near the middle at vertices and points of edges, of which float32 holds what it can; hits are at t = 1."""
    random = np.random.default_rng(seed)
    some = triangles[random.integers(len(triangles), size=count)]
    along = random.uniform(0, 1, (count, 1)).astype(np.float32) * (random.random((count, 1)) < 0.5)
    a, b = vertices[some[:, 0]], vertices[some[:, 1]]
    origins = random.uniform(-0.3, 0.3, (count, 3)).astype(np.float32)
    return np.hstack([origins, a + along * (b - a) - origins]).astype(np.float32)


def loaded(file):
    """A mesh, about 0 and two large, with a fan over each hole, so that it is closed."""
    import trimesh

    mesh = trimesh.load(file, force="mesh", process=False)
    low, high = mesh.bounds
    vertices, triangles = (mesh.vertices - (low + high) / 2) * 2 / (high - low).max(), np.asarray(mesh.faces)
    edges = triangles[:, [[0, 1], [1, 2], [2, 0]]].reshape(-1, 2)
    rim = {tuple(e) for e in edges.tolist()} - {(b, a) for a, b in edges.tolist()}
    after = {a: b for a, b in rim if (b, a) not in rim}
    while after:
        loop = [next(iter(after))]
        while (vertex := after.pop(loop[-1])) != loop[0]:
            loop.append(vertex)
        fan = [(b, a, len(vertices)) for a, b in zip(loop, loop[1:] + loop[:1])]
        vertices = np.vstack([vertices, vertices[loop].mean(axis=0)])
        triangles = np.vstack([triangles, fan])
    return vertices.astype(np.float32), triangles.astype(np.uint32)


def aimed_within(vertices, triangles, count, seed=1):
    """From points inside the closed mesh at its vertices and points of its edges: each must hit, if not there."""
    import twinray

    random = np.random.default_rng(seed)
    scene = twinray.Scene("sw")
    scene.add_triangles(vertices, triangles)
    points = random.uniform(vertices.min(axis=0), vertices.max(axis=0), (20000, 3)).astype(np.float32)
    inside = points[(scene.compute_winding_numbers(points) == 1) & (scene.compute_distance(points) > 1e-3)]
    rays = aimed(vertices, triangles, count, seed)
    origins = inside[random.integers(len(inside), size=count)]
    rays[:, 3:] += rays[:, :3] - origins
    rays[:, :3] = origins
    return rays


def wrong_per_million(t, is_sphere):
    is_right = np.abs(t - 1) < 1e-3 if is_sphere else np.isfinite(t) & (t > 0) & (t < 1e30)
    return float((~is_right).mean() * 1e6)


class Session:
    def __init__(self, options):
        self.options, self.records, self.end = options, [], time.monotonic() + options.seconds

    def is_over(self):
        return time.monotonic() > self.end

    def made(self, only):
        """The packages that are there, each ready to build."""
        made = {}
        for name, make in backends_of(self.options).items():
            if only and not any(part in name for part in only):
                continue
            try:
                made[name] = make()
            except Exception as error:  # not installed, or no such hardware
                print(f"{name}: left out: {error}", flush=True)
        return made

    def timed(self, backend, is_any):
        """The median of the rounds after the first."""
        seconds = []
        for _ in range(self.options.rounds + 1):
            start = time.perf_counter()
            told = backend.trace(is_any)
            seconds.append(time.perf_counter() - start if told is None else told)
        return statistics.median(seconds[1:])

    def measure(self, scene, geometry, rays, inside):
        vertices, triangles, offsets = geometry
        for name, backend in self.made(self.options.only).items():
            if self.is_over():
                print(f"{scene}: {name}: left out: the time is over", flush=True)
                continue
            record = {"scene": scene, "triangles": len(triangles) * len(offsets), "package": name,
                      "about": backend.about}  # fmt: skip
            try:
                record.update(self.figures(backend, geometry, rays, inside, "sphere" in scene))
            except Exception as error:  # the package failed: the others are measured all the same
                print(f"{scene}: {name}: left out: {error}", flush=True)
                continue
            self.records.append(record)
            print(json.dumps(record), flush=True)

    def figures(self, backend, geometry, rays, inside, is_sphere):
        start = time.perf_counter()
        backend.build(*geometry)
        backend.load(rays["camera"][:1])
        backend.trace(False)
        figures = {"build_seconds": round(time.perf_counter() - start, 3)}
        for kind, is_any in KINDS.items():
            backend.load(rays[kind])
            seconds = self.timed(backend, is_any)
            figures[kind] = {"rays": len(rays[kind]), "ms": round(seconds * 1e3, 3),
                             "mrays_per_s": round(len(rays[kind]) / seconds / 1e6, 3)}  # fmt: skip
        if inside is not None:
            backend.load(inside)
            backend.trace(False)
            figures["wrong_per_million"] = wrong_per_million(np.asarray(backend.distances()), is_sphere)
        return figures


def rays_of(geometry, count):
    """By kind. Where the camera's rays hit is told by twinray, for all."""
    vertices, triangles, offsets = geometry
    first = Twinray("sw", False)
    first.build(vertices, triangles, offsets)
    seen = camera(count)
    t = first.scene.cast_rays(seen, normals=False)["t_hit"]
    random = scattered(seen, np.asarray(t))
    return {"camera": seen, "random": random, "occlusion": random}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rays", type=int, default=1_000_000)
    parser.add_argument("--subdivisions", type=int, default=8)
    parser.add_argument("--instances", type=int, default=1000)
    parser.add_argument("--mesh")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--cuda", action="store_true")
    parser.add_argument("--only", type=lambda text: text.split(","))
    parser.add_argument("--seconds", type=float, default=float("inf"))
    parser.add_argument("--programs")
    parser.add_argument("-o", "--output")
    options = parser.parse_args()
    sys.path.insert(0, str(pathlib.Path(__file__).parent))
    fine, coarse, alone = sphere(options.subdivisions), sphere(4), np.zeros((1, 3), np.float32)
    spread = np.random.default_rng(2).uniform(-1, 1, (options.instances, 3)) * [20, 20, 1] - [0, 0, 30]
    scenes = {
        f"sphere of {len(fine[1])}": ((*fine, alone), lambda: aimed(*fine, 1_000_000)),
        f"{options.instances} spheres of {len(coarse[1])}": ((*coarse, spread.astype(np.float32)), lambda: None),
    }
    if options.mesh:
        mesh = loaded(options.mesh)
        name = f"{pathlib.Path(options.mesh).name} of {len(mesh[1])}"
        scenes[name] = ((*mesh, alone), lambda: aimed_within(*mesh, 1_000_000))
    session = Session(options)
    for scene, (geometry, inside) in scenes.items():
        session.measure(scene, geometry, rays_of(geometry, options.rays), inside())
    if options.output:
        pathlib.Path(options.output).write_text(json.dumps(session.records, indent=1) + "\n", encoding="utf-8")


if __name__ == "__main__":
    main()
