#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""A round window of coloured panes, by which the sun comes in. Usage: window_scene.py FILE.gltf"""

import math
import sys

import gltf
import shapes

BLUE, RED, AMBER, GREEN, VIOLET = (
    (0.04, 0.13, 0.9),
    (0.85, 0.03, 0.05),
    (1, 0.5, 0.04),
    (0.05, 0.6, 0.2),
    (0.4, 0.08, 0.8),
)
# Inner and outer radius, number of panes, and their colours, which take turns.
RINGS = [
    (0.0, 0.45, 1, [AMBER]),
    (0.45, 1.0, 8, [RED, BLUE]),
    (1.0, 1.6, 12, [VIOLET, GREEN, BLUE]),
    (1.6, 2.2, 24, [AMBER, RED]),
]
CENTER, LEAD = 2.7, 0.025  # height of the middle, half width of the strips between panes


def pane(inner, outer, first, last, steps=12):
    """A part of a ring in the plane z = 0, a single wall."""
    positions = []
    for i in range(steps + 1):
        angle = first + (last - first) * i / steps
        positions += [(r * math.cos(angle), r * math.sin(angle), 0.0) for r in (inner, outer)]
    triangles = []
    for i in range(steps):
        a = 2 * i
        triangles += [(a, a + 1, a + 2), (a + 2, a + 1, a + 3)]
    return positions, [(0.0, 0.0, 1.0)] * len(positions), triangles


def wall(radius, half_width, height, steps=96):
    """In the plane z = 0, with a round hole: from the hole's edge outwards to a rectangle."""
    positions = []
    for i in range(steps):
        x, y = math.cos(2 * math.pi * i / steps), math.sin(2 * math.pi * i / steps)
        reach = min(half_width / max(abs(x), 1e-9), (height - CENTER if y > 0 else CENTER) / max(abs(y), 1e-9))
        positions += [(radius * x, radius * y, 0.0), (reach * x, reach * y, 0.0)]
    triangles = []
    for i in range(steps):
        a, b = 2 * i, 2 * ((i + 1) % steps)
        triangles += [(a, a + 1, b), (b, a + 1, b + 1)]
    return positions, [(0.0, 0.0, 1.0)] * len(positions), triangles


scene = gltf.Gltf()
stone = scene.material((0.7, 0.66, 0.6), roughness=0.9)
floor = scene.material((0.75, 0.72, 0.68), roughness=0.35)
at = (0, CENTER, 0)
scene.node(scene.mesh(wall(RINGS[-1][1] + LEAD, 12, 9), stone), at)
scene.node(scene.mesh(shapes.box((-12, -1, 0), (12, 0, 14)), floor))
lead = scene.material((0.03, 0.03, 0.03), roughness=0.6)
for inner, outer, parts, colors in RINGS:
    for i in range(parts):
        first, last = (2 * math.pi * k / parts for k in (i, i + 1))
        glass = scene.material(colors[i % len(colors)], roughness=0.0, transmission={"transmissionFactor": 1})
        gap = LEAD / outer * (parts > 1)
        scene.node(scene.mesh(pane(inner + LEAD * (inner > 0), outer - LEAD, first + gap, last - gap), glass), at)
        if parts > 1:
            scene.node(scene.mesh(pane(inner, outer, last - gap, last + gap, 1), lead), at)
    scene.node(scene.mesh(pane(outer - LEAD, outer + LEAD, 0, 2 * math.pi, 96), lead), at)
bright = scene.material((0, 0, 0), emission=[1, 1, 1], emissive_strength={"emissiveStrength": 6})
scene.node(scene.mesh(shapes.box((-10, -20, 0), (40, 16, 1)), bright), (0, 0, -40))
scene.sun(shapes.unit((0.14, -0.72, 0.68)), 45.0, (1.0, 0.93, 0.82))
scene.save(sys.argv[1])
