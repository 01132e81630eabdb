"""Files made by the tools that people have, as twinray reads them: as many triangles as the tool made, the same area,
and hits of rays from the middle where the tool's own rays, or Open3D's on the tool's triangles, hit. Run by
run.sh.

Usage: exporters.py FOLDER, that of the built programs; the working directory takes the files. What is printed is the
table of docs/conventions.md. A tool that is not installed is a row that says so."""

import dataclasses
import datetime
import importlib.metadata
import pathlib
import re
import shutil
import subprocess
import sys
from collections.abc import Callable

import numpy as np

RAYS = 2000
ROUNDING = 1e-5  # of the extent: float32 files, and texts of six digits
QUANTISED = 2e-3  # of the extent: 11 bits of Draco, the fewest here, on slopes
Y_UP = np.array([[1, 0, 0], [0, 0, 1], [0, -1, 0]])  # (x, y, z) -> (x, z, -y)
THIRD_TURN = np.array([[0, 1, 0], [0, 0, 1], [1, 0, 0]])  # (x, y, z) -> (y, z, x)


@dataclasses.dataclass
class Model:
    """What a tool holds of a closed body, which every ray from the middle meets."""

    triangles: np.ndarray
    middle: np.ndarray
    directions: np.ndarray
    t: np.ndarray | None = None  # by the tool itself; by Open3D if None


def directions(count=RAYS):
    way = np.random.default_rng(1).normal(size=(count, 3))
    return way / np.linalg.norm(way, axis=1)[:, None]


def area(triangles):
    sides = triangles[:, 1:] - triangles[:, :1]
    return np.linalg.norm(np.cross(sides[:, 0], sides[:, 1]), axis=1).sum() / 2


def run_page(word):
    """The Python of docs/how-to/cad_and_ifc.md that has the word."""
    page = (pathlib.Path(__file__).parents[2] / "docs/how-to/cad_and_ifc.md").read_text()
    code = next(block for block in re.findall(r"```python[^\n]*\n(.*?)```", page, re.S) if word in block)
    run(sys.executable, "-c", code)


def cast_by_open3d(triangles, rays):
    import open3d as o3d

    corners = triangles.reshape(-1, 3).astype(np.float32)
    scene = o3d.t.geometry.RaycastingScene()
    scene.add_triangles(corners, np.arange(len(corners), dtype=np.uint32).reshape(-1, 3))
    return scene.cast_rays(o3d.core.Tensor(rays.astype(np.float32)))["t_hit"].numpy()


def compare(file, model, turn=None, *, scale=1.0, most=ROUNDING, same_count=True):
    """Raises where twinray's triangles, area or hits are not the model's, which `turn` and `scale` bring into the
    frame of the file; else says what was found."""
    import twinray

    turn = np.eye(3) if turn is None else turn
    scene = twinray.Scene(accel="sw")
    scene.add_file(file)
    found = np.asarray(scene.world_triangles()).reshape(-1, 3, 3)
    wanted = scale * model.triangles @ turn.T
    extent = np.ptp(wanted.reshape(-1, 3), axis=0).max()
    rays = np.concatenate([np.tile(scale * turn @ model.middle, (RAYS, 1)), model.directions @ turn.T], axis=1)
    t = np.asarray(scene.cast_rays(rays.astype(np.float32))["t_hit"])
    own = cast_by_open3d(wanted, rays) if model.t is None else scale * model.t
    off_t = np.abs(t - own).max() / extent
    off_area = abs(area(found) / area(wanted) - 1)
    told = f"{len(found)} of {len(wanted)} | {off_area:.1g} | {off_t:.1g}"
    if (same_count and len(found) != len(wanted)) or not off_area < 10 * most or not off_t < most:
        raise RuntimeError(told)
    return told


def ball():
    """A body with bumps, as float32 and with texture coordinates."""
    import trimesh

    mesh = trimesh.creation.icosphere(subdivisions=4)
    at = mesh.vertices
    radius = 1 + 0.2 * np.sin(3 * at[:, 0]) * np.cos(4 * at[:, 1] + at[:, 2])
    mesh.vertices = (at * radius[:, None]).astype(np.float32)
    uv = np.stack([0.5 + 0.4 * at[:, 0], 0.5 + 0.4 * at[:, 1]], 1)
    mesh.visual = trimesh.visual.TextureVisuals(uv=uv)
    return mesh


def model_of(mesh):
    return Model(mesh.triangles, np.zeros(3), directions())


