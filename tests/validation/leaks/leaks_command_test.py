#!/usr/bin/env python3
"""Runs `twinray leaks` as a user does. Usage: leaks_command_test.py TWINRAY"""
import json
import math
import pathlib
import subprocess
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "support"))
from command import here, program, records, run, write_ply


def leaks(scene, *arguments, status=0):
    return run("leaks", here / scene, "--quiet", *arguments, status=status)


def write_torus(file, rings, sides, missing=0):
    """A torus with dents, so that rays cross it one to many times, and grazing is common."""
    points, triangles = [], []
    for i in range(rings):
        for k in range(sides):
            a, b = 2 * math.pi * i / rings, 2 * math.pi * k / sides
            tube = 0.4 + 0.1 * math.sin(7 * a) * math.cos(5 * b)
            reach = 1 + tube * math.cos(b)
            points.append((reach * math.cos(a), tube * math.sin(b), reach * math.sin(a)))
            j, m = (i + 1) % rings, (k + 1) % sides
            vertices = [i * sides + k, j * sides + k, j * sides + m, i * sides + m]
            triangles += [vertices[:3], [vertices[0], *vertices[2:]]]
    write_ply(file, points, triangles[missing:])


def totals(file):
    state = json.loads((here / file).read_text())
    return [state[name] for name in ("rays", "leaks", "double_hits", "unspecified")]


write_torus("torus.ply", 96, 48)
write_torus("open.ply", 96, 48, missing=1)

# twinray keeps its promise.
said = leaks("torus.ply", "--ray-count", 1_000_000, "--json", here / "all.jsonl")
assert "1000000 rays: 0 leaks, 0 double hits by twinray" in said, said
record = records("all.jsonl")[0]
assert record["n"] == 1_000_000 and record["faults"] == 0 and record["pass"] and record["backend"] == "sw"
assert 2.9e-6 < record["bound95"] < 3.1e-6
leaks("torus.ply", "--ray-count", 20_000, "--level", "refined", "--validation")

# A broken accelerator is detected, its rays are named, and they are counted alike however often the run is interrupted.
said = leaks("torus.ply", "--ray-count", 200_000, "--level", "fast", "--state", here / "once.json", status=1)
assert "leak, crossed " in said and "double hit, crossed " in said and ", origin 0x" in said, said
leaks("torus.ply", "--ray-count", 60_000, "--level", "fast", "--state", here / "parts.json", status=1)
assert totals("parts.json")[0] == 60_000
said = leaks("torus.ply", "--ray-count", 200_000, "--level", "fast", "--state", here / "parts.json", status=1)
assert "continues after 60000 rays" in said, said
assert totals("parts.json") == totals("once.json"), (totals("parts.json"), totals("once.json"))
assert totals("once.json")[1] > 1000 and totals("once.json")[2] > 1000

# A killed run leaves a whole file.
with subprocess.Popen([program, "leaks", str(here / "torus.ply"), "--quiet", "--ray-count", "1000000000000", "--state",
                       str(here / "killed.json")], stdout=subprocess.DEVNULL) as endless:
    deadline = time.monotonic() + 120
    while not (here / "killed.json").exists() and time.monotonic() < deadline:
        time.sleep(0.05)
    endless.kill()
done = totals("killed.json")[0]
said = leaks("torus.ply", "--ray-count", done + 1000, "--state", here / "killed.json")
assert f"continues after {done} rays" in said and totals("killed.json") == [done + 1000, 0, 0, 0], said

# Mistakes.
said = leaks("torus.ply", "--seed", 2, "--state", here / "killed.json", status=1)
assert "belongs to another run: its seed is 1, not 2" in said, said
(here / "broken.json").write_text('{"schema": ')
assert "does not hold the state of" in leaks("torus.ply", "--state", here / "broken.json", status=1)
said = leaks("open.ply", status=1)
assert "mesh 'open.ply' is not closed: 1 triangle(s) share the edge from (" in said, said
assert "there is no folder" in leaks("torus.ply", "--state", here / "none" / "state.json", status=1)
assert "--ray-count is '0'" in leaks("torus.ply", "--ray-count", 0, status=2)
leaks("torus.ply", "--accel", "gpu", status=2)
print("leaks: the command works")
