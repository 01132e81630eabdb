#!/usr/bin/env python3
"""Runs `twinray collide` as a user does. Usage: collide_command_test.py TWINRAY"""
import functools
import pathlib
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import command
from command import here

run = functools.partial(command.run, "collide")

# Three triangles in one mesh: the second pierces the first, the third touches the second at a corner.
points = ["0 0 0", "4 0 0", "0 4 0", "1 1 -1", "1 1 1", "3 1 -1", "1 1 1", "0 0 5", "0 1 5"]
command.write_ply("soup.ply", points, [(0, 1, 2), (3, 4, 5), (6, 7, 8)])

said = run("soup.ply", "--self", "--validation", "-o", "out.csv", "--json", "all.jsonl")
assert (here / "out.csv").read_text().splitlines() == [
    "instance_a,instance_b,triangle_a,triangle_b,class", "0,0,0,1,crossing", "0,0,1,2,vertex_touch"], said
assert "crossing 1" in said and "vertex_touch 1" in said, said
record = command.records("all.jsonl")[0]
assert (record["schema"], record["contacts"], record["classes"]["crossing"], record["triangles"]) == ("twinray-collide/1", 2, 1, 3)
assert record["self"] and not record["weld"]

run("soup.ply", "--self", "--weld", "--quiet", "-o", "out.csv")  # the corner in common is a vertex in common
assert (here / "out.csv").read_text().splitlines()[1:] == ["0,0,0,1,crossing"]
run("soup.ply", "--quiet", "-o", "out.csv")
assert (here / "out.csv").read_text().splitlines()[1:] == []
for accel in ["sw", "hw"]:
    run("soup.ply", "--broad", "--accel", accel, "--quiet", "-o", "out.csv", "--json", "broad.jsonl")
    assert (here / "out.csv").read_text() == "instance_a,instance_b\n"
assert [record["pairs"] for record in command.records("broad.jsonl")] == [0, 0]

assert "at most 1 are allowed" in run("soup.ply", "--self", "--max-pairs", "1", status=1)
assert "--self excludes --broad" in run("soup.ply", "--broad", "--self", status=2)
assert "no folder" in run("soup.ply", "-o", "nowhere/out.csv", status=1)
assert "none.ply" in run("none.ply", status=1)
