"""Small scenes that twinray's path tracer and Mitsuba 3 render alike: the same triangles, the same materials.

A scene is a list of parts. A part has `positions` (n x 3), `uvs` (n x 2) or None, `triangles` (m x 3) and a `material`:
{"kind": "diffuse", "color": rgb or an image (h x w x 3, 8-bit sRGB), "emission": rgb}
{"kind": "metal", "alpha": GGX}             reflects all
{"kind": "glass", "alpha": GGX, "ior": eta} absorbs nothing
Triangles are flat. The camera looks along -z from `eye` with a vertical field of view `fov` in degrees, in a square
picture. `sky` is None or an image (h x w x 3) of radiance, as the path tracer has it: row 0 around +y, columns from -x
over -z.
"""
import base64
import json
import math
import struct
import zlib

import numpy as np


def quad(corner, a, b, material):
    """Faces towards a x b."""
    corner, a, b = (np.array(v, float) for v in (corner, a, b))
    return {"positions": np.array([corner, corner + a, corner + a + b, corner + b]), "triangles": np.array([[0, 1, 2], [0, 2, 3]]),
            "uvs": np.array([[0, 1], [1, 1], [1, 0], [0, 0]], float), "material": material}


def box(center, half, turn, material):
    """Turned about +y, in radians."""
    positions, triangles = [], []
    for axis in range(3):
        for side in (-1, 1):
            first = len(positions)
            for x, y in ((-1, -1), (1, -1), (1, 1), (-1, 1)):
                corner = [0, 0, 0]
                corner[axis], corner[(axis + 1) % 3], corner[(axis + 2) % 3] = side, x * side, y
                positions.append(corner)
            triangles += [[first, first + 1, first + 2], [first, first + 2, first + 3]]
    c, s = math.cos(turn), math.sin(turn)
    moved = np.array(positions, float) * half @ np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]]).T + center
    return {"positions": moved, "triangles": np.array(triangles), "uvs": None, "material": material}


def ball(center, radius, material, rings=12):
    """A polyhedron of latitudes and longitudes."""
    positions, triangles = [[0, 1, 0]], []
    for ring in range(1, rings):
        for step in range(2 * rings):
            theta, phi = math.pi * ring / rings, math.pi * step / rings
            positions.append([math.sin(theta) * math.cos(phi), math.cos(theta), -math.sin(theta) * math.sin(phi)])
    positions.append([0, -1, 0])
    at = lambda ring, step: 1 + (ring - 1) * 2 * rings + step % (2 * rings)
    for step in range(2 * rings):
        triangles.append([0, at(1, step), at(1, step + 1)])
        triangles.append([len(positions) - 1, at(rings - 1, step + 1), at(rings - 1, step)])
        for ring in range(1, rings - 1):
            a, b, c, d = at(ring, step), at(ring + 1, step), at(ring + 1, step + 1), at(ring, step + 1)
            triangles += [[a, b, c], [a, c, d]]
    return {"positions": np.array(positions) * radius + np.array(center, float), "triangles": np.array(triangles), "uvs": None,
            "material": material}


def diffuse(color, emission=None):
    return {"kind": "diffuse", "color": color, "emission": emission}


def room(white, left, right, lamp):
    """The inside of the cube from -1 to 1, open towards +z; the light is Mitsuba's own Cornell box's."""
    return [quad([-1, -1, 1], [2, 0, 0], [0, 0, -2], white), quad([-1, 1, -1], [2, 0, 0], [0, 0, 2], white),
            quad([-1, -1, -1], [2, 0, 0], [0, 2, 0], white), quad([-1, -1, 1], [0, 0, -2], [0, 2, 0], left),
            quad([1, -1, -1], [0, 0, 2], [0, 2, 0], right), quad([-0.23, 0.99, -0.18], [0.46, 0, 0], [0, 0, 0.38], lamp)]


