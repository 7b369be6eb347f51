"""How long a classic NetCDF file must be, by its own header.

The NetCDF library reads what is missing at the end of a classic file as zeros, in silence; of a
rig's record that would be contact.

References
----------
.. [1] UCAR, NetCDF File Format Specifications: the classic, 64-bit offset and 64-bit data formats.
"""

import math
import struct
from dataclasses import dataclass

_MARK = b"CDF"
_BYTES_OF_TYPE = {1: 1, 2: 1, 3: 2, 4: 4, 5: 4, 6: 8, 7: 1, 8: 2, 9: 4, 10: 8, 11: 8}


def needed_length(path):
    """Tell how many bytes a classic NetCDF file must have.

    Parameters
    ----------
    path : str or Path
        The file.

    Returns
    -------
    int or None
        None if the file is of another format.

    Raises
    ------
    ValueError
        If the file ends within its header.
    """
    with open(path, "rb") as file:
        if file.read(3) != _MARK:
            return None
        header = _Header(file, version=file.read(1)[0])
        try:
            return header.needed_length()
        except (struct.error, KeyError, IndexError):
            raise ValueError("its header is cut short or damaged") from None


@dataclass
class _Header:
    """The header of a classic file, read from its fifth byte on."""

    file: object
    version: int

    def needed_length(self):
        records = self.count()
        dims = self.many(lambda: (self.text(), self.count())[1])
        self.many(self.attribute)
        variables = self.many(lambda: self.variable(dims))
        fixed = [begin + size for begin, size, grows in variables if not grows]
        growing = [(begin, size) for begin, size, grows in variables if grows]
        # Of several variables that grow, each one's part of a record is padded to four bytes.
        step = growing[0][1] if len(growing) == 1 else sum(_padded(size) for _, size in growing)
        ends = [begin + (records - 1) * step + size for begin, size in growing if records]
        return max([self.file.tell(), *fixed, *ends])

    def variable(self, dims):
        """First byte of a variable, its length or that of its part of a record, and which."""
        self.text()
        shape = [dims[self.count()] for _ in range(self.count())]
        self.many(self.attribute)
        item = _BYTES_OF_TYPE[self.number(">i")]
        self.count()  # the length as written, which is limited to 32 bits
        begin = self.number(">i" if self.version == 1 else ">q")
        grows = bool(shape) and shape[0] == 0
        return begin, item * math.prod(shape[1:] if grows else shape), grows

    def attribute(self):
        self.text()
        item = _BYTES_OF_TYPE[self.number(">i")]
        self.skip(item * self.count())

    def many(self, read):
        self.number(">i")  # the kind of what follows
        return [read() for _ in range(self.count())]

    def text(self):
        self.skip(self.count())

    def skip(self, length):
        if len(self.file.read(_padded(length))) < _padded(length):
            raise IndexError(length)

    def count(self):
        return self.number(">q" if self.version == 5 else ">I")

    def number(self, form):
        return struct.unpack(form, self.file.read(struct.calcsize(form)))[0]


def _padded(length):
    return -(-length // 4) * 4
