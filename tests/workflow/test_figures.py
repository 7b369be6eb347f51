"""Figures of a study: drawn on its datasets, and known again by what was made."""

import json
import shutil

import nbformat
import pytest
from nbformat.v4 import new_code_cell, new_notebook
from PIL import Image

from lube.errors import LubeError
from lube.storage import provenance
from lube.workflow.figures import (
    draw_figure,
    origin,
    paths_for,
    products,
    read_origin,
    wrong_figures,
)

PARAMETERS = 'oil = "../results/paper/film.nc"\nspeed = 100\nfigure = None'
DRAW = """\
import matplotlib.pyplot as plt
from lube import plots
from lube.storage import netcdf
canvas, axes = plt.subplots()
line = axes.plot([speed, 200])
"""
SAVE = 'plots.save_figure(canvas, figure, netcdf.load(oil, "film"))'
TAKE_AWAY = "; take it away and run snakemake again"


@pytest.fixture
def write(tmp_path):
    """Write the notebook of the figure `fig99_mine`, and return its path."""

    def write_notebook(*codes):
        cells = [new_code_cell(PARAMETERS, metadata={"tags": ["parameters"]})]
        path = tmp_path / "fig99_mine.ipynb"
        nbformat.write(new_notebook(cells=[*cells, *map(new_code_cell, codes)]), path)
        return path

    return write_notebook


@pytest.fixture
def results(files, tmp_path):
    """Results of a study of which nothing but two datasets was made so far."""
    folder = tmp_path / "results"
    folder.mkdir()
    for kind in ("film", "contact"):
        shutil.copy(files / f"{kind}.nc", folder)
    return folder


def draw(notebook, results):
    draw_figure(notebook, [results / "film.nc"], ["lube/plots.py"], results)


def test_variables_get_the_datasets_that_they_name(write, tmp_path):
    datasets = [tmp_path / "contact.nc", tmp_path / "film.nc"]
    assert paths_for(write(), datasets) == {"oil": str(tmp_path / "film.nc")}
    with pytest.raises(LubeError, match=r"fig99_mine.ipynb: needs film.nc, which is not there"):
        paths_for(write(), datasets[:1])


def test_a_figure_is_drawn_and_known_again(write, results):
    draw(write(DRAW, SAVE), results)
    made = {path.relative_to(results).as_posix() for path in results.rglob("*.*")}
    assert made == {"film.nc", "contact.nc", *products("fig99_mine"), origin("fig99_mine")}
    assert list(wrong_figures(["fig99_mine"], results, results)) == []
    first = {name: (results / name).read_bytes() for name in made}
    draw(write(DRAW, SAVE), results)
    assert {name: (results / name).read_bytes() for name in made} == first


def test_what_differs_from_the_commit_is_in_the_stamp_and_beside_it(write, results, monkeypatch):
    monkeypatch.setattr(
        "lube.workflow.figures.drawn_by", lambda commits, *_: f"changed since {[*commits]}"
    )
    draw(write(DRAW, SAVE), results)
    told = f"changed since ['{provenance.commit()}']"
    assert read_origin("fig99_mine", results)["drawn_by"] == told
    with Image.open(results / "figures/fig99_mine.png") as picture:
        assert picture.text["Description"].endswith(f" · {told}")


@pytest.mark.parametrize("name", products("fig99_mine"))
def test_a_file_changed_by_hand_is_named(write, results, name):
    draw(write(DRAW, SAVE), results)
    with (results / name).open("ab") as file:
        file.write(b"0")
    told = f"{results / name}: not as the workflow made it{TAKE_AWAY}"
    assert list(wrong_figures(["fig99_mine"], results, results)) == [told]


def test_a_figure_of_another_dataset_is_named(write, results):
    draw(write(DRAW, SAVE), results)
    with (results / "film.nc").open("ab") as file:
        file.write(b"0")
    (results / "contact.nc").unlink()  # which it does not show
    told = f"{results}/figures/fig99_mine.png: was drawn from another film.nc{TAKE_AWAY}"
    assert list(wrong_figures(["fig99_mine"], results, results)) == [told]


@pytest.mark.parametrize("text", [None, "{}", "[]", '{"datasets": 3}', "\xff", "[" * 100_000])
def test_a_figure_of_unknown_origin_is_named(write, results, text):
    (results / "figures").mkdir()
    path = results / origin("fig99_mine")
    if text is not None:
        path.write_text(text, "latin-1")
    told = f"{path}: missing or damaged{TAKE_AWAY}"
    assert list(wrong_figures(["fig99_mine"], results, results)) == [told]


def test_a_picture_that_is_not_there_is_named(write, results):
    draw(write(DRAW, SAVE), results)
    (results / "figures/fig99_mine.pdf").unlink()
    (told,) = wrong_figures(["fig99_mine"], results, results)
    assert told.startswith(f"{results}/figures/fig99_mine.pdf: cannot be read: No such file")


@pytest.mark.parametrize("before", [False, True])
def test_a_notebook_that_saves_no_figure_is_refused_whatever_was_there(write, results, before):
    if before:
        draw(write(DRAW, SAVE), results)
        (results / origin("fig99_mine")).unlink()  # as Snakemake does
    with pytest.raises(LubeError, match=r"fig99_mine.ipynb: saved no figure, need plots.save_fig"):
        draw(write(DRAW), results)
    assert not (results / origin("fig99_mine")).exists()


def test_a_damaged_dataset_is_told_by_the_notebook_that_loads_it(write, results):
    (results / "film.nc").write_bytes(b"no dataset")
    told = r"fig99_mine.ipynb: cell 3 fails at line 1: DataError: .*film.nc: not a whole NetCDF"
    with pytest.raises(LubeError, match=told):
        draw(write(DRAW, SAVE), results)


def test_fingerprints_are_written_for_people_too(write, results):
    draw(write(DRAW, SAVE), results)
    text = (results / origin("fig99_mine")).read_text("utf-8")
    assert text.endswith("}\n") and text.count("\n") > 8
    assert set(json.loads(text)) == {"datasets", "products", "drawn_by"}
