# SPDX-License-Identifier: MIT
"""Scenes of triangle meshes, with the names, shapes and dtypes of Open3D's ``RaycastingScene``.

One file, since it is one class, half of which are docstrings.
"""

from __future__ import annotations

import logging
import os
import threading
import weakref
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import ArrayLike, DTypeLike, NDArray

from . import _core, picture
from . import device_array as _device
from ._arrays import Array, arrays_of_mesh, geometry_of, indices_of, matrix_of, number_of, rays_of, rows_of, vector_of
from ._frame import HARMLESS, Frame, rounding_of
from .pinhole import create_rays_pinhole

if TYPE_CHECKING:
    import subprocess

INVALID_ID: int = 0xFFFFFFFF  #: in place of the number of a geometry or a triangle, where there is none

_CPU_NOTE = "right, but tens to hundreds of times slower than on a GPU"
_log = logging.getLogger("twinray")
_told_of_cpu: set[str] = set()
_scenes: weakref.WeakSet[Scene] = weakref.WeakSet()


def _renew_locks():
    for scene in _scenes:
        scene._adding = threading.Lock()


os.register_at_fork(after_in_child=_renew_locks)  # a thread that held one is not there


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
    origin : array_like, (3,), optional
        What the device's float32 coordinates are counted from; by default the first mesh says: 0, unless it lies so far
        from there that it would be rounded by more than a millionth of its extent.

    Notes
    -----
    Rays are rows of six numbers, origin and direction; directions need not be unit, and ``t_hit`` counts in their
    lengths. The device computes in float32; what is given in float64 is counted from `origin` before it is rounded,
    so that scenes far from 0, as in UTM, keep their precision. Rays in float64 that begin more than 16 extents away,
    as from a sun or a satellite, are brought near the scene in float64 first; ``t_hit`` counts from where they began
    and is float64 then. Rays go to the device in blocks of a million. All calls may come from several threads.

    Pickles and copies hold the scene's meshes, not its device: a copy opens the device again, and so does a scene in a
    child process that a fork made. Warnings go to the logger "twinray". Ctrl-C ends any call.
    """

    def __init__(
        self,
        accel: Literal["auto", "sw", "hw"] = "auto",
        device: str | int | None = None,
        level: Literal["fast", "watertight", "refined", "certified"] = "watertight",
        origin: ArrayLike | None = None,
    ) -> None:
        for name, value in (("accel", accel), ("level", level)):
            if not isinstance(value, str):
                raise TypeError(f"{name}: {value!r} is not a str")
        self._open((accel, device, level), Frame(None if origin is None else vector_of(origin, "origin")))

    def _open(self, options, frame):
        accel, device, level = self._options = options
        if device is None:
            device = os.environ.get("TWINRAY_DEVICE", "")
        self._frame = frame
        self._adding = threading.Lock()  # the first mesh says the origin
        self._told_of_far = False
        self._core = _core.Scene(accel, str(device), level)
        _scenes.add(self)
        self._tell()

    def __getstate__(self) -> dict[str, Any]:
        with self._adding:
            return {"options": self._options, "frame": self._frame, "content": self._core.content()}

    def __setstate__(self, state: dict[str, Any]) -> None:
        self._open(state["options"], state["frame"].copy())
        self._core.restore(*state["content"])

    @property
    def backend(self) -> dict[str, str]:
        """The device and the accelerator that answer: a dict of strings.

        The keys are ``device``, ``driver``, ``kind``, ``accel``, ``why``, ``path``, ``level``, ``lists`` and ``note``.
        ``lists`` is the accelerator of `count_intersections` and `list_intersections`: "sw" always, since drivers may
        count an edge twice. Where ``accel`` is "hw" their first call builds it beside the driver's. ``note`` says how
        slow a CPU is as the device; it is empty for a GPU.
        """
        backend = self._core.backend()
        is_cpu = backend["kind"] == "CPU"
        return backend | {"note": _CPU_NOTE if is_cpu else ""}

    @property
    def origin(self) -> NDArray[np.float64]:
        """What the device's coordinates are counted from: (3,) float64."""
        return self._frame.origin

    def __repr__(self) -> str:
        backend = self.backend
        return (
            f"<twinray.Scene of {len(self)} geometries, {self._core.triangle_count()} triangles; "
            f"{backend['accel']} on {backend['device']}>"
        )

    def _repr_html_(self) -> str:
        from html import escape

        backend = self.backend
        rows = {"geometries": len(self), "triangles": self._core.triangle_count()} | backend
        cells = "".join(
            f"<tr><th>{escape(name)}</th><td>{escape(str(value))}</td></tr>" for name, value in rows.items()
        )
        return f"<table>{cells}</table>"

    def __len__(self) -> int:
        return len(self._core.geometries())

    def view(self, *options: str) -> subprocess.Popen[bytes]:
        """Open the scene, as it is now, in the window of the command ``twinray view``.

        Parameters
        ----------
        *options : str
            Of the command, as ``"--layer", "steps"``.

        Returns
        -------
        subprocess.Popen
            Of the command, which is in ``PATH`` or named by ``TWINRAY_COMMAND``.

        Raises
        ------
        FileNotFoundError
            Where there is no such command: it is built from the same sources, not part of this package.
        """
        from . import viewing

        return viewing.view(self, *options)

    def bounds(self) -> NDArray[np.float64]:
        """The box around all triangles, lowest and highest corner: (2, 3) float64, infinite where there are none."""
        return self._core.bounds() + self.origin

    def first_faces(self) -> NDArray[np.uint64]:
        """The number of each geometry's first face, where faces of all are numbered: (geometries + 1,) uint64."""
        return self._core.first_faces()

    def show(self, *args: Any, **options: Any) -> Any:
        """Make a picture of the scene, of rays and of what they hit.

        Parameters
        ----------
        rays : array_like, (..., 6), optional
            Drawn from their origins to `t_hit`, which they are cast for where it is not given; those that miss are
            blue. Behind surfaces they are faint. Of more than 2,000 every second, third, ... is drawn.
        t_hit : array_like, (...), optional
            Infinite for a miss.
        points : array_like, (n, 3), optional
        point_values : array_like, (n,), optional
            Numbers whose colours the points get.
        point_size : float
            Of points, across, in pixels; 5 by default.
        values : array_like, (faces,), optional
            Numbers whose colours the faces get (`first_faces` says which are whose); NaN: grey.
        value_range : (float, float), optional
            The values of the darkest and the brightest colour; by default the least and the greatest.
        eye, center, up : array_like, (3,), optional
            Where the camera stands, what it looks at and which way is up; by default all is seen, +y is up.
        fov_deg : float
            Horizontal, 40 by default.
        size : (int, int)
            Width and height in pixels, (640, 480) by default.
        interactive : bool
            True opens the window, or in a notebook the widget, of PyVista or trimesh, with their camera.

        Returns
        -------
        Picture
            Shown by notebooks; ``save("picture.png")`` writes it. With `interactive`, what that package returns.
        """
        return picture.show(self, *args, **options)

    def world_triangles(self) -> NDArray[np.float64]:
        """The vertices of all triangles where they are, three rows each: (3 m, 3) float64.

        Triangles of a mirrored geometry have their last two vertices exchanged, so that fronts stay fronts.
        """
        return self._core.world_triangles() + self.origin

    def to_trimesh(self) -> Any:
        """Give all triangles where they are as a ``trimesh.Trimesh``, which trimesh is installed for."""
        import trimesh

        triangles = self.world_triangles()
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
            From the mesh to the scene; columns are the images of the axes and of the origin. One that loses one
            direction, as a scale of 1, 1, 0 does, flattens the geometry for good.

        Returns
        -------
        int
            The number of the geometry: 0, 1, ...

        Raises
        ------
        ValueError, TypeError
            Naming the argument, its shape or dtype, and what is wanted.
        Error
            For an index that names no vertex, and a transform that leaves no area.
        """
        if triangle_indices is None:
            vertex_positions, triangle_indices = arrays_of_mesh(vertex_positions)
        positions, _ = rows_of(vertex_positions, "vertex_positions", None, 3)
        triangles = indices_of(triangle_indices, "triangle_indices")
        given = matrix_of(transform, "transform")
        with self._adding:
            positions, matrix, mesh_origin = self._frame.placed(positions, given)
            geometry = self._core.add(positions, triangles, matrix)
            self._frame.keep(geometry, mesh_origin)
        self._tell_if_far([geometry])
        return geometry

    def add_instance(self, geometry: int, transform: ArrayLike | None = None) -> int:
        """Add the mesh of a geometry once more, without another copy; returns the number of the new geometry."""
        number, matrix = geometry_of(geometry, "geometry"), matrix_of(transform, "transform")
        with self._adding:
            added = self._core.add_instance(number, self._frame.matrix_of(number, matrix))
            self._frame.keep(added, self._frame.mesh_origin(number))
        self._tell_if_far([added])
        return added

    def add_file(self, file: str | os.PathLike[str]) -> list[int]:
        """Add all that a file shows: .gltf, .glb, .obj, .ply or .stl.

        Returns
        -------
        list of int
            A number for each instance; those of one mesh share it.
        """
        name = os.fspath(file)
        with self._adding:
            fixed = self._frame.fixed_origin()
            added, origin = self._core.add_file(name, fixed)
            self._frame.keep_file(added, np.array(origin), name.lower().endswith((".gltf", ".glb")))
        if fixed:
            self._tell_if_far(added)
        self._tell()
        return added

    def remove(self, geometry: int) -> None:
        """Take a geometry out. Its number is not given again."""
        self._core.remove(geometry_of(geometry, "geometry"))

    def set_transform(self, geometry: int, transform: ArrayLike) -> None:
        """Move a geometry: `transform` is (4, 4) or (3, 4), from its mesh to the scene."""
        number, matrix = geometry_of(geometry, "geometry"), matrix_of(transform, "transform")
        self._core.set_transform(number, self._frame.matrix_of(number, matrix))
        self._tell_if_far([number])

    def update_vertices(self, geometry: int, vertex_positions: ArrayLike) -> None:
        """Move the vertices of a mesh, and of all its instances: as many as it has, (N, 3)."""
        positions, _ = rows_of(vertex_positions, "vertex_positions", None, 3)
        number = geometry_of(geometry, "geometry")
        self._core.update_vertices(number, self._frame.moved(positions, self._frame.mesh_origin(number)))

    # Rays

    def cast_rays(
        self, rays: ArrayLike, nthreads: int = 0, *, tnear: float = 0.0, tfar: float = np.inf, normals: bool = True
    ) -> dict[str, Array]:
        """Find what each ray meets first.

        Parameters
        ----------
        rays : array_like, (..., 6)
        nthreads : int
            Not used; for programs written for Open3D.
        tnear, tfar : float
            Only hits between them count.
        normals : bool
            False leaves ``primitive_normals`` out.

        Returns
        -------
        dict
            ``t_hit`` (...) float32, or float64 where a ray began far off, infinite for a miss; ``geometry_ids`` and
            ``primitive_ids`` (...) uint32, `INVALID_ID` for a miss; ``primitive_uvs`` (..., 2) float32: the point is
            (1 - u - v) a + u b + v c; ``primitive_normals`` (..., 3) float32, unit, on the triangle's front, which
            stays the front where a transform mirrors; 0 where the triangle has no area.
        """
        flat, shape = self._rays_of(rays)
        found = self._core.cast(*flat, *_interval(tnear, tfar), bool(normals))
        self._tell()
        return _shaped(found, shape)

    def test_occlusions(self, rays: ArrayLike, tnear: float = 0.0, tfar: float = np.inf, nthreads: int = 0) -> Array:
        """Tell whether each ray meets anything between `tnear` and `tfar`; (...) bool."""
        flat, shape = self._rays_of(rays)
        return self._core.occlusions(*flat, *_interval(tnear, tfar)).reshape(shape).view(Array)

    def count_intersections(
        self, rays: ArrayLike, nthreads: int = 0, *, tnear: float = 0.0, tfar: float = np.inf
    ) -> Array:
        """Count the triangles that each ray meets, an edge or vertex between them once; (...) int32."""
        flat, shape = self._rays_of(rays)
        return self._core.counts(*flat, *_interval(tnear, tfar)).reshape(shape).view(Array)

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
        flat, _ = self._rays_of(rays)
        splits, found = self._core.list(*flat, *_interval(tnear, tfar), bool(normals))
        if splits[-1] > INVALID_ID:
            raise _core.Error(f"list_intersections: {splits[-1]} hits; ray_splits holds numbers below 2**32")
        found["ray_splits"] = splits.astype(np.uint32)
        found["ray_ids"] = np.repeat(np.arange(len(flat[0]), dtype=np.uint32), np.diff(splits.astype(np.int64)))
        return {name: array.view(Array) for name, array in found.items()}

    # On the device

    def device_array(self, shape: int | tuple[int, ...], dtype: DTypeLike = np.float32) -> _device.DeviceArray:
        """Make an array in the memory of the scene's device, which NumPy, PyTorch and CuPy see without a copy.

        Parameters
        ----------
        shape : int or tuple of int
        dtype : dtype
            `HIT` for hits.

        Returns
        -------
        DeviceArray
            What it holds is not set.

        Raises
        ------
        Error
            Where the driver cannot export memory (``VK_KHR_external_memory_fd``).
        """
        return _device.device_array(self, shape, dtype)

    def trace(
        self,
        rays: _device.DeviceArray,
        hits: _device.DeviceArray | None = None,
        *,
        any_hit: bool = False,
    ) -> _device.DeviceArray:
        """Find what rays in the device's memory meet, without a copy through the host; returns when it is done.

        Parameters
        ----------
        rays : DeviceArray, (n, 8) float32
            Origin, tnear, direction, tfar of each, origins counted from `origin`. What CUDA writes there is waited for.
        hits : DeviceArray, (n,) of `HIT`, optional
            Written; by default a new one.
        any_hit : bool
            Any hit instead of the first.

        Returns
        -------
        DeviceArray
            `hits`.
        """
        return _device.trace(self, rays, hits, bool(any_hit))

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
            ``points`` (..., 3) float32, or float64 where `origin` is not 0; ``geometry_ids``, ``primitive_ids`` (...)
            uint32, ``primitive_uvs`` (..., 2), ``primitive_normals`` (..., 3) float32. Of an empty scene the numbers
            are `INVALID_ID`.
        """
        flat, shape = self._points_of(query_points)
        found = self._core.closest(flat, True)
        found["points"] = self._from_device(found["points"])
        del found["distances"]
        return _shaped(found, shape)

    def compute_distance(self, query_points: ArrayLike, nthreads: int = 0) -> Array:
        """Compute the distance of each point from the scene; (...) float32, infinite where it is empty."""
        flat, shape = self._points_of(query_points)
        return self._core.closest(flat, False)["distances"].astype(np.float32).reshape(shape).view(Array)

    def compute_winding_numbers(self, query_points: ArrayLike) -> Array:
        """Compute how often the scene winds around each point; (...) float64.

        Of closed meshes with fronts outward 0 outside, 1 inside, exactly; of open ones the generalized winding number
        (Jacobson, Kavan, Sorkine-Hornung 2013), the solid angle of all triangles over 4 pi; NaN for a point that is not
        finite.
        """
        flat, shape = self._points_of(query_points)
        return self._windings(flat).reshape(shape).view(Array)

    def compute_signed_distance(self, query_points: ArrayLike, nthreads: int = 0, nsamples: int = 1) -> Array:
        """Compute the distance of each point, negative inside; (...) float32.

        Inside is where the winding number, rounded, is not 0: see `compute_winding_numbers`. `nsamples` is not used: no
        rays vote here.
        """
        flat, shape = self._points_of(query_points)
        distances = self._core.closest(flat, False)["distances"]
        signed = np.where(self._is_inside(flat), -distances, distances)
        return signed.astype(np.float32).reshape(shape).view(Array)

    def compute_occupancy(self, query_points: ArrayLike, nthreads: int = 0, nsamples: int = 1) -> Array:
        """Tell which points are inside, by 1; others are 0; (...) float32. Inside is as for signed distances."""
        flat, shape = self._points_of(query_points)
        return self._is_inside(flat).astype(np.float32).reshape(shape).view(Array)

    @staticmethod
    def create_rays_pinhole(*args: Any, **options: Any) -> Array:
        """As the function `create_rays_pinhole`."""
        return create_rays_pinhole(*args, **options)

    INVALID_ID = INVALID_ID

    def _rays_of(self, rays):
        flat, shape = rays_of(rays)
        return (flat, self.origin.tolist()), shape

    def _points_of(self, points):
        flat, shape = rows_of(points, "query_points", np.float64, 3)
        return flat - self.origin, shape

    def _from_device(self, points):
        return points + self.origin if self.origin.any() else points.astype(np.float32)

    def _windings(self, points):
        windings = np.full(len(points), np.nan)
        is_finite = np.isfinite(points).all(axis=1)
        windings[is_finite] = self._core.winding_numbers(points[is_finite])
        return windings

    def _is_inside(self, points):
        return np.nan_to_num(np.rint(self._windings(points))) != 0

    def _tell_if_far(self, geometries):
        # Small parts of a large scene are no news.
        harmless = HARMLESS if self._frame.has_one_geometry() else 1000 * HARMLESS
        for geometry in () if self._told_of_far else geometries:
            farthest, extent = self._core.reach(geometry)
            rounding = rounding_of(farthest)
            if 0 < harmless * extent < rounding < np.inf:
                self._told_of_far = True
                _log.warning(
                    "geometry %d stands so far from the scene's origin %s that float32 moves it by up to %.2g; give "
                    "Scene an origin near it",
                    geometry,
                    self.origin.tolist(),
                    rounding,
                )
                return

    def _tell(self):
        for message in self._core.take_log():
            _log.warning("%s", message)
        backend = self.backend
        if backend["note"] and backend["device"] not in _told_of_cpu:
            _told_of_cpu.add(backend["device"])
            _log.warning("twinray runs on a CPU, by Vulkan device '%s': %s", backend["device"], backend["note"])


def _interval(tnear, tfar):
    return number_of(tnear, "tnear", 0), number_of(tfar, "tfar")


def _shaped(found, shape):
    return {name: array.reshape(shape + array.shape[1:]).view(Array) for name, array in found.items()}
