"""Sky and sun of rasters of heights, tile by tile, so that they need not fit into memory: extra ``twinray[dask]``.

A raster is a surface of triangles between the middles of cells; cells without a height (NaN) are holes in it. Each tile
is asked by itself, with a halo as wide as anything could stand that hides the lowest ray. Results are lazy arrays of
Dask, a chunk a tile.

One file of more than 400 lines, since all its questions share how tiles and halos are cut.
"""

from __future__ import annotations

import logging
import math
import os
from typing import Any, Literal

import dask.array as da
import numpy as np
from dask import delayed
from numpy.typing import ArrayLike

from . import _core
from ._arrays import number_of
from ._workers import SceneSpec, twice
from .dask import suns_of, weighted, weights_of
from .sky import sky_patches

__all__ = ["horizon", "sky_view", "sun_hours", "visible"]

EARTH_RADIUS = 6_371_000.0  #: metres
_TILE = 1024
_DEGREES = "heights: coordinates are degrees; project them, as by .rio.reproject(), or give spacing"
_SIDE_OF_BLOCK = 256  # in cells
_SIDE_OF_CURVED_BLOCK = 64  # each has one vertical
_FINE = 13  # heights are whole numbers of 2^-13 of a cell, so that tiles round them alike,
_WHOLE = 22  # or of larger parts, so that float32 holds the whole relief
_LIFT = 2.0**-10  # of a cell: how far up sensors on the ground begin, so that rays uphill meet the slope ahead
_MANY_CELLS = 1 << 24  # in a tile with its halo
_log = logging.getLogger("twinray")


def sky_view(
    heights: Any,
    spacing: float | tuple[float, float] | None = None,
    *,
    patches: Literal["tregenza145", "reinhart577", "reinhart2305"] | None = None,
    weights: ArrayLike | None = None,
    measure: Literal["light", "solid_angle"] = "light",
    azimuths: int = 32,
    lowest: float = 3.0,
    **options: Any,
) -> Any:
    """Compute how much of the sky each cell sees, (rows, columns) float32; NaN where it has no height.

    Parameters
    ----------
    heights : xarray.DataArray, dask.array, array_like or the name of a GeoTIFF, (rows, columns)
        In the unit of the cells' spacing. A GeoTIFF needs rioxarray.
    spacing : float or (float, float), optional
        From column to column, eastward, and from row to row, northward, negative where rows go south; one number: of
        square cells whose rows go south. By default the coordinates of the DataArray tell.
    patches : {"tregenza145", "reinhart577", "reinhart2305"}, optional
        Patches of the sky, one ray each. By default the sky above the `horizon` counts, which is quicker and more
        exact.
    weights : array_like, (patches,), optional
        The brightness of each patch; by default a uniform sky's.
    azimuths, lowest
        The options of `horizon`; not with `patches`.
    measure : {"light", "solid_angle"}
        The part of the light on a horizontal plane, or of the hemisphere itself.
    relief : float, optional
        The highest less the lowest height; by default the raster is read once for it.
    height : float
        Height of the sensors above ground; 0 by default.
    curvature : float
        Curvature of the earth: 0 is a plane, 1 a sphere, 0.857 a sphere with the refraction of air. Heights must be in
        metres. For rays 64 x 64 cells share the vertical of their middle.
    reach : float
        Ground that is farther away hides nothing; without limit by default. It bounds what a tile needs in memory.
    tile : int
        Cells along a side of a tile; 1024 by default.
    accel, device : optional
        The options of `twinray.Scene`.
    """
    if measure not in ("light", "solid_angle"):
        raise ValueError(f"measure: {measure!r} is not one of light, solid_angle")
    if patches is None:
        if weights is not None:
            raise ValueError("weights: they are of patches, which are not chosen")
        search = _Horizon(azimuths, lowest, measure)
        return _over_tiles(heights, spacing, search.lowest_rays(), search, options)
    directions, angles = sky_patches(patches)
    light = np.asarray(angles) * (1 if weights is None else weights_of(weights, "weights", len(angles)))
    if measure == "light":
        light = light * np.asarray(directions)[:, 2]
    return _over_tiles(heights, spacing, np.asarray(directions), _Sum(light / light.sum(), "sky_view", "1"), options)


