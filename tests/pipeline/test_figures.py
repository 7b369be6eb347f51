"""Figures of a study: drawn from its datasets, with a file that states their origin."""

import shutil

import pytest
from PIL import Image
from written_notebooks import DRAW, write_notebook

from lube.errors import LubeError
from lube.pipeline.figure_files import origin, products
from lube.pipeline.figures import draw_figure, paths_for, read_origin, wrong_figures
from lube.storage import provenance

FIGURE = "fig99_mine"
REMEDY = "; delete it and run snakemake again"


@pytest.fixture
def notebook(tmp_path):
    """A notebook that draws a figure of a film dataset."""
    return write_notebook(tmp_path / f"{FIGURE}.ipynb", DRAW.format(200))


@pytest.fixture
def results(files, tmp_path):
    """Results of a study that has two datasets and no figure yet."""
    folder = tmp_path / "results"
    folder.mkdir()
    for kind in ("film", "contact"):
        shutil.copy(files / f"{kind}.nc", folder)
    return folder


def draw(notebook, results):
    draw_figure(notebook, [results / "film.nc"], ["lube/plots.py"], results)


@pytest.fixture
def drawn(notebook, results, monkeypatch):
    """The same results with the figure, made without executing the notebook."""

    def execute(notebook, output, parameters, changes):
        for name in products(FIGURE):
            (results / name).parent.mkdir(exist_ok=True)
            (results / name).write_text(name)

    monkeypatch.setattr("lube.pipeline.figures.execute_notebook", execute)
    draw(notebook, results)
    return results


def test_parameters_get_the_datasets_that_they_name(notebook, tmp_path):
    datasets = [tmp_path / "contact.nc", tmp_path / "film.nc"]
    assert paths_for(notebook, datasets) == {"oil": str(tmp_path / "film.nc")}
    with pytest.raises(LubeError, match=rf"{FIGURE}.ipynb: needs film.nc, which is missing"):
        paths_for(notebook, datasets[:1])


def test_what_is_not_a_notebook_with_parameters_is_refused(notebook, results):
    write_notebook(notebook, "x = 1", tag="another")
    with pytest.raises(LubeError, match="no cell is tagged 'parameters'"):
        draw(notebook, results)
    write_notebook(notebook, parameters="film =")
    with pytest.raises(LubeError, match="got 'film =', which is not Python"):
        draw(notebook, results)
    notebook.write_text("no notebook", encoding="utf-8")
    with pytest.raises(LubeError, match="not a Jupyter notebook"):
        draw(notebook, results)


def test_a_figure_is_the_same_bytes_each_time_and_states_its_origin(notebook, results, monkeypatch):
    monkeypatch.setattr(
        "lube.pipeline.figures.drawn_by", lambda commits, *_: f"changed since {[*commits]}"
    )
    draw(notebook, results)
    made = {path.relative_to(results).as_posix() for path in results.rglob("*.*")}
    assert made == {"film.nc", "contact.nc", *products(FIGURE), origin(FIGURE)}
    assert list(wrong_figures([FIGURE], results, results)) == []
    changes = f"changed since ['{provenance.commit()}']"
    assert read_origin(FIGURE, results)["drawn_by"] == changes
    with Image.open(results / products(FIGURE)[0]) as picture:
        assert picture.text["Description"].endswith(f" · {changes}")
    first = {name: (results / name).read_bytes() for name in made}
    draw(notebook, results)
    assert {name: (results / name).read_bytes() for name in made} == first


def test_changed_and_missing_files_of_a_figure_are_named(drawn):
    for name in products(FIGURE):
        before = (drawn / name).read_bytes()
        (drawn / name).write_bytes(before + b"0")
        expected = f"{drawn / name}: not as the workflow made it{REMEDY}"
        assert list(wrong_figures([FIGURE], drawn, drawn)) == [expected]
        (drawn / name).unlink()
        (line,) = wrong_figures([FIGURE], drawn, drawn)
        assert line.startswith(f"{drawn / name}: cannot be read: No such file")
        (drawn / name).write_bytes(before)


def test_a_figure_of_another_dataset_is_named(drawn):
    with (drawn / "film.nc").open("ab") as file:
        file.write(b"0")
    (drawn / "contact.nc").unlink()  # which it does not show
    expected = f"{drawn / products(FIGURE)[0]}: was drawn from another film.nc{REMEDY}"
    assert list(wrong_figures([FIGURE], drawn, drawn)) == [expected]


def test_a_figure_without_a_readable_origin_is_named(drawn):
    path = drawn / origin(FIGURE)
    expected = [f"{path}: missing or damaged{REMEDY}"]
    for text in ("no JSON", "[]", "{}", '{"datasets": {}}', '{"datasets": {}, "products": 1}'):
        path.write_text(text)
        assert list(wrong_figures([FIGURE], drawn, drawn)) == expected
    path.unlink()
    assert list(wrong_figures([FIGURE], drawn, drawn)) == expected


def test_a_notebook_that_saves_no_figure_is_refused_even_if_an_old_one_exists(
    notebook, drawn, monkeypatch
):
    (drawn / origin(FIGURE)).unlink()  # as Snakemake does before the job
    monkeypatch.setattr("lube.pipeline.figures.execute_notebook", lambda *_: None)
    with pytest.raises(LubeError, match=rf"{FIGURE}.ipynb: saved no figure, need plots.save_fig"):
        draw(notebook, drawn)
    assert not (drawn / origin(FIGURE)).exists()
