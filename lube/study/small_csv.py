"""Small CSV files that people write: lines, columns with units, decimal commas."""

import csv
import re

from lube.study.texts import read_text

HEADER_CELL = re.compile(r"(\w+)\s*\[\s*([^\]\s](?:[^\]]*[^\]\s])?)\s*\]")
"""A column's name and unit: ``temperature [degC]``."""


def numbered_lines(path, error_type):
    """Lines of a text file that hold something, with their numbers in the file.

    Parameters
    ----------
    path : str or Path
        The file, UTF-8 text; lines that begin with ``#`` are passed over.
    error_type : type
        The child of LubeError to raise.

    Returns
    -------
    list of tuple
        Number, from 1 on, and text of each line.

    Raises
    ------
    LubeError
        Of `error_type`, if the file cannot be read or is not UTF-8 text.
    """
    numbered = enumerate(read_text(path, error_type).splitlines(), start=1)
    return [
        (number, line)
        for number, line in numbered
        if line.strip() and not line.lstrip().startswith("#")
    ]


def delimiter_of(header):
    """Return what parts the columns: a tab, a semicolon or else a comma, the first found."""
    return next((sign for sign in "\t;" if sign in header), ",")


def split_cells(line, delimiter, blanks=None):
    """Cells of a line, without the blanks and quotes around them.

    Parameters
    ----------
    line : str
        One line of the file.
    delimiter : str
        What parts the cells, one character.
    blanks : str, optional
        Characters that are blanks; else all that Unicode calls so.

    Returns
    -------
    list of str
        The cells.
    """
    try:
        cells = next(csv.reader([line], delimiter=delimiter, skipinitialspace=True), [])
    except csv.Error:  # at a carriage return within the line, or a cell of 100 000 characters
        cells = [line]
    return [cell.strip(blanks) for cell in cells]
