"""Errors that a user of the study can cause and correct. Each message is one line.

Every message says which input is meant, what came and what is needed.
"""

import difflib
import re
from collections.abc import Iterable, Iterator
from contextlib import contextmanager

_WORD = re.compile(r"[^\W_]+")

LONGEST_VALUE = 60
"""Longest representation of a value in a message, in characters."""


def shown(value: object) -> str:
    """Represent a value in an error message.

    Parameters
    ----------
    value : object
        The value that came.

    Returns
    -------
    str
        Its ``repr``, cut off if it is long.

    Examples
    --------
    >>> shown("50 mm")
    "'50 mm'"
    """
    text = repr(value)
    return text if len(text) <= LONGEST_VALUE else text[: LONGEST_VALUE - 3] + "..."


def right_one(wrong: object, names: Iterable[str]) -> str:
    """Suggest the known name that was probably meant, or list all known names.

    Parameters
    ----------
    wrong : object
        The unknown name, or what came in its place.
    names : iterable of str
        The known names.

    Returns
    -------
    str
        The end of an error message.

    Examples
    --------
    >>> right_one("moe", ["moes", "grubin"])
    "did you mean 'moes'?"
    """
    names = list(names)
    near = nearest(str(wrong), names)
    return f"did you mean {near!r}?" if near else f"need one of {', '.join(names)}"


def nearest(wrong: str, names: Iterable[str]) -> str | None:
    """Find the known name that was probably meant, by its words or else by its spelling.

    Parameters
    ----------
    wrong : str
        The unknown name.
    names : iterable of str
        The known names.

    Returns
    -------
    str or None
        The name; None if no name is similar.

    Examples
    --------
    >>> nearest("roughness_ra", ["rms_roughness", "ra_roughness"])
    'ra_roughness'
    """
    by_words = {" ".join(sorted(_WORD.findall(name.casefold()))): name for name in names}
    words = " ".join(sorted(_WORD.findall(wrong.casefold())))
    near = difflib.get_close_matches(wrong, by_words.values(), n=1)
    return by_words.get(words) or next(iter(near), None)


class LubeError(Exception):
    """Base class of all errors that a user can correct.

    The message is a single line: line breaks and control characters, which a value from a file
    may contain, are replaced by their escapes.

    Parameters
    ----------
    message : str
        Which input is meant, what came and what is needed.
    """

    def __init__(self, message: str) -> None:
        escaped = (char if char.isprintable() else ascii(char)[1:-1] for char in message)
        super().__init__("".join(escaped))


@contextmanager
def located(where: str = "", kind: type[Exception] | None = None, hint: str = "") -> Iterator[None]:
    """Add to the message of a LubeError what it is about; also usable as a decorator.

    Parameters
    ----------
    where : str, optional
        File, key or name, put before the message.
    kind : type, optional
        Type of the new error, by default that of the old one; ``ValueError`` for pydantic, which
        collects errors of this type only.
    hint : str, optional
        Text to add after the message.

    Raises
    ------
    Exception
        An error of this type, in place of the LubeError.

    Examples
    --------
    >>> with located("oil.yaml"):
    ...     raise RecordError("no density")
    Traceback (most recent call last):
    lube.errors.RecordError: oil.yaml: no density
    """
    try:
        yield
    except LubeError as error:
        message = f"{where}: {error}{hint}".removeprefix(": ")
        raise (kind or type(error))(message) from None


class StudyError(LubeError):
    """A study cannot be carried out as it is written."""


class RecordError(LubeError):
    """A lubricant record, or the data file it names, cannot be used."""


class DataError(LubeError):
    """A dataset, recording or list of records is missing, damaged, or not the one needed."""


class RangeError(LubeError):
    """A value lies outside the range in which a model or property is valid."""