WHITE, GREEN, RED = [0.885809, 0.698859, 0.666422], [0.105421, 0.37798, 0.076425], [0.570068, 0.0430135, 0.0443706]
LAMP = diffuse(WHITE, [18.387, 13.9873, 6.75357])


def cornell_box():
    """Mitsuba 3's own (mitsuba.cornell_box())."""
    parts = room(diffuse(WHITE), diffuse(RED), diffuse(GREEN), LAMP)
    parts.append(box([0.335, -0.7, 0.38], [0.3, 0.3, 0.3], -math.radians(17), diffuse(WHITE)))
    parts.append(box([-0.33, -0.4, -0.28], [0.3, 0.61, 0.3], math.radians(18.25), diffuse(WHITE)))
    return {"name": "cornell_box", "parts": parts, "eye": [0, 0, 3.9], "fov": 39.3077, "sky": None, "depth": 7}


def metal_and_glass():
    """Nearly smooth: Mitsuba multiplies the shadowing of both directions, glTF takes them as correlated (Heitz 2014)."""
    parts = room(diffuse([0.7, 0.7, 0.7]), diffuse(RED), diffuse(GREEN), diffuse([0, 0, 0], [17, 12, 8]))
    parts[-1]["positions"][:, [0, 2]] *= 2
    parts.append(ball([-0.5, -0.6, -0.3], 0.4, {"kind": "metal", "alpha": 0.06}))
    parts.append(box([0.45, -0.55, -0.4], [0.3, 0.45, 0.3], 0.4, {"kind": "metal", "alpha": 0.02}))
    parts.append(ball([0.45, -0.7, 0.45], 0.3, {"kind": "glass", "alpha": 0.06, "ior": 1.5}))
    parts.append(box([-0.3, -0.78, 0.5], [0.15, 0.2, 0.15], 0.3, {"kind": "glass", "alpha": 0, "ior": 1.33}))
    return {"name": "metal_and_glass", "parts": parts, "eye": [0, 0, 3.9], "fov": 39.3077, "sky": None, "depth": 12}


def textured_sky():
    random = np.random.default_rng(7)
    tiles = random.integers(0, 256, (16, 16, 3))
    stripes = np.repeat(random.integers(0, 256, (4, 1, 3)), 64, axis=1)
    v, u = np.mgrid[0:8, 0:16]
    sky = 0.3 + 0.3 * np.stack([1 + np.sin(u * 0.7), 1 + np.cos(v * 1.1), 1 + np.sin(u + v)], axis=-1)
    sky[2, 5] = [40, 35, 25]
    # No ray of the camera reaches the sky: the path tracer shows it smooth, though its light is not.
    parts = [quad([-3, -1, 3], [6, 0, 0], [0, 0, -6], diffuse(tiles)), quad([-4, -1, -3], [8, 0, 0], [0, 4, 0], diffuse([0.3, 0.3, 0.35])), box([-0.5, -0.4, 0], [0.4, 0.6, 0.4], 0.5, diffuse([0.6, 0.6, 0.2])),
             quad([0.1, -0.9, -0.6], [1, 0.2, 0.6], [-0.1, 1.2, 0.3], diffuse(stripes)),
             ball([0.6, -0.7, 0.7], 0.3, diffuse([0.2, 0.5, 0.8]))]
    return {"name": "textured_sky", "parts": parts, "eye": [0, 0, 3.9], "fov": 39.3077, "sky": sky, "depth": 5}


def png_uri(image):
    rows = b"".join(b"\0" + row.astype(np.uint8).tobytes() for row in image)
    chunk = lambda tag, data: struct.pack(">I", len(data)) + tag + data + struct.pack(">I", zlib.crc32(tag + data))
    header = struct.pack(">IIBBBBB", image.shape[1], image.shape[0], 8, 2, 0, 0, 0)
    data = b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", header) + chunk(b"IDAT", zlib.compress(rows, 9)) + chunk(b"IEND", b"")
    return "data:image/png;base64," + base64.b64encode(data).decode()


