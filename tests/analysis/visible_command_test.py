#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Runs `twinray visible`. Usage: visible_command_test.py TWINRAY"""
import csv
import json
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from command import here, run


def rows():
    table = list(csv.reader((here / "out.csv").read_text().splitlines()))
    assert table[0] == ["sensor", "free_patches", "share"], table[0]
    return [(int(sensor), int(patches), float(share)) for sensor, patches, share in table[1:]]


# A wall of x = 0, as wide and high as one sees.
(here / "wall.obj").write_text("v 0 -1e4 -1e4\nv 0 1e4 -1e4\nv 0 1e4 1e4\nv 0 -1e4 1e4\nf 1 2 3 4\n")
sensors = "# x y z dx dy dz\n1 0 1  0 0 1\n-1 0 1  0 0 1\n1 0 1  1 0 0\n1 0 1  -1 0 0\n0 0 1  1 0 0\n"
(here / "grid.pts").write_text(sensors)
for accel in ("sw", "hw"):
    run("visible", "wall.obj", "--sensors", "grid.pts", "--up", "0", "0", "1", "--t-near", "0.01", "-o", "out.csv",
        "--accel", accel, "--json", "log.json")
    upward, behind, away, facing, on_it = rows()
    # 65 of 145 patches are behind the wall, and 15 over it: two of each row, and the zenith.
    assert upward[1] == behind[1] == 80, rows()
    assert 0.5 < upward[2] < 0.6 and away[2] == 1 and on_it == (4, *away[1:]) and facing[1:] == (0, 0), rows()
    assert 65 <= away[1] <= 72, rows()
record = json.loads((here / "log.json").read_text().splitlines()[-1])
assert record["sensors"] == 5 and record["sky"] == "tregenza145" and record["n"] == 5 * 145, record

# The same scene with y up: its sky is over y, and the wall still hides one half.
run("visible", "wall.obj", "--sensors", "grid.pts", "--patches", "reinhart577", "-o", "out.csv")
assert rows()[2][2] == 1 and 200 < rows()[2][1] < 290, rows()

(here / "bad.pts").write_text("1 2 3 0 0\n")
assert "line 1" in run("visible", "wall.obj", "--sensors", "bad.pts", status=1)
assert "--up" in run("visible", "wall.obj", "--sensors", "grid.pts", "--up", "0", "0", "0", status=1)
assert "--sensors" in run("visible", "wall.obj", status=2)
assert "reinhart2305" in run("visible", "wall.obj", "--sensors", "grid.pts", "--patches", "cie", status=2)
print("visible: as it should be")
