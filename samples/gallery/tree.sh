#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
tutorial_inside_the_builder .
mv 10_radix_tree.svg tree.svg
