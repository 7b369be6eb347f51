"""What notebooks say by their cells: which datasets they want, and what decides on a figure."""

import json

import nbformat
import pytest
from nbformat.v4 import new_code_cell, new_markdown_cell, new_notebook
from studies import ROOT

from lube.errors import LubeError
from lube.workflow.cells import cells_of, datasets_of, parameters_of, python_of, reduced

NOTEBOOKS = sorted((ROOT / "notebooks").glob("*.ipynb"))


@pytest.fixture
def write(tmp_path):
    """Write a notebook with the given parameters cell, and return its path."""

    def write_notebook(parameters):
        cells = [new_markdown_cell("# A figure")]
        cells.append(new_code_cell(parameters, metadata={"tags": ["parameters"]}))
        cells.append(new_code_cell('film = "../results/paper/film.nc"'))
        path = tmp_path / "figure.ipynb"
        nbformat.write(new_notebook(cells=cells), path)
        return path

    return write_notebook


@pytest.mark.parametrize(
    ("code", "named"),
    [
        ('film = "../results/paper/film.nc"', {"film": "film"}),
        ('x = "../results/paper/film.nc"', {"x": "film"}),
        ('film = "../results/paper/contact.nc"', {"film": "contact"}),
        ('film = "film.nc"', {"film": "film"}),
        ('a = b = "../film.nc"', {"a": "film", "b": "film"}),
        ('film: str = "../film.nc"', {"film": "film"}),
        ('clocks = "../results/paper/speed.nc"', {"clocks": "speed"}),
        # Names of datasets that are nothing of the kind.
        ("speed = 100", {}),
        ('film = "thick"', {}),
        ('film = "../results/paper/film.csv"', {}),
        ('film = "../results/paper/my-film.nc"', {}),
        ('film = "film.nc/"', {}),
        ('mine = "../mine/records.nc"', {}),
        ("film = None", {}),
        ('film: "../film.nc"', {}),
        ('film = ["../film.nc"]', {}),
        # The last one counts.
        ('film = "../film.nc"\nfilm = 3', {}),
        ('%matplotlib inline\nfilm = "../film.nc"\nspeed = 100', {"film": "film"}),
    ],
)
def test_a_variable_is_a_dataset_if_its_value_is_the_path_of_one(write, code, named):
    assert datasets_of(write(code)) == named


def test_parameters_have_their_values_as_far_as_these_stand_there(write):
    code = 'film = "film.nc"\nspeed = 100\nfigure = None\nforces = [1, 2]'
    assert parameters_of(write(code)) == {
        "film": "film.nc",
        "speed": 100,
        "figure": None,
        "forces": None,
    }


@pytest.mark.parametrize("notebook", NOTEBOOKS, ids=lambda path: path.stem)
def test_every_notebook_run_by_hand_writes_no_figure(notebook):
    assert parameters_of(notebook)["figure"] is None
    assert "figure = None" in notebook.read_text("utf-8")
    assert datasets_of(notebook)


@pytest.mark.parametrize("notebook", NOTEBOOKS, ids=lambda path: path.stem)
def test_notebooks_are_committed_without_outputs(notebook):
    text = notebook.read_text("utf-8")
    code = [cell for cell in json.loads(text)["cells"] if cell["cell_type"] == "code"]
    assert not any(cell["outputs"] or cell["execution_count"] for cell in code)
    assert text.endswith("}\n")


def test_outputs_and_counts_decide_nothing(write):
    path = write("figure = None")
    before = cells_of(path)
    notebook = nbformat.read(path, as_version=4)
    notebook.cells[1].outputs = [nbformat.v4.new_output("stream", text="said")]
    notebook.cells[1].execution_count = 3
    assert reduced(nbformat.writes(notebook)) == before


def test_lines_for_jupyter_alone_are_left_out():
    cell = {"source": "%matplotlib inline\nx = 1\n!ls"}
    assert python_of(cell, "figure.ipynb") == "x = 1"


@pytest.mark.parametrize("code", ["film =", "x = 1\0"])
def test_what_is_not_python_is_refused(write, code):
    with pytest.raises(LubeError, match=r"figure.ipynb: got .*, which is not Python"):
        python_of({"source": code}, "figure.ipynb")


@pytest.mark.parametrize(
    "text", ["no notebook", "{}", "[]", '{"cells": [3]}', '{"cells": [{"cell_type": "code"}]}']
)
def test_a_file_that_is_no_notebook_is_refused(tmp_path, text):
    (tmp_path / "figure.ipynb").write_text(text, encoding="utf-8")
    with pytest.raises(LubeError, match=r"figure.ipynb: not a Jupyter notebook"):
        cells_of(tmp_path / "figure.ipynb")


def test_a_notebook_that_is_not_there_is_told(tmp_path):
    with pytest.raises(LubeError, match=r"figure.ipynb: cannot be read: No such file"):
        cells_of(tmp_path / "figure.ipynb")
