#!/usr/bin/env python3
"""Measures twinray beside packages that do the same, on the same input, in turns: time and error of each.

    compare.py TWINRAY [-o FILE.json] [--rounds N] [--only collisions|distances|rays|viewfactors]

Needs numpy, trimesh, python-fcl, rtree, embreex, pyvista and pyviewfactor; peers.sh installs them into a folder and runs this.
Times are of the work alone: loading files, starting Python and making the Vulkan device are not counted. Building what is
searched is counted of collisions and distances; of rays and view factors, where each has an acceleration structure, it is not."""
import argparse
import json
import pathlib
import subprocess
import tempfile
import time

import numpy as np
import trimesh

import references


class Bench:
    def __init__(self, options):
        self.twinray, self.rounds = pathlib.Path(options.twinray).resolve(), options.rounds
        self.folder, self.rows, self.device = pathlib.Path(tempfile.mkdtemp()), [], None

    def run(self, *arguments):
        """The JSON line of a command."""
        record = self.folder / "record.jsonl"
        record.unlink(missing_ok=True)
        done = subprocess.run([self.twinray, *map(str, arguments), "--quiet", "--json", record], capture_output=True, text=True)
        if done.returncode:
            raise SystemExit(f"twinray {arguments[0]}: {done.stderr}")
        told = json.loads(record.read_text())
        self.device = told["device"]
        return told

    def versions(self):
        """Of the packages, and the device."""
        from importlib.metadata import version
        names = ("numpy", "trimesh", "python-fcl", "rtree", "embreex", "pyvista", "pyviewfactor")
        return {name: version(name) for name in names}

    def measure(self, case, backends):
        """Runs each in turns: functions that return (seconds, {name: error}). Prints and keeps the medians."""
        times, errors = {name: [] for name in backends}, {}
        for _ in range(self.rounds):
            for name, backend in backends.items():
                seconds, errors[name] = backend()
                times[name].append(seconds)
        first = np.median(times[next(iter(backends))])
        for name in backends:
            seconds = float(np.median(times[name]))
            self.rows.append({"case": case, "who": name, "seconds": seconds, "least": min(times[name]), "most": max(times[name]), "times_ours": seconds / first, **errors[name]})
            said = ", ".join(f"{what} {value:.3g}" for what, value in errors[name].items())
            print(f"{case:44} {name:26} {seconds:10.4f} s {seconds / first:9.1f}x   {said}", flush=True)


def timed(work):
    start = time.perf_counter()
    result = work()
    return time.perf_counter() - start, result


def save(mesh, path):
    trimesh.Trimesh(mesh.vertices.astype(np.float32), mesh.faces, process=False).export(path)
    return path


def subdivided_box(n, extents=(1, 1, 1)):
    """A box of 12 n^2 triangles about the origin."""
    mesh = trimesh.creation.box(extents=extents)
    corners, faces = [], []
    for triangle in mesh.triangles:
        a, u, v = triangle[0], (triangle[1] - triangle[0]) / n, (triangle[2] - triangle[0]) / n
        for i in range(n):
            for j in range(n - i):
                corner = a + i * u + j * v
                corners.append([corner, corner + u, corner + v])
                if i + j < n - 1:
                    corners.append([corner + u, corner + u + v, corner + v])
    vertices = np.array(corners).reshape(-1, 3)
    faces = np.arange(len(vertices)).reshape(-1, 3)
    return trimesh.Trimesh(np.round(vertices * 4096) / 4096, faces, process=False)