def horizon(
    heights: Any,
    spacing: float | tuple[float, float] | None = None,
    *,
    azimuths: int = 32,
    lowest: float = 3.0,
    **options: Any,
) -> Any:
    """Find how high the horizon is, in degrees, (rows, columns, azimuths) float32; NaN where a cell has no height.

    It is exact but for roundings: the highest of the points where the line of an azimuth crosses the surface's edges,
    and at least 0. No ray is traced and no accelerator is built. The other parameters are those of `sky_view`.

    Parameters
    ----------
    azimuths : int
        From half a step east of north on, clockwise.
    lowest : float
        In degrees. The raster counts as far as anything could stand above this, which says how wide halos are.
    """
    search = _Horizon(azimuths, lowest, None)
    return _over_tiles(heights, spacing, search.lowest_rays(), search, options)


def sun_hours(
    heights: Any,
    suns: ArrayLike,
    hours: ArrayLike | float = 1.0,
    spacing: float | tuple[float, float] | None = None,
    **options: Any,
) -> Any:
    """Compute how many hours the sun shines on each cell, (rows, columns) float32; NaN where it has no height.

    Parameters
    ----------
    heights, spacing, relief, height, curvature, reach, tile, accel, device
        The parameters of `sky_view`. The lowest sun decides how wide halos are.
    suns : array_like, (S, 3)
        Towards the sun: x east, y north, z up; those that are not above the horizon bring nothing.
    hours : array_like, (S,), or float
        How long each stays there.
    """
    vectors, stay = suns_of(suns, hours)
    return _over_tiles(heights, spacing, vectors.astype(np.float64), _Sum(stay, "sun_hours", "hours"), options)


def visible(
    heights: Any, vectors: ArrayLike, spacing: float | tuple[float, float] | None = None, **options: Any
) -> Any:
    """Tell along which vectors (V, 3) each cell sees the sky, (rows, columns, V) uint8; 0 where it has no height.

    The other parameters are those of `sky_view`. All vectors must lead above the horizon.
    """
    across = np.asarray(vectors, np.float64).reshape(-1, 3)
    if not (across[:, 2] > 0).all():
        raise ValueError("vectors: not all lead above the horizon (z above 0)")
    return _over_tiles(heights, spacing, across, _Each(len(across)), options)


class _OfRays:
    """Answers of rays: `of(scene, points, across, t_far)` tells them for cells that have a height."""

    def of_tile(self, z, plan, inside):
        """The answers of the cells inside, of a tile with its halo."""
        shape = tuple(part.stop - part.start for part in inside)
        result = np.full((*shape, *self.more), self.fill, self.dtype)
        is_asked = np.isfinite(z[inside])
        vertices = _vertices(z, plan, inside)
        scene = plan.spec.build()
        scene.add_triangles(vertices.reshape(-1, 3), triangles_of(np.isfinite(z)))
        points = vertices[inside]
        points[..., 2] += plan.lift + _LIFT
        side = _SIDE_OF_CURVED_BLOCK if plan.curvature else _SIDE_OF_BLOCK
        for row in range(0, shape[0], side):
            for column in range(0, shape[1], side):
                block = (slice(row, row + side), slice(column, column + side))
                if is_asked[block].any():
                    asked = points[block][is_asked[block]]
                    across = plan.directions_at(points[block].reshape(-1, 3).mean(axis=0))
                    result[block][is_asked[block]] = self.of(scene, asked, across, plan.t_far)
        return result


class _Sum(_OfRays):
    """Sums the weights of the directions that a cell sees."""

    dtype, fill, more = np.dtype(np.float32), np.nan, ()

    def __init__(self, weights, name, units):
        self.weights, self.name, self.units = weights, name, units

    def of(self, scene, points, across, t_far):
        return weighted(_seen(scene, points, across, t_far), self.weights)


class _Each(_OfRays):
    """The directions that a cell sees."""

    dtype, fill, name, units = np.dtype(np.uint8), 0, "visible", "1"

    def __init__(self, count):
        self.more, self.axis = (count,), "vector"

    def of(self, scene, points, across, t_far):
        return _seen(scene, points, across, t_far)


