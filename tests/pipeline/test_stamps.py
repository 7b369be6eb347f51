"""Stamps state a figure's study, its values and the code that drew it."""

import json
import shutil
import subprocess

import pytest
import xarray as xr

from lube.errors import DataError
from lube.pipeline import stamps
from lube.pipeline.stamps import DRAWN_BY, drawn_by, stamp
from lube.storage import git
from lube.storage.git import commit
from lube.storage.provenance import config_text, digest, global_attributes


def made_by(study, kind):
    """A dataset that has nothing but its origin."""
    return xr.Dataset(attrs=global_attributes(study, kind))


def test_a_stamp_states_study_values_commit_and_what_the_workflow_adds(study, monkeypatch):
    film = made_by(study, "film")
    film.attrs["code_commit"] = "0123456789abcdef+changes"
    monkeypatch.setenv(DRAWN_BY, "")
    clean = f"study smoke · config {digest(config_text(study, 'film'))[:10]} · commit 0123456789+"
    assert stamp([film]) == clean
    monkeypatch.setenv(DRAWN_BY, "changed notebook")
    assert stamp([film]) == f"{clean} · changed notebook"


def test_files_of_two_studies_are_drawn_together_only_if_they_have_different_names(study):
    layer = study.boundary_layer.model_copy(update={"shear_strength": 2e6})
    stronger = study.model_copy(update={"boundary_layer": layer})
    pair = [made_by(study, "trace"), made_by(stronger, "trace")]
    expected = "not of one study: trace.boundary_layer.shear_strength is 2000000.0, need 1000000.0"
    with pytest.raises(DataError, match=expected):
        stamp(pair)
    pair[1] = made_by(stronger.model_copy(update={"name": "strong"}), "trace")
    names = [part.split(" · ")[0] for part in stamp(pair).split("; ")]
    assert names == ["study smoke", "study strong"]


def test_a_figure_needs_datasets_of_known_origin():
    with pytest.raises(DataError, match="attribute 'config' is missing or damaged, so its origin"):
        stamp([xr.Dataset()])
    with pytest.raises(DataError, match="needs the loaded datasets that it shows"):
        stamp([])


def test_a_stamp_drawn_by_hand_states_changes_of_the_code(study, monkeypatch):
    monkeypatch.delenv(DRAWN_BY, raising=False)
    asked = []
    monkeypatch.setattr(
        stamps, "changed_since", lambda name, files: asked.append(files) or ["lube/plots.py"]
    )
    assert stamp([made_by(study, "film")]).endswith(" · changed code")
    assert "lube/pipeline/stamps.py" in asked[0] and "lube/__init__.py" in asked[0]


# What differs from the commit


@pytest.fixture
def clone(tmp_path, monkeypatch):
    """A folder that stands for the clone, and a function that commits its content."""
    if shutil.which("git") is None:
        pytest.skip("needs Git")
    monkeypatch.setattr(git, "ROOT", tmp_path)
    monkeypatch.setattr(stamps, "ROOT", tmp_path)
    for name in ("lube/plots.py", "lube/stages/gauge.py", "notebooks/fig.ipynb"):
        (tmp_path / name).parent.mkdir(parents=True, exist_ok=True)
        (tmp_path / name).write_text(notebook_of("x = 1") if name.endswith("ipynb") else "1")

    def run(*arguments):
        command = ["git", "-c", "user.name=A", "-c", "user.email=a@b", *arguments]
        subprocess.run(command, cwd=tmp_path, capture_output=True, check=True)

    def commit_all():
        run("add", ".")
        run("commit", "-m", "as it is")
        commit.cache_clear()
        return commit()

    run("init")
    yield tmp_path, commit_all
    commit.cache_clear()


def notebook_of(source, outputs=()):
    cell = {"cell_type": "code", "metadata": {}, "source": [source], "outputs": [*outputs]}
    return json.dumps({"cells": [cell], "nbformat": 4, "nbformat_minor": 5, "metadata": {}})


@pytest.mark.parametrize(
    ("name", "text", "expected"),
    [
        ("README.md", "2", ""),
        ("lube/stages/gauge.py", "2", ""),
        ("lube/plots.py", "2", "changed code"),
        ("lube/new.py", "2", "changed code"),
        ("notebooks/fig.ipynb", notebook_of("x = 2"), "changed notebook"),
        ("notebooks/fig.ipynb", notebook_of("x = 1", ["saved by Jupyter"]), ""),
    ],
)
def test_changes_of_the_code_behind_a_figure_are_named(clone, name, text, expected):
    folder, commit_all = clone
    first = commit_all()
    code, notebook = ["lube/new.py", "lube/plots.py"], folder / "notebooks/fig.ipynb"
    assert drawn_by([first], code, notebook) == ""
    (folder / name).write_text(text)
    assert drawn_by([first], code, notebook) == expected
    assert drawn_by([f"{first}+changes"], code, notebook) == expected
    # Of datasets made at a commit that is not in this clone.
    parts = [f"drawn at commit {first[:10]}", expected]
    assert drawn_by(["unknown"], code, notebook) == " · ".join(filter(None, parts))
    # Once committed, they are named by the commit, unless they do not matter.
    second = commit_all()
    later = f"drawn at commit {second[:10]}" if expected else ""
    assert drawn_by([first], code, notebook) == later
    assert drawn_by([first, second], code, notebook) == ""


def test_a_notebook_that_was_never_committed_is_new(clone):
    folder, commit_all = clone
    first = commit_all()
    new = folder / "notebooks/new.ipynb"
    new.write_text(notebook_of("x = 1"))
    (folder / "lube/plots.py").write_text("2")
    assert drawn_by([first], ["lube/stages/gauge.py"], new) == "new notebook"
    assert drawn_by([first], ["lube/plots.py"], new) == "new notebook · changed code"


def test_in_an_unpacked_archive_changes_are_unknown(tmp_path, monkeypatch):
    monkeypatch.setattr(git, "ROOT", tmp_path)
    commit.cache_clear()
    assert drawn_by(["0123456789abcdef"], ["lube/plots.py"], tmp_path / "fig.ipynb") == ""
    commit.cache_clear()
