"""Errors are one line that a terminal shows as it is, whatever a file held."""

import pytest

from lube.errors import LONGEST_LINE, LONGEST_VALUE, LubeError, StudyError, shown


@pytest.mark.parametrize(
    ("message", "told"),
    [
        ("x.yaml: name: got 'Ω', need text", "x.yaml: name: got 'Ω', need text"),
        ("two\nlines\r\n", r"two\nlines\r\n"),
        ("\x1b[31mred\x07", r"\x1b[31mred\x07"),
        ("half a \ud800", r"half a \ud800"),
        ("turned \u202e round \u2028", r"turned \u202e round \u2028"),
    ],
)
def test_what_does_not_print_is_told_by_its_escape(message, told):
    assert str(StudyError(message)) == told
    assert str(LubeError(str(StudyError(message)))) == told


def test_a_long_line_loses_its_middle():
    told = str(LubeError("file: " + "x" * 10**6 + ", need less"))
    assert told.startswith("file: xxx")
    assert told.endswith("xxx, need less")
    assert len(told) == LONGEST_LINE + len(" ... ")


def nested(depth):
    """Lists in lists, ten times as many with each level: no memory holds their `repr`."""
    value = "lol"
    for _ in range(depth):
        value = [value] * 10
    return value


@pytest.mark.parametrize("value", [3, 2.5, True, None, "mm", [1, 2], {"a": 1}, (0, "x"), b"x"])
def test_a_small_value_is_told_as_python_writes_it(value):
    assert shown(value) == repr(value)


@pytest.mark.parametrize(
    "value", ["x" * 10**6, [0] * 10**6, nested(30), {"a": nested(30)}, set(range(99))]
)
def test_a_large_value_is_cut_off(value):
    assert len(shown(value)) <= LONGEST_VALUE


def test_a_number_too_long_for_python_to_write_is_told_by_its_digits():
    assert shown(16**6000) == "a whole number of some 7225 digits"
    assert shown([-(10**5000)]) == "[a whole number of some 5000 digits]"


def test_a_list_that_holds_itself_is_told():
    ring = []
    ring.append(ring)
    assert shown(ring) == "[[[[...]]]]"
