#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Blocks of houses around yards, with a tower, on a ground of small squares. Usage: town_scene.py FILE.gltf"""

import random
import sys

import gltf
import shapes

BLOCKS, PITCH, CELLS = 4, 46, 48  # blocks a side, metres from one to the next, squares of ground a block
chance = random.Random(7)


def grid(corner, u, v, step):
    """A rectangle with sides u and v from a corner, in triangles of about this size."""
    count_u, count_v = (max(1, round(sum(x * x for x in side) ** 0.5 / step)) for side in (u, v))
    positions = [
        tuple(c + a * i / count_u + b * j / count_v for c, a, b in zip(corner, u, v, strict=True))
        for j in range(count_v + 1)
        for i in range(count_u + 1)
    ]
    triangles = []
    for j in range(count_v):
        for i in range(count_u):
            a = j * (count_u + 1) + i
            triangles += [(a, a + 1, a + count_u + 2), (a, a + count_u + 2, a + count_u + 1)]
    return positions, [shapes.unit(shapes.cross(u, v))] * len(positions), triangles


def joined(parts):
    positions, normals, triangles = [], [], []
    for part in parts:
        first = len(positions)
        positions += part[0]
        normals += part[1]
        triangles += [tuple(first + i for i in triangle) for triangle in part[2]]
    return positions, normals, triangles


def house(x, z, width, depth, height, step=2.0):
    """Four walls and a flat roof."""
    return joined(
        [
            grid((x, 0, z + depth), (width, 0, 0), (0, height, 0), step),
            grid((x + width, 0, z), (-width, 0, 0), (0, height, 0), step),
            grid((x, 0, z), (0, 0, depth), (0, height, 0), step),
            grid((x + width, 0, z + depth), (0, 0, -depth), (0, height, 0), step),
            grid((x, height, z + depth), (width, 0, 0), (0, 0, -depth), step),
        ]
    )


scene = gltf.Gltf()
plaster = scene.material((0.75, 0.72, 0.66), roughness=0.9)
half = BLOCKS * PITCH / 2
scene.node(scene.mesh(grid((-half, 0, half), (2 * half, 0, 0), (0, 0, -2 * half), PITCH / CELLS), plaster))
for row in range(BLOCKS):
    for column in range(BLOCKS):
        x, z = column * PITCH - half + 5, row * PITCH - half + 5
        for i in range(4):  # along each side of the block, in two houses
            for part in range(2):
                height = chance.uniform(8, 20)
                if i < 2:
                    place = (x + 18 * part, z + 26 * i, 18, 10)
                else:
                    place = (x + 26 * (i - 2), z + 10 + 8 * part, 10, 8)
                scene.node(scene.mesh(house(*place, height), plaster))
scene.node(scene.mesh(house(14, -9, 9, 9, 48), plaster))
scene.save(sys.argv[1])
