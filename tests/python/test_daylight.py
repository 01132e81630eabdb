# SPDX-License-Identifier: MIT
"""The recipe of docs/how-to/daylight.md beside Radiance's rfluxmtx, where pyradiance is installed."""

import os
import pathlib
import re
import subprocess

import numpy as np
import pytest

pyradiance = pytest.importorskip("pyradiance")
pytest.importorskip("trimesh")

PAGE = pathlib.Path(__file__).parents[2] / "docs/how-to/daylight.md"
WEATHER = """place street
latitude 48.1
longitude -11.6
time_zone -15
site_elevation 520
weather_data_file_units 1
3 21 9.5 310 150
3 21 12.5 0 200
3 21 15.5 520 120
"""
SKY = """#@rfluxmtx h=u u=Y
void glow ground 0 0 4 1 1 1 0
ground source below 0 0 4 0 0 -1 180
#@rfluxmtx h=r4 u=Y
void glow sky 0 0 4 1 1 1 0
sky source above 0 0 4 0 0 1 180
"""


def by_radiance(folder, street, points, normals, repeats):
    """Irradiance coefficients of the patches, by sensor, repeat and patch."""
    tools = pathlib.Path(pyradiance.__file__).parent
    lines = ["void plastic black 0 0 5 0 0 0 0 0"]
    for mesh in street:
        for corners in mesh.triangles:
            lines.append(f"black polygon f{len(lines)} 0 0 9 " + " ".join(map(str, corners.ravel())))
    (folder / "street.rad").write_text("\n".join(lines))
    (folder / "sky.rad").write_text(SKY)
    rows = np.hstack([points, normals]).repeat(repeats, axis=0)
    options = ["-h", "-I+", "-ab", "1", "-ad", "16384", "-lw", "1e-9", "-faf", "-n", "1"]
    found = subprocess.run(
        [tools / "bin/rfluxmtx", *options, "-", "sky.rad", "street.rad"],
        input="\n".join(" ".join(map(str, row)) for row in rows).encode(),
        stdout=subprocess.PIPE,
        cwd=folder,
        env=os.environ | {"RAYPATH": str(tools / "lib"), "PATH": f"{tools / 'bin'}:{os.environ['PATH']}"},
        check=True,
    ).stdout
    return np.frombuffer(found, np.float32).reshape(len(points), repeats, 2306, 3)[:, :, 1:, 1]


def test_the_recipe_agrees_with_radiance(tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    (tmp_path / "day.wea").write_text(WEATHER)
    [recipe] = re.findall(r"```python.*?\n(.*?)```", PAGE.read_text(), re.S)
    names = {}
    exec(recipe, names)
    coefficients = by_radiance(tmp_path, names["street"], names["points"], names["normals"], 8)
    by_repeat = coefficients @ names["radiance"]
    wanted, its_error = by_repeat.mean(1), by_repeat.std(1, ddof=1) / np.sqrt(8)
    irradiance, error = names["irradiance"], names["error"]
    assert irradiance.shape == (9, 3) and 20 < irradiance.min() < irradiance.max() < 150
    assert (error < 0.02 * irradiance).all()
    off = (irradiance - wanted) / np.hypot(error, its_error)
    assert np.abs(off).max() < 4 and np.sqrt(np.mean(off**2)) < 1.7
