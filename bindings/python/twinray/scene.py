# SPDX-License-Identifier: MIT
"""Scenes of triangle meshes, with the names, shapes and dtypes of Open3D's ``RaycastingScene``."""

from __future__ import annotations

import os
import warnings
from html import escape
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from . import _core
from ._arrays import Array, array_of, geometry_of, indices_of, matrix_of, number_of, rows_of
from ._winding import winding_numbers_of_open_meshes

INVALID_ID: int = 0xFFFFFFFF  #: in place of the number of a geometry or a triangle, where there is none

_told_of_cpu: set[str] = set()


class Scene:
    """Triangle meshes on a Vulkan device, to be asked by rays and points.

    Parameters
    ----------
    accel : {"auto", "sw", "hw"}
        The accelerator: twinray's own compute shaders ("sw"), the driver's ("hw"), or the driver's where the device
        is a GPU with units for rays.
    device : str, optional
        A part of the device's name, or its index in `devices`; by default ``TWINRAY_DEVICE``, else the fastest.
    level : {"watertight", "refined", "certified", "fast"}
        Of the triangle test: "watertight" loses no ray at an edge, "refined" computes t, u and v in float64,
        "certified" decides hits and their order in float64, too; "fast" may lose rays at edges.

    Notes
    -----
    Rays are rows of six numbers, origin and direction, in float32; directions need not be unit, and ``t_hit`` counts
    in their lengths. Other dtypes are cast once. All calls may come from several threads.
    """

    def __init__(
        self,
        accel: Literal["auto", "sw", "hw"] = "auto",
        device: str | int | None = None,
        level: Literal["fast", "watertight", "refined", "certified"] = "watertight",
    ) -> None:
        for name, value in (("accel", accel), ("level", level)):
            if not isinstance(value, str):
                raise TypeError(f"{name}: {value!r} is not a str")
        if device is None:
            device = os.environ.get("TWINRAY_DEVICE", "")
        self._core = _core.Scene(accel, str(device), level)
        self._tell()

    @property
    def backend(self) -> dict[str, str]:
        """What answers: dict of ``device``, ``driver``, ``kind``, ``accel``, ``why``, ``path``, ``level``."""
        return self._core.backend()

    def __repr__(self) -> str:
        backend = self.backend
        return (
            f"<twinray.Scene of {len(self)} geometries, {self._core.triangle_count()} triangles; "
            f"{backend['accel']} on {backend['device']}>"
        )

    def _repr_html_(self) -> str:
        backend = self.backend
        rows = {"geometries": len(self), "triangles": self._core.triangle_count()} | backend
        cells = "".join(
            f"<tr><th>{escape(name)}</th><td>{escape(str(value))}</td></tr>" for name, value in rows.items()
        )
        return f"<table>{cells}</table>"

    def __len__(self) -> int:
        return len(self._core.geometries())

    def to_trimesh(self) -> Any:
        """Give all triangles where they are as a ``trimesh.Trimesh``, which trimesh is installed for."""
        import trimesh

        triangles = self._core.world_triangles()
        return trimesh.Trimesh(triangles, np.arange(len(triangles)).reshape(-1, 3), process=False)

    # Geometries

    def add_triangles(
        self,
        vertex_positions: ArrayLike | Any,
        triangle_indices: ArrayLike | None = None,
        *,
        transform: ArrayLike | None = None,
    ) -> int:
        """Add a mesh.

        Parameters
        ----------
        vertex_positions : array_like, (N, 3) float32, or a mesh
            A mesh of trimesh, Open3D or PyVista stands for both arrays.
        triangle_indices : array_like, (M, 3) uint32
        transform : array_like, (4, 4) or (3, 4), optional
            From the mesh to the scene; columns are the images of the axes and of the origin.

        Returns
        -------
        int
            The number of the geometry: 0, 1, ...

        Raises
        ------
        ValueError, TypeError
            Naming the argument, its shape or dtype, and what is wanted.
        Error
            For an index that names no vertex, and a transform that cannot be inverted.
        """
        if triangle_indices is None:
            vertex_positions, triangle_indices = arrays_of_mesh(vertex_positions)
        positions, _ = rows_of(vertex_positions, "vertex_positions", np.float32, 3)
        triangles = indices_of(triangle_indices, "triangle_indices")
        return self._core.add(positions, triangles, matrix_of(transform, "transform"))

    def add_instance(self, geometry: int, transform: ArrayLike | None = None) -> int:
        """Add the mesh of a geometry once more, without another copy; returns the number of the new geometry."""
        return self._core.add_instance(geometry_of(geometry, "geometry"), matrix_of(transform, "transform"))

    def add_file(self, file: str | os.PathLike[str]) -> list[int]:
        """Add all that a file shows: .gltf, .glb, .obj, .ply or .stl.

        Returns
        -------
        list of int
            A number for each instance; those of one mesh share it.

        Notes
        -----
        Coordinates become float32: what lies far from the origin, as in UTM, is better moved there first.
        """
        added = self._core.add_file(os.fspath(file))
        self._tell()
        return added

    def remove(self, geometry: int) -> None:
        """Take a geometry out. Its number is not given again."""
        self._core.remove(geometry_of(geometry, "geometry"))

    def set_transform(self, geometry: int, transform: ArrayLike) -> None:
        """Move a geometry: `transform` is (4, 4) or (3, 4), from its mesh to the scene."""
        self._core.set_transform(geometry_of(geometry, "geometry"), matrix_of(transform, "transform"))

    def update_vertices(self, geometry: int, vertex_positions: ArrayLike) -> None:
        """Move the vertices of a mesh, and of all its instances: as many as it has, (N, 3)."""
        positions, _ = rows_of(vertex_positions, "vertex_positions", np.float32, 3)
        self._core.update_vertices(geometry_of(geometry, "geometry"), positions)

    # Rays

    def cast_rays(
        self, rays: ArrayLike, nthreads: int = 0, *, tnear: float = 0.0, tfar: float = np.inf, normals: bool = True
    ) -> dict[str, Array]:
        """Find what each ray meets first.

        Parameters
        ----------
        rays : array_like, (..., 6) float32
        nthreads : int
            Not used; for programs written for Open3D.
        tnear, tfar : float
            Only hits between them count.
        normals : bool
            False leaves ``primitive_normals`` out.

        Returns
        -------
        dict
            ``t_hit`` (...) float32, infinite for a miss; ``geometry_ids`` and ``primitive_ids`` (...) uint32,
            `INVALID_ID` for a miss; ``primitive_uvs`` (..., 2) float32: the point is (1 - u - v) a + u b + v c;
            ``primitive_normals`` (..., 3) float32, unit, of the triangle.
        """
        flat, shape = rows_of(rays, "rays", np.float32, 6)
        found = self._core.cast(flat, *_interval(tnear, tfar), bool(normals))
        self._tell()
        return _shaped(found, shape)

    def test_occlusions(self, rays: ArrayLike, tnear: float = 0.0, tfar: float = np.inf, nthreads: int = 0) -> Array:
        """Tell whether each ray meets anything between `tnear` and `tfar`; (...) bool."""
        flat, shape = rows_of(rays, "rays", np.float32, 6)
        return self._core.occlusions(flat, *_interval(tnear, tfar)).reshape(shape).view(Array)

    def count_intersections(
        self, rays: ArrayLike, nthreads: int = 0, *, tnear: float = 0.0, tfar: float = np.inf
    ) -> Array:
        """Count the triangles that each ray meets, an edge or vertex between them once; (...) int32."""
        flat, shape = rows_of(rays, "rays", np.float32, 6)
        return self._core.counts(flat, *_interval(tnear, tfar)).reshape(shape).view(Array)

    def list_intersections(
        self, rays: ArrayLike, nthreads: int = 0, *, tnear: float = 0.0, tfar: float = np.inf, normals: bool = False
    ) -> dict[str, Array]:
        """List all that each ray meets, by ray, then by t; an edge or vertex between triangles once.

        Returns
        -------
        dict
            ``ray_splits`` (n + 1,) uint32: the hits of ray i are those from ``ray_splits[i]`` on, before
            ``ray_splits[i + 1]``; ``ray_ids``, ``t_hit``, ``geometry_ids``, ``primitive_ids`` (m,);
            ``primitive_uvs`` (m, 2); ``primitive_normals`` (m, 3) where asked for.
        """
        flat, _ = rows_of(rays, "rays", np.float32, 6)
        splits, found = self._core.list(flat, *_interval(tnear, tfar), bool(normals))
        if splits[-1] > INVALID_ID:
            raise _core.Error(f"list_intersections: {splits[-1]} hits; ray_splits holds numbers below 2**32")
        found["ray_splits"] = splits.astype(np.uint32)
        found["ray_ids"] = np.repeat(np.arange(len(flat), dtype=np.uint32), np.diff(splits.astype(np.int64)))
        return {name: array.view(Array) for name, array in found.items()}

    # Points

    def compute_closest_points(self, query_points: ArrayLike, nthreads: int = 0) -> dict[str, Array]:
        """Find the point of the scene that is closest to each.

        Parameters
        ----------
        query_points : array_like, (..., 3)
            Computed with in float64.

        Returns
        -------
        dict
            ``points`` (..., 3) float32, ``geometry_ids``, ``primitive_ids`` (...) uint32, ``primitive_uvs`` (..., 2),
            ``primitive_normals`` (..., 3) float32. Of an empty scene the numbers are `INVALID_ID`.
        """
        flat, shape = rows_of(query_points, "query_points", np.float64, 3)
        found = self._core.closest(flat, True)
        found["points"] = found["points"].astype(np.float32)
        del found["distances"]
        return _shaped(found, shape)

    def compute_distance(self, query_points: ArrayLike, nthreads: int = 0) -> Array:
        """Compute the distance of each point from the scene; (...) float32, infinite where it is empty."""
        flat, shape = rows_of(query_points, "query_points", np.float64, 3)
        return self._core.closest(flat, False)["distances"].astype(np.float32).reshape(shape).view(Array)

    def compute_signed_distance(self, query_points: ArrayLike, nthreads: int = 0, nsamples: int = 1) -> Array:
        """Compute the distance of each point, negative inside; (...) float32.

        Inside is where the winding number is not 0. That is exact for closed meshes; of open ones it is the
        generalised winding number (Jacobson, Kavan, Sorkine-Hornung 2013), rounded. `nsamples` is not used: no rays
        vote here.
        """
        flat, shape = rows_of(query_points, "query_points", np.float64, 3)
        distances = self._core.closest(flat, False)["distances"]
        signed = np.where(self._is_inside(flat), -distances, distances)
        return signed.astype(np.float32).reshape(shape).view(Array)

    def compute_occupancy(self, query_points: ArrayLike, nthreads: int = 0, nsamples: int = 1) -> Array:
        """Tell which points are inside, by 1; others are 0; (...) float32. Inside is as for signed distances."""
        flat, shape = rows_of(query_points, "query_points", np.float64, 3)
        return self._is_inside(flat).astype(np.float32).reshape(shape).view(Array)

    @staticmethod
    def create_rays_pinhole(*args: Any, **options: Any) -> Array:
        """As the function `create_rays_pinhole`."""
        return create_rays_pinhole(*args, **options)

    INVALID_ID = INVALID_ID

    def _is_inside(self, points):
        if self._core.triangle_count() == 0:
            return np.zeros(len(points), bool)
        is_finite = np.isfinite(points).all(axis=1)
        inside = np.zeros(len(points), bool)
        if self._core.is_closed():
            inside[is_finite] = self._core.winding_numbers(points[is_finite]) != 0
        else:
            triangles = self._core.world_triangles().reshape(-1, 3, 3)
            inside[is_finite] = np.rint(winding_numbers_of_open_meshes(points[is_finite], triangles)) != 0
        return inside

    def _tell(self):
        for message in self._core.take_log():
            warnings.warn(message, stacklevel=3)
        backend = self.backend
        if backend["kind"] == "CPU" and backend["device"] not in _told_of_cpu:
            _told_of_cpu.add(backend["device"])
            warnings.warn(f"twinray runs on a CPU, by Vulkan device '{backend['device']}'", stacklevel=3)


