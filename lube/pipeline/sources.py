"""Which files of the lube package a script or notebook depends on, found by its imports.

Snakemake does not notice a change of an imported package. So every rule has these files among
its inputs, and an edited module reruns the jobs that use it.
"""

import ast
import functools
import os
from pathlib import Path

from lube.lazy import homes
from lube.storage.git import ROOT
from lube.types import File

_PACKAGES = {"lube", "lube.stages"}
"""Packages that offer names defined in other modules."""
_BY_VALUE = {"lube.study.study", "lube.schema.stages"}
"""Modules that affect a stage only by the values they give it, which are parameters of its rule."""


def from_here(name: File) -> str:
    """Return the path of a file of the repository as seen from the working folder.

    The two folders differ where the workflow is a module of another one.

    Parameters
    ----------
    name : str or Path
        Its path, from `ROOT` on if relative.

    Returns
    -------
    str
        The relative path, so that the repository can be moved together with its results.
    """
    return os.path.relpath(ROOT / name)


def imported_modules(code: str) -> tuple[str, ...]:
    """List the modules that some Python code imports, at its top or inside functions.

    Parameters
    ----------
    code : str
        Python.

    Returns
    -------
    tuple of str
        Full names of all that may be modules: for ``from lube.stages import film`` both
        ``lube.stages`` and ``lube.stages.film``. For a name from another module, such as
        ``from lube import load``, the module that defines it.

    Examples
    --------
    >>> imported_modules("import numpy as np")
    ('numpy',)
    """
    found = []
    for node in ast.walk(ast.parse(code)):
        if isinstance(node, ast.ImportFrom) and node.module:
            names = [alias.name for alias in node.names]
            found += [node.module, *(f"{node.module}.{name}" for name in names)]
            if node.module in _PACKAGES:
                known = homes(node.module)
                found += [known[name] for name in names if name in known]
        elif isinstance(node, ast.Import):
            names = [alias.name for alias in node.names]
            for package in _PACKAGES.intersection(names):  # any of its names may be used
                found += homes(package).values()
            found += names
    return tuple(found)


@functools.cache
def sources(code: str, root: Path = ROOT) -> list[str]:
    """List the files of the lube package that some Python code depends on.

    Parameters
    ----------
    code : str
        Python.
    root : Path, optional
        Folder that the package lies in.

    Returns
    -------
    list of str
        Paths relative to `root`, sorted: the modules, a style of figures beside one of the same
        name, and the CSV tables and templates in their folders, such as
        ``lube/schema/variables.csv``. Two modules are left out, with what only
        they import: the study, whose values are parameters of the rules, and the package's
        ``__init__``, which computes nothing.

    Examples
    --------
    >>> sources("from lube.errors import LubeError")
    ['lube/errors.py']
    """
    found, waiting = set(), list(imported_modules(code))
    while waiting:
        file = _file_of(waiting.pop(), root)
        if file is not None and file not in found:
            found.add(file)
            waiting += _imports_of(file)
    data = ("*.csv", "templates/*")
    found |= {
        path
        for file in found
        for pattern in (*data, f"{file.stem}.mplstyle")
        for path in file.parent.glob(pattern)
    }
    return sorted(file.relative_to(root).as_posix() for file in found)


@functools.cache
def _file_of(module, root):
    """File of a module of the package; None for other modules and for those in `_BY_VALUE`."""
    if not module.startswith("lube.") or module in _BY_VALUE:
        return None
    path = root / Path(*module.split("."))
    path = path / "__init__.py" if path.is_dir() else path.with_suffix(".py")
    return path if path.is_file() else None


@functools.cache
def _imports_of(file):
    return imported_modules(file.read_text(encoding="utf-8"))


def stage_sources(stage: str) -> list[str]:
    """List the files of the lube package that the job of a stage depends on.

    Parameters
    ----------
    stage : str
        Its name in `lube.schema.STAGES`.

    Returns
    -------
    list of str
        The files of `sources`, from the working folder.
    """
    return script_sources("stage", f"import lube.stages.{stage}")


def script_sources(name: str, code: str = "") -> list[str]:
    """List the files of the lube package that a script of the workflow depends on.

    Parameters
    ----------
    name : str
        Name of the script in ``workflow/scripts``, or its path below `ROOT`.
    code : str, optional
        Python that the script runs.

    Returns
    -------
    list of str
        The files of `sources`, from the working folder.
    """
    path = ROOT / (name if name.endswith(".py") else f"workflow/scripts/{name}.py")
    return [from_here(file) for file in sources(f"{path.read_text(encoding='utf-8')}\n{code}")]
