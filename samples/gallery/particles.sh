#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
particles -o particles.png --frames 30 --samples 4 --width 400 --height 400
