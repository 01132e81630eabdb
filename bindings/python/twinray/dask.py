"""Queries of scenes over arrays of Dask and xarray, on any number of workers: extra ``twinray[dask]``.

A `SceneSpec` describes a scene once; each worker builds it when the first chunk comes. Results are lazy, and their bits
depend on the scene, the seed and the version of twinray alone: not on chunks, workers, their order or restarts.

One file of more than 400 lines, since half of it is docstrings, and all functions cut arrays alike.

>>> import dask.array as da
>>> import twinray.dask
>>> spec = twinray.dask.SceneSpec(([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]]))
>>> rays = da.from_array([[0.25, 0.25, 2, 0, 0, -1], [2, 2, 2, 0, 0, -1]], chunks=(1, 6))
>>> twinray.dask.test_occlusions(spec, rays).compute()
array([ True, False])
"""

from __future__ import annotations

from typing import Any, Literal

import dask.array as da
import numpy as np
from dask import delayed
from numpy.typing import ArrayLike

from . import _core, analysis
from ._arrays import array_of, number_of
from ._workers import SceneSpec, computed
from .sky import sky_patches

__all__ = [
    "SceneSpec",
    "cast_rays",
    "compute_distance",
    "illumination",
    "sky_view",
    "sun_hours",
    "test_occlusions",
    "view_factors",
    "visible",
]


def cast_rays(scene: SceneSpec | Any, rays: Any, *, tnear: float = 0.0, tfar: float = np.inf) -> Any:
    """Find what each ray meets first: `Scene.cast_rays`, lazily.

    Parameters
    ----------
    scene : SceneSpec, or what it takes
    rays : dask.array, xarray.DataArray or array_like, (..., 6)
        Chunks divide all axes but the last.
    tnear, tfar : float
        Only hits between them count.

    Returns
    -------
    dict of dask.array, or xarray.Dataset for a DataArray
        The fields of `Scene.cast_rays`. ``t_hit`` is float64 if the rays are.
    """
    array, labels = _rows(rays, "rays", 6)
    t = np.dtype(np.float32 if array.dtype in (np.float16, np.float32) else np.float64)
    fields = [
        ("t_hit", t, ()),
        ("geometry_ids", np.uint32, ()),
        ("primitive_ids", np.uint32, ()),
        ("primitive_uvs", np.float32, (2,)),
        ("primitive_normals", np.float32, (3,)),
    ]
    hits = _mapped(_cast, scene, array, np.dtype(fields), (), {"tnear": tnear, "tfar": tfar})
    found = {name: hits[name] for name, _, _ in fields}
    axes = {"primitive_uvs": ("uv",), "primitive_normals": ("xyz",)}
    return labels.dataset(found, axes) if labels else found


def _cast(scene, rays, dtype, tnear, tfar):
    found = scene.cast_rays(rays, tnear=tnear, tfar=tfar)
    hits = np.empty(rays.shape[:-1], dtype)
    for name in dtype.names:
        hits[name] = found[name]
    return hits


def test_occlusions(scene: SceneSpec | Any, rays: Any, tnear: float = 0.0, tfar: float = np.inf) -> Any:
    """Tell whether each ray (..., 6) meets anything between `tnear` and `tfar`; (...) bool, lazily."""
    array, labels = _rows(rays, "rays", 6)
    return _labelled(
        _mapped(_occluded, scene, array, np.dtype(bool), (), {"tnear": tnear, "tfar": tfar}), labels, "occluded"
    )


test_occlusions.__test__ = False  # type: ignore[attr-defined]  # no test of pytest's


def _occluded(scene, rays, dtype, tnear, tfar):
    return scene.test_occlusions(rays, tnear, tfar).numpy()


def compute_distance(scene: SceneSpec | Any, query_points: Any) -> Any:
    """Compute the distance of each point (..., 3) from the scene; (...) float32, lazily."""
    array, labels = _rows(query_points, "query_points", 3)
    return _labelled(_mapped(_distance, scene, array, np.dtype(np.float32), (), {}), labels, "distance")


def _distance(scene, points, dtype):
    return scene.compute_distance(points).numpy()


