#!/usr/bin/env bash
# SPDX-License-Identifier: MIT
# A good guess: xdem.terrain.hillshade(dem, azimuth=90, altitude=45) lights from the east. Its docstring says "going
# clockwise, starting from north". So a plane of 45 degrees that falls to the east, for which xdem.terrain.aspect says
# 90, gets the highest value, 255.
# Seen: that plane gets 128.5, and the one that falls to the south gets 255. The light comes from 270 - azimuth: 0
# lights from the west, 90 from the south, 180 from the east, 270 from the north. Two azimuths are right, 135 and 315.
# The light by default is 315, so a picture with defaults looks right. Surface fits Horn and ZevenbergThorne agree.
# Seen with xdem 0.2.3 on 2026-11-30. Needs Python 3.12 or 3.13, 2 GB and no root.
folder=$(mktemp -d)
# shellcheck source=findings/checks.sh
. "$(dirname "${BASH_SOURCE[0]}")/checks.sh"
make_venv venv xdem==0.2.3 geoutils==0.2.5 numpy==2.4.6 scipy==1.17.1 \
    numba==0.68.1 rasterio==1.5.2 geopandas==1.2.0 pandas==2.3.3 pyproj==3.8.0 shapely==2.2.0 xarray==2026.9.0 \
    rioxarray==0.23.0 affine==3.0.1 pyogrio==0.13.0

cat >light.py <<'END'
import warnings

import numpy as np
import rasterio
import xdem

warnings.simplefilter("ignore")
compass = (0, 45, 90, 135, 180, 225, 270, 315)
side = np.arange(9)
planes = []
for falls_to in compass:  # rows go from north to south, a metre each
    east, north = np.sin(np.radians(falls_to)), np.cos(np.radians(falls_to))
    heights = -east * side[None, :] + north * side[:, None]
    corner = rasterio.transform.from_origin(500000, 5000000, 1, 1)
    planes.append(xdem.DEM.from_array(heights.astype("float32"), transform=corner, crs="EPSG:32631"))
middle = lambda raster: float(raster.data[4, 4])
print("version", xdem.__version__)
print("clockwise", xdem.terrain.hillshade.__doc__.count("going clockwise, starting from north"))
print("aspects", *(round(middle(xdem.terrain.aspect(plane))) % 360 for plane in planes))
for fit in ("Horn", "ZevenbergThorne"):
    for azimuth in compass:
        light = {"azimuth": azimuth, "altitude": 45, "surface_fit": fit}
        seen = [middle(xdem.terrain.hillshade(plane, **light)) for plane in planes]
        print(fit, azimuth, compass[int(np.argmax(seen))], *(f"{value:.1f}" for value in seen))
seen = [middle(xdem.terrain.hillshade(plane)) for plane in planes]
print("default", compass[int(np.argmax(seen))])
END
venv/bin/python light.py >results 2>log || {
    tail -n 5 log >&2
    fail "light.py failed"
}
row() { grep "^$1 " results | cut -d' ' -f"$2"; }
same "xdem" "$(row version 2)" 0.2.3
same "the docstring says 'going clockwise, starting from north'" "$(row clockwise 2)" 1
same "aspects" "$(row aspects 2-)" "0 45 90 135 180 225 270 315"
for fit in Horn ZevenbergThorne; do
    for azimuth in 0 45 90 135 180 225 270 315; do
        same "$fit, azimuth $azimuth: the brightest plane falls to" "$(row "$fit $azimuth" 3)" \
            $(((630 - azimuth) % 360))
    done
    same "$fit, azimuth 90: planes that fall to 0, 90, 180, 270" "$(row "$fit 90" 4,6,8,10)" "1.5 128.5 255.0 128.5"
done
same "by default: the brightest plane falls to" "$(row default 2)" 315
conclude
