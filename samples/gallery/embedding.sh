#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
tutorial_embedding .
mv 06_embedding.png embedding.png
