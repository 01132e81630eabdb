#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Runs `twinray trace` as a user does. Usage: trace_command_test.py TWINRAY"""
import pathlib
import struct
import subprocess
import sys
import tempfile

twinray, here = pathlib.Path(sys.argv[1]).resolve(), pathlib.Path(tempfile.mkdtemp())


def run(*arguments, status=0):
    done = subprocess.run([twinray, "trace", "two.ply", "--rays", "rays", "--hits", "hits", "--quiet", *arguments],
                          capture_output=True, text=True, cwd=here)
    assert done.returncode == status, f"{arguments}: status {done.returncode}\n{done.stdout}{done.stderr}"
    return done.stdout + done.stderr


def hits():  # (hit, t, triangle) of each
    return [(hit[0], hit[1], hit[2]) for hit in struct.iter_unpack("<If2I2f2I", (here / "hits").read_bytes())]


# Two triangles, one above the other, and rays that meet both, one and none.
(here / "two.ply").write_text("ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty float z\n"
                              "element face 2\nproperty list uchar int vertex_indices\nend_header\n"
                              "0 0 2\n4 0 2\n0 4 2\n0 0 1\n2 0 1\n0 2 1\n3 0 1 2\n3 3 4 5\n")
rays = [(0.5, 0.5, 0), (1.5, 1.5, 0), (5, 5, 0)]
(here / "rays").write_bytes(b"".join(struct.pack("<8f", *origin, 0, 0, 0, 1, 9) for origin in rays))

for accel in ["sw", "hw"]:
    run("--accel", accel)
    assert hits() == [(1, 1, 1), (1, 2, 0), (0, -1, 0)], hits()
    run("--accel", accel, "--query", "any")
    assert [hit[0] for hit in hits()] == [1, 1, 0], hits()
    run("--accel", accel, "--query", "all", "--counts", "counts")
    assert hits() == [(1, 1, 1), (1, 2, 0), (1, 2, 0)], hits()
    assert struct.unpack("<3I", (here / "counts").read_bytes()) == (2, 1, 0)
assert "--query all needs --counts" in run("--query", "all", status=1)
assert "--counts is for --query all" in run("--counts", "counts", status=1)
(here / "rays").write_bytes(b"12345")
assert "'rays'" in run(status=1)
