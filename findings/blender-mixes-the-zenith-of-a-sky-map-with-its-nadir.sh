#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# A good guess: straight up, an environment texture of Cycles has the colour of the map's first row. A map that is white
# above the horizon and black below is white there, and a lit last row sends no light down on a floor.
# Seen: the texture repeats in both directions, so the half texel above the first row is mixed with the last row, which
# is at the other pole. The zenith of the map of halves is 0.50, and so is its nadir; the middle of row 0 is 1.00. One
# degree from the poles of 8 rows it is 0.54 and 0.46; interpolation "Closest" gives 1 and 0 there. A map of 8 rows
# whose last row alone is lit, straight below, lights the upper side of a floor: with a radiance of 100 a white floor
# has 0.64, where 0 is right. A map of halves with 2 rows gives the floor 0.82; without the mix it would be 0.91.
# Seen with bpy 5.2.3 on Python 3.13 on 2026-11-30. Needs Python 3.13, 1.5 GB and no root.
folder=$(mktemp -d)
pythons=3.13
# shellcheck source=findings/checks.sh
. "$(dirname "${BASH_SOURCE[0]}")/checks.sh"
make_venv venv bpy==5.2.3 numpy==2.4.6

cat >sky.py <<'END'
import math
import os

import bpy
import numpy as np


def render(sky, interpolation, place, turn, samples, floor):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.device = "CPU"
    scene.cycles.samples = samples
    scene.cycles.use_adaptive_sampling = False
    scene.cycles.use_denoising = False
    scene.cycles.sample_clamp_indirect = 0
    scene.render.threads_mode = "FIXED"
    scene.render.threads = 1
    scene.render.resolution_x = scene.render.resolution_y = 4
    scene.render.resolution_percentage = 100
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.image_settings.color_depth = "32"

    height, width = sky.shape
    image = bpy.data.images.new("sky", width, height, float_buffer=True, is_data=True)
    pixels = np.ones((height, width, 4), np.float32)
    pixels[..., :3] = sky[::-1, :, None]  # Blender counts rows from below
    image.pixels.foreach_set(pixels.ravel())
    image.update()
    image.pack()
    world = bpy.data.worlds.new("world")
    scene.world = world
    world.use_nodes = True
    texture = world.node_tree.nodes.new("ShaderNodeTexEnvironment")
    texture.image = image
    texture.interpolation = interpolation
    background = world.node_tree.nodes["Background"]
    background.inputs["Strength"].default_value = 1
    world.node_tree.links.new(texture.outputs["Color"], background.inputs["Color"])

    camera = bpy.data.cameras.new("camera")
    camera.angle = math.radians(0.02)
    seer = bpy.data.objects.new("camera", camera)
    seer.location = place
    seer.rotation_euler = [math.radians(angle) for angle in turn]
    bpy.context.collection.objects.link(seer)
    scene.camera = seer
    if floor:
        bpy.ops.mesh.primitive_plane_add(size=100)
        white = bpy.data.materials.new("white")
        white.use_nodes = True
        white.node_tree.nodes.clear()
        diffuse = white.node_tree.nodes.new("ShaderNodeBsdfDiffuse")
        diffuse.inputs["Color"].default_value = (1, 1, 1, 1)
        output = white.node_tree.nodes.new("ShaderNodeOutputMaterial")
        white.node_tree.links.new(diffuse.outputs["BSDF"], output.inputs["Surface"])
        bpy.context.object.data.materials.append(white)

    scene.render.filepath = os.path.abspath("seen.exr")
    bpy.ops.render.render(write_still=True)
    seen = bpy.data.images.load(scene.render.filepath)
    seen.colorspace_settings.name = "Non-Color"
    return np.mean(np.reshape(seen.pixels[:], (16, 4))[:, 0])


def halves(rows):
    sky = np.zeros((rows, 2 * rows), np.float32)
    sky[: rows // 2] = 1
    return sky


def look(sky, interpolation, from_zenith):
    return render(sky, interpolation, (0, 0, 0), (180 - from_zenith, 0, 0), 16, False)


def floor(sky):  # a white floor, so radiance is irradiance divided by pi
    return render(sky, "Linear", (5, 0, 5), (45, 0, 90), 4096, True)


# Without the mix, the sky of two rows is white to 45 degrees, then falls evenly to black at 135.
angles = (np.arange(100000) + 0.5) * np.pi / 200000
clamped = np.mean(np.clip(1.5 - angles * 2 / np.pi, 0, 1) * np.sin(2 * angles)) * np.pi / 2
below = np.zeros((8, 16), np.float32)
below[-1] = 100
with open("results", "w") as file:
    for interpolation in ("Linear", "Closest"):
        # The middle of row 0 of 8 is 11.25 degrees from the zenith.
        for angle in (0, 1, 11.25, 168.75, 179, 180):
            file.write(f"{interpolation}/{angle} {look(halves(8), interpolation, angle):.2f}\n")
    file.write(f"white {floor(np.ones((2, 4), np.float32)):.4f}\n")
    file.write(f"halves {floor(halves(2)):.4f}\n")
    file.write(f"clamped {clamped:.4f}\n")
    file.write(f"below {floor(below):.4f}\n")
END
venv/bin/python sky.py >log 2>&1
cat results
seen() { grep "^$1 " results | cut -d' ' -f2; }
near() { # what, seen, stated
    holds "$1: $3 within 5 %" "$(awk -v x="$2" -v y="$3" 'BEGIN { print (x > 0.95 * y && x < 1.05 * y) }')"
}
same "zenith, white above black, 8 rows" "$(seen Linear/0)" 0.50
same "the middle of row 0, 11.25 degrees from it" "$(seen Linear/11.25)" 1.00
same "the middle of row 7" "$(seen Linear/168.75)" 0.00
same "nadir" "$(seen Linear/180)" 0.50
same "1 degree from the zenith" "$(seen Linear/1)" 0.54
same "1 degree from the nadir" "$(seen Linear/179)" 0.46
same "1 degree from the zenith with Closest" "$(seen Closest/1)" 1.00
same "1 degree from the nadir with Closest" "$(seen Closest/179)" 0.00
near "floor under a white map" "$(seen white)" 1.0
near "floor under white above black, 2 rows (1/2 + 1/pi)" "$(seen halves)" 0.8183
near "the same by integration, without the mix" "$(seen clamped)" 0.9092
near "floor above a lit last row" "$(seen below)" 0.64
conclude
