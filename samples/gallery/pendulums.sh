#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
pendulums_scene.py pendulums.gltf
studio_sky.py studio.hdr
path_tracer pendulums.gltf --environment studio.hdr -o pendulums.png \
    --frames 3 --time-range 2:8 --width 320 --height 180 --spp 48 --exposure -0.4 \
    --look-from 4.2 4.9 0 --look-at 0 1 0 --fov 36
