"""The figures of a study, from their notebooks: what each needs, and what it says."""

import re
from collections import Counter

import pytest
from written_notebooks import write_notebook

from lube.pipeline.figure_list import chapters, made_on_request, study_figures
from lube.study.lubricant_record import load_record


@pytest.fixture
def write(tmp_path):
    """Write a notebook and return its folder; `tags` are those of its first cell."""

    def write_figure(name, code="film = '../film.nc'", words="# Film\n\nSome *words*.", tags=()):
        write_notebook(tmp_path / f"{name}.ipynb", words=words, parameters=code, of=tags)
        return tmp_path

    return write_figure


def test_a_figure_says_what_it_needs(write, study):
    code = (
        "%matplotlib inline\nfrom lube.stages import gather\nfilm = '../film.nc'\nx = 'contact.nc'"
    )
    figure = study_figures(study, write("fig01_mine", code))["fig01_mine"]
    assert figure.datasets == ["contact", "film"]
    assert {"lube/contact/ensemble.py", "lube/pipeline/notebooks.py"} <= set(figure.sources)
    assert figure.target == "all"
    assert (figure.title, figure.text) == ("Film", "Some *words*.")


def test_without_words_and_chapter_a_figure_has_its_name_and_the_last_chapter(write, study):
    figure = study_figures(study, write("fig99_mine", words=""))["fig99_mine"]
    assert (figure.title, figure.text) == ("fig99_mine", "")
    assert figure.chapter == "Further figures"


def test_a_figure_that_compares_levels_asks_for_several(write, study):
    folder = write("fig01_forces", tags=["several-force"])
    write("fig02_slips", tags=["several-slide_to_roll_ratio"])
    one_slip = {"slide_to_roll_ratio": (0.0,)}
    grid = study.operating_grid.model_copy(update=one_slip)
    assert list(study_figures(study.model_copy(update={"operating_grid": grid}), folder)) == [
        "fig01_forces"
    ]


def test_a_figure_that_compares_oils_asks_for_several(write, study):
    folder = write("fig01_oils", tags=["several-lubricant"])
    assert not study_figures(study, folder)
    oils = (*study.lubricants, load_record("pao-iso-vg-68"))
    assert list(study_figures(study.model_copy(update={"lubricants": oils}), folder)) == [
        "fig01_oils"
    ]


def test_a_figure_may_need_gaussian_lines(write, study):
    folder = write("fig01_tail", tags=["gaussian-lines"])
    worn = study.roughness.model_copy(update={"skewness": -0.5})
    assert list(study_figures(study, folder)) == ["fig01_tail"]
    assert not study_figures(study.model_copy(update={"roughness": worn}), folder)


def test_a_notebook_may_be_no_figure(write, study):
    write("start_here", "study = 1", tags=["no-figure"])
    assert list(study_figures(study, write("fig01_mine"))) == ["fig01_mine"]


def test_chapters_are_numbered_by_their_figures_measured_times_last(write, study):
    write("bench01_speed", "clocks = '../speed.nc'", tags=["chapter-measured-times"])
    write("fig02_b", tags=["chapter-oil-and-film"])
    figures = study_figures(study, write("fig01_a", tags=["chapter-oil-and-film"]))
    assert figures["bench01_speed"].target == "benchmark"
    assert chapters(figures) == {
        "bench01_speed": "2 Measured times",
        "fig01_a": "1 Oil and film",
        "fig02_b": "1 Oil and film",
    }


def test_every_figure_is_in_a_chapter_of_several(study):
    """A misspelt tag would make a chapter of its own."""
    figures = study_figures(study)
    found = Counter(one.chapter for one in figures.values() if one.target != "benchmark")
    assert min(found.values()) > 1, found


def test_figures_on_request_are_listed_where_they_are_made_or_asked_for(study, tmp_path):
    figures = study_figures(study)
    assert made_on_request(figures, tmp_path, []) == []
    asked = made_on_request(figures, tmp_path, ["archive", "patch_contact", "benchmark"])
    assert asked == ["fig24_patch"]
    (tmp_path / "figures").mkdir()
    for name in ("bench01_speed", "fig02_film", "fig22_areal"):
        (tmp_path / f"figures/{name}.png").touch()
    assert made_on_request(figures, tmp_path, []) == ["fig22_areal"]


def test_captions_do_not_speak_of_the_papers_points_or_axes(study):
    """Another study has its own; that a figure is drawn like one of the paper is true of all."""
    for figure in study_figures(study).values():
        words = re.sub(r"Drawn like Fig\. \w+ of the paper", "", f"{figure.title} {figure.text}")
        assert not re.search(r"the paper's|Fig\. \d|transposed", words), figure.name
