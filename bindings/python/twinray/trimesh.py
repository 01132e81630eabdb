"""trimesh's ray interface: ``twinray.trimesh.use()``, or ``mesh.ray = twinray.trimesh.RayMeshIntersector(mesh)``."""

from __future__ import annotations

import functools
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from ._arrays import rows_of
from .scene import Scene

_uses: list[Use] = []  # not undone yet, the latest last


class Use:
    """The result of `use`. The end of a ``with`` block, or `undo`, restores trimesh's own engine for new meshes."""

    def __init__(self, options: dict[str, Any]) -> None:
        self._options = options

    def undo(self) -> None:
        """Undo the call of `use`. A second call does nothing."""
        if self in _uses:
            _uses.remove(self)

    def __enter__(self) -> Use:
        return self

    def __exit__(self, *_: Any) -> None:
        self.undo()


def use(
    accel: Literal["auto", "sw", "hw"] = "auto",
    device: str | int | None = None,
    level: Literal["fast", "watertight", "refined", "certified"] = "watertight",
) -> Use:
    """Make twinray the ray engine of all trimesh meshes created from now on, including copies and parts of others.

    ``with twinray.trimesh.use(): ...`` undoes this at its end. Meshes keep the engine with which they were created. The
    latest call that is not undone decides.

    Parameters
    ----------
    accel, device, level
        See `twinray.Scene`.
    """
    from trimesh import Trimesh

    if not hasattr(Trimesh.__init__, "_is_twinrays"):
        Trimesh.__init__ = _with_twinray(Trimesh.__init__)
    _uses.append(Use({"accel": accel, "device": device, "level": level}))
    return _uses[-1]


def _with_twinray(init):
    @functools.wraps(init)
    def made(mesh, *args, **options):
        init(mesh, *args, **options)
        for latest in _uses[-1:]:
            mesh.ray = RayMeshIntersector(mesh, **latest._options)

    made._is_twinrays = True
    return made


