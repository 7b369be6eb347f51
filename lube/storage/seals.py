"""The seal of a file: a last line with the checksum of all bytes before it.

HDF5 checksums the numbers of a dataset and most of its own structures, but not its index of
chunks, nor texts, nor lone numbers: a bit flipped there gives other numbers or labels, or ends
the reader by a segmentation fault. The seal covers every byte, and it is looked at before any
library tries to make sense of the file. Readers of NetCDF and HDF5 do not see it, for it lies
behind the end of what they read; who changes the file with one of them removes it. Anybody can
check it: `head -c -98 film.nc | sha256sum` gives what `tail -n 1 film.nc` says.
"""

import hashlib
import os
import re

_SEAL = b"\nsha256 of all before this line: %b\n"
LENGTH = len(_SEAL % (b"0" * 64))
"""Length of a seal, bytes."""

_BLOCK = 2**20


def seal(path):
    """Add the seal to a file.

    Parameters
    ----------
    path : str or Path
        The file, complete, without a seal.
    """
    with open(path, "r+b") as file:
        digest = _digest(file, os.path.getsize(path))
        file.write(_SEAL % digest)


def holds(path):
    """Tell whether a file is as it was when it was sealed.

    Parameters
    ----------
    path : str or Path
        The file.

    Returns
    -------
    bool or None
        None if it has no seal.
    """
    length = os.path.getsize(path) - LENGTH
    if length < 0:
        return None
    with open(path, "rb") as file:
        digest = _digest(file, length)
        last = file.read()
    if not re.fullmatch(_SEAL % b"[0-9a-f]{64}", last):
        return None
    return last == _SEAL % digest


def _digest(file, length):
    """Checksum, in hexadecimal digits, of the next bytes of a file."""
    checksum = hashlib.sha256()
    while length > 0 and (block := file.read(min(_BLOCK, length))):
        checksum.update(block)
        length -= len(block)
    return checksum.hexdigest().encode()
