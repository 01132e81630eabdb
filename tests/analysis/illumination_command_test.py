#!/usr/bin/env python3
"""Runs `twinray illumination`, `centroid` and `visible`. Usage: illumination_command_test.py TWINRAY"""
import csv
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import command
from command import expect_refusals, here, run, write_ply


def table(name, header):
    rows = list(csv.reader((here / name).read_text().splitlines()))
    assert rows[0] == header.split(","), rows[0]
    return rows[1:]


def near(value, exact, error):
    assert abs(float(value) - exact) <= error, f"{value} is not {exact}"


# Two unit squares of two triangles each; the upper one hides half of the lower one.
corners = [(x + shift, y, z) for shift, z in [(0, 0), (0.5, 1)] for x, y in [(0, 0), (1, 0), (1, 1), (0, 1)]]
write_ply("squares.ply", corners, [(0, 1, 2), (0, 2, 3), (4, 5, 6), (4, 6, 7)])
light = ["illumination", "squares.ply", "--direction", "0", "0", "-.5"]
for accel in ["sw", "hw"]:
    shown = run(*light, "--accel", accel, "-o", f"{accel}.csv", "--json", "all.jsonl")
    assert "1000000 rays" in shown and "lit: 4 of 4 by face" in shown, shown
    for row, exact in zip(table(f"{accel}.csv", "face,hits,area,ci_low,ci_high"), [0.125, 0.375, 0.5, 0.5], strict=True):
        near(row[2], exact, 0.001)
        assert row[1].isdigit() and float(row[3]) <= exact <= float(row[4]) + 1e-9, row
assert (here / "sw.csv").read_text() == (here / "hw.csv").read_text()
records = command.records("all.jsonl")
assert [r["backend"] for r in records] == ["sw", "hw"] and records[0]["n"] == 1000000, records
near(records[0]["area"], 1.5, 0.001)

assert run(*light, "--quiet", "--grid", "30", "--by", "mesh", "--measure", "fraction", "-o", "mesh.csv") == ""
near(table("mesh.csv", "mesh,hits,fraction,ci_low,ci_high")[0][2], 0.75, 0.02)
(here / "groups.csv").write_text("0 1\n1 1\n2 0\n3 0\n")
run(*light, "--grid", "100", "--groups", "groups.csv", "-o", "groups_lit.csv")
for row, exact in zip(table("groups_lit.csv", "group,hits,area,ci_low,ci_high"), [1, 0.5], strict=True):
    near(row[2], exact, 0.01)
run(*light, "--grid", "30", "--sides", "front", "--measure", "irradiance", "--grid-points", "centers", "-o", "centers.csv")
assert [row[3:] for row in table("centers.csv", "face,hits,irradiance,ci_low,ci_high")] == [["", ""]] * 4

run("illumination", "squares.ply", "--sky", "500", "--up", "0", "0", "1", "-o", "sky.csv")
near(table("sky.csv", "face,free_rays,sky,ci_low,ci_high")[2][2], 1, 0)
(here / "sun.csv").write_text("x,y,z,hours\n0,0,-1,2\n\n# noon\n-1,0,-1,3\n")
run("illumination", "squares.ply", "--sun", "sun.csv", "--samples", "100", "-o", "hours.csv")
near(table("hours.csv", "face,free_rays,hours,ci_low,ci_high")[0][2], 2.75, 0.3)

shown = run("centroid", "squares.ply", "--direction", "0", "0", "1", "-o", "points.csv", "--json", "mean.jsonl")
record = command.records("mean.jsonl")[0]
assert "standard error" in shown and record["points_hit"] == len(table("points.csv", "x,y,z")), shown
for value, exact in zip(record["mean"], [0.75, 0.5, 1 / 3], strict=True):
    near(value, exact, 0.001)
write_ply("nothing.ply", ["0 0 0", "1 1 1", "2 2 2"], [(0, 1, 2)])
assert "there is no mean" in run("centroid", "nothing.ply", "--direction", "0", "0", "1", "--grid", "9")

expect_refusals([
        (["--direction", "0", "0", "0"], 1, "must be finite and not 0"),
        (["--direction", "0", "0", "1", "--grid", "70000"], 2, "--grid is '70000', but must be a whole number from 1 to 65535"),
        (["--direction", "0", "0", "1", "-o", "none/a.csv"], 1, "there is no folder 'none'"),
        (["--direction", "0", "0", "1", "--sky", "9"], 2, "only one of --direction, --sky, --sun may be given"),
        ([], 2, "one of --direction, --sky, --sun is required"),
        (["--sky", "9", "--grid", "5"], 2, "--grid requires --direction"), (["--sky", "0"], 2, "--sky is '0', but must be a whole number from 1 to 1048576"),
        (["--sun", "none.csv"], 1, "sun file 'none.csv' cannot be read"),
        (["--sun", "squares.ply"], 1, "'format ascii 1.0' is not x,y,z,hours")], "illumination", "squares.ply")
assert "--direction is required" in run("centroid", "squares.ply", status=2)

# Sensors at a wall of x = 0, as wide and high as one sees.
(here / "wall.obj").write_text("v 0 -1e4 -1e4\nv 0 1e4 -1e4\nv 0 1e4 1e4\nv 0 -1e4 1e4\nf 1 2 3 4\n")
(here / "grid.pts").write_text(
    "# x y z dx dy dz\n1 0 1  0 0 1\n-1 0 1  0 0 1\n1 0 1  1 0 0\n1 0 1  -1 0 0\n0 0 1  1 0 0\n")
(here / "bad.pts").write_text("1 2 3 0 0\n")
sensors = ["visible", "wall.obj", "--sensors", "grid.pts"]


def patches():
    rows = table("out.csv", "sensor,free_patches,share")
    return [(int(sensor), int(free), float(share)) for sensor, free, share in rows]


for accel in ["sw", "hw"]:
    run(*sensors, "--up", "0", "0", "1", "--t-near", "0.01", "-o", "out.csv", "--accel", accel, "--json", "log.json")
    upward, behind, away, facing, on_it = patches()
    # 65 of 145 patches are behind the wall, and 15 over it: two of each row, and the zenith.
    assert upward[1] == behind[1] == 80, patches()
    assert 0.5 < upward[2] < 0.6 and away[2] == 1 and on_it == (4, *away[1:]) and facing[1:] == (0, 0), patches()
    assert 65 <= away[1] <= 72, patches()
record = command.records("log.json")[-1]
assert record["sensors"] == 5 and record["sky"] == "tregenza145" and record["n"] == 5 * 145, record
# The same scene with y up: its sky is over y, and the wall still hides one half.
run(*sensors, "--patches", "reinhart577", "-o", "out.csv")
assert patches()[2][2] == 1 and 200 < patches()[2][1] < 290, patches()
expect_refusals([
        (["--sensors", "bad.pts"], 1, "line 1"), ([], 2, "--sensors"),
        (["--sensors", "grid.pts", "--up", "0", "0", "0"], 1, "--up"),
        (["--sensors", "grid.pts", "--patches", "cie"], 2, "reinhart2305")], "visible", "wall.obj")
print("illumination: areas, shares, sky, hours, centroid and patches are those of squares and a wall")
