"""Figures of an archive drawn again: those that are in it, and nothing over them."""

import json
import shutil

import pytest
from PIL import Image

from lube.archive.redraw import redraw
from lube.archive.verify import verify_archive
from lube.errors import DataError, LubeError


def test_an_archive_without_figures_has_none_to_draw(spoilt, tmp_path):
    shutil.rmtree(spoilt / "figures")
    with pytest.raises(DataError, match="holds no figures"):
        list(redraw(spoilt, tmp_path / "new"))


def test_a_picture_that_is_not_there_is_not_the_same(spoilt, tmp_path):
    (spoilt / "figures/fig02_film.pdf").unlink()
    drawn = dict(redraw(spoilt, tmp_path / "new", ["fig02_film"]))
    assert drawn == {"fig02_film.png": True, "fig02_film.pdf": False}


def test_a_file_is_no_place_for_figures(archive, tmp_path):
    (tmp_path / "file").touch()
    with pytest.raises(DataError, match="need a folder, not a file"):
        list(redraw(archive, tmp_path / "file"))


def test_a_figure_that_is_not_in_the_archive_is_refused(archive, tmp_path):
    with pytest.raises(DataError, match=r"got fig99, need a figure of the archive: fig01_visc"):
        list(redraw(archive, tmp_path, ["fig99"]))


@pytest.mark.parametrize("place", [".", "figures", "notebooks/../figures"])
def test_nothing_is_drawn_over_an_archive(archive, place):
    with pytest.raises(DataError, match="need a folder outside the archive"):
        list(redraw(archive, archive / place))
    assert verify_archive(archive) == []


def test_figures_are_drawn_of_an_archive_and_nothing_else(archive, archived, tmp_path):
    for folder in (archive.parent, archived.results):
        with pytest.raises(DataError, match="not an archive: SHA256SUMS is missing"):
            list(redraw(folder, tmp_path))


def test_a_notebook_that_is_not_there_is_told(spoilt, tmp_path):
    (spoilt / "code/notebooks/fig02_film.ipynb").unlink()
    with pytest.raises(LubeError, match=r"fig02_film.ipynb: cannot be read: No such file"):
        list(redraw(spoilt, tmp_path / "new", ["fig02_film"]))


def test_what_a_notebook_sets_besides_paths_stays_when_it_is_drawn_again(spoilt, tmp_path):
    notebook = spoilt / "code/notebooks/fig02_film.ipynb"
    content = json.loads(notebook.read_text("utf-8"))
    for cell in content["cells"]:
        if "parameters" in cell["metadata"].get("tags", []):
            cell["source"] += ["\nshown_force = 800"]
    content["cells"][-1]["source"] += ["\nassert shown_force == 800"]
    notebook.write_text(json.dumps(content), "utf-8")
    drawn = dict(redraw(spoilt, tmp_path / "new", ["fig02_film"]))
    assert drawn == {"fig02_film.png": True, "fig02_film.pdf": True}


def test_what_a_stamp_says_of_changed_code_is_said_again(spoilt, tmp_path):
    origin = spoilt / "figures/fig02_film.json"
    text = origin.read_text("utf-8")
    origin.write_text(text.replace('"drawn_by": ""', '"drawn_by": "changed notebook"'), "utf-8")
    drawn = dict(redraw(spoilt, tmp_path / "new", ["fig02_film"]))
    assert drawn == {"fig02_film.png": False, "fig02_film.pdf": False}
    with Image.open(tmp_path / "new/fig02_film.png") as picture:
        assert picture.text["Description"].endswith(" · changed notebook")


def test_a_figure_of_unknown_origin_is_told(spoilt, tmp_path):
    (spoilt / "figures/fig02_film.json").unlink()
    with pytest.raises(DataError, match=r"figures/fig02_film.json: missing or damaged$"):
        list(redraw(spoilt, tmp_path / "new", ["fig02_film"]))
