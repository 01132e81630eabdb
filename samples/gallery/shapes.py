# SPDX-License-Identifier: MIT
"""Shapes as (positions, normals, triangles): triangles turn counter-clockwise as seen from outside."""

import math


def sphere(radius=1.0, around=64, down=32):
    normals = [
        (math.sin(p) * math.cos(a), math.cos(p), math.sin(p) * math.sin(a))
        for p in (math.pi * j / down for j in range(down + 1))
        for a in (2 * math.pi * i / around for i in range(around + 1))
    ]
    positions = [tuple(radius * x for x in normal) for normal in normals]
    triangles = []
    for j in range(down):
        for i in range(around):
            a, b = j * (around + 1) + i, (j + 1) * (around + 1) + i
            triangles += [(a, a + 1, b)] * (j > 0) + [(a + 1, b + 1, b)] * (j < down - 1)
    return positions, normals, triangles


def box(low, high):
    """Each side has corners of its own."""
    positions, normals, triangles = [], [], []
    for axis in range(3):
        for sign in (-1, 1):
            u, v = (axis + 1) % 3, (axis + 2) % 3
            first = len(positions)
            for su, sv in ((0, 0), (1, 0), (1, 1), (0, 1)):
                corner = [0.0, 0.0, 0.0]
                corner[axis] = high[axis] if sign > 0 else low[axis]
                corner[u], corner[v] = (high if su else low)[u], (high if sv else low)[v]
                positions.append(tuple(corner))
                normals.append(tuple(float(sign) if k == axis else 0.0 for k in range(3)))
            order = (0, 1, 2, 3) if sign > 0 else (0, 3, 2, 1)
            triangles += [tuple(first + order[i] for i in corners) for corners in ((0, 1, 2), (0, 2, 3))]
    return positions, normals, triangles


def ground(size, height=0.0):
    positions = [(-size, height, -size), (-size, height, size), (size, height, size), (size, height, -size)]
    return positions, [(0.0, 1.0, 0.0)] * 4, [(0, 1, 2), (0, 2, 3)]


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def unit(a):
    length = math.sqrt(sum(x * x for x in a))
    return tuple(x / length for x in a)


def tube(curve, radius, along=240, around=24):
    """Around a closed curve, a function of 0 to 1. Its frame turns with the direction away from the curve's middle."""
    positions, normals, triangles = [], [], []
    for i in range(along):
        here, ahead, behind = curve(i / along), curve((i + 0.5) / along), curve((i - 0.5) / along)
        forward = unit([p - q for p, q in zip(ahead, behind, strict=True)])
        side = unit(cross(forward, cross(here, forward)))
        other = cross(forward, side)
        for j in range(around):
            angle = 2 * math.pi * j / around
            normal = tuple(math.cos(angle) * s + math.sin(angle) * o for s, o in zip(side, other, strict=True))
            normals.append(normal)
            positions.append(tuple(p + radius * n for p, n in zip(here, normal, strict=True)))
    for i in range(along):
        for j in range(around):
            a, b = i * around + j, i * around + (j + 1) % around
            c, d = ((k + around) % (along * around) for k in (a, b))
            triangles += [(a, b, c), (b, d, c)]
    return positions, normals, triangles


def torus_knot(p, q, size=1.0):
    """A curve that goes p times around the axis z and q times through the hole."""

    def at(t):
        a, b = 2 * math.pi * p * t, 2 * math.pi * q * t
        far = size * (2 + math.cos(b))
        return (far * math.cos(a), far * math.sin(a), size * math.sin(b))

    return at
