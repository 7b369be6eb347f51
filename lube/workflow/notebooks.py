"""Executing a figure's notebook, strictly and reproducibly.

Papermill by itself passes over a missing parameters cell and only warns of a parameter that
the notebook does not know; and it writes clock times into its output. Here the first two are
errors and the last is taken out, so that an executed notebook is the same whenever it is made.
"""

import contextlib
import logging
import os
import re
import tempfile
from pathlib import Path

import nbformat
import papermill
from nbclient.exceptions import DeadKernelError
from papermill.exceptions import PapermillExecutionError

from lube.errors import LubeError
from lube.storage.files import written_whole
from lube.workflow.cells import parameters_of
from lube.workflow.stamps import DRAWN_BY

log = logging.getLogger(__name__)

# A kernel that is stopped after its last cell reports a KeyboardInterrupt; it alarms for nothing.
_QUIET_KERNEL = ["--log-level=CRITICAL"]

_ADDED = {"injected-parameters", "papermill-error-cell-tag"}
"""Tags of the cells that papermill adds."""

# What IPython writes into a traceback.
_COLOUR = re.compile(r"\x1b\[[0-9;]*m")
_LED_TO = re.compile(r"The above exception was the direct cause|During handling of the above")


def execute_notebook(notebook, output, parameters, drawn_by):
    """Execute a notebook with the given parameters and save the executed copy.

    Parameters
    ----------
    notebook : str or Path
        Notebook to execute; it stays as it is.
    output : str or Path
        Where the executed copy goes, such as ``fig02_film.ipynb``, written only if all cells
        succeed. Else what was executed goes beside it, to ``fig02_film.failed.ipynb``, which
        the next success removes; and the traceback goes to the log.
    parameters : dict
        Values for the names in the cell tagged ``parameters``.
    drawn_by : str
        What its stamps say of notebook and code, as from `lube.storage.provenance.drawn_by`.

    Raises
    ------
    LubeError
        If the file is no notebook, has no cell tagged ``parameters``, does not know a
        parameter, a cell fails, the kernel is killed, or the copy cannot be written.
    """
    _check_parameters(notebook, parameters)
    output = Path(output)
    failed = output.with_name(f"{output.stem}.failed.ipynb")
    with tempfile.TemporaryDirectory(prefix="lube-") as scratch:
        executed = Path(scratch) / output.name
        try:
            with environment({DRAWN_BY: drawn_by}):
                _execute(notebook, executed, parameters)
        except (PapermillExecutionError, DeadKernelError) as error:
            cells = nbformat.read(executed, as_version=4)
            told = _failure(error, cells)
            _save(cells, failed)
            log.debug("What was executed of it: %s", failed)
            raise LubeError(f"{notebook}: {told}") from error
        _save(nbformat.read(executed, as_version=4), output)
    failed.unlink(missing_ok=True)


def _execute(notebook, output, parameters):
    """Let papermill execute a notebook; its output is there even if a cell fails."""
    with _kernel_kept_quiet():
        papermill.execute_notebook(
            str(notebook),
            str(output),
            parameters,
            kernel_name="python3",
            language="python",
            progress_bar=False,
            # Else what a cell prints is in one piece or several, as the clock will.
            coalesce_streams=True,
            extra_arguments=_QUIET_KERNEL,
        )


def _failure(error, executed):
    """Tell in one line which cell fails, where and why; the log gets the whole traceback."""
    cells = [cell for cell in executed.cells if not _ADDED & set(cell.metadata.get("tags", []))]
    # Counted from 1, text included, as a reader of the notebook counts.
    number = max(n for n, cell in enumerate(cells, 1) if cell.metadata.papermill.start_time)
    if isinstance(error, DeadKernelError):
        return f"its kernel was killed in cell {number}, perhaps for want of memory"
    named = {f"Cell In[{cell.get('execution_count')}]": n for n, cell in enumerate(cells, 1)}
    traceback = _COLOUR.sub("", "\n".join(error.traceback))
    for count, cell_number in named.items():
        traceback = traceback.replace(count, f"Cell {cell_number}")
    log.debug("%s", traceback)
    # The first frame of the error itself, behind those of errors that led to it.
    lines = re.findall(rf"Cell {number}, line (\d+)", _LED_TO.split(traceback)[-1])
    place = f" at line {lines[0]}" if lines else ""
    return f"cell {number} fails{place}: {' '.join(f'{error.ename}: {error.evalue}'.split())}"


def _save(executed, path):
    """Write an executed notebook, the same bytes each time."""
    with written_whole(path) as part:
        nbformat.write(_without_times(executed), part)


@contextlib.contextmanager
def environment(variables):
    """Set variables of the environment for a while, for the processes begun in it.

    Parameters
    ----------
    variables : dict
        From name to value.
    """
    before = {name: os.environ.get(name) for name in variables}
    os.environ.update(variables)
    try:
        yield
    finally:
        for name, value in before.items():
            os.environ.pop(name)
            if value is not None:
                os.environ[name] = value


@contextlib.contextmanager
def _kernel_kept_quiet():
    """Keep what a kernel says while it closes off the terminal: it alarms and means nothing.

    What goes wrong in a cell reaches us as an exception, and not by way of standard error.
    """
    terminal = os.dup(2)
    try:
        with open(os.devnull, "wb") as nowhere:
            os.dup2(nowhere.fileno(), 2)
        yield
    finally:
        os.dup2(terminal, 2)
        os.close(terminal)


def _check_parameters(notebook, parameters):
    known = parameters_of(notebook)
    for name in parameters:
        if name not in known:
            raise LubeError(
                f"{notebook}: parameter {name!r} is not in its parameters cell, which has "
                f"{', '.join(known)}"
            )


def _without_times(executed):
    """Drop clock times and random cell names that papermill leaves in a notebook."""
    executed.metadata.pop("papermill", None)
    for number, cell in enumerate(executed.cells):
        cell.metadata.pop("papermill", None)
        cell.metadata.pop("execution", None)
        cell.id = f"cell-{number}"
    return executed
