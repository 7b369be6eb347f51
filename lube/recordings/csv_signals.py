"""Recordings in CSV files of any length, parsed by PyArrow in pieces of whole lines."""

import os
import re
from collections import deque
from collections.abc import Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import suppress
from dataclasses import dataclass
from itertools import islice, pairwise
from pathlib import Path

import numpy as np
import pyarrow
import pyarrow.csv

from lube.errors import DataError, shown
from lube.recordings.signals import Channel, Signal, find_signals, header_cell
from lube.study.small_csv import delimiter_of, split_cells

_NUMBER = re.compile(r"[+-]?([.,]?\d|nan\b|inf\b)", re.IGNORECASE)  # the beginning of a number

MOST_LINES = 200
"""Number of first lines that are searched for the line of column names."""

PIECE_BYTES = 2**20
"""Bytes parsed at a time on each core; the first of these pieces shows if decimals have commas."""


@dataclass(frozen=True)
class TextSignal:
    """A voltage or resistance in a CSV file, and its time if the file has it.

    Attributes
    ----------
    path : Path
        The file.
    header_line : int
        Number of the line of column names.
    begin : int
        Byte at which the first row begins.
    delimiter : str
        Character between columns.
    decimal_point : str
        Decimal separator, ``.`` or ``,``.
    width : int
        Number of columns.
    signals : list of Signal
        The time, if the file has it, and the voltage or resistance.
    """

    path: Path
    header_line: int
    begin: int
    delimiter: str
    decimal_point: str
    width: int
    signals: list[Signal]

    # A CSV file can state its sampling interval by a column of times only.
    sampling_interval = None

    def parts(self) -> Iterator[list[np.ndarray]]:
        """Read the recording, on all cores.

        Yields
        ------
        list of numpy.ndarray
            Values of each of the signals, s, V or ohm, at the next samples.

        Raises
        ------
        DataError
            At the first line that is not a row of numbers.
        """
        rows = 0
        try:
            for table in _on_all_cores(self._parsed, self._pieces()):
                rows += table.num_rows
                if table.num_rows:
                    columns = zip(self.signals, table.columns, strict=True)
                    yield [signal.converted(column.to_numpy()) for signal, column in columns]
        except pyarrow.ArrowInvalid as error:
            raise DataError(f"{self.path}: {self._refusal(str(error), rows)}") from None

    def where(self, sample: int) -> str:
        """Line of a sample, counted from 0, in the file."""
        return f"line {self._row(sample)[0]}"

    def may_begin_with(self, row: str) -> bool:
        """Whether a line has as many cells as columns, with numbers in those that are read."""
        cells = split_cells(row, self.delimiter)
        numbers = (_NUMBER.match(cells[signal.index]) for signal in self.signals)
        return len(cells) == self.width and all(numbers)

    def _pieces(self):
        """Text of the rows, in pieces of whole lines."""
        with open(self.path, "rb") as file:
            file.seek(self.begin)
            while text := file.read(PIECE_BYTES):
                whole_lines = text.rfind(b"\n") + 1 or len(text)
                file.seek(whole_lines - len(text), os.SEEK_CUR)
                yield pyarrow.py_buffer(text).slice(0, whole_lines)

    def _parsed(self, text):
        names = [str(index) for index in range(self.width)]
        used = [str(signal.index) for signal in self.signals]
        return pyarrow.csv.read_csv(
            text,
            # Only on a single core does PyArrow say which row is wrong.
            pyarrow.csv.ReadOptions(use_threads=False, block_size=text.size, column_names=names),
            pyarrow.csv.ParseOptions(delimiter=self.delimiter),
            pyarrow.csv.ConvertOptions(
                include_columns=used,
                column_types=dict.fromkeys(used, pyarrow.float64()),
                null_values=[],
                decimal_point=self.decimal_point,
            ),
        )

    def _refusal(self, reason, rows_before):
        """Say which line is not a row of numbers, given PyArrow's reason."""
        wrong = re.search(r"Row #(\d+)", reason)
        if wrong is None:
            return f"not a table of numbers, truncated or damaged ({reason})"
        number, line = self._row(rows_before + int(wrong[1]) - 1)
        quantities = " and ".join(signal.quantity for signal in self.signals)
        commas = " with decimal commas" if self.decimal_point == "," else ""
        needed = f"need {self.width} values, numbers{commas} for {quantities}"
        return f"line {number}: got {shown(line)}, {needed}"

    def _row(self, row):
        """Line number and text of a row; empty lines are not rows."""
        # Python and PyArrow recognise the same ends of a line.
        with open(self.path, encoding="utf-8-sig", errors="replace") as file:
            lines = ((number, line.rstrip("\n")) for number, line in enumerate(file, start=1))
            rows = (line for line in islice(lines, self.header_line, None) if line[1])
            return next(islice(rows, row, None))


