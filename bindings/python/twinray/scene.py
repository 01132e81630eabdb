"""Scenes of triangle meshes, with the names, shapes and dtypes of Open3D's ``RaycastingScene``.

It is one file because it is one class; half of it are docstrings.
"""

from __future__ import annotations

import concurrent.futures.thread  # noqa: F401
import logging
import os
import sys
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

INVALID_ID: int = 0xFFFFFFFF  #: the number of the geometry or triangle of a miss

_CPU_NOTE = "results are correct, but a GPU is tens to hundreds of times faster"
_log = logging.getLogger("twinray")
_told_of_cpu: set[str] = set()
_scenes: weakref.WeakSet[Scene] = weakref.WeakSet()


def _renew_locks():
    for scene in _scenes:
        scene._adding = threading.Lock()


os.register_at_fork(after_in_child=_renew_locks)  # a thread that held one does not exist in the child


def _end_calls_of_threads():
    if getattr(sys, "last_type", None) is KeyboardInterrupt:
        _core.end_calls()


# Python joins the threads of executors when it ends. After Ctrl-C nobody waits for their results. Functions are called
# in the reverse order of registration: this one before that of executors, whose module is imported above.
if _register_at_exit := getattr(threading, "_register_atexit", None):
    _register_at_exit(_end_calls_of_threads)