def create_rays_pinhole(*args: Any, **options: Any) -> Array:
    """Make the rays of a pinhole camera.

    Called as ``create_rays_pinhole(fov_deg, center, eye, up, width_px, height_px)``: `fov_deg` is horizontal, x of
    pixels goes along `up` x (`center` - `eye`) and y along `up`, as Open3D has it; or as
    ``create_rays_pinhole(intrinsic_matrix, extrinsic_matrix, width_px, height_px)``: (3, 3), and (4, 4) from the
    scene to the camera, which looks along +z.

    Returns
    -------
    Array, (height_px, width_px, 6) float32
        Through the middles of pixels; directions reach the plane at distance 1.
    """
    if "fov_deg" in options or (args and np.ndim(args[0]) == 0):
        return _rays_looking_at(*args, **options)
    return _rays_of_matrices(*args, **options)


def _rays_looking_at(fov_deg, center, eye, up, width_px, height_px):
    fov = number_of(fov_deg, "fov_deg", 0)
    center, eye, up = (
        array_of(v, name).astype(np.float64) for v, name in ((center, "center"), (eye, "eye"), (up, "up"))
    )
    forward = (center - eye) / np.linalg.norm(center - eye)
    right = np.cross(up, forward)
    right /= np.linalg.norm(right)
    focal = 0.5 * width_px / np.tan(0.5 * np.deg2rad(fov))
    intrinsic = np.array([[focal, 0, 0.5 * width_px], [0, focal, 0.5 * height_px], [0, 0, 1]])
    extrinsic = np.eye(4)
    extrinsic[:3, :3] = [right, np.cross(forward, right), forward]
    extrinsic[:3, 3] = -extrinsic[:3, :3] @ eye
    return _rays_of_matrices(intrinsic, extrinsic, width_px, height_px)


