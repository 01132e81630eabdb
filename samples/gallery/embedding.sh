#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
knots_scene.py knots.gltf
embed_renderer knots.gltf -o raster --frames 1 --balls 24 --width 480 --height 300 \
    --shadow-rays 0 --ao-rays 0
embed_renderer knots.gltf -o traced --frames 1 --balls 24 --width 480 --height 300 \
    --shadow-rays 16 --ao-rays 32
mv raster/frame_0000.png embedding_raster.png
mv traced/frame_0000.png embedding_traced.png
