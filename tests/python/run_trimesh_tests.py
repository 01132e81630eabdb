#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Runs trimesh's own tests of rays with twinray in place of each of its intersectors.

    run_trimesh_tests.py CHECKOUT [ARGUMENT OF PYTEST...]

CHECKOUT is a clone of github.com/mikedh/trimesh with its models; its Python needs trimesh's packages for tests.
"""

import sys
import types
from pathlib import Path

import pytest
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

checkout = Path(sys.argv[1])
sys.path.insert(0, str(checkout / "tests"))
files = [str(checkout / "tests" / name) for name in ("test_ray.py", "test_ray_upstream.py")]
sys.exit(pytest.main(["-q", "-p", "no:cacheprovider", *[f for f in files if Path(f).exists()], *sys.argv[2:]]))
