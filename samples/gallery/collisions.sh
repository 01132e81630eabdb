#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
knots_scene.py knots.gltf
twinray collide knots.gltf --picture collisions.png --picture-size 640 400 \
    --view 0.3 0.5 -1
