"""Executing a figure's notebook, strictly and reproducibly.

Papermill by itself passes over a missing parameters cell and only warns of a parameter that
the notebook does not know; and it writes clock times into its output. Here the first two are
errors and the last is taken out, so that an executed notebook is the same whenever it is made.
"""

from pathlib import Path

import nbformat
import papermill
from papermill.exceptions import PapermillExecutionError

from lube.errors import LubeError

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
        If the notebook has no cell tagged ``parameters``, does not know a parameter, or a
        cell fails.
    """
    _check_parameters(notebook, parameters)
    try:
        executed = papermill.execute_notebook(
            str(notebook),
            None,
            parameters,
            kernel_name="python3",
            progress_bar=False,
            extra_arguments=_QUIET_KERNEL,
        )
    except PapermillExecutionError as error:
        reason = " ".join(f"{error.ename}: {error.evalue}".split())
        raise LubeError(f"{notebook}: cell {error.cell_index} fails: {reason}") from error
    Path(output).parent.mkdir(parents=True, exist_ok=True)
    nbformat.write(_without_times(executed), output)


def _check_parameters(notebook, parameters):
    cells = nbformat.read(notebook, as_version=4).cells
    if not any("parameters" in cell.metadata.get("tags", []) for cell in cells):
        raise LubeError(f"{notebook}: no cell is tagged 'parameters', need one with the paths")
    known = papermill.inspect_notebook(str(notebook))
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
