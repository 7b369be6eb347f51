"""Files that are there whole or not at all."""

import contextlib
import os
import shutil
from pathlib import Path

from lube.errors import DataError


@contextlib.contextmanager
def written_whole(path):
    """Write a file beside its final place, force it to disk, and rename it.

    A reader finds the whole file or none; whatever goes wrong, an older file at `path` stays
    as it was and nothing is left beside it.

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
    part = path.with_name(path.name + ".part")
    try:
        path.parent.mkdir(parents=True, exist_ok=True)
        yield part
        _force_to_disk(part)
        os.replace(part, path)
        _force_to_disk(path.parent)
    except (OSError, RuntimeError) as error:  # the NetCDF library raises the latter
        raise DataError(f"{path}: cannot be written: {_why_not(error, path)}") from error
    finally:
        with contextlib.suppress(OSError):
            part.unlink(missing_ok=True)


def _force_to_disk(path):
    descriptor = os.open(path, os.O_RDONLY)
    try:
        os.fsync(descriptor)
    finally:
        os.close(descriptor)


def _why_not(error, path):
    """Reason of a failed write; the NetCDF library keeps quiet about a full disk."""
    folder = next(folder for folder in path.parents if folder.exists())
    if not os.access(folder, os.W_OK):
        return f"the folder {folder} is not writable"
    free = shutil.disk_usage(folder).free / 2**20
    reason = getattr(error, "strerror", None) or str(error)
    return f"{reason} ({free:.0f} MiB are free on its disk)"
