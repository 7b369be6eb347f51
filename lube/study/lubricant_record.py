"""Lubricant records: one YAML file per lubricant, checked as a whole and frozen.

A lubricant record gives the viscosity in one of four ways: as points, as a CSV file of
measurements in the record's folder, by ISO grade and viscosity index, or by the name of a CoolProp
fluid. Every section names its source, or says ``assumed: ...`` and why. This module only reads and
checks; the properties at a temperature are computed in `lube.study.oil_properties`.
"""

import re
from collections import defaultdict
from collections.abc import Sequence
from itertools import pairwise
from pathlib import Path
from typing import Annotated, Literal

import numpy as np
from pydantic import BeforeValidator, Field, PrivateAttr, model_validator

from lube.errors import RangeError, RecordError, located, nearest, shown
from lube.physics import ZERO_CELSIUS
from lube.physics.coolprop_fluids import ATMOSPHERIC_PRESSURE, liquid_property, liquid_range
from lube.physics.density import linear_density
from lube.physics.pressure_viscosity import DEFINITIONS, FORMULA_DEFINITION, GOLD_BASES
from lube.physics.viscosity_index import viscosity_at_100
from lube.physics.viscosity_laws import VISCOSITY_LAWS
from lube.study.field_types import Slug, StrictModel, Text, quantity, validate
from lube.study.text_files import read_yaml
from lube.study.viscosity_checks import ROUNDING, check_points
from lube.study.viscosity_points import OilTemperature, ViscosityPoint, read_viscosity_csv
from lube.types import File, Values

SHIPPED_FOLDER = Path(__file__).parent / "lubricants"

ISO_GRADES = (10, 15, 22, 32, 46, 68, 100, 150, 220, 320, 460, 680, 1000, 1500)
"""Grades of ISO 3448 by their kinematic viscosity at 40 degC, mm2/s."""

GEAR_OIL_GRADES = tuple(grade for grade in ISO_GRADES if 32 <= grade <= 680)
"""Grades of the shipped gear oils, whose file has one of them in its name."""

_GRADED = re.compile(r"(.+-iso-vg-)\d+")


class Sourced(StrictModel):
    """A section of a lubricant record, which must name the source of its values."""

    source: Text
    """where the values come from, or 'assumed: ...' and why"""


class Viscosity(Sourced):
    """Where the viscosity comes from: points, a CSV file, an ISO grade or a CoolProp fluid."""

    points: tuple[ViscosityPoint, ...] | None = None
    """viscosities at two temperatures or more"""
    csv: Text | None = None
    """CSV file in the record's folder"""
    iso_vg: Literal[ISO_GRADES] | None = None
    """ISO viscosity grade, with `viscosity_index`"""
    viscosity_index: Annotated[float, quantity(None, least=0.0, most=400.0)] | None = None
    """viscosity index (ASTM D2270) of an oil of that grade"""
    coolprop_fluid: Text | None = None
    """CoolProp's name of a pure fluid"""

    @model_validator(mode="after")
    def _check_one_way(self):
        ways = ("points", "csv", "iso_vg", "coolprop_fluid")
        given = self.given_keys(ways)
        if len(given) != 1:
            raise ValueError(f"got {' and '.join(given) or 'none'}, need one of {', '.join(ways)}")
        if (self.iso_vg is None) != (self.viscosity_index is None):
            raise ValueError("viscosity_index: need one if iso_vg is given, and none otherwise")
        return self


class Density(Sourced):
    """Density falling linearly with temperature about 15 degC."""

    # The range holds all liquids that lubricate, and neither g/cm^3 nor g/l by mistake.
    at_15_degC: Annotated[float, quantity("kg/m^3", least=400.0, most=2500.0)]
    """density at 15 degC"""
    thermal_coefficient: Annotated[float, quantity("1/K", least=0.0, below=2e-3)]
    """relative fall of the density per kelvin"""


# The range holds all liquids that lubricate.
_COEFFICIENT = Annotated[float, quantity("1/GPa", least=1.0, most=100.0)]


class CoefficientPoint(StrictModel):
    """Pressure-viscosity coefficient at one temperature."""

    temperature: OilTemperature
    """temperature of the value"""
    value: _COEFFICIENT
    """measured coefficient"""


_BASES = {name: name for name in GOLD_BASES} | {"pao": "polyalphaolefin", "pag": "polyglycol"}


