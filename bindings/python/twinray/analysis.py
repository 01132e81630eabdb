# SPDX-License-Identifier: MIT
"""What rays tell of scenes: what is visible, view factors, light, centroids, collisions."""

from __future__ import annotations

import logging
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from ._arrays import Array, array_of, count_of, number_of, rows_of
from ._frame import rounding_of
from ._progress import in_blocks, watched
from .scene import Scene

HIT_CLASSES = (
    "AGREE",
    "TIE",
    "BOUNDARY",
    "BOUNDARY_HW_MISS",
    "UNSPECIFIED",
    "INVALID_INPUT",
    "SW_LEAK",
    "SW_FALSE",
    "T_ERR",
    "HW_LEAK",
    "HW_FALSE",
    "HW_T_ERR",
    "HW_RANGE",
)
PAIR_CLASSES = ("separate", "vertex_touch", "edge_touch", "coplanar_touch", "coplanar_overlap", "crossing")


_log = logging.getLogger("twinray")
_RAYS_OF_BLOCK = 1 << 22  # at least
_RAYS_OF_WARNING = 1 << 16  # about, that look for points on surfaces


def _scene_of(mesh):
    if isinstance(mesh, Scene):
        return mesh
    scene = Scene()
    scene.add_triangles(mesh)
    return scene


def _direction(value, name):
    array = array_of(value, name)
    if array.shape != (3,):
        raise ValueError(f"{name}: shape {array.shape}; wanted is (3,)")
    return [float(x) for x in array]


def _groups(groups, scene):
    if groups is None:
        return []
    array = array_of(groups, "groups")
    faces = scene._core.triangle_count()
    if array.shape != (faces,) or array.dtype.kind == "f" or (array.size and array.min() < 0):
        raise ValueError(
            f"groups: shape {array.shape}, dtype {array.dtype}; wanted are {faces} integers from 0, one a face"
        )
    return array.astype(np.uint32).tolist()


