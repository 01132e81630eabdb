#!/usr/bin/env python3
"""Mitsuba 3 as reference of the path tracer, and as a peer in speed. In a Python that has mitsuba; its llvm variants need LLVM
(Debian: libllvm19).
    renderers.py references FOLDER                          pictures by Mitsuba of the scenes of peer_scenes.py, for the tests
    renderers.py check PATH_TRACER                          the path tracer against them: z-scores of blocks of pixels
    renderers.py times PATH_TRACER [--scene FILE EYE TARGET FOV SKY]...   variance x seconds of both
"""
import argparse
import json
import pathlib
import subprocess
import sys
import tempfile
import time

import mitsuba as mi
import numpy as np

import peer_scenes

SIDE, BLOCK = 64, 8
# Its own Cornell box has independent samples; ldsampler and multijitter are its best. orthogonal takes other numbers of
# samples.
MITSUBAS = [("scalar_rgb", "independent")] + [
    ("llvm_ad_rgb", sampler) for sampler in ("independent", "ldsampler", "multijitter")
]


def texture(color):
    if np.ndim(color) == 3:
        bitmap = mi.Bitmap(np.ascontiguousarray(color).astype(np.uint8))
        return {"type": "bitmap", "bitmap": bitmap, "raw": False, "filter_type": "bilinear", "wrap_mode": "repeat"}
    return {"type": "rgb", "value": list(map(float, color))}


def bsdf(material):
    if material["kind"] == "diffuse":
        return {"type": "twosided", "bsdf": {"type": "diffuse", "reflectance": texture(material["color"])}}
    alpha, is_rough = float(material["alpha"]), material["alpha"] > 0
    rough = {"distribution": "ggx", "alpha": alpha} if is_rough else {}
    if material["kind"] == "metal":
        conductor = "roughconductor" if is_rough else "conductor"
        return {"type": "twosided", "bsdf": {"type": conductor, "material": "none", **rough}}
    dielectric = "roughdielectric" if is_rough else "dielectric"
    return {"type": dielectric, "int_ior": float(material["ior"]), "ext_ior": 1.0, **rough}


def mesh(name, part):
    """Every triangle has vertices of its own: flat."""
    positions = part["positions"].astype(np.float32)[part["triangles"]].reshape(-1, 3)
    properties = mi.Properties()
    properties["bsdf"] = mi.load_dict(bsdf(part["material"]))
    if part["material"].get("emission"):
        properties["emitter"] = mi.load_dict({"type": "area", "radiance": texture(part["material"]["emission"])})
    shape = mi.Mesh(name, len(positions), len(positions) // 3, has_vertex_texcoords=part["uvs"] is not None,
                    props=properties)
    values = mi.traverse(shape)
    values["vertex_positions"] = positions.ravel()
    values["faces"] = np.arange(len(positions), dtype=np.uint32)
    if part["uvs"] is not None:
        uvs = part["uvs"].astype(np.float32)[part["triangles"]].reshape(-1, 2)
        values["vertex_texcoords"] = uvs.ravel()
    values.update()
    return shape


