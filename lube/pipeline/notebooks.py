"""Executing a figure's notebook, strictly and reproducibly.

A missing parameters cell, and a parameter that the notebook does not know, are errors. The executed
notebook holds no clock time, so that it is the same whenever it is made.
"""

import logging
import multiprocessing
import os
import re
import sys
import tempfile
from collections.abc import Mapping
from pathlib import Path

import matplotlib
import nbformat
from ipykernel.inprocess import InProcessKernelManager
from traitlets.config import Config

from lube.errors import LubeError
from lube.pipeline.cells import parameters_of
from lube.pipeline.stamps import DRAWN_BY
from lube.storage.files import written_whole

log = logging.getLogger(__name__)

_CELL_FAILED = 3
"""Exit code of the process if a cell fails; Python itself ends with 1 at any other error."""

_RUNNING = "running"
"""Key of the metadata of a notebook that is being executed: the number of the cell that runs."""

# Parts of IPython's tracebacks.
_COLOUR = re.compile(r"\x1b\[[0-9;]*m")
_CAUSE = re.compile(r"The above exception was the direct cause|During handling of the above")


def execute_notebook(
    notebook: str | Path,
    output: str | Path,
    parameters: Mapping[str, object],
    drawn_by: str,
    code: str | Path | None = None,
) -> None:
    """Execute a notebook with the given parameters and save the executed copy.

    Parameters
    ----------
    notebook : str or Path
        Notebook to execute; it is not changed.
    output : str or Path
        Path of the executed copy, such as ``fig02_film.ipynb``, written only if all cells
        succeed. It has the notebook's own cells, without the given parameters. If a cell fails,
        the cells executed so far are saved beside it as ``fig02_film.failed.ipynb``, which the
        next successful execution removes, and the traceback goes to the log.
    parameters : dict
        Values for the names in the cell tagged ``parameters``.
    drawn_by : str
        What the figure's stamp says of notebook and code, from `lube.pipeline.stamps.drawn_by`.
    code : str or Path, optional
        Folder with the package ``lube`` for the notebook; by default the running package.

    Raises
    ------
    LubeError
        If the file is not a notebook, has no cell tagged ``parameters``, does not know a
        parameter, a cell fails, the kernel is killed, or the copy cannot be written.
    """
    known = parameters_of(notebook)
    for name in parameters:
        if name not in known:
            there = f"its parameters cell, which has {', '.join(known)}"
            raise LubeError(f"{notebook}: parameter {name!r} is not in {there}")
    output = Path(output)
    failed = output.with_name(f"{output.stem}.failed.ipynb")
    with tempfile.TemporaryDirectory(prefix="lube-") as scratch:
        executed = Path(scratch) / output.name
        exit_code = _execute_apart(str(notebook), str(executed), dict(parameters), drawn_by, code)
        if exit_code == 1:
            raise LubeError(f"{notebook}: could not be executed, for the reason printed above")
        cells = nbformat.read(executed, as_version=4)
    if exit_code != 0:
        message = _failure(cells, exit_code)
        _save(cells, failed)
        log.debug("The cells executed so far: %s", failed)
        raise LubeError(f"{notebook}: {message}")
    _save(cells, output)
    failed.unlink(missing_ok=True)


def _execute_apart(*arguments):
    """Execute a notebook in a process forked from this one; return its exit code.

    The notebook cannot change this process or the next notebook, and if its memory runs out, this
    process is still there to report it. What is imported here need not be imported again.
    """
    fork = multiprocessing.get_context("fork")
    process = fork.Process(target=_execute, args=arguments, daemon=True)
    process.start()
    process.join()
    return process.exitcode


