#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Fifteen pendulums that swing 25 to 39 times a minute: they start together, and meet again
after it. Usage: pendulums_scene.py FILE.gltf"""

import colorsys
import math
import sys

import gltf
import shapes

COUNT, HEIGHT, SWING, SECONDS, RATE = 15, 2.2, 0.6, 60, 30

scene = gltf.Gltf()
ball, string = shapes.sphere(0.16), shapes.box((-0.012, 0, -0.012), (0.012, 1, 0.012))
times = scene.accessor([i / RATE for i in range(SECONDS * RATE + 1)], "SCALAR")
steel = scene.material((0.05, 0.05, 0.06), roughness=0.6)
samplers, channels = [], []
for i in range(COUNT):
    swings = 25 + i
    length = 9.81 * (SECONDS / swings / (2 * math.pi)) ** 2
    color = colorsys.hsv_to_rgb(0.95 * i / COUNT, 0.85, 0.9)
    glaze = scene.material([c**2.2 for c in color], roughness=0.25)
    hung = scene.node(scene.mesh(ball, glaze), (0, -length, 0))
    line = scene.node(scene.mesh(string, steel), (0, -length, 0), scale=[1, length, 1])
    pivot = scene.added("nodes", {"translation": [0, HEIGHT, 0.32 * (i - (COUNT - 1) / 2)], "children": [hung, line]})
    half = [SWING / 2 * math.cos(2 * math.pi * swings * k / RATE / SECONDS) for k in range(SECONDS * RATE + 1)]
    turns = scene.accessor([(0.0, 0.0, math.sin(a), math.cos(a)) for a in half], "VEC4")
    samplers.append({"input": times, "output": turns})
    channels.append({"sampler": i, "target": {"node": pivot, "path": "rotation"}})
scene.added("animations", {"name": "Swing", "samplers": samplers, "channels": channels})
rail = shapes.box((-0.05, HEIGHT, -2.6), (0.05, HEIGHT + 0.1, 2.6))
scene.node(scene.mesh(rail, steel))
scene.node(scene.mesh(shapes.ground(30), scene.material((0.55, 0.55, 0.57), roughness=0.9)))
scene.save(sys.argv[1])
