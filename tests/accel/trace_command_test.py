#!/usr/bin/env python3
"""Runs `twinray trace` as a user does. Usage: trace_command_test.py TWINRAY"""
import base64
import json
import pathlib
import struct
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import command
from command import here


def run(*arguments, scene="two.ply", rays="rays", status=0):
    return command.run("trace", scene, "--rays", rays, "--hits", "hits", "--quiet", *arguments, status=status)


def hits():  # (hit, t, triangle) of each
    return [(hit[0], hit[1], hit[2]) for hit in struct.iter_unpack("<If2I2f2I", (here / "hits").read_bytes())]


# Two triangles, one above the other, and rays that meet both, one and none.
command.write_ply("two.ply", ["0 0 2", "4 0 2", "0 4 2", "0 0 1", "2 0 1", "0 2 1"], [(0, 1, 2), (3, 4, 5)])
rays = [(0.5, 0.5, 0), (1.5, 1.5, 0), (5, 5, 0)]
(here / "rays").write_bytes(b"".join(struct.pack("<8f", *origin, 0, 0, 0, 1, 9) for origin in rays))

devices = json.loads(command.run("devices", "--json", "/dev/stdout").splitlines()[0])
for accel in ["sw", "hw"]:
    run("--accel", accel)
    assert hits() == [(1, 1, 1), (1, 2, 0), (0, -1, 0)], hits()
    run("--accel", accel, "--query", "any")
    assert [hit[0] for hit in hits()] == [1, 1, 0], hits()
    if accel == "hw" and not devices["ray_query"]:
        assert "VK_KHR_ray_query" in run("--accel", accel, "--query", "all", "--counts", "counts", status=1)
        continue
    run("--accel", accel, "--query", "all", "--counts", "counts")
    assert hits() == [(1, 1, 1), (1, 2, 0), (1, 2, 0)], hits()
    assert struct.unpack("<3I", (here / "counts").read_bytes()) == (2, 1, 0)
# Two instances with names, and rays that see one of them.
triangle = struct.pack("<9f", 0, 0, 0, 4, 0, 0, 0, 4, 0)
(here / "named.gltf").write_text(json.dumps({
    "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}],
    "nodes": [{"name": "near", "mesh": 0, "translation": [0, 0, 1]},
              {"name": "far", "mesh": 0, "translation": [0, 0, 2]}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
                   "min": [0, 0, 0], "max": [4, 4, 0]}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}],
    "buffers": [{"byteLength": 36,
                 "uri": "data:application/octet-stream;base64," + base64.b64encode(triangle).decode()}]}))
for accel in ["sw", "hw"] if devices["ray_query"] else ["sw"]:
    for mask, seen in [("1", 1), ("2", 2), ("6", 2), ("8", None), ("255", 1)]:
        masked = ["--accel", accel, "--mask", mask, "--instance-masks", "near=1,far=2"]
        run(*masked, scene="named.gltf")
        assert hits()[0][1] == (seen or -1), (accel, mask, hits())
        run(*masked, "--query", "all", "--counts", "counts", scene="named.gltf")
        assert len(hits()) == {"255": 2, "8": 0}.get(mask, 1) * 2, (accel, mask, hits())
    run("--accel", accel, "--mask", "4", "--instance-masks", "near=1", scene="named.gltf")
    assert hits()[0][1] == 2, hits()
assert "the scene has no instance 'nowhere'" in run("--instance-masks", "nowhere=1", scene="named.gltf", status=1)
for wrong in ["near", "near=", "near=256", "=1", "near=x"]:
    assert f"has '{wrong}', but must be NAME=BITS" in run("--instance-masks", wrong, scene="named.gltf", status=2)
assert "--mask is '256', but must be a whole number at most 255" in run("--mask", "256", status=2)
assert "--query all requires --counts" in run("--query", "all", status=2)
assert "--counts requires --query all" in run("--counts", "counts", status=2)
(here / "rays").write_bytes(b"12345")
assert "'rays'" in run(status=1)


# Far away, in float64: the same triangles 0.13 and 0.27 m off the numbers of float32. npy() writes NumPy's format by
# hand.
east, north = 500000.13, 5400000.27
(here / "two.ply").write_text((here / "two.ply").read_text().replace("property float", "property double").replace(
    "0 0 2\n4 0 2\n0 4 2\n0 0 1\n2 0 1\n0 2 1\n",
    "".join(f"{east + x:.2f} {north + y:.2f} {z}\n" for x, y, z in [(0, 0, 2), (4, 0, 2), (0, 4, 2), (0, 0, 1), (2, 0, 1), (0, 2, 1)])))


def npy(kind, numbers, shape, order="False"):
    header = f"{{'descr': '{kind}', 'fortran_order': {order}, 'shape': {shape}, }}".encode().ljust(117) + b"\n"
    (here / "rays.npy").write_bytes(b"\x93NUMPY\x01\x00" + struct.pack("<H", len(header)) + header +
                                    struct.pack(f"<{len(numbers)}{'d' if kind == '<f8' else 'f'}", *numbers))


def near(wanted):
    return all(h[0] == w[0] and h[2] == w[2] and abs(h[1] - w[1]) < 1e-6 for h, w in zip(hits(), wanted, strict=True))


# Rays pass half a millimetre inside the corners, and as much outside.
far_rays = [(east + 5e-4, north + 5e-4, 0), (east + 3.9985, north + 5e-4, 0), (east - 5e-4, north + 1, 0)]
inside = [(1, 1, 1), (1, 2, 0), (0, -1, 0)]
npy("<f8", [number for origin in far_rays for number in (*origin, 0, 0, 0, 1, 9)], "(3, 8)")
for accel in ["sw", "hw"]:
    run("--accel", accel, "--json", "far.jsonl", rays="rays.npy")
    assert near(inside), hits()
assert command.records("far.jsonl")[0]["origin"] == [500002, 5400002, 2]
said = subprocess.run([command.program, "trace", "two.ply", "--rays", "rays.npy", "--hits", "hits"],
                      capture_output=True, text=True, cwd=here)
assert said.stderr.count("scene moved to local origin 500002 5400002 2\n") == 1, said.stderr
# Rays whose coordinates float32 can hold there are moved exactly.
at = [(500001, 5400001, 0), (500003, 5400001, 0), (500000, 5400001, 0)]
(here / "rays").write_bytes(b"".join(struct.pack("<8f", *origin, 0, 0, 0, 1, 9) for origin in at))
run()
assert near(inside), hits()
npy("<f4", [number for origin in at for number in (*origin, 0, 0, 0, 1, 9)], "(3, 8)")
run(rays="rays.npy")
assert near(inside), hits()
npy("<f8", [0.0] * 16, "(4, 4)")
assert "'rays.npy': its shape is not (N, 8)" in run(rays="rays.npy", status=1)
npy("<f8", [0.0] * 15, "(2, 8)")
assert "'rays.npy': its shape is not (N, 8)" in run(rays="rays.npy", status=1)
npy("<f8", [0.0] * 16, "(2, 8)", order="True")
assert "'rays.npy': its order is Fortran's" in run(rays="rays.npy", status=1)
npy("<i4", [0.0] * 8, "(1, 8)")
assert "'rays.npy': its numbers are neither" in run(rays="rays.npy", status=1)
(here / "rays.npy").write_bytes(b"\x93NUMPY\x01\x00\xff\xff123")
assert "'rays.npy': its header is cut off" in run(rays="rays.npy", status=1)
(here / "rays.npy").write_bytes(b"no array at all")
assert "'rays.npy': it is not a NumPy array" in run(rays="rays.npy", status=1)
