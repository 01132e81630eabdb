#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Light of a studio all around: a warm lamp, a cold one, and a soft glow from above. Usage: studio_sky.py FILE.hdr"""

import math
import sys

WIDTH, HEIGHT = 256, 128
# Middle (longitude and latitude in degrees), half size, radiance.
LAMPS = [((50, 40), (40, 24), (6, 4.8, 3.2)), ((-70, 25), (30, 25), (1.6, 2.2, 3.2)), ((170, 50), (40, 12), (2, 2, 2))]


def radiance(longitude, latitude):
    glow = 0.25 + 0.35 * max(0.0, math.sin(math.radians(latitude)))
    color = [0.9 * glow, 0.95 * glow, 1.1 * glow]
    for (x, y), (w, h), light in LAMPS:
        aside = (longitude - x + 180) % 360 - 180
        if abs(aside) < w and abs(latitude - y) < h:
            color = [c + part for c, part in zip(color, light, strict=True)]
    return color


def rgbe(color):
    """Radiance's pixel: three bytes and a common exponent."""
    exponent = math.frexp(max(color))[1]
    return bytes([*(int(c * 256 / 2.0**exponent) for c in color), exponent + 128])


with open(sys.argv[1], "wb") as file:
    file.write(f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {HEIGHT} +X {WIDTH}\n".encode())
    for row in range(HEIGHT):
        for column in range(WIDTH):
            file.write(rgbe(radiance(360 * (column + 0.5) / WIDTH - 180, 90 - 180 * (row + 0.5) / HEIGHT)))