def collisions(bench):
    import fcl
    ball = trimesh.creation.icosphere(subdivisions=6)
    block = subdivided_box(32)
    corners = np.random.default_rng(3).integers(-2, 3, (3 * 2000, 3)).astype(np.float64)
    lattice = trimesh.Trimesh(corners, np.arange(len(corners)).reshape(-1, 3), process=False)
    cases = {"two spheres of 81,920 that cross": (ball, [0.5, 0.25, 0.125]),
             "two boxes of 12,288 that share a wall": (block, [1.0, 0.25, 0.125]),
             "two sets of 2000 on a lattice": (lattice, [1.0, 0.0, 0.0])}
    for case, (mesh, shift) in cases.items():
        vertices = mesh.vertices.astype(np.float32)
        both = [trimesh.Trimesh(vertices, mesh.faces, process=False),
                trimesh.Trimesh(vertices + np.float32(shift), mesh.faces, process=False)]
        scene = bench.folder / "pair.glb"
        trimesh.Scene({"a": both[0], "b": both[1]}).export(scene)
        found_by = {}

        def told(name, found):
            """Pairs on which the two disagree are put to a reference in rational numbers."""
            found_by[name] = found
            if len(found_by) < 2:
                return {"pairs": len(found)}
            disputed = sorted(found_by["ours"] ^ found_by["fcl"])[:2000]
            wrong = {each: 0 for each in found_by}
            for i, j in disputed:
                meet = references.meet(*(part.triangles[k] for part, k in zip(both, (i, j))))
                for each, pairs in found_by.items():
                    wrong[each] += ((i, j) in pairs) != meet
            return {"pairs": len(found), "disputed": len(found_by["ours"] ^ found_by["fcl"]), "judged": len(disputed),
                    "wrong of these": wrong[name]}

        def ours():
            record = bench.run("collide", scene, "-o", bench.folder / "pairs.csv")
            table = np.genfromtxt(bench.folder / "pairs.csv", delimiter=",", skip_header=1, dtype=None, encoding=None)
            return (record["search_seconds"] + record["classify_seconds"],
                    told("ours", {(int(row[2]), int(row[3])) for row in table}))

        def of_fcl():
            def work():
                objects = []
                for each in both:
                    model = fcl.BVHModel()
                    model.beginModel(len(each.vertices), len(each.faces))
                    model.addSubModel(each.vertices, each.faces)
                    model.endModel()
                    objects.append(fcl.CollisionObject(model, fcl.Transform()))
                result = fcl.CollisionResult()
                fcl.collide(*objects, fcl.CollisionRequest(num_max_contacts=10_000_000, enable_contact=True), result)
                return {(contact.b1, contact.b2) for contact in result.contacts}
            seconds, found = timed(work)
            return seconds, told("fcl", found)

        bench.measure(case, {"twinray collide": ours, "python-fcl": of_fcl})


def distances(bench):
    ball = trimesh.creation.icosphere(subdivisions=5)
    scene = save(ball, bench.folder / "ball.ply")
    mesh = trimesh.Trimesh(ball.vertices.astype(np.float32), ball.faces, process=False)
    points = np.random.default_rng(1).uniform(-1.5, 1.5, (20_000, 3))
    np.savetxt(bench.folder / "points.csv", points, fmt="%.17g", delimiter=",")
    some = np.arange(0, len(points), 100)
    truth = references.distances(points[some], mesh.triangles.astype(np.float64))

    inside = references.are_inside(points[some], mesh.triangles.astype(np.float64))

    def error(found, inside_is=1):
        """`inside_is`: the sign that distances have inside; 0: they have none."""
        signs = np.where(inside, inside_is, -inside_is) if inside_is else 1
        return {"largest error": float(np.max(np.abs(found[some] - signs * truth)))}

    def ours(*more):
        record = bench.run("distance", scene, "--points", bench.folder / "points.csv", "-o", bench.folder / "out.npz", *more)
        return (record["build_seconds"] + record["seconds"],
                error(np.load(bench.folder / "out.npz")["distance"], -1 if more else 0))

    def of_trimesh():
        seconds, (_, found, _) = timed(lambda: trimesh.proximity.closest_point(mesh, points))
        mesh._cache.clear()
        return seconds, error(found, 0)

    def of_trimesh_signed():
        seconds, found = timed(lambda: trimesh.proximity.signed_distance(mesh, points))
        mesh._cache.clear()
        return seconds, error(found, 1)  # trimesh counts up inside

    bench.measure("20,000 points, sphere of 20,480", {"twinray distance": ours, "trimesh": of_trimesh})
    bench.measure("the same, signed", {"twinray distance": lambda: ours("--signed"), "trimesh": of_trimesh_signed})


