"""The variables of every file, read from the two tables in this folder.

``variables.csv`` has one row per variable, in the order of the file. Its columns:

=============  ==================================================================================
files          files that hold the variable, separated by spaces; ``any`` for a coordinate that
               means the same in every file that has it
name           name of the variable
dims           its dimensions, in order; none for a scalar; with a question mark if the variable
               has the dimension in files of some studies only
units          unit in UDUNITS notation, ``1`` for a pure number or a flag, none for text
type           ``float``, ``integer``, ``boolean`` (stored as int8) or ``text``; with a question
               mark if only files of some studies have the variable
content        ACDD's ``coverage_content_type``; ``record`` stands for ``physicalMeasurement`` if
               the records are measured and ``modelResult`` if they are simulated
cell_methods   CF attribute: what a mean is over
flag_meanings  CF attribute: the meanings of the values 0, 1, ...
long_name      name of the variable, as on an axis
comment        CF attribute
=============  ==================================================================================

``files.csv`` has one row per file: the global attributes that it must have, separated by spaces,
and a summary of its content. A file without a summary is an intermediate result.
"""

import csv
from collections.abc import Iterable, Mapping
from dataclasses import dataclass, field
from pathlib import Path
from typing import Any

import numpy as np

_FOLDER = Path(__file__).parent
_KINDS = {"float": "f", "integer": "i", "boolean": "b", "text": "U"}


@dataclass(frozen=True)
class Variable:
    """One variable or coordinate of a file.

    Attributes
    ----------
    dims : tuple of str
        Its dimensions in every file, in order.
    units : str or None
        Unit in UDUNITS notation, ``"1"`` for a pure number or a flag, None for text.
    long_name : str
        Name of the variable, as on an axis.
    kind : str
        NumPy's letter of its type: ``f`` float, ``i`` integer, ``b`` boolean (stored as int8),
        ``U`` text.
    content : str
        As in the column ``content``.
    attributes : dict
        Its CF attributes, units and long name among them.
    optional : bool
        Whether a file may lack it.
    all_dims : tuple of str
        Its dimensions, in order, with those that it has in files of some studies only.
    """

    dims: tuple[str, ...]
    units: str | None
    long_name: str
    kind: str
    content: str
    attributes: Mapping[str, Any] = field(default_factory=dict)
    optional: bool = False
    all_dims: tuple[str, ...] = ()


def read_table(path: Path) -> list[dict[str, str]]:
    """Read a table that comes with the package.

    Parameters
    ----------
    path : Path
        CSV file, such as ``variables.csv``.

    Returns
    -------
    list of dict
        Its rows, each from column to text.
    """
    # Spreadsheets may begin a file with a byte order mark.
    with open(path, encoding="utf-8-sig", newline="") as file:
        return list(csv.DictReader(file))


def _variable(row):
    attributes = {"long_name": row["long_name"]}
    if meanings := row["flag_meanings"]:
        attributes["flag_values"] = np.arange(len(meanings.split()), dtype="int8")
    for name in ("flag_meanings", "cell_methods", "comment", "units"):
        if row[name]:
            attributes[name] = row[name]
    dims = row["dims"].split()
    return Variable(
        tuple(dim for dim in dims if not dim.endswith("?")),
        row["units"] or None,
        row["long_name"],
        _KINDS[row["type"].removesuffix("?")],
        row["content"],
        attributes,
        row["type"].endswith("?"),
        tuple(dim.removesuffix("?") for dim in dims),
    )


_FILES = read_table(_FOLDER / "files.csv")
_VARIABLES = {file: {} for file in ("any", *(row["file"] for row in _FILES))}
for _row in read_table(_FOLDER / "variables.csv"):
    for _file in _row["files"].split():
        _VARIABLES[_file][_row["name"]] = _variable(_row)

COORDINATES = _VARIABLES["any"]
"""Coordinates that mean the same in every file that has them, by name."""

FILES = {row["file"]: _VARIABLES[row["file"]] for row in _FILES}
"""Variables of each kind of file, by the kind's name."""

SUMMARIES = {row["file"]: row["summary"] for row in _FILES if row["summary"]}
"""What each kind of file contains, in a sentence or two; intermediate results have no entry."""

ATTRIBUTES = {row["file"]: tuple(row["attributes"].split()) for row in _FILES if row["attributes"]}
"""Required global attributes, by kind of file."""

OPERATING_DIMS = FILES["film"]["film_thickness"].dims
"""Dimensions of a variable over the operating grid that depends on the film formula."""

CONTACT_DIMS = FILES["contact"]["breakthrough_probability_mean"].dims
"""Dimensions of the contact model's results."""

POINT_DIMS = FILES["film"]["moes_load"].dims
"""Dimensions of a variable over the operating grid that does not depend on the film formula."""

EXPERIMENT_DIMS = ("slide_to_roll_ratio", *POINT_DIMS)
"""Operating variables of an experiment."""

AT_RECORDS = tuple(
    "force speed temperature slide_to_roll_ratio lubricant "
    "force_level speed_level temperature_level pair duration".split()
)
"""Variables that describe each record: its conditions, and the study's levels assigned to it."""

LIMITS = ("", "_lower", "_upper")
MEAN_LIMITS = ("_mean", "_lower", "_upper")
"""Suffixes of the variables that hold an estimate and the limits of its 95 % interval."""

REGIMES = tuple(FILES["film"]["regime"].attributes["flag_meanings"].split())
"""Regimes of lubrication, in the order of their flags."""


def values_with_limits(
    name: str,
    values: Iterable[Any],
    dims: str | tuple[str, ...] | None = None,
    names: tuple[str, str, str] = LIMITS,
) -> dict[str, Any]:
    """Name a value and the limits of its interval.

    Parameters
    ----------
    name : str
        Name of the value.
    values : iterable
        Value, lower limit and upper limit.
    dims : str or tuple of str, optional
        Dimensions of the three, to make them variables of a dataset.
    names : tuple of str, optional
        Suffixes of the three names: `LIMITS`, or `MEAN_LIMITS` for a mean.

    Returns
    -------
    dict
        The three by their names.

    Examples
    --------
    >>> values_with_limits("share", [0.5, 0.4, 0.6])
    {'share': 0.5, 'share_lower': 0.4, 'share_upper': 0.6}
    """
    given = values if dims is None else ((dims, value) for value in values)
    return {f"{name}{end}": value for end, value in zip(names, given, strict=True)}


def model_dependent(kind: str) -> list[str]:
    """Names of the variables of a kind of file that may depend on the contact model."""
    return [name for name, row in FILES[kind].items() if "contact_model" in row.all_dims]


def with_dims(kind: str, values: Mapping[str, Any]) -> dict[str, Any]:
    """Give plain arrays the dimensions that they have in a file.

    Parameters
    ----------
    kind : str
        A key of `FILES`.
    values : mapping of str to array_like
        Values of its variables and coordinates by their names.

    Returns
    -------
    dict of str to tuple
        Dimensions and values by name, as `xarray.Dataset` takes them.

    Examples
    --------
    >>> with_dims("tail", {"force": [800.0]})
    {'force': (('force',), [800.0])}
    """
    rows = COORDINATES | FILES[kind]
    return {name: (rows[name].dims, value) for name, value in values.items()}
