#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Writes replays by `twinray verify` and shows them. Usage: replay_command_test.py TWINRAY"""
import json
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "support"))
import command
from command import here


def run(*arguments, status=0):
    return command.run(*arguments, "--quiet", status=status)


# In a flat grid of unit cells, the boxes of drivers are flat as well.
n = 8
firsts = [z * (n + 1) + x for z in range(n) for x in range(n)]
faces = [face for i in firsts for face in ((i, i + n + 1, i + 1), (i + 1, i + n + 1, i + n + 2))]
command.write_ply("grid.ply", [(x, 0, z) for z in range(n + 1) for x in range(n + 1)], faces)
run("verify", "grid.ply", "--random", "100", "--aimed", "20000", "--replays", "out", "--json", "all.jsonl")
assert not (here / "twinray_replays").exists(), "no fault of twinray, but a folder of that name"
records = command.records("all.jsonl")
leaks = sum(min(100, r["counts"]["HW_LEAK"]) for r in records if r["backend"] == "hw")
files = sorted((here / "out").glob("*HW_LEAK*.json")) if leaks else []
assert len(files) == leaks, (len(files), leaks)

# This replay is written by hand: a ray through a vertex of four cells, which no driver loses.
ray = {"origin": ["0x1p+1", "0x1.8p+1", "0x1p+1"], "direction": ["0x0p+0", "-0x1p+0", "0x0p+0"], "t_min": "0x0p+0", "t_max": "inf"}
if files:
    replay = json.loads(files[0].read_text())
    assert replay["class"] == "HW_LEAK" and pathlib.Path(replay["scene"]) == here / "grid.ply"
    shown = run("verify", "--replay", str(files[0]))
    for words in ["HW_LEAK of hw", "Correct answer", "exactly", "Triangle tests", "edge across from vertex 2", "Boxes",
                  "padded enters", "slipped between", "no fault of twinray"]:
        assert words in shown, f"no '{words}' in\n{shown}"
    assert ": padded PASSES" not in shown, shown  # the padding is what the driver lacks

    replay["ray"] = ray
    (here / "vertex.json").write_text(json.dumps(replay))
    shown = run("verify", "--replay", "vertex.json")
    assert "at its vertex; 6 triangles meet the ray at this t" in shown and "a tie" in shown, shown

    replay["scene_hash"] = "0" * 16
    (here / "other.json").write_text(json.dumps(replay))
    assert "is not the scene that was traced" in run("verify", "--replay", "other.json", status=1)
assert "--replay" in run("verify", status=2)
run("verify", "grid.ply", "--replay", "all.jsonl", status=2)
print(f"replay: {len(files)} leaks of the driver, the first one shown")
