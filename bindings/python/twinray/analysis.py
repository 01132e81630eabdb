"""Analyses of scenes: visibility, view factors, light, centroids, collisions."""

from __future__ import annotations

import logging
import threading
from contextlib import nullcontext
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from ._arrays import Array, array_of, count_of, number_of, rows_of
from ._frame import rounding_of
from .scene import Scene

HIT_CLASSES: tuple[str, ...] = _core.HIT_CLASSES
PAIR_CLASSES: tuple[str, ...] = _core.PAIR_CLASSES

_log = logging.getLogger("twinray")
_RAYS_OF_BLOCK = 1 << 22  # at least
_RAYS_OF_WARNING = 1 << 16  # about, to look for points on surfaces
_MOST_STEPS = 100  # of a progress bar
_SECONDS = 0.1  # from one look at progress to the next


class _NoBar:
    @staticmethod
    def update(count):
        pass


def _bar(total, name):
    try:
        from tqdm.auto import tqdm
    except ImportError:
        raise ImportError("progress: requires tqdm, which is not installed") from None
    return tqdm(total=total, desc=name, leave=False)


def _in_blocks(count, least, name, work):
    """Call work(first, last) for blocks of at least `least` of `count` items. Without a name there is no bar."""
    step = max(least, -(-count // _MOST_STEPS))
    with nullcontext(_NoBar) if name is None else _bar(count, name) as bar:
        for first in range(0, count, step):
            work(first, min(first + step, count))
            bar.update(min(step, count - first))


def _watched(scene, name, work):
    """Return the result of work() while another thread counts its rows. Only this thread receives Ctrl-C."""
    has_ended = threading.Event()

    def count(bar):
        while not has_ended.wait(_SECONDS):
            done, bar.total = scene._core.progress()
            bar.update(done - bar.n)

    with _bar(None, name) as bar:
        counting = threading.Thread(target=count, args=(bar,))
        counting.start()
        try:
            return work()
        finally:
            has_ended.set()
            counting.join()


def _scene_of(mesh):
    if isinstance(mesh, Scene):
        return mesh
    scene = Scene()
    scene.add_triangles(mesh)
    return scene


def _direction(value, name):
    array = array_of(value, name)
    if array.shape != (3,):
        raise ValueError(f"{name}: shape {array.shape}; expected (3,)")
    return [float(x) for x in array]


def groups_of(groups, faces):
    """Integers (faces,), or None."""
    if groups is None:
        return None
    array = array_of(groups, "groups")
    if array.shape != (faces,) or array.dtype.kind == "f" or (array.size and array.min() < 0):
        raise ValueError(
            f"groups: shape {array.shape}, dtype {array.dtype}; expected {faces} integers from 0, one per face"
        )
    return array.astype(np.uint32)


def _groups(groups, scene):
    return [] if groups is None else groups_of(groups, scene._core.triangle_count()).tolist()


def _tell_of_own_surfaces(scene, points, vectors):
    """Warn if rays of points that do not see everything hit a surface within rounding of their origin."""
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
            "visible: %d of %d tested points lie on the scene, and their rays hit the surface that they begin on; "
            "pass normals or tnear",
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
    tfar: float = np.inf,
    progress: bool = False,
) -> NDArray[np.uint8]:
    """Test which points have an unobstructed view along which vectors.

    Parameters
    ----------
    points : array_like, (P, 3)
    vectors : array_like, (V, 3) float32
        View directions of any length, for example sky patches (`sky_patches`).
    normals : array_like, (P, 3) float32, optional
        A point does not see along vectors behind its normal. Rays begin at a small distance along the normal, as large
        as rounding may have moved a surface there, so a point on a surface does not hit that surface.
    scene : Scene, or a mesh
    tnear, tfar : float
        Only hits between these distances, in units of a vector's length, count; `tnear` is for points on the scene
        without normals.
    progress : bool
        Show a progress bar of tqdm.

    Returns
    -------
    (P, V) uint8
        1 if the ray hits nothing. Rays are processed in blocks, never all in memory at once.
    """
    rows, _ = rows_of(points, "points", None, 3)
    across, _ = rows_of(vectors, "vectors", np.float32, 3)
    sides = np.zeros((0, 3), np.float32) if normals is None else rows_of(normals, "normals", np.float32, 3)[0]
    if normals is not None and len(sides) != len(rows):
        raise ValueError(f"normals: {len(sides)} rows, of points {len(rows)}")
    scene = _scene_of(scene)
    near, far = number_of(tnear, "tnear", 0), number_of(tfar, "tfar")
    rows = scene._frame.moved(rows, scene.origin)
    seen = np.empty((len(rows), len(across)), np.uint8)

    def fill(first, last):
        part = slice(first, last)
        found = _core.visible(scene._core, rows[part], across, sides[part], near, far)
        seen[part] = found.reshape(seen[part].shape)

    _in_blocks(len(rows), 1 + _RAYS_OF_BLOCK // max(1, len(across)), "visible" if progress else None, fill)
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
    """Compute the view factors between all faces, or groups of faces.

    A view factor is the fraction of the diffuse radiation of one that reaches the other directly.

    Parameters
    ----------
    scene : Scene, or a mesh
    groups : array_like, (faces,) of int, optional
        The group of each face. Faces are ordered by geometry, then by triangle.
    sides : {"front", "both"}
        The sides of faces that radiate. The vertices appear counter-clockwise from the front.
    rays : int
        Number of rays per row; with `target_error` the largest number.
    target_error : float, optional
        Stop a row when the 95 % confidence interval of each of its entries is within +- this.
    seed : int
        Seed of the random numbers; the same seed gives the same result.
    estimator : {"auto", "hits", "area", "contour"}
        "auto" uses contour integrals for pairs that nothing can come between, rays between points of both for distant
        pairs, and hits of rays for all others. The other values use one estimator for all pairs.
    sparse : bool
        Return SciPy matrices (CSR) instead of arrays.
    progress : bool
        Show a progress bar of tqdm.

    Returns
    -------
    F : (n, n) float64
        ``F[i, j]`` is the view factor from i to j.
    half_width : (n, n) float64
        Half the width of the 95 % confidence interval of each entry; 0 if F is 0 or exact.
    """
    scene = _scene_of(scene)
    groups = groups_of(groups, scene._core.triangle_count())
    options = factor_arguments(groups, sides, rays, target_error, seed, estimator)

    def all_rows():
        factors = _core.ViewFactors(scene._core, *options)
        return factors.rows(0, factors.count())

    found = _watched(scene, "view factors", all_rows) if progress else all_rows()
    return matrices_of(found, len(found["first"]) - 1, sparse)


def factor_arguments(groups, sides, rays, target_error, seed, estimator):
    """Return the arguments of the extension module's ViewFactors after the scene."""
    if sides not in ("front", "both"):
        raise ValueError(f"sides: {sides!r} is not one of front, both")
    return (
        [] if groups is None else groups.tolist(), sides == "both", count_of(rays, "rays", 1, 2**31),
        None if target_error is None else number_of(target_error, "target_error", 0),
        count_of(seed, "seed", 0, 2**32 - 1), estimator,
    )  # fmt: skip


def matrices_of(found, columns, sparse):
    """F and the half-widths of its intervals, of rows that the extension module gives."""
    half = (found["high"].astype(np.float64) - found["low"]) / 2
    first, count = found["first"].astype(np.int64), len(found["first"]) - 1
    matrices = []
    for values in (found["value"].astype(np.float64), half):
        if sparse:
            from scipy.sparse import csr_matrix

            matrices.append(csr_matrix((values, found["column"].astype(np.int64), first), shape=(count, columns)))
        else:
            dense = np.zeros((count, columns))
            dense[np.repeat(np.arange(count), np.diff(first)), found["column"]] = values
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
    """Compute the area of each face, or group of faces, that parallel light reaches, with a grid of rays.

    Parameters
    ----------
    scene : Scene, or a mesh
    direction : array_like, (3,)
        Direction in which the light travels.
    groups : array_like, (faces,) of int, optional
        The group of each face.
    side : int
        The grid has ``side * side`` rays.
    sides : {"front", "both"}
        The sides of faces that receive light.

    Returns
    -------
    dict
        Arrays (n,) float64, one value per face or group: ``area``, the lit area perpendicular to the light; ``low`` and
        ``high``, its 95 % confidence interval; ``unobstructed``, that area without shadows; ``surface``, the area of
        the faces; ``hits``, the number of rays.
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
    """Compute the light of a uniform sky on each face, relative to an unobstructed horizontal plane.

    Returns
    -------
    value, low, high : (faces,) float64
        For the front, the sky view factor, with its 95 % confidence interval.
    """
    rows = _core.sky_light(
        _scene_of(scene)._core, _direction(zenith, "zenith"), count_of(samples, "samples", 1, 2**20), sides != "front",
        count_of(seed, "seed", 0, 2**63),
    )  # fmt: skip
    return rows[:, 0], rows[:, 1], rows[:, 2]


def centroid(
    scene: Scene | Any, direction: ArrayLike, *, side: int = 1000, seed: int = 1
) -> tuple[NDArray[np.float64] | None, NDArray[np.float64] | None]:
    """Compute the mean of the points of a scene that are visible along a direction.

    Returns
    -------
    mean, standard_error : (3,) float64, or None if nothing is visible
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
        Also report pairs within a geometry, except neighbours that touch only where they are joined.
    shared : {"index", "position"}
        Whether vertices of a mesh are the same if they have the same index, or the same position.
    segments : bool
        Also return the segments in which crossing triangles intersect.

    Returns
    -------
    dict
        ``geometry_ids`` and ``primitive_ids`` (m, 2) uint32, ``classes`` (m,) uint8, indices into `PAIR_CLASSES`;
        With `segments`, ``segments`` (m, 2, 3) float64, 0 for other classes.
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
    """Check closest hits against a reference on the CPU, in float64 or, if that cannot decide, in higher precision.

    Parameters
    ----------
    scene : Scene, or a mesh
    rays : array_like, (n, 6) float32, optional
        Rays to check. Default: `count` rays, half random, a quarter aimed at vertices, a quarter at points of edges.

    Returns
    -------
    dict
        ``counts``, the number of rays of each of `HIT_CLASSES`; ``faults``, the number of wrong answers; ``bound_95``,
        an upper bound of the fault rate (95 %); ``classes`` (n,) uint8, indices into `HIT_CLASSES`; ``rays`` (n, 6)
        float32, or float64 if the scene's `origin` is not 0.
    """
    scene = _scene_of(scene)
    flat, _ = scene._rays_of(np.zeros((0, 6)) if rays is None else rays)
    found = _core.verify(scene._core, *flat, count_of(count, "count", 4, 2**31), count_of(seed, "seed", 0, 2**63))
    found["rays"] = found["rays"][:, [0, 1, 2, 4, 5, 6]]
    if scene.origin.any():
        found["rays"] = found["rays"] + np.concatenate([scene.origin, np.zeros(3)])
    return found
