#!/usr/bin/env python3
"""Runs `twinray distance` as a user does. Usage: distance_command_test.py TWINRAY"""
import functools
import pathlib
import struct
import sys
import zipfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import command
from command import here

run = functools.partial(command.run, "distance")


def lines(name):
    return (here / name).read_text().splitlines()

# A tetrahedron with its fronts outward, and the same without its last face.
corners, faces = ["0 0 0", "4 0 0", "0 4 0", "0 0 4"], [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)]
command.write_ply("solid.ply", corners, faces)
command.write_ply("open.ply", corners, faces[:3])
(here / "points.csv").write_text("x,y,z\n1,1,-2\n0.5, 0.75 ,0.25\n\n-3,0,4\n")

run("solid.ply", "--points", "points.csv", "--validation", "--quiet", "-o", "out.csv", "--json", "all.jsonl")
assert lines("out.csv") == ["point,distance,x,y,z,instance,triangle", "0,2,1,1,0,0,0", "1,0.25,0.5,0.75,0,0,0",
                            "2,3,0,0,4,0,1"], lines("out.csv")
said = run("solid.ply", "--points", "points.csv", "--signed", "--validation", "-o", "out.csv", "--json", "all.jsonl")
assert [line.split(",")[1] for line in lines("out.csv")[1:]] == ["2", "-0.25", "3"] and "1 are inside" in said, said
run("solid.ply", "--points", "points.csv", "--max-distance", "2", "--quiet", "-o", "out.csv")
assert lines("out.csv")[3] == "2,inf,,,,,"
run("solid.ply", "--points", "points.csv", "--within", "0.5", "--validation", "--quiet", "-o", "out.csv", "--json", "all.jsonl")
assert lines("out.csv") == ["point,instance,triangle,distance", "1,0,0,0.25", "1,0,2,0.5"], lines("out.csv")
records = command.records("all.jsonl")
assert [(r["schema"], r["query"], r["n"], r["found"]) for r in records] == [
    ("twinray-distance/1", "closest", 3, 3), ("twinray-distance/1", "signed", 3, 3), ("twinray-distance/1", "within", 3, 2)]

run("solid.ply", "--grid", "3", "--signed", "--quiet", "-o", "out.npz")
with zipfile.ZipFile(here / "out.npz") as archive:
    distances = archive.read("distance.npy")
    assert b"'descr': '<f8'" in distances[:128] and b"'shape': (3, 3, 3, )" in distances[:128], distances[:128]
    # The centres of cells are at 0.4, 2 and 3.6 along each axis, in the box with a tenth around it.
    assert [round(d, 6) for d in struct.unpack_from("<27d", distances, len(distances) - 27 * 8)[:2]] == [-0.4, -0.4]
run("open.ply", "--random", "5", "--quiet", "-o", "out.csv")
assert len(lines("out.csv")) == 6

run("solid.ply", "--slice", "plane.png", "--slice-axis", "x", "--slice-at", "0.5", "--slice-size", "64", "--signed", "--quiet")
assert (here / "plane.png").read_bytes()[:8] == b"\x89PNG\r\n\x1a\n"
assert ".png" in run("solid.ply", "--slice", "plane.jpg", status=2)
assert "--within excludes --slice" in run("solid.ply", "--random", "5", "--within", "1", "--slice", "plane.png", status=2)
assert "is not closed" in run("open.ply", "--random", "5", "--signed", status=1)
(here / "bad.csv").write_text("1,2,3\n1,2\n")
assert "line 2: '1,2' is not x,y,z" in run("solid.ply", "--points", "bad.csv", status=1)
(here / "bad.csv").write_text("i1,0,0\n1,2,3\n")
assert "line 1: 'i1,0,0' is not x,y,z" in run("solid.ply", "--points", "bad.csv", status=1)
for text in ("\ufeffx,y,z\r\n+1,2 3\r\n", "# of a survey\n\nx,y,z\n1,2,3 # behind\n", "x;y;z\n1; 2;3.0\n", "1;2;3", "\u00c4,b,c\n1,2,3\n",
             "x,y,z\r1,2,3\r"):
    (here / "good.csv").write_text(text, encoding="utf-8", newline="")
    assert run("solid.ply", "--points", "good.csv").startswith("1 points"), text
