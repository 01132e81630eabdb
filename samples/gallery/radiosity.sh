#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
tutorial_view_factors .
mv 05_view_factors.png radiosity.png
