#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
window_scene.py window.gltf
studio_sky.py studio.hdr
path_tracer window.gltf --environment studio.hdr -o window.png \
    --width 640 --height 360 --spp 56 --look-from -3.5 3.4 10 --look-at 0.3 1.9 1 --fov 36
