#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Three rings and a knot that meet in places. Usage: knots_scene.py FILE.gltf"""

import math
import sys

import gltf
import shapes

scene = gltf.Gltf()
scene.node(
    scene.mesh(shapes.tube(shapes.torus_knot(2, 5, 0.8), 0.3, along=240, around=16), scene.material((0.02, 0.2, 0.3)))
)
ring = scene.mesh(
    shapes.tube(shapes.torus_knot(1, 0, 0.36), 0.22, along=64, around=16), scene.material((0.8, 0.45, 0.05))
)
for i in range(3):
    angle = 2 * math.pi * i / 3 + 0.4
    turn = [0.7071 * math.cos(angle), 0.7071 * math.sin(angle), 0, 0.7071]
    scene.node(ring, (1.6 * math.cos(angle), 1.6 * math.sin(angle), 0.1), rotation=turn)
scene.save(sys.argv[1])
