# SPDX-License-Identifier: MIT
"""Scenes of peer_scenes.py for Mitsuba 3. mitsuba.set_variant() comes before the import."""
import mitsuba as mi
import numpy as np


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
        return {"type": "twosided", "bsdf": {"type": "roughconductor" if is_rough else "conductor", "material": "none", **rough}}
    return {"type": "roughdielectric" if is_rough else "dielectric", "int_ior": float(material["ior"]), "ext_ior": 1.0, **rough}


def mesh(name, part):
    """Every triangle has vertices of its own: flat."""
    positions = part["positions"].astype(np.float32)[part["triangles"]].reshape(-1, 3)
    properties = mi.Properties()
    properties["bsdf"] = mi.load_dict(bsdf(part["material"]))
    if part["material"].get("emission"):
        properties["emitter"] = mi.load_dict({"type": "area", "radiance": texture(part["material"]["emission"])})
    shape = mi.Mesh(name, len(positions), len(positions) // 3, has_vertex_texcoords=part["uvs"] is not None, props=properties)
    values = mi.traverse(shape)
    values["vertex_positions"] = positions.ravel()
    values["faces"] = np.arange(len(positions), dtype=np.uint32)
    if part["uvs"] is not None:
        uvs = part["uvs"].astype(np.float32)[part["triangles"]].reshape(-1, 2)
        values["vertex_texcoords"] = uvs.ravel()
    values.update()
    return shape


def sky(image, finer=64):
    """Mitsuba interpolates between pixels, the path tracer's light is constant in each. Columns begin a quarter of a turn later."""
    columns = image.shape[1] * finer
    fine = np.repeat(np.repeat(image, finer, axis=0), finer, axis=1)
    return {"type": "envmap", "bitmap": mi.Bitmap(np.roll(fine, -columns // 4, axis=1).astype(np.float32))}


def sensor(to_world, fov, side, sampler):
    return {"type": "perspective", "fov": float(fov), "fov_axis": "y", "near_clip": 0.001, "far_clip": 1e4, "to_world": to_world,
            "film": {"type": "hdrfilm", "width": side, "height": side, "rfilter": {"type": "box"}, "pixel_format": "rgb", "component_format": "float32"},
            "sampler": sampler}


def load(scene, side, sampler=None):
    eye = scene["eye"]
    to_world = mi.ScalarTransform4f().look_at(origin=eye, target=[eye[0], eye[1], eye[2] - 1], up=[0, 1, 0])
    parts = {f"part{i}": mesh(f"part{i}", part) for i, part in enumerate(scene["parts"])}
    if scene["sky"] is not None:
        parts["sky"] = sky(scene["sky"])
    # Mitsuba counts edges of paths, the path tracer scatterings.
    return mi.load_dict({"type": "scene", "integrator": {"type": "path", "max_depth": scene["depth"] + 1},
                         "sensor": sensor(to_world, scene["fov"], side, sampler or {"type": "independent"}), **parts})
