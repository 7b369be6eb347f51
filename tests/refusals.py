"""A file is read, or refused in one line that says what is needed."""

import re

import pytest

from lube.errors import LubeError

NEEDED = re.compile(
    "need|did you mean|must be|unknown key|missing|not allowed|repeated|"
    "cannot be read|not valid|truncated|empty|no such file|the same operating point"
)
"""Every message contains one of these expressions, which say how to correct the input."""


def check_line(message):
    """A message is one printable line and says what is needed."""
    assert message.isprintable()
    assert NEEDED.search(message), message


def attempt(read, path):
    """Read a file; None if it is refused in one line that begins with its name."""
    try:
        return read(path)
    except LubeError as error:
        check_line(str(error))
        assert str(error).startswith(str(LubeError(f"{path}: ")))
        return None


def one_line(error, call, *arguments):
    """The line in which a call refuses its arguments, by this kind of error."""
    with pytest.raises(error) as caught:
        call(*arguments)
    message = str(caught.value)
    assert message and "\n" not in message
    return message
