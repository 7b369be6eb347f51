"""The content of a notebook's cells, read without executing them."""

import ast
import json
from pathlib import Path
from typing import Any

from lube.errors import LubeError
from lube.schema import DATASETS, ON_REQUEST
from lube.types import File


def cells_of(notebook: File) -> list[dict[str, Any]]:
    """Read the cells of a notebook, reduced to what determines its figure.

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
        If the file does not exist or is not a notebook.
    """
    try:
        return reduced(Path(notebook).read_text(encoding="utf-8"))
    except OSError as error:
        raise LubeError(f"{notebook}: cannot be read: {error.strerror}") from None
    except (ValueError, KeyError, TypeError):
        raise LubeError(f"{notebook}: not a Jupyter notebook, or a damaged one") from None


def reduced(text: str) -> list[dict[str, Any]]:
    """Reduce a notebook to the type, source and tags of its cells.

    Outputs, execution counts and other metadata change whenever somebody runs and saves the
    notebook, so they are left out.

    Parameters
    ----------
    text : str
        Content of the notebook's file, JSON.

    Returns
    -------
    list of dict
        With the keys ``type``, ``source`` and ``tags``.
    """
    cells = []
    for cell in json.loads(text)["cells"]:
        source, tags = "".join(cell["source"]), cell.get("metadata", {}).get("tags", [])
        cells.append({"type": cell["cell_type"], "source": source, "tags": tags})
    return cells


def python_of(cell: dict[str, Any], notebook: File) -> str:
    """Return the Python code of a cell, without lines of IPython such as ``%matplotlib inline``.

    Parameters
    ----------
    cell : dict
        A code cell of `cells_of`.
    notebook : str or Path
        Its notebook, for the message.

    Returns
    -------
    str
        The code.

    Raises
    ------
    LubeError
        If it is not valid Python.
    """
    lines = cell["source"].splitlines()
    code = "\n".join(line for line in lines if not line.lstrip().startswith(("%", "!")))
    try:
        ast.parse(code)
    except SyntaxError as error:
        came = repr((error.text or "").strip())
        raise LubeError(f"{notebook}: got {came}, which is not Python") from None
    return code


def parameters_of(notebook: File) -> dict[str, Any]:
    """Read the parameters of a notebook: the variables of its cell tagged ``parameters``.

    Parameters
    ----------
    notebook : str or Path
        The notebook.

    Returns
    -------
    dict
        From the variable's name to its value. A single text or number is kept; of a path such as
        ``study / "film.nc"`` the last name is kept; any other value becomes None.

    Raises
    ------
    LubeError
        If the file does not exist, is not a notebook, or has no such cell of valid Python.
    """
    tagged = [cell for cell in cells_of(notebook) if "parameters" in cell["tags"]]
    if not tagged:
        raise LubeError(f"{notebook}: no cell is tagged 'parameters', need one with the datasets")
    found = {}
    for node in ast.parse(python_of(tagged[0], notebook)).body:
        if isinstance(node, ast.Assign | ast.AnnAssign):
            targets = node.targets if isinstance(node, ast.Assign) else [node.target]
            value = _constant(node.value)
            found |= {target.id: value for target in targets if isinstance(target, ast.Name)}
    return found


def _constant(value):
    """Value of a text or number, or of the name at the end of a path such as folder / "film.nc"."""
    match value:
        case ast.BinOp(op=ast.Div(), right=ast.Constant(value=str(name))):
            return name
        case ast.Constant(value=constant):
            return constant
    return None


def datasets_of(notebook: File) -> dict[str, str]:
    """Find the parameters of a notebook whose values are paths of datasets.

    Parameters
    ----------
    notebook : str or Path
        The notebook.

    Returns
    -------
    dict
        From each parameter to its kind of dataset: ``film`` for any path that ends in ``film.nc``.

    Raises
    ------
    LubeError
        As from `parameters_of`.
    """
    kinds = {f"{kind}.nc": kind for kind in (*DATASETS, *ON_REQUEST)}
    names = {key: str(value).rpartition("/")[2] for key, value in parameters_of(notebook).items()}
    return {parameter: kinds[name] for parameter, name in names.items() if name in kinds}
