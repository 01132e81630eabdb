# SPDX-License-Identifier: MIT
"""The triangles of a .gltf file as parts of peer_scenes.py, with nothing of its materials but base colour and emission."""
import json

import numpy as np

TYPES = {5121: np.uint8, 5123: np.uint16, 5125: np.uint32, 5126: np.float32}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}


class File:
    def __init__(self, path, load_image):
        self.folder, self.json, self.load_image = path.parent, json.loads(path.read_text()), load_image
        self.buffers = [(self.folder / buffer["uri"]).read_bytes() for buffer in self.json["buffers"]]

    def array(self, index):
        accessor = self.json["accessors"][index]
        view = self.json["bufferViews"][accessor["bufferView"]]
        kind, width = np.dtype(TYPES[accessor["componentType"]]), WIDTHS[accessor["type"]]
        stride = view.get("byteStride", kind.itemsize * width)
        first = view.get("byteOffset", 0) + accessor.get("byteOffset", 0)
        rows = np.lib.stride_tricks.as_strided(np.frombuffer(self.buffers[view["buffer"]], np.uint8)[first:],
                                               (accessor["count"], kind.itemsize * width), (stride, 1))
        return np.ascontiguousarray(rows).view(kind).reshape(accessor["count"], width)

    def material(self, index):
        source = self.json["materials"][index] if index is not None else {}
        pbr = source.get("pbrMetallicRoughness", {})
        color = pbr.get("baseColorFactor", [1, 1, 1, 1])[:3]
        if "baseColorTexture" in pbr:
            image = self.json["images"][self.json["textures"][pbr["baseColorTexture"]["index"]]["source"]]
            color = self.load_image(self.folder / image["uri"])
        return {"kind": "diffuse", "color": color, "emission": None}

    def parts(self, node, parent):
        here = self.json["nodes"][node]
        local = np.array(here["matrix"], float).reshape(4, 4).T if "matrix" in here else placed(here)
        world = parent @ local
        for primitive in self.json["meshes"][here["mesh"]]["primitives"] if "mesh" in here else []:
            positions = self.array(primitive["attributes"]["POSITION"]).astype(float)
            uvs = primitive["attributes"].get("TEXCOORD_0")
            yield {"positions": positions @ world[:3, :3].T + world[:3, 3], "uvs": None if uvs is None else self.array(uvs).astype(float),
                   "triangles": self.array(primitive["indices"]).reshape(-1, 3).astype(np.uint32),
                   "material": self.material(primitive.get("material"))}
        for child in here.get("children", []):
            yield from self.parts(child, world)


def placed(node):
    x, y, z, w = node.get("rotation", [0, 0, 0, 1])
    turn = np.array([[1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)],
                     [2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)],
                     [2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)]])
    matrix = np.eye(4)
    matrix[:3, :3], matrix[:3, 3] = turn * node.get("scale", [1, 1, 1]), node.get("translation", [0, 0, 0])
    return matrix


def parts_of(path, load_image):
    file = File(path, load_image)
    scene = file.json["scenes"][file.json.get("scene", 0)]
    return [part for node in scene["nodes"] for part in file.parts(node, np.eye(4))]


def seen_from(parts, eye, target):
    """The parts in the frame of a camera at `eye` that looks at `target`: it stands at 0 and looks along -z."""
    back = np.subtract(eye, target).astype(float)
    back /= np.linalg.norm(back)
    right = np.cross([0, 1, 0], back)
    right /= np.linalg.norm(right)
    frame = np.array([right, np.cross(back, right), back])
    return [{**part, "positions": (part["positions"] - eye) @ frame.T} for part in parts]