class _Horizon:
    """The horizon of a cell, or how much of the sky is above it."""

    dtype, fill = np.dtype(np.float32), np.nan

    def __init__(self, azimuths, lowest, measure):
        if not hasattr(azimuths, "__index__") or not 1 <= azimuths <= 1 << 16:
            raise ValueError(f"azimuths: {azimuths!r}; wanted is an integer from 1 to {1 << 16}")
        if not 0 < number_of(lowest, "lowest") < 90:
            raise ValueError(f"lowest: {lowest}; wanted are degrees above 0 and below 90")
        self.lowest, self.measure = math.radians(lowest), measure
        around = (np.arange(azimuths) + 0.5) * (2 * math.pi / azimuths)
        self.ways = np.stack([np.sin(around), np.cos(around)], axis=-1)  # east and north
        self.more, self.axis = ((azimuths,) if measure is None else ()), "azimuth"
        self.name, self.units = ("horizon", "degrees") if measure is None else ("sky_view", "1")
        self.weights = np.array([azimuths, lowest, ("light", "solid_angle", None).index(measure)])

    def lowest_rays(self):
        return np.column_stack([self.ways, np.full(len(self.ways), math.tan(self.lowest))])

    def of_tile(self, z, plan, inside):
        """The answers of the cells inside, of a tile with its halo."""
        grid = plan.grid
        fine = _fine_heights(z, plan, inside).astype(np.float32)
        fine = np.pad(fine, [(0, max(0, 2 - side)) for side in z.shape], constant_values=np.nan)  # at least 2 x 2
        found = _core.horizon(
            plan.spec.build()._core,
            fine,
            [part.start for part in reversed(inside)],
            [part.stop - part.start for part in reversed(inside)],
            (self.ways * (grid.unit / grid.dx, grid.unit / grid.dy)).astype(np.float32),
            getattr(_core.HorizonMeasure, self.measure or "slope"),
            plan.lift,
            plan.curvature * grid.unit / EARTH_RADIUS,
            plan.way / grid.unit,
        )
        found = found.reshape(*(part.stop - part.start for part in inside), *self.more)
        return found if self.measure else np.degrees(np.arctan(found))


class _Grid:
    """The distance from column to column and from row to row, in metres or the raster's unit."""

    def __init__(self, spacing):
        pair = (spacing, -spacing) if np.ndim(spacing) == 0 else tuple(spacing)
        if len(pair) != 2:
            raise ValueError(f"spacing: {spacing!r}; wanted are one or two numbers")
        self.dx, self.dy = (number_of(value, "spacing") for value in pair)
        if not all(math.isfinite(value) and value != 0 for value in (self.dx, self.dy)):
            raise ValueError(f"spacing: {spacing!r}; wanted are finite numbers other than 0")
        self.unit = min(abs(self.dx), abs(self.dy))

    def halo(self, way):
        """Rows and columns of so long a way, and one more for the triangles there."""
        return math.ceil(way / abs(self.dy)) + 1, math.ceil(way / abs(self.dx)) + 1

    def in_cells(self, directions):
        """Directions where columns, rows and heights in units of `unit` are axes."""
        return directions / (self.dx, self.dy, self.unit)


def _over_tiles(
    heights,
    spacing,
    directions,
    answer,
    options,
    *,
    _names=("relief", "height", "curvature", "reach", "tile", "accel", "device"),
):
    unknown = sorted(set(options) - set(_names))
    if unknown:
        raise TypeError(f"unknown options {unknown}; there are {', '.join(_names)}")
    tile = options.get("tile", _TILE)
    if not hasattr(tile, "__index__") or tile < 1:
        raise ValueError(f"tile: {tile!r}; wanted is an integer of at least 1")
    source, array, grid = _raster(heights, spacing, tile)
    curvature, lifted = (_finite(options.get(name, 0.0), name) for name in ("curvature", "height"))
    relief = options.get("relief")
    relief = _relief_of(array) if relief is None else _finite(relief, "relief")
    reach = number_of(options.get("reach", math.inf), "reach")
    if reach <= 0:
        raise ValueError(f"reach: {reach}; wanted is a number above 0")
    way = min(reach, _way(relief, directions, curvature))
    halo = grid.halo(way)
    _tell_if_large(array.shape, tile, halo, way)
    spec = SceneSpec(accel=options.get("accel", "auto"), device=options.get("device"))
    plan = delayed(_Plan(spec, grid, directions, answer, lifted, curvature, reach, way, relief), pure=True)
    rows = [_tile_row(array, first, tile, halo, plan, answer) for first in range(0, array.shape[0], tile)]
    found = da.concatenate(rows) if rows else da.zeros((*array.shape, *answer.more), dtype=answer.dtype)
    return found if source is None else _labelled(found, source, answer)


def _tell_if_large(shape, tile, halo, way):
    seen = [min(tile + 2 * around, size) for around, size in zip(halo, shape, strict=True)]
    if seen[0] * seen[1] > max(_MANY_CELLS, 4 * tile * tile):
        _log.warning(
            "terrain: a tile of %d x %d cells needs %d x %d, since the lowest direction may meet ground %.6g away; "
            "leave low ones out, or give reach",
            tile,
            tile,
            *seen,
            way,
        )


def _finite(value, name):
    number = number_of(value, name, 0)
    if number == math.inf:
        raise ValueError(f"{name}: {number}; wanted is a finite number")
    return number


