"""The files that pages take for given, as small as they can be: each page finds them in its folder.

scene.glb    a room with two blocks that cut into each other, a lamp and a camera; all of it closed
fox.glb      a block that an animation, "Run", turns once in a second
spheres.trace_program.h    as twinray_add_trace_program() makes it of the page's spheres.glsl
"""

import json
import math
import struct


def box(low, high, inward=False):
    """Positions and triangles of a box: 8 corners, whose bits are x, y, z, and 12 triangles that look outward."""
    corners = [[(high if corner >> axis & 1 else low)[axis] for axis in range(3)] for corner in range(8)]
    quads = [(0, 2, 3, 1), (4, 5, 7, 6), (0, 1, 5, 4), (2, 6, 7, 3), (0, 4, 6, 2), (1, 3, 7, 5)]
    triangles = [triangle for a, b, c, d in quads for triangle in ((a, b, c), (a, c, d))]
    return corners, [triangle[::-1] if inward else triangle for triangle in triangles]


class Glb:
    """A binary glTF file as it is put together."""

    def __init__(self):
        self.bytes = b""
        self.json = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": []}]}

    def add(self, kind, item):
        self.json.setdefault(kind, []).append(item)
        return len(self.json[kind]) - 1

    def array(self, kind, rows):
        """The number of an accessor: of floats, or of indices where rows are integers."""
        values = [value for row in rows for value in row]
        is_index = isinstance(values[0], int)
        data = struct.pack(f"<{len(values)}{'I' if is_index else 'f'}", *values)
        view = self.add("bufferViews", {"buffer": 0, "byteOffset": len(self.bytes), "byteLength": len(data)})
        self.bytes += data
        width = {"SCALAR": 1, "VEC3": 3, "VEC4": 4}[kind]
        accessor = {"bufferView": view, "componentType": 5125 if is_index else 5126, "type": kind}
        accessor |= {"count": len(values) // width}
        if kind != "VEC4" and not is_index:
            accessor |= {"min": [min(row[i] for row in rows) for i in range(width)]}
            accessor |= {"max": [max(row[i] for row in rows) for i in range(width)]}
        return self.add("accessors", accessor)

    def mesh(self, name, shape, color, emission=0.0):
        positions, triangles = shape
        material = {"name": name, "pbrMetallicRoughness": {"baseColorFactor": [*color, 1], "metallicFactor": 0}}
        primitive = {
            "attributes": {"POSITION": self.array("VEC3", [[float(x) for x in p] for p in positions])},
            "indices": self.array("SCALAR", triangles),
            "material": self.add("materials", material | {"emissiveFactor": [emission] * 3}),
        }
        return self.add("meshes", {"name": name, "primitives": [primitive]})

    def node(self, **what):
        number = self.add("nodes", what)
        self.json["scenes"][0]["nodes"].append(number)
        return number

    def camera(self, height, distance):
        lens = {"type": "perspective", "perspective": {"yfov": 0.8, "aspectRatio": 4 / 3, "znear": 0.01}}
        self.node(camera=self.add("cameras", lens), translation=[0, height, distance])

    def write(self, file):
        text = json.dumps(self.json | {"buffers": [{"byteLength": len(self.bytes)}]}).encode()
        text += b" " * (-len(text) % 4)
        head = struct.pack("<4sII", b"glTF", 2, 28 + len(text) + len(self.bytes))
        file.write_bytes(
            head + struct.pack("<I4s", len(text), b"JSON") + text
            + struct.pack("<I4s", len(self.bytes), b"BIN\0") + self.bytes
        )  # fmt: skip


def room():
    glb = Glb()
    block = glb.mesh("block", box((-0.5, 0, -0.5), (0.5, 1, 0.5)), (0.8, 0.4, 0.2))
    glb.node(name="room", mesh=glb.mesh("room", box((-2, 0, -2), (2, 3, 2), inward=True), (0.7, 0.7, 0.7)))
    glb.node(name="left", mesh=block, translation=[-0.25, 0.25, -0.5])
    glb.node(name="right", mesh=block, translation=[0.375, 0.5, -0.25])
    glb.node(name="lamp", mesh=glb.mesh("lamp", box((-0.5, 2.75, -0.5), (0.5, 2.875, 0.5)), (0, 0, 0), 1.0))
    glb.camera(1.5, 1.75)
    return glb


def runner():
    glb = Glb()
    node = glb.node(name="fox", mesh=glb.mesh("fox", box((-0.5, 0, -0.25), (0.5, 0.5, 0.25)), (0.9, 0.5, 0.2)))
    glb.camera(0.5, 2.5)
    angles = [step * math.tau / 4 for step in range(5)]
    sampler = {
        "input": glb.array("SCALAR", [[step / 4] for step in range(5)]),
        "output": glb.array("VEC4", [[0.0, math.sin(angle / 2), 0.0, math.cos(angle / 2)] for angle in angles]),
    }
    channel = {"sampler": 0, "target": {"node": node, "path": "rotation"}}
    glb.add("animations", {"name": "Run", "samplers": [sampler], "channels": [channel]})
    return glb


def write(folder):
    room().write(folder / "scene.glb")
    runner().write(folder / "fox.glb")
    code = "#pragma once\n#include <twinray/trace.h>\n\nextern const twinray::TraceProgramCode spheres;\n"
    (folder / "spheres.trace_program.h").write_text(code)
