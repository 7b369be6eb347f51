"""Executing a figure's notebook, strictly and reproducibly.

Papermill by itself passes over a missing parameters cell and only warns of a parameter that
the notebook does not know; and it writes clock times into its output. Here the first two are
errors and the last is taken out, so that an executed notebook is the same whenever it is made.
"""

import ast
import contextlib
import os

import nbformat
import papermill
from nbclient.exceptions import DeadKernelError
from papermill.exceptions import PapermillExecutionError

from lube.errors import LubeError
from lube.files import written_whole

# A kernel that is stopped after its last cell reports a KeyboardInterrupt; it alarms for nothing.
_QUIET_KERNEL = ["--log-level=CRITICAL"]


def execute_notebook(notebook, output, parameters):
    """Execute a notebook with the given parameters and save the executed copy.

    Parameters
    ----------
    notebook : str or Path
        Notebook to execute; it stays as it is.
    output : str or Path
        Where the executed copy goes, written only if all cells succeed.
    parameters : dict
        Values for the names in the cell tagged ``parameters``.

    Raises
    ------
    LubeError
        If the file is no notebook, has no cell tagged ``parameters``, does not know a
        parameter, a cell fails, the kernel is killed, or the copy cannot be written.
    """
    _check_parameters(notebook, parameters)
    try:
        with _kernel_kept_quiet():
            executed = papermill.execute_notebook(
                str(notebook),
                None,
                parameters,
                kernel_name="python3",
                language="python",
                progress_bar=False,
                # Else what a cell prints is in one piece or several, as the clock will.
                coalesce_streams=True,
                extra_arguments=_QUIET_KERNEL,
            )
    except PapermillExecutionError as error:
        reason = " ".join(f"{error.ename}: {error.evalue}".split())
        raise LubeError(f"{notebook}: cell {error.cell_index} fails: {reason}") from error
    except DeadKernelError as error:
        raise LubeError(f"{notebook}: its kernel was killed, perhaps for want of memory") from error
    with written_whole(output) as part:
        nbformat.write(_without_times(executed), part)


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


def parameters_of(notebook):
    """Names that a notebook takes: those assigned in its cell tagged ``parameters``.

    Parameters
    ----------
    notebook : str or Path
        The notebook.

    Returns
    -------
    list of str
        The names in order.

    Raises
    ------
    LubeError
        If the file is not there or no notebook, or has no such cell of Python.
    """
    try:
        cells = nbformat.read(notebook, as_version=4).cells
    except OSError as error:
        raise LubeError(f"{notebook}: cannot be read: {error.strerror}") from None
    except ValueError:
        raise LubeError(f"{notebook}: not a Jupyter notebook, damaged or foreign") from None
    tagged = [cell for cell in cells if "parameters" in cell.metadata.get("tags", [])]
    if not tagged:
        raise LubeError(f"{notebook}: no cell is tagged 'parameters', need one with the paths")
    try:
        return _assigned_names(tagged[0].source)
    except (SyntaxError, ValueError):
        raise LubeError(f"{notebook}: its parameters cell is not Python") from None


def _check_parameters(notebook, parameters):
    known = parameters_of(notebook)
    for name in parameters:
        if name not in known:
            raise LubeError(
                f"{notebook}: parameter {name!r} is not in its parameters cell, which has "
                f"{', '.join(known)}"
            )


def _assigned_names(code):
    assignments = [node for node in ast.parse(code).body if isinstance(node, ast.Assign)]
    targets = [target for assignment in assignments for target in assignment.targets]
    return [target.id for target in targets if isinstance(target, ast.Name)]


def _without_times(executed):
    """Drop clock times and random cell names that papermill leaves in a notebook."""
    executed.metadata.pop("papermill", None)
    for number, cell in enumerate(executed.cells):
        cell.metadata.pop("papermill", None)
        cell.metadata.pop("execution", None)
        cell.id = f"cell-{number}"
    return executed
