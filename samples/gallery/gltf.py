# SPDX-License-Identifier: MIT
"""A glTF 2.0 file with its data inside, as the scenes of the gallery need it.
Shapes are tuples of positions, normals and triangles, as shapes.py makes them."""

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
