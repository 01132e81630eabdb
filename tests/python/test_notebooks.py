"""The notebooks of docs/notebooks run from nothing, and show pictures; in the repository they have no outputs. A recipe
of a page gives what another program does."""

import os
import re
import subprocess
from pathlib import Path

import numpy as np
import pytest
import twinray
from conftest import needed

FOLDER = Path(__file__).resolve().parents[2] / "docs" / "notebooks"
NOTEBOOKS = sorted(FOLDER.glob("*.ipynb"))
IMPORTED = ("matplotlib", "scipy", "trimesh", "xarray")  # beside NumPy, where a notebook says so


def source_of(notebook):
    return "\n".join(cell.source for cell in notebook.cells if cell.cell_type == "code")


def run(notebook):
    """Execute it in place, by a kernel of this Python that imports the twinray of this test."""
    nbclient = needed("nbclient")
    needed("ipykernel")
    path = os.path.dirname(os.path.dirname(os.path.abspath(twinray.__file__)))
    environment = os.environ | {
        "PYTHONPATH": os.pathsep.join(p for p in (path, os.environ.get("PYTHONPATH")) if p),
        "MPLBACKEND": "module://matplotlib_inline.backend_inline",
    }
    client = nbclient.NotebookClient(notebook, timeout=120, kernel_name="python3")
    client.execute(env=environment)


def has_image(output):
    data = output.get("data", {})
    return "image/png" in data or "<img" in data.get("text/html", "")


def test_there_are_notebooks():
    assert len(NOTEBOOKS) >= 6


@pytest.mark.parametrize("file", NOTEBOOKS, ids=lambda file: file.stem)
def test_notebook(file):
    nbformat = needed("nbformat")
    notebook = nbformat.read(file, as_version=4)
    nbformat.validate(notebook)
    cells = [cell for cell in notebook.cells if cell.cell_type == "code"]
    assert all(not cell.outputs and cell.execution_count is None for cell in cells)
    assert "assert " in source_of(notebook)
    for module in IMPORTED:
        if f"import {module}" in source_of(notebook) or f"from {module}" in source_of(notebook):
            needed(module)
    run(notebook)
    outputs = [output for cell in cells for output in cell.outputs]
    assert any(has_image(output) for output in outputs)
    assert not [output.text for output in outputs if "RuntimeWarning" in output.get("text", "")]


def new_notebook(*sources):
    nbformat = needed("nbformat")
    cells = [nbformat.v4.new_code_cell(source) for source in sources]
    return nbformat.v4.new_notebook(cells=cells)


def test_the_kernel_imports_this_twinray():
    notebook = new_notebook("import twinray\nprint(twinray.__file__)")
    run(notebook)
    assert os.path.samefile(notebook.cells[0].outputs[0].text.strip(), twinray.__file__)


def test_a_cell_that_raises_fails():
    error = needed("nbclient").exceptions.CellExecutionError
    with pytest.raises(error, match="half of it"):
        run(new_notebook("x = 1", "assert x == 2, 'half of it'"))


PAGE = Path(__file__).parents[2] / "docs/how-to/daylight.md"
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
    tools = Path(pytest.importorskip("pyradiance").__file__).parent
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
    """The recipe of docs/how-to/daylight.md beside Radiance's rfluxmtx, where pyradiance is installed."""
    pytest.importorskip("pyradiance")
    pytest.importorskip("trimesh")
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