def rays(bench):
    from embreex import rtcore_scene
    from embreex.mesh_construction import TriangleMesh
    ball = trimesh.creation.icosphere(subdivisions=6)
    scene = save(ball, bench.folder / "ball.ply")
    triangles = ball.vertices.astype(np.float32)[ball.faces]
    generator = np.random.default_rng(2)
    count = 1_000_000
    origins = generator.uniform(-0.3, 0.3, (count, 3)).astype(np.float32)
    aims = {"at random": generator.normal(size=(count, 3)),
            "at vertices": triangles.reshape(-1, 3)[generator.integers(0, 3 * len(triangles), count)] - origins}
    for aim, directions in aims.items():
        directions = (directions / np.linalg.norm(directions, axis=1, keepdims=True)).astype(np.float32)
        raw = np.zeros((count, 8), np.float32)
        raw[:, :3], raw[:, 4:7], raw[:, 7] = origins, directions, np.inf
        raw.tofile(bench.folder / "rays")

        def errors(triangle, t):
            hit = triangle >= 0
            truth = references.ray_distances(origins[hit], directions[hit], triangles[triangle[hit]])
            units = np.spacing(truth.astype(np.float32)).astype(np.float64)
            off = np.abs(t[hit] - truth) / units
            return {"lost": int(np.sum(~hit)), "t: median ulp": float(np.median(off)), "99.9 %": float(np.quantile(off, 0.999))}

        def ours(accel):
            record = bench.run("trace", scene, "--rays", bench.folder / "rays", "--hits", bench.folder / "hits", "--accel", accel)
            hits = np.fromfile(bench.folder / "hits", np.dtype("u4, f4, u4, u4, f4, f4, u4, u4"))
            return record["seconds"], errors(np.where(hits["f0"] == 1, hits["f2"].astype(int), -1), hits["f1"].astype(np.float64))

        def of_embreex():
            embree = rtcore_scene.EmbreeScene()
            TriangleMesh(embree, triangles)
            embree.run(origins[:1], directions[:1])  # builds the tree
            seconds, found = timed(lambda: embree.run(origins, directions, output=1))
            return seconds, errors(found["primID"].astype(int), found["tfar"].astype(np.float64))

        bench.measure(f"10^6 rays {aim}, sphere of 81,920", {"twinray trace --accel sw": lambda: ours("sw"),
                                                             "twinray trace --accel hw": lambda: ours("hw"),
                                                             "embreex": of_embreex})


def viewfactors(bench):
    import pyvista
    import pyviewfactor
    for n in (2, 4):
        box = subdivided_box(n)
        box.faces = box.faces[:, ::-1]  # seen from inside
        scene = save(box, bench.folder / "room.ply")
        areas = trimesh.triangles.area(box.vertices.astype(np.float32)[box.faces].astype(np.float64))
        normals = np.cross(box.triangles[:, 1] - box.triangles[:, 0], box.triangles[:, 2] - box.triangles[:, 0])
        walls = 2 * np.argmax(np.abs(normals), axis=1) + (normals.sum(1) > 0)

        def errors(matrix):
            between = np.zeros((6, 6))
            np.add.at(between, (walls[:, None], walls[None, :]), matrix * areas[:, None])
            return {"largest error between walls": references.room_error(between, box.triangles_center, walls),
                    "closure": float(np.max(np.abs(matrix.sum(1) - 1)))}

        def ours(*more):
            record = bench.run("viewfactors", scene, "-o", bench.folder / "room.npz", *more)
            with np.load(bench.folder / "room.npz") as file:
                matrix = np.zeros(file["shape"])
                rows = np.repeat(np.arange(len(matrix)), np.diff(file["indptr"]))
                matrix[rows, file["indices"]] = file["data"]
            return record["seconds"], errors(matrix)

        def of_pyviewfactor():
            polygons = pyvista.PolyData(box.vertices, np.column_stack([np.full(len(box.faces), 3), box.faces]))
            seconds, matrix = timed(lambda: pyviewfactor.compute_viewfactor_matrix(polygons))
            return seconds, errors(np.asarray(matrix))

        bench.measure(f"room of {len(box.faces)} triangles", {
            "twinray viewfactors": ours,
            **{f"the same, hits of 2^{k} rays": lambda k=k: ours("--estimator", "hits", "--rays-per-row", 1 << k)
               for k in (10, 12, 14, 16, 18)},
            "pyviewfactor": of_pyviewfactor})


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("twinray")
    parser.add_argument("-o", "--output")
    parser.add_argument("--rounds", type=int, default=3)
    domains = {each.__name__: each for each in (collisions, distances, rays, viewfactors)}
    parser.add_argument("--only", choices=domains)
    options = parser.parse_args()
    if options.rounds < 2:
        parser.error(f"--rounds {options.rounds}: at least 2, for pairs are checked once both have found theirs")
    bench = Bench(options)
    for name, domain in domains.items():
        if options.only in (None, name):
            domain(bench)
    if options.output:
        pathlib.Path(options.output).write_text(json.dumps({"schema": "twinray-peers/1", "device": bench.device, "versions": bench.versions(),
                                                         "rounds": bench.rounds, "rows": bench.rows}, indent=1) + "\n")


if __name__ == "__main__":
    main()
