#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
town_scene.py town.gltf
twinray view town.gltf --layer steps --tree-depth 5 --screenshot steps.png \
    --size 640 360 --camera -95 75 105 -2 0 8
