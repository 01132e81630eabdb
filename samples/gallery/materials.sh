#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
materials_scene.py materials.gltf
studio_sky.py studio.hdr
path_tracer materials.gltf --environment studio.hdr -o materials.png \
    --width 640 --height 360 --spp 40 --look-from 0 6.5 8.5 --look-at 0 0.35 0.1 --fov 34
