"""Notebooks: executed strictly, apart from this process, and the same whenever they are."""

import os
from functools import partial

import matplotlib.pyplot as plt
import nbformat
import pytest
from written_notebooks import write_notebook

from lube.errors import LubeError
from lube.pipeline.notebooks import execute_notebook
from lube.pipeline.stamps import DRAWN_BY

PARAMETERS = 'film = "somewhere"\nfigure = None'


@pytest.fixture
def write(tmp_path):
    """Write a notebook of a parameters cell and the given code, and return its path."""
    return partial(write_notebook, tmp_path / "figure.ipynb", parameters=PARAMETERS)


@pytest.fixture
def output(tmp_path):
    return tmp_path / "made" / "executed.ipynb"


def outputs_of(path):
    cells = nbformat.read(path, as_version=4).cells
    return [shown for cell in cells for shown in cell.get("outputs", [])]


def sources_of(path):
    return [cell.source for cell in nbformat.read(path, as_version=4).cells]


def refusal(notebook, output, parameters):
    with pytest.raises(LubeError) as caught:
        execute_notebook(notebook, output, parameters, "")
    message = str(caught.value)
    assert message.startswith(f"{notebook}: ")
    assert "\n" not in message
    assert not output.exists()
    return message


def test_a_notebook_is_executed_with_its_parameters_twice_the_same(write, output, tmp_path):
    notebook = write("print(film, figure)", "from pathlib import Path; Path(figure).touch()")
    before, copies = notebook.read_bytes(), []
    drawn = tmp_path / "drawn"
    for _ in range(2):
        execute_notebook(notebook, output, {"film": "film.nc", "figure": str(drawn)}, "")
        assert sources_of(output) == sources_of(notebook)  # without the parameters of this run
        copies.append(output.read_bytes())
        assert drawn.exists()
    assert copies[0] == copies[1]
    assert notebook.read_bytes() == before
    assert outputs_of(output)[0].text == f"film.nc {drawn}\n"
    for time in (b"start_time", b"iopub", b"duration"):
        assert time not in copies[0]
    nbformat.validate(nbformat.read(output, as_version=4))


def test_a_cell_is_named_without_the_number_of_the_process(write, output):
    """As in a warning, which begins with the path of the code."""
    notebook, copies = write("import sys", "print(sys._getframe().f_code.co_filename)"), []
    for _ in range(2):
        execute_notebook(notebook, output, {}, "")
        copies.append(output.read_bytes())
    assert copies[0] == copies[1]
    assert outputs_of(output)[0].text.removesuffix(".py\n").isdigit()


def test_all_kinds_of_output_are_kept_in_order(write, output):
    code = """
import sys, time
import matplotlib.pyplot as plt
from IPython.display import display, Markdown
print(1)
time.sleep(0.7)  # what is printed slowly is one piece all the same
print(2)
print("careful", file=sys.stderr)
display(Markdown("shown"))
plt.plot([1, 2])
1 + 1
"""
    execute_notebook(write(code), output, {}, "")
    outputs = outputs_of(output)
    kinds = [one.output_type for one in outputs]
    assert kinds == ["stream", "stream", "display_data", "execute_result", "display_data"]
    printed, warned, shown, result, picture = outputs
    assert (printed.name, printed.text) == ("stdout", "1\n2\n")
    assert (warned.name, warned.text) == ("stderr", "careful\n")
    assert shown.data["text/markdown"] == "shown"
    assert result.data["text/plain"] == "2"
    assert "image/png" in picture.data
    cell = nbformat.read(output, as_version=4).cells[-1]
    assert cell.execution_count == result.execution_count == 2


def test_figures_of_this_process_are_not_the_notebooks(write, output):
    here = plt.figure()
    code = "import matplotlib.pyplot as plt\nplt.plot([1, 2])\nlen(plt.get_fignums())"
    execute_notebook(write(code), output, {}, "")
    result, picture = outputs_of(output)
    assert result.data["text/plain"] == "1" and "image/png" in picture.data
    assert plt.fignum_exists(here.number)
    plt.close(here)