def sky(image, finer=64):
    """Mitsuba interpolates between pixels, the path tracer's light is constant in each. Columns begin a quarter of a
    circle later."""
    columns = image.shape[1] * finer
    fine = np.repeat(np.repeat(image, finer, axis=0), finer, axis=1)
    return {"type": "envmap", "bitmap": mi.Bitmap(np.roll(fine, -columns // 4, axis=1).astype(np.float32))}


def sensor(to_world, fov, side, sampler):
    film = {"type": "hdrfilm", "width": side, "height": side, "rfilter": {"type": "box"}, "pixel_format": "rgb",
            "component_format": "float32"}
    return {"type": "perspective", "fov": float(fov), "fov_axis": "y", "near_clip": 0.001, "far_clip": 1e4,
            "to_world": to_world, "film": film, "sampler": sampler}


def load(scene, side, sampler=None):
    """A scene of peer_scenes.py for Mitsuba, whose variant is set."""
    eye = scene["eye"]
    to_world = mi.ScalarTransform4f().look_at(origin=eye, target=[eye[0], eye[1], eye[2] - 1], up=[0, 1, 0])
    parts = {f"part{i}": mesh(f"part{i}", part) for i, part in enumerate(scene["parts"])}
    if scene["sky"] is not None:
        parts["sky"] = sky(scene["sky"])
    # Mitsuba counts edges of paths, the path tracer scatterings.
    return mi.load_dict({"type": "scene", "integrator": {"type": "path", "max_depth": scene["depth"] + 1},
                         "sensor": sensor(to_world, scene["fov"], side, sampler or {"type": "independent"}), **parts})


def blocks(picture):
    return picture.reshape(SIDE // BLOCK, BLOCK, SIDE // BLOCK, BLOCK, 3).mean(axis=(1, 3)).reshape(-1)


def mean_and_error(rows):
    rows = np.array(rows)
    return rows.mean(axis=0), rows.std(axis=0, ddof=1) / len(rows) ** 0.5


class PathTracer:
    """One scene, as a .gltf file in a folder of its own."""

    def __init__(self, program, accel, scene, folder):
        self.program, self.accel, self.depth, self.folder = program, accel, scene["depth"], folder
        (folder / "scene.gltf").write_text(peer_scenes.gltf_text(scene))
        self.sky = []
        if scene["sky"] is not None:
            mi.Bitmap(scene["sky"].astype(np.float32)).write(str(folder / "sky.exr"))
            self.sky = ["--environment", "sky.exr"]

    def render(self, side, spp, seed):
        """The picture and the seconds of rendering."""
        (self.folder / "run.json").unlink(missing_ok=True)
        subprocess.run([self.program, "scene.gltf", "-o", "out.exr", "--accel", self.accel, "--width", str(side), "--height", str(side),
                        "--spp", str(spp), "--seed", str(seed), "--max-depth", str(self.depth), "--filter", "box", "--quiet",
                        "--json", "run.json", *self.sky], check=True, cwd=self.folder, capture_output=True)
        picture = np.array(mi.Bitmap(str(self.folder / "out.exr")).convert(mi.Bitmap.PixelFormat.RGB))
        return picture, json.loads((self.folder / "run.json").read_text())["seconds"]


class Mitsuba:
    def __init__(self, variant, sampler, scene, side, spp):
        mi.set_variant(variant)
        self.variant, self.scene = variant, load(scene, side, {"type": sampler, "sample_count": spp})
        self.render(side, spp, 0)  # compiles

    def render(self, side, spp, seed):
        mi.set_variant(self.variant)
        start = time.perf_counter()
        picture = np.array(mi.render(self.scene, spp=spp, seed=seed))
        return picture, time.perf_counter() - start


def write_references(folder, runs=24, spp=512):
    mi.set_variant("llvm_ad_rgb")
    for make in peer_scenes.ALL:
        scene = make()
        loaded = load(scene, SIDE)
        mean, error = mean_and_error([blocks(np.array(mi.render(loaded, spp=spp, seed=seed))) for seed in range(1, runs + 1)])
        record = {"renderer": f"Mitsuba {mi.__version__}, llvm_ad_rgb, {runs} x {spp} spp", "side": SIDE, "block": BLOCK, "depth": scene["depth"],
                  "mean": [float(f"{x:.7g}") for x in mean], "error": [float(f"{x:.3g}") for x in error]}
        if scene["sky"] is not None:
            record.update(sky_width=scene["sky"].shape[1], sky=[float(np.float32(x)) for x in scene["sky"].reshape(-1)])
        (folder / f"{scene['name']}.json").write_text(json.dumps(record))
        (folder / f"{scene['name']}.gltf").write_text(peer_scenes.gltf_text(scene))
        print(scene["name"], mean.mean(), (error / mean).mean())


def check(program, runs=24, spp=256):
    from scipy import stats
    references = pathlib.Path(__file__).resolve().parents[2] / "tests/samples/peers"
    mi.set_variant("scalar_rgb")
    print("scene, accel: blocks x channels, mean z, rms z, largest |z|, p of Kolmogorov and Smirnov against N(0, 1)")
    for make in peer_scenes.ALL:
        scene = make()
        record = json.loads((references / f"{scene['name']}.json").read_text())
        for accel in ("sw", "hw"):
            with tempfile.TemporaryDirectory() as folder:
                ours = PathTracer(program, accel, scene, pathlib.Path(folder))
                mean, error = mean_and_error([blocks(ours.render(SIDE, spp, seed)[0]) for seed in range(1, runs + 1)])
            z = (mean - record["mean"]) / np.hypot(error, record["error"])
            print(f"{scene['name']}, {accel}: {len(z)}, {z.mean():.2f}, {np.sqrt((z * z).mean()):.2f}, {abs(z).max():.2f}, "
                  f"{stats.kstest(z, 'norm').pvalue:.3f}")


def asset_scene(path, eye, target, fov, sky):
    load_image = lambda file: np.array(mi.Bitmap(str(file)).convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.UInt8, True))
    parts = peer_scenes.seen_from(peer_scenes.parts_of(path, load_image), eye, target)
    pixels = np.array(mi.Bitmap(str(sky)).convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32, False))
    step = pixels.shape[0] // 64
    small = pixels[:64 * step, :128 * step].reshape(64, step, 128, step, 3).mean(axis=(1, 3))
    return {"name": path.stem, "parts": parts, "eye": [0, 0, 0], "fov": fov, "sky": small, "depth": 7}


def measure(program, scene, side, spp, rounds):
    """By backend: median seconds of a round, variance of a pixel's luminance."""
    with tempfile.TemporaryDirectory() as folder:
        backends = {f"mitsuba {variant} {sampler}": Mitsuba(variant, sampler, scene, side, spp) for variant, sampler in MITSUBAS}
        for accel in ("sw", "hw"):
            (pathlib.Path(folder) / accel).mkdir()
            backends[f"twinray {accel}"] = PathTracer(program, accel, scene, pathlib.Path(folder) / accel)
        seconds, pictures = {name: [] for name in backends}, {name: [] for name in backends}
        for seed in range(1, rounds + 1):
            for name, backend in backends.items():
                picture, taken = backend.render(side, spp, seed)
                seconds[name].append(taken)
                pictures[name].append(picture @ [0.2126, 0.7152, 0.0722])
    return {name: (np.median(seconds[name]), np.var(pictures[name], axis=0, ddof=1).mean(), np.mean(pictures[name])) for name in backends}


def times(program, scenes, side, spp, rounds):
    for scene in scenes:
        figures = measure(program, scene, side, spp, rounds)
        costs = {name: seconds * variance for name, (seconds, variance, _) in figures.items()}
        plain = min(cost for name, cost in costs.items() if name.endswith("independent"))
        best = min(cost for name, cost in costs.items() if name.startswith("mitsuba"))
        print(f"{scene['name']}, {side} x {side}, {spp} spp, {scene['depth']} scatterings, {rounds} rounds")
        for name, (seconds, variance, mean) in figures.items():
            print(f"  {name:31} {seconds:7.2f} s {side * side * spp / seconds * 1e-6:6.2f} Msamples/s  variance {variance:.3e}  mean {mean:.5f}"
                  f"  variance x s {variance * seconds:.3e}  {costs[name] / plain:5.2f} of the better independent,"
                  f" {costs[name] / best:5.2f} of its best sampler")


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("mode", choices=["references", "check", "times"])
    parser.add_argument("target", type=pathlib.Path, help="folder, or path_tracer")
    parser.add_argument("--scene", nargs=5, action="append", default=[], metavar=("FILE", "EYE", "TARGET", "FOV", "SKY"))
    parser.add_argument("--side", type=int, default=256)
    parser.add_argument("--spp", type=int, default=64)
    parser.add_argument("--rounds", type=int, default=5)
    options = parser.parse_args()
    if options.mode == "references":
        return write_references(options.target)
    program = str(options.target.resolve())
    if options.mode == "check":
        return check(program)
    mi.set_variant("scalar_rgb")
    vector = lambda text: [float(x) for x in text.split(",")]
    scenes = [peer_scenes.cornell_box()]
    scenes += [asset_scene(pathlib.Path(f), vector(eye), vector(target), float(fov), sky) for f, eye, target, fov, sky in options.scene]
    times(program, scenes, options.side, options.spp, options.rounds)


if __name__ == "__main__":
    sys.exit(main())
