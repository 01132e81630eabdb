#!/usr/bin/env python3
"""Runs the own tests of Open3D and trimesh with twinray in place of their ray tracing.

    run_peers_tests.py open3d FILE [ARGUMENT OF PYTEST...]
    run_peers_tests.py trimesh CHECKOUT [ARGUMENT OF PYTEST...]

FILE is python/test/t/geometry/test_raycasting_scene.py of a clone of github.com/isl-org/Open3D; open3d is installed.
CHECKOUT is a clone of github.com/mikedh/trimesh with its models; its Python needs trimesh's packages for tests.
"""

import sys
import types
from pathlib import Path

import pytest
import twinray


def files_of_open3d(file):
    import open3d as o3d

    class RaycastingScene(twinray.Scene):
        """Open3D's constructor; devices are Vulkan's here."""

        def __init__(self, nthreads=0, device=None):
            super().__init__()

    helpers = types.ModuleType("open3d_test")  # the clone's; tests only ask for its list of devices
    helpers.list_devices = lambda **options: [o3d.core.Device("CPU:0")]
    sys.modules["open3d_test"] = helpers
    o3d.t.geometry.RaycastingScene = RaycastingScene
    return [file]


def files_of_trimesh(checkout):
    import trimesh
    import trimesh.ray
    from twinray.trimesh import RayMeshIntersector

    for name in ("ray_triangle", "ray_pyembree"):
        module = sys.modules.get(f"trimesh.ray.{name}") or types.ModuleType(f"trimesh.ray.{name}")
        module.RayMeshIntersector = RayMeshIntersector
        module.error = None
        sys.modules[f"trimesh.ray.{name}"] = module
        setattr(trimesh.ray, name, module)
    trimesh.ray.has_embree = True
    trimesh.base.ray_pyembree = trimesh.ray.ray_pyembree
    tests = Path(checkout) / "tests"
    sys.path.insert(0, str(tests))
    files = [tests / name for name in ("test_ray.py", "test_ray_upstream.py")]
    return [str(file) for file in files if file.exists()]


peer, place, *arguments = sys.argv[1:]
files = {"open3d": files_of_open3d, "trimesh": files_of_trimesh}[peer](place)
sys.exit(pytest.main(["-q", "-p", "no:cacheprovider", *files, *arguments]))
