#!/usr/bin/env python3
"""Runs `path_tracer` as a user does. Usage: path_tracer_command_test.py PATH_TRACER"""
import base64
import json
import os
import pathlib
import shutil
import signal
import socket
import struct
import subprocess
import sys
import time

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
from command import expect_refusals, here, program as path_tracer, records, run, same, write_ply

box = ["builtin:cornell-box", "--height", "24", "--accel", "sw"]


def stop_when(checkpoint, signal_number, *arguments):
    """Starts a run and sends it the signal once its checkpoint is there."""
    process = subprocess.Popen([path_tracer, *arguments], stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True, cwd=here)
    while process.poll() is None and not (here / checkpoint).exists():
        time.sleep(0.005)
    assert process.poll() is None, f"{arguments} ended by itself: {process.communicate()}"
    process.send_signal(signal_number)
    shown = "".join(process.communicate())
    return process.returncode, shown


# One run and three shards, merged in another order, give the same picture and the same film.
shown = run(*box, "--spp", "8", "-o", "whole.png", "--keep-film", "--json", "all.jsonl", "--stats")
assert "24 x 24, 8 spp, error" in shown and "swtlas_trace closest" in shown and "device memory" in shown, shown
for shard in range(3):
    run(*box, "--spp", "8", "--shard", f"{shard}/3", "--outfile", f"{shard}.film")
assert "8 spp" in run("merge", "2.film", "0.film", "1.film", "-o", "merged.png")
run("merge", "1.film", "2.film", "0.film", "-o", "merged.film")
assert same("whole.png", "merged.png") and same("whole.png.film", "merged.film")
assert "both hold samples 1 to 1" in run("merge", "0.film", "1.film", "1.film", "-o", "no.png", status=1)
# A lost shard can be rendered later.
run("merge", "2.film", "0.film", "-o", "part.png.film")
assert "(5 resumed)" in run(*box, "--spp", "8", "-o", "part.png", "--resume")
assert same("whole.png", "part.png") and not (here / "part.png.film").exists()

# A run that is killed in the middle and resumed gives the same picture, bit for bit, also with adaptive sampling.
for name, rule in [("plain", ["--spp", "120"]), ("adaptive", ["--target-error", "0.2"])]:
    job = [*box, *rule, "--checkpoint", "0", "-o"]
    status, shown = stop_when(f"{name}.exr.film", signal.SIGKILL, *job, f"{name}.exr")
    assert status == -signal.SIGKILL and not (here / f"{name}.exr").exists(), shown
    assert "resumed" in run(*job, f"{name}.exr", "--resume")
    shown = run(*job, f"{name}2.exr", "--mse-reference-image", f"{name}.exr", "--json", "errors.jsonl")
    assert "MSE 0, relMSE 0" in shown, shown
    assert same(f"{name}.exr", f"{name}2.exr"), name
    assert not list(here.glob("*exr.film")), "nothing is left behind"

# Ctrl-C leaves a picture and a checkpoint.
status, shown = stop_when("stopped.png", signal.SIGINT, *box, "--time", "600", "-o", "stopped.png", "--write-partial-images", "0")
assert "stopped.png: written after" in shown, shown
assert status == 130 and "interrupted after" in shown and (here / "stopped.png.film").exists(), (status, shown)
assert (here / "stopped.png").read_bytes()[-8:-4] == b"IEND"
assert "seed is 1, not 2" in run(*box, "--seed", "2", "--resume", "-o", "stopped.png", status=1)
begun = time.monotonic()
run(*box, "--time", "1", "--resume", "-o", "stopped.png", "--json", "all.jsonl")
assert 1 <= time.monotonic() - begun < 20

# A part of a picture equals that part of the whole.
run(*box, "--spp", "2", "-o", "all.film", "--quiet")
run(*box, "--spp", "2", "--cropwindow", "0.25", "0.5", "0.5", "1", "-o", "part.film", "--quiet")
# The part is the data window of the whole; its pixels are those of the film.
run("merge", "part.film", "-o", "part.exr")
header = (here / "part.exr").read_bytes()[:2000]
for window, corners in [(b"dataWindow", (6, 12, 11, 23)), (b"displayWindow", (0, 0, 23, 23))]:
    at = header.index(window + b"\0box2i\0") + len(window) + 7
    assert struct.unpack_from("<Iiiii", header, at) == (16, *corners), window
assert "MSE 0, relMSE 0" in run(*box, "--spp", "2", "--cropwindow", "0.25", "0.5", "0.5", "1", "-o", "again.exr",
                                "--mse-reference-image", "part.exr")


