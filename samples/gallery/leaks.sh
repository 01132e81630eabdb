#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
tutorial_robust_rays .
mv 07_robust_rays.png leaks.png