def run(*command):
    found = subprocess.run([*map(str, command)], capture_output=True, text=True, check=False)
    if found.returncode != 0:
        raise RuntimeError(f"{command[0]}: {(found.stdout + found.stderr)[-300:]}")
    return found.stdout


def by_trimesh():
    mesh, model = ball(), model_of(ball())
    place, ray, _ = mesh.ray.intersects_location(np.zeros((RAYS, 3)), model.directions, multiple_hits=False)
    model.t = np.empty(RAYS)
    model.t[ray] = np.linalg.norm(place, axis=1)
    for suffix in ("glb", "ply", "stl", "obj"):
        mesh.export(f"trimesh.{suffix}")
        yield f"trimesh.{suffix}", compare(f"trimesh.{suffix}", model)


def by_meshio():
    import meshio

    mesh = ball()
    ids = {"id": np.arange(len(mesh.vertices))}
    for suffix in ("ply", "stl", "obj"):
        meshio.Mesh(mesh.vertices, [("triangle", mesh.faces)], point_data=ids).write(f"meshio.{suffix}")
        yield f"meshio.{suffix}", compare(f"meshio.{suffix}", model_of(mesh))


def by_open3d():
    import open3d as o3d

    mesh = ball()
    vertices, faces = o3d.utility.Vector3dVector(mesh.vertices), o3d.utility.Vector3iVector(mesh.faces)
    own = o3d.geometry.TriangleMesh(vertices, faces)
    own.compute_vertex_normals()
    for suffix in ("glb", "ply", "stl", "obj"):
        o3d.io.write_triangle_mesh(f"open3d.{suffix}", own)
        yield f"open3d.{suffix}", compare(f"open3d.{suffix}", model_of(mesh))


def by_pyvista():
    import pyvista

    mesh = ball()
    own = pyvista.PolyData.from_regular_faces(mesh.vertices, mesh.faces)
    model = model_of(mesh)
    seen = [own.ray_trace(np.zeros(3), 3 * way, first_point=True)[0] for way in model.directions]
    model.t = np.linalg.norm(seen, axis=1)
    for suffix in ("ply", "stl"):
        own.save(f"pyvista.{suffix}")
        yield f"pyvista.{suffix}", compare(f"pyvista.{suffix}", model)
    plotter = pyvista.Plotter(off_screen=True)
    plotter.add_mesh(own)
    plotter.export_gltf("pyvista.gltf")
    yield "pyvista.gltf, (y, z, x)", compare("pyvista.gltf", model, THIRD_TURN)


def by_pymeshlab():
    import pymeshlab

    mesh = ball()
    meshes = pymeshlab.MeshSet(verbose=False)
    meshes.add_mesh(pymeshlab.Mesh(mesh.vertices, mesh.faces))
    for suffix in ("ply", "stl", "obj"):
        meshes.save_current_mesh(f"pymeshlab.{suffix}")
        yield f"pymeshlab.{suffix}", compare(f"pymeshlab.{suffix}", model_of(mesh))


def by_assimp():
    ball().export("ball.obj")
    for kind, suffix in (("glb2", "glb"), ("gltf2", "gltf"), ("objnomtl", "obj"), ("plyb", "ply"), ("stlb", "stl")):
        run("assimp", "export", "ball.obj", f"assimp.{suffix}", f"-f{kind}")
        yield f"assimp.{suffix}", compare(f"assimp.{suffix}", model_of(ball()))


def by_gltfpack():
    mesh = ball()
    mesh.export("ball.glb")
    model = model_of(mesh)
    for name, options, most in (
        ("-noq", ["-noq"], ROUNDING),
        ("14 bits", [], QUANTISED),
        ("-c", ["-c"], QUANTISED),
        ("-cc", ["-cc"], QUANTISED),
        ("-cc -vpf", ["-cc", "-vpf"], QUANTISED),
        ("-cf", ["-cf"], QUANTISED),
    ):
        file = f"gltfpack{len(options)}{'_'.join(options)}.glb"
        run("gltfpack", "-i", "ball.glb", "-o", file, *options)
        yield f"gltfpack {name}", compare(file, model, most=most)


def by_gltf_transform():
    mesh = ball()
    mesh.export("ball.glb")
    model = model_of(mesh)
    for name, most in (("copy", ROUNDING), ("draco", QUANTISED), ("meshopt", QUANTISED), ("quantize", QUANTISED)):
        run("gltf-transform", name, "ball.glb", f"gltf_transform_{name}.glb")
        yield f"gltf-transform {name}", compare(f"gltf_transform_{name}.glb", model, most=most)


