#!/usr/bin/env python3
"""Writes the inputs that fuzzing begins with, a folder for each target: make_seeds.py FOLDER

They are small files of $TWINRAY_ASSETS, of ../shared/assets and ../shared/cases (whose make.py write them), of
Debian's assimp-testmodels and of this repository, as far as these are there, and some that are made here."""

import base64
import gzip
import os
import pathlib
import random
import shutil
import struct
import subprocess
import sys
import tempfile
import zlib

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
MOST_BYTES = 1 << 16
TARGET_OF = {f".{target}": target for target in ("gltf", "ply", "stl", "hdr", "exr", "csv")}
TARGET_OF |= {".glb": "gltf", ".png": "image", ".jpg": "image", ".jpeg": "image", ".npy": "rays", ".gz": "encodings"}
COMMAND_LINES = [
    "a.ply --accel sw --levels=watertight,fast --count 7 --up -1 -.5 1e-3 --within +2.5 --quiet",
    "-o here a.ply --picture 1.png --growth 1e3,5",
    "a.ply --rays 3 --growth",
    "--help",
]
EVENTS = "# a comment\nkey F2\nkeyup A\ndown left 320 200 shift\nmove 330 210\nup left\ndouble 320 200\nscroll -1.5\n"
EVENTS += "resize 800 600\ndrop a file.ply\nframes 10\nshot a.png\nclose\n"
FIGURE = '{"metric":"t_ulp","median":0.5,"p99":"inf","p99_95":[1,2],"max":"nan","floor":0}'
TIME = '{"metric":"ns","median":1,"median_95":[1,2],"mad":0,"min":1,"reps":3,"build_ms":2.5}'
RECORD = (
    '{"schema":"twinray-report/1","run":"r","git":"g","device":{"name":"n","driver":"d","api":"1","probe":{"a":true}},'
    '"case":"W04","params":{"x":1.5},"backend":"sw","level":"fast","variant":"","reference":"f64","n":3,"seed":1,'
    '"counts":{"AGREE":3},"results":{"y":"kept"},"error":%s,"faults":0,"bound95":null,"time":%s,"pass":true,'
    '"criterion":"c","fault_of":"","status":"run","reason":"","example":"","replay":""}\n' % (FIGURE, TIME)
)
HIT = '{"instance":0,"primitive":1,"t":"0x1p+1","u":"0x1p-2","v":"0x0p+0"}'
REPLAY = (
    '{"schema":"twinray-replay/1","scene":"a.glb","scene_hash":"0","backend":"sw","level":"fast","class":"T_ERR",'
    '"ray":{"origin":["0x0p+0","0x0p+0","0x1p+0"],"direction":["0x0p+0","0x0p+0","-0x1p+0"],"t_min":"0x0p+0",'
    '"t_max":"inf"},"answer":%s,"reference":null,"device":"d","driver":"e","twinray":"f"}' % HIT
)
STATE = '{"schema":"twinray-leaks/1","seed":1,"rays":5,"leaks":0,"double_hits":0,"unspecified":0,"seconds":0.5}'


class Seeds:
    def __init__(self, folder):
        self.folder = folder
        self.count = 0

    def add(self, target, name, data):
        if 0 < len(data) <= MOST_BYTES:
            place = self.folder / target
            place.mkdir(parents=True, exist_ok=True)
            (place / f"{self.count:04}_{name}").write_bytes(data)
            self.count += 1

    def add_file(self, file):
        suffix = file.suffix.lower()
        if file.stat().st_size > MOST_BYTES:
            return
        if suffix == ".obj":
            libraries = [line.split(None, 1)[1].strip() for line in lines_of(file) if line.startswith("mtllib ")]
            materials = [file.parent / name for name in libraries if (file.parent / name).is_file()]
            body = file.read_bytes().replace(b"\r\n", b"\n")
            for name in libraries:
                body = body.replace(f"mtllib {name}".encode(), b"mtllib input.mtl")
            self.add("obj", file.name, body + b"\n#mtl\n" + b"\n".join(m.read_bytes() for m in materials))
        elif suffix in TARGET_OF:
            self.add(TARGET_OF[suffix], file.name, file.read_bytes())

    def add_tree(self, folder):
        for file in sorted(folder.rglob("*")) if folder.is_dir() else []:
            if file.is_file():
                self.add_file(file)


