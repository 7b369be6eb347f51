"""The code that runs: its commit, whatever surrounds it, and its files."""

import shutil
import subprocess

import pytest

from lube import repository
from lube.repository import code_files, commit, commit_date


@pytest.fixture
def place(tmp_path, monkeypatch):
    """A folder taken for that of the code."""
    monkeypatch.setattr(repository, "ROOT", tmp_path)
    commit.cache_clear()
    yield tmp_path
    commit.cache_clear()


def git(place, *arguments):
    identity = ("-c", "user.name=A", "-c", "user.email=a@b")
    command = ["git", *identity, *arguments]
    done = subprocess.run(command, cwd=place, capture_output=True, text=True, check=True)
    return done.stdout.strip()


def test_code_outside_git_has_no_commit(place):
    assert commit() == "unknown"


def test_code_of_an_archive_says_its_commit(place):
    (place / "COMMIT").write_text("abc\n")
    assert commit() == "abc"


@pytest.mark.skipif(shutil.which("git") is None, reason="needs Git")
def test_code_that_differs_from_its_commit_says_so(place):
    (place / "lube").mkdir()
    (place / "workflow" / "scripts").mkdir(parents=True)
    for name in ("lube/film.py", "workflow/scripts/film.py", "README.md"):
        (place / name).write_text("1")
    git(place, "init")
    git(place, "add", ".")
    git(place, "commit", "-m", "first")
    (place / "README.md").write_text("2")
    head = git(place, "rev-parse", "HEAD")
    assert commit() == head
    (place / "lube" / "film.py").write_text("2")
    commit.cache_clear()
    assert commit() == f"{head}+changes"


def test_code_in_git_has_a_day_and_code_elsewhere_has_none(place):
    commit_date.cache_clear()
    assert commit_date() is None
    commit_date.cache_clear()


def test_the_files_of_the_code_are_those_that_make_and_draw_results():
    files = code_files()
    for needed in ("Snakefile", "lube/film.py", "notebooks/fig02_film.ipynb"):
        assert needed in files
    assert not [name for name in files if "__pycache__" in name or name.startswith("results")]
