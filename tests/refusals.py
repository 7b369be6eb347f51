"""Try to read a file: it is read, or refused in one line that says what is needed."""

import contextlib
import re
import signal

import pytest

from lube.errors import LubeError

LONGEST_WAIT = 60
"""Seconds after which a case counts as hanging; the slowest takes one on an idle machine."""

NEEDED = re.compile(
    "need|must be|unknown key|missing|not allowed|repeated|"
    "cannot be read|not valid|truncated|empty|no such file|the same operating point"
)
"""Every message contains one of these expressions, which say how to correct the input."""


class Hang(BaseException):
    """A case takes too long. No `except Exception` mistakes it for an error of the file."""


@contextlib.contextmanager
def in_time():
    """Fail instead of waiting for ever."""

    def give_up(*_):
        raise Hang

    before = signal.signal(signal.SIGALRM, give_up)
    signal.alarm(LONGEST_WAIT)
    try:
        yield
    finally:
        signal.alarm(0)
        signal.signal(signal.SIGALRM, before)


def check_line(message):
    """A message is one printable line and says what is needed."""
    assert message.isprintable()
    assert NEEDED.search(message), message


def attempt(read, path, named=None):
    """What is read of a file; None if it is refused in one line that begins with its name.

    Where the fault may lie in a file that it names, `named` is the folder of both.
    """
    with in_time():
        try:
            return read(path)
        except LubeError as error:
            check_line(str(error))
            assert str(error).startswith(str(LubeError(str(named or f"{path}: "))))
            return None


def one_line(error, call, *arguments):
    """The line in which a call refuses its arguments, by this kind of error."""
    with pytest.raises(error) as caught:
        call(*arguments)
    message = str(caught.value)
    assert message and "\n" not in message
    return message
