#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
iso_surface gyroid.png