def base_oil(name: object) -> object:
    """Return the key of `GOLD_BASES` that means a base oil, in any case; another name as it is.

    Examples
    --------
    >>> base_oil("PAO")
    'polyalphaolefin'
    """
    return _BASES.get(f"{name}".lower(), name)


class PressureViscosity(Sourced):
    """Pressure-viscosity coefficient: Gold's form, measured, or from viscosities under pressure."""

    gold_base: Annotated[Literal[tuple(GOLD_BASES)], BeforeValidator(base_oil)] | None = None
    """base oil, for Gold's form alpha = s nu^t"""
    value: _COEFFICIENT | None = None
    """measured coefficient, the same at all temperatures"""
    points: Annotated[tuple[CoefficientPoint, ...], Field(min_length=1)] | None = None
    """measured coefficients; between them its logarithm is linear in temperature"""
    definition: Literal[tuple(DEFINITIONS)] | None = None
    """definition of the measured coefficient, or of the one from viscosities under pressure"""
    pressure: Annotated[float, quantity("Pa", above=ATMOSPHERIC_PRESSURE)] | None = None
    """pressure to which the secant runs"""

    @model_validator(mode="after")
    def _check_definition(self):
        gold, given = self.gold_base is not None, self.given
        if gold == (self.definition is not None) or (gold and len(given) > 1):
            raise ValueError("need either gold_base alone, or a definition of the coefficient")
        if len(given) > 1:
            raise ValueError(f"got {' and '.join(given)}, need one of them")
        for cold, hot in pairwise(sorted(point.temperature for point in self.points or ())):
            if hot - cold <= ROUNDING:
                raise ValueError(f"points: got two values at {hot:g} degC, need one")
        if (self.pressure is None) == (self.definition == "secant"):
            raise ValueError("pressure: need one if definition is 'secant', and none otherwise")
        return self

    @property
    def given(self) -> list[str]:
        """Keys that give the coefficient; none if it follows from viscosities under pressure."""
        return self.given_keys(("gold_base", "value", "points"))

    @property
    def span(self) -> float | None:
        """Pressure above atmospheric to which the secant runs, Pa."""
        return None if self.pressure is None else self.pressure - ATMOSPHERIC_PRESSURE

    @property
    def definition_text(self) -> str:
        """Definition of the coefficient that the film formulas take, in words for its file."""
        if self.gold_base is not None:
            s, t = GOLD_BASES[self.gold_base]
            return f"Gold's form {s:g} nu^{t:g} 1/GPa, nu in mm2/s ({self.gold_base})"
        words = DEFINITIONS[self.definition].format(pressure=(self.pressure or 0.0) / 1e6)
        if self.definition == FORMULA_DEFINITION:
            return words
        return f"{DEFINITIONS[FORMULA_DEFINITION]}, by Roelands' law from the {words}"


