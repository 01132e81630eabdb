"""Watertight ray tracing, distances and inside tests for NumPy, on any Vulkan GPU or CPU.

>>> import numpy as np
>>> import twinray
>>> scene = twinray.Scene()
>>> triangle = scene.add_triangles([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
>>> scene.cast_rays([[0.25, 0.25, 2, 0, 0, -1]])["t_hit"]
Array([2.], dtype=float32)
"""

from __future__ import annotations

import atexit as _atexit
import sys as _sys
from typing import Any as _Any

from . import _core
from ._arrays import Array
from ._core import Error
from .analysis import (
    HIT_CLASSES,
    PAIR_CLASSES,
    centroid,
    collide,
    illumination,
    sky_light,
    verify,
    view_factors,
    visible,
)
from .device_array import HIT, DeviceArray
from .picture import Picture
from .pinhole import create_rays_pinhole
from .scene import INVALID_ID, Scene
from .sky import read_sensors, sky_patches

# Importing the core switches the GIL of a free-threaded Python on, unless its user keeps it off.
if not getattr(_sys, "_is_gil_enabled", lambda: True)():
    raise ImportError("twinray needs the GIL, which PYTHON_GIL=0 or -X gil=0 keeps off; run Python without them")

__all__ = [
    "Array",
    "DeviceArray",
    "Error",
    "HIT",
    "HIT_CLASSES",
    "INVALID_ID",
    "PAIR_CLASSES",
    "Picture",
    "Scene",
    "centroid",
    "collide",
    "create_rays_pinhole",
    "devices",
    "illumination",
    "read_sensors",
    "sky_light",
    "sky_patches",
    "verify",
    "view_factors",
    "visible",
]
__version__ = _core.__version__

_atexit.register(_core.forget_devices)


def devices() -> list[dict[str, _Any]]:
    """List the Vulkan devices of this machine.

    Returns
    -------
    list of dict
        ``name``, ``driver``, ``kind`` ("discrete GPU", "CPU", ...), and whether it has
        ``ray_query``, ``ray_tracing_pipeline`` and ``float64``.

    Raises
    ------
    Error
        If this machine has no Vulkan loader or driver.
    """
    return _core.devices()
