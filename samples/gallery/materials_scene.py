#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Eight knots of as many materials. Usage: materials_scene.py FILE.gltf"""

import sys

import gltf
import shapes

scene = gltf.Gltf()
knot = shapes.tube(shapes.torus_knot(2, 3, 0.3), 0.2, around=36)
ball = shapes.sphere(1.0)


def glass(roughness, distance, color):
    """What absorbs light on its way: `color` is left of it after `distance`."""
    volume = {"thicknessFactor": 1, "attenuationDistance": distance, "attenuationColor": color}
    extensions = {"transmission": {"transmissionFactor": 1}, "ior": {"ior": 1.5}, "volume": volume}
    return scene.material((1, 1, 1), 0, roughness, **extensions)


materials = [
    scene.material((1.0, 0.71, 0.29), metallic=1, roughness=0.2),  # gold
    scene.material((0.85, 0.85, 0.88), metallic=1, roughness=0.45, anisotropy={"anisotropyStrength": 0.9}),
    scene.material((0.35, 0.01, 0.02), 0.4, 0.5, clearcoat={"clearcoatFactor": 1, "clearcoatRoughnessFactor": 0.03}),
    scene.material((0.05, 0.03, 0.25), 0, 0.9, sheen={"sheenColorFactor": [0.6, 0.5, 1], "sheenRoughnessFactor": 0.4}),
    scene.material((0.95, 0.64, 0.54), metallic=1, roughness=0.5),  # copper
    glass(roughness=0.0, distance=0.5, color=[0.1, 0.75, 0.55]),
    glass(roughness=0.25, distance=0.6, color=[0.9, 0.45, 0.1]),
    scene.material((0.03, 0.25, 0.3), roughness=0.25),
]
for i, material in enumerate(materials):
    scene.node(
        scene.mesh(knot, material),
        (2.3 * (i % 4 - 1.5), 0.5, 2.3 * (i // 4 - 0.5)),
        rotation=[-0.7071068, 0, 0, 0.7071068],
    )
scene.node(scene.mesh(shapes.ground(60), scene.material((0.18, 0.17, 0.16), roughness=0.6)))
scene.save(sys.argv[1])
