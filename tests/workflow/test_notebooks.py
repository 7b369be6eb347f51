"""Notebooks: executed strictly, and the same whenever they are."""

import os

import nbformat
import pytest
from nbformat.v4 import new_code_cell, new_markdown_cell, new_notebook

from lube.errors import LubeError
from lube.workflow.notebooks import execute_notebook
from lube.workflow.stamps import DRAWN_BY

PARAMETERS = 'film = "somewhere"\nfigure = None'


@pytest.fixture
def write(tmp_path):
    """Write a notebook of a parameters cell and the given code, and return its path."""

    def write_notebook(*codes, parameters=PARAMETERS, tags=("parameters",)):
        cells = [new_markdown_cell("# A figure")]
        cells.append(new_code_cell(parameters, metadata={"tags": list(tags)}))
        cells.extend(new_code_cell(code) for code in codes)
        path = tmp_path / "figure.ipynb"
        nbformat.write(new_notebook(cells=cells), path)
        return path

    return write_notebook


def refusal(notebook, output, parameters):
    with pytest.raises(LubeError) as caught:
        execute_notebook(notebook, output, parameters, "")
    message = str(caught.value)
    assert message.startswith(f"{notebook}: ")
    assert "\n" not in message
    assert not output.exists()
    return message


def test_a_notebook_is_executed_with_its_parameters_twice_the_same(write, tmp_path):
    notebook = write("print(film, figure)", "from pathlib import Path; Path(figure).touch()")
    before = notebook.read_bytes()
    copies = [tmp_path / "made" / "first.ipynb", tmp_path / "made" / "second.ipynb"]
    for copy in copies:
        drawn = tmp_path / "drawn"
        execute_notebook(notebook, copy, {"film": "film.nc", "figure": str(drawn)}, "")
        assert drawn.exists()
    assert copies[0].read_bytes() == copies[1].read_bytes()
    assert notebook.read_bytes() == before
    outputs = [cell.get("outputs") for cell in nbformat.read(copies[0], as_version=4).cells]
    assert f"film.nc {drawn}\n" in str(outputs).replace("\\n", "\n")


def test_what_a_cell_prints_is_one_piece_however_slowly_it_comes(write, tmp_path):
    output = tmp_path / "executed.ipynb"
    execute_notebook(write("import time; print(1); time.sleep(0.7); print(2)"), output, {}, "")
    cell = nbformat.read(output, as_version=4).cells[-1]
    assert [printed.text for printed in cell.outputs] == ["1\n2\n"]


def test_an_executed_notebook_holds_no_clock_time_and_is_valid(write, tmp_path):
    output = tmp_path / "executed.ipynb"
    execute_notebook(write("1 + 1"), output, {}, "")
    text = output.read_text(encoding="utf-8")
    assert "start_time" not in text and "iopub" not in text and "duration" not in text
    nbformat.validate(nbformat.read(output, as_version=4))


def test_what_stamps_say_reaches_the_notebook_and_goes_with_it(write, tmp_path):
    notebook = write(f"import os; print(os.environ['{DRAWN_BY}'])")
    execute_notebook(notebook, tmp_path / "executed.ipynb", {}, "changed notebook")
    assert "changed notebook" in (tmp_path / "executed.ipynb").read_text("utf-8")
    assert DRAWN_BY not in os.environ


# A cell that fails

# Counted from 1, as a reader counts: text, parameters, and these.
CAUSED = """\
try:
    reciprocal(0)
except ZeroDivisionError as error:
    story = "long"
    raise ValueError('no\\nsuch film') from error
"""


@pytest.mark.parametrize("parameters", [{}, {"film": "film.nc"}])
@pytest.mark.parametrize(
    ("code", "told"),
    [
        ("x = 1\n\nraise ValueError('no\\nsuch film')", "at line 3: ValueError: no such film"),
        ("x = 1\nreciprocal(0)", "at line 2: ZeroDivisionError: division by zero"),
        (CAUSED, "at line 5: ValueError: no such film"),
        ("x = 1\ny = = 2", "at line 2: SyntaxError: invalid syntax"),
    ],
    ids=["raised", "in-a-function", "caused", "syntax"],
)
def test_a_failing_cell_is_told_in_one_line_and_leaves_no_copy(
    write, tmp_path, code, told, parameters
):
    notebook = write("def reciprocal(x):\n    return 1 / x", code)
    message = refusal(notebook, tmp_path / "executed.ipynb", parameters)
    assert message.startswith(f"{notebook}: cell 4 fails {told}")


def test_the_log_gets_the_traceback_with_cells_and_lines(write, tmp_path, caplog):
    caplog.set_level("DEBUG", "lube")
    notebook = write("def reciprocal(x):\n    return 1 / x", "x = 1\nreciprocal(0)")
    refusal(notebook, tmp_path / "executed.ipynb", {"film": "film.nc"})
    assert "Cell 4, line 2\n" in caplog.text
    assert "Cell 3, line 2, in reciprocal(x)\n" in caplog.text
    assert "----> 2     return 1 / x" in caplog.text
    assert "\x1b" not in caplog.text
    assert f"What was executed of it: {tmp_path / 'executed.failed.ipynb'}" in caplog.text


def test_what_was_executed_stays_beside_until_the_next_success(write, tmp_path):
    output, failed = tmp_path / "executed.ipynb", tmp_path / "executed.failed.ipynb"
    execute_notebook(write("print('good')"), output, {}, "")
    good = output.read_bytes()
    for _ in range(2):
        with pytest.raises(LubeError):
            execute_notebook(write("print('so far')", "1 / 0", "never"), output, {}, "")
        assert output.read_bytes() == good
        cells = nbformat.read(failed, as_version=4).cells
        kinds = [output.output_type for cell in cells for output in cell.get("outputs", [])]
        assert kinds == ["stream", "error"]
    execute_notebook(write("print('good')"), output, {}, "")
    assert output.read_bytes() == good
    assert not failed.exists()


def test_a_notebook_without_a_parameters_cell_is_refused(write, tmp_path):
    message = refusal(write("x = 1", tags=()), tmp_path / "executed.ipynb", {"film": "film.nc"})
    assert "no cell is tagged 'parameters'" in message


def test_a_parameters_cell_that_is_no_python_is_refused(write, tmp_path):
    message = refusal(write(parameters="film ="), tmp_path / "executed.ipynb", {})
    assert "got 'film =', which is not Python" in message


def test_a_parameter_that_the_notebook_does_not_know_is_refused(write, tmp_path):
    message = refusal(write("x = 1"), tmp_path / "executed.ipynb", {"trace": "trace.nc"})
    assert "parameter 'trace' is not in its parameters cell, which has film, figure" in message


def test_a_file_that_is_no_notebook_is_refused(tmp_path):
    path = tmp_path / "figure.ipynb"
    path.write_text("no notebook", encoding="utf-8")
    assert "not a Jupyter notebook" in refusal(path, tmp_path / "executed.ipynb", {})


def test_a_killed_kernel_is_told(write, tmp_path):
    notebook = write("x = 1", "import os, signal; os.kill(os.getpid(), signal.SIGKILL)")
    told = "its kernel was killed in cell 4, perhaps for want of memory"
    assert told in refusal(notebook, tmp_path / "executed.ipynb", {})
    assert (tmp_path / "executed.failed.ipynb").exists()
