#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Reproducers as a user makes, compiles and runs them: of the driver's own leaks, where it has any, and of each fault of
a driver that is broken on purpose.
Usage: reproducer_command_test.py TWINRAY FOLDER_OF_THE_BROKEN_DRIVER C_COMPILER [FLAG...]"""

import json
import os
import pathlib
import random
import re
import subprocess
import sys
import tempfile

twinray, layer, compile_c = sys.argv[1], sys.argv[2], sys.argv[3:]
here = pathlib.Path(tempfile.mkdtemp())
RIGHT, WRONG = 0, 1


def on_driver(fault):
    """The environment of a driver with this fault; "": as it is."""
    environment = dict(os.environ, TWINRAY_BROKEN_DRIVER=fault)
    if fault:
        environment.update(VK_ADD_LAYER_PATH=layer, VK_INSTANCE_LAYERS="VK_LAYER_TWINRAY_broken_driver")
    return environment


def run(fault, *command, status=0):
    done = subprocess.run(list(map(str, command)), env=on_driver(fault), capture_output=True, text=True, cwd=here)
    assert done.returncode == status, f"{command}: status {done.returncode}\n{done.stdout}{done.stderr}"
    return done.stdout + done.stderr


def compiled(folder):
    program = folder / "reproducer"
    run("", *compile_c, folder / "reproducer.c", "-lvulkan", "-o", program)
    return program


def counts_in(records):
    """Of random rays of each class, of each accelerator."""
    of_all = map(json.loads, (here / records).open())
    return {record["backend"]: record["counts"] for record in of_all if record["case"] == "verify.random"}


def triangles_of(folder):
    return (folder / "report.md").read_text().count("\n| 0 |")


# A flat grid, whose vertices are where drivers with flat boxes lose rays.
n = 8
corners = [f"v {x} 0 {z}\n" for z in range(n + 1) for x in range(n + 1)]
firsts = [z * (n + 1) + x + 1 for z in range(n) for x in range(n)]
faces = [f"f {i} {i + n + 1} {i + 1}\nf {i + 1} {i + n + 1} {i + n + 2}\n" for i in firsts]
(here / "grid.obj").write_text("".join(corners + faces))
said = run("", twinray, "verify", "grid.obj", "--random", 100, "--aimed", 20000, "--reproducers", "own", "--quiet")
if "without HwTlas" in said:
    print("the device has no hardware path")
    sys.exit(77)
leak = here / "own" / "HW_LEAK"
if leak.exists():
    assert triangles_of(leak) <= 4, (leak / "report.md").read_text()
    assert "WRONG" in run("", compiled(leak), status=WRONG)
    replay = json.loads((leak / "replay.json").read_text())
    assert replay["class"] == "HW_LEAK" and replay["scene"] == "scene.glb", replay
    shown = run("", twinray, "verify", "--replay", leak / "replay.json", "--reproducer", "again", "--quiet")
    assert re.search(r"^  hw +HW_LEAK", shown, re.M), shown
    assert triangles_of(here / "again") <= triangles_of(leak)
    print(f"reproducer: a leak of this driver in {triangles_of(leak)} triangles, seen by the C program")
else:
    assert "no fault of the driver, so no reproducer" in said or "HW_" in said, said
    print("reproducer: this driver has no leak at the vertices of a grid")

# Triangles in all directions, many behind another: the unbroken driver has no fault there.
random.seed(1)
with open(here / "soup.obj", "w") as soup:
    for _ in range(400):
        center = [random.uniform(-1, 1) for _ in range(3)]
        for _ in range(3):
            print("v", *(f"{x + random.uniform(-0.3, 0.3):.9g}" for x in center), file=soup)
        print("f -3 -2 -1", file=soup)
arguments = (twinray, "verify", "soup.obj", "--random", 500, "--aimed", 0, "--quiet")
said = run("", *arguments, "--reproducers", "none", "--json", "none.jsonl")
assert "so no reproducer" in said, "the driver is wrong as it is"
for fault, kind, most in (
    ("cull", "HW_LEAK", 1),
    ("first", "HW_LEAK", 2),
    ("distance", "HW_T_ERR", 1),
    ("infinite", "HW_RANGE", 1),
    ("triangle", "HW_FALSE", 2),
):
    said = run(fault, *arguments, "--reproducers", fault, "--json", f"{fault}.jsonl")
    counts = counts_in(f"{fault}.jsonl")
    assert counts["hw"][kind] < 300, f"{fault}: {counts['hw']} of 500 rays"
    assert counts["sw"] == counts_in("none.jsonl")["sw"], f"{fault} reached SwTlas: {counts['sw']}"
    folder = here / fault / kind
    assert folder.exists(), said
    assert triangles_of(folder) <= most, (folder / "report.md").read_text()
    program = compiled(folder)
    for way in ("query", "pipeline"):
        for driver, status, word in ((fault, WRONG, "WRONG"), ("", RIGHT, "RIGHT")):
            done = subprocess.run([program, "0", way], env=on_driver(driver), capture_output=True, text=True)
            if way == "pipeline" and done.returncode == 2:
                continue  # the device has no ray tracing pipelines
            assert done.returncode == status and word in done.stdout, (fault, way, driver, done)
    print(f"reproducer: {fault}: {kind} in {triangles_of(folder)} triangles; WRONG when broken, RIGHT when not")

# Faults that cannot be reproduced are refused in one sentence.
replay = json.loads(next((here / "cull").glob("*/replay.json")).read_text())
said = run("", twinray, "verify", "--replay", "cull/HW_LEAK/replay.json", "--reproducer", "x", "--quiet", status=1)
assert "own answer is AGREE, which is no fault" in said, said
replay["backend"] = "sw"
(here / "cull/HW_LEAK/ours.json").write_text(json.dumps(replay))
said = run("", twinray, "verify", "--replay", "cull/HW_LEAK/ours.json", "--reproducer", "x", "--quiet", status=1)
assert "is not a fault of the driver" in said, said
run("", twinray, "verify", "soup.obj", "--reproducer", "x", status=2)
