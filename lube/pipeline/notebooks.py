"""Executing a figure's notebook, strictly and reproducibly.

Papermill by itself ignores a missing parameters cell and only warns of a parameter that the
notebook does not know, and it writes clock times into its output. Here the first two are errors
and the times are removed, so that an executed notebook is the same whenever it is made.
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
import papermill
from ipykernel.inprocess import InProcessKernelManager
from papermill.engines import Engine, papermill_engines
from papermill.exceptions import PapermillExecutionError
from traitlets.config import Config

from lube.errors import LubeError
from lube.pipeline.cells import parameters_of
from lube.pipeline.stamps import DRAWN_BY
from lube.storage.files import written_whole

log = logging.getLogger(__name__)
# Papermill's own reading of the parameters, which warns of all but the simplest Python.
logging.getLogger("papermill.translators").setLevel(logging.ERROR)

_CELL_FAILED = 3
"""Exit code of the process if a cell fails; Python itself ends with 1 at any other error."""

_INJECTED = "injected-parameters"
_ADDED = {_INJECTED, "papermill-error-cell-tag"}
"""Tags of the cells that papermill adds."""

# Parts of IPython's tracebacks.
_COLOUR = re.compile(r"\x1b\[[0-9;]*m")
_CAUSE = re.compile(r"The above exception was the direct cause|During handling of the above")

_FOLDER = re.compile(r"\S*/ipykernel_\d+/(?=\d+\.py)")
"""Folder of the file by which a warning names a cell; it has the number of the process."""


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
    """Execute a notebook with papermill; its output is written even if a cell fails."""
    os.environ[DRAWN_BY] = drawn_by
    # Jupyter's debugger, not used here, would print a warning.
    os.environ["PYDEVD_DISABLE_FILE_VALIDATION"] = "1"
    if code is not None:  # the notebook imports `lube` again, from that folder
        for name in [name for name in sys.modules if name.split(".")[0] == "lube"]:
            del sys.modules[name]
        sys.path.insert(0, str(code))
    options = {"kernel_name": "python3", "language": "python", "progress_bar": False}
    try:
        papermill.execute_notebook(notebook, output, parameters, _ENGINE, **options)
    except PapermillExecutionError:
        raise SystemExit(_CELL_FAILED) from None


class _InProcess(Engine):
    """Engine of papermill that executes the cells in this process.

    Papermill's own engine starts a second process, which takes longer than drawing most figures.
    """

    @classmethod
    def execute_managed_notebook(cls, nb_man, kernel_name, **options):
        # Nothing is added to the user's history of IPython.
        manager = InProcessKernelManager(config=Config({"HistoryManager": {"enabled": False}}))
        manager.start_kernel()
        # Pictures appear below the cells, in Matplotlib's defaults, not in the user's own style.
        manager.kernel.shell.enable_matplotlib("inline")
        matplotlib.pyplot.close("all")  # figures of the process that this one was forked from
        matplotlib.rcdefaults()
        client = manager.client()
        client.start_channels()
        nb_man.nb.metadata.language_info = manager.kernel.language_info
        for cell in nb_man.nb.cells:
            nb_man.cell_start(cell)
            failed = cell.cell_type == "code" and _run(cell, client) == "error"
            if failed:
                nb_man.cell_exception(cell)
            nb_man.cell_complete(cell)
            if failed:
                break


papermill_engines.register(_ENGINE := "in-process", _InProcess)


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


def _failure(executed, exit_code):
    """Say in one line which cell fails, where and why; log the full traceback."""
    cells = [cell for cell in executed.cells if _ADDED.isdisjoint(_tags(cell))]
    # Counted from 1, text included, as a reader of the notebook counts.
    started = [n for n, cell in enumerate(cells, 1) if cell.metadata.papermill.start_time]
    if exit_code != _CELL_FAILED:
        return f"its kernel was killed in cell {started[-1]}, perhaps because memory ran out"
    outputs = [(n, one) for n, cell in enumerate(cells, 1) for one in cell.get("outputs", ())]
    # The error is not always in the cell that ran last: a cell may show an error and go on.
    number, error = [(n, one) for n, one in outputs if one.output_type == "error"][-1]
    traceback = _COLOUR.sub("", "\n".join(error.traceback))
    for n, cell in enumerate(cells, 1):
        traceback = traceback.replace(f"Cell In[{cell.get('execution_count')}]", f"Cell {n}")
    log.debug("%s", traceback)
    # The first frame of the error itself, after the frames of the errors that caused it.
    lines = re.findall(rf"Cell {number}, line (\d+)", _CAUSE.split(traceback)[-1])
    where = f" at line {lines[0]}" if lines else ""
    return f"cell {number} fails{where}: {' '.join(f'{error.ename}: {error.evalue}'.split())}"


def _tags(cell):
    return cell.metadata.get("tags", [])


def _save(executed, path):
    """Write an executed notebook, the same bytes each time.

    Papermill's clock times and random cell names are removed, the process number in warnings too,
    and the cell with this run's paths: without it the copy, opened and run by hand, shows the study
    in whose folder it lies, and writes nothing.
    """
    executed.metadata.pop("papermill", None)
    executed.cells = [cell for cell in executed.cells if _INJECTED not in _tags(cell)]
    for number, cell in enumerate(executed.cells):
        cell.metadata.pop("papermill", None)
        cell.metadata.pop("execution", None)
        cell.id = f"cell-{number}"
        for output in cell.get("outputs", ()):
            if output.output_type == "stream":
                output.text = _FOLDER.sub("", output.text)
    with written_whole(path) as part:
        nbformat.write(executed, part)
