#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Runs `twinray viewfactors` as a user does. Usage: viewfactors_command_test.py TWINRAY"""
import ast
import csv
import json
import os
import signal
import struct
import subprocess
import sys
import tempfile
import time
import zipfile

twinray = sys.argv[1]


def run(*arguments, fails=False):
    done = subprocess.run([twinray, "viewfactors", *arguments], capture_output=True, text=True)
    if (done.returncode != 0) != fails:
        sys.exit(f"{' '.join(arguments)}: exit {done.returncode}\n{done.stdout}{done.stderr}")
    return done.stderr if fails else done.stdout


def expect(condition, what):
    if not condition:
        sys.exit(f"not so: {what}")


def array(archive, name):
    """A one-dimensional .npy as a list: NumPy may not be installed."""
    data = archive.read(name + ".npy")
    expect(data[:8] == b"\x93NUMPY\x01\x00", name)
    size = struct.unpack("<H", data[8:10])[0]
    expect((10 + size) % 64 == 0, "headers are aligned")
    header = ast.literal_eval(data[10:10 + size].decode())
    kind = {"<f4": "f", "<f8": "d", "<u4": "I", "<i8": "q", "<u8": "Q"}[header["descr"]]
    return list(struct.unpack(f"<{header['shape'][0]}{kind}", data[10 + size:]))


def write_grid_box(path, n, with_plate=False, plate_at=0.1):
    """A box of n x n quads a side that looks inwards; with a plate above the floor, if wanted."""
    lines, count = [], 0
    for axis in range(3):
        for side in (0, 1):
            for i in range(n):
                for j in range(n):
                    for di, dj in ((0, 0), (1, 0), (1, 1), (0, 1)):
                        point = [0.0, 0.0, 0.0]
                        point[axis], point[(axis + 1) % 3], point[(axis + 2) % 3] = side, (i + di) / n, (j + dj) / n
                        lines.append("v {} {} {}".format(*point))
                    corners = [count + 1, count + 2, count + 3, count + 4]
                    lines.append("f {} {} {} {}".format(*(corners if side == 0 else corners[::-1])))
                    count += 4
    if with_plate:
        lines += [f"v {x} {y} {plate_at}" for x, y in ((0.1, 0.1), (0.6, 0.1), (0.6, 0.6), (0.1, 0.6))]
        lines.append("f {} {} {} {}".format(*range(count + 1, count + 5)))
    with open(path, "w", encoding="utf-8") as out:
        out.write("\n".join(lines) + "\n")


