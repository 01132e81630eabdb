#!/usr/bin/env python3
"""Runs `twinray viewfactors` as a user does. Usage: viewfactors_command_test.py TWINRAY"""
import ast
import csv
import functools
import pathlib
import signal
import struct
import subprocess
import sys
import time
import zipfile

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import command
from command import here, program, records, same

run = functools.partial(command.run, "viewfactors", one_stream=True)
by_hits = ["--rays-per-row", "1024", "--estimator", "hits"]


def array(archive, name):
    """A one-dimensional .npy as a list: NumPy may not be installed."""
    data = archive.read(name + ".npy")
    assert data[:8] == b"\x93NUMPY\x01\x00", name
    size = struct.unpack("<H", data[8:10])[0]
    assert (10 + size) % 64 == 0, "headers are aligned"
    header = ast.literal_eval(data[10:10 + size].decode())
    kind = {"<f4": "f", "<f8": "d", "<u4": "I", "<i8": "q", "<u8": "Q"}[header["descr"]]
    return list(struct.unpack(f"<{header['shape'][0]}{kind}", data[10 + size:]))


def table(name):
    return list(csv.DictReader((here / name).read_text().splitlines()))


def write_grid_box(name, n, plate_at=None):
    """A box of n x n quads a side that looks inwards; with a plate above the floor, if wanted."""
    points, faces = [], []
    for axis in range(3):
        for side in (0, 1):
            for i in range(n):
                for j in range(n):
                    corners = list(range(len(points) + 1, len(points) + 5))
                    faces.append(corners if side == 0 else corners[::-1])
                    for di, dj in ((0, 0), (1, 0), (1, 1), (0, 1)):
                        point = [0.0, 0.0, 0.0]
                        point[axis], point[(axis + 1) % 3], point[(axis + 2) % 3] = side, (i + di) / n, (j + dj) / n
                        points.append(point)
    if plate_at:
        faces.append(range(len(points) + 1, len(points) + 5))
        points += [(x, y, plate_at) for x, y in ((0.1, 0.1), (0.6, 0.1), (0.6, 0.6), (0.1, 0.6))]
    lines = [f"{kind} {' '.join(map(str, row))}\n" for kind, rows in (("v", points), ("f", faces)) for row in rows]
    (here / name).write_text("".join(lines))


write_grid_box("box.obj", 6)
said = run("box.obj", "-o", "f.csv", *by_hits, "--project", "--json", "f.json")
assert "432 face rows" in said and "closure 0\n" in said and "--sides both" not in said, said
entries = [(int(r["i"]), int(r["j"]), *(float(r[name]) for name in ("F", "ci_low", "ci_high"))) for r in table("f.csv")]
sums = {}
for i, j, factor, low, high in entries:
    sums[i] = sums.get(i, 0) + factor
    assert 0 <= low <= factor <= high <= 1, f"interval of {i}, {j}"
assert len(sums) == 432 and all(abs(s - 1) < 1e-6 for s in sums.values()), "rows of a closed box add up to 1"
record = records("f.json")[0]
assert record["hits"] == record["rays"] == 432 * 1024 and record["projected"]["reciprocity"] < 1e-6, record

# Fronts that point away see nothing, and the command says what may be meant.
(here / "outwards.obj").write_text("".join(
    " ".join(["f", *line.split()[:0:-1]]) + "\n" if line.startswith("f ") else line
    for line in (here / "box.obj").read_text().splitlines(keepends=True)))
said = run("outwards.obj", "--rays-per-row", "64", "--estimator", "hits")
assert "0 entries" in said and "fronts point away; --sides both" in said, said

run("box.obj", "-o", "f.npz", *by_hits, "--project", "--quiet")
with zipfile.ZipFile(here / "f.npz") as archive:
    assert archive.testzip() is None, "checksums"
    starts, columns, values = array(archive, "indptr"), array(archive, "indices"), array(archive, "data")
    assert array(archive, "shape") == [432, 432] and b"csr" in archive.read("format.npy"), "a CSR matrix"
    lows, areas = array(archive, "ci_low"), array(archive, "area")
    assert set(array(archive, "estimator")) == {1}, "all entries by hits"
flat = [(i, columns[k], values[k], lows[k]) for i in range(432) for k in range(starts[i], starts[i + 1])]
assert all(a[:2] == b[:2] and abs(a[2] - b[2]) < 1e-8 and abs(a[3] - b[3]) < 1e-8
           for a, b in zip(flat, entries, strict=True)), "both formats hold the same"
