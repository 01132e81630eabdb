# SPDX-License-Identifier: MIT
"""Shows scenes in the window of the command ``twinray view``, through a temporary file."""

from __future__ import annotations

import os
import shutil
import subprocess
import tempfile
from typing import TYPE_CHECKING

import numpy as np

if TYPE_CHECKING:
    from .scene import Scene

_folders: list[
    tempfile.TemporaryDirectory[str]
] = []  # kept until this program ends, because the window may read the file again


def _write_ply(file, triangles):
    """Write triangles (3 m, 3) as binary PLY in float64."""
    faces = np.empty(len(triangles) // 3, np.dtype([("count", "u1"), ("vertices", "<i4", 3)]))
    faces["count"] = 3
    faces["vertices"] = np.arange(len(triangles)).reshape(-1, 3)
    header = (
        f"ply\nformat binary_little_endian 1.0\nelement vertex {len(triangles)}\n"
        "property double x\nproperty double y\nproperty double z\n"
        f"element face {len(faces)}\nproperty list uchar int vertex_indices\nend_header\n"
    )
    with open(file, "wb") as out:
        out.write(header.encode() + triangles.astype("<f8").tobytes() + faces.tobytes())


def view(scene: Scene, *options: str) -> subprocess.Popen[bytes]:
    """Implement `Scene.view`."""
    command = shutil.which(os.environ.get("TWINRAY_COMMAND", "twinray"))
    if command is None:
        raise FileNotFoundError("view: the command twinray is not in PATH, and TWINRAY_COMMAND does not name it")
    _folders.append(tempfile.TemporaryDirectory(prefix="twinray"))
    file = os.path.join(_folders[-1].name, "scene.ply")
    _write_ply(file, scene.world_triangles())
    return subprocess.Popen([command, "view", file, *options])
