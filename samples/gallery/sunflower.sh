#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
path_tracer builtin:sunflower -o sunflower.png --width 640 --height 360 --spp 40 \
    --look-from 1.6 1.5 3.4 --look-at 0.2 0.45 0.9 --fov 38 --lens-radius 0.05
