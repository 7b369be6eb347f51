"""Errors that a user of the study can cause and correct. Each message is one line.

Every message says which input is meant, what came and what is needed.
"""

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


class StudyError(LubeError):
    """A study cannot be carried out as it is written."""


class RecordError(LubeError):
    """A lubricant record, or the data file it names, cannot be used."""


class DataError(LubeError):
    """A dataset, recording or list of records is missing, damaged, or not the one needed."""


class RangeError(LubeError):
    """A value lies outside the range in which a model or property is valid."""
