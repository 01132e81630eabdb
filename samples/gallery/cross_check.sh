#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
path_tracer builtin:sunflower -o cross_check.png --width 320 --height 180 --spp 4 \
    --cross-check differences.txt