def pixels(name):  # 72 bytes each, before the checksum
    data = (here / name).read_bytes()
    width, height = (int.from_bytes(data[at:at + 4], "little") for at in (16, 20))
    rows = data[len(data) - 4 - 72 * width * height:-4]
    return [[rows[72 * (y * width + x):72 * (y * width + x + 1)] for x in range(width)] for y in range(height)]


assert pixels("part.film") == [row[6:12] for row in pixels("all.film")[12:24]]

# A camera; what is seen first, in layers beside the same picture.
run(*box, "--spp", "2", "-o", "right.png", "--look-from", "0", "1", "3", "--look-at", "0", "1", "0", "--fov", "30")
run(*box, "--spp", "2", "-o", "left.png", "--look-from", "-1", "1", "3", "--look-at", "0", "1", "0", "--fov", "30")
assert not same("right.png", "left.png")
run(*box, "--spp", "8", "-o", "layers.exr", "--aovs")
assert "MSE 0" in run("merge", "whole.png.film", "-o", "flat.exr", "--mse-reference-image", "layers.exr")
# Kernels with every feature make the same picture but for roundings, here without a tree of lights.
shown = run(*box, "--spp", "8", "--all-features", "-o", "every.exr", "--mse-reference-image", "layers.exr")
assert float(shown.split("relMSE ")[1].split()[0]) < 1e-9, shown
layers = (here / "layers.exr").read_bytes()
for layer in ["albedo.R", "normal.Z", "depth.Z", "instance.ID", "primitive.ID", "samples.N", "variance.Y"]:
    assert layer.encode() + b"\0" in layers[:1000], layer

