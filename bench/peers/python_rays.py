#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
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
import subprocess
import sys
import tempfile
import time
import warnings

import numpy as np

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


class Twinray:
    def __init__(self, accel, has_cuda):
        import twinray

        self.scene = twinray.Scene(accel)
        backend = self.scene.backend
        self.about = f"{twinray.__version__}, {backend['path']} on {backend['device']}"
        self.moves = np.asarray
        if has_cuda:
            import cupy

            self.moves = cupy.asarray

    def build(self, vertices, triangles, offsets):
        first = self.scene.add_triangles(vertices, triangles, transform=moved(offsets[0]))
        for offset in offsets[1:]:
            self.scene.add_instance(first, moved(offset))

    def load(self, rays):
        import twinray

        self.rays = self.scene.device_array((len(rays), 8))
        whole = np.zeros((len(rays), 8), np.float32)
        whole[:, :3], whole[:, 4:7], whole[:, 7] = rays[:, :3], rays[:, 3:], np.inf
        self.moves(self.rays)[:] = self.moves(whole)
        self.hits = self.scene.device_array(len(rays), twinray.HIT)

    def trace(self, is_any):
        self.scene.trace(self.rays, self.hits, any_hit=is_any)

    def distances(self):
        return self.hits.numpy()["t_hit"]


class Baked:
    """Packages without instances get all triangles."""

    def build(self, vertices, triangles, offsets):
        n = np.arange(len(offsets))[:, None, None] * len(vertices)
        self.push((vertices[None] + offsets[:, None]).reshape(-1, 3), (triangles[None] + n).reshape(-1, 3))


class Embreex(Baked):
    def __init__(self):
        import embreex

        self.about = f"embreex {embreex.__version__}, robust, rays one by one"

    def push(self, vertices, triangles):
        from embreex.mesh_construction import TriangleMesh
        from embreex.rtcore_scene import EmbreeScene

        self.scene = EmbreeScene(robust=True)
        self.mesh = TriangleMesh(self.scene, vertices.astype(np.float32), triangles.astype(np.int32))

    def load(self, rays):
        self.origins, self.directions = np.ascontiguousarray(rays[:, :3]), np.ascontiguousarray(rays[:, 3:])

    def trace(self, is_any):
        self.found = self.scene.run(self.origins, self.directions, query="OCCLUDED" if is_any else "DISTANCE")

    def distances(self):
        return self.found


class Open3d(Baked):
    def __init__(self):
        import open3d

        self.o3d, self.about = open3d, open3d.__version__

    def push(self, vertices, triangles):
        self.scene = self.o3d.t.geometry.RaycastingScene()
        self.scene.add_triangles(self.o3d.core.Tensor(vertices), self.o3d.core.Tensor(triangles.astype(np.uint32)))

    def load(self, rays):
        self.rays = self.o3d.core.Tensor(rays)

    def trace(self, is_any):
        self.found = self.scene.test_occlusions(self.rays) if is_any else self.scene.cast_rays(self.rays)["t_hit"]

    def distances(self):
        return self.found.numpy()


class Warp(Baked):
    def __init__(self, has_cuda):
        import warp

        warp.config.quiet = True
        self.wp, self.device = warp, "cuda" if has_cuda else "cpu"
        self.about = f"{warp.__version__}, {warp.get_device(self.device).name}"
        import warp_rays  # a kernel wants a file

        self.kernels = {False: warp_rays.closest, True: warp_rays.any_hit}

    def push(self, vertices, triangles):
        self.mesh = self.wp.Mesh(
            self.wp.array(vertices, dtype=self.wp.vec3, device=self.device),
            self.wp.array(triangles.reshape(-1).astype(np.int32), dtype=int, device=self.device),
        )

    def load(self, rays):
        self.rays = [
            self.wp.array(np.ascontiguousarray(part), dtype=self.wp.vec3, device=self.device)
            for part in (rays[:, :3], rays[:, 3:])
        ]
        self.found = self.wp.zeros(len(rays), dtype=float, device=self.device)

    def trace(self, is_any):
        inputs = [self.mesh.id, *self.rays, self.found]
        self.wp.launch(self.kernels[is_any], len(self.found), inputs, device=self.device)
        self.wp.synchronize_device(self.device)

    def distances(self):
        return self.found.numpy()


class Mitsuba(Baked):
    def __init__(self, has_cuda):
        import mitsuba

        mitsuba.set_variant("cuda_ad_rgb" if has_cuda else "llvm_ad_rgb")
        import drjit

        self.mi, self.dr = mitsuba, drjit
        self.about = f"{mitsuba.__version__}, {'OptiX' if has_cuda else 'Embree, by LLVM'}"

    def push(self, vertices, triangles):
        mesh = self.mi.Mesh("mesh", len(vertices), len(triangles))
        values = self.mi.traverse(mesh)
        values["vertex_positions"] = vertices.reshape(-1)
        values["faces"] = triangles.reshape(-1)
        values.update()
        self.scene = self.mi.load_dict({"type": "scene", "mesh": mesh})

    def load(self, rays):
        origins, directions = (self.mi.Point3f(np.ascontiguousarray(part.T)) for part in (rays[:, :3], rays[:, 3:]))
        self.rays = self.mi.Ray3f(origins, self.mi.Vector3f(directions))
        self.dr.eval(self.rays)
        self.dr.sync_thread()

    def trace(self, is_any):
        self.found = self.scene.ray_test(self.rays) if is_any else self.scene.ray_intersect_preliminary(self.rays).t
        self.dr.eval(self.found)
        self.dr.sync_thread()

    def distances(self):
        return np.array(self.found)


class Program(Baked):
    """Made by programs.sh. It reads a mesh and rays, prints a line of seconds, and writes distances."""

    def __init__(self, folder, name):
        self.program = pathlib.Path(folder or "", name).resolve()
        if not folder or not self.program.is_file():
            raise FileNotFoundError("programs.sh has not made it")
        self.about = (self.program.parent / f"{name}.about").read_text().strip()
        self.files = tempfile.TemporaryDirectory()
        self.at = pathlib.Path(self.files.name)

    def push(self, vertices, triangles):
        vertices.astype(np.float32).tofile(self.at / "vertices")
        triangles.astype(np.int32).tofile(self.at / "triangles")

    def load(self, rays):
        rays.astype(np.float32).tofile(self.at / "rays")

    def trace(self, is_any):
        """The seconds that it says: not those of reading files and building."""
        done = subprocess.run(
            [self.program, "any" if is_any else "closest"], cwd=self.at, capture_output=True, text=True
        )
        if done.returncode:
            raise RuntimeError(done.stderr)
        return float(done.stdout.split()[-1])

    def distances(self):
        return np.fromfile(self.at / "distances", np.float32)


def moved(offset):
    return np.hstack([np.eye(3), np.reshape(offset, (3, 1))])


def backends_of(options):
    return {
        "twinray sw": lambda: Twinray("sw", options.cuda),
        "twinray hw": lambda: Twinray("hw", options.cuda),
        "embreex": Embreex,
        "open3d": Open3d,
        "warp": lambda: Warp(options.cuda),
        "mitsuba": lambda: Mitsuba(options.cuda),
        "cuBQL": lambda: Program(options.programs, "cubql_rays"),
        "deepeeRT": lambda: Program(options.programs, "deepee_rays"),
    }


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
            except Exception as error:  # of the package: the others are measured all the same
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
