# SPDX-License-Identifier: MIT
"""Skies in patches, and sensors, as users of Radiance have them."""

from __future__ import annotations

import os
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from . import _core
from ._arrays import Array


def sky_patches(
    name: Literal["tregenza145", "reinhart577", "reinhart2305"] = "tregenza145",
) -> tuple[Array, Array]:
    """Give the middles and solid angles of the patches of a sky, as Radiance numbers them.

    Of Tregenza ("Subdivision of the sky hemisphere for luminance measurements", 1987), and Reinhart's division of each
    patch into 2 x 2 or 4 x 4.

    Parameters
    ----------
    name : {"tregenza145", "reinhart577", "reinhart2305"}

    Returns
    -------
    directions : Array, (n, 3) float64
        Unit; z is up, x east and y north. Patches go by row from the horizon up, in a row from north by east.
    solid_angles : Array, (n,) float64
        In steradians; together the hemisphere's 2 pi.
    """
    if not isinstance(name, str):
        raise TypeError(f"name: {name!r} is not a str")
    rows = _core.sky_patches(name)
    return rows[:, :3].view(Array), rows[:, 3].view(Array)


def read_sensors(file: str | os.PathLike[str]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Read a sensor file of Radiance: a line ``x y z dx dy dz`` a point.

    Returns
    -------
    points, normals : (n, 3) float64
    """
    rows = np.loadtxt(file, ndmin=2, comments="#")
    if rows.size and rows.shape[1] != 6:
        raise ValueError(f"file: lines of {rows.shape[1]} numbers in {file}; wanted are six")
    rows = rows.reshape(-1, 6)
    return rows[:, :3], rows[:, 3:]