assert abs(sum(areas) - 6) < 1e-6, "areas of the box"

said = run("box.obj", "--by", "mesh", "--rays-per-row", "65536", "--estimator", "hits")
assert "1 mesh rows, 1 entries" in said, said


# Groups of faces: with walls as groups, each sees the four beside it and the one that faces it.
def write_groups(rows):
    (here / "groups.csv").write_text("face,group\n" + "".join(f"{face},{group}\n" for face, group in rows))


write_groups((face, face // 72) for face in reversed(range(432)))
said = run("box.obj", "--groups", "groups.csv", "--rays-per-row", "65536", "--estimator", "hits", "-o", "f.csv")
assert "6 group rows, 30 entries" in said, said
for r in table("f.csv"):
    truth = 0.199825 if int(r["i"]) // 2 == int(r["j"]) // 2 else 0.200044
    assert float(r["ci_low"]) - 0.002 < truth < float(r["ci_high"]) + 0.002, r
assert "excludes" in run("box.obj", "--groups", "groups.csv", "--by", "mesh", status=2), "one or the other"
for rows, words in [([(0, 0)], "face 1 is missing"), ([(0, 0), (0, 0)], "face 0 occurs twice"),
                    ([(432, 0)], "line 2: face 432; both must be whole numbers from 0 to 431"),
                    ([(0, 0.5)], "line 2: group 0.5")]:
    write_groups(rows)
    assert words in run("box.obj", "--groups", "groups.csv", status=1), words

# Contours are exact but for float32; with a plate in the way, areas and hits have their part.
write_grid_box("small.obj", 2)
write_grid_box("plate.obj", 4, plate_at=0.1)
for scene in ("small.obj", "plate.obj"):
    run(scene, "--rays-per-row", "1024", "--json", "s.json")
exact, mixed = records("s.json")
assert exact["entries_by_estimator"] == {"area": 0, "contour": 48 * 40, "hits": 0}, exact
assert exact["as_counted"]["closure"] < 1e-6 and exact["widest_half_interval"] < 1e-6, exact
assert all(count > 0 for count in mixed["entries_by_estimator"].values()) and mixed["rays_between_faces"] > 0, mixed
for accel in ("sw", "hw"):
    run("plate.obj", *by_hits, "--accel", accel, "-o", accel + ".npz")
assert same("sw.npz", "hw.npz"), "both accelerators give the same counts"

# Killed in the middle and resumed: the same file, byte for byte.
options = ["--rays-per-row", "16384", "--quiet"]
run("plate.obj", "-o", "whole.npz", *options)
process = subprocess.Popen([program, "viewfactors", "plate.obj", "-o", "killed.npz", *options], cwd=here)
unfinished = here / "killed.npz.rows"
while process.poll() is None and not (unfinished.exists() and unfinished.stat().st_size > 100_000):
    time.sleep(0.005)
assert process.poll() is None, "it is still at work"
process.send_signal(signal.SIGKILL)
process.wait()
assert unfinished.exists() and not (here / "killed.npz").exists(), "unfinished rows are left"
write_grid_box("box.obj", 4, plate_at=0.2)  # as many faces of the same areas
for scene, *other in (("plate.obj", "4096"), ("plate.obj", "16384", "--estimator", "hits"), ("box.obj", "16384")):
    said = run(scene, "-o", "killed.npz", "--resume", "--rays-per-row", *other, status=1)
    assert "of another scene or of other options" in said, said
said = run("plate.obj", "-o", "killed.npz", "--resume", "--rays-per-row", "16384")
assert "resumed after" in said and same("whole.npz", "killed.npz"), said
assert not unfinished.exists(), "nothing is left behind"

command.expect_refusals([
    (["--estimator", "contour"], 1, "may come between"), (["--estimator", "area"], 1, "of their longest edge"),
    (["-o", "f.txt"], 2, ".npz or .csv"), (["--resume"], 2, "--resume requires --output"),
    (["--rays-per-row", "0"], 2, "--rays-per-row is '0', but must be a whole number at least 1"),
    (["--target-error", "0"], 2, "--target-error is '0', but must be a finite number above 0"),
    (["-o", "none/f.csv"], 1, "there is no folder")], "viewfactors", "plate.obj")
print("viewfactors_command_test: passed")