def _execute(notebook, output, parameters, drawn_by, code):
    """Execute a notebook in this process; what has been executed is written before each cell."""
    os.environ[DRAWN_BY] = drawn_by
    # Jupyter's debugger, not used here, would print a warning.
    os.environ["PYDEVD_DISABLE_FILE_VALIDATION"] = "1"
    if code is not None:  # the notebook imports `lube` again, from that folder
        for name in [name for name in sys.modules if name.split(".")[0] == "lube"]:
            del sys.modules[name]
        sys.path.insert(0, str(code))
    executed = nbformat.v4.upgrade(nbformat.read(notebook, as_version=4))
    client, executed.metadata.language_info = _kernel()
    given = "\n".join(f"{name} = {value!r}" for name, value in parameters.items())
    for cell in executed.cells:
        if cell.cell_type == "code":
            cell.outputs, cell.execution_count = [], None
    for number, cell in enumerate(executed.cells, start=1):
        executed.metadata[_RUNNING] = number
        nbformat.write(executed, output)
        if cell.cell_type == "code" and _run(cell, client) == "error":
            break
        if given and "parameters" in cell.metadata.get("tags", ()):
            _run(nbformat.v4.new_code_cell(given), client)
    nbformat.write(executed, output)
    if _errors(executed):
        raise SystemExit(_CELL_FAILED)


def _kernel():
    """Start a kernel in this process; return its client, and the metadata on its language.

    A kernel in a second process takes longer to start than most figures take to draw.
    """
    # Nothing is added to the user's history of IPython.
    manager = InProcessKernelManager(config=Config({"HistoryManager": {"enabled": False}}))
    manager.start_kernel()
    # Pictures appear below the cells, in Matplotlib's defaults, not in the user's own style.
    manager.kernel.shell.enable_matplotlib("inline")
    matplotlib.pyplot.close("all")  # figures of the process that this one was forked from
    matplotlib.rcdefaults()
    client = manager.client()
    client.start_channels()
    return client, manager.kernel.language_info


def _run(cell, client):
    """Run a code cell and put its outputs below it; return `ok` or `error`."""
    client.execute(cell.source)
    reply = client.get_shell_msg()["content"]
    cell.execution_count = reply["execution_count"]
    # A thread delivers the outputs; the last message says that there are no more.
    while (message := client.get_iopub_msg())["content"].get("execution_state") != "idle":
        if message["msg_type"] in ("stream", "display_data", "execute_result", "error"):
            _add_output(cell, nbformat.v4.output_from_msg(message))
    return reply["status"]


def _add_output(cell, output):
    """Add an output below a cell; what is printed in several pieces becomes one."""
    last = cell.outputs[-1] if cell.outputs else None
    if last and output.output_type == "stream" and last.get("name") == output.name:
        last.text += output.text
    else:
        cell.outputs.append(output)


def _errors(executed):
    """List the errors below the cells, each with the number of its cell.

    Cells are counted from 1, text included, as a reader of the notebook counts.
    """
    found = []
    for number, cell in enumerate(executed.cells, start=1):
        found += [(number, one) for one in cell.get("outputs", ()) if one.output_type == "error"]
    return found


def _failure(executed, exit_code):
    """Say in one line which cell fails, where and why; log the full traceback."""
    if exit_code != _CELL_FAILED:
        number = executed.metadata[_RUNNING]
        return f"its kernel was killed in cell {number}, perhaps because memory ran out"
    # The error is not always in the cell that ran last: a cell may show an error and go on.
    number, error = _errors(executed)[-1]
    traceback = _COLOUR.sub("", "\n".join(error.traceback))
    for n, cell in enumerate(executed.cells, 1):
        traceback = traceback.replace(f"Cell In[{cell.get('execution_count')}]", f"Cell {n}")
    log.debug("%s", traceback)
    # The first frame of the error itself, after the frames of the errors that caused it.
    lines = re.findall(rf"Cell {number}, line (\d+)", _CAUSE.split(traceback)[-1])
    where = f" at line {lines[0]}" if lines else ""
    return f"cell {number} fails{where}: {' '.join(f'{error.ename}: {error.evalue}'.split())}"


def _save(executed, path):
    """Write an executed notebook, the same bytes each time.

    It does not hold this run's paths: opened and run by hand, it shows the study in whose folder it
    lies, and writes nothing.
    """
    del executed.metadata[_RUNNING]
    for number, cell in enumerate(executed.cells):
        cell.metadata.pop("execution", None)  # clock times, from an editor
        cell.metadata.setdefault("tags", [])
        cell.id = f"cell-{number}"
    with written_whole(path) as part:
        nbformat.write(executed, part)