class Gltf:
    def __init__(self):
        self.blob, self.views, self.accessors = b"", [], []
        self.materials, self.images = [], []

    def array(self, values):
        is_index = values.dtype.kind in "iu"
        values = values.astype("<u4" if is_index else "<f4")
        self.views.append({"buffer": 0, "byteOffset": len(self.blob), "byteLength": values.nbytes})
        self.blob += values.tobytes()
        accessor = {"bufferView": len(self.views) - 1, "componentType": 5125 if is_index else 5126,
                    "count": values.size if is_index else len(values), "type": "SCALAR" if is_index else f"VEC{values.shape[1]}"}
        if not is_index and values.shape[1] == 3:
            accessor.update(min=values.min(axis=0).tolist(), max=values.max(axis=0).tolist())
        self.accessors.append(accessor)
        return len(self.accessors) - 1

    def material(self, source):
        """An index of refraction of 1 reflects nothing, so that only the diffuse part is left."""
        if source["kind"] == "diffuse":
            pbr = {"metallicFactor": 0, "roughnessFactor": 1}
            if np.ndim(source["color"]) == 3:
                self.images.append({"uri": png_uri(source["color"])})
                pbr["baseColorTexture"] = {"index": len(self.images) - 1}
            else:
                pbr["baseColorFactor"] = [*source["color"], 1]
            material = {"pbrMetallicRoughness": pbr, "extensions": {"KHR_materials_ior": {"ior": 1}}}
            if source["emission"]:
                strength = max(source["emission"])
                material["emissiveFactor"] = [e / strength for e in source["emission"]]
                material["extensions"]["KHR_materials_emissive_strength"] = {"emissiveStrength": strength}
        else:
            material = {"pbrMetallicRoughness": {"metallicFactor": float(source["kind"] == "metal"), "roughnessFactor": source["alpha"] ** 0.5}}
            if source["kind"] == "glass":
                material["extensions"] = {"KHR_materials_ior": {"ior": source["ior"]}, "KHR_materials_transmission": {"transmissionFactor": 1},
                                          "KHR_materials_volume": {"thicknessFactor": 1}}
        self.materials.append(material)
        return len(self.materials) - 1

    def primitive(self, part):
        attributes = {"POSITION": self.array(part["positions"])}
        if part["uvs"] is not None:
            attributes["TEXCOORD_0"] = self.array(part["uvs"])
        return {"attributes": attributes, "indices": self.array(part["triangles"].reshape(-1)), "material": self.material(part["material"])}


def gltf_text(scene):
    gltf = Gltf()
    primitives = [gltf.primitive(part) for part in scene["parts"]]
    used = sorted({name for material in gltf.materials for name in material.get("extensions", {})})
    result = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 1]}],
              "nodes": [{"mesh": 0}, {"camera": 0, "translation": scene["eye"]}], "meshes": [{"primitives": primitives}],
              "cameras": [{"type": "perspective", "perspective": {"yfov": math.radians(scene["fov"]), "znear": 0.01, "aspectRatio": 1}}],
              "materials": gltf.materials, "accessors": gltf.accessors, "bufferViews": gltf.views,
              "buffers": [{"byteLength": len(gltf.blob), "uri": "data:application/octet-stream;base64," + base64.b64encode(gltf.blob).decode()}]}
    if used:
        result["extensionsUsed"] = used
    if gltf.images:
        result.update(images=gltf.images, samplers=[{"magFilter": 9729, "minFilter": 9729}],
                      textures=[{"source": i, "sampler": 0} for i in range(len(gltf.images))])
    return json.dumps(result, indent=1)


TYPES = {5121: np.uint8, 5123: np.uint16, 5125: np.uint32, 5126: np.float32}
WIDTHS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4}


class File:
    """The triangles of a .gltf file as parts, with nothing of its materials but base colour and emission."""

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
            yield {"positions": positions @ world[:3, :3].T + world[:3, 3],
                   "uvs": None if uvs is None else self.array(uvs).astype(float),
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


ALL = [cornell_box, metal_and_glass, textured_sky]
