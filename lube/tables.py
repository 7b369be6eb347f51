"""Small CSV files that people write: lines, columns with units, decimal commas."""

import csv
import re
from pathlib import Path

HEADER_CELL = re.compile(r"(\w+)\s*\[\s*([^\]]+?)\s*\]")
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
    try:
        text = Path(path).read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        reason = getattr(error, "strerror", None) or "it is not UTF-8 text"
        raise error_type(f"{path}: cannot be read: {reason}") from None
    numbered = enumerate(text.splitlines(), start=1)
    return [
        (number, line)
        for number, line in numbered
        if line.strip() and not line.lstrip().startswith("#")
    ]


def delimiter_of(header):
    """Return what parts the columns: a tab, a semicolon or else a comma, the first found."""
    return next((sign for sign in "\t;" if sign in header), ",")


def split_cells(line, delimiter):
    """Cells of a line, without the blanks and quotes around them.

    Parameters
    ----------
    line : str
        One line of the file.
    delimiter : str
        What parts the cells, one character.

    Returns
    -------
    list of str
        The cells.
    """
    cells = next(csv.reader([line], delimiter=delimiter, skipinitialspace=True), [])
    return [cell.strip() for cell in cells]