class ThermalConductivity(Sourced):
    """Thermal conductivity, the same at all temperatures."""

    value: Annotated[float, quantity("W/m/K", above=0.0, most=1.0)]
    """thermal conductivity; that of oils is 0.1 to 0.2 W/(m K), that of water 0.6"""


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
    """A lubricant, in SI units (but degC, and 1/GPa). Read it with `load_record`."""

    name: Slug
    """label of the lubricant in all files"""
    title: Text
    """full name of the lubricant, for the report; figures show its `name`"""
    viscosity: Viscosity
    viscosity_law: Literal[tuple(VISCOSITY_LAWS)] | None = None
    """law that gives the viscosity between the data; by default astm-d341"""
    density: Density | None = None
    """density; needed unless CoolProp gives it"""
    pressure_viscosity: PressureViscosity
    thermal_conductivity: ThermalConductivity | None = None
    """thermal conductivity, for the heating at the inlet; CoolProp gives that of its fluids"""
    temperature_range: TemperatureRange | None = None

    _files: tuple[Path, ...] = PrivateAttr(())

    @model_validator(mode="after")
    def _check_sections(self):
        fluid, alpha = self.viscosity.coolprop_fluid, self.pressure_viscosity
        if fluid is None:
            if self.density is None:
                raise ValueError("density: missing, need it unless CoolProp gives it")
            return self
        given = [f"pressure_viscosity.{key}" for key in alpha.given]
        for key in given + self.given_keys(("density", "thermal_conductivity", "viscosity_law")):
            raise ValueError(f"{key}: not allowed, CoolProp gives it for {fluid}")
        if alpha.definition == "reciprocal-asymptotic":
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

        They are those of `temperature_range` if it is given, else those at which the data give
        both viscosity and pressure-viscosity coefficient, else CoolProp's liquid range.
        """
        if self.temperature_range is not None:
            return self.temperature_range.lowest, self.temperature_range.highest
        if self.viscosity.points is not None:
            ambient = [point.temperature for point in self._ambient]
            measured = [point.temperature for point in self.pressure_viscosity.points or ()]
            known = list(filter(None, [ambient, measured, [*self.isotherms]]))
            return max(map(min, known)), min(map(max, known))
        lowest, highest = liquid_range(self.viscosity.coolprop_fluid)
        return lowest - ZERO_CELSIUS, highest - ZERO_CELSIUS

    @property
    def _ambient(self):
        return [point for point in self.viscosity.points if not point.is_under_pressure]

    def density_at(self, kelvin: Values) -> Values:
        """Density, kg/m3, at a temperature in K."""
        return linear_density(kelvin, self.density.at_15_degC, self.density.thermal_coefficient)

    def kinematic_viscosity(self, point: ViscosityPoint) -> float:
        """Kinematic viscosity of a point, m2/s: as given, or dynamic viscosity over density."""
        if point.kinematic_viscosity is not None:
            return point.kinematic_viscosity
        return point.dynamic_viscosity / self.density_at(point.temperature + ZERO_CELSIUS)

    @property
    def data(self) -> list[tuple[float, float]]:
        """Viscosities at atmospheric pressure: temperature in degC, kinematic viscosity in m2/s."""
        return [(point.temperature, self.kinematic_viscosity(point)) for point in self._ambient]

    @property
    def isotherms(self) -> dict[float, list[tuple[float, float]]]:
        """Viscosities under pressure, by temperature in degC.

        Pressures above atmospheric, in Pa, rising, each with the dynamic viscosity over the one at
        atmospheric pressure.
        """
        found = defaultdict(list)
        for point in self.viscosity.points:
            if point.is_under_pressure:
                found[point.temperature].append(point)
        return {temperature: self._ratios(points) for temperature, points in found.items()}

    def _ratios(self, points):
        temperature = points[0].temperature
        same = [nu for at, nu in self.data if abs(at - temperature) <= ROUNDING]
        if not same:
            raise RecordError(
                f"viscosity: got values at {temperature:g} degC under pressure only, need one at "
                "atmospheric pressure as well"
            )
        ambient = sum(same) / len(same) * self.density_at(temperature + ZERO_CELSIUS)
        pairs = [(p.pressure - ATMOSPHERIC_PRESSURE, p.dynamic_viscosity / ambient) for p in points]
        return sorted(pairs)

    def check_temperatures(self, temperatures: Sequence[float]) -> None:
        """Refuse temperatures at which a lubricant record is not valid.

        CoolProp, which takes seconds to import, is asked for the range of a fluid if the record has
        none.

        Parameters
        ----------
        temperatures : sequence of float
            Temperatures, degC.

        Raises
        ------
        RangeError
            At the first temperature outside, with the lubricant's name and its range.
        """
        lowest, highest = self.valid_temperatures
        needed = f"need {lowest:g} to {highest:g} degC"
        if self.viscosity.coolprop_fluid is None:  # its liquid has no properties beyond
            needed += ", or a wider temperature_range of the oil"
        for temperature in temperatures:
            if not lowest - ROUNDING <= temperature <= highest + ROUNDING:
                raise RangeError(f"{self.name}: got {temperature:g} degC, {needed}")

    def check_fluid(self, temperatures: Sequence[float]) -> None:
        """Refuse a CoolProp fluid without viscosity or density at the temperatures of a study.

        The shipped fluids are known to be fit and are not checked: CoolProp takes seconds to
        import.

        Parameters
        ----------
        temperatures : sequence of float
            Temperatures, degC.

        Raises
        ------
        LubeError
            If CoolProp lacks a property of the fluid, or a temperature or the secant's pressure
            lies outside its range.
        """
        fluid = self.viscosity.coolprop_fluid
        if fluid is None or (self.files and self.files[0].parent == SHIPPED_FOLDER):
            return
        kelvin = np.array(temperatures, dtype=float) + ZERO_CELSIUS
        with located(self.name):
            for name in ("viscosity", "density"):
                liquid_property(fluid, name, kelvin)
            if self.pressure_viscosity.pressure is not None:
                liquid_property(fluid, "viscosity", kelvin, self.pressure_viscosity.pressure)


def _shipped():
    """Shipped records: YAML file of each name, and the ISO grade in the name, if any, to insert."""
    found = {}
    for path in sorted(SHIPPED_FOLDER.glob("*.yaml")):
        graded = _GRADED.fullmatch(path.stem)
        grades = GEAR_OIL_GRADES if graded else (None,)
        found |= {f"{graded[1]}{one}" if graded else path.stem: (path, one) for one in grades}
    return found


def shipped_records() -> tuple[str, ...]:
    """Names of the lubricant records that come with the package.

    Returns
    -------
    tuple of str
        The names, sorted; a gear oil has one for each ISO grade from 32 to 680.

    Examples
    --------
    >>> [name for name in shipped_records() if "iso-vg" not in name][:3]
    ['base-oil-m100', 'base-oil-n100', 'base-oil-pao100']
    >>> [name for name in shipped_records() if name.startswith("mineral")][:3]
    ['mineral-iso-vg-100', 'mineral-iso-vg-150', 'mineral-iso-vg-220']
    """
    return tuple(sorted(_shipped()))


def is_record_path(name: object) -> bool:
    """Whether a study's lubricant is given as the path of a YAML file, not as a shipped name."""
    return isinstance(name, str | Path) and Path(name).suffix in (".yaml", ".yml")


