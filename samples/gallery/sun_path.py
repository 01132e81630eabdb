#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Where the sun's rays go from 6 to 18 o'clock of a midsummer day at 48 degrees north, for half an hour
each; y is up and -z is north. Usage: sun_path.py FILE.csv"""

import math
import sys

LATITUDE, TILT = math.radians(48), math.radians(23.44)

with open(sys.argv[1], "w", encoding="utf-8") as file:
    for step in range(24):
        hour = math.radians(15 * (step / 2 + 0.25 - 6))
        up = math.sin(LATITUDE) * math.sin(TILT) + math.cos(LATITUDE) * math.cos(TILT) * math.cos(hour)
        west = math.cos(TILT) * math.sin(hour)
        south = math.sin(LATITUDE) * math.cos(TILT) * math.cos(hour) - math.cos(LATITUDE) * math.sin(TILT)
        file.write(f"{west:.5f},{-up:.5f},{-south:.5f},0.5\n")
