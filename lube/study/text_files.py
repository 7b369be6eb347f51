"""Read the text files that people write: studies, lubricant records, manifests."""

from pathlib import Path

from ruamel.yaml import YAML
from ruamel.yaml.constructor import SafeConstructor

from lube.types import File


class _Constructor(SafeConstructor):
    """Keeps dates as text, so that a date that does not exist is refused with its key."""


_Constructor.add_constructor("tag:yaml.org,2002:timestamp", SafeConstructor.construct_yaml_str)

_YAML_KINDS = {dict: "a mapping of keys to values", list: "a list of mappings"}


def read_text(path: File, error_type: type) -> str:
    """Read a text file.

    Parameters
    ----------
    path : str or Path
        The file, UTF-8, with or without a byte order mark.
    error_type : type
        The subclass of LubeError to raise.

    Returns
    -------
    str
        Its text.

    Raises
    ------
    LubeError
        Of `error_type`, if the file cannot be read or is not UTF-8 text.
    """
    try:
        return Path(path).read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        reason = getattr(error, "strerror", "it is not UTF-8 text")
        raise error_type(f"{path}: cannot be read: {reason}") from None


def read_yaml(path: File, error_type: type, kind: type = dict) -> dict | list:
    """Read a YAML file (version 1.2) that contains one mapping, or one list.

    Parameters
    ----------
    path : str or Path
        File to read.
    error_type : type
        The subclass of LubeError to raise.
    kind : type, optional
        ``dict`` or ``list``.

    Returns
    -------
    dict or list
        The content, values as YAML gives them, dates as text.

    Raises
    ------
    LubeError
        Of `error_type`, if the file cannot be read, is not YAML, repeats a key or contains
        anything else.
    """
    yaml = YAML(typ="safe", pure=True)
    yaml.Constructor = _Constructor
    text = read_text(path, error_type)
    try:
        content = yaml.load(text)
    except Exception as error:  # not only the library's errors: a tag's value may raise any
        mark = getattr(error, "problem_mark", None)
        line = f" at line {mark.line + 1}" if mark else ""
        # For a repeated key the library also prints both values, however long they are.
        reason = str(getattr(error, "problem", error)).partition(" with value ")[0]
        raise error_type(f"{path}: not valid YAML{line}: {reason}") from None
    if not isinstance(content, kind):
        raise error_type(f"{path}: need {_YAML_KINDS[kind]}, got {type(content).__name__}")
    return content