class RayMeshIntersector:
    """twinray's implementation of ``trimesh.Trimesh.ray``.

    Parameters
    ----------
    geometry : trimesh.Trimesh
        The mesh. Its triangles are read at the first query, and again after a change.
    accel, device, level
        See `twinray.Scene`.
    scale_to_box : bool
        Ignored; accepted for compatibility with trimesh.

    Notes
    -----
    Vertices and rays are moved to the centre of the mesh in float64 before they are rounded to float32. A ray that
    passes exactly between triangles hits one of them, never none and never two. With "hw", first hits and
    `intersects_any` are the driver's, which does not guarantee this. Results are ordered by ray, then by distance.
    """

    def __init__(
        self,
        geometry: Any,
        scale_to_box: bool = True,
        *,
        accel: Literal["auto", "sw", "hw"] = "auto",
        device: str | int | None = None,
        level: Literal["fast", "watertight", "refined", "certified"] = "watertight",
    ) -> None:
        self.mesh = geometry
        self._options = {"accel": accel, "device": device, "level": level}
        self._built = None

    def __getstate__(self):
        return {"mesh": self.mesh, "_options": self._options, "_built": None}

    def __deepcopy__(self, memo):
        from copy import deepcopy

        return type(self)(deepcopy(self.mesh, memo), **self._options)

    @property
    def scene(self) -> Scene:
        """The `twinray.Scene` of the mesh, whose origin is the centre of the mesh."""
        return self._scene_and_center()[0]

    def _scene_and_center(self):
        key = hash(self.mesh)
        if self._built is None or self._built[0] != key:
            vertices = np.asarray(self.mesh.vertices, np.float64).reshape(-1, 3)
            finite = vertices[np.isfinite(vertices).all(axis=1)]
            center = (finite.min(axis=0) + finite.max(axis=0)) / 2 if len(finite) else np.zeros(3)
            scene = Scene(**self._options)
            scene.add_triangles(vertices - center, self.mesh.faces)
            self._built = key, scene, center
        return self._built[1:]

    def _rays(self, ray_origins, ray_directions):
        origins, _ = rows_of(ray_origins, "ray_origins", np.float64, 3)
        directions, _ = rows_of(ray_directions, "ray_directions", np.float64, 3)
        if len(origins) != len(directions):
            raise ValueError(f"ray_directions: {len(directions)} rows, of ray_origins {len(origins)}")
        with np.errstate(invalid="ignore", divide="ignore"):
            directions = directions / np.abs(directions).max(axis=1, keepdims=True, initial=0)
            directions /= np.linalg.norm(directions, axis=1, keepdims=True)
        return origins, directions

    def _ask(self, question, origins, directions, **options):
        scene, center = self._scene_and_center()
        return getattr(scene, question)(np.hstack([origins - center, directions]), **options)

    def intersects_id(
        self,
        ray_origins: ArrayLike,
        ray_directions: ArrayLike,
        multiple_hits: bool = True,
        max_hits: int | None = None,
        return_locations: bool = False,
    ) -> tuple[NDArray[Any], ...]:
        """Find the triangles that each ray hits.

        Parameters
        ----------
        ray_origins, ray_directions : array_like, (n, 3)
        multiple_hits : bool
            Whether to return all hits, or only the first hit of each ray.
        max_hits : int, optional
            Largest number of hits per ray; None returns all.
        return_locations : bool

        Returns
        -------
        index_tri, index_ray : (m,) int64
        locations : (m, 3) float64
            Only with `return_locations`.
        """
        origins, directions = self._rays(ray_origins, ray_directions)
        if multiple_hits:
            found = self._ask("list_intersections", origins, directions)
            rays, triangles = found["ray_ids"].astype(np.int64), found["primitive_ids"].astype(np.int64)
            if max_hits is not None:
                rank = np.arange(len(rays)) - found["ray_splits"].astype(np.int64)[rays]
                rays, triangles = rays[rank < max_hits], triangles[rank < max_hits]
        else:
            first = self._ask("cast_rays", origins, directions, normals=False)
            rays = np.flatnonzero(np.isfinite(first["t_hit"]))
            triangles = first["primitive_ids"][rays].astype(np.int64)
        rays, triangles = rays.view(np.ndarray), triangles.view(np.ndarray)
        if not return_locations:
            return triangles, rays
        return triangles, rays, self._locations(origins[rays], directions[rays], triangles)

    def _locations(self, origins, directions, triangles):
        """Return the points where rays meet the planes of triangles, in float64, clamped to the triangles' boxes. For a
        ray nearly parallel to a triangle, rounding may move the point along the ray, out of the triangle."""
        corners = np.asarray(self.mesh.triangles, np.float64)[triangles].reshape(-1, 3, 3)
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        with np.errstate(invalid="ignore", divide="ignore"):
            distance = np.einsum("ij,ij->i", corners[:, 0] - origins, normals) / np.einsum(
                "ij,ij->i", directions, normals
            )
            points = origins + distance[:, None] * directions
        return np.clip(points, corners.min(axis=1), corners.max(axis=1)) if len(points) else points.reshape(0, 3)

    def intersects_location(
        self, ray_origins: ArrayLike, ray_directions: ArrayLike, multiple_hits: bool = True, **options: Any
    ) -> tuple[NDArray[Any], ...]:
        """Find the points where rays hit the mesh.

        Returns
        -------
        locations : (m, 3) float64
        index_ray, index_tri : (m,) int64
        """
        triangles, rays, locations = self.intersects_id(
            ray_origins, ray_directions, multiple_hits=multiple_hits, return_locations=True, **options
        )
        return locations, rays, triangles

    def intersects_first(self, ray_origins: ArrayLike, ray_directions: ArrayLike) -> NDArray[np.int32]:
        """Find the first triangle that each ray hits: (n,) int32, -1 for a miss."""
        origins, directions = self._rays(ray_origins, ray_directions)
        found = self._ask("cast_rays", origins, directions, normals=False)
        return found["primitive_ids"].view(np.ndarray).view(np.int32)

    def intersects_any(self, ray_origins: ArrayLike, ray_directions: ArrayLike) -> NDArray[np.bool_]:
        """Test whether each ray hits the mesh: (n,) bool."""
        origins, directions = self._rays(ray_origins, ray_directions)
        return self._ask("test_occlusions", origins, directions).view(np.ndarray)

    def contains_points(self, points: ArrayLike) -> NDArray[np.bool_]:
        """Test whether each point is inside, with winding numbers: (n,) bool."""
        rows, _ = rows_of(points, "points", np.float64, 3)
        scene, center = self._scene_and_center()
        return scene.compute_occupancy(rows - center).view(np.ndarray) != 0