class Scene:
    """A scene of triangle meshes on a Vulkan device, for ray and point queries.

    Parameters
    ----------
    accel : {"auto", "sw", "hw"}
        The accelerator: twinray's own compute shaders ("sw"), or the driver's ray tracing ("hw"). "auto" selects "hw"
        if the device supports it and is not a CPU.
    device : str, optional
        Part of the device's name, or its index in `devices`. Default: the environment variable ``TWINRAY_DEVICE``, else
        the fastest device.
    level : {"watertight", "refined", "certified", "fast"}
        Precision of the triangle test. "watertight" loses no ray at an edge. "refined" also computes t, u and v in
        float64. "certified" also decides hits and their order in float64. "fast" may lose rays at edges.
    origin : array_like, (3,), optional
        The origin of the device's float32 coordinates. By default it is 0, unless float32 would round the first mesh
        there by more than a millionth of its extent; then it is a point near that mesh.

    Notes
    -----
    A ray is a row of six numbers, origin and direction. Directions need not have unit length; ``t_hit`` is in units of
    the direction's length. The device computes in float32. Float64 input is first made relative to `origin`, then
    rounded, so scenes far from 0 keep their precision, for example in UTM coordinates. Float64 rays that begin more
    than 16 extents away, for example at a satellite, are first moved near the scene in float64; their ``t_hit`` is
    float64 and counts from where they began. Rays go to the device in blocks of a million. All methods are thread-safe.

    Pickles and copies contain the scene's meshes, not its device. A copy opens the device again, and so does a scene in
    a forked child process. Warnings go to the logger "twinray". Ctrl-C ends any call.
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
        self._adding = threading.Lock()  # the first mesh decides the origin
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
        """The device and the accelerator in use, as a dict of strings.

        The keys are ``device``, ``driver``, ``kind``, ``accel``, ``why``, ``path``, ``level``, ``lists`` and ``note``.
        ``lists`` is the accelerator of `count_intersections` and `list_intersections`. It is always "sw", because
        drivers may count an edge twice; if ``accel`` is "hw", their first call also builds the "sw" accelerator.
        ``note`` says how slow a CPU device is; it is empty for a GPU.
        """
        backend = self._core.backend()
        is_cpu = backend["kind"] == "CPU"
        return backend | {"note": _CPU_NOTE if is_cpu else ""}

    @property
    def origin(self) -> NDArray[np.float64]:
        """The origin of the device's coordinates: (3,) float64."""
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
        """Open the current scene in the window of the command ``twinray view``.

        Parameters
        ----------
        *options : str
            Options of the command, for example ``"--layer", "steps"``.

        Returns
        -------
        subprocess.Popen
            The process of the command, which must be in ``PATH`` or named by ``TWINRAY_COMMAND``.

        Raises
        ------
        FileNotFoundError
            If the command is not found. It is built from the same sources, but is not part of this package.
        """
        return picture.view(self, *options)

    def bounds(self) -> NDArray[np.float64]:
        """Return the lowest and highest corner of the box around all triangles: (2, 3) float64.

        They are infinite for an empty scene.
        """
        return self._core.bounds() + self.origin

    def first_faces(self) -> NDArray[np.uint64]:
        """Return the number of each geometry's first face, in the numbering of all faces: (geometries + 1,) uint64."""
        return self._core.first_faces()

    def show(self, *args: Any, **options: Any) -> Any:
        """Make a picture of the scene, with rays, hits and points.

        Parameters
        ----------
        rays : array_like, (..., 6), optional
            Rays to draw, from their origins to `t_hit`. Rays that miss are blue, and rays are faint behind surfaces. If
            there are more than 2,000, an even sample is drawn.
        t_hit : array_like, (...), optional
            Ends of the rays, infinite for a miss. Default: the rays are cast.
        points : array_like, (n, 3), optional
            Points to draw.
        point_values : array_like, (n,), optional
            Values that the colours of the points show.
        point_size : float
            Diameter of the points in pixels. Default: 5.
        values : array_like, (faces,), optional
            Values that the colours of the faces show, in the order of `first_faces`; NaN is grey.
        value_range : (float, float), optional
            The values of the darkest and the brightest colour. Default: the smallest and the largest value.
        eye, center, up : array_like, (3,), optional
            Position of the camera, the point it looks at, and the up direction. Default: the whole scene, with +y up.
        fov_deg : float
            Horizontal field of view in degrees. Default: 40.
        size : (int, int)
            Width and height in pixels. Default: (640, 480).
        interactive : bool
            Open a window of PyVista or trimesh, or in a notebook a widget, with their camera.

        Returns
        -------
        Picture
            Notebooks display it; ``save("picture.png")`` writes it. With `interactive`, the result of that package.
        """
        return picture.show(self, *args, **options)

    def world_triangles(self) -> NDArray[np.float64]:
        """Return the vertices of all triangles in scene coordinates, three rows each: (3 m, 3) float64.

        The last two vertices of the triangles of a mirrored geometry are swapped, so that fronts stay fronts.
        """
        return self._core.world_triangles() + self.origin

    def to_trimesh(self) -> Any:
        """Return all triangles in scene coordinates as a ``trimesh.Trimesh``; requires trimesh."""
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
            The vertices, or a mesh of trimesh, Open3D or PyVista in place of both arrays.
        triangle_indices : array_like, (M, 3) uint32
            Three vertex indices per triangle.
        transform : array_like, (4, 4) or (3, 4), optional
            Transform from the mesh to the scene; its columns are the images of the axes and of the origin. A transform
            that loses one direction, such as a scale of (1, 1, 0), flattens the geometry permanently.

        Returns
        -------
        int
            The number of the geometry: 0, 1, ...

        Raises
        ------
        ValueError, TypeError
            If an argument has the wrong shape or dtype; the message names it and the expected one.
        Error
            If an index is out of range, or a transform leaves no area.
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
        """Add another instance of a geometry's mesh, without a copy of it.

        Returns
        -------
        int
            The number of the new geometry.
        """
        number, matrix = geometry_of(geometry, "geometry"), matrix_of(transform, "transform")
        with self._adding:
            added = self._core.add_instance(number, self._frame.matrix_of(number, matrix))
            self._frame.keep(added, self._frame.mesh_origin(number))
        self._tell_if_far([added])
        return added

    def add_file(self, file: str | os.PathLike[str]) -> list[int]:
        """Add the contents of a scene file: .gltf, .glb, .obj, .ply or .stl.

        Returns
        -------
        list of int
            The numbers of the new geometries, one per instance. Instances of one mesh share its memory.
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
        """Remove a geometry. Its number is not used again."""
        self._core.remove(geometry_of(geometry, "geometry"))

    def set_transform(self, geometry: int, transform: ArrayLike) -> None:
        """Move a geometry; `transform` is (4, 4) or (3, 4), from its mesh to the scene."""
        number, matrix = geometry_of(geometry, "geometry"), matrix_of(transform, "transform")
        self._core.set_transform(number, self._frame.matrix_of(number, matrix))
        self._tell_if_far([number])

    def update_vertices(self, geometry: int, vertex_positions: ArrayLike) -> None:
        """Move the vertices of a mesh and of all its instances; (N, 3), with N unchanged."""
        positions, _ = rows_of(vertex_positions, "vertex_positions", None, 3)
        number = geometry_of(geometry, "geometry")
        self._core.update_vertices(number, self._frame.moved(positions, self._frame.mesh_origin(number)))

    # Rays

    def cast_rays(
        self, rays: ArrayLike, nthreads: int = 0, *, tnear: float = 0.0, tfar: float = np.inf, normals: bool = True
    ) -> dict[str, Array]:
        """Find the first hit of each ray.

        Parameters
        ----------
        rays : array_like, (..., 6)
        nthreads : int
            Ignored; accepted for compatibility with Open3D.
        tnear, tfar : float
            Only hits between these values of t count.
        normals : bool
            Whether to return ``primitive_normals``.

        Returns
        -------
        dict
            ``t_hit`` (...) float32, or float64 if a ray began far away; infinite for a miss. ``geometry_ids`` and
            ``primitive_ids`` (...) uint32, `INVALID_ID` for a miss. ``primitive_uvs`` (..., 2) float32; the hit point
            is (1 - u - v) a + u b + v c. ``primitive_normals`` (..., 3) float32, of unit length, on the front of the
            triangle, which mirroring transforms do not change; 0 for a triangle without area.
        """
        flat, shape = self._rays_of(rays)
        found = self._core.cast(*flat, *_interval(tnear, tfar), bool(normals))
        self._tell()
        return _shaped(found, shape)

    def test_occlusions(self, rays: ArrayLike, tnear: float = 0.0, tfar: float = np.inf, nthreads: int = 0) -> Array:
        """Test whether each ray hits anything between `tnear` and `tfar`; (...) bool."""
        flat, shape = self._rays_of(rays)
        return self._core.occlusions(*flat, *_interval(tnear, tfar)).reshape(shape).view(Array)

    def count_intersections(
        self, rays: ArrayLike, nthreads: int = 0, *, tnear: float = 0.0, tfar: float = np.inf
    ) -> Array:
        """Count the triangles that each ray hits; a shared edge or vertex counts once; (...) int32."""
        flat, shape = self._rays_of(rays)
        return self._core.counts(*flat, *_interval(tnear, tfar)).reshape(shape).view(Array)

    def list_intersections(
        self, rays: ArrayLike, nthreads: int = 0, *, tnear: float = 0.0, tfar: float = np.inf, normals: bool = False
    ) -> dict[str, Array]:
        """List all hits, ordered by ray, then by t. A hit at a shared edge or vertex is listed once.

        Returns
        -------
        dict
            ``ray_splits`` (n + 1,) uint32: the hits of ray i begin at ``ray_splits[i]`` and end before
            ``ray_splits[i + 1]``. ``ray_ids``, ``t_hit``, ``geometry_ids``, ``primitive_ids`` (m,).
            ``primitive_uvs`` (m, 2). With `normals`, ``primitive_normals`` (m, 3).
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
        """Create an array in the memory of the scene's device, which NumPy, PyTorch and CuPy access without a copy.

        Parameters
        ----------
        shape : int or tuple of int
        dtype : dtype
            Use `HIT` for hits.

        Returns
        -------
        DeviceArray
            Its contents are undefined.

        Raises
        ------
        Error
            If the driver cannot export memory (``VK_KHR_external_memory_fd``).
        """
        return _device.device_array(self, shape, dtype)

    def trace(
        self,
        rays: _device.DeviceArray,
        hits: _device.DeviceArray | None = None,
        *,
        any_hit: bool = False,
    ) -> _device.DeviceArray:
        """Trace rays in the device's memory, without a copy through the host. Returns when the hits are written.

        Parameters
        ----------
        rays : DeviceArray, (n, 8) float32
            Origin (relative to `Scene.origin`), tnear, direction and tfar of each ray. Waits for CUDA's writes to them.
        hits : DeviceArray, (n,) of `HIT`, optional
            Array for the results. Default: a new one.
        any_hit : bool
            Find any hit instead of the first one.

        Returns
        -------
        DeviceArray
            The array `hits`.
        """
        return _device.trace(self, rays, hits, bool(any_hit))

    # Points

    def compute_closest_points(self, query_points: ArrayLike, nthreads: int = 0) -> dict[str, Array]:
        """Find the closest point of the scene to each query point.

        Parameters
        ----------
        query_points : array_like, (..., 3)
            Computation is in float64.

        Returns
        -------
        dict
            ``points`` (..., 3) float32, or float64 if `origin` is not 0. ``geometry_ids``, ``primitive_ids`` (...)
            uint32; `INVALID_ID` if the scene is empty. ``primitive_uvs`` (..., 2) and ``primitive_normals`` (..., 3)
            float32.
        """
        flat, shape = self._points_of(query_points)
        found = self._core.closest(flat, True)
        found["points"] = self._from_device(found["points"])
        del found["distances"]
        return _shaped(found, shape)

    def compute_distance(self, query_points: ArrayLike, nthreads: int = 0) -> Array:
        """Compute the distance of each point to the scene; (...) float32, infinite if the scene is empty."""
        flat, shape = self._points_of(query_points)
        return self._core.closest(flat, False)["distances"].astype(np.float32).reshape(shape).view(Array)

    def compute_winding_numbers(self, query_points: ArrayLike) -> Array:
        """Compute the winding number of the scene around each point; (...) float64.

        For closed meshes whose fronts face outward it is exactly 0 outside and 1 inside. For open meshes it is the
        generalized winding number, the solid angle of all triangles divided by 4 pi (Jacobson, Kavan, Sorkine-Hornung
        2013). It is NaN for a point that is not finite.
        """
        flat, shape = self._points_of(query_points)
        return self._windings(flat).reshape(shape).view(Array)

    def compute_signed_distance(self, query_points: ArrayLike, nthreads: int = 0, nsamples: int = 1) -> Array:
        """Compute the signed distance of each point, negative inside; (...) float32.

        A point is inside if its rounded winding number is not 0; see `compute_winding_numbers`. `nsamples` is ignored,
        because no rays vote here.
        """
        flat, shape = self._points_of(query_points)
        distances = self._core.closest(flat, False)["distances"]
        signed = np.where(self._is_inside(flat), -distances, distances)
        return signed.astype(np.float32).reshape(shape).view(Array)

    def compute_occupancy(self, query_points: ArrayLike, nthreads: int = 0, nsamples: int = 1) -> Array:
        """Return 1 for points inside and 0 for others, as for signed distances; (...) float32."""
        flat, shape = self._points_of(query_points)
        return self._is_inside(flat).astype(np.float32).reshape(shape).view(Array)

    @staticmethod
    def create_rays_pinhole(*args: Any, **options: Any) -> Array:
        """Call the function `create_rays_pinhole`."""
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
        # Small parts of a large scene cause no warning.
        harmless = HARMLESS if self._frame.has_one_geometry() else 1000 * HARMLESS
        for geometry in () if self._told_of_far else geometries:
            farthest, extent = self._core.reach(geometry)
            rounding = rounding_of(farthest)
            if 0 < harmless * extent < rounding < np.inf:
                self._told_of_far = True
                _log.warning(
                    "geometry %d is so far from the scene's origin %s that float32 moves it by up to %.2g; give "
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
            _log.warning("twinray runs on a CPU, Vulkan device '%s': %s", backend["device"], backend["note"])


def _interval(tnear, tfar):
    return number_of(tnear, "tnear", 0), number_of(tfar, "tfar")


def _shaped(found, shape):
    return {name: array.reshape(shape + array.shape[1:]).view(Array) for name, array in found.items()}
