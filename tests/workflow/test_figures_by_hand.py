"""Figures of a study under Snakemake: run by hand, failing, stamped."""

import nbformat
from nbclient import NotebookClient
from nbformat.v4 import new_code_cell, new_notebook
from repository import products_of

PICTURE, TARGET = "figures/fig99_mine.png", "results/smoke/figures/fig99_mine.png"
DRAW = """\
import matplotlib.pyplot as plt
from lube import plots
from lube.storage import netcdf
canvas, axes = plt.subplots()
line = axes.plot([{}, speed])
plots.save_figure(canvas, figure, netcdf.load(oil, "film"))
"""


def write(repository, *codes):
    """Write the notebook of a figure, with names of its own for its parameters."""
    parameters = 'oil = "../results/paper/film.nc"\nspeed = 100\nfigure = None'
    cells = [new_code_cell(parameters, metadata={"tags": ["parameters"]})]
    path = repository / "notebooks/fig99_mine.ipynb"
    nbformat.write(new_notebook(cells=[*cells, *map(new_code_cell, codes)]), path)


def made(repository):
    """Content of the figure's files, except its origin."""
    names = products_of("fig99_mine") - {"figures/fig99_mine.json"}
    return {name: (repository.results / name).read_bytes() for name in names}


def test_a_notebook_run_by_hand_shows_its_figure_once_and_writes_nothing(spare, monkeypatch):
    (spare / "results/paper").symlink_to("smoke")
    before = spare.snapshot()
    monkeypatch.setenv("PYTHONPATH", str(spare.folder))
    notebook = nbformat.read(spare / "notebooks/fig02_film.ipynb", as_version=4)
    NotebookClient(notebook, resources={"metadata": {"path": spare / "notebooks"}}).execute()
    outputs = [output for cell in notebook.cells for output in cell.get("outputs", [])]
    assert len([output for output in outputs if "image/png" in output.get("data", {})]) == 1
    assert spare.snapshot() == before
    assert {path.name for path in (spare / "results").iterdir()} == {"smoke", "paper"}


def test_a_failing_cell_leaves_its_traceback_and_the_old_figure(spare):
    write(spare, DRAW.format(1))
    assert spare.planned() == products_of("fig99_mine")
    spare.run(TARGET)
    executed = (spare.results / "notebooks/fig99_mine.ipynb").read_text("utf-8")
    assert r"oil = \"results/smoke/film.nc\"" in executed
    assert "speed = 100" in executed
    old = made(spare)
    failed = spare.results / "notebooks/fig99_mine.failed.ipynb"
    # The cell fails after another figure was saved. It fails again when nothing has changed.
    write(spare, DRAW.format(2), "x = 1\nx / 0")
    for targets in ([], [TARGET]):
        finished = spare.snakemake(*targets)
        assert finished.returncode != 0
        line = "notebooks/fig99_mine.ipynb: cell 3 fails at line 2: ZeroDivisionError: division by"
        assert f"Error: {line} zero\n" in finished.stdout
        log = (spare.results / "logs/fig99_mine.log").read_text("utf-8")
        assert "Cell 3, line 2\n" in log and "----> 2 x / 0" in log
        assert log.splitlines()[-1] == f"Error: {line} zero"
        assert made(spare) == old
        assert "ZeroDivisionError" in failed.read_text("utf-8")
    write(spare, DRAW.format(2))
    spare.run()
    assert made(spare)[PICTURE] != old[PICTURE]
    assert not failed.exists()
    assert "Nothing to be done" in spare.run()