def by_open_cascade():
    import build123d
    import cascadio
    import trimesh

    part = build123d.Box(10, 20, 30) - build123d.Pos(0, 6, 0) * build123d.Cylinder(2, 30)
    build123d.export_step(part, "part.step")
    build123d.export_gltf(part, "build123d.glb", binary=True, linear_deflection=0.001, angular_deflection=0.02)
    build123d.export_stl(part, "build123d.stl", tolerance=0.001, angular_tolerance=0.02)
    cascadio.step_to_glb("part.step", "cascadio.glb", 0.001, 0.02)
    middle, ways = np.array([0.5, -4, 2]), directions()
    own = []
    for way in ways:  # exact, on the body's own surfaces
        axis = build123d.Axis(tuple(middle), tuple(way))
        ahead = [(np.array(tuple(point)) - middle) @ way for point, _ in part.find_intersection_points(axis)]
        own.append(min(t for t in ahead if t > 0))
    for name, turn, scale in (
        ("build123d.stl, millimetres, z up", None, 1),
        ("build123d.glb, metres, y up", Y_UP, 1e-3),
        ("cascadio.glb, metres, z up", None, 1e-3),
    ):
        file = name.split(",")[0]
        read = trimesh.load(file, force="mesh").triangles / scale
        model = Model(read if turn is None else read @ turn, middle, ways, np.array(own))
        if abs(area(model.triangles) / part.area - 1) > 1e-3:
            raise RuntimeError(f"{file}: {area(model.triangles)} square millimetres, not {part.area}")
        yield name, compare(file, model, turn, scale=scale, most=1e-4)
    run_page("cascadio")


def by_ifcopenshell():
    import ifcopenshell
    import ifcopenshell.api.aggregate
    import ifcopenshell.api.context
    import ifcopenshell.api.geometry
    import ifcopenshell.api.project
    import ifcopenshell.api.root
    import ifcopenshell.api.spatial
    import ifcopenshell.api.unit
    import ifcopenshell.geom
    import trimesh

    file = ifcopenshell.api.project.create_file()
    ifcopenshell.api.root.create_entity(file, ifc_class="IfcProject")
    ifcopenshell.api.unit.assign_unit(file)  # millimetres
    whole = ifcopenshell.api.context.add_context(file, context_type="Model")
    body = ifcopenshell.api.context.add_context(
        file, context_type="Model", context_identifier="Body", target_view="MODEL_VIEW", parent=whole
    )
    wall = ifcopenshell.api.root.create_entity(file, ifc_class="IfcWall")
    shape = ifcopenshell.api.geometry.add_wall_representation(file, context=body, length=5, height=3, thickness=0.2)
    ifcopenshell.api.geometry.assign_representation(file, product=wall, representation=shape)
    matrix = np.array([[0, -1, 0, 7.0], [1, 0, 0, 2], [0, 0, 1, 1], [0, 0, 0, 1]])
    ifcopenshell.api.geometry.edit_object_placement(file, product=wall, matrix=matrix)
    file.write("building.ifc")
    run_page("ifcopenshell")
    for name, in_world in (("the wall's own frame", False), ("world coordinates", True)):
        settings = ifcopenshell.geom.settings()
        settings.set("use-world-coords", in_world)
        opened = ifcopenshell.open("building.ifc")
        shape = ifcopenshell.geom.create_shape(settings, opened.by_type("IfcWall")[0])
        corners, faces = np.reshape(shape.geometry.verts, (-1, 3)), np.reshape(shape.geometry.faces, (-1, 3))
        mesh = trimesh.Trimesh(corners, faces, process=False)
        box = np.array([[0, 0, 0], [5, 0.2, 3.0]])
        box = np.sort(box @ matrix[:3, :3].T + matrix[:3, 3], axis=0) if in_world else box
        if not np.allclose(mesh.bounds, box) or mesh.volume < 0:
            raise RuntimeError(f"bounds {mesh.bounds.tolist()}, volume {mesh.volume}")
        mesh.export("wall.ply")
        yield f"IFC, metres, {name}", compare("wall.ply", Model(mesh.triangles, mesh.bounds.mean(0), directions()))


