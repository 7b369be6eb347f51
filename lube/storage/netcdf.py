"""Save and load NetCDF files: checked against the schema, compressed, with checksums.

Files carry the values they were computed from, and no clock time: the same study gives the same
bytes.
"""

import contextlib
import logging
from collections.abc import Iterable, Iterator
from pathlib import Path
from typing import TYPE_CHECKING

import netCDF4  # noqa: F401  (if it is missing, say so on import, not when the first file is read)
import numpy as np
import xarray as xr

from lube.errors import DataError
from lube.schema import check
from lube.storage.files import written_whole
from lube.storage.provenance import check_config, global_attributes

if TYPE_CHECKING:
    from lube.study.study import Study

log = logging.getLogger(__name__)


def save(
    dataset: xr.Dataset,
    path: str | Path,
    kind: str,
    study: "Study",
    inputs: Iterable[str | Path] = (),
    compress: bool = True,
) -> None:
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
    compress : bool, optional
        False for temporary files.

    Raises
    ------
    DataError
        If the dataset does not fit the schema or the file cannot be written. An older file at
        `path` then stays as it was.
    """
    path = Path(path)
    dataset = check(dataset, kind, path).assign_attrs(global_attributes(study, kind, inputs))
    encoding = _encoding(dataset, compress)
    with written_whole(path) as part:
        dataset.to_netcdf(part, engine="netcdf4", format="NETCDF4", encoding=encoding)
    log.info("%s: %s", path, ", ".join(f"{n} {name}" for name, n in dataset.sizes.items()))


def load(path: str | Path, kind: str, study: "Study | None" = None) -> xr.Dataset:
    """Load a dataset into memory after checking it against the schema of its kind.

    Parameters
    ----------
    path : str or Path
        File to read.
    kind : str
        A key of `lube.schema.FILES`.
    study : Study, optional
        If given, the file must follow from this study's values.

    Returns
    -------
    xarray.Dataset
        The data; the file is closed.

    Raises
    ------
    DataError
        If the file is missing, truncated, damaged, not of this kind, or follows from other
        values than the study's.
    """
    with opened(path, kind, study, raw=False) as dataset:
        return dataset.load()


@contextlib.contextmanager
def opened(
    path: str | Path, kind: str, study: "Study | None" = None, raw: bool = True
) -> Iterator[xr.Dataset]:
    """Open a dataset whose values are read when they are used.

    Parameters
    ----------
    path, kind, study
        As in `load`.
    raw : bool, optional
        Leave packed heights as whole steps.

    Yields
    ------
    xarray.Dataset
        The data, readable until the file is closed.

    Raises
    ------
    DataError
        As `load`; damaged values are found when they are read.
    """
    path = Path(path)
    if not path.is_file():
        raise DataError(f"{path}: no such file, need a {kind} dataset")
    try:
        dataset = xr.open_dataset(path, engine="netcdf4", mask_and_scale=not raw)
    except (OSError, RuntimeError, ValueError, AttributeError) as error:
        raise _damaged(path, error) from error
    with dataset:
        try:
            check(dataset, kind, path)
            if study is not None:
                check_config(dataset, study, kind, path)
            yield dataset
        except RuntimeError as error:  # the NetCDF library found a wrong checksum
            raise _damaged(path, error) from error


def _damaged(path, error):
    reason = (str(error) or type(error).__name__).splitlines()[0]
    return DataError(f"{path}: not a whole NetCDF file, truncated, damaged or foreign ({reason})")


def _encoding(dataset, compress):
    """Storage of every variable: checksummed, in explicit chunks, without fill values."""
    encoding = {}
    for name, variable in dataset.variables.items():
        # CF forbids fill values on coordinates; elsewhere NaN marks what is missing.
        encoding[name] = {"_FillValue": None}
        if variable.dtype.kind in "UOT":
            # Character arrays: HDF5 cannot checksum strings of variable length.
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
    """One chunk for a small variable; one chunk per line for roughness lines and traces."""
    if variable.size <= 2**18:
        return variable.shape
    return (1,) * (variable.ndim - 1) + (variable.shape[-1],)
