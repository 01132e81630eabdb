#!/usr/bin/env python3
"""The hits of SwTlas are the same bytes whatever a CPU driver computes with. Usage: same_bytes_test.py TWINRAY

Vectors of 128, 256 and 512 bits where the driver takes any width (lavapipe below Mesa 26), and one thread or two.
"""
import pathlib
import random
import struct
import sys

sys.path.insert(0, str(pathlib.Path(__file__).resolve().parents[1] / "support"))
import command
from command import here

RAYS = 20_000


def run(*arguments, env=None):
    return command.run(*arguments, env={"MESA_SHADER_CACHE_DISABLE": "true", **(env or {})})


draw = random.Random(1)
with (here / "soup.obj").open("w") as file:
    for _ in range(2000):
        middle = [draw.uniform(-1, 1) for _ in range(3)]
        for _ in range(3):
            file.write("v " + " ".join(str(x + draw.uniform(-0.1, 0.1)) for x in middle) + "\n")
        file.write("f -3 -2 -1\n")
numbers = [[*(draw.uniform(-2, 2) for _ in range(3)), 0, *(draw.uniform(-1, 1) for _ in range(3)), 1e30]
           for _ in range(RAYS)]
(here / "rays").write_bytes(b"".join(struct.pack("<8f", *ray) for ray in numbers))

devices = run("devices")
if "llvmpipe" not in devices:
    print("skipped: there is no lavapipe")
    sys.exit(77)
mesa = float(devices.split("llvmpipe Mesa ")[1].split("-")[0].rsplit(".", 1)[0])
flags = pathlib.Path("/proc/cpuinfo").read_text()
widths = [None] if mesa >= 26 else [128, 256] + [512] * ("avx512vl" in flags)
found = {}
for level in ("watertight", "refined"):
    for width in widths:
        for threads in (1, 2):
            env = {"LP_NUM_THREADS": str(threads), **({"LP_NATIVE_VECTOR_WIDTH": str(width)} if width else {})}
            run("trace", "soup.obj", "--rays", "rays", "--hits", "hits", "--accel", "sw", "--level", level,
                "--device", "llvmpipe", "--pipelines", "", env=env)
            found[level, width, threads] = (here / "hits").read_bytes()
    first = found[level, widths[0], 1]
    hits = sum(struct.unpack_from("<I", first, 32 * i)[0] for i in range(RAYS))
    assert len(first) == 32 * RAYS and RAYS // 10 < hits < RAYS, hits
    different = [key for key, value in found.items() if key[0] == level and value != first]
    assert not different, f"other bytes than {level}, {widths[0]} bits, 1 thread: {different}"
assert found["watertight", widths[0], 1] != found["refined", widths[0], 1], "the comparison sees no difference"
print(f"the same bytes on Mesa {mesa}: {sorted(found, key=str)}")
