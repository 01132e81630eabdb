#!/usr/bin/env python3
"""Replays that `twinray verify` writes and shows, and reproducers as a user makes, compiles and runs them: of the
driver's own leaks, where it has any, and of each fault of a driver that is broken on purpose.
Usage: reproducer_command_test.py TWINRAY FOLDER_OF_THE_BROKEN_DRIVER C_COMPILER [FLAG...]"""
import json
import os
import pathlib
import random
import re
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "support"))
import command
from command import here, records

layer, compile_c = sys.argv[2], sys.argv[3:]
RIGHT, WRONG = 0, 1


def on_driver(fault):
    """The variables of a driver with this fault; "": as it is."""
    layers = {"VK_ADD_LAYER_PATH": layer, "VK_INSTANCE_LAYERS": "VK_LAYER_TWINRAY_broken_driver"} if fault else {}
    return {"TWINRAY_BROKEN_DRIVER": fault, **layers}


def verify(*arguments, fault="", status=0):
    return command.run("verify", *arguments, "--quiet", status=status, env=on_driver(fault))


def compiled(folder):
    program = folder / "reproducer"
    command.run(*compile_c[1:], folder / "reproducer.c", "-lvulkan", "-o", program, of=compile_c[0])
    return program


def counts_in(name):
    """Of random rays of each class, of each accelerator."""
    return {record["backend"]: record["counts"] for record in records(name) if record["case"] == "verify.random"}


def triangles_of(folder):
    return (folder / "report.md").read_text().count("\n| 0 |")


# A flat grid of unit cells, whose vertices are where drivers with flat boxes lose rays.
n = 8
firsts = [z * (n + 1) + x for z in range(n) for x in range(n)]
faces = [face for i in firsts for face in ((i, i + n + 1, i + 1), (i + 1, i + n + 1, i + n + 2))]
command.write_ply("grid.ply", [(x, 0, z) for z in range(n + 1) for x in range(n + 1)], faces)
verify("grid.ply", "--random", 100, "--aimed", 20000, "--replays", "out", "--json", "all.jsonl")
assert not (here / "twinray_replays").exists(), "no fault of twinray, but a folder of that name"
leaks = sum(min(100, r["counts"]["HW_LEAK"]) for r in records("all.jsonl") if r["backend"] == "hw")
files = sorted((here / "out").glob("*HW_LEAK*.json")) if leaks else []
assert len(files) == leaks, (len(files), leaks)
if files:
    replay = json.loads(files[0].read_text())
    assert replay["class"] == "HW_LEAK" and pathlib.Path(replay["scene"]) == here / "grid.ply"
    shown = verify("--replay", files[0])
    for words in ["HW_LEAK of hw", "Correct answer", "exactly", "Triangle tests", "edge across from vertex 2", "Boxes",
                  "padded enters", "slipped between", "no fault of twinray"]:
        assert words in shown, f"no '{words}' in\n{shown}"
    assert ": padded PASSES" not in shown, shown  # the padding is what the driver lacks

    # This replay is written by hand: a ray through a vertex of four cells, which no driver loses.
    replay["ray"] = {"origin": ["0x1p+1", "0x1.8p+1", "0x1p+1"], "direction": ["0x0p+0", "-0x1p+0", "0x0p+0"],
                     "t_min": "0x0p+0", "t_max": "inf"}
    (here / "vertex.json").write_text(json.dumps(replay))
    shown = verify("--replay", "vertex.json")
    assert "at its vertex; 6 triangles meet the ray at this t" in shown and "a tie" in shown, shown

    replay["scene_hash"] = "0" * 16
    (here / "other.json").write_text(json.dumps(replay))
    assert "is not the scene that was traced" in verify("--replay", "other.json", status=1)
assert "--replay" in verify(status=2)
verify("grid.ply", "--replay", "all.jsonl", status=2)
print(f"replay: {len(files)} leaks of the driver, the first one shown")

said = verify("grid.ply", "--random", 100, "--aimed", 20000, "--reproducers", "own")
if "without HwTlas" in said:
    print("the device has no hardware path")
    sys.exit(77)
leak = here / "own" / "HW_LEAK"
if leak.exists():
    assert triangles_of(leak) <= 4, (leak / "report.md").read_text()
    assert "WRONG" in command.run(of=compiled(leak), status=WRONG)
    replay = json.loads((leak / "replay.json").read_text())
    assert replay["class"] == "HW_LEAK" and replay["scene"] == "scene.glb", replay
    shown = verify("--replay", leak / "replay.json", "--reproducer", "again")
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
arguments = ("soup.obj", "--random", 500, "--aimed", 0)
said = verify(*arguments, "--reproducers", "none", "--json", "none.jsonl")
assert "so no reproducer" in said, "the driver is wrong as it is"
for fault, kind, most in (
    ("cull", "HW_LEAK", 1),
    ("first", "HW_LEAK", 2),
    ("distance", "HW_T_ERR", 1),
    ("infinite", "HW_RANGE", 1),
    ("triangle", "HW_FALSE", 2),
):
    said = verify(*arguments, "--reproducers", fault, "--json", f"{fault}.jsonl", fault=fault)
    counts = counts_in(f"{fault}.jsonl")
    assert counts["hw"][kind] < 300, f"{fault}: {counts['hw']} of 500 rays"
    assert counts["sw"] == counts_in("none.jsonl")["sw"], f"{fault} reached SwTlas: {counts['sw']}"
    folder = here / fault / kind
    assert folder.exists(), said
    assert triangles_of(folder) <= most, (folder / "report.md").read_text()
    program = compiled(folder)
    for way in ("query", "pipeline"):
        for driver, status, word in ((fault, WRONG, "WRONG"), ("", RIGHT, "RIGHT")):
            done = subprocess.run([program, "0", way], env=os.environ | on_driver(driver), capture_output=True,
                                  text=True)
            if way == "pipeline" and done.returncode == 2:
                continue  # the device has no ray tracing pipelines
            assert done.returncode == status and word in done.stdout, (fault, way, driver, done)
    print(f"reproducer: {fault}: {kind} in {triangles_of(folder)} triangles; WRONG when broken, RIGHT when not")

# Faults that cannot be reproduced are refused in one sentence.
replay = json.loads(next((here / "cull").glob("*/replay.json")).read_text())
said = verify("--replay", "cull/HW_LEAK/replay.json", "--reproducer", "x", status=1)
assert "own answer is AGREE, which is no fault" in said, said
replay["backend"] = "sw"
(here / "cull/HW_LEAK/ours.json").write_text(json.dumps(replay))
said = verify("--replay", "cull/HW_LEAK/ours.json", "--reproducer", "x", status=1)
assert "is not a fault of the driver" in said, said
verify("soup.obj", "--reproducer", "x", status=2)
