#!/usr/bin/env python3
"""Runs `twinray view` as a user does. Usage: view_command_test.py TWINRAY [--record]; the latter writes the stored
pictures."""
import functools
import json
import math
import os
import pathlib
import shutil
import subprocess
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import command
from command import here, program as twinray

run = functools.partial(command.run, "view")
pictures = pathlib.Path(__file__).resolve().parent / "pictures"
is_recording = "--record" in sys.argv
required = os.environ.get("TWINRAY_REQUIRE", "").split(",")


def scene(name):
    """A ball, a slanted plate that cuts it, and a floor, as meshes of their own."""
    vertices, faces, lines = [], [], []

    def add(what, corners, triangles):
        lines.append(f"o {what}")
        lines.extend(f"v {x:.6f} {y:.6f} {z:.6f}" for x, y, z in corners)
        lines.extend("f " + " ".join(str(len(vertices) + i + 1) for i in t) for t in triangles)
        vertices.extend(corners)
        faces.extend(triangles)

    n, m = 24, 12
    ball = [(math.sin(math.pi * j / m) * math.cos(2 * math.pi * i / n), math.cos(math.pi * j / m),
             math.sin(math.pi * j / m) * math.sin(2 * math.pi * i / n)) for j in range(m + 1) for i in range(n)]
    quads = [(j * n + i, j * n + (i + 1) % n, (j + 1) * n + (i + 1) % n, (j + 1) * n + i)
             for j in range(m) for i in range(n)]
    add("ball", ball, [t for a, b, c, d in quads for t in ((a, b, c), (a, c, d))])
    add("plate", [(-1.5, -0.9, -1), (1.5, -0.2, -1), (1.5, -0.2, 1.5), (-1.5, -0.9, 1.5)], [(0, 2, 1), (0, 3, 2)])
    add("floor", [(-4, -1, -4), (4, -1, -4), (4, -1, 4), (-4, -1, 4)], [(0, 2, 1), (0, 3, 2)])
    (here / name).write_text("\n".join(lines) + "\n")


CAMERA = ["--camera", "2.5", "1.5", "4", "0", "-0.3", "0", "--size", "160", "90"]
# These views are alike on both accelerators.
BOOKMARKS = {
    "eyelight": ["--layer", "eyelight"],
    "uv": ["--layer", "uv"],
    "normal": ["--layer", "normal", "--orthographic"],
    "geometry": ["--layer", "geometry"],
    "primitive": ["--layer", "primitive", "--pick", "80", "40"],
    "depth": ["--layer", "depth", "--tree-depth", "3"],
    "areas": ["--layer", "eyelight", "--tree-depth", "5", "--tree-areas"],
    "distance": ["--layer", "distance"],
    "light": ["--layer", "light", "--hour", "9"],
    "collisions": ["--layer", "collisions"],
    "path": ["--layer", "path", "--spp", "64"],
}
# These views show both at once, or the software tree alone.
OTHERS = {
    "wipe": ["--layer", "normal", "--show", "wipe"],
    "difference": ["--show", "difference"],
    "steps": ["--layer", "steps"],
    "factors": ["--layer", "factors", "--pick", "80", "70"],
}
scene("scene.obj")


def compared(name, *options, status=0):
    return run("scene.obj", *CAMERA, *options, "--quiet", "--reference", pictures / f"{name}.png", "--threshold", "2",
               "--screenshot", f"{name}-unlike.png", status=status)


if is_recording:
    pictures.mkdir(exist_ok=True)
    for name, options in (BOOKMARKS | OTHERS).items():
        run("scene.obj", *CAMERA, *options, "--quiet", "--screenshot", pictures / f"{name}.png")
    sys.exit()

lacks = subprocess.run([twinray, "view", "scene.obj", *CAMERA, "--show", "hw", "--screenshot", "hw.png"], cwd=here,
                       capture_output=True, text=True)
has_hardware = lacks.returncode == 0
assert has_hardware or "no hardware accelerator" in lacks.stderr, lacks.stderr
assert has_hardware or "ray_tracing" not in required, lacks.stderr
for name, options in BOOKMARKS.items():
    for show in ["sw", "hw"] if has_hardware else ["sw"]:
        compared(name, *options, "--show", show, "--validation")
        assert not (here / f"{name}-unlike.png").exists()
for name, options in OTHERS.items():
    if has_hardware or name in ("steps", "factors"):
        compared(name, *options)

# A broken picture is detected, and the picture is written only then.
assert "differs" in compared("steps", "--layer", "depth", status=1)
assert (here / "steps-unlike.png").exists()
compared("geometry", "--layer", "primitive", status=1)
if has_hardware:
    compared("wipe", "--layer", "normal", "--show", "wipe", "--wipe", "0.45", status=1)
    compared("difference", "--layer", "eyelight", status=1)