def _tile_row(array, first, tile, halo, plan, answer):
    tiles = []
    for left in range(0, array.shape[1], tile):
        spans, inside = [], []
        for start, size, around in ((first, array.shape[0], halo[0]), (left, array.shape[1], halo[1])):
            end = min(start + tile, size)
            low = max(0, start - around)
            spans.append(slice(low, min(end + around, size)))
            inside.append(slice(start - low, end - low))
        chunks = tuple((part.stop - part.start,) for part in inside) + tuple((n,) for n in answer.more)
        kwargs = {"new_axis": [2]} if answer.more else {}
        tiles.append(
            array[tuple(spans)]
            .rechunk(-1)
            .map_blocks(
                _tile,
                plan,
                tuple(inside),
                (first, left),
                dtype=answer.dtype,
                chunks=chunks,
                meta=np.empty((0,) * len(chunks), answer.dtype),
                **kwargs,
            )  # fmt: skip
        )
    return da.concatenate(tiles, axis=1)


class _Plan:
    """The settings that all tiles share."""

    def __init__(self, spec, grid, directions, answer, lifted, curvature, reach, way, relief):
        self.spec, self.grid, self.directions, self.answer = spec, grid, directions, answer
        self.t_far = math.inf
        if reach < math.inf:  # the directions get the length of the rays
            across = np.hypot(directions[:, 0], directions[:, 1])
            across = np.maximum(across, 1e-6 * np.linalg.norm(directions, axis=1))  # all but vertical
            self.t_far, self.directions = 1.0, directions * (reach / across)[:, None]
        self.fine = 2.0 ** min(_FINE, _WHOLE - math.ceil(math.log2(max(1.0, relief / grid.unit))))
        self.lift = np.round(lifted / grid.unit * self.fine) / self.fine
        self.curvature, self.way, self.relief = curvature, way, relief

    def directions_at(self, point):
        """The directions, in cells, as they are where the surface is bent about the middle of the tile."""
        along = self.directions.copy()
        if self.curvature:
            away = point[:2] * (self.grid.dx, self.grid.dy)
            along[:, 2] -= self.curvature / EARTH_RADIUS * (along[:, :2] @ away)
        return self.grid.in_cells(along).astype(np.float32)

    def __dask_tokenize__(self):
        weights = getattr(self.answer, "weights", np.zeros(0))
        grid = (self.grid.dx, self.grid.dy, self.fine, self.lift, self.curvature, self.way, self.t_far)
        return (type(self.answer).__name__, self.spec.key, grid, self.directions.tobytes(), weights.tobytes())


def _tile(heights, plan, inside, corner):
    rows, columns = (f"{first}:{first + part.stop - part.start}" for first, part in zip(corner, inside, strict=True))
    what = f"terrain of rows {rows}, columns {columns}"
    return twice(lambda: _answered(heights, plan, inside), plan.spec, what)


def _answered(heights, plan, inside):
    z = np.asarray(heights, np.float64)
    z = np.where(np.isfinite(z), z, np.nan)
    answer = plan.answer
    if np.isfinite(z).any() and np.nanmax(z) - np.nanmin(z) > plan.relief * (1 + 1e-6):
        raise ValueError(f"relief: {plan.relief}; heights of this tile differ by {np.nanmax(z) - np.nanmin(z)}")
    if np.isfinite(z[inside]).any():
        return answer.of_tile(z, plan, inside)
    return np.full((*(part.stop - part.start for part in inside), *answer.more), answer.fill, answer.dtype)


def _seen(scene, points, across, t_far):
    moved = scene._frame.moved(points, scene.origin)
    seen = _core.visible(scene._core, moved, across, np.zeros((0, 3), np.float32), 0.0, t_far)
    return seen.reshape(len(points), len(across))


