"""The manifest of an experiment: which record, or which share, belongs to which operating point.

A manifest is a CSV file with units in its column names, or a YAML list of mappings whose values
carry theirs. A row that cannot be used is told, and does not hide the others.
"""

import os
import re
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Literal

from pydantic import Field, StringConstraints, model_validator

from lube.errors import DataError, LubeError, shown
from lube.schema import ORIGINS
from lube.study.field_types import (
    StrictModel,
    checked_text,
    pure_number,
    quantity,
    validate,
)
from lube.study.small_csv import HEADER_CELL, delimiter_of, numbered_lines, split_cells
from lube.study.text_files import read_yaml
from lube.units import convert, electrical_quantity, parse_electrical

Text = Annotated[str, StringConstraints(strip_whitespace=True, min_length=1)]
Share = pure_number(least=0.0, most=1.0)

_UNITS = {
    "force": "N",
    "speed": "rpm",
    "temperature": "degC",
    "force_tolerance": "N",
    "speed_tolerance": "rpm",
    "temperature_tolerance": "K",
    "sampling_interval": "s",
    "offset": "mV",
}
"""A unit for each column that needs one; the offset of a resistance has one of resistance."""

_TEXTS = ("file", "channel", "unit", "lubricant", "pair", "origin")
_OF_FILES = ("channel", "unit", "gain", "offset", "sampling_interval")
_OF_SHARES = ("lower", "upper")


class _Row(StrictModel):
    """A row as it is written: an operating point, and its record or its share."""

    file: Text | None = Field(
        None, description="the record, relative to the manifest's folder; this or `probability`"
    )
    channel: Text | None = Field(
        None,
        description="which column, variable or channel of the file, its name without the unit; in "
        "TDMS also `group/channel`; else the first voltage or resistance",
    )
    unit: checked_text(electrical_quantity, "unit of voltage or resistance") | None = Field(
        None,
        description="unit of that channel, where the file states none; it is believed even if the "
        "file states another; where the channel's name does not say voltage or resistance, it does",
    )
    gain: pure_number(other_than=0.0) = Field(
        1.0,
        description="factor of an amplifier between rig and recorder, below 0 if it inverts: "
        "recorded = gain × true + offset",
    )
    offset: checked_text(parse_electrical, "quantity in V or ohm, as the record is") = Field(
        0.0,
        description="what is recorded when the true value is 0, in the channel's own quantity; "
        "subtracted before the gain is divided out: true = (recorded - offset) / gain",
    )
    sampling_interval: quantity("s", above=0.0) | None = Field(
        None, description="time between samples, for a file that does not tell it"
    )
    probability: Share | None = Field(
        None, description="share of time in contact that you evaluated yourself, in place of `file`"
    )
    lower: Share | None = Field(None, description="lower limit of that share")
    upper: Share | None = Field(None, description="upper limit of that share")
    force: quantity("N", above=0.0) = Field(description="normal force")
    speed: quantity("rpm", above=0.0) = Field(
        description="rotation speed, as in the study; `1/min` and `Hz` count turns"
    )
    temperature: quantity("degC", above=-273.15) = Field(description="of rollers and oil")
    force_tolerance: quantity("N", above=0.0) | None = Field(
        None, description="how far the true force may be from the one stated"
    )
    speed_tolerance: quantity("rpm", above=0.0) | None = Field(
        None, description="how far the true speed may be from the one stated"
    )
    temperature_tolerance: quantity("K", above=0.0) | None = Field(
        None,
        description="how far the true temperature may be from the one stated; 1 degC is 1 K here",
    )
    lubricant: Text | None = Field(None, description="a lubricant of the study; else its first")
    slide_to_roll_ratio: pure_number(least=-2.0, most=2.0) | None = Field(
        None, description="a ratio of the study; else 0, or the study's first if 0 is none of them"
    )
    pair: Text | None = Field(
        None,
        description="label of the pair of rollers that was measured; records without it are all of "
        "one pair",
    )
    origin: Literal[ORIGINS] = Field(
        ORIGINS[0], description="where the values come from, the same in all rows"
    )

    @model_validator(mode="after")
    def _check_what_is_told(self):
        if (self.file is None) == (self.probability is None):
            raise ValueError("need either file or probability")
        kind, foreign = "probability", _OF_FILES
        if self.file is not None:
            kind, foreign = "file", _OF_SHARES
        for key in foreign:
            if key in self.model_fields_set:
                raise ValueError(f"{key}: not allowed with {kind}")
        return self

    @model_validator(mode="after")
    def _check_interval(self):
        ends = [self.lower, self.probability, self.upper]
        told = [share for share in ends if share is not None]
        if told != sorted(told):
            raise ValueError(f"probability: got {told}, need lower, probability and upper to rise")
        return self


@dataclass(frozen=True)
class Entry:
    """One usable row of a manifest.

    Attributes
    ----------
    where : str
        Where it stands, such as ``manifest.csv: line 3``.
    file : Path or None
        Record of the rig, which exists; None where the share is given.
    channel : str or None
        Its channel in the file, if given.
    unit : str or None
        Unit of that channel, if given.
    gain : float
        Amplification of what was recorded, not 0.
    offset : float or str
        What was recorded when the true value was 0: with its unit, or 0.0 if not given.
    sampling_interval : float or None
        Time between samples, s, if given.
    probability, lower, upper : float or None
        Share of time in contact, already evaluated, and its limits if given.
    force, speed, temperature : float
        Operating point, N, rpm and degC.
    force_tolerance, speed_tolerance, temperature_tolerance : float or None
        How far the true operating point may be from it, N, rpm and K, if given.
    lubricant : str or None
        Lubricant, if given.
    slide_to_roll_ratio : float or None
        Slide-to-roll ratio, if given.
    pair : str or None
        Label of the pair of rollers, if given.
    """

    where: str
    file: Path | None
    channel: str | None
    unit: str | None
    gain: float
    offset: float | str
    sampling_interval: float | None
    probability: float | None
    lower: float | None
    upper: float | None
    force: float
    speed: float
    temperature: float
    force_tolerance: float | None
    speed_tolerance: float | None
    temperature_tolerance: float | None
    lubricant: str | None
    slide_to_roll_ratio: float | None
    pair: str | None


