"""The code that runs: its commit, whatever surrounds it, and its files."""

import shutil
import subprocess

import pytest

from lube.storage.git import (
    ROOT,
    changed_code,
    changed_since,
    code_files,
    commit,
    commit_date,
    text_in,
)


@pytest.fixture
def place(tmp_path, monkeypatch):
    """A folder taken for that of the code."""
    monkeypatch.setattr("lube.storage.ROOT", tmp_path)
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
    (place / "lube/stages").mkdir(parents=True)
    (place / "workflow" / "scripts").mkdir(parents=True)
    for name in ("lube/stages/film.py", "workflow/scripts/film.py", "README.md"):
        (place / name).write_text("1")
    git(place, "init")
    git(place, "add", ".")
    git(place, "commit", "-m", "first")
    (place / "README.md").write_text("2")
    head = git(place, "rev-parse", "HEAD")
    assert commit() == head
    (place / "lube/stages/film.py").write_text("2")
    commit.cache_clear()
    assert commit() == f"{head}+changes"


@pytest.mark.skipif(shutil.which("git") is None, reason="needs Git")
def test_code_tells_which_of_its_files_are_not_in_the_commit(place):
    for name in (
        "notebooks/fig1.ipynb",
        "lube/stages/film.py",
        "lube/stages/gauge.py",
        "notes.txt",
    ):
        (place / name).parent.mkdir(exist_ok=True)
        (place / name).write_text("1")
    git(place, "init")
    git(place, "add", ".")
    git(place, "commit", "-m", "first")
    assert changed_code() == []
    for name in (
        "notebooks/fig1.ipynb",
        "lube/stages/gauge.py",
        "lube/new.py",
        "notes.txt",
        "more.txt",
    ):
        (place / name).write_text("2")
    git(place, "add", "lube/stages/gauge.py")
    assert changed_code() == ["lube/stages/gauge.py", "lube/new.py", "notebooks/fig1.ipynb"]


@pytest.mark.skipif(shutil.which("git") is None, reason="needs Git")
def test_files_are_compared_with_any_commit(place):
    names = ["film.py", "plots.py", "[a].py"]
    for name in names:
        (place / name).write_text("1 µm")
    git(place, "init")
    git(place, "add", ".")
    git(place, "commit", "-m", "first")
    first = git(place, "rev-parse", "HEAD")
    (place / "film.py").write_text("2")
    git(place, "commit", "-am", "second")
    second = git(place, "rev-parse", "HEAD")
    (place / "[a].py").write_text("2")
    (place / "new.py").write_text("1")
    names.append("new.py")
    assert changed_since(first, names) == ["[a].py", "film.py", "new.py"]
    assert changed_since(second, names) == ["[a].py", "new.py"]
    assert changed_since(second, ["plots.py"]) == changed_since(second, []) == []
    assert (text_in(first, "film.py"), text_in(second, "film.py")) == ("1 µm", "2")
    assert text_in(second, "new.py") is None


@pytest.mark.skipif(shutil.which("git") is None, reason="needs Git")
@pytest.mark.parametrize("name", ["unknown", "0123456789abcdef", "--output=stolen", "HEAD"])
def test_of_what_is_no_commit_nobody_knows(place, name):
    git(place, "init")
    assert changed_since(name, ["film.py"]) is None
    assert not (place / "stolen").exists()


def test_code_outside_git_knows_of_no_changes(place):
    assert changed_code() == []
    assert changed_since("0123456789abcdef", ["film.py"]) is None


def test_code_in_git_has_a_day_and_code_elsewhere_has_none(place):
    commit_date.cache_clear()
    assert commit_date() is None
    commit_date.cache_clear()


def test_the_files_of_the_code_are_those_that_make_and_draw_results():
    files = code_files()
    for needed in ("Snakefile", "lube/stages/film.py", "notebooks/fig02_film.ipynb"):
        assert needed in files
    assert not [name for name in files if "__pycache__" in name or name.startswith("results")]


@pytest.mark.skipif(not (ROOT / ".git").exists(), reason="needs the clone")
def test_all_files_of_the_clone_but_tests_are_code():
    tracked = set(git(ROOT, "ls-files").splitlines())
    passing = ("tests/", ".ci/", ".git")
    needed = {name for name in tracked if not name.startswith(passing)}
    assert needed <= set(code_files())


def test_what_its_user_leaves_among_the_code_is_not_code(place):
    for name in ("workflow/config/mine.yaml", "workflow/config/run.csv", "notebooks/notes.txt"):
        (place / name).parent.mkdir(parents=True, exist_ok=True)
        (place / name).write_text("private")
    (place / "notebooks/mine.ipynb").write_text("a figure")
    assert code_files() == ["notebooks/mine.ipynb"]
