#!/usr/bin/env python3
"""Pictures of `twinray` commands, as a user asks for them. Usage: picture_command_test.py TWINRAY"""
import json
import pathlib
import struct
import sys
import zlib

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[2] / "support"))
from command import expect_refusals, here, run, same, write_ply

small = ["--picture-size", "80", "60"]


def png(name):
    """Rows of (r, g, b) of a PNG with 8 bits a channel."""
    data, at, packed = (here / name).read_bytes(), 8, b""
    width, height, depth, kind = struct.unpack(">IIBB", data[16:26])
    assert data[:8] == b"\x89PNG\r\n\x1a\n" and (depth, kind) == (8, 2), name
    while at < len(data):
        length, what = struct.unpack(">I4s", data[at:at + 8])
        packed += data[at + 8:at + 8 + length] if what == b"IDAT" else b""
        at += 12 + length
    raw, stride, rows = zlib.decompress(packed), 3 * width, [bytearray(3 * width)]
    for y in range(height):
        filtered, row, above = raw[y * (stride + 1)], bytearray(raw[y * (stride + 1) + 1:(y + 1) * (stride + 1)]), rows[-1]
        for i in range(stride):
            a, b, c = row[i - 3] if i > 2 else 0, above[i], above[i - 3] if i > 2 else 0
            paeth = min((abs(b - c), 0, a), (abs(a - c), 1, b), (abs(a + b - 2 * c), 2, c))[2]
            row[i] = (row[i] + (0, a, b, (a + b) // 2, paeth)[filtered]) % 256
        rows.append(row)
    return [[tuple(row[i:i + 3]) for i in range(0, stride, 3)] for row in rows[1:]]


def colors(name):
    return {pixel for row in png(name) for pixel in row}


def colors_of_scene(name):
    """Of the pixels of the scene: from (18, 66) on, under title and subtitle."""
    return [pixel for row in png(name)[66:126] for pixel in row[18:98]]


def glb(name):
    data = (here / name).read_bytes()
    return json.loads(data[20:20 + struct.unpack("<I", data[12:16])[0]])


# Two unit squares that face +z: the right one is tilted about its lower edge by 60 degrees away from light along -z.
half, tilt = 0.5, 0.8660254
corners = [(0, 0, 0), (1, 0, 0), (1, 1, 0), (0, 1, 0), (2, 0, 0), (3, 0, 0), (3, half, -tilt), (2, half, -tilt)]
write_ply("pair.ply", corners, [(0, 1, 2), (0, 2, 3), (4, 5, 6), (4, 6, 7)])
light = ["illumination", "pair.ply", "--direction", "0", "0", "-1", "--measure", "irradiance", "--grid", "300", "--quiet"]

# Full light is yellow; a cosine of 1/2 is the green blue of the middle of the map, three quarters as bright.
for accel in ["sw", "hw"]:
    run(*light, "--accel", accel, "--validation", "--picture", f"{accel}.png", "--picture", f"{accel}.glb", "--view", "0", "0", "-1", *small)
rows = png("sw.png")[66:126]
left, right = rows[30][18 + 10], rows[36][18 + 68]
assert left[0] > 240 and left[1] > 215 and left[2] < 70, left
assert right[0] < 70 and 100 < right[1] < 140 and 90 < right[2] < 140, right
assert same("sw.png", "hw.png") and same("sw.glb", "hw.glb")
scene = glb("sw.glb")
assert [n["mesh"] for n in scene["nodes"]] == [0] and "COLOR_0" in scene["meshes"][0]["primitives"][0]["attributes"], scene
assert "4 faces" in run("centroid", "sw.glb", "--direction", "0", "0", "-1", "--grid", "9")
assert {(253, 231, 37), (68, 1, 84)} <= colors("sw.png")  # the whole scale, however small the picture

# The sky and the sun, by their own scales.
(here / "sun.csv").write_text("0,0,-1,2\n")
run("illumination", "pair.ply", "--sky", "16", "--picture", "sky.png", "--color-scale", "log", "--quiet", *small)
run("illumination", "pair.ply", "--sun", "sun.csv", "--picture", "sun.png", "--cutaway", "--quiet", *small)
assert not same("sky.png", "sun.png")

run("centroid", "pair.ply", "--direction", "0", "0", "-1", "--grid", "40", "--picture", "centroid.png", "--quiet", *small)
assert {(213, 94, 0), (0, 114, 178)} <= set(colors_of_scene("centroid.png"))

# Three triangles: the second pierces the first, the third touches nothing.
points = ["0 0 0", "4 0 0", "0 4 0", "1 1 -1", "1 1 1", "3 1 -1", "5 0 0", "6 0 0", "5 1 0"]
write_ply("soup.ply", points, [(0, 1, 2), (3, 4, 5), (6, 7, 8)])
run("collide", "soup.ply", "--self", "--picture", "contacts.png", "--picture", "contacts.glb", "--view", "0", "0", "-1", "--quiet", *small)
for color in [(213, 94, 0), (205, 208, 213), (30, 30, 30)]:  # crossing, no contact, where they meet
    assert any(max(abs(a - b) for a, b in zip(color, pixel)) < 8 for pixel in colors_of_scene("contacts.png")), color
run("collide", "soup.ply", "--broad", "--picture", "broad.png", "--quiet", *small)
assert (68, 1, 84) in colors("broad.png")

run("viewfactors", "pair.ply", "--rays-per-row", "1024", "--picture", "open.png", "--matrix", "matrix.png", "--quiet", *small)
assert struct.unpack(">II", (here / "matrix.png").read_bytes()[16:24]) > (900, 900) and len(colors("open.png")) > 1
run("viewfactors", "pair.ply", "--rays-per-row", "1024", "--by", "mesh", "--picture", "from.png", "--from", "0", "--quiet", *small)
assert (213, 94, 0) in colors("from.png")

# Rays down onto both squares, one from behind, one that misses: their colours, the marks of the .glb, the words of the
# .html.
(here / "rays.csv").write_text("0.5,0.5,3,0,0,-1\n2.5,0.25,3,0,0,-1\n0.25,0.25,-2,0,0,1\n5,5,3,0,0,-1\n")
for accel in ["sw", "hw"]:
    files = [word for suffix in ["png", "html", "glb"] for word in ("--picture", f"rays_{accel}.{suffix}")]
    run("trace", "pair.ply", "--rays", "rays.csv", "--hits", "hits.npy", "--accel", accel, "--validation",
        "--hit-color", "facing", "--labels", *files, "--quiet", "--picture-size", "160", "120")
    seen = colors(f"rays_{accel}.png")
    assert {(0, 114, 178), (213, 94, 0), (150, 150, 150)} <= seen, seen
    scene = glb(f"rays_{accel}.glb")
    modes = {scene["meshes"][node["mesh"]]["primitives"][0].get("mode", 4): node["mesh"] for node in scene["nodes"]}
    assert set(modes) == {0, 1, 4}, modes  # points, lines, triangles
    of_mode = lambda mode: scene["meshes"][modes[mode]]["primitives"][0]["attributes"]["POSITION"]
    count = lambda mode: scene["accessors"][of_mode(mode)]["count"]
    assert (count(0), count(1)) == (7, 8), (count(0), count(1))
    page = (here / f"rays_{accel}.html").read_text()
    assert page.count("<circle") == 3 and "<script" not in page, page[:500]
    assert "ray 2: t 2" in page and "triangle 2" in page, page[:500]
assert same("rays_sw.png", "rays_hw.png")
hits = (here / "hits.npy").read_bytes()
assert hits[:8] == b"\x93NUMPY\x01\x00" and (10 + struct.unpack("<H", hits[8:10])[0]) % 64 == 0
assert len(hits) == 10 + struct.unpack("<H", hits[8:10])[0] + 4 * 32
run("trace", "pair.ply", "--rays", "rays.csv", "--hits", "hits.csv", "--cull", "back", "--quiet")
assert [line.split(",")[0] for line in (here / "hits.csv").read_text().splitlines()] == ["hit", "1", "1", "0", "0"]
run("trace", "pair.ply", "--rays", "rays.csv", "--hits", "hits", "--picture", "near.png",
    "--camera", "0.5", "0.5", "2", "0.5", "0.5", "0", "--quiet", *small)

expect_refusals([
        ([*light, "--picture", "a.jpg"], 2, "--picture is 'a.jpg', but must be a file whose name ends in .png, .html or .glb"),
        ([*light, "--picture", "none/a.png"], 1, "there is no folder 'none'"),
        ([*light, "--view", "0", "0", "1"], 2, "--view requires --picture"),
        ([*light, "--picture", "a.png", "--camera", "0", "0", "1", "0", "0", "1"], 1, "the two must differ"),
        (["trace", "pair.ply", "--rays", "rays.csv", "--hits", "h", "--query", "all", "--counts", "c",
          "--picture", "a.png"], 2, "--picture shows one hit per ray"),
        ([*light, "--picture", "a.png", "--view", "0", "0", "0"], 1, "must be finite and not 0"),
        ([*light, "--picture", "a.png", "--picture-size", "1", "1"], 2, "--picture-size is '1', but must be a whole number from 16 to 16384"),
        (["viewfactors", "pair.ply", "--matrix", "a.npz"], 2, "--matrix is 'a.npz', but must be a file whose name ends in .png"),
        (["viewfactors", "pair.ply", "--picture", "a.png", "--from", "4"], 1, "--from 4: there are 4 rows")])
assert not (here / "a.png").exists()
print("pictures: colours are those of the values, for either accelerator")
