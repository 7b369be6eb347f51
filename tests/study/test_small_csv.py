"""Cells of small CSV files, as people and their editors write them."""

import pytest

from lube.study.small_csv import split_cells


@pytest.mark.parametrize("end", ["", "\r", "\n", "\r\n"])
def test_cells_do_not_depend_on_how_a_line_ends(end):
    assert split_cells(f'40 ; "n-dodecane"{end}', ";") == ["40", "n-dodecane"]


def test_a_carriage_return_inside_a_line_does_not_end_it():
    assert split_cells("0,4.679\r5", ",") == ["0", "4.679 5"]
