"""Sky subdivisions and sensor files of Radiance."""

from __future__ import annotations

import os
from typing import Literal

import numpy as np
from numpy.typing import NDArray

from . import _core
from ._arrays import Array, count_of


def sky_patches(
    name: Literal["tregenza145", "reinhart577", "reinhart2305"] = "tregenza145",
    samples: int | None = None,
    seed: int = 1,
) -> tuple[Array, Array]:
    """Return the directions and solid angles of sky patches.

    The patches are Tregenza's ("Subdivision of the sky hemisphere for luminance measurements", 1987), and Reinhart's
    division of each into 2 x 2 or 4 x 4. Their order is Radiance's: patch k is bin k + 1 of ``reinhartb.cal`` and row
    k + 1 of ``gendaymtx``, whose row 0 is the ground.

    Parameters
    ----------
    name : {"tregenza145", "reinhart577", "reinhart2305"}
    samples : int, optional
        Number of random directions per patch, uniform in solid angle, instead of its centre. With its centre, a patch
        that a roof line cuts counts as wholly visible or hidden; the spread of samples gives the error of this.
    seed : int
        Seed of the random directions.

    Returns
    -------
    directions : Array, (n, 3) float64; with `samples` (samples, n, 3)
        Unit vectors; z is up, x east and y north. Rows go from the horizon up, and the patches of a row from north to
        east.
    solid_angles : Array, (n,) float64
        Solid angles in steradians; their sum is 2 pi.
    """
    if not isinstance(name, str):
        raise TypeError(f"name: {name!r} is not a str")
    rows = _core.sky_patches(name)
    middles, angles = rows[:, :3], rows[:, 3]
    if samples is None:
        return middles.view(Array), angles.view(Array)
    count = count_of(samples, "samples", 1, 2**20)
    return _within_patches(middles, count, count_of(seed, "seed", 0, 2**63)).view(Array), angles.view(Array)


def _within_patches(middles, count, seed):
    _, row, sizes = np.unique(middles[:, 2].round(9), return_inverse=True, return_counts=True)
    height = np.pi / 2 / (len(sizes) - 0.5)  # the last row is a cap of half of it
    low, high = (np.sin(np.minimum(height * (row + top), np.pi / 2)) for top in (0, 1))
    up, across = np.random.default_rng(seed).random((2, count, len(middles)))
    z = low + up * (high - low)
    azimuth = np.arctan2(middles[:, 0], middles[:, 1]) + (across - 0.5) * 2 * np.pi / sizes[row]
    flat = np.sqrt(1 - z * z)
    return np.stack([flat * np.sin(azimuth), flat * np.cos(azimuth), z], axis=-1)


def read_sensors(file: str | os.PathLike[str]) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Read a sensor file of Radiance, with one line ``x y z dx dy dz`` per point.

    Returns
    -------
    points, normals : (n, 3) float64
    """
    rows = np.loadtxt(file, ndmin=2, comments="#")
    if rows.size and rows.shape[1] != 6:
        raise ValueError(f"file: lines of {rows.shape[1]} numbers in {file}; expected six")
    rows = rows.reshape(-1, 6)
    return rows[:, :3], rows[:, 3:]
