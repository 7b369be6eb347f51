"""The first notebook, in which a study is explored: with sliders, and without ipywidgets."""

import sys

import matplotlib.pyplot as plt
import nbformat
import pytest
from nbclient import NotebookClient
from nbformat.v4 import new_code_cell
from studies import ROOT

from lube.storage.netcdf import load

NOTEBOOK = ROOT / "notebooks/start_here.ipynb"
CHOSEN = {"force": 1600, "speed": 100, "temperature": 80, "slide_to_roll_ratio": 0.1}


@pytest.fixture
def expected(files, monkeypatch):
    """Choose a study; return what the notebook is to say at an operating point."""
    monkeypatch.setenv("LUBE_STUDY", str(files))

    def lines(**chosen):
        film, contact = load(files / "film.nc", "film"), load(files / "contact.nc", "contact")
        point = contact.isel(lubricant=0, film_formula=0).sel(chosen)
        del chosen["slide_to_roll_ratio"]
        film = film.isel(lubricant=0, film_formula=0).sel(chosen)
        mean, lower, upper = (
            100 * point[f"breakthrough_probability_{word}"].item()
            for word in ("mean", "lower", "upper")
        )
        return [
            f"Film thickness            {1e6 * film.film_thickness.item():.3g} µm",
            f"Lambda ratio              {film.lambda_ratio.item():.3g}",
            f"Breakthrough probability  {mean:.3g} %, 95 % interval {lower:.3g} to {upper:.3g} %",
        ]

    return lines


def test_moved_sliders_show_the_numbers_of_the_datasets_and_curves(expected, tmp_path):
    notebook = nbformat.read(NOTEBOOK, as_version=4)
    moves = [f"controls[{name!r}].value = {level}" for name, level in CHOSEN.items()]
    notebook.cells.append(new_code_cell("\n".join(moves)))
    options = {"timeout": 120, "resources": {"metadata": {"path": tmp_path}}}
    NotebookClient(notebook, **options).execute()
    state = notebook.metadata.widgets["application/vnd.jupyter.widget-state+json"]["state"]
    (shown,) = [one["state"] for one in state.values() if one["model_name"] == "OutputModel"]
    said, picture = shown["outputs"]
    assert said["text"].splitlines() == expected(**CHOSEN)
    assert "image/png" in picture["data"]
    assert list(tmp_path.iterdir()) == []


def test_without_ipywidgets_one_operating_point_is_shown(expected, capsys, monkeypatch):
    monkeypatch.setitem(sys.modules, "ipywidgets", None)
    monkeypatch.setattr(plt, "show", lambda: None)
    cells = nbformat.read(NOTEBOOK, as_version=4).cells
    names = {}
    exec("\n".join(cell.source for cell in cells if cell.cell_type == "code"), names)
    said = capsys.readouterr().out.splitlines()
    assert "For sliders: pip install ipywidgets." in said[1]
    middle = {name: names["middle"][name] for name in CHOSEN}
    assert said[3:] == expected(**middle)
    assert len(plt.gcf().axes) == 4
