"""twinray.terrain: exact horizons, rays against a scene of all, the same bits for any tiles."""

import warnings

import numpy as np
import pytest
import twinray
from conftest import grid, needed, raster, same, scene_of

da = needed("dask.array")
xr = needed("xarray")
from twinray import dask as td  # noqa: E402
from twinray import terrain  # noqa: E402


def test_tiles_and_chunks_do_not_change_terrain():
    heights = raster()
    views = [
        terrain.sky_view(each, tile=tile) for each, tile in [(heights, 64), (heights, 16), (heights.chunk(13), 16)]
    ]
    assert views[0].dims == ("y", "x") and same(views[0].coords["x"].values, heights.coords["x"].values)
    assert len(views[1].chunks[0]) == 3
    values = [view.compute().values for view in views]
    assert all(same(each, values[0]) for each in values[1:]) and values[0].dtype == np.float32
    assert same(np.isnan(values[0]), np.isnan(heights.values))
    assert 0.8 < np.nanmin(values[0]) < np.nanmax(values[0]) <= 1


def test_terrain_against_a_scene_of_all():
    heights = raster()
    heights[:] = np.nan_to_num(heights)
    there = np.ones(heights.shape, bool)
    x, y = np.meshgrid(heights.x, heights.y)
    vertices = np.stack([x, y, heights], axis=-1)
    scene = scene_of((vertices.reshape(-1, 3), terrain.triangles_of(there)))
    directions, _ = twinray.sky_patches()
    points = vertices.reshape(-1, 3) + [0, 0, 10 / 1024]
    wanted = twinray.visible(points, directions, scene=scene, tnear=1e-9).reshape(*there.shape, -1)
    found = terrain.visible(heights, directions, tile=16).compute()
    assert (found != wanted).mean() < 1e-4  # rays within rounding of an edge


