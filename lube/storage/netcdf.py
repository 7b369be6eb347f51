"""NetCDF in and out: checked against the schema, compressed, complete or not there at all.

Files carry the values they were computed from, and no clock time: the same study makes the
same bytes.
"""

import contextlib
import logging
from pathlib import Path

import netCDF4  # noqa: F401  (named here because xarray would report its absence late)
import numpy as np
import xarray as xr

from lube.errors import DataError
from lube.schema import check
from lube.storage.files import written_whole
from lube.storage.provenance import check_config, check_origin, global_attributes
from lube.storage.seals import holds, seal

log = logging.getLogger(__name__)


def save(dataset, path, kind, study, inputs=(), compress=True):
    """Save a dataset, refusing one that does not fit its kind.

    The file is written beside its final place, forced to disk, and renamed: a reader finds
    the whole file or none. Its last line is a seal, see `lube.storage.seals`.

    Parameters
    ----------
    dataset : xarray.Dataset
        Result of a stage.
    path : str or Path
        File to write.
    kind : str
        A key of `lube.schema.FILES`.
    study : Study
        The study it belongs to; the values that the result follows from are written along.
    inputs : iterable of str or Path, optional
        Files that the result was made from; their fingerprints are written along.
    compress : bool, optional
        False for files that live for minutes only.

    Raises
    ------
    DataError
        If the dataset does not fit the schema, or the file cannot be written: the folder is
        not writable, the disk is full. An older file at `path` then stays as it was.
    """
    path = Path(path)
    dataset = check(dataset, kind, path).assign_attrs(global_attributes(study, kind, inputs))
    with written_whole(path) as part:
        dataset.to_netcdf(
            part, engine="netcdf4", format="NETCDF4", encoding=_encoding(dataset, compress)
        )
        seal(part)
    log.info("%s: %s", path, ", ".join(f"{n} {name}" for name, n in dataset.sizes.items()))


def load(path, kind, study=None):
    """Load a dataset of a known kind into memory.

    Parameters
    ----------
    path : str or Path
        File to read.
    kind : str
        A key of `lube.schema.FILES`.
    study : Study, optional
        The study that the file must belong to, with all values it follows from; any if not
        given.

    Returns
    -------
    xarray.Dataset
        The data, independent of the file.

    Raises
    ------
    DataError
        If the file is missing, truncated, damaged, not of this kind, or follows from other
        values than the study's; its path is named.
    """
    with opened(path, kind, study, raw=False) as dataset:
        return dataset.load()


@contextlib.contextmanager
def opened(path, kind, study=None, raw=True):
    """Open a dataset of a known kind, whose values are read as they are used.

    Parameters
    ----------
    path, kind, study
        As in `load`.
    raw : bool, optional
        Leave packed heights as whole steps.

    Yields
    ------
    xarray.Dataset
        The data, to be read before the file is closed.

    Raises
    ------
    DataError
        As `load`, also while values are read.
    """
    path = Path(path)
    if not path.is_file():
        raise DataError(f"{path}: no such file, need a {kind} dataset")
    sealed = _seal_of(path)
    with _told_as_damage(path):
        dataset = xr.open_dataset(path, engine="netcdf4", mask_and_scale=not raw)
    with dataset:
        with _told_as_damage(path):
            check(dataset, kind, path)
            check_origin(dataset, path)
            if study is not None:
                check_config(dataset, study, kind, path)
        if sealed:
            yield dataset  # whole, so that what goes wrong from here on is not the file's fault
            return
        log.warning("%s: has no seal, so nobody knows if it is undamaged", path)
        with _told_as_damage(path):
            yield dataset


@contextlib.contextmanager
def _told_as_damage(path):
    """Tell what the NetCDF library and xarray stumble over as damage of a file."""
    try:
        yield
    except (OSError, RuntimeError, ValueError, AttributeError) as error:
        reason = str(error).splitlines()[0] if str(error) else type(error).__name__
        raise DataError(
            f"{path}: not a whole NetCDF file, truncated, damaged or foreign ({reason})"
        ) from error


def _seal_of(path):
    """Whether a file has a seal, which must hold: a damaged file may crash the NetCDF library."""
    try:
        sealed = holds(path)
    except OSError as error:
        raise DataError(f"{path}: cannot be read: {error.strerror}") from None
    if sealed is False:
        raise DataError(
            f"{path}: not a whole NetCDF file, damaged since it was saved (its seal is broken)"
        )
    return sealed


def _encoding(dataset, compress):
    """Storage of every variable: checksummed, in explicit chunks, without fill values."""
    encoding = {}
    for name, variable in dataset.variables.items():
        # CF forbids fill values on coordinates, and no other variable has gaps but those
        # where NaN says so itself.
        encoding[name] = {"_FillValue": None}
        if variable.dtype.kind in "UOT":
            # As characters, like all older software: strings of no fixed length get no checksum.
            encoding[name] |= {"dtype": "S1", "fletcher32": True}
        if variable.dtype.kind in "fib" and variable.ndim > 0:
            encoding[name] |= {
                "zlib": compress,
                "complevel": 4,
                "shuffle": compress,
                "fletcher32": True,
                "chunksizes": _chunks(variable),
            }
    if dataset.get("height") is not None and dataset["height"].dtype.kind == "f":
        encoding["height"] |= {
            "dtype": "int32",
            "scale_factor": dataset.attrs["height_step"],
            "_FillValue": np.iinfo(np.int32).min,
        }
    return encoding


def _chunks(variable):
    """One chunk for a small variable, one a line for roughness lines and traces."""
    if variable.size <= 2**18:
        return variable.shape
    return (1,) * (variable.ndim - 1) + (variable.shape[-1],)