def _rays_of_matrices(intrinsic_matrix, extrinsic_matrix, width_px, height_px):
    intrinsic = array_of(intrinsic_matrix, "intrinsic_matrix").astype(np.float64)
    extrinsic = array_of(extrinsic_matrix, "extrinsic_matrix").astype(np.float64)
    x, y = np.meshgrid(np.arange(width_px) + 0.5, np.arange(height_px) + 0.5)
    pixels = np.stack([x, y, np.ones_like(x)], axis=-1)
    to_scene = extrinsic[:3, :3].T @ np.linalg.inv(intrinsic)
    rays = np.empty((height_px, width_px, 6), np.float32)
    rays[..., :3] = -extrinsic[:3, :3].T @ extrinsic[:3, 3]
    rays[..., 3:] = pixels @ to_scene.T
    return rays.view(Array)


def arrays_of_mesh(mesh):
    """The vertices and triangles of a mesh of trimesh, Open3D (legacy or tensor) or PyVista."""
    if hasattr(mesh, "vertices") and hasattr(mesh, "faces"):
        return mesh.vertices, mesh.faces
    if hasattr(mesh, "vertices") and hasattr(mesh, "triangles"):
        return np.asarray(mesh.vertices), np.asarray(mesh.triangles)
    if hasattr(mesh, "vertex") and hasattr(mesh, "triangle"):
        return mesh.vertex.positions.cpu().numpy(), mesh.triangle.indices.cpu().numpy()
    if hasattr(mesh, "points") and hasattr(mesh, "regular_faces"):
        surface = mesh.triangulate()
        return np.asarray(surface.points), np.asarray(surface.regular_faces)
    raise TypeError(
        f"vertex_positions: {type(mesh).__name__} is no mesh of trimesh, Open3D or PyVista; give triangle_indices"
    )


def _interval(tnear, tfar):
    return number_of(tnear, "tnear", 0), number_of(tfar, "tfar")


def _shaped(found, shape):
    return {name: array.reshape(shape + array.shape[1:]).view(Array) for name, array in found.items()}
