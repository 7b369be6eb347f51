"""The manifest of an experiment: a list of records with their operating conditions.

A manifest is a CSV file with units in its column names, or a YAML list of mappings whose values
have units. Each row names a recording or states a contact share. A row that cannot be used is
refused in one line; the others are still read.
"""

import os
from dataclasses import dataclass
from pathlib import Path
from typing import Annotated, Literal

from pydantic import NonNegativeInt, model_validator

from lube.errors import DataError, located, right_one, shown
from lube.recordings.signals import header_cell
from lube.study.field_types import StrictModel, Text, checked_text, quantity, validate
from lube.study.small_csv import read_cells, with_point
from lube.study.text_files import read_yaml
from lube.units import convert, electrical_quantity, parse_electrical

Share = Annotated[float, quantity(None, least=0.0, most=1.0)]
_Unit = Annotated[str, checked_text(electrical_quantity, "unit of voltage or resistance")]
_Offset = Annotated[str, checked_text(parse_electrical, "quantity in V or ohm, as the record is")]

_UNITS = {"force": "N", "speed": "rpm", "temperature": "degC", "offset": "mV"}
_UNITS |= {"force_tolerance": "N", "speed_tolerance": "rpm", "temperature_tolerance": "K"}
_UNITS |= {"sampling_interval": "s"}
"""Columns whose header needs a unit, with an example; an offset may also be in ohm."""

ORIGINS = ("measured", "simulated")
"""Possible origins of the records."""

_TEXTS = ("file", "channel", "unit", "lubricant", "pair", "origin")
OF_FILES = ("channel", "unit", "gain", "offset", "sampling_interval", "skip")
"""Columns that say how to read a recording; arguments of `open_recording`."""


class Row(StrictModel):
    """A row as it is written: operating conditions, and a recording or a contact share."""

    file: Text | None = None
    """the recording, relative to the manifest's folder; this or `probability`"""
    channel: Text | None = None
    """name, without its unit, of the column, variable or channel to read; in TDMS also
    `group/channel`; by default the first voltage or resistance
    """
    unit: _Unit | None = None
    """unit of that channel; overrides the one in the file, and decides between voltage and
    resistance where the channel's name does not
    """
    gain: Annotated[float, quantity(None, other_than=0.0)] = 1.0
    """factor of an amplifier between rig and recorder, below 0 if it inverts: recorded = gain ×
    true + offset
    """
    offset: _Offset = 0.0
    """recorded value when the true value is 0, a voltage or a resistance as the channel is:
    true = (recorded - offset) / gain
    """
    sampling_interval: Annotated[float, quantity("s", above=0.0)] | None = None
    """time between samples, for a file that does not state it"""
    skip: NonNegativeInt | None = None
    """number of lines of a CSV file before its column names, where they are not found"""
    probability: Share | None = None
    """contact share that you evaluated yourself, in place of `file`"""
    lower: Share | None = None
    """lower limit of that share"""
    upper: Share | None = None
    """upper limit of that share"""
    force: Annotated[float, quantity("N", above=0.0)]
    """normal force"""
    speed: Annotated[float, quantity("rpm", above=0.0)]
    """rotation speed, as in the study; `1/min` and `Hz` count turns"""
    temperature: Annotated[float, quantity("degC", above=-273.15)]
    """temperature of rollers and oil"""
    force_tolerance: Annotated[float, quantity("N", above=0.0)] | None = None
    """largest difference between the true force and the one stated"""
    speed_tolerance: Annotated[float, quantity("rpm", above=0.0)] | None = None
    """largest difference between the true speed and the one stated"""
    temperature_tolerance: Annotated[float, quantity("K", above=0.0)] | None = None
    """largest difference between the true temperature and the one stated; 1 degC is 1 K here"""
    lubricant: Text | None = None
    """a lubricant of the study; by default its first"""
    slide_to_roll_ratio: Annotated[float, quantity(None, least=-2.0, most=2.0)] | None = None
    """(v1 - v2) / mean surface speed; by default the study's nearest to 0"""
    pair: Text | None = None
    """label of the pair of rollers measured; all rows without a label are of one pair"""
    origin: Literal[ORIGINS] = ORIGINS[0]
    """where the values come from, the same in all rows"""

    @model_validator(mode="after")
    def _check_file_or_probability(self):
        if (self.file is None) == (self.probability is None):
            raise ValueError("need either file or probability")
        kind, excluded = ("file", ("lower", "upper")) if self.file else ("probability", OF_FILES)
        for key in excluded:
            if key in self.model_fields_set:
                raise ValueError(f"{key}: not allowed with {kind}")
        return self

    @model_validator(mode="after")
    def _check_interval(self):
        given = [one for one in (self.lower, self.probability, self.upper) if one is not None]
        if given != sorted(given):
            raise ValueError(f"probability: got {given}, need lower <= probability <= upper")
        return self


