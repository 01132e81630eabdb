#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Runs Open3D's own tests of its RaycastingScene with twinray.Scene in its place.

    run_open3d_tests.py FILE [ARGUMENT OF PYTEST...]

FILE is python/test/t/geometry/test_raycasting_scene.py of a clone of github.com/isl-org/Open3D; open3d is installed.
"""

import sys
import types

import open3d as o3d
import pytest
import twinray


class RaycastingScene(twinray.Scene):
    """Open3D's constructor; devices are Vulkan's here."""

    def __init__(self, nthreads=0, device=None):
        super().__init__()


helpers = types.ModuleType("open3d_test")  # the clone's; tests only ask for its list of devices
helpers.list_devices = lambda **options: [o3d.core.Device("CPU:0")]
sys.modules["open3d_test"] = helpers
o3d.t.geometry.RaycastingScene = RaycastingScene
sys.exit(pytest.main(["-q", "-p", "no:cacheprovider", *sys.argv[1:]]))