def test_the_stamps_text_and_no_style_of_the_users_reach_the_notebook(
    write, output, tmp_path, monkeypatch
):
    (tmp_path / "matplotlibrc").write_text("lines.linewidth: 7")
    monkeypatch.setenv("MATPLOTLIBRC", str(tmp_path))
    codes = f"import os; os.environ['{DRAWN_BY}']", "from matplotlib import rcParams"
    notebook = write(*codes, "rcParams['lines.linewidth']")
    execute_notebook(notebook, output, {}, "changed notebook")
    shown = [shown.data["text/plain"] for shown in outputs_of(output)]
    assert shown == ["'changed notebook'", "1.5"]
    assert DRAWN_BY not in os.environ
    assert os.environ["MATPLOTLIBRC"] == str(tmp_path)


def test_a_notebook_takes_the_package_from_the_folder_that_is_named(write, output, tmp_path):
    (tmp_path / "lube").mkdir()
    (tmp_path / "lube/__init__.py").write_text("film = 'archived'")
    execute_notebook(write("from lube import film; print(film)"), output, {}, "", tmp_path)
    assert outputs_of(output)[0].text == "archived\n"


# A cell that fails

# Counted from 1, as a reader counts: text, parameters, and these.
CAUSED = """\
try:
    reciprocal(0)
except ZeroDivisionError as error:
    story = "long"
    raise ValueError('no\\nsuch film') from error
"""


def test_a_failing_cell_is_named_in_one_line(write, output):
    cases = {
        "x = 1\n\nraise ValueError('no\\nsuch film')": "at line 3: ValueError: no such film",
        "x = 1\nreciprocal(0)": "at line 2: ZeroDivisionError: division by zero",
        CAUSED: "at line 5: ValueError: no such film",
        "x = 1\ny = = 2": "at line 2: SyntaxError: invalid syntax",
    }
    every_other = 2 * [{}, {"film": "film.nc"}]
    for (code, reason), parameters in zip(cases.items(), every_other, strict=True):
        notebook = write("def reciprocal(x):\n    return 1 / x", code)
        message = refusal(notebook, output, parameters)
        assert message.startswith(f"{notebook}: cell 4 fails {reason}")


def test_an_error_is_found_in_whichever_cell_it_is(write, output):
    handled = "try:\n    1 / 0\nexcept ZeroDivisionError:\n    get_ipython().showtraceback()"
    message = refusal(write(handled, "x = 1"), output, {})
    assert "cell 3 fails" in message and "ZeroDivisionError: division by zero" in message


def test_the_log_gets_the_traceback_with_cells_and_lines(write, output, caplog):
    caplog.set_level("DEBUG", "lube")
    notebook = write("def reciprocal(x):\n    return 1 / x", "x = 1\nreciprocal(0)")
    refusal(notebook, output, {"film": "film.nc"})
    assert "Cell 4, line 2\n" in caplog.text
    assert "Cell 3, line 2, in reciprocal(x)\n" in caplog.text
    assert "----> 2     return 1 / x" in caplog.text
    assert "\x1b" not in caplog.text
    assert f"The cells executed so far: {output.with_suffix('.failed.ipynb')}" in caplog.text


def test_the_cells_executed_so_far_are_kept_until_the_next_success(write, output):
    failed = output.with_suffix(".failed.ipynb")
    execute_notebook(write("print('good')"), output, {}, "")
    good = output.read_bytes()
    with pytest.raises(LubeError):
        execute_notebook(write("print('so far')", "1 / 0", "print('never')"), output, {}, "")
    assert output.read_bytes() == good
    assert [shown.output_type for shown in outputs_of(failed)] == ["stream", "error"]
    execute_notebook(write("print('good')"), output, {}, "")
    assert output.read_bytes() == good
    assert not failed.exists()


def test_a_killed_kernel_is_reported(write, output):
    notebook = write("x = 1", "import os, signal; os.kill(os.getpid(), signal.SIGKILL)")
    reason = "its kernel was killed in cell 4, perhaps because memory ran out"
    assert reason in refusal(notebook, output, {})
    assert output.with_suffix(".failed.ipynb").exists()


# A notebook that cannot be executed


def test_what_is_not_a_notebook_with_the_wanted_parameters_is_refused(write, output):
    cases = [
        ({"tag": "another"}, {"film": "film.nc"}, "no cell is tagged 'parameters'"),
        ({"parameters": "film ="}, {}, "got 'film =', which is not Python"),
        ({}, {"trace": "trace.nc"}, "parameter 'trace' is not in its parameters cell, which has"),
    ]
    for written, parameters, reason in cases:
        assert reason in refusal(write("x = 1", **written), output, parameters)
    path = write()
    path.write_text("no notebook", encoding="utf-8")
    assert "not a Jupyter notebook" in refusal(path, output, {})
