"""Stamps lead from a figure to its study, its values and the code that drew it."""

import json
import shutil
import subprocess

import pytest
import xarray as xr

from lube.errors import DataError
from lube.storage.git import commit
from lube.storage.provenance import config_text, digest, global_attributes
from lube.workflow import stamps
from lube.workflow.stamps import DRAWN_BY, drawn_by, stamp


def made_by(study, kind):
    """A dataset of which nothing matters but its origin."""
    return xr.Dataset(attrs=global_attributes(study, kind))


@pytest.fixture
def stronger(study):
    """The study with a stronger boundary layer."""
    layer = study.boundary_layer.model_copy(update={"shear_strength": 2e6})
    return study.model_copy(update={"boundary_layer": layer})


# What a file says


def test_files_of_two_studies_make_no_figure_unless_they_say_so(study, stronger):
    pair = [made_by(study, "trace"), made_by(stronger, "trace")]
    told = "not of one study: trace.boundary_layer.shear_strength is 1000000.0, need 2000000.0"
    with pytest.raises(DataError, match=told):
        stamp(pair)
    pair[1] = made_by(stronger.model_copy(update={"name": "strong"}), "trace")
    assert [part.split(" · ")[0] for part in stamp(pair).split("; ")] == [
        "study smoke",
        "study strong",
    ]


@pytest.fixture
def as_committed(monkeypatch):
    """What the workflow tells a notebook that is as in its commit, as is all code behind it."""
    monkeypatch.setenv(DRAWN_BY, "")


def test_a_stamp_leads_to_study_values_and_code(study, as_committed):
    film = made_by(study, "film")
    digits = digest(config_text(study, "film"))[:10]
    film.attrs["code_commit"] = "0123456789abcdef+changes"
    assert stamp([film]) == f"study smoke · config {digits} · commit 0123456789+"


def test_a_stamp_says_what_the_workflow_knows_of_its_notebook(study, monkeypatch, as_committed):
    clean = stamp([made_by(study, "film")])
    monkeypatch.setenv(DRAWN_BY, "changed notebook")
    assert stamp([made_by(study, "film")]) == f"{clean} · changed notebook"


@pytest.fixture
def clone(tmp_path, monkeypatch):
    """A folder taken for the clone, with one commit; and a way to commit what is there."""
    if shutil.which("git") is None:
        pytest.skip("needs Git")
    monkeypatch.setattr("lube.storage.git.ROOT", tmp_path)
    monkeypatch.setattr(stamps, "ROOT", tmp_path)
    monkeypatch.delenv(DRAWN_BY, raising=False)
    for name in ("lube/plots.py", "lube/stages/gauge.py", "notebooks/fig.ipynb"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(notebook_of("x = 1") if name.endswith("ipynb") else "1")

    def git(*arguments):
        command = ["git", "-c", "user.name=A", "-c", "user.email=a@b", *arguments]
        subprocess.run(command, cwd=tmp_path, capture_output=True, check=True)

    def commit_all():
        git("add", ".")
        git("commit", "-m", "as it is")
        commit.cache_clear()
        return commit()

    git("init")
    yield tmp_path, commit_all
    commit.cache_clear()


def notebook_of(source, outputs=()):
    cell = {"cell_type": "code", "metadata": {}, "source": [source], "outputs": [*outputs]}
    return json.dumps({"cells": [cell], "nbformat": 4, "nbformat_minor": 5, "metadata": {}})


@pytest.mark.parametrize(
    ("name", "text", "told"),
    [
        (None, None, ""),
        ("README.md", "2", ""),
        ("lube/stages/gauge.py", "2", ""),
        ("lube/plots.py", "2", "changed code"),
        ("lube/new.py", "2", "changed code"),
        ("notebooks/fig.ipynb", notebook_of("x = 2"), "changed notebook"),
        ("notebooks/fig.ipynb", notebook_of("x = 1", ["saved by Jupyter"]), ""),
    ],
)
def test_a_stamp_says_what_differs_from_the_commit(clone, name, text, told):
    folder, commit_all = clone
    first = commit_all()
    if name:
        (folder / name).write_text(text)
    code = ["lube/new.py", "lube/plots.py"]
    notebook = folder / "notebooks/fig.ipynb"
    assert drawn_by([first], code, notebook) == told
    # What was computed by changed code as well.
    assert drawn_by([f"{first}+changes"], code, notebook) == told
    # What was computed by code that nobody here knows.
    elsewhere = " · ".join(filter(None, [f"drawn at commit {first[:10]}", told]))
    assert drawn_by(["unknown"], code, notebook) == elsewhere
    # Once it is committed, the stamp leads there, but for what makes no difference.
    if name:
        second = commit_all()
        expected = f"drawn at commit {second[:10]}" if told else ""
        assert drawn_by([first], code, notebook) == expected
        assert drawn_by([first, second], code, notebook) == ""


def test_a_notebook_that_was_never_committed_is_new(clone):
    folder, commit_all = clone
    first = commit_all()
    new = folder / "notebooks/new.ipynb"
    new.write_text(notebook_of("x = 1"))
    (folder / "lube/plots.py").write_text("2")
    assert drawn_by([first], ["lube/stages/gauge.py"], new) == "new notebook"
    assert drawn_by([first], ["lube/plots.py"], new) == "new notebook · changed code"


def test_in_an_unpacked_archive_nobody_knows_what_is_changed(tmp_path, monkeypatch):
    monkeypatch.setattr("lube.storage.git.ROOT", tmp_path)
    commit.cache_clear()
    assert drawn_by(["0123456789abcdef"], ["lube/plots.py"], tmp_path / "fig.ipynb") == ""
    commit.cache_clear()


def test_by_hand_a_stamp_says_what_it_knows_of_the_code(study, monkeypatch):
    monkeypatch.delenv(DRAWN_BY, raising=False)
    asked = []
    monkeypatch.setattr(
        stamps,
        "changed_since",
        lambda name, files: asked.append(files) or ["lube/storage/netcdf.py"],
    )
    film = made_by(study, "film")
    film.attrs["code_commit"] = commit()
    assert stamp([film]).endswith(" · changed code")
    assert "lube/workflow/stamps.py" in asked[0] and "lube/__init__.py" in asked[0]


def test_a_dataset_from_elsewhere_cannot_be_stamped():
    with pytest.raises(DataError, match="attribute 'config' is missing or damaged, so its origin"):
        stamp([xr.Dataset()])
