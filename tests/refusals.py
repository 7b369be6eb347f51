"""How a file of whatever kind is tried: it is read, or refused in one line, and soon."""

import contextlib
import re
import signal

import pytest

from lube.errors import LONGEST_LINE, LubeError

LONGEST_WAIT = 60
"""Seconds after which a case hangs; the slowest takes one, on a busy machine some more."""

NEEDED = re.compile(
    "need|must be|unknown key|missing|not allowed|repeated|"
    "cannot be read|not valid|truncated|empty|no such file|the same operating point"
)
"""One of these words tells what to do about a mistake."""


class Hang(BaseException):
    """A case takes too long. No `except Exception` takes it for an error of the file."""


@contextlib.contextmanager
def in_time():
    """Fail rather than wait for ever."""

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
    """A message is one line, fit for any terminal, and says what is needed."""
    assert message.isprintable()
    assert len(message) < LONGEST_LINE + 10
    assert NEEDED.search(message), message


def attempt(read, path, named=None):
    """What is read of a file; None if it is refused in one line that begins with its name.

    Where a file that it names may be the wrong one, `named` is the folder of both.
    """
    with in_time():
        try:
            return read(path)
        except LubeError as error:
            check_line(str(error))
            assert str(error).startswith(str(LubeError(str(named or f"{path}: ")))[:300])
            return None


def one_line(error, call, *arguments):
    """The line in which a call refuses its arguments, by this kind of error."""
    with pytest.raises(error) as caught:
        call(*arguments)
    message = str(caught.value)
    assert message and "\n" not in message
    return message
