#!/usr/bin/env python3
"""Which accelerator commands take and what they say of it; --level and --strict. Usage: accel_option_test.py TWINRAY PATH_TRACER"""
import pathlib
import struct
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import command as support
from command import here, program as twinray, write_ply

path_tracer = pathlib.Path(sys.argv[2]).resolve()
NONE = {"TWINRAY_DISABLE": "ray_query,ray_tracing_pipeline"}  # as a device without ray tracing


def run(program, *arguments, **options):
    return support.run(*arguments, of=program, **options)


def record(program, *arguments, env=None):
    """Of a run with --json."""
    (here / "all.jsonl").unlink(missing_ok=True)
    run(program, *arguments, "--json", "all.jsonl", env=env)
    return support.records("all.jsonl")[-1]


CORNERS = [(x, y, z) for z in (0, 1) for y in (0, 1) for x in (0, 1)]
CUBE = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
write_ply("cube.ply", CORNERS, CUBE)
(here / "rays").write_bytes(struct.pack("<8f", 0.25, 0.375, -1, 0, 0, 0, 1, 9) + struct.pack("<8f", 5, 5, -1, 0, 0, 0, 1, 9))
trace = ["trace", "cube.ply", "--rays", "rays", "--hits", "hits"]
light = ["--direction", 0, 0, -1, "--grid", 8]
commands = [trace, ["illumination", "cube.ply", *light], ["illumination", "cube.ply", "--sky", 4],
            ["centroid", "cube.ply", *light], ["viewfactors", "cube.ply", "--rays-per-row", 64],
            ["collide", "cube.ply", "--broad"], ["leaks", "cube.ply", "--ray-count", 100]]

device = record(twinray, "devices")
assert set(device["auto"]) == {"backend", "backend_why"} and device["auto"]["backend_why"]
assert device["auto"]["backend"] == ("sw" if device["kind"] == "CPU" or device["hw_missing"] else "hw"), device
assert "--accel auto traces by " in run(twinray, "devices")
assert record(twinray, "devices", env=NONE)["auto"]["backend"] == "sw"

# Requirements: the missing ones of a device are those of the list without the option.
needs = record(twinray, "devices", "--requirements")
assert needs["name"] == device["name"] and all(need["why"] for need in needs["requirements"]), needs
assert [n["what"] for n in needs["requirements"] if n["of"] == "everything" and not n["has"]] == device["sw_missing"]
lacking = {n["of"] for n in record(twinray, "devices", "--requirements", env=NONE)["requirements"] if not n["has"]}
assert {"hardware", "ray_queries", "ray_pipelines"} <= lacking and "everything" not in lacking, lacking
assert "yes  Vulkan 1.2\n" in run(twinray, "devices", "--requirements")

def check(of, backend, why):
    assert of["backend"] == backend and why in of["backend_why"], of


check(record(twinray, *trace), device["auto"]["backend"], device["auto"]["backend_why"])
check(record(twinray, *trace, "--accel", "sw"), "sw", "asked for")
for command in commands:
    check(record(twinray, *command, env=NONE), "sw", "lacks VK_KHR_ray_query")
    said = run(twinray, *command, "--accel", "hw", env=NONE, status=1)
    assert "VK_KHR_ray_query or VK_KHR_ray_tracing_pipeline" in said and "--accel sw works" in said, said
    assert said.count("\n") == 1, said
small = [path_tracer, "cube.ply", "-o", "p.exr", "--spp", 1, "--width", 8, "--height", 8]
check(record(*small, env=NONE), "sw", "lacks VK_KHR_ray_query")
said = run(*small, "--accel", "hw", env=NONE, status=1)
assert "VK_KHR_ray_query" in said and "--accel sw works" in said, said

# The same hits at every level, and hardware has no level certified.
hits = set()
for level in ["fast", "watertight", "refined", "certified"]:
    of = record(twinray, *trace, "--level", level, "--accel", "sw")
    assert (of["level"], of["hits"]) == (level, 1), of
    hits.add((here / "hits").read_bytes())
assert len(hits) == 1
assert record(twinray, *trace, "--level", "certified")["backend"] == "sw"
if device["auto"]["backend"] == "hw" or not device["hw_missing"]:
    assert "certified" in run(twinray, *trace, "--level", "certified", "--accel", "hw", status=1)
of = record(twinray, "verify", "cube.ply", "--random", 500, "--aimed", 100, "--level", "certified")
assert (of["level"], of["backend"]) == ("certified", "sw"), of

# Warnings of the importer are errors with --strict; without warnings it changes nothing.
write_ply("odd.ply", CORNERS, CUBE + [(0, 1)])
loads = [[twinray, *trace], [twinray, *commands[1]], [twinray, *commands[2]], [twinray, *commands[5]],
         [twinray, "distance", "cube.ply", "--random", 5], [twinray, "verify", "cube.ply", "--random", 10, "--aimed", 5], small]
assert "twinray: warning: " in run(twinray, "distance", "odd.ply", "--random", 5)
for command in loads:
    said = run(*["odd.ply" if word == "cube.ply" else word for word in command], "--strict", "--quiet", status=1)
    assert said.splitlines()[-1].endswith("'odd.ply': 1 warning(s), which --strict treats as errors"), said
run(twinray, *trace, "--strict", "--quiet")
print("cli: accelerators are chosen, and told")
