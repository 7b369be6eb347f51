"""Write a file beside its final path, then move it there: readers find a complete file or none."""

import contextlib
import glob
import os
import shutil
from collections.abc import Iterator
from pathlib import Path

from lube.errors import DataError
from lube.types import File

_FULL = 0.5
"""Free space below which a disk counts as full, MiB, since the NetCDF library gives no reason."""


@contextlib.contextmanager
def written_whole(path: File) -> Iterator[Path]:
    """Write a file beside its final path and rename it when it is complete.

    Until then an older file at `path` stays as it was. A killed process leaves an unfinished
    ``.part`` file, which the next write of the same file removes.

    Parameters
    ----------
    path : str or Path
        File to write; its folder is created if needed.

    Yields
    ------
    Path
        The temporary path to write to.

    Raises
    ------
    DataError
        If the file cannot be written: the folder is not writable, the disk is full.
    """
    path = Path(path)
    part = path.with_name(f"{path.name}.{os.getpid()}.part")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        for leftover in path.parent.glob(f"{glob.escape(path.name)}.*.part"):
            leftover.unlink()
        yield part
        os.replace(part, path)
    except (OSError, RuntimeError) as error:  # the NetCDF library raises RuntimeError
        raise DataError(f"{path}: cannot be written: {why_not(error, path)}") from error
    finally:
        with contextlib.suppress(OSError):
            part.unlink()


def write_text(path: File, text: str) -> None:
    """Write a text file in UTF-8, by `written_whole`."""
    with written_whole(path) as part:
        part.write_text(text, encoding="utf-8")


def check_writable(folder: File) -> None:
    """Check that files can be created in a folder.

    Parameters
    ----------
    folder : str or Path
        The folder; if it does not exist, its nearest existing parent is checked.

    Raises
    ------
    DataError
        If the folder is not writable.
    """
    existing = _existing(folder)
    if not os.access(existing, os.W_OK):
        raise DataError(f"{folder}: cannot be written: the folder {existing} is not writable")


def why_not(error: Exception, path: File) -> str:
    """Explain in one line why a file could not be written.

    Parameters
    ----------
    error : Exception
        The error that the write raised.
    path : str or Path
        The file.

    Returns
    -------
    str
        The reason, and the free space on the disk.
    """
    free = shutil.disk_usage(_existing(Path(path).parent)).free / 2**20
    full = "No space left on device" if free < _FULL else ""
    reason = full or getattr(error, "strerror", None) or str(error)
    return f"{reason} ({free:.0f} MiB are free on its disk)"


def _existing(folder):
    """Return the folder, or its nearest parent that exists."""
    return next(path for path in (Path(folder), *Path(folder).parents) if path.exists())