def visible(
    scene: SceneSpec | Any,
    points: Any,
    vectors: ArrayLike,
    normals: Any | None = None,
    *,
    tnear: float = 0.0,
    tfar: float = np.inf,
) -> Any:
    """Tell which points see free sky along which vectors: `twinray.visible`, lazily.

    Parameters
    ----------
    scene : SceneSpec, or what it takes
    points : dask.array, xarray.DataArray or array_like, (..., 3)
    vectors : array_like, (V, 3)
        In memory: each chunk asks for all.
    normals : the same as points, optional
    tnear, tfar : float

    Returns
    -------
    (..., V) uint8
    """
    across = np.ascontiguousarray(array_of(vectors, "vectors"), np.float32).reshape(-1, 3)
    array, labels = _sensors(points, normals)
    options = {"vectors": across, "tnear": number_of(tnear, "tnear", 0), "tfar": number_of(tfar, "tfar")}
    found = _mapped(_visible, scene, array, np.dtype(np.uint8), (len(across),), options)
    return labels.array(found, "visible", ("vector",)) if labels else found


def _visible(scene, sensors, dtype, vectors, tnear, tfar=np.inf):
    flat = sensors.reshape(-1, sensors.shape[-1])
    normals = flat[:, 3:] if flat.shape[1] == 6 else None
    seen = analysis.visible(flat[:, :3], vectors, normals, scene=scene, tnear=tnear, tfar=tfar)
    return seen.reshape(*sensors.shape[:-1], -1)


def sky_view(
    scene: SceneSpec | Any,
    points: Any,
    normals: Any | None = None,
    *,
    patches: Literal["tregenza145", "reinhart577", "reinhart2305"] = "tregenza145",
    weights: ArrayLike | None = None,
    tnear: float = 0.0,
) -> Any:
    """Compute which part of the light of the sky each point gets.

    Parameters
    ----------
    scene : SceneSpec, or what it takes
    points : dask.array, xarray.DataArray or array_like, (..., 3)
    normals : the same as points, optional
        Normals of the surfaces that the points lie on. By default rays begin at the points, and up is z.
    patches : {"tregenza145", "reinhart577", "reinhart2305"}
        Patches of the sky, one ray each (`sky_patches`). `visible` gives the answers by patch.
    weights : array_like, (patches,), optional
        The brightness of each patch; by default a uniform sky's, 1 each.

    Returns
    -------
    (...) float64
        1 where nothing is in the way.
    """
    directions, angles = sky_patches(patches)
    bright = angles * (1 if weights is None else weights_of(weights, "weights", len(angles)))
    options = {"directions": directions.numpy(), "light": np.asarray(bright), "tnear": number_of(tnear, "tnear", 0)}
    array, labels = _sensors(points, normals)
    return _labelled(_mapped(_sky, scene, array, np.dtype(np.float64), (), options), labels, "sky_view")


def _sky(scene, sensors, dtype, directions, light, tnear):
    flat = sensors.reshape(-1, sensors.shape[-1])
    seen = _visible(scene, flat, None, directions.astype(np.float32), tnear)
    if flat.shape[1] == 6:
        unit = flat[:, 3:] / np.linalg.norm(flat[:, 3:], axis=1, keepdims=True)
        # This is no product of matrices, whose sums depend on how many rows there are.
        cosines = [np.maximum(unit[:, 0] * x + unit[:, 1] * y + unit[:, 2] * z, 0) for x, y, z in directions]
    else:
        cosines = list(np.maximum(directions[:, 2], 0))
    whole = sum(cosine * power for cosine, power in zip(cosines, light, strict=True))
    return (weighted(seen, [c * p for c, p in zip(cosines, light, strict=True)]) / whole).reshape(sensors.shape[:-1])


def weighted(seen, weights):
    """The sum of weights by row of what is seen, (n, V), in an order that does not depend on the number of rows."""
    total = np.zeros(len(seen))
    for column, weight in zip(np.ascontiguousarray(seen.T), weights, strict=True):
        total += column * weight
    return total


def sun_hours(
    scene: SceneSpec | Any,
    points: Any,
    suns: ArrayLike,
    hours: ArrayLike | float = 1.0,
    normals: Any | None = None,
    *,
    tnear: float = 0.0,
) -> Any:
    """Compute how many hours of sun each point gets.

    Parameters
    ----------
    scene : SceneSpec, or what it takes
    points : dask.array, xarray.DataArray or array_like, (..., 3)
    suns : array_like, (S, 3)
        Towards the sun at each time; those below the horizon (z not above 0) bring nothing.
    hours : array_like, (S,), or float
        How long each stays there.
    normals : the same as points, optional

    Returns
    -------
    (...) float64
    """
    vectors, stay = suns_of(suns, hours)
    array, labels = _sensors(points, normals)
    options = {"vectors": vectors, "stay": stay, "tnear": number_of(tnear, "tnear", 0)}
    return _labelled(_mapped(_hours, scene, array, np.dtype(np.float64), (), options), labels, "sun_hours")


