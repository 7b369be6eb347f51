"""The JSON Schemas that ship with the package, by which editors check what people write."""

import os
from pathlib import Path

from lube.types import File

KINDS = ("study", "lubricant", "manifest")
"""Kinds of files that people write as YAML."""


def schema_file(kind: str) -> Path:
    """Return the file of a JSON Schema.

    Parameters
    ----------
    kind : str
        One of `KINDS`.

    Returns
    -------
    Path
        The file, in the package.

    Examples
    --------
    >>> schema_file("study").name
    'study.json'
    """
    return Path(__file__).parent / "json" / f"{kind}.json"


def schema_line(kind: str, path: File) -> str:
    """Compose the first line of a YAML file, which names its schema to editors.

    Parameters
    ----------
    kind : str
        One of `KINDS`.
    path : str or Path
        The YAML file.

    Returns
    -------
    str
        A comment, understood by the YAML language server of most editors.
    """
    schema = os.path.relpath(schema_file(kind), Path(path).resolve().parent)
    return f"# yaml-language-server: $schema={Path(schema).as_posix()}"
