#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Rays a second of packages of Python, and how many of a million answers are wrong, in one run:

    python_rays.py [--rays 1000000] [--subdivisions 8] [--instances 1000] [--mesh FILE] [--rounds 3] [-o FILE.json]

Speed: a camera's rays at a sphere of 20 * 4**subdivisions triangles, at as many spheres as there are instances, and at
a mesh, say the Stanford bunny. Wrong answers: rays from inside a sphere, aimed at its vertices and at points of its
edges, must hit at t = 1; those from inside the mesh, whose holes are closed first, somewhere. Packages that are not
installed are left out: twinray, embreex, open3d, warp-lang."""

import argparse
import json
import statistics
import time
import warnings

import numpy as np

warnings.simplefilter("ignore")


def sphere(subdivisions):
    import trimesh

    mesh = trimesh.creation.icosphere(subdivisions)
    return mesh.vertices.astype(np.float32), mesh.faces.astype(np.uint32)


def camera(count):
    side = int(count**0.5)
    x, y = np.meshgrid(np.linspace(-0.4, 0.4, side), np.linspace(-0.4, 0.4, side))
    directions = np.stack([x, y, np.full_like(x, -1)], axis=-1).reshape(-1, 3)
    return np.hstack([np.tile([0, 0, 3.0], (len(directions), 1)), directions]).astype(np.float32)


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
    def __init__(self, accel):
        import twinray

        self.scene = twinray.Scene(accel)
        backend = self.scene.backend
        self.about = f"{twinray.__version__}, {backend['path']} on {backend['device']}"

    def build(self, vertices, triangles, offsets):
        first = self.scene.add_triangles(vertices, triangles, transform=moved(offsets[0]))
        for offset in offsets[1:]:
            self.scene.add_instance(first, moved(offset))

    def cast(self, rays):
        return self.scene.cast_rays(rays, normals=False)["t_hit"]


class Baked:
    """Packages without instances get all triangles."""

    def build(self, vertices, triangles, offsets):
        n = np.arange(len(offsets))[:, None, None] * len(vertices)
        self.push((vertices[None] + offsets[:, None]).reshape(-1, 3), (triangles[None] + n).reshape(-1, 3))


class Embreex(Baked):
    def __init__(self):
        import embreex

        self.about = f"embreex {embreex.__version__}, robust, closest hits one by one"

    def push(self, vertices, triangles):
        from embreex.mesh_construction import TriangleMesh
        from embreex.rtcore_scene import EmbreeScene

        self.scene = EmbreeScene(robust=True)
        self.mesh = TriangleMesh(self.scene, vertices.astype(np.float32), triangles.astype(np.int32))

    def cast(self, rays):
        origins, directions = np.ascontiguousarray(rays[:, :3]), np.ascontiguousarray(rays[:, 3:])
        return self.scene.run(origins, directions, query="DISTANCE")


class Open3d(Baked):
    def __init__(self):
        import open3d

        self.o3d, self.about = open3d, open3d.__version__

    def push(self, vertices, triangles):
        self.scene = self.o3d.t.geometry.RaycastingScene()
        self.scene.add_triangles(self.o3d.core.Tensor(vertices), self.o3d.core.Tensor(triangles.astype(np.uint32)))

    def cast(self, rays):
        return self.scene.cast_rays(self.o3d.core.Tensor(rays))["t_hit"].numpy()


class Warp(Baked):
    def __init__(self):
        import warp

        warp.config.quiet = True
        self.wp, self.about = warp, f"{warp.__version__}, CPU"
        from warp_rays import closest  # a kernel wants a file

        self.kernel = closest

    def push(self, vertices, triangles):
        self.mesh = self.wp.Mesh(
            self.wp.array(vertices, dtype=self.wp.vec3, device="cpu"),
            self.wp.array(triangles.reshape(-1).astype(np.int32), dtype=int, device="cpu"),
        )

    def cast(self, rays):
        origins, directions = (
            self.wp.array(np.ascontiguousarray(part), dtype=self.wp.vec3, device="cpu")
            for part in (rays[:, :3], rays[:, 3:])
        )
        found = self.wp.zeros(len(rays), dtype=float, device="cpu")
        self.wp.launch(self.kernel, len(rays), [self.mesh.id, origins, directions, found], device="cpu")
        return found.numpy()


def moved(offset):
    return np.hstack([np.eye(3), np.reshape(offset, (3, 1))])


BACKENDS = {
    "twinray sw": lambda: Twinray("sw"),
    "twinray hw": lambda: Twinray("hw"),
    "embreex": Embreex,
    "open3d": Open3d,
    "warp": Warp,
}


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--rays", type=int, default=1_000_000)
    parser.add_argument("--subdivisions", type=int, default=8)
    parser.add_argument("--instances", type=int, default=1000)
    parser.add_argument("--mesh")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("-o", "--output")
    options = parser.parse_args()
    fine, coarse = sphere(options.subdivisions), sphere(4)
    spread = np.random.default_rng(2).uniform(-1, 1, (options.instances, 3)).astype(np.float32) * [20, 20, 1] - [
        0,
        0,
        30,
    ]
    scenes = {
        f"sphere of {len(fine[1])}": (*fine, np.zeros((1, 3), np.float32), camera(options.rays)),
        f"{options.instances} spheres of {len(coarse[1])}": (*coarse, spread.astype(np.float32), camera(options.rays)),
    }
    inside = {next(iter(scenes)): aimed(*fine, options.rays)}
    if options.mesh:
        mesh = loaded(options.mesh)
        name = f"{options.mesh.rsplit('/')[-1]} of {len(mesh[1])}"
        scenes[name] = (*mesh, np.zeros((1, 3), np.float32), camera(options.rays))
        inside[name] = aimed_within(*mesh, options.rays)
    records = []
    for scene, (vertices, triangles, offsets, rays) in scenes.items():
        built = {}
        for name, make in BACKENDS.items():
            try:
                backend = make()
            except Exception as error:  # not installed, or no such hardware
                print(f"{name}: left out: {error}")
                continue
            start = time.perf_counter()
            backend.build(vertices, triangles, offsets)
            backend.cast(rays[:1])
            built[name] = (backend, time.perf_counter() - start, [])
        for _ in range(options.rounds + 1):  # the first is a warm-up
            for backend, _, seconds in built.values():
                start = time.perf_counter()
                backend.cast(rays)
                seconds.append(time.perf_counter() - start)
        for name, (backend, build, seconds) in built.items():
            record = {"scene": scene, "package": name, "about": backend.about, "build_seconds": round(build, 3),
                      "mrays_per_s": round(len(rays) / statistics.median(seconds[1:]) / 1e6, 3)}  # fmt: skip
            if scene in inside:
                t = np.asarray(backend.cast(inside[scene]))
                record["wrong_per_million"] = wrong_per_million(t, "sphere" in scene)
            records.append(record)
            print(record)
    if options.output:
        with open(options.output, "w", encoding="utf-8") as file:
            json.dump(records, file, indent=1)


main()
