"""Lubricant records: one YAML file per lubricant, checked as a whole and frozen.

A lubricant record gives the viscosity in one of three ways: as points, as a CSV file of
measurements beside the record, or by naming a CoolProp fluid. Every section names its source, or
says ``assumed: ...`` and why. This module only reads and checks; the properties at a temperature
are computed in `lube.stages.lubricant`.
"""

from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path
from typing import Literal

from pydantic import PrivateAttr, model_validator

from lube.errors import RangeError, RecordError, right_one, shown
from lube.physics import ZERO_CELSIUS
from lube.physics.coolprop_fluids import ATMOSPHERIC_PRESSURE, liquid_range
from lube.physics.pressure_viscosity import GOLD_BASES
from lube.physics.viscosity_laws import VISCOSITY_LAWS
from lube.study.field_types import Slug, StrictModel, Text, quantity, validate
from lube.study.small_csv import HEADER_CELL, read_cells
from lube.study.text_files import read_yaml
from lube.types import File

SHIPPED_FOLDER = Path(__file__).parent / "lubricants"

# Temperatures converted from K or degF to degC may miss a limit by rounding.
_ROUNDING = 1e-6

OilTemperature = quantity("degC", above=-ZERO_CELSIUS, most=1000.0)


class Sourced(StrictModel):
    """A section of a lubricant record, which must name the source of its values."""

    source: Text
    """where the values come from, or 'assumed: ...' and why"""


class ViscosityPoint(StrictModel):
    """Viscosity at one temperature, kinematic or dynamic."""

    temperature: OilTemperature
    """temperature of the value"""
    kinematic_viscosity: quantity("m^2/s", above=0.0) | None = None
    """kinematic viscosity; this or `dynamic_viscosity`"""
    dynamic_viscosity: quantity("Pa*s", above=0.0) | None = None
    """dynamic viscosity"""

    @model_validator(mode="after")
    def _check_one_viscosity(self):
        if (self.kinematic_viscosity is None) == (self.dynamic_viscosity is None):
            raise ValueError("need either kinematic_viscosity or dynamic_viscosity")
        return self


class Viscosity(Sourced):
    """Where the viscosity comes from: points, a CSV file or a CoolProp fluid."""

    points: tuple[ViscosityPoint, ...] | None = None
    """viscosities at two temperatures or more"""
    csv: Text | None = None
    """CSV file in the record's folder"""
    coolprop_fluid: Text | None = None
    """CoolProp's name of a pure fluid"""

    @model_validator(mode="after")
    def _check_one_way(self):
        ways = ("points", "csv", "coolprop_fluid")
        given = [way for way in ways if getattr(self, way) is not None]
        if len(given) != 1:
            raise ValueError(f"got {' and '.join(given) or 'none'}, need one of {', '.join(ways)}")
        return self


class Density(Sourced):
    """Density falling linearly with temperature about 15 degC."""

    at_15_degC: quantity("kg/m^3", above=0.0)
    """density at 15 degC"""
    thermal_coefficient: quantity("1/K", least=0.0, below=2e-3)
    """relative fall of the density per kelvin"""


_DEFINITIONS = {
    "slope-at-atmospheric": "slope of ln viscosity at atmospheric pressure",
    "secant": "secant of ln viscosity from atmospheric pressure to {pressure:g} MPa",
    "reciprocal-asymptotic": "reciprocal asymptotic isoviscous pressure",
}


class PressureViscosity(Sourced):
    """Pressure-viscosity coefficient: Gold's form, a measured value, or CoolProp's."""

    gold_base: Literal[tuple(GOLD_BASES)] | None = None
    """base oil, for Gold's form alpha = s nu^t"""
    value: quantity("1/Pa", above=0.0) | None = None
    """measured coefficient, the same at all temperatures"""
    definition: Literal[tuple(_DEFINITIONS)] | None = None
    """definition of the measured, or CoolProp's, coefficient"""
    pressure: quantity("Pa", above=ATMOSPHERIC_PRESSURE) | None = None
    """pressure to which the secant runs"""

    @model_validator(mode="after")
    def _check_definition(self):
        gold = self.gold_base is not None
        if gold == (self.definition is not None) or (gold and self.value is not None):
            raise ValueError("need either gold_base alone, or definition")
        if (self.pressure is None) == (self.definition == "secant"):
            raise ValueError("pressure: need it with definition 'secant', and only there")
        return self

    @property
    def definition_text(self) -> str:
        """Definition of the coefficient in words, stored with its values."""
        if self.gold_base is not None:
            s, t = GOLD_BASES[self.gold_base]
            return f"Gold's form {s:g} nu^{t:g} 1/GPa, nu in mm2/s ({self.gold_base})"
        return _DEFINITIONS[self.definition].format(pressure=(self.pressure or 0.0) / 1e6)


class ThermalConductivity(Sourced):
    """Thermal conductivity, the same at all temperatures."""

    value: quantity("W/m/K", above=0.0)
    """thermal conductivity"""