def lines_of(file):
    with file.open(encoding="utf-8", errors="replace") as text:
        return list(text)


def add_cases(seeds, cases):
    for script in sorted(cases.glob("*/make.py")):
        with tempfile.TemporaryDirectory() as folder:
            subprocess.run([sys.executable, "-B", script, folder], capture_output=True, check=False, timeout=60)
            seeds.add_tree(pathlib.Path(folder))


def film():
    pixels = struct.pack("<2I16I", 1, 0, *range(16)) * 2
    text = b"seed: 1\nlevel: fast\n"
    head = b"twinray film 1\n\0" + struct.pack("<6I", 2, 1, 4, len(text), 1, zlib.crc32(text))
    body = head + text + struct.pack("<I", 1) + pixels
    return body + struct.pack("<I", zlib.crc32(body))


def row(group, targets):
    estimates = struct.pack("<6d", 0.5, 0.4, 0.6, 0, 0, 0)
    factors = b"".join(struct.pack("<I3fI", target, 0.25, 0.2, 0.3, 0) for target in targets)
    body = struct.pack("<2I2Q", group, len(targets), 100, 90)[:24] + estimates + factors
    return body + struct.pack("<I", zlib.crc32(body))


def npy(kind, count):
    header = f"{{'descr': '<{kind}', 'fortran_order': False, 'shape': ({count}, 8), }}".ljust(117) + "\n"
    numbers = struct.pack(f"<{8 * count}{'d' if kind == 'f8' else 'f'}", *range(8 * count))
    return b"\x93NUMPY\1\0" + struct.pack("<H", len(header)) + header.encode() + numbers


def add_made_here(seeds):
    for i, line in enumerate(COMMAND_LINES):
        seeds.add("command", f"line{i}", line.replace(" ", "\n").encode())
    seeds.add("events", "all.txt", EVENTS.encode())
    for name, text in {"record": RECORD + "\n" + RECORD, "replay": REPLAY, "state": STATE}.items():
        seeds.add("json", name, text.encode())
    limits = lines_of(ROOT / "tests/kernel_limits.json")
    seeds.add("json", "limits", "".join(limits[:4]).encode())
    seeds.add("film", "two_pixels", film())
    seeds.add("rows", "two", row(0, [1, 2]) + row(1, []))
    seeds.add("rays", "float64", npy("f8", 2))
    seeds.add("rays", "float32", npy("f4", 3))
    seeds.add("rays", "raw", struct.pack("<16f", *range(16)))
    seeds.add("csv", "rays", b"x,y,z,dx,dy,dz\n0,0,1,0,0,-1\n1;2,5;3;4;5;6 # seven\n")
    seeds.add("csv", "groups", b"face,group\n" + b"".join(b"%d,%d\n" % (face, face // 2) for face in range(12)))
    seeds.add("csv", "sun", b"x,y,z,hours\r\n0 -1 0 1.5\r\n+1e-3 -.5 0 2\r\n")
    seeds.add("encodings", "text.gz", gzip.compress(b"twinray " * 50, mtime=0))
    seeds.add("encodings", "base64", base64.b64encode(bytes(range(64))) + b"%20")
    generator = random.Random(1)
    for size in (16, 64, 128, 256, 256, 512, 512, 1024):
        seeds.add("accel", f"history{size}", generator.randbytes(size))


def main(folder):
    shutil.rmtree(folder, ignore_errors=True)
    seeds = Seeds(folder)
    shared = ROOT.parent / "shared"
    assets = os.environ.get("TWINRAY_ASSETS") or shared / "assets"
    seeds.add_tree(pathlib.Path(assets))
    add_cases(seeds, shared / "cases")
    for kind in ("glTF2", "OBJ", "PLY", "STL"):
        seeds.add_tree(pathlib.Path("/usr/share/assimp/models") / kind)
    seeds.add_tree(ROOT / "tests/samples/peers")
    add_made_here(seeds)
    for file in sorted((HERE / "seeds").iterdir()) + sorted((HERE / "found").iterdir()):
        target, _, name = file.name.partition("-")
        seeds.add(target, name, file.read_bytes())
    print(f"{seeds.count} inputs in {folder}")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit(__doc__)
    main(pathlib.Path(sys.argv[1]))
