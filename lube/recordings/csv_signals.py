"""Records as CSV files of any length, read in blocks of whole lines.

PyArrow parses the blocks, one on each core, so that none waits for another and the record is
evaluated meanwhile. It does not say where it failed: a block that it refuses is gone through
line by line, to name the first that is wrong.
"""

from collections import deque
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass
from functools import partial
from itertools import islice
from pathlib import Path

import pyarrow
import pyarrow.csv

from lube.errors import DataError
from lube.recordings.signals import FIRST_STEPS, Channel, Part, Signal, find_signals, header_cell
from lube.study.small_csv import delimiter_of, split_cells

HEAD_BYTES = 2**20
"""The column names, and a row that tells the decimal sign, come within so many bytes."""

BLOCK_BYTES = 2**22


@dataclass(frozen=True)
class TextSignal:
    """A voltage or resistance in a CSV file, and its time if the file has it.

    Attributes
    ----------
    path : Path
        The file.
    begin : int
        Byte at which the first row begins.
    delimiter, decimal_sign : str
        What parts the columns, and the digits of a number.
    width : int
        Number of columns.
    time : Signal or None
        Column of the time.
    measured : Signal
        Column of the voltage or resistance.
    """

    path: Path
    begin: int
    delimiter: str
    decimal_sign: str
    width: int
    time: Signal | None
    measured: Signal

    # A CSV file has no place for it but a column of times.
    told_interval = None

    def head(self):
        """First samples of the record, a `Part`; None if there are none."""
        with open(self.path, "rb") as file:
            file.seek(self.begin)
            rows = b"".join(islice(file, FIRST_STEPS + 1))
        return None if _is_blank(rows) else self._part(self.begin, rows)

    def parts(self):
        """Read the record, on all cores.

        Yields
        ------
        Part
            The samples of some megabytes of text.

        Raises
        ------
        DataError
            At the first line that is no row of numbers.
        """
        cores, waiting = pyarrow.cpu_count(), deque()
        with ThreadPoolExecutor(cores) as pool:
            for offset, block in self._blocks():
                waiting.append(pool.submit(self._part, offset, block))
                if len(waiting) > cores:  # so many blocks are in memory at most
                    yield waiting.popleft().result()
            while waiting:
                yield waiting.popleft().result()

    def _blocks(self):
        """Offset and text of blocks that end with a line and are not blank."""
        with open(self.path, "rb") as file:
            file.seek(self.begin)
            offset = self.begin
            while block := file.read(BLOCK_BYTES):
                whole_lines = block.rfind(b"\n") + 1
                if whole_lines and len(block) == BLOCK_BYTES:
                    block = memoryview(block)[:whole_lines]
                    file.seek(offset + whole_lines)
                if not _is_blank(block):
                    yield offset, block
                offset += len(block)

    def _part(self, offset, block):
        table = self._parsed(offset, block)
        times = None if self.time is None else self._column(table, self.time)
        place = partial(self._place_of_row, offset, block)
        return Part(self._column(table, self.measured), times, place)

    def _parsed(self, offset, block):
        names = [str(place) for place in range(self.width)]
        used = [str(signal.place) for signal in (self.time, self.measured) if signal is not None]
        try:
            return pyarrow.csv.read_csv(
                pyarrow.BufferReader(pyarrow.py_buffer(block)),
                pyarrow.csv.ReadOptions(
                    use_threads=False, block_size=len(block), column_names=names
                ),
                pyarrow.csv.ParseOptions(delimiter=self.delimiter),
                pyarrow.csv.ConvertOptions(
                    include_columns=used,
                    column_types=dict.fromkeys(used, pyarrow.float64()),
                    null_values=[],
                    decimal_point=self.decimal_sign,
                ),
            )
        except pyarrow.ArrowInvalid as error:
            raise DataError(f"{self.path}: {self._fault(offset, block, error)}") from None

    def _column(self, table, signal):
        return signal.converted(table[str(signal.place)].to_numpy())

    def _place_of_row(self, offset, block, row):
        number, _ = next(islice(self._rows(offset, block), row, None))
        return f"line {number}"

    def _rows(self, offset, block):
        """Yield number in the file, and text, of each line of a block that is not empty."""
        first = _line_number(self.path, offset)
        for number, line in enumerate(bytes(block).split(b"\n"), start=first):
            if line.rstrip(b"\r"):
                yield number, line.rstrip(b"\r").decode(errors="replace")

    def _fault(self, offset, block, error):
        """First line of a block that is no row of numbers, and why."""
        for number, line in self._rows(offset, block):
            # As the reader does, which knows no other digits or blanks than ASCII's.
            cells = split_cells(line, self.delimiter, blanks=" \t")
            if len(cells) != self.width:
                return f"line {number}: got {len(cells)} values, need {self.width}"
            for signal in filter(None, (self.time, self.measured)):
                if not self._is_number(cells[signal.place]):
                    needed = "a number" + " with a decimal comma" * (self.decimal_sign == ",")
                    came = cells[signal.place][:40]
                    return f"line {number}: got {came!r} as {signal.quantity}, need {needed}"
        first = _line_number(self.path, offset)
        found = str(error).splitlines()[0]
        return f"lines from {first} on: got what is no row ({found}), need a table of numbers"

    def _is_number(self, cell):
        if self.decimal_sign == "," and "." in cell:
            return False
        try:
            pyarrow.scalar(cell.replace(self.decimal_sign, ".")).cast("float64")
        except pyarrow.ArrowInvalid:
            return False
        return True


def _is_blank(block):
    # Only where the beginning is blank is it worth a copy of the whole.
    return not bytes(block[:64]).strip() and not bytes(block).strip()


def _line_number(path, offset):
    """Count the lines up to the byte at which one begins, itself included."""
    number = 1
    with open(path, "rb") as file:
        while file.tell() < offset:
            number += file.read(min(BLOCK_BYTES, offset - file.tell())).count(b"\n")
    return number


def open_text(path, channel=None, unit=None):
    """Read the head of a CSV file: where rows begin, and which columns matter.

    Lines that are empty or begin with ``#`` may stand before the one of column names. Columns
    are parted by tabs, semicolons or commas; where not by commas, numbers may have decimal
    commas.

    Parameters
    ----------
    path : Path
        The file, UTF-8 text.
    channel : str, optional
        Name of the record's column, or the whole head of it.
    unit : str, optional
        Its unit, in place of what the file states.

    Returns
    -------
    TextSignal
        The record, not read yet.

    Raises
    ------
    DataError
        If it has no line of column names, or `lube.recordings.signals.find_signals` refuses those.
    """
    with open(path, "rb") as file:
        number, header = _header_line(file, path)
        begin = file.tell()
        rows = file.read(HEAD_BYTES)
    # A comma in a lone column is a decimal one.
    delimiter = delimiter_of(header) if "," in header else delimiter_of(header + ";")
    cells = split_cells(header, delimiter)
    columns = [Channel(*header_cell(cell), full_name=cell) for cell in cells]
    time, measured = find_signals(columns, f"{path}: line {number}", channel, unit)
    sign = "," if delimiter != "," and b"," in rows else "."
    return TextSignal(path, begin, delimiter, sign, len(cells), time, measured)


def _header_line(file, path):
    for number, line in enumerate(iter(lambda: file.readline(HEAD_BYTES), b""), start=1):
        try:
            text = line.decode("utf-8-sig").strip()
        except UnicodeDecodeError:
            raise DataError(f"{path}: line {number}: need UTF-8 text") from None
        if text and not text.startswith("#"):
            return number, text
    raise DataError(f"{path}: empty record, need a line of column names and rows of numbers")
