"""Files that are there whole or not at all."""

import contextlib
import os
import platform
import re
import secrets
import shutil
from pathlib import Path

from lube.errors import DataError

_TEXTS = (".yaml", ".yml", ".csv", ".tsv", ".txt")
_FULL = 0.5
"""Free space below which a disk is full, whatever the NetCDF library says, MiB."""


@contextlib.contextmanager
def written_whole(path):
    """Write a file beside its final place, force it to disk, and rename it.

    A reader finds the whole file or none; whatever goes wrong, an older file at `path` stays
    as it was and nothing is left beside it. Only a killed process leaves its unfinished
    ``.part`` there, until the next file is written to the same folder. Of two that write one
    file at once, each writes its own, and the last to finish gives it its place.

    Parameters
    ----------
    path : str or Path
        File to write; its folder is made if need be.

    Yields
    ------
    Path
        Where to write instead.

    Raises
    ------
    DataError
        If the file cannot be written: the folder is not writable, the disk is full.
    """
    path = Path(path)
    part = _part_of(path)
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        _clear_leftovers(path.parent)
        yield part
        _force_to_disk(part)
        os.replace(part, path)
        _force_to_disk(path.parent)
    except (OSError, RuntimeError) as error:  # the NetCDF library raises the latter
        raise DataError(f"{path}: cannot be written: {why_not(error, path)}") from error
    finally:
        with contextlib.suppress(OSError):
            part.unlink(missing_ok=True)


@contextlib.contextmanager
def scratch_beside(path):
    """Make a folder beside the place of another, for a while.

    Only a killed process leaves it there, until the next file is written to the same place.

    Parameters
    ----------
    path : str or Path
        The other's place; the folder that it lies in is made if need be.

    Yields
    ------
    Path
        The folder, empty.
    """
    path = Path(path)
    part = _part_of(path)
    path.parent.mkdir(parents=True, exist_ok=True)
    _clear_leftovers(path.parent)
    part.mkdir()
    try:
        yield part
    finally:
        shutil.rmtree(part, ignore_errors=True)


def _part_of(path):
    """Name of what is not finished: it tells who works at it."""
    return path.with_name(f"{path.name}.{secrets.token_hex(4)}.{os.getpid()}@{_HERE}.part")


def _this_machine():
    """Name of this machine, and of the container if processes are numbered anew in it."""
    try:
        numbering = f"-{os.stat('/proc/self/ns/pid').st_ino}"
    except OSError:
        numbering = ""
    return re.sub(r"\W", "-", platform.node()) + numbering


_HERE = _this_machine()
_OURS = re.compile(rf".*\.(\d+)@{_HERE}\.part")


def _clear_leftovers(folder):
    """Remove what killed writers left; of those on other machines nobody knows if they live."""
    for part in folder.glob("*.part"):
        writer = _OURS.fullmatch(part.name)
        if writer and not is_running(int(writer[1])):
            with contextlib.suppress(OSError):
                shutil.rmtree(part) if part.is_dir() else part.unlink()


def is_running(process):
    """Tell whether a process of this machine still runs, given its number."""
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return False
    except OSError:  # another user's
        return True
    return True


def _force_to_disk(path):
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


def check_writable(folder):
    """Refuse a folder in which nothing can be written.

    Parameters
    ----------
    folder : str or Path
        The folder; if it is not there, the nearest one above counts.

    Raises
    ------
    DataError
        If it cannot be written.
    """
    existing = next(path for path in (Path(folder), *Path(folder).parents) if path.exists())
    if not os.access(existing, os.W_OK):
        raise DataError(f"{folder}: cannot be written: the folder {existing} is not writable")


def cut_within_a_line(path):
    """Tell whether a file of text ends within a line, as one that is cut short mostly does.

    Parameters
    ----------
    path : str or Path
        The file; all but tables and YAML are passed over.

    Returns
    -------
    bool
        True if it is text whose last line has no end.
    """
    if Path(path).suffix.lower() not in _TEXTS or os.path.getsize(path) == 0:
        return False
    with open(path, "rb") as file:
        file.seek(-1, os.SEEK_END)
        return file.read() != b"\n"


def why_not(error, path):
    """Tell the reason of a failed write; the NetCDF library keeps quiet about a full disk.

    Parameters
    ----------
    error : Exception
        What the write ended with.
    path : Path
        The file that was to be written.

    Returns
    -------
    str
        The reason, one line.
    """
    folder = next(folder for folder in Path(path).parents if folder.exists())
    if not os.access(folder, os.W_OK):
        return f"the folder {folder} is not writable"
    free = shutil.disk_usage(folder).free / 2**20
    reason = getattr(error, "strerror", None) or str(error)
    if free < _FULL:
        reason = "No space left on device"
    return f"{reason} ({free:.0f} MiB are free on its disk)"
