"""The content of notebooks' cells: the datasets they name, and what determines a figure."""

import json

import nbformat
import pytest
from nbformat.v4 import new_notebook
from studies import ROOT
from written_notebooks import write_notebook

from lube.errors import LubeError
from lube.pipeline.cells import cells_of, datasets_of, parameters_of, python_of

NOTEBOOKS = sorted((ROOT / "notebooks").glob("*.ipynb"))


@pytest.fixture
def write(tmp_path):
    """Write a notebook with the given parameters cell, and return its path."""
    code = 'film = "../results/paper/film.nc"'
    return lambda parameters: write_notebook(tmp_path / "a.ipynb", code, parameters=parameters)


def test_a_parameter_is_a_dataset_if_its_value_is_the_path_of_one(write):
    for code, named in [
        ('x = "../results/paper/film.nc"', {"x": "film"}),
        ('film = "../results/paper/contact.nc"', {"film": "contact"}),
        ('film = "film.nc"', {"film": "film"}),
        ('study = results_folder()\nfilm = study / "film.nc"', {"film": "film"}),
        ('film = results_folder("slip") / "data" / "film.nc"', {"film": "film"}),
        ('a = b = "../film.nc"', {"a": "film", "b": "film"}),
        ('film: str = "../film.nc"', {"film": "film"}),
        ('clocks = "../results/paper/speed.nc"', {"clocks": "speed"}),
        ('%matplotlib inline\nfilm = "../film.nc"\nspeed = 100', {"film": "film"}),
        # Values that are not the path of a dataset.
        ("speed = 100\nfilm = None", {}),
        ('film = "thick"\nmaster = "film.csv"\nrig = "my-film.nc"', {}),
        ('film = ["../film.nc"]', {}),
        ('film = "../film.nc"\nfilm = 3', {}),
    ]:
        assert datasets_of(write(code)) == named


def test_parameters_have_their_values_if_these_are_constants(write):
    code = 'film = "film.nc"\nspeed = 100\nfigure = None\nforces = [1, 2]'
    expected = {"film": "film.nc", "speed": 100, "figure": None, "forces": None}
    assert parameters_of(write(code)) == expected


def test_notebooks_are_committed_without_outputs_and_write_no_figure_when_run_by_hand():
    assert NOTEBOOKS
    for notebook in NOTEBOOKS:
        text = notebook.read_text("utf-8")
        code = [cell for cell in json.loads(text)["cells"] if cell["cell_type"] == "code"]
        assert not any(cell["outputs"] or cell["execution_count"] for cell in code), notebook
        assert text.endswith("}\n")
        if notebook.stem != "start_here":
            assert "figure = None" in text
            assert parameters_of(notebook)["figure"] is None
            assert datasets_of(notebook)


def test_outputs_and_execution_counts_are_left_out(write):
    path = write("figure = None")
    before = cells_of(path)
    notebook = nbformat.read(path, as_version=4)
    notebook.cells[1].outputs = [nbformat.v4.new_output("stream", text="said")]
    notebook.cells[1].execution_count = 3
    nbformat.write(notebook, path)
    assert cells_of(path) == before


def test_lines_of_ipython_are_left_out_of_the_python_code():
    assert python_of({"source": "%matplotlib inline\nx = 1\n!ls"}, "figure.ipynb") == "x = 1"
    with pytest.raises(LubeError, match=r"figure.ipynb: got 'film =', which is not Python"):
        python_of({"source": "film ="}, "figure.ipynb")


def test_a_file_that_is_not_a_notebook_is_refused(tmp_path):
    path = tmp_path / "figure.ipynb"
    with pytest.raises(LubeError, match=r"figure.ipynb: cannot be read: No such file"):
        cells_of(path)
    for text in ("no notebook", "{}", "[]", '{"cells": [{"cell_type": "code"}]}'):
        path.write_text(text, encoding="utf-8")
        with pytest.raises(LubeError, match=r"figure.ipynb: not a Jupyter notebook"):
            cells_of(path)
    nbformat.write(new_notebook(), path)
    with pytest.raises(LubeError, match=r"no cell is tagged 'parameters', need one"):
        parameters_of(path)
