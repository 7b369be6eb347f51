"""Executing a figure's notebook, strictly and reproducibly.

An executed notebook holds no clock times, so that it is the same whenever it is made.
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
from lube.pipeline.stamps import DRAWN_BY
from lube.storage.files import written_whole

log = logging.getLogger(__name__)

# Between the errors of a traceback.
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
        Notebook to execute; it is not changed. It has a cell tagged ``parameters``.
    output : str or Path
        Path of the executed copy, such as ``fig02_film.ipynb``, written only if all cells
        succeed. It has the notebook's own cells, without the given parameters. If a cell fails,
        the cells up to it are saved beside it as ``fig02_film.failed.ipynb``, which the next
        success removes, and the traceback goes to the log.
    parameters : dict
        Values for the names in that cell, given after it.
    drawn_by : str
        What the figure's stamp says of notebook and code, from `lube.pipeline.stamps.drawn_by`.
    code : str or Path, optional
        Folder that holds the package ``lube`` for the notebook; if not given, this one is used.

    Raises
    ------
    LubeError
        If a cell fails, the kernel is killed, or the copy cannot be written.
    """
    output = Path(output)
    failed = output.with_name(f"{output.stem}.failed.ipynb")
    with tempfile.TemporaryDirectory(prefix="lube-") as scratch:
        copy = Path(scratch) / output.name
        exit_code = _execute_apart(notebook, copy, parameters, drawn_by, code)
        if exit_code == 1:
            raise LubeError(f"{notebook}: could not be executed, for the reason printed above")
        executed = nbformat.read(copy, as_version=4)
    failure = _failure(executed.cells, exit_code)
    if failure:
        _save(executed, failed)
        log.debug("The cells executed so far: %s", failed)
        raise LubeError(f"{notebook}: {failure}")
    _save(executed, output)
    failed.unlink(missing_ok=True)


def _execute_apart(*arguments):
    """Execute a notebook in a process forked from this one; return its exit code.

    The notebook cannot change this process or the next notebook, and if its memory runs out, this
    process is still there to report it. What is imported here need not be imported again.
    """
    process = multiprocessing.get_context("fork").Process(
        target=_execute, args=arguments, daemon=True
    )
    process.start()
    process.join()
    return process.exitcode


def _execute(notebook, copy, parameters, drawn_by, code):
    """Execute a notebook until a cell fails; keep a copy of the cells that were started."""
    os.environ[DRAWN_BY] = drawn_by
    # Jupyter's debugger, not used here, would print a warning.
    os.environ["PYDEVD_DISABLE_FILE_VALIDATION"] = "1"
    if code is not None:
        _use_package_in(code)
    client = _kernel_client()
    executed = nbformat.v4.upgrade(nbformat.read(notebook, as_version=4))
    executed.metadata.language_info = client.kernel.language_info
    given = "\n".join(f"{name} = {value!r}" for name, value in parameters.items())
    cells, executed.cells = executed.cells, []
    for cell in cells:
        executed.cells.append(cell)
        nbformat.write(executed, copy)
        if cell.cell_type == "code":
            _run(cell, client)
        if _error_of(cell):
            break
        if given and "parameters" in cell.metadata.get("tags", ()):
            _run(nbformat.v4.new_code_cell(given), client)
    nbformat.write(executed, copy)


def _use_package_in(folder):
    """Let this process import `lube` again, from another folder."""
    for name in [name for name in sys.modules if name.split(".")[0] == "lube"]:
        del sys.modules[name]
    sys.path.insert(0, str(folder))


def _kernel_client():
    """Start a kernel in this process; a second process takes longer than drawing most figures."""
    # Nothing is added to the user's history of IPython.
    options = {"HistoryManager": {"enabled": False}, "InteractiveShell": {"colors": "nocolor"}}
    manager = InProcessKernelManager(config=Config(options))
    manager.start_kernel()
    # Pictures appear below the cells, in Matplotlib's defaults, not in the user's own style.
    manager.kernel.shell.enable_matplotlib("inline")
    matplotlib.pyplot.close("all")  # figures of the process that this one was forked from
    matplotlib.rcdefaults()
    client = manager.client()
    client.start_channels()
    return client


def _run(cell, client):
    """Run a code cell and put its outputs below it."""
    client.execute(cell.source)
    cell.execution_count, cell.outputs = client.get_shell_msg()["content"]["execution_count"], []
    # A thread delivers the outputs; the last message says that there are no more.
    while (message := client.get_iopub_msg())["content"].get("execution_state") != "idle":
        if message["msg_type"] in ("stream", "display_data", "execute_result", "error"):
            _add_output(cell, nbformat.v4.output_from_msg(message))


def _add_output(cell, output):
    """Add an output below a cell; what is printed in several pieces becomes one."""
    last = cell.outputs[-1] if cell.outputs else None
    if last and output.output_type == "stream" and last.get("name") == output.name:
        last.text += output.text
    else:
        cell.outputs.append(output)


def _error_of(cell):
    return next((one for one in cell.get("outputs", ()) if one.output_type == "error"), None)


def _failure(cells, exit_code):
    """Say in one line where and why the last cell fails, and log the traceback; empty if none."""
    number = len(cells)  # text included, as a reader of the notebook counts
    if exit_code != 0:
        return f"its kernel was killed in cell {number}, perhaps because memory ran out"
    error = _error_of(cells[-1])
    if error is None:
        return ""
    traceback = "\n".join(error.traceback)
    for n, cell in enumerate(cells, 1):
        traceback = traceback.replace(f"Cell In[{cell.get('execution_count')}]", f"Cell {n}")
    log.debug("%s", traceback)
    # The first frame of the error itself, after those of the errors that caused it.
    lines = re.findall(rf"Cell {number}, line (\d+)", _CAUSE.split(traceback)[-1])
    where = f" at line {lines[0]}" if lines else ""
    return f"cell {number} fails{where}: {' '.join(f'{error.ename}: {error.evalue}'.split())}"


def _save(executed, path):
    """Write an executed notebook, the same bytes each time: its cells are named by their numbers.

    It does not hold the paths of this run. Opened and run by hand, it shows the study in whose
    folder it lies, and writes nothing.
    """
    for number, cell in enumerate(executed.cells):
        cell.id = f"cell-{number}"
        cell.metadata.setdefault("tags", [])
        cell.metadata.pop("execution", None)
    with written_whole(path) as part:
        nbformat.write(executed, part)
