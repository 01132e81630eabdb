#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
town_scene.py town.gltf
sun_path.py sun.csv
twinray illumination town.gltf --sun sun.csv --samples 4 --sides front \
    --picture sun_hours.png --picture-size 640 360 --camera -95 75 105 -2 0 8
