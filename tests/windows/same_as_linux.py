#!/usr/bin/env python3
"""Compares what programs for Windows write with what those for Linux write, on the same driver.
Usage: same_as_linux.py LINUX_BIN WINDOWS_BIN [--quick]; folders with the programs. Wine runs those for Windows.

A row a case: how many results were compared, and how many are not the same bits (ends of lines do not count). Exits with 1
where any is not, or where a comparison compared nothing.
"""
import json
import math
import pathlib
import random
import subprocess
import sys
import tempfile

linux, windows = (pathlib.Path(folder).resolve() for folder in sys.argv[1:3])
is_quick = "--quick" in sys.argv
held = tempfile.TemporaryDirectory(prefix="twinray-same-")  # as long as this program
root = pathlib.Path(held.name)
sides = {"linux": root / "Linux side", "windows": root / "Windows side"}
found = []


def run(side, program, *arguments):
    command = [linux / program] if side == "linux" else ["wine", windows / (program + ".exe")]
    done = subprocess.run([*map(str, command), *map(str, arguments)], capture_output=True, text=True, errors="replace",
                          cwd=sides[side])
    assert done.returncode == 0, f"{side}: {program} {arguments}: {done.returncode}\n{done.stdout}{done.stderr}"
    return done.stdout


def compare(case, results):
    """results: by side, values by name."""
    ours, theirs = results["linux"], results["windows"]
    different = sorted(name for name in ours.keys() | theirs.keys() if ours.get(name) != theirs.get(name))
    found.append((case, len(ours), different))
    print(f"{case:<56} {len(ours):>6} compared, {len(different)} different", *different[:3], flush=True)


def lines_of(data):
    """Lines of a table. Ends of intervals count by 12 digits: they are functions of the system's C library, which
    differ in the last bits."""
    rows = [line.split(",") for line in data.decode().splitlines()]
    is_end = [name.startswith("ci_") for name in rows[0]]
    return [[f"{float(cell):.12g}" if end and cell and i else cell for cell, end in zip(row, is_end, strict=True)]
            for i, row in enumerate(rows)]


def both(case, program, arguments, files):
    """Runs a program on each side; the files that it wrote are compared by line, or as bytes."""
    results = {}
    for side, folder in sides.items():
        run(side, program, *arguments)
        results[side] = {}
        for name in files:
            data = (folder / name).read_bytes()
            lines = lines_of(data) if name.endswith(".csv") else [data]
            results[side].update({f"{name}:{i}": line for i, line in enumerate(lines)})
    compare(case, results)


def write_obj(name, points, faces):
    text = "".join(f"v {x:.9g} {y:.9g} {z:.9g}\n" for x, y, z in points)
    text += "".join("f " + " ".join(str(i + 1) for i in face) + "\n" for face in faces)
    for folder in sides.values():
        (folder / name).write_text(text)


def write_scenes():
    draw = random.Random(1)
    grid = [(i, j) for i in range(60) for j in range(60)]
    cells = [(60 * i + j, 60 * i + j + 1, 60 * i + j + 61, 60 * i + j + 60) for i in range(59) for j in range(59)]
    write_obj("hills.obj", [(x, y, 3 * math.sin(x / 5) * math.cos(y / 7)) for x, y in grid], cells)
    write_obj("far away.obj", [(x + 1e5, y - 1e5, draw.uniform(0, 2)) for x, y in grid], cells)
    write_obj("tiny.obj", [(1e-6 * x, 1e-6 * y, 1e-6 * draw.random()) for x, y in grid], cells)
    slivers = [(draw.uniform(-1, 1) + 1e-4 * k, draw.uniform(-1, 1), draw.uniform(-1, 1)) for _ in range(1000)
               for k in range(3)]
    write_obj("slivers.obj", slivers, [(3 * i, 3 * i + 1, 3 * i + 2) for i in range(1000)])
    corners = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
    sides_of_box = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    write_obj("käfig.obj", corners, sides_of_box)


def hits(scene):
    """Hashes of hits, over levels, layouts, queries and accelerators."""
    layouts = [] if is_quick else ["--layouts", "compressed4,bvh2,compressed8"]
    results = {}
    for side, folder in sides.items():
        out = folder / "bench.jsonl"
        out.unlink(missing_ok=True)
        run(side, "twinray", "bench", "--scene", scene, "--width", "64", "--rounds", "1", "--max-seconds", "600", "--no-embree", "--no-build",
            "--levels", "watertight" if is_quick else "fast,watertight,refined,certified", *layouts, "--quiet",
            "--json", "bench.jsonl")
        records = [json.loads(line) for line in out.read_text().splitlines()]
        results[side] = {" ".join(str(r.get(k)) for k in ("contestant", "backend", "layout", "builder", "level",
                                                           "rays", "ray_kind", "order")): r["hits_hash"]
                         for r in records if r.get("hits_hash")}
    compare(f"hashes of hits, {scene}", results)


def saved_accelerators():
    """Each side loads what the other has saved, and what it has saved itself; hits are hashed."""
    for side in sides:
        run(side, "saved_accel", "save", sides[side] / "scene.swtlas")
    results = {side: {} for side in sides}
    for side in sides:
        for owner in sides:
            other = sides["windows" if side == "linux" else "linux"] if owner != side else sides[side]
            results[side]["own" if owner == side else "other's"] = run(side, "saved_accel", "load",
                                                                       other / "scene.swtlas").strip()
    results["linux"]["file"], results["windows"]["file"] = ((sides[s] / "scene.swtlas").read_bytes() for s in sides)
    compare("saved accelerators, own and the other's", results)


for folder in sides.values():
    folder.mkdir()
write_scenes()
scenes = ["sphere:20000", "soup:20000", "instances:50x500"]
for scene in scenes if is_quick else [*scenes, "hills.obj", "far away.obj", "tiny.obj", "slivers.obj", "käfig.obj"]:
    hits(scene)
saved_accelerators()
for accel in ("sw", "hw"):
    both(f"view factors of a box, {accel}", "twinray",
         ["viewfactors", "käfig.obj", "--accel", accel, "--rays-per-row", "20000", "--sides", "both", "--quiet", "-o", "factors.csv"],
         ["factors.csv"])
    both(f"illumination by a sky, {accel}", "twinray",
         ["illumination", "hills.obj", "--accel", accel, "--sky", "100", "--up", "0", "0", "1", "--quiet", "-o", "sky.csv"],
         ["sky.csv"])
for scene in ("builtin:cornell-box", "builtin:sunflower"):
    both(f"picture, {scene}", "path_tracer",
         [scene, "-o", "picture ü.png", "--width", "160", "--height", "120", "--spp", "4", "--accel", "sw", "--quiet"],
         ["picture ü.png"])
wrong = [case for case, count, different in found if different or count == 0]
print(f"same_as_linux: {len(found)} cases, {len(found) - len(wrong)} the same bits")
sys.exit(bool(wrong))
