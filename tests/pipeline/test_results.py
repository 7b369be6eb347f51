"""The folder of the results that a notebook shows."""

import pytest

from lube.errors import DataError
from lube.pipeline import results
from lube.pipeline.results import results_folder
from lube.pipeline.stamps import DRAWN_BY


@pytest.fixture
def clone(tmp_path, monkeypatch):
    """A repository with the results of three studies, and a working folder outside it."""
    for study in ("paper", "slip", "smoke"):
        (tmp_path / "clone/results" / study / "notebooks").mkdir(parents=True)
        (tmp_path / "clone/results" / study / "film.nc").touch()
    (tmp_path / "clone/results/unfinished").mkdir()
    (tmp_path / "elsewhere").mkdir()
    monkeypatch.setattr(results, "ROOT", tmp_path / "clone")
    monkeypatch.chdir(tmp_path / "elsewhere")
    return tmp_path / "clone"


def test_by_default_the_papers_or_the_one_that_the_environment_names(clone, monkeypatch):
    assert results_folder() == clone / "results/paper"
    assert results_folder(default="slip") == clone / "results/slip"
    monkeypatch.setenv("LUBE_STUDY", "smoke")
    assert results_folder() == results_folder(default="slip") == clone / "results/smoke"
    assert results_folder("slip") == clone / "results/slip"
    monkeypatch.setenv("LUBE_STUDY", str(clone / "results/slip"))
    assert results_folder() == clone / "results/slip"


def test_within_results_or_an_archive_that_study(clone, monkeypatch):
    monkeypatch.setenv("LUBE_STUDY", "smoke")
    monkeypatch.chdir(clone / "results/slip/notebooks")
    assert results_folder() == clone / "results/slip"
    assert results_folder("paper") == clone / "results/paper"
    archive = clone.parent / "archive"
    for name in ("data", "notebooks"):
        (archive / name).mkdir(parents=True)
    (archive / "data/contact.nc").touch()
    monkeypatch.chdir(archive / "notebooks")
    assert results_folder() == archive / "data"


def test_a_repository_around_the_working_folder_comes_first(clone, monkeypatch):
    own = clone.parent / "elsewhere/results/slip"
    own.mkdir(parents=True)
    (own / "contact.nc").touch()
    (own.parents[1] / "notebooks").mkdir()
    monkeypatch.chdir(own.parents[1] / "notebooks")
    assert results_folder("slip") == own
    assert results_folder() == clone / "results/paper"


def test_a_study_without_results_is_refused_with_the_right_name(clone, monkeypatch):
    with pytest.raises(DataError, match=r"^study: got 'slpi', did you mean 'slip'\?"):
        results_folder("slpi")
    with pytest.raises(DataError, match=r"need one of paper, slip, smoke \(LUBE_STUDY chooses"):
        results_folder("unfinished")
    monkeypatch.setattr(results, "ROOT", clone.parent / "new")
    with pytest.raises(DataError, match=r"got 'paper', which has no results yet: run snakemake"):
        results_folder()


def test_the_workflow_gives_the_datasets_itself(clone, monkeypatch):
    monkeypatch.setenv(DRAWN_BY, "")
    results_folder("not made yet")
