# SPDX-License-Identifier: MIT
"""Patches of the sky, as Radiance numbers them: rows of patches around the zenith, from the horizon up.

Tregenza's 145 ("Subdivision of the sky hemisphere for luminance measurements", 1987), and Reinhart's divisions of each
into m x m, the zenith's stays one (Bourgeois, Reinhart, Ward, "Standard daylight coefficient model for dynamic
daylighting simulations", 2008).
"""

import numpy as np

from ._arrays import Array

_ROWS = (30, 30, 24, 24, 18, 12, 6)  # patches of Tregenza's rows, 12 degrees high each, below the zenith's
_DIVISIONS = {"tregenza145": 1, "reinhart577": 2, "reinhart2305": 4}


def sky_patches(name="tregenza145"):
    """The middles and solid angles of the patches of a sky.

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
    try:
        m = _DIVISIONS[name]
    except (KeyError, TypeError):
        raise ValueError(f"name: {name!r} is not one of {', '.join(_DIVISIONS)}") from None
    height = np.deg2rad(90 / (len(_ROWS) * m + 0.5))  # of a row; the zenith's patch has half of one around it
    directions, angles = [], []
    for row in range(len(_ROWS) * m):
        count = _ROWS[row // m] * m
        altitude = (row + 0.5) * height
        azimuth = 2 * np.pi * np.arange(count) / count
        directions.append(
            np.stack(
                [np.sin(azimuth) * np.cos(altitude), np.cos(azimuth) * np.cos(altitude), np.full(count, np.sin(altitude))],
                axis=1,
            )
        )
        angles.append(np.full(count, 2 * np.pi / count * (np.sin((row + 1) * height) - np.sin(row * height))))
    directions.append([[0, 0, 1]])
    angles.append([2 * np.pi * (1 - np.sin(len(_ROWS) * m * height))])
    return np.concatenate(directions).view(Array), np.concatenate(angles).view(Array)


def read_sensors(file):
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
