# SPDX-License-Identifier: MIT
"""The notebooks of docs/notebooks run from nothing, and show pictures; in the repository they have no outputs."""

import os
from pathlib import Path

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