def true_slope(z, row, column, way, bend=0.0):
    """In float64, by all edges of the triangles: the steepest crossing with a line of columns and rows per length."""
    corners = terrain.triangles_of(np.isfinite(z)).astype(np.int64)
    p, q = np.concatenate([corners[:, [0, 1]], corners[:, [1, 2]], corners[:, [2, 0]]]).T
    places = [np.column_stack([each % z.shape[1] - column, each // z.shape[1] - row]) for each in (p, q)]
    off = [xy[:, 0] * way[1] - xy[:, 1] * way[0] for xy in places]
    off = [np.where(np.abs(each) < 1e-9 * np.abs(way).max(), 0, each) for each in off]  # vertices on the line
    crosses = (off[0] * off[1] <= 0) & (off[0] != off[1])
    part = off[0][crosses] / (off[0] - off[1])[crosses]
    along = ((places[0][crosses].T * (1 - part) + places[1][crosses].T * part).T @ way) / (way @ way)
    heights = z.ravel()[p][crosses] * (1 - part) + z.ravel()[q][crosses] * part
    ahead = along > 1e-9
    slopes = (heights[ahead] - z[row, column]) / along[ahead] - bend * along[ahead] / 2
    return max(0.0, slopes.max(initial=0.0))


# Some ways lead along rows, columns and diagonals, from cells at the border and beside holes.
@pytest.mark.parametrize(("curvature", "azimuths", "oblong"), [(0.0, 9, 1.5), (1.0, 9, 1.5), (0.0, 2, 1), (0.0, 4, 1)])
def test_the_horizon_is_exact(curvature, azimuths, oblong):
    heights = np.round(raster(rows=30, columns=41, step=512.0) * 1600) / 16  # with holes; terrain rounds as much
    heights = heights.assign_coords(y=heights.y * oblong)
    options = {"azimuths": azimuths, "lowest": 0.1, "curvature": curvature}
    found = terrain.horizon(heights, tile=16, **options).compute().values
    assert same(found, terrain.horizon(heights, tile=64, **options).compute().values)
    largest = 0.0
    cells = [(0, 7), (29, 9), (11, 0), (5, 40), (9, 22), (12, 19)]
    for row, column in [*np.random.default_rng(3).integers(0, (30, 41), (40, 2)), *cells]:
        if np.isnan(heights.values[row, column]):
            assert np.isnan(found[row, column]).all()
            continue
        for k in range(azimuths):
            angle = (k + 0.5) * 2 * np.pi / azimuths
            way = np.array([np.sin(angle) / 512, -np.cos(angle) / (512 * oblong)])
            wanted = true_slope(heights.values, row, column, way, curvature / terrain.EARTH_RADIUS)
            largest = max(largest, abs(np.degrees(np.arctan(wanted)) - found[row, column, k]))
    assert largest < 1e-5
    assert np.nanmax(found) > 10


def test_tiles_round_high_mountains_alike():
    heights = raster(step=1.0)
    heights[:, 20:] += 5000.3  # 5,000 cells high
    options = {"azimuths": 8, "lowest": 40.0}
    found = [terrain.horizon(heights, tile=tile, **options).compute().values for tile in (64, 16, 7)]
    assert all(same(each, found[0]) for each in found[1:])


def test_the_sky_is_what_is_above_the_horizon():
    heights = raster()
    options = {"azimuths": 8, "lowest": 0.5}
    found = terrain.horizon(heights, tile=16, **options).compute()
    assert found.dims == ("y", "x", "azimuth") and found.attrs["units"] == "degrees" and found.name == "horizon"
    view = terrain.sky_view(heights, tile=64, **options).compute().values
    assert np.nanmax(np.abs(view - (np.cos(np.radians(found.values)) ** 2).mean(axis=2))) < 1e-6
    assert same(np.isnan(view), np.isnan(heights.values))
    whole = terrain.sky_view(heights, tile=64, measure="solid_angle", **options).compute().values
    assert np.nanmax(np.abs(whole - (1 - np.sin(np.radians(found.values))).mean(axis=2))) < 1e-6
    wall = np.zeros((3, 64))
    wall[:, 40:] = 1000.0
    east = terrain.horizon(wall, 10.0, azimuths=2).compute()[:, 30, 0]
    assert np.abs(east - np.degrees(np.arctan(1000 / 100))).max() < 1e-5
    assert (terrain.horizon(wall[:, :30], 10.0).compute() == 0).all()
    assert (terrain.horizon(wall[:1], 10.0).compute() == 0).all()  # a row has no surface


def test_a_night_has_no_sun():
    heights = raster()
    for found in (terrain.sun_hours(heights, [[0, 0, -1]]), terrain.sun_hours(heights, np.zeros((0, 3)), [])):
        assert np.nanmax(found.compute().values) == 0
    points = np.zeros((5, 3))
    assert td.sun_hours(grid(3), points, [[0, 0, -1]]).compute().tolist() == [0] * 5


def test_values_that_say_no_height_are_holes():
    heights = raster()
    filled = heights.fillna(-9999).assign_attrs(_FillValue=-9999.0)
    assert same(terrain.sky_view(filled).compute().values, terrain.sky_view(heights).compute().values)


def test_a_wall_hides_what_it_must():
    heights = np.zeros((64, 64))
    heights[:, 40:] = 30.0  # a step of 30 m, with cells of 10 m
    sun = [[1.0, 0, slope] for slope in (0.25, 0.5, 1.0)]
    hours = terrain.sun_hours(heights, sun, [1, 10, 100], 10.0, tile=16).compute()
    # At 100 m before the edge it rises by 0.3, at 190 m by 0.16.
    assert hours[30, 30] == 110 and hours[30, 20] == 111 and hours[30, 36] == 100
    assert terrain.sun_hours(heights, sun, 1, (10.0, 10.0), tile=16, height=40).compute().min() == 3


def test_a_curved_earth_hides_less_of_the_sky():
    heights = np.zeros((8, 400))
    heights[:, 300:] = 500.0  # 200 cells of 100 m off: 20 km, over which the earth falls by 31 m
    sun = [[1, 0, 484 / 20000], [1, 0, 463 / 20000]]
    flat, curved = (
        terrain.sun_hours(heights, sun, 1, 100.0, curvature=c, tile=512).compute()[4, 100] for c in (0.0, 1.0)
    )
    assert (flat, curved) == (0, 1)


def test_ground_beyond_the_reach_hides_nothing(caplog):
    heights = np.zeros((9, 200))
    heights[:, 100:] = 500.0  # seen from column 50 the step begins 49 cells of 10 m away
    east = [[1.0, 0, 0.1], [0, 0, 1]]
    for reach, hours in ((480, 2), (510, 1), (np.inf, 1)):
        found = [terrain.sun_hours(heights, east, 1, 10.0, reach=reach, tile=tile).compute() for tile in (256, 32, 7)]
        assert found[0][4, 50] == hours and all(same(each, found[0]) for each in found[1:])
        slope = terrain.horizon(heights, 10.0, azimuths=2, lowest=1.0, reach=reach).compute()[4, 50, 0]
        assert (slope > 40) == (hours == 1)
    assert not [told for told in caplog.messages if told.startswith("terrain")]
    with pytest.raises(ValueError, match="reach: 0.0; wanted is a number above 0"):
        terrain.sky_view(heights, 10.0, reach=0)


def test_halos_that_need_much_memory_are_told(caplog):
    heights = da.zeros((10_000, 10_000), chunks=1000)
    terrain.sun_hours(heights, [[1, 0, 0.01]], 1, 10.0, relief=500.0)
    terrain.sun_hours(heights, [[1, 0, 0.01]], 1, 10.0, relief=500.0, reach=9000.0)
    (told,) = [told for told in caplog.messages if told.startswith("terrain")]
    assert "tile of 1024 x 1024 cells needs 10000 x 10000" in told and "ground 50000 away" in told


def test_degrees_are_refused():
    needed("rioxarray")
    heights = raster().rio.write_crs("EPSG:4326")
    with pytest.raises(ValueError, match="coordinates are degrees"):
        terrain.sky_view(heights)
    assert terrain.sky_view(heights, 30.0).shape == heights.shape


def test_a_map_goes_to_zarr(tmp_path):
    zarr = needed("zarr")
    view = terrain.sky_view(raster(), tile=16)
    view.data.to_zarr(str(tmp_path / "view.zarr"))
    assert same(zarr.open(str(tmp_path / "view.zarr"))[:], view.compute().values)


def test_a_geotiff_becomes_a_map(tmp_path):
    needed("rioxarray")
    heights = raster().rio.write_crs("EPSG:25832")
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        heights.rio.write_nodata(np.nan).rio.to_raster(tmp_path / "heights.tif")
    found = terrain.sun_hours(tmp_path / "heights.tif", [[1, 0, 0.1], [0, 0, 1]], tile=32)
    wanted = terrain.sun_hours(raster(), [[1, 0, 0.1], [0, 0, 1]])
    assert same(found.compute().values, wanted.compute().values)