@dataclass(frozen=True)
class Manifest:
    """What a manifest tells.

    Attributes
    ----------
    origin : str
        ``measured`` or ``simulated``, that of the first usable row; the same for all entries.
    entries : tuple of Entry
        The usable rows, in order.
    refused : tuple of str
        One line for each row that cannot be used: where it stands, what came, what is needed.
    """

    origin: str
    entries: tuple
    refused: tuple


def read_manifest(path):
    """Read a manifest.

    The README has the table of its keys, made of `manifest_schema`. They are the columns of a CSV
    file, with a unit where there is one (``force [N]``), or the keys of a YAML list's mappings,
    where the unit stands with the value: ``force: 800 N``. Commas within numbers are decimal
    commas. Several rows may be of one operating point.

    Parameters
    ----------
    path : str or Path
        The file, with the suffix .csv, .yaml or .yml.

    Returns
    -------
    Manifest
        Its rows, those refused as well.

    Raises
    ------
    DataError
        If the file cannot be read, has no usable line of column names, or is no list.
    """
    path = Path(path)
    if path.suffix.lower() in (".yaml", ".yml"):
        rows = _yaml_rows(path)
    elif path.suffix.lower() == ".csv":
        rows = _csv_rows(path)
    else:
        raise DataError(f"{path}: got the suffix {path.suffix!r}, need .csv, .yaml or .yml")
    return _collected(rows, path.parent)


def manifest_schema():
    """Tell the columns, or keys, of a manifest.

    Returns
    -------
    dict
        JSON schema of a row, each key with its meaning.
    """
    return _Row.model_json_schema()


def _yaml_rows(path):
    """Place and content of each row; the content of an unusable one is the reason."""
    for number, content in enumerate(read_yaml(path, DataError, list), start=1):
        if not isinstance(content, dict):
            content = f"need a mapping of keys to values, got {type(content).__name__}"
        yield f"{path.name}: entry {number}", content


def _csv_rows(path):
    lines = numbered_lines(path, DataError)
    if not lines:
        raise DataError(f"{path}: empty, need a line of column names and rows of values")
    (header_line, header), *rows = lines
    delimiter = delimiter_of(header)
    columns = _columns(split_cells(header, delimiter), f"{path}: line {header_line}")
    for number, text in rows:
        cells = split_cells(text, delimiter)
        where = f"{path.name}: line {number}"
        if len(cells) != len(columns):
            yield where, f"got {len(cells)} values, need {len(columns)}"
            continue
        told = zip(columns.items(), cells, strict=True)
        yield where, {name: f"{cell} {units or ''}".strip() for (name, units), cell in told if cell}


def _columns(cells, where):
    """Units, or None, by column name, in the order of the columns."""
    columns = {}
    for cell in cells:
        match = HEADER_CELL.fullmatch(cell)
        name, units = match.groups() if match else (cell, None)
        if name not in _Row.model_fields or name in columns:
            raise DataError(
                f"{where}: got the column {shown(cell)}, need each once of "
                f"{', '.join(_Row.model_fields)}, with units such as 'force [N]'"
            )
        _check_units(name, units, where)
        columns[name] = units
    for name in ("force", "speed", "temperature"):
        if name not in columns:
            raise DataError(f"{where}: no column '{name} [{_UNITS[name]}]', need it")
    return columns


def _check_units(name, units, where):
    target = _UNITS.get(name)
    if (units is None) != (target is None):
        needed = f"'{name} [{target}]'" if target else f"{name!r} without a unit"
        raise DataError(f"{where}: {name}: got the unit {shown(units)}, need {needed}")
    if target is None:
        return
    try:
        if name == "offset":
            electrical_quantity(units)
        else:
            convert(1.0, units, target)
    except LubeError as error:
        raise DataError(f"{where}: {name}: {error}") from None


def _collected(rows, folder):
    """Sort rows into those that can be used and those that cannot."""
    entries, refused, origin = [], [], None
    for where, content in rows:
        try:
            row = _row(content, where)
            file = _file(row, where, folder)
            if row.origin != (origin or row.origin):
                raise DataError(
                    f"{where}: origin: got {row.origin!r} among rows that are {origin}, need "
                    "one origin in a manifest"
                )
        except DataError as error:
            refused.append(str(error))
            continue
        origin = row.origin
        told = {name: value for name, value in row if name not in ("file", "origin")}
        entries.append(Entry(where=where, file=file, **told))
    return Manifest(origin or ORIGINS[0], tuple(entries), tuple(refused))


def _row(content, where):
    if isinstance(content, str):
        raise DataError(f"{where}: {content}")
    content = {
        key: value if key in _TEXTS else _with_point(value)
        for key, value in content.items()
        if value is not None
    }
    return validate(_Row, content, where, DataError)


def _with_point(value):
    """Turn a decimal comma into a point."""
    return re.sub(r"^(\s*[+-]?\d*),(?=\d)", r"\1.", value) if isinstance(value, str) else value


def _file(row, where, folder):
    if row.file is None:
        return None
    if not os.path.isfile(folder / row.file):  # whatever its name holds
        raise DataError(f"{where}: file: got {shown(row.file)}, no such file")
    return folder / row.file