def suns_of(suns, hours):
    """Vectors (S, 3) float32 and hours (S,) float64 of the suns above the horizon."""
    vectors = np.ascontiguousarray(array_of(suns, "suns"), np.float32).reshape(-1, 3)
    stay = np.broadcast_to(np.asarray(hours, np.float64), len(vectors)) if np.ndim(hours) == 0 else None
    stay = weights_of(hours, "hours", len(vectors)) if stay is None else stay
    is_up = vectors[:, 2] > 0
    return vectors[is_up], np.ascontiguousarray(stay[is_up])


def _hours(scene, sensors, dtype, vectors, stay, tnear):
    flat = sensors.reshape(-1, sensors.shape[-1])
    return weighted(_visible(scene, flat, None, vectors, tnear), stay).reshape(sensors.shape[:-1])


def illumination(
    scene: SceneSpec | Any,
    directions: Any,
    groups: ArrayLike | None = None,
    *,
    side: int = 1000,
    sides: Literal["front", "both"] = "both",
    seed: int = 1,
) -> dict[str, Any]:
    """Compute what parallel light of many directions reaches: `twinray.illumination` of each, lazily.

    Parameters
    ----------
    scene : SceneSpec, or what it takes
    directions : dask.array or array_like, (D, 3)
        Directions of the light's rays, in chunks or whole.

    Returns
    -------
    dict of dask.array, (D, n) float64
        The first axis is the direction, the second the face or group.
    """
    array, labels = _rows(directions, "directions", 3)
    if array.ndim != 2:
        raise ValueError(f"directions: shape {array.shape}; wanted is (D, 3)")
    spec = SceneSpec.of(scene)
    names = ("hits", "area", "low", "high", "unobstructed", "surface")
    count = spec.face_count() if groups is None else int(np.max(groups, initial=-1)) + 1
    options = {"groups": groups, "side": side, "sides": sides, "seed": seed}
    dtype = np.dtype([(name, np.float64) for name in names])
    found = _mapped(_illumination, spec, array, dtype, (count,), options)
    light = {name: found[name] for name in names}
    return labels.dataset(light, dict.fromkeys(names, ("face",))) if labels else light


def _illumination(scene, directions, dtype, groups, side, sides, seed):
    rows = []
    for direction in directions:
        found = analysis.illumination(scene, direction, groups, side=side, sides=sides, seed=seed)
        row = np.empty(len(found["area"]), dtype)
        for name in dtype.names:
            row[name] = found[name]
        rows.append(row)
    return np.stack(rows)


def view_factors(
    scene: SceneSpec | Any,
    groups: ArrayLike | None = None,
    *,
    chunk: int = 1000,
    sides: Literal["front", "both"] = "front",
    rays: int = 1 << 14,
    target_error: float | None = None,
    seed: int = 1,
    estimator: Literal["auto", "hits", "area", "contour"] = "auto",
    sparse: bool = False,
) -> tuple[Any, Any]:
    """Compute rows of view factors: `twinray.view_factors`, lazily, a chunk of rows at a time.

    Parameters
    ----------
    chunk : int
        Rows of a chunk.
    sparse : bool
        True gives arrays whose blocks are matrices of SciPy (CSR); ``F.to_delayed()`` has them one by one.

    Returns
    -------
    F, half_width : dask.array, (n, n) float64
    """
    spec = SceneSpec.of(scene)
    count = spec.face_count() if groups is None else int(np.max(groups, initial=-1)) + 1
    options = {
        "groups": analysis.groups_of(groups, spec.face_count()), "sides": sides, "rays": rays,
        "target_error": target_error, "seed": seed, "estimator": estimator,
    }  # fmt: skip
    arguments = analysis.factor_arguments(**options)
    if chunk < 1:
        raise ValueError(f"chunk: {chunk}; wanted is at least one row")
    shared = delayed(spec, pure=True)
    rows = delayed(_factor_rows, pure=True, nout=2)
    blocks = [rows(shared, arguments, first, min(first + chunk, count), sparse) for first in range(0, count, chunk)]
    if sparse:
        from scipy.sparse import csr_matrix

        meta = csr_matrix((0, 0))
    else:
        meta = np.empty((0, 0))
    matrices = []
    for which in range(2):
        parts = [
            da.from_delayed(block[which], (min(chunk, count - i * chunk), count), meta=meta)
            for i, block in enumerate(blocks)
        ]
        matrices.append(da.concatenate(parts) if parts else da.zeros((0, 0)))
    return tuple(matrices)


