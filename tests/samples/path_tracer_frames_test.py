#!/usr/bin/env python3
"""Runs `path_tracer --frames` as a user does. Usage: path_tracer_frames_test.py PATH_TRACER"""
import base64
import json
import pathlib
import struct
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from command import expect_refusals, here, records, run, same

buffer, views, accessors = b"", [], []


def accessor(kind, component, values):
    global buffer
    data = struct.pack(f"<{len(values)}{'f' if component == 5126 else 'H'}", *values)
    views.append({"buffer": 0, "byteOffset": len(buffer), "byteLength": len(data)})
    buffer += data + b"\0" * (-len(data) % 4)
    width = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}[kind]
    accessors.append({"bufferView": len(views) - 1, "componentType": component, "count": len(values) // width, "type": kind})
    return len(accessors) - 1


# Two flags: one of a mesh on two joints, the upper of which bends, and one that a node carries along.
joints = accessor("VEC4", 5123, [0, 0, 0, 0] * 2 + [1, 0, 0, 0] * 2)
weights = accessor("VEC4", 5126, [1, 0, 0, 0] * 4)
flag = {"POSITION": accessor("VEC3", 5126, [-1, 0, 0, 1, 0, 0, 1, 1, 0, -1, 1, 0])}
indices = accessor("SCALAR", 5123, [0, 1, 2, 0, 2, 3])
times = accessor("SCALAR", 5126, [0, 1])
bend = accessor("VEC4", 5126, [0, 0, 0, 1, 0, 0, 0.6, 0.8])
ride = accessor("VEC3", 5126, [-2, -1, 0, 2, -1, 0])
scene = {
    "asset": {"version": "2.0"},
    "extensionsUsed": ["KHR_materials_variants"],
    "extensions": {"KHR_materials_variants": {"variants": [{"name": "night"}]}},
    "materials": [{"pbrMetallicRoughness": {"baseColorFactor": [1, 0.5, 0.25, 1]}}, {"pbrMetallicRoughness": {"baseColorFactor": [0, 0, 0, 1]}}],
    "meshes": [{"primitives": [{"attributes": {**flag, "JOINTS_0": joints, "WEIGHTS_0": weights}, "indices": indices, "material": 0}]},
               {"primitives": [{"attributes": flag, "indices": indices, "material": 0, "extensions": {
                   "KHR_materials_variants": {"mappings": [{"material": 1, "variants": [0]}]}}}]}],
    "skins": [{"joints": [1, 2]}],
    "nodes": [{"mesh": 0, "skin": 0}, {"children": [2]}, {}, {"mesh": 1, "translation": [-2, -1, 0]}],
    "scenes": [{"nodes": [0, 1, 3]}],
    "scene": 0,
    "animations": [{"name": "parade",
                    "samplers": [{"input": times, "output": bend}, {"input": times, "output": ride}],
                    "channels": [{"sampler": 0, "target": {"node": 2, "path": "rotation"}},
                                 {"sampler": 1, "target": {"node": 3, "path": "translation"}}]},
                   {"name": "torn", "samplers": [{"input": times, "output": ride}],
                    "channels": [{"sampler": 0, "target": {"node": 2, "path": "rotation"}}]}],
    "accessors": accessors, "bufferViews": views}
scene["buffers"] = [{"byteLength": len(buffer), "uri": "data:application/octet-stream;base64," + base64.b64encode(buffer).decode()}]
(here / "flags.gltf").write_text(json.dumps(scene))
small = ["flags.gltf", "--height", "24", "--spp", "2"]


# Renders two frames, by each accelerator of the device.
accels = ["sw", "hw"] if "HwTlas" in run(*small, "-o", "any.png") else ["sw"]
for accel in accels:
    shown = run(*small, "-o", f"{accel}.exr", "--frames", "2", "--accel", accel, "--json", "all.jsonl", "--validation")
    assert "frame 2 of 2: 0.500 s" in shown and "animation 1 'torn' cannot be played" in shown, shown
    assert not same(f"{accel}_0001.exr", f"{accel}_0002.exr"), accel
rows = records("all.jsonl")
assert [(r["frame"], r["time"]) for r in rows[:2]] == [(1, 0), (2, 0.5)] and rows[1]["refit_ms"] > 0, rows
assert rows[0]["configuration"] != rows[1]["configuration"], rows
assert not list(here.glob("*.film")), "frames leave no checkpoints"

# Frames are numbered as asked for; the same moment and random numbers give the same picture, and others do not.
moment = [*small, "--accel", "sw", "--frames", "1", "--time-range"]
view = ["--look-from", "0", "0", "6", "--look-at", "0", "0", "0"]
run(*moment, "0.5:0.5", "-o", "f##.png", "--seed", "2", *view)
run(*small, "--accel", "sw", "-o", "all_#.png", "--frames", "2", "--fps", "2", "--animation", "parade", *view)
assert same("f01.png", "all_2.png") and not same("all_1.png", "all_2.png")
run(*moment, "0.25:0.25", "-o", "early.png", "--seed", "2", *view)
assert not same("early_0001.png", "all_2.png")

# A turntable of a scene at rest: half way round it is seen from behind; nothing else moves.
run(*small, "--accel", "sw", "-o", "turn_#.png", "--frames", "2", "--turntable", *view)
run(*small, "--accel", "sw", "-o", "front.png", *view)
assert same("turn_1.png", "front.png") and not same("turn_1.png", "turn_2.png")
# Another set of materials.
run(*small, "--accel", "sw", "-o", "night.png", "--variant", "night", *view)
assert not same("front.png", "night.png")

expect_refusals([
        (["--frames", "2", "-o", "a.film"], 1, "must be a picture"), (["--frames", "2", "-o", "a.png", "--resume"], 2, "excludes"),
        (["--frames", "0", "-o", "a.png"], 2, "not in range"), (["--fps", "24", "-o", "a.png"], 2, "requires --frames"),
        (["--frames", "2", "-o", "a.png", "--animation", "walk"], 1, "does not exist; the scene has 0 'parade', 1 'torn'"),
        (["--frames", "2", "-o", "a.png", "--animation", "1"], 1, "'torn' cannot be played: sampler 0 output: accessor 6 is not of type VEC4"),
        (["--frames", "2", "-o", "a.png", "--time-range", "1"], 1, "must be A:B"),
        (["--frames", "2", "-o", "none/a.png"], 1, "there is no folder"),
        (["-o", "a.png", "--variant", "day"], 1, "variant 'day' does not exist; the scene has 'night'")], *small)
assert "has no animations" in run("builtin:cornell-box", "--frames", "2", "-o", "a.png", status=1)
print("path_tracer_frames_test: passed")