def by_blender(folder):
    """The files are made by Blender's own Python, blender_files.py."""
    here = pathlib.Path(__file__).parent
    run(f"{folder}/bin/python", here / "blender_files.py")
    own = np.load("blender.npz")
    model = Model(own["triangles"], own["middle"], directions(), own["t"])
    for name, turn, most in (
        ("blender.glb, y up", Y_UP, ROUNDING),
        ("blender_draco.glb, y up", Y_UP, QUANTISED),
        ("blender_ext_meshopt.glb, y up", Y_UP, QUANTISED),
        ("blender_khr_meshopt.glb, y up", Y_UP, QUANTISED),
        ("blender.obj, y up", Y_UP, ROUNDING),
        ("blender.ply, z up", None, ROUNDING),
        ("blender.stl, z up", None, ROUNDING),
    ):
        file = pathlib.Path(name.split(",")[0])
        if not file.exists():  # an older Blender has no meshopt
            continue
        is_plain = most == QUANTISED and b"_compression" not in file.read_bytes()
        yield name + (", written plain" if is_plain else ""), compare(file.name, model, turn, most=most)
        file.unlink()


def by_radiance():
    """A sky of one radiance, with the exposure of pfilt: what the path tracer sees beside the body."""
    import OpenEXR
    import pyradiance

    programs = pathlib.Path(pyradiance.__file__).parent / "bin"
    ball().export("ball.glb")
    pixels = "\n".join(["1.004 1.004 1.004"] * 32 * 16)
    with open("sky.hdr", "wb") as file:
        command = [programs / "pvalue", "-r", "-h", "-d", "-y", "16", "+x", "32"]
        subprocess.run(command, input=pixels.encode(), stdout=file, check=True)
    with open("exposed.hdr", "wb") as file:
        subprocess.run([programs / "pfilt", "-1", "-e", "4", "sky.hdr"], stdout=file, check=True)
    if b"EXPOSURE=4" not in pathlib.Path("exposed.hdr").read_bytes():
        raise RuntimeError("pfilt writes no EXPOSURE=4")
    for name in ("sky.hdr", "exposed.hdr"):
        command = [pathlib.Path(sys.argv[1]) / "path_tracer", "ball.glb", "--environment", name, "--spp", 1]
        run(*command, "-o", "seen.exr", "--look-from", 0, 9, 0, "--look-at", 9, 12, 9)
        with OpenEXR.File("seen.exr") as file:
            seen = float(next(iter(file.channels().values())).pixels.mean())
        if abs(seen - 1.004) > 0.004:
            raise RuntimeError(f"{name}: a radiance of {seen}, not 1.004")
        yield name, f"| {abs(seen / 1.004 - 1):.1g}, of the radiance |"


TOOLS: dict[str, tuple[str, Callable]] = {
    "Blender": ("blender", lambda: by_blender("blender")),
    "newer Blender": ("newer_blender", lambda: by_blender("newer_blender")),
    "Open CASCADE": ("build123d", by_open_cascade),
    "IfcOpenShell": ("ifcopenshell", by_ifcopenshell),
    "gltfpack": ("gltfpack", by_gltfpack),
    "glTF-Transform": ("gltf-transform", by_gltf_transform),
    "PyVista": ("pyvista", by_pyvista),
    "MeshLab": ("pymeshlab", by_pymeshlab),
    "trimesh": ("trimesh", by_trimesh),
    "meshio": ("meshio", by_meshio),
    "Open3D": ("open3d", by_open3d),
    "assimp": ("assimp", by_assimp),
    "Radiance": ("pyradiance", by_radiance),
}


def version_of(program):
    """"" if it is not installed."""
    if program.endswith("blender"):  # the folder of its venv
        there = sorted(pathlib.Path(program).glob("lib/python*/site-packages/bpy-*.dist-info"))
        return there[0].name.split("-")[1].removesuffix(".dist") if there else ""
    if program == "assimp" and shutil.which(program):
        return run("sh", "-c", "assimp version | grep -o 'Version [0-9.]*'").split()[-1]
    if shutil.which(program) and program.startswith("gltf"):
        return run(program, "-v" if program == "gltfpack" else "--version").split()[-1]
    try:
        return importlib.metadata.version(program)
    except importlib.metadata.PackageNotFoundError:
        return ""


def main():
    print(f"{datetime.date.today()}\n")
    print("| tool | file | triangles | area off by | t off by, of the extent |\n|---|---|---|---|---|")
    failed = 0
    for tool, (program, make) in TOOLS.items():
        version = version_of(program)
        if not version:
            print(f"| {tool} | not installed | | | |")
            continue
        try:
            for file, found in make():
                print(f"| {tool} {version} | {file} | {found} |", flush=True)
        except Exception as error:  # noqa: BLE001 -- a tool's own failure is a row as well
            failed += 1
            print(f"| {tool} {version} | FAILED: {type(error).__name__}: {error} | | | |", flush=True)
    sys.exit(failed > 0)


if __name__ == "__main__":
    main()