def _factor_rows(spec, arguments, first, last, sparse):
    def work(scene):
        factors = spec.kept(("view factors", arguments), lambda: _core.ViewFactors(scene._core, *arguments))
        return analysis.matrices_of(factors.rows(first, last), factors.count(), sparse)

    return computed(spec, work, f"view factors of rows {first} to {last - 1}")


class _Labels:
    """The dimensions and coordinates of a DataArray but for its last dimension."""

    def __init__(self, array):
        self.dims = array.dims[:-1]
        last = array.dims[-1]
        self.coords = {name: value for name, value in array.coords.items() if last not in value.dims}

    def array(self, values, name, more=()):
        import xarray

        return xarray.DataArray(values, dims=(*self.dims, *more), coords=self.coords).rename(name)

    def dataset(self, found, axes):
        import xarray

        return xarray.Dataset({name: self.array(values, name, axes.get(name, ())) for name, values in found.items()})


def _labelled(values, labels, name):
    return labels.array(values, name) if labels else values


def _rows(values, name, columns):
    """As dask's, whose last axis is of one chunk, and the labels of a DataArray, else None."""
    labels = None
    if hasattr(values, "dims") and hasattr(values, "coords"):
        labels = _Labels(values)
        values = values.data
    if not isinstance(values, da.Array):
        values = array_of(values, name)
        chunks = {axis: "auto" for axis in range(values.ndim - 1)}
        values = da.from_array(values, chunks={**chunks, values.ndim - 1: -1}) if values.ndim else da.asarray(values)
    if values.dtype.kind not in "fiu":
        raise TypeError(f"{name}: dtype {values.dtype}; wanted are floats or integers")
    if values.ndim < 1 or values.shape[-1] != columns:
        raise ValueError(f"{name}: shape {values.shape}; wanted is (..., {columns})")
    return values.rechunk({values.ndim - 1: -1}), labels


def _sensors(points, normals):
    """Points, or points and normals beside each other, and the labels."""
    array, labels = _rows(points, "points", 3)
    if normals is None:
        return array, labels
    facing, _ = _rows(normals, "normals", 3)
    if facing.shape != array.shape:
        raise ValueError(f"normals: shape {facing.shape}; of points it is {array.shape}")
    both = da.concatenate([array.astype(np.float64), facing.rechunk(array.chunks).astype(np.float64)], axis=-1)
    return both.rechunk({both.ndim - 1: -1}), labels


def weights_of(values, name, count):
    """Finite numbers (count,), as float64."""
    array = array_of(values, name).astype(np.float64)
    if array.shape != (count,) or not np.isfinite(array).all():
        raise ValueError(f"{name}: shape {array.shape}; wanted are {count} finite numbers")
    return array


def _mapped(function, scene, array, dtype, more, options):
    """Calls function(scene, block, dtype, **options) for each chunk of rows: of its last axis `more` is left."""
    spec = SceneSpec.of(scene)
    kwargs = {"dtype": dtype} if not more else {"dtype": dtype, "new_axis": [array.ndim - 1]}
    chunks = array.chunks[:-1] + tuple((n,) for n in more)
    return da.map_blocks(
        _block, array, function, delayed(spec, pure=True), dtype, options, drop_axis=array.ndim - 1, chunks=chunks,
        meta=np.empty((0,) * len(chunks), dtype), name=None, **kwargs,
    )  # fmt: skip


def _block(rows, function, spec, dtype, options, block_info=None):
    where = block_info[0]["array-location"][:-1] if block_info else []
    spans = ", ".join(f"{first}:{last}" for first, last in where)
    name = function.__name__.strip("_")
    return computed(spec, lambda scene: function(scene, rows, dtype, **options), f"{name} of chunk [{spans}]")