with tempfile.TemporaryDirectory() as folder:
    box, csv_file, npz_file = (os.path.join(folder, name) for name in ("box.obj", "f.csv", "f.npz"))
    write_grid_box(box, 6)

    text = run(box, "-o", csv_file, "--rays-per-row", "1024", "--estimator", "hits", "--project", "--json",
               os.path.join(folder, "f.json"))
    expect("432 face rows" in text and "closure 0\n" in text, text)
    with open(csv_file, encoding="utf-8") as rows:
        table = [(int(r["i"]), int(r["j"]), float(r["F"]), float(r["ci_low"]), float(r["ci_high"]))
                 for r in csv.DictReader(rows)]
    sums = {}
    for i, j, factor, low, high in table:
        sums[i] = sums.get(i, 0) + factor
        expect(0 <= low <= factor <= high <= 1, f"interval of {i}, {j}")
    expect(len(sums) == 432 and all(abs(s - 1) < 1e-6 for s in sums.values()), "rows of a closed box add up to 1")
    with open(os.path.join(folder, "f.json"), encoding="utf-8") as lines:
        record = json.loads(lines.readline())
    expect(record["hits"] == record["rays"] == 432 * 1024 and record["projected"]["reciprocity"] < 1e-6, record)

    expect("--sides both" not in text, text)

    # Fronts that point away see nothing, and the command says what may be meant.
    outwards = os.path.join(folder, "outwards.obj")
    with open(box, encoding="utf-8") as lines, open(outwards, "w", encoding="utf-8") as out:
        for line in lines:
            out.write(" ".join(["f", *line.split()[:0:-1]]) + "\n" if line.startswith("f ") else line)
    text = run(outwards, "--rays-per-row", "64", "--estimator", "hits")
    expect("0 entries" in text and "fronts point away; --sides both" in text, text)

    run(box, "-o", npz_file, "--rays-per-row", "1024", "--estimator", "hits", "--project", "--quiet")
    with zipfile.ZipFile(npz_file) as archive:
        expect(archive.testzip() is None, "checksums")
        starts, columns, values = array(archive, "indptr"), array(archive, "indices"), array(archive, "data")
        expect(array(archive, "shape") == [432, 432] and b"csr" in archive.read("format.npy"), "a CSR matrix")
        low, areas = array(archive, "ci_low"), array(archive, "area")
        expect(set(array(archive, "estimator")) == {1}, "all entries by hits")
    flat = [(i, columns[k], values[k], low[k]) for i in range(432) for k in range(starts[i], starts[i + 1])]
    expect(len(flat) == len(table), "as many entries")
    expect(all(a[:2] == b[:2] and abs(a[2] - b[2]) < 1e-8 and abs(a[3] - b[3]) < 1e-8 for a, b in zip(flat, table)),
           "both formats hold the same")
    expect(abs(sum(areas) - 6) < 1e-6, "areas of the box")

    by_mesh = run(box, "--by", "mesh", "--rays-per-row", "65536", "--estimator", "hits")
    expect("1 mesh rows, 1 entries" in by_mesh, by_mesh)

    # Groups of faces: with walls as groups, each sees the four beside it and the one that faces it.
    groups = os.path.join(folder, "groups.csv")
    def write_groups(lines):
        with open(groups, "w", encoding="utf-8") as out:
            out.write("face,group\n" + "".join(f"{face},{group}\n" for face, group in lines))
    write_groups((face, face // 72) for face in reversed(range(432)))
    by_wall = run(box, "--groups", groups, "--rays-per-row", "65536", "--estimator", "hits", "-o", csv_file)
    expect("6 group rows, 30 entries" in by_wall, by_wall)
    with open(csv_file, encoding="utf-8") as rows:
        for r in csv.DictReader(rows):
            truth = 0.199825 if int(r["i"]) // 2 == int(r["j"]) // 2 else 0.200044
            expect(float(r["ci_low"]) - 0.002 < truth < float(r["ci_high"]) + 0.002, r)
    expect("excludes" in run(box, "--groups", groups, "--by", "mesh", fails=True), "one or the other")
    for lines, words in [([(0, 0)], "face 1 is missing"), ([(0, 0), (0, 0)], "face 0 occurs twice"),
                         ([(432, 0)], "line 2: face 432; both must be whole numbers from 0 to 431"), ([(0, 0.5)], "line 2: group 0.5")]:
        write_groups(lines)
        expect(words in run(box, "--groups", groups, fails=True), words)

    # Contours are exact but for float32; with a plate in the way, areas and hits have their part.
    small, plate, json_file = (os.path.join(folder, name) for name in ("small.obj", "plate.obj", "s.json"))
    write_grid_box(small, 2)
    write_grid_box(plate, 4, with_plate=True)
    for scene in (small, plate):
        run(scene, "--rays-per-row", "1024", "--json", json_file)
    with open(json_file, encoding="utf-8") as lines:
        exact, mixed = (json.loads(line) for line in lines)
    expect(exact["entries_by_estimator"] == {"area": 0, "contour": 48 * 40, "hits": 0}, exact)
    expect(exact["as_counted"]["closure"] < 1e-6 and exact["widest_half_interval"] < 1e-6, exact)
    expect(all(count > 0 for count in mixed["entries_by_estimator"].values()) and mixed["rays_between_faces"] > 0, mixed)
    for accel in ("sw", "hw"):
        run(plate, "--rays-per-row", "1024", "--estimator", "hits", "--accel", accel, "-o", os.path.join(folder, accel + ".npz"))
    with open(os.path.join(folder, "sw.npz"), "rb") as one, open(os.path.join(folder, "hw.npz"), "rb") as other:
        expect(one.read() == other.read(), "both accelerators give the same counts")
    expect("may come between" in run(plate, "--estimator", "contour", fails=True), "contours are refused")
    expect("of their longest edge" in run(plate, "--estimator", "area", fails=True), "areas are refused")

    # Killed in the middle and resumed: the same file, byte for byte.
    whole, killed = os.path.join(folder, "whole.npz"), os.path.join(folder, "killed.npz")
    options = ["--rays-per-row", "16384", "--quiet"]
    run(plate, "-o", whole, *options)
    process = subprocess.Popen([twinray, "viewfactors", plate, "-o", killed, *options])
    unfinished = killed + ".rows"
    while process.poll() is None and not (os.path.exists(unfinished) and os.path.getsize(unfinished) > 100_000):
        time.sleep(0.005)
    expect(process.poll() is None, "it is still at work")
    process.send_signal(signal.SIGKILL)
    process.wait()
    expect(os.path.exists(unfinished) and not os.path.exists(killed), "unfinished rows are left")
    for other in (["--rays-per-row", "4096"], ["--rays-per-row", "16384", "--estimator", "hits"]):
        refused = run(plate, "-o", killed, "--resume", *other, fails=True)
        expect("of another scene or of other options" in refused, refused)
    write_grid_box(box, 4, with_plate=True, plate_at=0.2)  # as many faces of the same areas
    refused = run(box, "-o", killed, "--resume", "--rays-per-row", "16384", fails=True)
    expect("of another scene or of other options" in refused, refused)
    resumed = run(plate, "-o", killed, "--resume", "--rays-per-row", "16384")
    expect("resumed after" in resumed, resumed)
    with open(whole, "rb") as a, open(killed, "rb") as b:
        expect(a.read() == b.read(), "resuming gives the same file")
    expect(not os.path.exists(unfinished), "nothing is left behind")

    for arguments, message in ((["-o", os.path.join(folder, "f.txt")], ".npz or .csv"),
                               (["--resume"], "--resume requires --output"), (["--rays-per-row", "0"], "--rays-per-row is '0', but must be a whole number at least 1"),
                               (["--target-error", "0"], "--target-error is '0', but must be a finite number above 0"),
                               (["-o", os.path.join(folder, "none", "f.csv")], "there is no folder")):
        expect(message in run(box, *arguments, fails=True), message)
print("viewfactors_command_test: passed")
