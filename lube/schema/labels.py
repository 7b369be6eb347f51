"""Labels written on a dataset, and a dataset held against its labels."""

from lube.errors import DataError
from lube.schema.coordinates import COORDINATES
from lube.schema.kinds import ATTRIBUTES, FILES


def _expected(kind, name):
    return FILES[kind].get(name) or COORDINATES.get(name)


def label(dataset, kind):
    """Write units, long names and flags on a dataset, replacing what arithmetic left there.

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
        if expected is None:
            continue  # to be refused below, by name
        attributes = {"long_name": expected.long_name, **expected.attributes}
        if expected.units is not None:
            attributes["units"] = expected.units
        attributes["coverage_content_type"] = _content(name, expected, labelled)
        labelled[name].attrs = attributes
    return check(labelled, kind)


def _content(name, expected, dataset):
    """ACDD's word for what a variable holds."""
    if name in COORDINATES:
        return "coordinate"
    if expected.content == "record":
        measured = dataset["origin"].item() == "measured"
        return "physicalMeasurement" if measured else "modelResult"
    return expected.content


def check(dataset, kind, where="dataset"):
    """Refuse a dataset whose variables, dimensions, types or units are not the schema's.

    Parameters
    ----------
    dataset : xarray.Dataset
        Dataset to check.
    kind : str
        A key of `lube.schema.FILES`.
    where : str, optional
        What to call the dataset in an error, for instance its path.

    Returns
    -------
    xarray.Dataset
        `dataset` itself.

    Raises
    ------
    DataError
        At the first departure, naming the variable, what it is and what it should be.
    """
    for name in dataset.variables:
        if _expected(kind, name) is None:
            raise DataError(f"{where}: not a {kind} file: variable {name!r} does not belong there")
    for name, expected in FILES[kind].items():
        if name not in dataset.variables:
            raise DataError(f"{where}: not a {kind} file: variable {name!r} is missing")
        _check_variable(dataset[name], name, expected, where)
    for name in dataset.dims:
        if name in COORDINATES and (name in dataset.coords or name != "position"):
            _check_coordinate(dataset, name, where)
    for name in ATTRIBUTES.get(kind, ()):
        if name not in dataset.attrs:
            raise DataError(f"{where}: not a {kind} file: attribute {name!r} is missing")
    return dataset


def _check_coordinate(dataset, name, where):
    if name not in dataset.coords:
        raise DataError(f"{where}: coordinate {name!r} is missing")
    _check_variable(dataset[name], name, COORDINATES[name], where)
    if not dataset.indexes[name].is_unique:
        raise DataError(f"{where}: coordinate {name!r} repeats a value")


def _check_variable(array, name, expected, where):
    if array.dims != expected.dims:
        raise DataError(f"{where}: {name!r} has dimensions {array.dims}, need {expected.dims}")
    kind = {"O": "U", "T": "U", "u": "i"}.get(array.dtype.kind, array.dtype.kind)
    wanted = "i" if expected.kind == "b" and kind == "i" else expected.kind
    if kind != wanted:
        raise DataError(f"{where}: {name!r} holds {array.dtype}, need kind {expected.kind!r}")
    if array.attrs.get("units") != expected.units:
        raise DataError(
            f"{where}: {name!r} is in {array.attrs.get('units')!r}, need {expected.units!r}"
        )
