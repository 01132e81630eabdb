"""Float64 coordinates for a device that computes in float32: those far from 0 get a nearer origin."""

from __future__ import annotations

import numpy as np

_ROUNDING = 2.0**-24  # of float32
HARMLESS = 1e-6  # a rounding, in extents of a mesh


def rounding_of(coordinates):
    """Return an upper bound of the float32 rounding of these coordinates."""
    return float(np.max(np.abs(coordinates))) * _ROUNDING


def near_point(points):
    """Return the best origin (3,) for float32 coordinates of these points.

    It is 0, unless they would be rounded by more than a millionth of their extent; then it is a point near their
    middle with coordinates as round as the extent allows.
    """
    finite = points[np.isfinite(points).all(axis=1)]
    if len(finite) == 0:
        return np.zeros(3)
    low, high = finite.min(axis=0).astype(np.float64), finite.max(axis=0).astype(np.float64)
    extent = float((high - low).max())
    if rounding_of([low, high]) <= HARMLESS * extent or not np.isfinite(extent):
        return np.zeros(3)
    middle = low + (high - low) / 2
    if extent == 0:
        return middle
    step = 2.0 ** np.ceil(np.log2(extent))
    return np.round(middle / step) * step


class Frame:
    """The origin of a scene, and of each of its meshes."""

    def __init__(self, origin):
        self.origin = np.zeros(3) if origin is None else origin
        self._is_given = origin is not None
        self._of_mesh = {}  # by geometry

    def copy(self):
        """Return an independent copy."""
        other = Frame(self.origin if self._is_given else None)
        other.origin, other._of_mesh = self.origin, dict(self._of_mesh)
        return other

    def placed(self, positions, matrix):
        """Return positions and matrix (3, 4) of a new mesh in float32, and the origin of its positions."""
        mesh_origin = near_point(positions)
        if not self._is_given and not self._of_mesh:
            with np.errstate(over="ignore", invalid="ignore"):
                world = positions @ matrix[:3, :3].T + matrix[:3, 3]
            self.origin = near_point(world)
        return self.moved(positions, mesh_origin), self._on_device(matrix, mesh_origin), mesh_origin

    def keep(self, geometry, mesh_origin):
        """Store the origin of a geometry's vertices."""
        self._of_mesh[geometry] = mesh_origin

    def has_one_geometry(self):
        """Whether at most one geometry was added so far."""
        return len(self._of_mesh) <= 1

    def fixed_origin(self):
        """The origin as a tuple; None if the next mesh will decide it."""
        return tuple(self.origin) if self._is_given or self._of_mesh else None

    def keep_file(self, geometries, origin, has_nodes):
        """Store geometries of a file. If it has nodes, they contain the origin, else its vertices do."""
        self.origin = origin
        for geometry in geometries:
            self._of_mesh[geometry] = np.zeros(3) if has_nodes else origin

    def mesh_origin(self, geometry):
        """The origin of a geometry's vertices."""
        return self._of_mesh.get(geometry, np.zeros(3))

    def matrix_of(self, geometry, matrix):
        """The matrix of a geometry, (3, 4) in float32, from its vertices to the device's coordinates."""
        return self._on_device(matrix, self.mesh_origin(geometry))

    @staticmethod
    def moved(points, origin):
        """Return points (..., 3) relative to the origin, in float32."""
        with np.errstate(over="ignore", invalid="ignore"):
            if origin.any():
                points = points.astype(np.float64) - origin
            return np.ascontiguousarray(points, dtype=np.float32)

    def _on_device(self, matrix, mesh_origin):
        with np.errstate(over="ignore", invalid="ignore"):
            placed = matrix[:3].copy()
            if mesh_origin.any() or self.origin.any():
                placed[:, 3] += matrix[:3, :3] @ mesh_origin - self.origin
            return np.ascontiguousarray(placed, dtype=np.float32)