def _tell_of_own_surfaces(scene, points, vectors):
    """Warn where rays of points from which something is hidden meet a surface within rounding of where they begin."""
    step = max(1, len(points) * max(1, len(vectors)) // _RAYS_OF_WARNING)
    some = points[::step]
    if not (some.size and vectors.size):
        return
    rays = np.concatenate([np.repeat(some, len(vectors), axis=0), np.tile(vectors, (len(some), 1))], axis=1)
    t = scene._core.cast(rays, [0.0, 0.0, 0.0], 0.0, np.inf, False)["t_hit"].reshape(len(some), len(vectors))
    nearest = np.min(t * np.linalg.norm(vectors, axis=1), axis=1)
    here = int((nearest <= 16 * rounding_of([np.abs(some).max(), *(scene._core.bounds().ravel())])).sum())
    if here:
        _log.warning(
            "visible: %d of %d points that were looked at lie on the scene, and their rays meet the surface that they "
            "begin on; give normals, or tnear",
            here,
            len(some),
        )


def visible(
    points: ArrayLike,
    vectors: ArrayLike,
    normals: ArrayLike | None = None,
    *,
    scene: Scene | Any,
    tnear: float = 0.0,
    progress: bool = False,
) -> NDArray[np.uint8]:
    """Tell which points see free sky along which vectors.

    Parameters
    ----------
    points : array_like, (P, 3)
    vectors : array_like, (V, 3) float32
        Of any length, as patches of the sky (`sky_patches`).
    normals : array_like, (P, 3) float32, optional
        A vector that does not leave the side of a point's normal is not seen there. Rays begin off the point along its
        normal by what rounding may have moved a surface there, so that points on surfaces see what is before them.
    scene : Scene, or a mesh
    tnear : float
        How far off, in lengths of a vector, hits begin to count: for points on the scene itself without normals.
    progress : bool
        True shows a bar of tqdm's.

    Returns
    -------
    (P, V) uint8
        1 where nothing of the scene lies on the ray. All rays are never in memory at once.
    """
    rows, _ = rows_of(points, "points", None, 3)
    across, _ = rows_of(vectors, "vectors", np.float32, 3)
    sides = np.zeros((0, 3), np.float32) if normals is None else rows_of(normals, "normals", np.float32, 3)[0]
    if normals is not None and len(sides) != len(rows):
        raise ValueError(f"normals: {len(sides)} rows, of points {len(rows)}")
    scene = _scene_of(scene)
    near = number_of(tnear, "tnear", 0)
    rows = scene._frame.moved(rows, scene.origin)
    seen = np.empty((len(rows), len(across)), np.uint8)

    def fill(first, last):
        part = slice(first, last)
        seen[part] = _core.visible(scene._core, rows[part], across, sides[part], near).reshape(-1, len(across))

    in_blocks(len(rows), 1 + _RAYS_OF_BLOCK // max(1, len(across)), "visible" if progress else None, fill)
    if normals is None and near == 0:
        _tell_of_own_surfaces(scene, rows[~seen.all(axis=1)], across)
    return seen


def view_factors(
    scene: Scene | Any,
    groups: ArrayLike | None = None,
    *,
    sides: Literal["front", "both"] = "front",
    rays: int = 1 << 14,
    target_error: float | None = None,
    seed: int = 1,
    estimator: Literal["auto", "hits", "area", "contour"] = "auto",
    sparse: bool = False,
    progress: bool = False,
) -> tuple[Any, Any]:
    """Compute which fraction of the diffuse radiation of each face, or group of faces, meets each other one directly.

    Parameters
    ----------
    scene : Scene, or a mesh
    groups : array_like, (faces,) of int, optional
        To which group each face belongs. Faces are numbered by geometry, then by triangle.
    sides : {"front", "both"}
        Which sides of faces radiate. The front is where vertices turn counter-clockwise.
    rays : int
        Of a row; the most where `target_error` is set.
    target_error : float, optional
        A row ends when the 95 % interval of each of its entries is within +- this.
    seed : int
        The same, the same result.
    estimator : {"auto", "hits", "area", "contour"}
        Contour integrals for pairs that nothing can come between, rays between points of both for those far apart,
        else what the rays of a row meet; or one of them for all.
    sparse : bool
        True gives matrices of SciPy (CSR) instead of arrays.
    progress : bool
        True shows a bar of tqdm's.

    Returns
    -------
    F : (n, n) float64
        ``F[i, j]`` from i to j.
    half_width : (n, n) float64
        Half of the 95 % interval of each entry; 0 where F is 0 or no estimate.
    """
    if sides not in ("front", "both"):
        raise ValueError(f"sides: {sides!r} is not one of front, both")
    scene = _scene_of(scene)
    error = None if target_error is None else number_of(target_error, "target_error", 0)
    arguments = (
        scene._core, _groups(groups, scene), sides == "both", count_of(rays, "rays", 1, 2**31), error,
        count_of(seed, "seed", 0, 2**32 - 1), estimator,
    )  # fmt: skip
    if progress:
        found = watched(scene, "view factors", lambda: _core.view_factors(*arguments))
    else:
        found = _core.view_factors(*arguments)
    n = len(found["area"])
    half = (found["high"].astype(np.float64) - found["low"]) / 2
    matrices = []
    for values in (found["value"].astype(np.float64), half):
        if sparse:
            from scipy.sparse import csr_matrix

            first = found["first"].astype(np.int64)
            matrices.append(csr_matrix((values, found["column"].astype(np.int64), first), shape=(n, n)))
        else:
            dense = np.zeros((n, n))
            dense[np.repeat(np.arange(n), np.diff(found["first"].astype(np.int64))), found["column"]] = values
            matrices.append(dense)
    return tuple(matrices)


def illumination(
    scene: Scene | Any,
    direction: ArrayLike,
    groups: ArrayLike | None = None,
    *,
    side: int = 1000,
    sides: Literal["front", "both"] = "both",
    seed: int = 1,
) -> dict[str, NDArray[np.float64]]:
    """Compute what parallel light reaches, by a grid of rays in front of the scene.

    Parameters
    ----------
    scene : Scene, or a mesh
    direction : array_like, (3,)
        Of the light's rays.
    groups : array_like, (faces,) of int, optional
    side : int
        ``side * side`` rays.
    sides : {"front", "both"}

    Returns
    -------
    dict
        Arrays (n,) float64 by face or group: ``area`` as the light sees it, ``low`` and ``high``, its 95 % interval,
        ``unobstructed``, what it would be if nothing else were there, ``surface``, the faces' own, ``hits``.
    """
    scene = _scene_of(scene)
    rows, _ = _core.illumination(
        scene._core, _direction(direction, "direction"), count_of(side, "side", 1, 65535), sides != "front",
        count_of(seed, "seed", 0, 2**63), _groups(groups, scene),
    )  # fmt: skip
    return {name: rows[:, i] for i, name in enumerate(("hits", "area", "low", "high", "unobstructed", "surface"))}


def sky_light(
    scene: Scene | Any,
    zenith: ArrayLike = (0, 0, 1),
    *,
    samples: int = 256,
    sides: Literal["front", "both"] = "front",
    seed: int = 1,
) -> tuple[NDArray[np.float64], NDArray[np.float64], NDArray[np.float64]]:
    """Compute what each face gets of a uniform sky, in units of an unobstructed horizontal plane.

    Returns
    -------
    value, low, high : (faces,) float64
        Of the front, the sky view factor, with its 95 % interval.
    """
    rows = _core.sky_light(
        _scene_of(scene)._core, _direction(zenith, "zenith"), count_of(samples, "samples", 1, 2**20), sides != "front",
        count_of(seed, "seed", 0, 2**63),
    )  # fmt: skip
    return rows[:, 0], rows[:, 1], rows[:, 2]


def centroid(
    scene: Scene | Any, direction: ArrayLike, *, side: int = 1000, seed: int = 1
) -> tuple[NDArray[np.float64] | None, NDArray[np.float64] | None]:
    """Compute the mean of what is seen of a scene along a direction.

    Returns
    -------
    mean, standard_error : (3,) float64, or None where nothing is seen
    """
    scene = _scene_of(scene)
    mean, error, _, _ = _core.centroid(
        scene._core, _direction(direction, "direction"), count_of(side, "side", 1, 65535),
        count_of(seed, "seed", 0, 2**63),
    )  # fmt: skip
    return (None if mean is None else mean + scene.origin), (None if error is None else np.array(error))


def collide(
    scene: Scene | Any,
    *,
    self: bool = False,
    shared: Literal["index", "position"] = "index",
    segments: bool = False,
) -> dict[str, Any]:
    """Find the triangles of different geometries that touch or intersect, exactly.

    Parameters
    ----------
    scene : Scene
    self : bool
        Also those within a geometry that are no neighbours, or more than that.
    shared : {"index", "position"}
        Which vertices of a mesh are one, for neighbours.
    segments : bool
        Also where the insides of crossing triangles meet.

    Returns
    -------
    dict
        ``geometry_ids`` and ``primitive_ids`` (m, 2) uint32, ``classes`` (m,) uint8, indices into `PAIR_CLASSES`;
        ``segments`` (m, 2, 3) float64 where asked for, 0 for other classes.
    """
    if shared not in ("index", "position"):
        raise ValueError(f"shared: {shared!r} is not one of index, position")
    scene = _scene_of(scene)
    contacts, ends = _core.collide(scene._core, bool(self), shared == "position", bool(segments))
    found = {
        "geometry_ids": contacts[:, :2].copy().view(Array),
        "primitive_ids": contacts[:, 2:4].copy().view(Array),
        "classes": contacts[:, 4].astype(np.uint8).view(Array),
    }
    if segments:
        is_crossing = found["classes"] == PAIR_CLASSES.index("crossing")
        found["segments"] = ends.reshape(-1, 2, 3) + is_crossing[:, None, None] * scene.origin
    return found


def verify(scene: Scene | Any, rays: ArrayLike | None = None, *, count: int = 100_000, seed: int = 1) -> dict[str, Any]:
    """Judge closest hits by a reference on the CPU, in float64 and, where that cannot tell, more.

    Parameters
    ----------
    scene : Scene, or a mesh
    rays : array_like, (n, 6) float32, optional
        By default `count` are made: half random, a quarter aimed at vertices, a quarter at points of edges.

    Returns
    -------
    dict
        ``counts``, how often each of `HIT_CLASSES` occurred; ``faults``, how many rays got a wrong answer;
        ``bound_95``, below which the rate of faults is (95 %); ``classes`` (n,) uint8, indices into `HIT_CLASSES`;
        ``rays`` (n, 6) float32, or float64 where the scene's `origin` is not 0.
    """
    scene = _scene_of(scene)
    flat, _ = scene._rays_of(np.zeros((0, 6)) if rays is None else rays)
    found = _core.verify(scene._core, *flat, count_of(count, "count", 4, 2**31), count_of(seed, "seed", 0, 2**63))
    found["rays"] = found["rays"][:, [0, 1, 2, 4, 5, 6]]
    if scene.origin.any():
        found["rays"] = found["rays"] + np.concatenate([scene.origin, np.zeros(3)])
    return found
