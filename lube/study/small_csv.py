"""Small CSV files that people write: lines, columns with units, decimal commas.

Errors name the line in the file, which pandas does not report, so the lines are split here.
"""

import csv
import re

from lube.errors import shown
from lube.study.text_files import read_text
from lube.types import File

HEADER_CELL = re.compile(r"(\w+)\s*\[\s*([^\]\s](?:[^\]]*[^\]\s])?)\s*\]")
"""A column's name and unit: ``temperature [degC]``."""
_POINTED = re.compile(r"\s*[-+]?\d*\.\d")
"""Beginning of a number with a decimal point."""


def read_cells(path: File, error_type: type) -> list[tuple[int, list[str]]]:
    """Read the cells of a CSV file, whose first line names the columns.

    Parameters
    ----------
    path : str or Path
        The file, UTF-8 text; empty lines and lines that begin with ``#`` are ignored.
    error_type : type
        The subclass of LubeError to raise.

    Returns
    -------
    list of tuple
        Line number in the file, counted from 1, and cells of each line.

    Raises
    ------
    LubeError
        Of `error_type`, if the file cannot be read, is not UTF-8 text or is empty.
    """
    numbered = enumerate(read_text(path, error_type).splitlines(), start=1)
    lines = [(number, line) for number, line in numbered if line.strip() and line.strip()[0] != "#"]
    if not lines:
        raise error_type(f"{path}: empty, need a line of column names and rows of values")
    delimiter = delimiter_of(lines[0][1])
    return [(number, split_cells(line, delimiter)) for number, line in lines]


def with_points(
    path: File, rows: list[tuple[int, list[str]]], columns: int, error_type: type
) -> list[list[str]]:
    """Cells of a file's rows, with decimal commas turned into points.

    Parameters
    ----------
    path : str or Path
        The file, for error messages.
    rows : list of tuple
        From `read_cells`, without the line of the columns' names.
    columns : int
        Number of columns.
    error_type : type
        The subclass of LubeError to raise.

    Returns
    -------
    list of list of str
        The cells of each row.

    Raises
    ------
    LubeError
        Of `error_type`, if a row has more or fewer cells, or a number a point although others have
        decimal commas.
    """
    cells = [[with_point(cell) for cell in row] for _, row in rows]
    has_commas = cells != [row for _, row in rows]
    for line, row in rows:
        where = f"{path}: line {line}"
        if len(row) != columns:
            needed = f"need one for each of {columns} columns"
            raise error_type(f"{where}: got {len(row)} values, {needed}")
        pointed = list(filter(_POINTED.match, row))
        if has_commas and pointed:  # thousands separators, or mistakes
            came = f"got {shown(pointed[0])} in a file with decimal commas"
            raise error_type(f"{where}: {came}, need no point")
    return cells


def units_of(header: list[str]) -> dict[str, str]:
    """Return the unit of each column that has one, by the column's name.

    Examples
    --------
    >>> units_of(["position [mm]", "height [um]", "remark"])
    {'position': 'mm', 'height': 'um'}
    """
    return dict(cell.groups() for cell in map(HEADER_CELL.fullmatch, header) if cell)


def delimiter_of(header: str) -> str:
    """Return the delimiter of the columns: a tab, a semicolon or else a comma, the first found.

    Examples
    --------
    >>> delimiter_of("time [s]; voltage [V]")
    ';'
    """
    return next((char for char in "\t;" if char in header), ",")


def split_cells(line: str, delimiter: str) -> list[str]:
    """Split a line into cells, without the spaces and quotes around them.

    Parameters
    ----------
    line : str
        One line of the file.
    delimiter : str
        Character between cells.

    Returns
    -------
    list of str
        The cells.

    Examples
    --------
    >>> split_cells('40, "n-dodecane"', ",")
    ['40', 'n-dodecane']
    """
    # A carriage return inside a line would end it.
    cells = next(csv.reader([line.replace("\r", " ")], delimiter=delimiter, skipinitialspace=True))
    return [cell.strip() for cell in cells]


def with_point(value: object) -> object:
    """Turn the decimal comma of a text that begins with a number into a point.

    Examples
    --------
    >>> with_point("12,5 mm"), with_point("boost, long"), with_point(3)
    ('12.5 mm', 'boost, long', 3)
    """
    return re.sub(r"^(\s*[+-]?\d*),(?=\d)", r"\1.", value) if isinstance(value, str) else value
