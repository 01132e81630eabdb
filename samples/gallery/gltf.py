# SPDX-License-Identifier: MIT
"""A glTF 2.0 file with its data inside, as the scenes of the gallery need it, and its shapes: tuples of positions,
normals and triangles, which turn counter-clockwise as seen from outside."""

import array
import base64
import json
import math

FLOAT, UNSIGNED_INT = 5126, 5125


class Gltf:
    """Collects meshes, materials and nodes; each method gives the index of what it added."""

    def __init__(self):
        self.bytes = b""
        self.parts = {
            name: [] for name in ("accessors", "bufferViews", "materials", "meshes", "nodes", "cameras", "animations")
        }
        self.extensions = set()
        self.lights = []

    def added(self, name, item):
        self.parts[name].append(item)
        return len(self.parts[name]) - 1

    def accessor(self, rows, kind, component=FLOAT):
        """Of rows of numbers, or of numbers where `kind` is SCALAR."""
        flat = [x for row in rows for x in row] if kind != "SCALAR" else list(rows)
        data = array.array("f" if component == FLOAT else "I", flat).tobytes()
        view = self.added("bufferViews", {"buffer": 0, "byteOffset": len(self.bytes), "byteLength": len(data)})
        self.bytes += data
        item = {"bufferView": view, "componentType": component, "count": len(rows), "type": kind}
        if component == FLOAT:
            columns = list(zip(*rows, strict=True)) if kind != "SCALAR" else [rows]
            item |= {"min": [min(c) for c in columns], "max": [max(c) for c in columns]}
        return self.added("accessors", item)

    def material(self, color, metallic=0.0, roughness=0.5, emission=None, **extensions):
        """`color` is linear RGB; extensions as KHR_materials_... by the rest of their name."""
        self.extensions |= {f"KHR_materials_{name}" for name in extensions}
        surface = {"baseColorFactor": [*color, 1.0], "metallicFactor": metallic, "roughnessFactor": roughness}
        item = {"pbrMetallicRoughness": surface}
        if emission:
            item["emissiveFactor"] = emission
        if extensions:
            item["extensions"] = {f"KHR_materials_{name}": values for name, values in extensions.items()}
        return self.added("materials", item)

    def mesh(self, shape, material):
        positions, normals, triangles = shape
        attributes = {"POSITION": self.accessor(positions, "VEC3"), "NORMAL": self.accessor(normals, "VEC3")}
        indices = self.accessor([i for triangle in triangles for i in triangle], "SCALAR", UNSIGNED_INT)
        primitive = {"attributes": attributes, "indices": indices, "material": material}
        return self.added("meshes", {"primitives": [primitive]})

    def node(self, mesh, at=(0, 0, 0), **more):
        return self.added("nodes", {"mesh": mesh, "translation": list(at)} | more)

    def sun(self, direction, intensity, color=(1, 1, 1)):
        """Parallel light, in lux; `direction` is where it goes, of length 1 and not +z."""
        self.extensions.add("KHR_lights_punctual")
        self.lights.append({"type": "directional", "intensity": intensity, "color": list(color)})
        x, y, z = direction
        size = math.sqrt(2 * (1 - z))  # lights go along -z: a turn from there to `direction`
        light = {"KHR_lights_punctual": {"light": len(self.lights) - 1}}
        return self.added("nodes", {"rotation": [y / size, -x / size, 0, (1 - z) / size], "extensions": light})

    def save(self, path):
        """Nodes that nobody names as children are the scene."""
        children = {child for node in self.parts["nodes"] for child in node.get("children", [])}
        roots = [i for i in range(len(self.parts["nodes"])) if i not in children]
        uri = "data:application/octet-stream;base64," + base64.b64encode(self.bytes).decode()
        root = {
            "asset": {"version": "2.0"},
            "scene": 0,
            "scenes": [{"nodes": roots}],
            "buffers": [{"byteLength": len(self.bytes), "uri": uri}],
        }
        root |= {name: items for name, items in self.parts.items() if items}
        if self.extensions:
            root["extensionsUsed"] = sorted(self.extensions)
        if self.lights:
            root["extensions"] = {"KHR_lights_punctual": {"lights": self.lights}}
        with open(path, "w", encoding="utf-8") as file:
            json.dump(root, file)


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
