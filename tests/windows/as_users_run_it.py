#!/usr/bin/env python3
"""Runs the programs for Windows by Wine as a user does: names with letters beyond ASCII, with spaces and of more than
260 letters, exit statuses, Ctrl-C, a window.
Usage: as_users_run_it.py WINDOWS_BIN SCREEN PICTURE; SCREEN is the file that Xvfb -fbdir keeps its screen in, and
PICTURE the PNG that the window is written to."""
import pathlib
import signal
import struct
import subprocess
import sys
import tempfile
import time
import zlib

windows, screen, picture = (pathlib.Path(name).resolve() for name in sys.argv[1:4])
held = tempfile.TemporaryDirectory(prefix="twinray-users-")  # as long as this program
here = pathlib.Path(held.name)
folder = here / "Größe und Höhe"
BOX = ("".join(f"v {x} {y} {z}\n" for x in (0, 1) for y in (0, 1) for z in (0, 1)) +
       "f 1 2 4 3\nf 5 7 8 6\nf 1 5 6 2\nf 3 4 8 7\nf 1 3 7 5\nf 2 6 8 4\n")


def words(program, arguments):
    return ["wine", str(windows / f"{program}.exe"), *map(str, arguments)]


def run(program, *arguments, status=0, folder=folder):
    done = subprocess.run(words(program, arguments), capture_output=True, text=True, cwd=folder)
    assert done.returncode == status, f"{program} {arguments}: {done.returncode}\n{done.stdout}{done.stderr}"
    return done.stdout + done.stderr


def names():
    folder.mkdir()
    (folder / "käfig 1.obj").write_text(BOX)
    (folder / "ends of lines.obj").write_bytes(BOX.replace("\n", "\r\n").encode())
    deep = folder
    while len(str(deep)) < 300:
        deep = deep / ("a deep folder " * 4 + "ü")
        deep.mkdir()
    (deep / "käfig.obj").write_text(BOX)
    factors = {}
    for scene in (folder / "käfig 1.obj", folder / "ends of lines.obj", deep / "käfig.obj"):
        table = scene.with_suffix(".csv")
        run("twinray", "viewfactors", scene, "--rays-per-row", "1000", "--sides", "both", "--quiet", "-o", table)
        factors[scene] = table.read_bytes()
    table = folder / "aus Stücken.csv"
    for part in ("--shard=0/2", "--shard=1/2", "--merge=2"):
        run("twinray", "viewfactors", folder / "käfig 1.obj", "--rays-per-row", "1000", "--sides", "both", "--quiet",
            "-o", table, part)
    factors[table] = table.read_bytes()
    assert len(set(factors.values())) == 1, {str(name): len(data) for name, data in factors.items()}
    run("path_tracer", "builtin:cornell-box", "-o", deep / "Bild.png", "--width", "16", "--height", "16", "--spp", "1",
        "--quiet")
    assert (deep / "Bild.png").read_bytes().startswith(b"\x89PNG")
    said = run("twinray", "viewfactors", "fehlt ä.obj", "-o", "x.csv", status=1)
    assert "fehlt ä.obj" in said, said
    print(f"names: {len(factors)} files, of up to {max(len(str(name)) for name in factors)} letters")


def statuses():
    run("twinray", "--version")
    run("twinray", "devices")
    assert "there is no command" in run("twinray", "nothing", status=2)
    assert "--nothing" in run("twinray", "devices", "--nothing", status=2)
    print("statuses: 0, 1 and 2 as on Linux")


def ctrl_c():
    """A run that Ctrl-C ends goes on from its file."""
    command = ["leaks", "käfig 1.obj", "--state", "state.json", "--ray-count"]
    process = subprocess.Popen(words("twinray", [*command, "1e10"]), stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
                               text=True, cwd=folder)
    state = folder / "state.json"
    for _ in range(600):
        if state.exists() and state.stat().st_size > 0:
            break
        time.sleep(0.1)
    time.sleep(2)
    process.send_signal(signal.SIGINT)
    said, _ = process.communicate(timeout=20)
    assert process.returncode not in (0, 1, 2), f"{process.returncode}\n{said}"
    assert [name.name for name in folder.iterdir() if name.name.startswith("state")] == ["state.json"]
    rays = run("twinray", *command, "1")
    assert "continues after" in rays, rays
    print(f"Ctrl-C: status {process.returncode}; {rays.splitlines()[1].strip()}")


def pixels(file):
    """Width, and rows of RGB bytes of a screen of Xvfb: a file of xwd of 32 bits a pixel."""
    data = file.read_bytes()
    header = struct.unpack(">25I", data[:100])
    size, width, height, row_bytes, colors = header[0], header[4], header[5], header[12], header[19]
    assert header[1] == 7 and header[11] == 32 and header[7] == 0, header
    start = size + 12 * colors
    rows = []
    for y in range(height):
        row, blue_green_red = bytearray(3 * width), data[start + y * row_bytes:start + y * row_bytes + 4 * width]
        for channel in range(3):
            row[channel::3] = blue_green_red[2 - channel::4]
        rows.append(bytes(row))
    return width, rows


def write_png(file, width, rows):
    def chunk(kind, data):
        return struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    lines = zlib.compress(b"".join(b"\0" + row for row in rows))
    header = chunk(b"IHDR", struct.pack(">IIBBBBB", width, len(rows), 8, 2, 0, 0, 0))
    file.write_bytes(b"\x89PNG\r\n\x1a\n" + header + chunk(b"IDAT", lines) + chunk(b"IEND", b""))


def window():
    """A window stays open and shows a scene until it is closed."""
    (folder / "Sitzung.txt").write_text("frames 4\nshot Bild vom Fenster.png\nframes 100000\n")
    view = ["view", "käfig 1.obj", "--size", "800", "500", "--play", "Sitzung.txt"]
    process = subprocess.Popen(
        words("twinray", view), stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, cwd=folder)
    shot = folder / "Bild vom Fenster.png"
    for _ in range(1200):
        if shot.exists() or process.poll() is not None:
            break
        time.sleep(0.1)
    time.sleep(2)
    assert process.poll() is None, f"{process.returncode}: {process.communicate()[0]}"
    width, rows = pixels(screen)
    process.send_signal(signal.SIGINT)
    process.communicate(timeout=20)
    write_png(picture, width, rows)
    colors = {row[i:i + 3] for row in rows for i in range(0, len(row), 3)}
    assert shot.exists() and len(colors) > 20, f"{len(colors)} colours on the screen; see {picture}"
    print(f"window: {len(colors)} colours on the screen, see {picture}")


for check in (names, statuses, ctrl_c, window):
    check()