class TemperatureRange(Sourced):
    """Temperatures at which the lubricant record is valid, in place of those of its data."""

    lowest: OilTemperature
    """lowest temperature"""
    highest: OilTemperature
    """highest temperature"""

    @model_validator(mode="after")
    def _check_order(self):
        if not self.lowest < self.highest:
            raise ValueError(f"got {self.lowest:g} to {self.highest:g} degC, need the lowest first")
        return self


class LubricantRecord(StrictModel):
    """A lubricant, in SI units (but temperatures in degC). Read it with `load_record`."""

    name: Slug
    """label of the lubricant in all files"""
    title: Text
    """name of the lubricant in figures"""
    viscosity: Viscosity
    viscosity_law: Literal[tuple(VISCOSITY_LAWS)] | None = None
    """law that gives the viscosity between the data; by default astm-d341"""
    density: Density | None = None
    """density; needed unless CoolProp gives it"""
    pressure_viscosity: PressureViscosity
    thermal_conductivity: ThermalConductivity | None = None
    """thermal conductivity, for the heating of the oil at the inlet; CoolProp gives its own"""
    temperature_range: TemperatureRange | None = None

    _files: tuple[Path, ...] = PrivateAttr(())

    @model_validator(mode="after")
    def _check_sections(self):
        fluid, alpha = self.viscosity.coolprop_fluid, self.pressure_viscosity
        measured = {
            "density": self.density,
            "pressure_viscosity.gold_base or value": alpha.gold_base or alpha.value,
        }
        for key, value in measured.items():
            if fluid is None and value is None:
                raise ValueError(f"{key}: missing, need it unless CoolProp gives it")
        optional = {name: getattr(self, name) for name in ("thermal_conductivity", "viscosity_law")}
        for key, value in (measured | optional).items():
            if fluid is not None and value is not None:
                raise ValueError(f"{key}: not allowed, CoolProp gives it for {fluid}")
        if fluid is not None and alpha.definition == "reciprocal-asymptotic":
            raise ValueError(
                "pressure_viscosity.definition: 'reciprocal-asymptotic' not allowed with CoolProp"
            )
        return self

    @property
    def files(self) -> tuple[Path, ...]:
        """Files it was read from: the YAML file, and its CSV file if any."""
        return self._files

    @property
    def law_used(self) -> str:
        """Source of the viscosity between the data: ``coolprop``, or a key of `VISCOSITY_LAWS`."""
        law = self.viscosity_law or "astm-d341"
        return law if self.viscosity.coolprop_fluid is None else "coolprop"

    @property
    def valid_temperatures(self) -> tuple[float, float]:
        """Lowest and highest temperature at which the lubricant record is valid, degC.

        From `temperature_range` if it is given, else from the data, else the liquid range of
        CoolProp, which is imported for it.
        """
        if self.temperature_range is not None:
            return self.temperature_range.lowest, self.temperature_range.highest
        if self.viscosity.points is not None:
            temperatures = [point.temperature for point in self.viscosity.points]
            return min(temperatures), max(temperatures)
        lowest, highest = liquid_range(self.viscosity.coolprop_fluid)
        return lowest - ZERO_CELSIUS, highest - ZERO_CELSIUS


def shipped_records() -> tuple[str, ...]:
    """Names of the lubricant records that come with the package.

    Returns
    -------
    tuple of str
        The names, sorted.

    Examples
    --------
    >>> shipped_records()
    ('mobilgear-shc-xmp-320', 'n-dodecane')
    """
    return tuple(sorted(path.stem for path in SHIPPED_FOLDER.glob("*.yaml")))


def is_record_path(name: object) -> bool:
    """Whether a study's lubricant is given as the path of a YAML file, not as a shipped name."""
    return isinstance(name, str | Path) and Path(name).suffix in (".yaml", ".yml")


def load_record(name_or_path: File, folder: File = ".") -> LubricantRecord:
    """Read and check a lubricant record.

    Parameters
    ----------
    name_or_path : str or Path
        Name of a shipped record, or path of a ``.yaml`` file.
    folder : str or Path, optional
        Folder that a relative path starts from; by default the current one.

    Returns
    -------
    LubricantRecord
        The lubricant record, with the points of its CSV file if it names one.

    Raises
    ------
    RecordError
        Which key, what came, what is needed.

    Examples
    --------
    >>> load_record("n-dodecane").viscosity.coolprop_fluid
    'n-Dodecane'
    """
    path = _record_path(name_or_path, folder)
    record = validate(LubricantRecord, read_yaml(path, RecordError), path, RecordError)
    viscosity, files = record.viscosity, (path,)
    if viscosity.csv is not None:
        files += (_beside(path, viscosity.csv),)
        viscosity = viscosity.model_copy(update={"points": read_viscosity_csv(files[1])})
        record = record.model_copy(update={"viscosity": viscosity})
    if viscosity.points is not None:
        check_points(viscosity.points, files[-1])
    record._files = files
    return record


