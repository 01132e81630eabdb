#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The scenes of the gallery, and what lights them. Usage: scenes.py NAME FILE   NAME: a function below"""

import colorsys
import math
import random
import sys

from gltf import Gltf, box, cross, ground, sphere, torus_knot, tube, unit


def knots(path):
    """Three rings and a knot that meet in places."""
    scene = Gltf()
    scene.node(scene.mesh(tube(torus_knot(2, 5, 0.8), 0.3, along=240, around=16), scene.material((0.02, 0.2, 0.3))))
    ring = scene.mesh(tube(torus_knot(1, 0, 0.36), 0.22, along=64, around=16), scene.material((0.8, 0.45, 0.05)))
    for i in range(3):
        angle = 2 * math.pi * i / 3 + 0.4
        turn = [0.7071 * math.cos(angle), 0.7071 * math.sin(angle), 0, 0.7071]
        scene.node(ring, (1.6 * math.cos(angle), 1.6 * math.sin(angle), 0.1), rotation=turn)
    scene.save(path)


def materials(path):
    """Eight knots of as many materials."""
    scene = Gltf()
    knot = tube(torus_knot(2, 3, 0.3), 0.2, around=36)

    def glass(roughness, distance, color):
        """What absorbs light on its way: `color` is left of it after `distance`."""
        volume = {"thicknessFactor": 1, "attenuationDistance": distance, "attenuationColor": color}
        extensions = {"transmission": {"transmissionFactor": 1}, "ior": {"ior": 1.5}, "volume": volume}
        return scene.material((1, 1, 1), 0, roughness, **extensions)

    looks = [
        scene.material((1.0, 0.71, 0.29), metallic=1, roughness=0.2),  # gold
        scene.material((0.85, 0.85, 0.88), metallic=1, roughness=0.45, anisotropy={"anisotropyStrength": 0.9}),
        scene.material(
            (0.35, 0.01, 0.02), 0.4, 0.5, clearcoat={"clearcoatFactor": 1, "clearcoatRoughnessFactor": 0.03}
        ),
        scene.material(
            (0.05, 0.03, 0.25), 0, 0.9, sheen={"sheenColorFactor": [0.6, 0.5, 1], "sheenRoughnessFactor": 0.4}
        ),
        scene.material((0.95, 0.64, 0.54), metallic=1, roughness=0.5),  # copper
        glass(roughness=0.0, distance=0.5, color=[0.1, 0.75, 0.55]),
        glass(roughness=0.25, distance=0.6, color=[0.9, 0.45, 0.1]),
        scene.material((0.03, 0.25, 0.3), roughness=0.25),
    ]
    for i, material in enumerate(looks):
        scene.node(
            scene.mesh(knot, material),
            (2.3 * (i % 4 - 1.5), 0.5, 2.3 * (i // 4 - 0.5)),
            rotation=[-0.7071068, 0, 0, 0.7071068],
        )
    scene.node(scene.mesh(ground(60), scene.material((0.18, 0.17, 0.16), roughness=0.6)))
    scene.save(path)


def pendulums(path):
    """Fifteen pendulums that swing 25 to 39 times a minute: they start together, and meet again after it."""
    COUNT, HEIGHT, SWING, SECONDS, RATE = 15, 2.2, 0.6, 60, 30
    scene = Gltf()
    ball, string = sphere(0.16), box((-0.012, 0, -0.012), (0.012, 1, 0.012))
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
        pivot = scene.added(
            "nodes", {"translation": [0, HEIGHT, 0.32 * (i - (COUNT - 1) / 2)], "children": [hung, line]}
        )
        half = [SWING / 2 * math.cos(2 * math.pi * swings * k / RATE / SECONDS) for k in range(SECONDS * RATE + 1)]
        turns = scene.accessor([(0.0, 0.0, math.sin(a), math.cos(a)) for a in half], "VEC4")
        samplers.append({"input": times, "output": turns})
        channels.append({"sampler": i, "target": {"node": pivot, "path": "rotation"}})
    scene.added("animations", {"name": "Swing", "samplers": samplers, "channels": channels})
    rail = box((-0.05, HEIGHT, -2.6), (0.05, HEIGHT + 0.1, 2.6))
    scene.node(scene.mesh(rail, steel))
    scene.node(scene.mesh(ground(30), scene.material((0.55, 0.55, 0.57), roughness=0.9)))
    scene.save(path)


BLOCKS, PITCH, CELLS = 4, 46, 48  # blocks a side, metres from one to the next, squares of ground a block


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
    return positions, [unit(cross(u, v))] * len(positions), triangles


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


def town(path):
    """Blocks of houses around yards, with a tower, on a ground of small squares."""
    chance = random.Random(7)
    scene = Gltf()
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
    scene.save(path)


BLUE, RED, AMBER = (0.04, 0.13, 0.9), (0.85, 0.03, 0.05), (1, 0.5, 0.04)
GREEN, VIOLET = (0.05, 0.6, 0.2), (0.4, 0.08, 0.8)
# Inner and outer radius, number of panes, and their colours, which take turns.
RINGS = [
    (0.0, 0.45, 1, [AMBER]),
    (0.45, 1.0, 8, [RED, BLUE]),
    (1.0, 1.6, 12, [VIOLET, GREEN, BLUE]),
    (1.6, 2.2, 24, [AMBER, RED]),
]
CENTER, LEAD = 2.7, 0.025  # height of the middle, half width of the strips between panes


def strip(pairs, is_closed=False):
    """Between points in the plane z = 0, each with the one beside it; a single wall."""
    positions = [(*point, 0.0) for pair in pairs for point in pair]
    starts = range(0, len(positions) if is_closed else len(positions) - 2, 2)
    ends = [(a, (a + 2) % len(positions)) for a in starts]
    triangles = [corners for a, b in ends for corners in ((a, a + 1, b), (b, a + 1, b + 1))]
    return positions, [(0.0, 0.0, 1.0)] * len(positions), triangles


def pane(inner, outer, first, last, steps=12):
    """A part of a ring."""
    angles = [first + (last - first) * i / steps for i in range(steps + 1)]
    return strip([[(r * math.cos(angle), r * math.sin(angle)) for r in (inner, outer)] for angle in angles])


def wall(radius, half_width, height, steps=96):
    """With a round hole: from the hole's edge outwards to a rectangle."""
    pairs = []
    for i in range(steps):
        x, y = math.cos(2 * math.pi * i / steps), math.sin(2 * math.pi * i / steps)
        reach = min(half_width / max(abs(x), 1e-9), (height - CENTER if y > 0 else CENTER) / max(abs(y), 1e-9))
        pairs.append([(radius * x, radius * y), (reach * x, reach * y)])
    return strip(pairs, is_closed=True)


def window(path):
    """A round window of coloured panes, by which the sun comes in."""
    scene = Gltf()
    stone = scene.material((0.7, 0.66, 0.6), roughness=0.9)
    floor = scene.material((0.75, 0.72, 0.68), roughness=0.35)
    at = (0, CENTER, 0)
    scene.node(scene.mesh(wall(RINGS[-1][1] + LEAD, 12, 9), stone), at)
    scene.node(scene.mesh(box((-12, -1, 0), (12, 0, 14)), floor))
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
    scene.node(scene.mesh(box((-10, -20, 0), (40, 16, 1)), bright), (0, 0, -40))
    scene.sun(unit((0.14, -0.72, 0.68)), 45.0, (1.0, 0.93, 0.82))
    scene.save(path)


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


def studio_sky(path):
    """Light of a studio all around: a warm lamp, a cold one, and a soft glow from above."""
    with open(path, "wb") as file:
        file.write(f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {HEIGHT} +X {WIDTH}\n".encode())
        for row in range(HEIGHT):
            for column in range(WIDTH):
                file.write(rgbe(radiance(360 * (column + 0.5) / WIDTH - 180, 90 - 180 * (row + 0.5) / HEIGHT)))


def sun_path(path):
    """Where the sun's rays go from 6 to 18 o'clock of a midsummer day at 48 degrees north, for half an hour each; y is
    up and -z is north."""
    latitude, tilt = math.radians(48), math.radians(23.44)
    with open(path, "w", encoding="utf-8") as file:
        for step in range(24):
            hour = math.radians(15 * (step / 2 + 0.25 - 6))
            up = math.sin(latitude) * math.sin(tilt) + math.cos(latitude) * math.cos(tilt) * math.cos(hour)
            west = math.cos(tilt) * math.sin(hour)
            south = math.sin(latitude) * math.cos(tilt) * math.cos(hour) - math.cos(latitude) * math.sin(tilt)
            file.write(f"{west:.5f},{-up:.5f},{-south:.5f},0.5\n")


if __name__ == "__main__":
    globals()[sys.argv[1]](sys.argv[2])