for text, fault in (("1|2|3\n", "line 1: '1|2|3' is not x,y,z"), ("0,5;1;2\n", "line 1: '0,5;1;2' is not x,y,z"),
                    ("x,y,z\nu,v,w\n1,2,3\n", "line 2: 'u,v,w' is not x,y,z"), ("x;y;z\n1,2;3\n", "line 2: '1,2;3' is not x,y,z"),
                    ("nan,0,0\n", "line 1: 'nan,0,0' is not x,y,z"), ("1,2,3\n1e999,0,0\n", "line 2: '1e999,0,0' is not x,y,z"),
                    ("x,y,z\n# nothing\n", "has no line x,y,z"), ("", "has no line x,y,z")):
    (here / "bad.csv").write_text(text)
    said = run("solid.ply", "--points", "bad.csv", status=1)
    assert "points file 'bad.csv'" in said and fault in said, (text, said)
(here / "bad.csv").write_text("x,y,z\n1,2,3\n", encoding="utf-16")
assert "'bad.csv': not a text file in ASCII or UTF-8" in run("solid.ply", "--points", "bad.csv", status=1)
assert "points file 'none.csv'" in run("solid.ply", "--points", "none.csv", status=1)
assert ".csv or .npz" in run("solid.ply", "--random", "5", "-o", "out.txt", status=2)
run("solid.ply", status=2)
run("solid.ply", "--random", "5", "--grid", "2", status=2)
run("solid.ply", "--random", "5", "--within", "-1", status=2)

# Far away, all numbers are in the file's coordinates.
east, north = 500000.13, 5400000.27
(here / "far.ply").write_text((here / "solid.ply").read_text().replace("float", "double").replace(
    "0 0 0\n4 0 0\n0 4 0\n0 0 4\n", "".join(f"{east + x:.2f} {north + y:.2f} {z}\n" for x, y, z in [(0, 0, 0), (4, 0, 0), (0, 4, 0), (0, 0, 4)])))
(here / "far.csv").write_text(f"{east + 1:.6f},{north + 1:.6f},-2\n{east + 0.5:.6f},{north + 0.75:.6f},0.25\n{east - 3:.6f},{north:.6f},4\n")


def near(text, *wanted):
    return all(abs(float(number) - right) < 1e-6 for number, right in zip(text, wanted, strict=True))


said = run("far.ply", "--points", "far.csv", "--signed", "-o", "out.csv", "--json", "far.jsonl")
assert said.count("scene moved to local origin 500002 5400002 2\n") == 1, said
assert command.records("far.jsonl")[0]["origin"] == [500002, 5400002, 2]
rows = [line.split(",")[1:5] for line in lines("out.csv")[1:]]
assert near(rows[0], 2, east + 1, north + 1, 0) and near(rows[1], -0.25, east + 0.5, north + 0.75, 0), rows
assert near(rows[2], 3, east, north, 4), rows
assert "moved" not in run("far.ply", "--points", "far.csv", "--quiet", "-o", "out.npz")
with zipfile.ZipFile(here / "out.npz") as archive:
    for name, values in [("point", [east + 1, north + 1, -2]), ("nearest", [east + 1, north + 1, 0])]:
        array = archive.read(f"{name}.npy")
        assert near(struct.unpack("<3d", array[len(array) - 72:][:24]), *values), name
# The plane through the middle, by default and on request, and another one.
far_slice = ["far.ply", "--slice-axis", "x", "--slice-size", "64", "--signed", "--quiet", "--slice"]
run(*far_slice, "middle.png")
run(*far_slice, "asked.png", "--slice-at", f"{east + 2:.2f}")
run(*far_slice, "other.png", "--slice-at", f"{east + 1:.2f}")
middle, asked, other = [(here / f"{name}.png").read_bytes() for name in ["middle", "asked", "other"]]
assert middle == asked and middle != other
