"""What a notebook says by its cells, read without executing them."""

import ast
import json
from pathlib import Path

from lube.errors import LubeError
from lube.schema import DATASETS, MEASURED


def cells_of(notebook):
    """Cells of a notebook, reduced to what decides on its figure.

    Parameters
    ----------
    notebook : str or Path
        The notebook.

    Returns
    -------
    list of dict
        As from `reduced`.

    Raises
    ------
    LubeError
        If the file is not there, or no notebook.
    """
    try:
        return reduced(Path(notebook).read_text(encoding="utf-8"))
    except OSError as error:
        raise LubeError(f"{notebook}: cannot be read: {error.strerror}") from None
    except ValueError:
        raise LubeError(f"{notebook}: not a Jupyter notebook, damaged or foreign") from None


def reduced(text):
    """Reduce the text of a notebook's file to its cells' kinds, sources and tags.

    Outputs, counts and other metadata are left out: they change when somebody runs and saves
    the notebook.

    Parameters
    ----------
    text : str
        JSON.

    Returns
    -------
    list of dict
        With the keys ``type``, ``source`` and ``tags``.

    Raises
    ------
    ValueError
        If it is no notebook.
    """
    try:
        return [
            {
                "type": cell["cell_type"],
                "source": "".join(cell["source"]),
                "tags": cell.get("metadata", {}).get("tags", []),
            }
            for cell in json.loads(text)["cells"]
        ]
    except (KeyError, TypeError, AttributeError, RecursionError) as error:
        raise ValueError("not a notebook") from error


def python_of(cell, notebook):
    """Python of a code cell, without the lines that only Jupyter understands.

    Parameters
    ----------
    cell : dict
        A cell of `cells_of`.
    notebook : str or Path
        Its notebook, for the message.

    Returns
    -------
    str
        The code.

    Raises
    ------
    LubeError
        If it is not Python.
    """
    lines = cell["source"].splitlines()
    code = "\n".join(line for line in lines if not line.lstrip().startswith(("%", "!")))
    try:
        ast.parse(code)
    except (SyntaxError, ValueError) as error:
        came = repr((getattr(error, "text", None) or "").strip())
        raise LubeError(f"{notebook}: got {came}, which is not Python") from None
    return code


def parameters_of(notebook):
    """Variables that a notebook takes: those assigned in its cell tagged ``parameters``.

    Parameters
    ----------
    notebook : str or Path
        The notebook.

    Returns
    -------
    dict
        From name to value, as far as that is a plain text or number, else to None.

    Raises
    ------
    LubeError
        If the file is not there or no notebook, or has no such cell of Python.
    """
    tagged = [cell for cell in cells_of(notebook) if "parameters" in cell["tags"]]
    if not tagged:
        raise LubeError(f"{notebook}: no cell is tagged 'parameters', need one with the paths")
    found = {}
    for node in ast.parse(python_of(tagged[0], notebook)).body:
        if isinstance(node, ast.Assign | ast.AnnAssign):
            targets = node.targets if isinstance(node, ast.Assign) else [node.target]
            value = node.value.value if isinstance(node.value, ast.Constant) else None
            found |= {target.id: value for target in targets if isinstance(target, ast.Name)}
    return found


def datasets_of(notebook):
    """Variables of a notebook that name datasets, by their values, such as ``"../film.nc"``.

    Parameters
    ----------
    notebook : str or Path
        The notebook.

    Returns
    -------
    dict
        From name to kind: ``film`` for any path whose last part is ``film.nc``.

    Raises
    ------
    LubeError
        As from `parameters_of`.
    """
    kinds = {f"{kind}.nc": kind for kind in (*DATASETS, *MEASURED)}
    named = {
        name: kinds.get(value.rsplit("/", 1)[-1])
        for name, value in parameters_of(notebook).items()
        if isinstance(value, str)
    }
    return {name: kind for name, kind in named.items() if kind}
