"""Figures of a study under Snakemake: run by hand, failing, stamped."""

import nbformat
import pytest
from nbclient import NotebookClient
from repository import products_of
from written_notebooks import DRAW, write_notebook

PICTURE, TARGET = "figures/fig99_mine.png", "results/smoke/figures/fig99_mine.png"


def made(repository):
    """Content of the figure's files, except its origin."""
    names = products_of("fig99_mine") - {"figures/fig99_mine.json"}
    return {name: (repository.results / name).read_bytes() for name in names}


@pytest.mark.parametrize("folder", ["notebooks", "results/smoke/notebooks"])
def test_a_notebook_run_by_hand_shows_its_figure_once_and_writes_nothing(
    spare, monkeypatch, folder
):
    """A notebook of the repository, or the copy that the workflow has executed."""
    before = spare.snapshot()
    monkeypatch.setenv("PYTHONPATH", str(spare.folder))
    if folder == "notebooks":
        monkeypatch.setenv("LUBE_STUDY", "smoke")
    notebook = nbformat.read(spare / folder / "fig02_film.ipynb", as_version=4)
    NotebookClient(notebook, resources={"metadata": {"path": spare / folder}}).execute()
    outputs = [output for cell in notebook.cells for output in cell.get("outputs", [])]
    assert len([output for output in outputs if "image/png" in output.get("data", {})]) == 1
    assert spare.snapshot() == before
    assert {path.name for path in (spare / "results").iterdir()} == {"smoke"}


@pytest.mark.slow
def test_a_failing_cell_is_named_and_leaves_the_old_figure(spare):
    """What else a failing cell leaves is tested in test_notebooks.py."""
    notebook = spare / "notebooks/fig99_mine.ipynb"
    write_notebook(notebook, DRAW.format(1))
    assert spare.planned() == products_of("fig99_mine")
    spare.run(TARGET)
    old = made(spare)
    # The cell fails after another figure was saved. It fails again when nothing has changed.
    write_notebook(notebook, DRAW.format(2), "x = 1\nx / 0")
    for targets in ([], [TARGET]):
        finished = spare.snakemake(*targets)
        assert finished.returncode != 0
        line = "Error: notebooks/fig99_mine.ipynb: cell 4 fails at line 2: ZeroDivisionError: divis"
        assert line in finished.stdout
        assert line in (spare.results / "logs/fig99_mine.log").read_text("utf-8")
        assert made(spare) == old
    write_notebook(notebook, DRAW.format(2))
    spare.run()
    assert made(spare)[PICTURE] != old[PICTURE]
    assert "Nothing to be done" in spare.run()