def _vertices(z, plan, inside):
    """(rows, columns, 3) float64: column, row and height in cells, from the middle of the tile; NaN at 0."""
    middle = [(part.start + part.stop) // 2 for part in inside]
    row, column = np.arange(z.shape[0]) - middle[0], np.arange(z.shape[1]) - middle[1]
    if plan.curvature:
        away = (row * plan.grid.dy)[:, None] ** 2 + (column * plan.grid.dx)[None, :] ** 2
        z = z - plan.curvature * away / (2 * EARTH_RADIUS)
    vertices = np.empty((*z.shape, 3))
    vertices[..., 0] = column[None, :]
    vertices[..., 1] = row[:, None]
    vertices[..., 2] = np.nan_to_num(_fine_heights(z, plan, inside))
    return vertices


def _fine_heights(z, plan, inside):
    """In cells, about 0 in the middle of the tile."""
    fine = np.round(z * (plan.fine / plan.grid.unit))
    return (fine - np.round(np.nanmean(fine[inside]))) / plan.fine


def triangles_of(is_there):
    """(m, 3) uint32: two of each square of four cells, but for those with a corner that is not there."""
    index = np.arange(is_there.size, dtype=np.uint32).reshape(is_there.shape)
    a, b, c, d = index[:-1, :-1], index[:-1, 1:], index[1:, 1:], index[1:, :-1]
    corners = np.stack([a, b, c, a, c, d], axis=-1).reshape(-1, 3)
    return corners if is_there.all() else corners[is_there.reshape(-1)[corners].all(axis=1)]


def _way(relief, directions, curvature):
    """How far anything that is so much higher may hide the lowest of the directions."""
    if len(directions) == 0 or relief == 0:
        return 0.0
    slope = float((directions[:, 2] / np.hypot(directions[:, 0], directions[:, 1]).clip(1e-300)).min())
    if curvature == 0:
        return relief / slope
    radius = EARTH_RADIUS / curvature
    return radius * (math.sqrt(slope * slope + 2 * relief / radius) - slope)


def _relief_of(array):
    finite = da.where(da.isfinite(array), array, np.nan)
    low, high = da.compute(da.nanmin(finite), da.nanmax(finite))
    return float(high - low) if high >= low else 0.0


def _raster(heights, spacing, tile):
    """The DataArray or None, dask's array, and the grid."""
    if isinstance(heights, str | os.PathLike):
        heights = _opened(heights, tile)
    is_labelled = hasattr(heights, "dims") and hasattr(heights, "coords")
    array = heights.data if is_labelled else heights
    array = array if isinstance(array, da.Array) else da.from_array(np.asarray(array), chunks=tile)
    if array.ndim != 2 or array.dtype.kind not in "fiu":
        raise ValueError(f"heights: shape {array.shape}, dtype {array.dtype}; wanted are numbers (rows, columns)")
    if is_labelled:
        array = _without_nodata(heights, array)
    if spacing is None:
        if not is_labelled:
            raise ValueError("spacing: an array without coordinates needs it")
        spacing = _spacing_of(heights)
    return heights if is_labelled else None, array, _Grid(spacing)


def _without_nodata(heights, array):
    """NaN where a DataArray has the value that says that there is no height: as rioxarray and xarray give it."""
    nodata = heights.attrs.get("_FillValue", getattr(getattr(heights, "rio", None), "nodata", None))
    if nodata is None or not np.isfinite(nodata):
        return array
    return da.where(array == nodata, np.nan, array)


def _opened(name, tile):
    try:
        import rioxarray
    except ImportError:
        raise ImportError("heights: a file needs rioxarray, which is not installed") from None
    opened = rioxarray.open_rasterio(os.fspath(name), masked=True, chunks={"x": tile, "y": tile})
    if opened.sizes["band"] != 1:
        raise ValueError(f"heights: '{name}' has {opened.sizes['band']} bands; wanted is one")
    return opened.squeeze("band", drop=True)


def _spacing_of(heights):
    crs = getattr(getattr(heights, "rio", None), "crs", None)
    if crs is not None and crs.is_geographic:
        raise ValueError(_DEGREES)
    if heights.dims == ("x", "y"):
        raise ValueError("heights: dimensions ('x', 'y'); wanted are rows, then columns: give heights.transpose()")
    steps = []
    for dim in reversed(heights.dims):
        if dim not in heights.coords or heights.sizes[dim] < 2:
            raise ValueError(f"heights: dimension '{dim}' has no coordinates; give spacing")
        units = str(heights.coords[dim].attrs.get("units", ""))
        if str(dim).lower() in ("lon", "lat", "longitude", "latitude") or units.startswith("degree"):
            raise ValueError(_DEGREES)
        values = np.asarray(heights.coords[dim], np.float64)
        step = (values[-1] - values[0]) / (len(values) - 1)
        if not np.abs(np.diff(values) - step).max() <= 1e-3 * abs(step):
            raise ValueError(f"heights: coordinates '{dim}' are not evenly spaced")
        steps.append(step)
    return tuple(steps)


def _labelled(found, source, answer):
    import xarray

    dims = (*source.dims, *((answer.axis,) if answer.more else ()))
    coords = {name: value for name, value in source.coords.items() if value.dtype.kind != "O"}
    labelled = xarray.DataArray(found, dims=dims, coords=coords, attrs={"units": answer.units})
    return labelled.rename(answer.name)
