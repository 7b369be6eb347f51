"""The code that runs: its commit and its files."""

import shutil
import subprocess

import pytest

from lube.storage import git
from lube.storage.git import changed_code, changed_since, code_files, commit, commit_date

needs_git = pytest.mark.skipif(shutil.which("git") is None, reason="needs Git")


@pytest.fixture
def folder(tmp_path, monkeypatch):
    """An empty folder that stands for the folder of the code."""
    monkeypatch.setattr(git, "ROOT", tmp_path)
    forget()
    yield tmp_path
    forget()


def forget():
    commit.cache_clear()
    commit_date.cache_clear()


def write(folder, text, *names):
    for name in names:
        (folder / name).parent.mkdir(parents=True, exist_ok=True)
        (folder / name).write_text(text, encoding="utf-8")


def run_git(folder, *arguments):
    command = ["git", "-c", "user.name=A", "-c", "user.email=a@b", *arguments]
    done = subprocess.run(command, cwd=folder, capture_output=True, text=True, check=True)
    return done.stdout.strip()


def commit_all(folder):
    if not (folder / ".git").exists():
        run_git(folder, "init")
    run_git(folder, "add", ".")
    run_git(folder, "commit", "-m", "as it is")
    forget()
    return run_git(folder, "rev-parse", "HEAD")


def test_code_outside_git_has_no_commit_date_or_changes(folder):
    assert commit() == "unknown"
    assert commit_date() is None
    assert changed_code() == []
    assert changed_since("0123456789abcdef", ["film.py"]) is None


def test_code_of_an_archive_states_its_commit(folder):
    write(folder, "abc\n", "COMMIT")
    assert commit() == "abc"


@needs_git
def test_a_commit_is_marked_if_the_code_that_computes_has_changed(folder):
    write(folder, "1", "lube/stages/film.py", "workflow/scripts/stage.py", "README.md")
    head = commit_all(folder)
    write(folder, "2", "README.md")
    assert commit() == head
    write(folder, "2", "lube/stages/film.py")
    forget()
    assert commit() == f"{head}+changes"


@needs_git
def test_changed_and_new_files_of_the_code_are_listed(folder):
    write(folder, "1", "notebooks/fig1.ipynb", "lube/film.py", "lube/gauge.py", "notes.txt")
    commit_all(folder)
    assert changed_code() == []
    write(folder, "2", "notebooks/fig1.ipynb", "lube/gauge.py", "lube/new.py", "notes.txt", "more")
    run_git(folder, "add", "lube/gauge.py")
    assert changed_code() == ["lube/gauge.py", "lube/new.py", "notebooks/fig1.ipynb"]


def test_the_code_is_all_that_git_tracks_but_tests():
    files = set(code_files())
    assert {"Snakefile", "lube/stages/film.py", "notebooks/fig02_film.ipynb"} <= files
    assert not [name for name in files if "__pycache__" in name or name.startswith("results")]
    if (git.ROOT / ".git").exists():
        tracked = run_git(git.ROOT, "ls-files").splitlines()
        outside = ("tests/", ".ci/", ".git", ".snakemake", "results/")
        assert {name for name in tracked if not name.startswith(outside)} <= files


def test_other_files_of_the_user_are_not_code(folder):
    write(folder, "private", "workflow/config/mine.yaml", "workflow/config/run.csv", "notes.md")
    write(folder, "a figure", "notebooks/mine.ipynb", "notebooks/notes.txt")
    assert code_files() == ["notebooks/mine.ipynb"]