# A viewer gets the whole picture, channel by channel, and a run does not stop when one leaves.
with socket.create_server(("localhost", 0)) as server:
    port = server.getsockname()[1]
    process = subprocess.Popen([path_tracer, *box, "--spp", "4", "-o", "seen.png", "--display-server", f"localhost:{port}"], cwd=here,
                               stdout=subprocess.DEVNULL)
    connection = server.accept()[0]
    data = b"".join(iter(lambda: connection.recv(1 << 16), b""))
    assert process.wait() == 0
    packets, values = [], {}
    while data:
        size = struct.unpack_from("<I", data)[0]
        packets.append(data[4:size])
        data = data[size:]
    assert packets[0] == b"\4\0seen.png\0" + struct.pack("<III", 24, 24, 3) + b"R\0G\0B\0", packets[0]
    for packet in packets[1:]:
        name, rest = packet[2:].split(b"\0", 1)
        channel, rest = rest.split(b"\0", 1)
        assert packet[0] == 3 and name == b"seen.png" and struct.unpack_from("<IIII", rest) == (0, 0, 24, 24), packet[:60]
        values[channel] = struct.unpack("<576f", rest[16:])
    assert set(values) == {b"R", b"G", b"B"} and all(0 < sum(channel) / 576 < 10 for channel in values.values()), values
    assert sum(values[b"R"]) > sum(values[b"B"]), "the lamp is warm"
    process = subprocess.Popen([path_tracer, *box, "--time", "2", "-o", "unseen.png", "--display-server", f"localhost:{port}"], cwd=here,
                               stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    server.accept()[0].close()
    assert "the display server has closed" in process.communicate()[1] and process.returncode == 0
assert "no server listens" in run(*box, "-o", "a.png", "--display-server", f"localhost:{port}", status=1)

record = records("all.jsonl")[0]
assert record["spp"] == 8 and 0 < record["error"] < 10 and len(record["configuration"]) == 8, record
record = records("errors.jsonl")[0]
assert record["mse"] == 0 and record["relative_mse"] == 0, record
assert not list(here.glob("*partial*")), "nothing half written is left"

expect_refusals([
        (["-o", "a.jpg"], 2, "must end in .png, .exr or .film"), (["-o", "none/a.png"], 1, "there is no folder 'none'"),
        (["-o", "a.png", "--shard", "0/2"], 1, "must end in .film"), (["-o", "a.film", "--shard", "2/2"], 1, "must be I/N"),
        (["-o", "a.film", "--shard", "0/2", "--target-error", "0.1"], 2, "excludes"),
        (["-o", "a.png", "--spp", "16", "--target-error", "0.1"], 1, "at least 32"),
        (["-o", "a.png", "--aovs"], 1, "must end in .exr"),
        (["-o", "a.png", "--cropwindow", "0.5", "0.5", "0", "1"], 1, "no pixel"),
        (["-o", "a.png", "--look-from", "0", "1", "0", "--look-at", "0", "0", "0"], 1, "which is up"),
        (["-o", "a.png", "--mse-reference-image", "plain.exr", "--width", "30"], 1,
         "24 x 24 pixels, but the picture has 30 x 24")], *box)
(here / "bad.film").write_bytes((here / "0.film").read_bytes()[:-5])
expect_refusals([([*films, "-o", "a.png"], 1, words) for films, words in [
    (["bad.film"], "cut short or damaged"), (["whole.png"], "not a film"),
    (["part.film", "0.film"], "part is")]], "merge")

# Far away: the picture is that of the same tetrahedron about 0, seen from the same place.
def tetrahedron(name, at):
    corners = [(-1.87, -1.73, -2), (2.13, -1.73, -2), (-1.87, 2.27, -2), (-1.87, -1.73, 2)]
    write_ply(name, [f"{at[0] + x:.2f} {at[1] + y:.2f} {at[2] + z:.2f}" for x, y, z in corners],
              [(0, 2, 1), (0, 1, 3), (0, 3, 2), (1, 2, 3)], "double")
    place = [[str(o + c) for o, c in zip(at, corner, strict=True)] for corner in [(7.13, 5.26, 8), (0.13, 0.26, 0)]]
    return run(name, "--height", "24", "--spp", "2", "--look-from", *place[0], "--look-at", *place[1], "--accel", "sw", "--json", "far.jsonl",
               "-o", name + ".png")


shown = tetrahedron("far.ply", (500000, 5400000, 2))
assert shown.count("scene moved to local origin 500000 5400000 2\n") == 1, shown
assert "moved" not in tetrahedron("near.ply", (0, 0, 0)) and same("far.ply.png", "near.ply.png")
assert [record["origin"] for record in records("far.jsonl")] == [[500000, 5400000, 2], [0, 0, 0]]

# A light that no path can reach.
corners = base64.b64encode(struct.pack("<9f", 0, 0, 0, 1, 0, 0, 0, 1, 0)).decode()
(here / "stopped.gltf").write_text(json.dumps({
    "asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}],
    "extensionsUsed": ["KHR_lights_punctual", "KHR_materials_transmission"],
    "extensions": {"KHR_lights_punctual": {"lights": [{"type": "point", "name": "bulb"}]}},
    "nodes": [{"mesh": 0}, {"extensions": {"KHR_lights_punctual": {"light": 0}}, "translation": [0, 0, 3]}],
    "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]}],
    "materials": [{"name": "frosted", "pbrMetallicRoughness": {"roughnessFactor": 0.5, "metallicFactor": 0},
                   "extensions": {"KHR_materials_transmission": {"transmissionFactor": 1}}}],
    "buffers": [{"uri": "data:application/octet-stream;base64," + corners, "byteLength": 36}],
    "bufferViews": [{"buffer": 0, "byteLength": 36}],
    "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0],
                   "max": [1, 1, 0]}]}))
small = ["stopped.gltf", "--height", "8", "--spp", "1", "--accel", "sw", "-o", "stopped.png"]
assert "light of 'bulb' cannot pass material 'frosted'" in run(*small)
assert "cannot pass" in run(*small, "--strict", status=1)
assert "cannot pass" not in run(*small, "--quiet")

# The window is another program's: the one beside this, else the one in PATH.
alone = here / "alone"
alone.mkdir()
shutil.copy(path_tracer, alone / "path_tracer")
(alone / "bin").mkdir()
(alone / "bin/twinray").write_text('#!/bin/sh\necho "$@"\n')
(alone / "bin/twinray").chmod(0o755)


def view(*arguments, path):
    return subprocess.run([alone / "path_tracer", *arguments, "--view"], capture_output=True, text=True,
                          env=os.environ | {"PATH": str(path) + ":/usr/bin:/bin"})


done = view("a.glb", "--accel", "hw", "--look-from", "1", "2", "3", "--look-at", "0", "0", "0", path=alone / "bin")
assert done.stdout == "view a.glb --layer path --show hw --camera 1 2 3 0 0 0 --up 0 1 0 --fov 40\n", done
assert "the command twinray is neither" in view("a.glb", path="/nowhere").stderr
assert "is not a file" in view("builtin:cornell-box", path=alone / "bin").stderr
assert "--output is required" in run("a.glb", status=2)
print("path_tracer_command_test: passed")
