"""Cells and column names of CSV files."""

from lube.study.small_csv import HEADER_CELL, delimiter_of, split_cells


def test_a_line_is_split_into_cells():
    long = "x" * 200_000 + ",c"  # no table
    for line, cells in [
        ("a, b ,c", ["a", "b", "c"]),
        ('"a,b", c', ["a,b", "c"]),
        ("", []),
        (long, [long]),
    ]:
        assert split_cells(line, ",") == cells


def test_the_first_delimiter_found_counts():
    for header, sign in [("a;b", ";"), ("a\tb;c", "\t"), ("a,b", ","), ("a", ",")]:
        assert delimiter_of(header) == sign


def test_a_column_has_a_name_and_a_unit():
    for cell, parts in [
        ("force [N]", ("force", "N")),
        ("force[ kN ]", ("force", "kN")),
        ("speed [1 / s]", ("speed", "1 / s")),
        ("force []", None),
        ("force [ ]", None),
        ("force [N", None),
    ]:
        match = HEADER_CELL.fullmatch(cell)
        assert (match and match.groups()) == parts
