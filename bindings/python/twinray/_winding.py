# SPDX-License-Identifier: MIT
"""Generalised winding numbers (Jacobson, Kavan, Sorkine-Hornung, "Robust Inside-Outside Segmentation using Generalized
Winding Numbers", 2013): sums of solid angles, for meshes that are not closed."""

import numpy as np

_PAIRS = 1 << 20  # of points and triangles at a time


def winding_numbers_of_open_meshes(points, triangles):
    """The winding number of triangles (m, 3, 3) around each point (n, 3), in float64.

    The angle of a triangle is by Van Oosterom and Strackee ("The solid angle of a plane triangle", 1983). Time and the
    number of pairs grow together, 10**7 or so a second.
    """
    sums = np.zeros(len(points))
    step = max(1, _PAIRS // max(1, len(triangles)))
    for first in range(0, len(points), step):
        some = points[first : first + step, None]
        a, b, c = (triangles[None, :, i] - some for i in range(3))
        la, lb, lc = (np.linalg.norm(v, axis=-1) for v in (a, b, c))
        volume = np.einsum("...i,...i", a, np.cross(b, c))
        below = (
            la * lb * lc
            + np.einsum("...i,...i", a, b) * lc
            + np.einsum("...i,...i", b, c) * la
            + np.einsum("...i,...i", c, a) * lb
        )
        sums[first : first + step] = np.arctan2(volume, below).sum(axis=1) / (2 * np.pi)
    return sums
