#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Three spheres one behind the other and rays along them, with what they meet.
Usage: hit_tests.py TWINRAY PICTURE..."""
import math
import pathlib
import subprocess
import sys
import tempfile

AROUND, DOWN = 48, 24


def sphere(name, z, first):
    """Lines of an OBJ: a sphere of radius 1 about (0, 0, z), whose vertices count from `first`."""
    lines = [f"o {name}"]
    for j in range(DOWN + 1):
        for i in range(AROUND):
            polar, turn = math.pi * j / DOWN, 2 * math.pi * i / AROUND
            x, y = math.sin(polar) * math.cos(turn), math.cos(polar)
            lines.append(f"v {x:.7f} {y:.7f} {z + math.sin(polar) * math.sin(turn):.7f}")
    for j in range(DOWN):
        for i in range(AROUND):
            a, b = first + j * AROUND + i, first + j * AROUND + (i + 1) % AROUND
            lines += [f"f {a} {b} {a + AROUND}", f"f {b} {b + AROUND} {a + AROUND}"]
    return lines


twinray, pictures, here = sys.argv[1], sys.argv[2:], pathlib.Path(tempfile.mkdtemp())
spheres = [sphere(f"sphere_{n}", 2 * n + 1, n * AROUND * (DOWN + 1) + 1) for n in range(3)]
(here / "spheres.obj").write_text("\n".join(line for lines in spheres for line in lines))
(here / "rays.csv").write_text("x,y,z,dx,dy,dz\n"
                               "0.05,0.1,-2,0,0,1\n"      # the first sphere, head on
                               "-0.6,0.5,-2,0,0,1\n"      # the same, aside
                               "2.0,0.3,-2,-0.25,0,1\n"   # past the first, into the second
                               "-1.6,-0.3,-2,0.1,0,1\n"   # and into the third
                               "1.6,-0.4,-2,0.05,0,1\n")  # past all
subprocess.run([twinray, "trace", here / "spheres.obj", "--rays", here / "rays.csv", "--hits", here / "hits.csv",
                *(word for picture in pictures for word in ("--picture", picture)), "--view", "1", "-0.6", "0.5",
                "--labels"], check=True)
print((here / "hits.csv").read_text(), end="")
