"""Small CSV files that people write: lines, columns with units, decimal commas.

Errors name the line in the file, which pandas does not report, so the lines are split here.
"""

import csv
import re
from pathlib import Path

from lube.errors import LubeError
from lube.study.text_files import read_text

HEADER_CELL = re.compile(r"(\w+)\s*\[\s*([^\]\s](?:[^\]]*[^\]\s])?)\s*\]")
"""A column's name and unit: ``temperature [degC]``."""


def numbered_lines(path: str | Path, error_type: type[LubeError]) -> list[tuple[int, str]]:
    """Read the lines of a text file that are neither blank nor a comment.

    Parameters
    ----------
    path : str or Path
        The file, UTF-8 text; lines that begin with ``#`` are comments.
    error_type : type
        The subclass of LubeError to raise.

    Returns
    -------
    list of tuple
        Number in the file, from 1 on, and text of each line.

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


def delimiter_of(header: str) -> str:
    """Return the delimiter of the columns: a tab, a semicolon or else a comma, the first found.

    Examples
    --------
    >>> delimiter_of("time [s]; voltage [V]")
    ';'
    """
    return next((sign for sign in "\t;" if sign in header), ",")


def split_cells(line: str, delimiter: str, blanks: str | None = None) -> list[str]:
    """Split a line into cells, without the blanks and quotes around them.

    Parameters
    ----------
    line : str
        One line of the file.
    delimiter : str
        The character between cells.
    blanks : str, optional
        Characters that count as blanks; else all white space of Unicode.

    Returns
    -------
    list of str
        The cells.

    Examples
    --------
    >>> split_cells('40, "n-dodecane"', ",")
    ['40', 'n-dodecane']
    """
    try:
        cells = next(csv.reader([line], delimiter=delimiter, skipinitialspace=True), [])
    except csv.Error:  # a cell of more than 100 000 characters: no table
        cells = [line]
    return [cell.strip(blanks) for cell in cells]
