"""Cells and column names of CSV files."""

import pytest

from lube.study.small_csv import HEADER_CELL, delimiter_of, split_cells


@pytest.mark.parametrize(
    ("line", "cells"),
    [
        ("a, b ,c", ["a", "b", "c"]),
        ('"a,b", c', ["a,b", "c"]),
        ("", []),
        ("a\rb,c", ["a\rb,c"]),
        ("x" * 200_000 + ",c", ["x" * 200_000 + ",c"]),
    ],
    ids=["plain", "quoted", "empty", "carriage return", "long"],
)
def test_cells_of_a_line_that_cannot_be_parted_are_one(line, cells):
    assert split_cells(line, ",") == cells


@pytest.mark.parametrize(
    ("header", "sign"), [("a;b", ";"), ("a\tb;c", "\t"), ("a,b", ","), ("a", ",")]
)
def test_the_first_delimiter_found_counts(header, sign):
    assert delimiter_of(header) == sign


@pytest.mark.parametrize(
    ("cell", "parts"),
    [
        ("force [N]", ("force", "N")),
        ("force[ kN ]", ("force", "kN")),
        ("speed [1 / s]", ("speed", "1 / s")),
        ("force []", None),
        ("force [ ]", None),
        ("force [N", None),
        ("force [" + " " * 100_000, None),
        ("force [" + "N " * 100_000, None),
    ],
    ids=["plain", "blanks", "blanks within", "none", "blank", "open", "long blank", "long open"],
)
def test_a_column_has_a_name_and_a_unit(cell, parts):
    match = HEADER_CELL.fullmatch(cell)
    assert (match and match.groups()) == parts
