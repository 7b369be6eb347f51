"""Names that are imported on first use, so that importing their package takes no time."""

import ast
import functools
import importlib
from collections.abc import Callable
from pathlib import Path


@functools.cache
def homes(package: str) -> dict[str, str]:
    """Map the names that a package offers to the modules that define them.

    Parameters
    ----------
    package : str
        ``lube``, or one of its packages whose folder has an ``__init__.pyi``.

    Returns
    -------
    dict of str to str
        Module of each name, from the imports in that file. Editors and type checkers read the same
        file.

    Examples
    --------
    >>> homes("lube")["Oil"]
    'lube.calculator.oil'
    """
    stub = Path(__file__).parents[1].joinpath(*package.split("."), "__init__.pyi")
    return {
        alias.name: node.module
        for node in ast.parse(stub.read_text(encoding="utf-8")).body
        if isinstance(node, ast.ImportFrom) and node.module.startswith("lube.")
        for alias in node.names
    }


def attach(package: str, *modules: str) -> tuple[Callable[[str], object], Callable[[], list[str]]]:
    """Return ``__getattr__`` and ``__dir__`` for a package whose names are imported on first use.

    Parameters
    ----------
    package : str
        As in `homes`.
    *modules : str
        Modules of the package that are imported on first use, too.

    Returns
    -------
    getter, lister : callable
        The first raises AttributeError for a name that the package does not have.
    """

    def getter(name):
        if name in modules:
            return importlib.import_module(f"{package}.{name}")
        if name not in homes(package):
            raise AttributeError(f"module {package!r} has no attribute {name!r}")
        return getattr(importlib.import_module(homes(package)[name]), name)

    return getter, lambda: sorted([*homes(package), *modules])