class Entry(Row):
    """One usable row of a manifest: its columns, and the two attributes below.

    Attributes
    ----------
    where : str
        Its position in the manifest, such as ``manifest.csv: line 3``.
    file : Path or None
        The recording, an existing file; None where the row states a contact share.
    """

    where: str
    file: Path | None = None


@dataclass(frozen=True)
class Manifest:
    """Content of a manifest.

    Attributes
    ----------
    origin : str
        ``measured`` or ``simulated``, as in the first usable row; the same for all entries.
    entries : tuple of Entry
        The usable rows, in order.
    refused : tuple of str
        One line for each row that cannot be used, with its position and the reason.
    """

    origin: str
    entries: tuple[Entry, ...]
    refused: tuple[str, ...]


def read_manifest(path: str | Path) -> Manifest:
    """Read a manifest.

    Its columns are the fields of `Row`. In a CSV file a column of dimensional values has its
    unit in the header (``force [N]``); in a YAML list of mappings the unit is part of the value
    (``force: 800 N``). Numbers may have decimal commas. Several rows may have the same operating
    point.

    Parameters
    ----------
    path : str or Path
        The file; YAML if its suffix is .yaml or .yml, else CSV.

    Returns
    -------
    Manifest
        The usable rows, and the reasons why others are refused.

    Raises
    ------
    DataError
        If the file cannot be read, its line of column names cannot be used, or it is not a list.
    """
    path = Path(path)
    rows = _yaml_rows(path) if path.suffix.lower() in (".yaml", ".yml") else _csv_rows(path)
    entries, refused = [], []
    for where, content in rows:
        try:
            entries.append(_entry(content, where, path.parent, entries))
        except DataError as error:
            refused.append(str(error))
    origin = entries[0].origin if entries else ORIGINS[0]
    return Manifest(origin, tuple(entries), tuple(refused))


def _yaml_rows(path):
    """Position and content of each row."""
    for number, content in enumerate(read_yaml(path, DataError, list), start=1):
        yield f"{path.name}: entry {number}", content


def _csv_rows(path):
    """Position and content of each row; a row of the wrong length has an error as content."""
    (header_line, header), *rows = read_cells(path, DataError)
    columns = _columns(header, f"{path}: line {header_line}")
    for number, cells in rows:
        where = f"{path.name}: line {number}"
        if len(cells) != len(columns):
            yield where, DataError(f"{where}: got {len(cells)} values, need {len(columns)}")
            continue
        pairs = zip(columns.items(), cells, strict=True)
        yield where, {name: f"{cell} {unit or ''}".strip() for (name, unit), cell in pairs if cell}


def _columns(cells, where):
    """Units of the columns by name, None where there is none, in the order of the columns."""
    columns, known = {}, Row.model_fields
    for cell in cells:
        name, units = header_cell(cell)
        if name not in known:
            raise DataError(f"{where}: unknown column {shown(cell)}, {right_one(name, known)}")
        if name in columns:
            raise DataError(f"{where}: column {name!r} is repeated")
        _check_units(name, units, where)
        columns[name] = units
    for name in ("force", "speed", "temperature"):
        if name not in columns:
            raise DataError(f"{where}: missing column '{name} [{_UNITS[name]}]'")
    return columns


def _check_units(name, units, where):
    target = _UNITS.get(name)
    if (units is None) != (target is None):
        needed = f"'{name} [{target}]'" if target else f"{name!r} without a unit"
        came = f"the unit {shown(units)}" if units else "no unit"
        raise DataError(f"{where}: {name}: got {came}, need {needed}")
    with located(f"{where}: {name}", DataError):
        if name == "offset":
            electrical_quantity(units)
        elif target is not None:
            convert(1.0, units, target)


def _entry(content, where, folder, earlier):
    """Entry of a row's content, after the earlier entries."""
    if isinstance(content, DataError):
        raise content
    if not isinstance(content, dict):
        raise DataError(f"{where}: got {type(content).__name__}, need a mapping of keys to values")
    content = {
        key: value if key in _TEXTS else with_point(value)
        for key, value in content.items()
        if value is not None
    }
    row = validate(Row, content, where, DataError)
    file = None if row.file is None else folder / row.file
    if file is not None and not os.path.isfile(file):
        raise DataError(f"{where}: file: got {shown(row.file)}, no such file")
    if earlier and row.origin != earlier[0].origin:
        came = f"got {row.origin!r} after {earlier[0].origin!r}"
        raise DataError(f"{where}: origin: {came}, need the same in all rows")
    entry = Entry.model_construct(**dict(row) | {"where": where, "file": file})
    for other in earlier:
        if file is not None and dict(other) | {"where": where} == dict(entry):
            raise DataError(f"{where}: repeats {other.where}, need each record once")
    return entry