# Frames, figures and the report on a ray.
said = run("scene.obj", *CAMERA, "--layer", "path", "--headless", "3", "-o", "frames", "--json", "view.jsonl",
           "--pick", "80", "40")
assert sorted(p.name for p in (here / "frames").iterdir()) == ["frame0.png", "frame1.png", "frame2.png"]
record = json.loads((here / "view.jsonl").read_text())
assert (record["schema"], record["frames"], record["samples"]) == ("twinray-view/1", 3, 3), record
assert "software: t " in said and "float64: t " in said and "exactly: hit" in said, said

# Events are played.
(here / "events.txt").write_text("key F5\nframes 2\ndown left 80 45\nmove 100 45\nup left\nframes 2\nshot moved.png\n"
                                 "key C\nkey B\nresize 64 36\nframes 1\nshot small.png\nkey Escape\n")
said = run("scene.obj", *CAMERA, "--play", "events.txt", "-o", "frames", "--screenshot", "last.png", "--json",
           "view.jsonl")
assert (here / "frames/moved.png").exists() and (here / "frames/small.png").exists()
camera = next(line for line in said.splitlines() if line.startswith("--camera"))
bookmark = next(line for line in said.splitlines() if line.startswith("twinray view"))
assert camera.split()[1:7] == bookmark.split()[4:10] and "--layer normal" in bookmark, said
assert len(json.loads((here / "view.jsonl").read_text().splitlines()[-1])["frame_seconds"]) == 5
run("scene.obj", *bookmark.split()[3:], "--quiet", "--reference", "frames/moved.png", "--threshold", "0")

# The values of faces of a layer.
run("scene.obj", *CAMERA, "--layer", "collisions", "--export", "contacts.csv", "--quiet")
lines = (here / "contacts.csv").read_text().splitlines()
classes = {line.split(",")[2] for line in lines[1:]}  # the pole touches the floor
assert lines[0] == "instance,triangle,value" and classes == {"1", "5"}, lines
run("scene.obj", *CAMERA, "--layer", "light", "--export", "light.glb", "--quiet")
assert (here / "light.glb").read_bytes()[:4] == b"glTF"
assert "only the layers" in run("scene.obj", *CAMERA, "--export", "x.csv", status=1)

# Wrong use.
assert "--pick" in run("scene.obj", *CAMERA, "--pick", "160", "1", "--screenshot", "x.png", status=2)
assert "--up" in run("scene.obj", "--up", "1", "0", "0", "--screenshot", "x.png", status=2)
assert "160 x 90" in run("scene.obj", *CAMERA, "--reference", "frames/small.png", "--headless", "1", status=1)
assert "is the point that it looks at" in run("scene.obj", "--camera", *"111111", "--screenshot", "x.png", status=1)
(here / "bad.txt").write_text("key A\nfly\n")
assert "line 2" in run("scene.obj", "--play", "bad.txt", "-o", "frames", status=1)
assert not (here / "x.png").exists()

# The window, on a display of its own.
if not shutil.which("xvfb-run"):
    assert "display" not in required, "there is no xvfb-run"
    print("view.command: the window is not tested: there is no xvfb-run")
    sys.exit()
(here / "session.txt").write_text(
    "frames 2\nkey H\nframes 2\nkey H\ndown left 320 180\nmove 360 180\nframes 1\nmove 400 190\nframes 1\nup left\n"
    "double 320 200\nscroll 1\nframes 2\nkey W\nframes 2\nkey ]\nkey ]\nframes 2\nkey F9\nframes 2\nkey F1\nframes 3\n"
    "resize 500 300\nframes 2\nresize 0 0\nframes 1\nkey R\nframes 2\ndrop nowhere.glb\nframes 1\nshot window.png\n"
    "close\n")
done = subprocess.run(["xvfb-run", "-a", "-s", "-screen 0 1024x768x24", twinray, "view", "scene.obj", "--size", "640",
                       "360", "--validation", "--play", "session.txt", "--record", "recorded.txt"], cwd=here,
                      capture_output=True, text=True)
said = done.stdout + done.stderr
if "built without a window" in said:
    assert "display" not in required, said
    print("view.command: the window is not tested: twinray was built without one")
    sys.exit()
assert done.returncode == 0 and "VUID" not in said, f"status {done.returncode}\n{said}"
assert (here / "window.png").exists()
nothing = subprocess.run([twinray, "view", "scene.obj"], cwd=here, capture_output=True, text=True,
                         env={k: v for k, v in os.environ.items() if k not in ("DISPLAY", "WAYLAND_DISPLAY")})
assert nothing.returncode == 1 and "no display" in nothing.stderr, nothing.stderr
