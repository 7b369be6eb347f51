"""Save and load NetCDF files: checked against the schema, compressed, with checksums.

Files carry the values they were computed from, and no clock time: the same study gives the same
bytes.
"""

import contextlib
import logging
from collections.abc import Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import netCDF4  # noqa: F401  (so that a missing library shows on import, not at the first file)
import numpy as np
import xarray as xr

from lube.errors import DataError, right_one, shown
from lube.schema import FILES, check
from lube.storage.files import written_whole
from lube.storage.provenance import check_config, global_attributes
from lube.types import File, Files

if TYPE_CHECKING:
    from lube.study.study import Study

log = logging.getLogger(__name__)

_COMPRESSED = {"zlib": True, "complevel": 4, "shuffle": True, "fletcher32": True}


def save(dataset: xr.Dataset, path: File, kind: str, study: "Study", inputs: Files = ()) -> None:
    """Save a dataset after checking it against the schema of its kind.

    Parameters
    ----------
    dataset : xarray.Dataset
        Result of a stage.
    path : str or Path
        File to write.
    kind : str
        A key of `lube.schema.FILES`.
    study : Study
        The study; the values that determine the result are stored in the file's attributes.
    inputs : iterable of str or Path, optional
        Files that the result was made from; their SHA-256 sums are stored, too.

    Raises
    ------
    DataError
        If the dataset does not fit the schema or the file cannot be written. An older file at
        `path` then stays as it was.
    """
    path = Path(path)
    dataset = check(dataset, kind, path).assign_attrs(global_attributes(study, kind, inputs))
    with written_whole(path) as part:
        dataset.to_netcdf(part, engine="netcdf4", format="NETCDF4", encoding=_encoding(dataset))
    log.debug("%s: %s", path, ", ".join(f"{n} {name}" for name, n in dataset.sizes.items()))


@contextlib.contextmanager
def opened(path: File) -> Iterator[xr.Dataset]:
    """Open a NetCDF file; an error of the libraries becomes one line.

    Parameters
    ----------
    path : str or Path
        File to read.

    Yields
    ------
    xarray.Dataset
        Its data, not yet in memory.

    Raises
    ------
    DataError
        If the file is truncated, damaged or of another kind.
    """
    try:
        with xr.open_dataset(path, engine="netcdf4") as dataset:
            yield dataset
    except (OSError, RuntimeError, ValueError, AttributeError) as error:
        reason = (str(error) or type(error).__name__).splitlines()[0]
        raise DataError(
            f"{path}: not a complete NetCDF file, truncated, damaged or of another kind ({reason})"
        ) from error


def load(path: File, kind: str, study: "Study | None" = None) -> xr.Dataset:
    """Load a dataset into memory after checking it against the schema of its kind.

    Parameters
    ----------
    path : str or Path
        File to read.
    kind : str
        A key of `lube.schema.FILES`.
    study : Study, optional
        If given, the file must have been computed from this study's values.

    Returns
    -------
    xarray.Dataset
        The data; the file is closed.

    Raises
    ------
    DataError
        If the file is missing, truncated, damaged, not of this kind, or computed from other
        values than the study's.
    """
    path = Path(path)
    if kind not in FILES:
        raise DataError(f"kind: got {shown(kind)}, {right_one(f'{kind}', FILES)}")
    if not path.is_file():
        came = "a folder" if path.is_dir() else "no such file"
        raise DataError(f"{path}: {came}, need a {kind} dataset")
    with opened(path) as dataset:
        check(dataset, kind, path)
        if study is not None:
            check_config(dataset, study, kind, path)
        return dataset.load()


def _encoding(dataset):
    """Storage of every variable: checksummed, in explicit chunks, without fill values."""
    encoding = {}
    for name, variable in dataset.variables.items():
        # CF forbids fill values on coordinates; elsewhere NaN marks what is missing.
        encoding[name] = {"_FillValue": None}
        if variable.dtype.kind in "UOT":
            # Character arrays: HDF5 cannot checksum strings of variable length.
            encoding[name] |= {"dtype": "S1", "fletcher32": True}
        if variable.dtype.kind in "fib" and variable.ndim > 0:
            # One chunk for a small variable; one per line for roughness lines and traces.
            line = (1,) * (variable.ndim - 1) + variable.shape[-1:]
            chunks = variable.shape if variable.size <= 2**18 else line
            encoding[name] |= {**_COMPRESSED, "chunksizes": chunks}
    if "height" in dataset:  # whole height steps
        step, missing = dataset.attrs["height_step"], np.iinfo(np.int32).min
        encoding["height"] |= {"dtype": "int32", "scale_factor": step, "_FillValue": missing}
    return encoding
