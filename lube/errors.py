"""The errors a user of the study can cause, each told in one line.

Every message says which input is meant, what came and what is needed.
"""

import reprlib

LONGEST_LINE = 800
"""Characters of the longest message; a longer one loses its middle."""

LONGEST_VALUE = 60
"""Characters of a value in a message, at most."""


class _Shortened(reprlib.Repr):
    """Representation whose cost is bounded, whatever the value: see `shown`."""

    def __init__(self):
        super().__init__()
        self.maxstring = self.maxother = self.maxlong = 2 * LONGEST_VALUE
        self.maxlevel = 3

    def repr_int(self, value, level):
        # Python refuses to write out numbers of thousands of digits.
        if value.bit_length() > 4 * LONGEST_VALUE:
            return f"a whole number of some {round(value.bit_length() * 0.30103)} digits"
        return super().repr_int(value, level)


_shortened = _Shortened()


def shown(value):
    """Tell a value that came, of whatever kind and size, in a few words.

    Parameters
    ----------
    value : object
        The value.

    Returns
    -------
    str
        Its ``repr``, cut off if long.
    """
    text = _shortened.repr(value)
    return text if len(text) <= LONGEST_VALUE else text[: LONGEST_VALUE - 3] + "..."


class LubeError(Exception):
    """Base of all errors that a user can mend.

    Whatever a file or its name held, the message is one line that a terminal shows as it is:
    characters that do not print are told by their escapes.

    Parameters
    ----------
    message : str
        Which input is meant, what came and what is needed.
    """

    def __init__(self, message):
        super().__init__(_one_line(message))


def _one_line(message):
    if len(message) > LONGEST_LINE:
        half = LONGEST_LINE // 2
        message = f"{message[:half]} ... {message[-half:]}"
    if message.isprintable():
        return message
    return "".join(sign if sign.isprintable() else ascii(sign)[1:-1] for sign in message)


class StudyError(LubeError):
    """A study's configuration cannot be carried out as written."""


class RecordError(LubeError):
    """A lubricant record, or the data file it names, cannot be used."""


class DataError(LubeError):
    """A dataset is missing, damaged, foreign, or does not fit its stage."""


class RangeError(LubeError):
    """A value lies outside the range in which a model or property is known."""