def _on_all_cores(function, items):
    """Yield the results of a function in order, computing some of them ahead."""
    cores, items = pyarrow.cpu_count(), iter(items)
    with ThreadPoolExecutor(cores) as pool:
        ahead = deque(pool.submit(function, item) for item in islice(items, cores + 1))
        while ahead:
            yield ahead.popleft().result()
            ahead.extend(pool.submit(function, item) for item in islice(items, 1))


def open_text(
    path: Path, channel: str | None = None, unit: str | None = None, skip: int | None = None
) -> TextSignal:
    """Find the recording in a CSV file.

    Empty lines and lines that begin with ``#`` may precede the line of column names. If other lines
    precede it, it is the first line that names a voltage or resistance with its unit and stands
    right above a row of as many values. Columns are separated by tabs, semicolons or commas; with
    tabs or semicolons, numbers may have decimal commas.

    Parameters
    ----------
    path : Path
        The file; lines that are not UTF-8 text are read as Windows-1252 (or Latin-1).
    channel : str, optional
        Name of the column to read, or its whole header.
    unit : str, optional
        Its unit; overrides the one in the file.
    skip : int, optional
        Number of lines before the line of column names; without it the line is searched for.

    Returns
    -------
    TextSignal
        The recording, not read yet.

    Raises
    ------
    DataError
        If there is no line of column names, or `lube.recordings.signals.find_signals` refuses it.
    """
    lines = _first_lines(path, skip or 0)

    def names_columns(line, row, name):
        with suppress(DataError):
            return _table(path, *line, name, unit).may_begin_with(row)

    following = list(pairwise(lines)) if skip is None else []
    for name in (channel, None):  # a message about a wrong channel is about the same line
        for line, (_, row, _) in following:
            if names_columns(line, row, name):
                return _table(path, *line, channel, unit)
    return _table(path, *lines[0], channel, unit)


def _first_lines(path, skip):
    """List number, text and end of the first lines that are neither empty nor comments."""
    found, end = [], 0
    with open(path, "rb") as file:
        for number, line in enumerate(islice(file, skip + MOST_LINES), start=1):
            end += len(line)
            try:
                text = line.decode("utf-8-sig").strip()
            except UnicodeDecodeError:
                text = line.decode("cp1252", "replace").strip()
            if number > skip and text and not text.startswith("#"):
                found.append((number, text, end))
    if not found:
        raise DataError(f"{path}: empty, need a line of column names and rows of numbers")
    return found


def _table(path, number, header, begin, channel, unit):
    """Find the recording below a line of column names."""
    # In a single column, a comma can only be a decimal comma.
    delimiter = delimiter_of(header) if "," in header else delimiter_of(header + ";")
    cells = split_cells(header, delimiter)
    columns = [Channel(*header_cell(cell), full_name=cell) for cell in cells]
    signals = find_signals(columns, f"{path}: line {number}", channel, unit)
    with open(path, "rb") as file:
        file.seek(begin)
        point = "," if delimiter != "," and b"," in file.read(PIECE_BYTES) else "."
    return TextSignal(path, number, begin, delimiter, point, len(cells), signals)