def load_record(name_or_path: File) -> LubricantRecord:
    """Read and check a lubricant record.

    Parameters
    ----------
    name_or_path : str or Path
        Name of a shipped record, or path of a ``.yaml`` file.

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
    path, grade = _record_path(name_or_path)
    content = read_yaml(path, RecordError)
    if grade is not None:
        content = _regraded(content, name_or_path, grade)
    record = validate(LubricantRecord, content, path, RecordError)
    viscosity, files = record.viscosity, (path,)
    points = viscosity.points
    if viscosity.csv is not None:
        files += (_beside(path, viscosity.csv),)
        points = read_viscosity_csv(files[1])
    elif viscosity.iso_vg is not None:
        points = _points_of_grade(viscosity)
    if points is not None:
        viscosity = viscosity.model_copy(update={"points": points})
        record = record.model_copy(update={"viscosity": viscosity})
        check_points(record, files[-1])
    record._files = files
    return record


def _points_of_grade(viscosity):
    """Viscosities at 40 degC, which names the grade, and at 100 degC, by the viscosity index."""
    at_100 = viscosity_at_100(viscosity.iso_vg, viscosity.viscosity_index)
    return tuple(
        ViscosityPoint(temperature=f"{degrees} degC", kinematic_viscosity=f"{value!r} mm^2/s")
        for degrees, value in ((40, viscosity.iso_vg), (100, at_100))
    )


def _regraded(content, name, grade):
    """Content of a shipped record with another ISO grade."""
    viscosity = content["viscosity"]
    title = content["title"].replace(str(viscosity["iso_vg"]), str(grade))
    return content | {"name": name, "title": title, "viscosity": viscosity | {"iso_vg": grade}}


def _record_path(name_or_path):
    """Path of a record's file, and the ISO grade to insert, if any."""
    if is_record_path(name_or_path):
        return Path(name_or_path), None
    shipped, is_name = _shipped(), isinstance(name_or_path, str)
    if is_name and name_or_path in shipped:
        return shipped[name_or_path]
    near = nearest(name_or_path, shipped) if is_name else None
    lowest, *_, highest = GEAR_OIL_GRADES
    names = {_GRADED.sub(rf"\1<{lowest} to {highest}>", name): None for name in sorted(shipped)}
    needed = f"need one of {', '.join(names)}, or a path of a .yaml file"
    hint = f"; did you mean {near!r}?" if near else ""
    raise RecordError(f"got {shown(name_or_path)}, {needed}{hint}")


def _beside(record_path, name):
    """Path of a data file, which must lie in the folder of its lubricant record."""
    folder = record_path.parent
    inside = (folder / name).resolve().is_relative_to(folder.resolve())
    if Path(name).is_absolute() or not inside:
        came = f"viscosity.csv: got {shown(name)}"
        raise RecordError(f"{record_path}: {came}, need a file in the record's folder")
    return folder / name
