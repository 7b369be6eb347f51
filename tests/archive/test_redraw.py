"""Figures of an archive drawn again; workflow/test_archived_study.py executes real notebooks."""

import json

import pytest

from lube.archive.redraw import redraw
from lube.archive.verify import verify_archive
from lube.errors import DataError, LubeError

FIGURE = "fig02_film"


@pytest.fixture
def executed(monkeypatch):
    """The parameters of executed notebooks, which draw the same pictures as in the archive."""
    calls = []

    def execute(notebook, output, parameters, changes, code):
        calls.append(parameters | {"changes": changes, "code": code})
        for suffix in ("png", "pdf"):
            output.parent.mkdir(exist_ok=True)
            output.with_suffix(f".{suffix}").write_text(f"figures/{FIGURE}.{suffix}")

    monkeypatch.setattr("lube.archive.redraw.execute_notebook", execute)
    return calls


def test_figures_are_drawn_from_the_archive_and_compared(changed, tmp_path, executed):
    origin = changed / f"figures/{FIGURE}.json"
    content = json.loads(origin.read_text("utf-8")) | {"drawn_by": "changed notebook"}
    origin.write_text(json.dumps(content))
    new = tmp_path / "new"
    assert dict(redraw(changed, new, [])) == {f"{FIGURE}.png": True, f"{FIGURE}.pdf": True}
    (parameters,) = executed
    assert parameters["film"] == str(changed / "data/film.nc")
    assert parameters["figure"] == str(new / FIGURE)
    assert parameters["changes"] == "changed notebook"
    assert parameters["code"] == changed / "code"
    (changed / f"figures/{FIGURE}.png").write_text("another")
    (changed / f"figures/{FIGURE}.pdf").unlink()
    assert not any(dict(redraw(changed, new, [FIGURE])).values())


def test_figures_that_cannot_be_drawn_are_refused(archive, changed, tmp_path):
    (tmp_path / "file").touch()
    for folder, target, figures, expected in (
        (archive, tmp_path, ["fig99"], f"got fig99, need a figure of the archive: {FIGURE}"),
        (archive, tmp_path / "file", [], "need a folder outside the archive"),
        (archive, archive / "notebooks/../figures", [], "need a folder outside the archive"),
    ):
        with pytest.raises(DataError, match=expected):
            list(redraw(folder, target, figures))
    assert verify_archive(archive) == []
    (changed / f"code/notebooks/{FIGURE}.ipynb").unlink()
    with pytest.raises(LubeError, match=r"fig02_film.ipynb: cannot be read: No such file"):
        list(redraw(changed, tmp_path / "new", []))
