"""Label a dataset as the schema says, and check it against the schema."""

from __future__ import annotations

from typing import TYPE_CHECKING

from lube.errors import DataError
from lube.schema.tables import ATTRIBUTES, COORDINATES, FILES, Variable
from lube.types import File

if TYPE_CHECKING:  # Snakemake loads the schema at every start, without xarray
    import xarray as xr


def _expected(kind: str, name: str) -> Variable | None:
    return FILES[kind].get(name) or COORDINATES.get(name)


def label(dataset: xr.Dataset, kind: str) -> xr.Dataset:
    """Write units, long names and flags on a dataset, replacing the attributes it has.

    Parameters
    ----------
    dataset : xarray.Dataset
        Result of a stage.
    kind : str
        A key of `lube.schema.FILES`.

    Returns
    -------
    xarray.Dataset
        The same data with the attributes of the schema.

    Raises
    ------
    DataError
        If the dataset does not fit the schema.
    """
    labelled = dataset.copy()
    for name in labelled.variables:
        expected = _expected(kind, name)
        if expected is not None:  # else refused by `check`
            content = expected.content
            if content == "record":
                measured = labelled["origin"].item() == "measured"
                content = "physicalMeasurement" if measured else "modelResult"
            labelled[name].attrs = {**expected.attributes, "coverage_content_type": content}
    return check(labelled, kind)


def check(dataset: xr.Dataset, kind: str, where: File = "dataset") -> xr.Dataset:
    """Refuse a dataset whose variables, dimensions, types or units are not the schema's.

    Parameters
    ----------
    dataset : xarray.Dataset
        Dataset to check.
    kind : str
        A key of `lube.schema.FILES`.
    where : str or Path, optional
        Name of the dataset in error messages, such as its path.

    Returns
    -------
    xarray.Dataset
        `dataset` itself.

    Raises
    ------
    DataError
        At the first difference, with the variable, what was found and what is needed.
    """
    refusal = f"{where}: not a {kind} file"
    for name in dataset.variables:
        if _expected(kind, name) is None:
            raise DataError(f"{refusal}: variable {name!r} does not belong there")
    coordinates = {name: COORDINATES[name] for name in dataset.dims if name in COORDINATES}
    for name, expected in (FILES[kind] | coordinates).items():
        if name in dataset.variables:
            _check_variable(dataset[name], name, expected, where)
        elif not expected.optional:
            raise DataError(f"{refusal}: variable {name!r} is missing")
    for name in coordinates:
        if not dataset.indexes[name].is_unique:
            raise DataError(f"{where}: coordinate {name!r} repeats a value")
    for name in ATTRIBUTES.get(kind, ()):
        if name not in dataset.attrs:
            raise DataError(f"{refusal}: attribute {name!r} is missing")
    return dataset


def _check_variable(array, name, expected, where):
    if array.dims not in (expected.dims, expected.all_dims):
        raise DataError(f"{where}: {name!r} has dimensions {array.dims}, need {expected.dims}")
    kind = {"O": "U", "T": "U", "u": "i"}.get(array.dtype.kind, array.dtype.kind)
    if kind != expected.kind and (kind, expected.kind) != ("i", "b"):
        raise DataError(f"{where}: {name!r} holds {array.dtype}, need kind {expected.kind!r}")
    units = array.attrs.get("units")
    if units != expected.units:
        raise DataError(f"{where}: {name!r} is in {units!r}, need {expected.units!r}")