def _record_path(name_or_path, folder):
    if is_record_path(name_or_path):
        return Path(folder) / name_or_path
    names = shipped_records()
    if name_or_path not in names:
        near = right_one(name_or_path, names) if isinstance(name_or_path, str) else ""
        needed = f"need one of {', '.join(names)}, or a path of a .yaml file"
        raise RecordError(
            f"got {shown(name_or_path)}, {needed}{f'; {near}' if near.startswith('did') else ''}"
        )
    return SHIPPED_FOLDER / f"{name_or_path}.yaml"


def _beside(record_path, name):
    """Path of a data file, which must lie in the folder of its lubricant record."""
    folder = record_path.parent
    inside = (folder / name).resolve().is_relative_to(folder.resolve())
    if Path(name).is_absolute() or not inside:
        raise RecordError(
            f"{record_path}: viscosity.csv: got {shown(name)}, need a file in the record's folder"
        )
    return folder / name


def check_points(points: Sequence[ViscosityPoint], where: File) -> None:
    """Refuse data that no viscosity law can fit.

    Parameters
    ----------
    points : sequence of ViscosityPoint
        Viscosities at some temperatures.
    where : str or Path
        Where they come from, for the message.

    Raises
    ------
    RecordError
        If they are all at one temperature, or rise with the temperature.
    """
    if len({point.temperature for point in points}) < 2:
        raise RecordError(f"{where}: viscosity: need values at two temperatures or more")
    for kind in ("kinematic_viscosity", "dynamic_viscosity"):
        known = [point for point in points if getattr(point, kind) is not None]
        for cold, hot in pairwise(sorted(known, key=lambda point: point.temperature)):
            if cold.temperature < hot.temperature and getattr(cold, kind) <= getattr(hot, kind):
                raise RecordError(
                    f"{where}: viscosity: need less at {hot.temperature:g} degC than at "
                    f"{cold.temperature:g} degC"
                )


_COLUMNS = "temperature [degC] and kinematic_viscosity [mm^2/s] or dynamic_viscosity [mPa*s]"


def read_viscosity_csv(path: File) -> tuple[ViscosityPoint, ...]:
    """Read measured viscosities against temperature.

    The first line names the columns with their units: ``temperature [degC]`` and either
    ``kinematic_viscosity [mm^2/s]`` or ``dynamic_viscosity [mPa*s]``. Columns are separated by
    tabs, semicolons or commas; with tabs or semicolons, numbers may have decimal commas. Empty
    lines and lines that begin with ``#`` are ignored.

    Parameters
    ----------
    path : str or Path
        The file, UTF-8 text.

    Returns
    -------
    tuple of ViscosityPoint
        One point per row.

    Raises
    ------
    RecordError
        Which line and column, what came, what is needed.
    """
    (header_line, header), *rows = read_cells(path, RecordError)
    columns = _csv_columns(header, f"{path}: line {header_line}")
    decimal_comma = any("," in cell for _, cells in rows for cell in cells)
    points = []
    for number, cells in rows:
        where = f"{path}: line {number}"
        if len(cells) != len(columns):
            raise RecordError(f"{where}: got {len(cells)} values, need {len(columns)}")
        with_points = [cell for cell in cells if "." in cell]
        if decimal_comma and with_points:  # thousands separators, or mistakes
            raise RecordError(
                f"{where}: got {shown(with_points[0])} in a file with decimal commas, need no point"
            )
        pairs = zip(columns.items(), cells, strict=True)
        content = {name: f"{cell.replace(',', '.')} {units}" for (name, units), cell in pairs}
        points.append(validate(ViscosityPoint, content, where, RecordError))
    return tuple(points)


def _csv_columns(cells, where):
    """Units of the columns by name, in the order of the columns."""
    columns = dict(cell.groups() for cell in map(HEADER_CELL.fullmatch, cells) if cell)
    ways = [{"temperature", "kinematic_viscosity"}, {"temperature", "dynamic_viscosity"}]
    if len(cells) != 2 or set(columns) not in ways:
        raise RecordError(f"{where}: got the columns {shown(', '.join(cells))}, need {_COLUMNS}")
    return columns


def check_temperatures(record: LubricantRecord, temperatures: Sequence[float]) -> None:
    """Refuse temperatures at which a lubricant record is not valid.

    Cheap, unless the record names a CoolProp fluid and no range: CoolProp is imported to give one.

    Parameters
    ----------
    record : LubricantRecord
        The lubricant.
    temperatures : sequence of float
        Temperatures, degC.

    Raises
    ------
    RangeError
        At the first temperature outside, with the lubricant's name and its range.
    """
    lowest, highest = record.valid_temperatures
    for temperature in temperatures:
        if not lowest - _ROUNDING <= temperature <= highest + _ROUNDING:
            raise RangeError(
                f"{record.name}: got {temperature:g} degC, need {lowest:g} to {highest:g} degC"
            )
