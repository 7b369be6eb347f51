"""What a study's figures stand: notebooks run by hand, cells that fail, files changed by hand."""

import re
import subprocess

import nbformat
import pytest
from nbclient import NotebookClient
from nbformat.v4 import new_code_cell, new_notebook
from PIL import Image
from repository import environment, products_of

from lube.archive.verify import verify_archive

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
    """Write the notebook of a figure whose variables are called as they like."""
    parameters = 'oil = "../results/paper/film.nc"\nspeed = 100\nfigure = None'
    cells = [new_code_cell(parameters, metadata={"tags": ["parameters"]})]
    path = repository / "notebooks/fig99_mine.ipynb"
    nbformat.write(new_notebook(cells=[*cells, *map(new_code_cell, codes)]), path)


def made(repository):
    """What there is of the figure, but for its origin."""
    names = products_of("fig99_mine") - {"figures/fig99_mine.json"}
    return {name: (repository.results / name).read_bytes() for name in names}


# By hand


@pytest.mark.parametrize("figure", ["fig02_film", "fig07_probability"])
def test_a_notebook_run_by_hand_shows_its_figure_once_and_touches_nothing(
    spare, monkeypatch, figure
):
    (spare / "results/paper").symlink_to("smoke")
    before = spare.snapshot()
    monkeypatch.setenv("PYTHONPATH", str(spare.folder))
    notebook = nbformat.read(spare / f"notebooks/{figure}.ipynb", as_version=4)
    place = {"metadata": {"path": spare / "notebooks"}}
    NotebookClient(notebook, resources=place).execute()
    outputs = [output for cell in notebook.cells for output in cell.get("outputs", [])]
    assert len([output for output in outputs if "image/png" in output.get("data", {})]) == 1
    assert spare.snapshot() == before
    assert {path.name for path in (spare / "results").iterdir()} == {"smoke", "paper"}


def test_a_figure_gets_the_datasets_that_its_values_name(spare):
    write(spare, DRAW.format(1))
    assert spare.planned() == products_of("fig99_mine")
    spare.run(TARGET)
    executed = (spare.results / "notebooks/fig99_mine.ipynb").read_text("utf-8")
    assert r"oil = \"results/smoke/film.nc\"" in executed
    assert "speed = 100" in executed


# A cell that fails


def test_a_failing_cell_leaves_its_traceback_and_the_old_figure(spare):
    write(spare, DRAW.format(1))
    spare.run(TARGET)
    old = made(spare)
    failed = spare.results / "notebooks/fig99_mine.failed.ipynb"
    # It has saved another figure by then.
    write(spare, DRAW.format(2), "x = 1\nx / 0")
    # The second time nothing has changed but that it failed; nor does it help to ask for less.
    for targets in ([], [], [TARGET]):
        finished = spare.snakemake(*targets)
        assert finished.returncode != 0
        told = "notebooks/fig99_mine.ipynb: cell 3 fails at line 2: ZeroDivisionError: division by"
        assert f"Error: {told} zero\n" in finished.stdout
        log = (spare.results / "logs/fig99_mine.log").read_text("utf-8")
        assert "Cell 3, line 2\n" in log and "----> 2 x / 0" in log
        assert log.splitlines()[-1] == f"Error: {told} zero"
        assert made(spare) == old
        assert "ZeroDivisionError" in failed.read_text("utf-8")
    write(spare, DRAW.format(2))
    spare.run()
    assert made(spare)[PICTURE] != old[PICTURE]
    assert not failed.exists()
    assert "Nothing to be done" in spare.run()


def test_a_notebook_that_saves_no_figure_does_not_pass_the_old_one_for_new(spare):
    write(spare, DRAW.format(1))
    spare.run(TARGET)
    old = made(spare)
    write(spare, "x = 1")
    finished = spare.snakemake(TARGET)
    assert finished.returncode != 0
    assert "Error: notebooks/fig99_mine.ipynb: saved no figure, need plots.sa" in finished.stdout
    assert made(spare) == old


# The archive


def refusal(repository):
    finished = repository.snakemake("archive")
    assert finished.returncode != 0
    assert "Traceback" not in finished.stdout
    (line,) = set(re.findall("^Error: .*", finished.stdout, re.MULTILINE))
    return line.removeprefix("Error: ")


def test_an_archive_holds_what_the_workflow_made_and_nothing_else(spare):
    spare.run("archive")
    archive = spare.results / "archive/smoke"
    for name in ("figures/fig02_film.png", "notebooks/fig05_contact_length.ipynb"):
        path = spare.results / name
        path.write_bytes(path.read_bytes() + b"\n")
        for _ in range(2):  # the old archive that stays is none of the new figure
            told = f"results/smoke/{name}: not as the workflow made it"
            assert refusal(spare) == f"{told}; take it away and run snakemake again"
        assert verify_archive(archive) == []
        path.unlink()
        spare.run("archive")
        assert verify_archive(archive) == []
    checked = ["sha256sum", "--check", "smoke.zip.sha256"]
    subprocess.run(checked, cwd=archive.parent, check=True, capture_output=True)


# The stamp


def stamp_of(path):
    with Image.open(path) as picture:
        return picture.text["Description"]


def test_a_stamp_says_when_notebook_or_code_are_not_as_committed(spare):
    def git(*arguments):
        command = ["git", "-c", "user.name=A", "-c", "user.email=a@b", *arguments]
        subprocess.run(command, cwd=spare.folder, env=environment(), check=True, timeout=60)

    (spare / ".gitignore").write_text("results/\n.snakemake/\n__pycache__/\n")
    git("init", "--quiet")
    git("add", ".")
    git("commit", "--quiet", "-m", "first")
    (spare.results / "film.nc").unlink()
    write(spare, DRAW.format(1))
    spare.run(TARGET)
    clean = stamp_of(spare / TARGET).removesuffix(" · new notebook")
    assert re.fullmatch(r"study smoke · config \w{10} · commit [0-9a-f]{10}", clean)
    assert stamp_of(spare / TARGET) == f"{clean} · new notebook"
    git("add", ".")
    git("commit", "--quiet", "-m", "second")
    write(spare, DRAW.format(2))
    spare.append("lube/plots.py", "# changed")
    spare.run(TARGET)
    added = stamp_of(spare / TARGET).removeprefix(clean)
    assert re.fullmatch(r" · drawn at commit \w{10} · changed notebook · changed code", added)
