"""What exporters.py reads of Blender: a turned and scaled body by all of its exporters, and the body's triangles and
hits by Blender itself, in blender.npz. Run by Blender's Python (bpy) in the folder that takes the files."""

import bpy
import numpy as np
from exporters import directions
from mathutils import Vector
from mathutils.bvhtree import BVHTree

bpy.ops.wm.read_factory_settings(use_empty=True)
bpy.ops.mesh.primitive_uv_sphere_add(
    segments=48, ring_count=24, location=(1, 2, 3), rotation=(0.3, 0.5, 0.7), scale=(1, 2, 1.5)
)
body = bpy.context.object
texture = body.modifiers.new("bumps", "CAST")
texture.cast_type, texture.factor = "CUBOID", 0.6
bpy.ops.object.modifier_apply(modifier="bumps")

mesh = body.data
mesh.calc_loop_triangles()
corners = np.array([body.matrix_world @ vertex.co for vertex in mesh.vertices])
faces = np.array([triangle.vertices for triangle in mesh.loop_triangles])
tree = BVHTree.FromPolygons(corners.tolist(), faces.tolist())
middle = np.array(body.matrix_world.translation)
t = [tree.ray_cast(Vector(middle), Vector(way))[3] for way in directions()]
np.savez("blender.npz", triangles=corners[faces], middle=middle, t=np.array(t))

bpy.ops.export_scene.gltf(filepath="blender.glb")
bpy.ops.export_scene.gltf(
    filepath="blender_draco.glb", export_draco_mesh_compression_enable=True, export_draco_position_quantization=14
)
if "export_meshopt_extension" in bpy.ops.export_scene.gltf.get_rna_type().properties:
    for name in ("EXT", "KHR"):
        bpy.ops.export_scene.gltf(
            filepath=f"blender_{name.lower()}_meshopt.glb",
            export_meshopt_compression_enable=True,
            export_meshopt_extension=f"{name}_meshopt_compression",
        )
bpy.ops.wm.obj_export(filepath="blender.obj")
bpy.ops.wm.ply_export(filepath="blender.ply")
bpy.ops.wm.stl_export(filepath="blender.stl")
