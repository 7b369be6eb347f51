"""What a study does not know exactly: ranges of its quantities, and choices of its model.

Each uncertain quantity or choice is a *factor* of a sensitivity study. Factors of a kind form a
group.
"""

import math
import re
from collections.abc import Mapping
from dataclasses import dataclass
from typing import Annotated, ClassVar, Generic, Literal, TypeVar

from pydantic import Field, field_validator, model_validator

from lube.ehl.film_formulas import FORMULAS, formula
from lube.errors import LubeError, StudyError, located, shown
from lube.physics.pressure_viscosity import DEFINITIONS
from lube.study.field_types import StrictModel, Text, bounded, each_once, read_by, read_number
from lube.study.line_spec import LineSpec
from lube.study.roller_lines import beyond_cutoffs
from lube.study.rollers import ROLLERS
from lube.types import ContactModel, FilmShape, InletHeating, Values
from lube.units import with_unit

BEYOND = 5.0
"""Kelvin by which deviating temperatures may leave the range of an oil's data."""
FARTHEST = 1.5
"""Normal deviations are cut off at this many half-ranges."""
SAMPLE_BATCHES = 8
"""Jobs among which the samples of a study are shared: those that are done are not lost."""


def _range(units, example, **limits):
    """Say how to read a range, ``A to B`` or ``+- A``, whose ends are kept in `units`.

    Percent are kept as fractions.
    """
    needed = f"range such as {example}"

    def parse(value):
        match = re.fullmatch(r"\s*(?:\+-\s*([^\s+-].*)|(\S.*?)\s+to\s+(\S.*))", str(value))
        if match is None or (match[1] and not units):
            raise LubeError(f"got {shown(value)}, need a {needed}")
        # The upper end first: messages quote what is wrong with it, and `+- A` has no lower one.
        ends = [match[1], f"-{match[1]}"] if match[1] else [match[3], match[2]]
        upper, lower = (read_number(end.strip(), units, **limits) for end in ends)
        if lower >= upper:
            raise LubeError(f"got {shown(value)}, need the lower end first")
        return (lower / 100.0, upper / 100.0) if units == "%" else (lower, upper)

    return read_by(parse, {"type": "string", "format": needed})


class _Uncertain(StrictModel):
    """A quantity that is not known exactly, a pure number unless a class says otherwise."""

    _UNITS: ClassVar[str] = ""
    _SCALE: ClassVar[float] = 1.0
    _LIMITS: ClassVar[dict[str, float]] = {}

    distribution: Literal["uniform", "normal"] = "uniform"
    """uniform over the range, or normal, with 95 % of it in the range, cut off at 1.5 times the
    half-width of the range from its middle
    """
    source: Text
    """where the range comes from, or `assumed`"""

    @property
    def in_words(self) -> str:
        """The range in words."""
        lower, upper = (f"{self._SCALE * end:g}{self._UNITS}" for end in self.range)
        return f"{lower} to {upper}"

    @property
    def ends(self) -> tuple[float, float]:
        """The least and the greatest value that occur, those of the range if it is uniform."""
        lower, upper = self.range
        if self.distribution == "uniform":
            return lower, upper
        middle, half = 0.5 * (lower + upper), 0.5 * (upper - lower)
        return middle - half * FARTHEST, middle + half * FARTHEST

    @model_validator(mode="after")
    def _check_ends(self):
        with located("distribution: normal", ValueError):
            for end in self.ends:
                bounded(self._SCALE * end, self._UNITS.strip(), **self._LIMITS)
        return self

    def within(self, part: float) -> str:
        """Half of the range, reduced to a part of it, in words, such as ``+- 1 %``."""
        lower, upper = self.range
        half = 0.5 * part * (upper - lower) * self._SCALE
        return f"+- {float(f'{half:.2g}'):g}{self._UNITS}"


class Relative(_Uncertain):
    """A quantity whose deviation is given in per cent of its value."""

    _UNITS: ClassVar[str] = " %"
    _SCALE: ClassVar[float] = 100.0
    _LIMITS: ClassVar[dict[str, float]] = {"above": -100.0}

    range: Annotated[tuple[float, float], _range("%", "+- 10 %", above=-100.0, most=1000.0)]
    """deviation from the study's value"""


class OfTemperature(_Uncertain):
    """A temperature that is not known exactly."""

    _UNITS: ClassVar[str] = " K"

    range: Annotated[tuple[float, float], _range("K", "+- 1 K", least=-50.0, most=50.0)]
    """deviation from the study's value"""


class OfExponent(_Uncertain):
    """A Hurst exponent that is not known exactly."""

    _LIMITS: ClassVar[dict[str, float]] = {"above": 0.0, "below": 1.0}

    range: Annotated[tuple[float, float], _range("", "0.6 to 0.8", above=0.0, below=1.0)]
    """least and greatest value"""


class OfSkewness(_Uncertain):
    """A skewness of heights that is not known exactly."""

    range: Annotated[tuple[float, float], _range("", "-0.2 to 0.2", least=-1.0, most=1.0)]
    """least and greatest value"""


class OfKurtosis(_Uncertain):
    """A kurtosis of heights that is not known exactly."""

    range: Annotated[tuple[float, float], _range("", "3 to 3.5", least=3.0, most=10.0)]
    """least and greatest value"""


_FORMULA = {"type": "string", "format": "text", "enum": list(FORMULAS)}
FilmFormula = Annotated[str, read_by(lambda name: formula(f"{name}").name, _FORMULA)]
"""Name of a film formula."""


Name = TypeVar("Name")


class Choice(StrictModel, Generic[Name]):
    """A choice of the model that may be made otherwise; all are equally likely."""

    choices: tuple[Name, ...] = Field(min_length=2)
    """the choices"""
    source: Text
    """why each of them may be right, or `assumed`"""

    @property
    def in_words(self) -> str:
        """The choices in words."""
        return ", ".join(self.choices)

    _each_once = field_validator("choices")(each_once)


class OfDefinition(Choice[Literal[tuple(DEFINITIONS)]]):
    """Definitions of the pressure-viscosity coefficient."""


class OfFormula(Choice[FilmFormula]):
    """Film formulas."""


class OfShape(Choice[FilmShape]):
    """Shapes of the film."""


class OfHeating(Choice[InletHeating]):
    """Models of the heating at the inlet."""


class OfDeformation(Choice[Literal["none", "computed"]]):
    """Deformations of the roughness."""


class OfContact(Choice[ContactModel]):
    """Contact of lines or of surfaces."""


@dataclass(frozen=True)
class Factor:
    """One factor.

    Attributes
    ----------
    name : str
        Key in the study's section ``uncertainty``.
    group : str
        ``oil``, ``conditions``, ``surface``, ``layer``, ``film`` or ``contact model``.
    given : _Uncertain or Choice
        Range or choices.
    """

    name: str
    group: str
    given: _Uncertain | Choice


def spoken(name: str) -> str:
    """Write the name of a factor, or of an operating variable, as in a text.

    Examples
    --------
    >>> spoken("young_modulus")
    "Young's modulus"
    """
    words = name.replace("_", " ").replace("pressure viscosity", "pressure-viscosity")
    words = words.replace("slide to roll", "slide-to-roll")
    return words.replace("hurst", "Hurst").replace("young", "Young's")


def _of(group, **unit):
    """Say to which group a field belongs, and the unit of the study's value if it is a quantity."""
    return Field(None, json_schema_extra={"group": group, **unit})


class Uncertainty(StrictModel):
    """Quantities and choices of the model that a study does not know exactly."""

    viscosity: Relative | None = _of("oil", unit="m^2/s")
    """viscosity of the oils"""
    pressure_viscosity_coefficient: Relative | None = _of("oil", unit="1/Pa")
    """pressure-viscosity coefficient of the oils"""
    pressure_viscosity_definition: OfDefinition | None = _of("oil")
    """definition of the coefficient where its source states none; a secant is to 200 MPa"""
    temperature: OfTemperature | None = _of("conditions", unit="degC")
    """temperature of the oil at the inlet"""
    force: Relative | None = _of("conditions", unit="N")
    """normal force"""
    speed: Relative | None = _of("conditions", unit="rpm")
    """speed of both rollers"""
    young_modulus: Relative | None = _of("conditions", unit="Pa")
    """Young's modulus of both rollers"""
    rms_roughness: Relative | None = _of("surface", unit="m")
    """rms height of the roughness of both rollers alike"""
    first_rms_roughness: Relative | None = _of("surface", unit="m")
    """rms height of the first roller's roughness"""
    second_rms_roughness: Relative | None = _of("surface", unit="m")
    """rms height of the second roller's roughness"""
    hurst_exponent: OfExponent | None = _of("surface", unit="")
    """Hurst exponent of both rollers"""
    longest_wavelength: Relative | None = _of("surface", unit="m")
    """longest wavelength of both rollers' roughness"""
    shortest_wavelength: Relative | None = _of("surface", unit="m")
    """shortest wavelength of both rollers' roughness"""
    skewness: OfSkewness | None = _of("surface", unit="")
    """skewness of the heights of both rollers"""
    kurtosis: OfKurtosis | None = _of("surface", unit="")
    """kurtosis of the heights of both rollers; at least that of lognormal heights as skewed"""
    critical_thickness: Relative | None = _of("layer", unit="m")
    """critical thickness of the boundary layer"""
    shear_strength: Relative | None = _of("layer", unit="Pa")
    """limiting shear stress of the boundary layer"""
    film_formula: OfFormula | None = _of("film")
    """film formula, of which the study takes its first"""
    film_shape: OfShape | None = _of("film")
    """shape of the film"""
    inlet_shear_heating: OfHeating | None = _of("film")
    """heating of the oil at the inlet"""
    roughness_deformation: OfDeformation | None = _of("film")
    """deformation of the roughness"""
    contact_model: OfContact | None = _of("contact model")
    """contact of the line, or of the surface that it stands for"""
    resistivity: Relative | None = _of("electrical", unit="ohm*m")
    """resistivity of the rollers' material, on which resistances depend, but no probability"""

    def factors(self) -> list[Factor]:
        """Return the factors of the probability that are given, in the order of the keys above."""
        fields = type(self).model_fields
        each = (Factor(name, fields[name].json_schema_extra["group"], one) for name, one in self)
        return [factor for factor in each if factor.given and factor.group != "electrical"]


BAND = "longest_wavelength", "shortest_wavelength"
"""Factors that are ends of the band of wavelengths."""
_EXTRAS = {name: field.json_schema_extra for name, field in Uncertainty.model_fields.items()}
UNITS = {name: extra["unit"] for name, extra in _EXTRAS.items() if "unit" in extra}
"""Unit of the study's value of each quantity, empty for a pure number."""
CHOICES = [name for name in _EXTRAS if name not in UNITS]
"""Factors that are choices, which cannot be measured."""


def deviating_lines(spec: LineSpec, values: Mapping[str, float]) -> LineSpec:
    """Return roughness lines whose parameters deviate.

    Parameters
    ----------
    spec : LineSpec
        The lines of the study.
    values : dict of str to float
        Deviations, and the Hurst exponent, by the keys of `Uncertainty`; others are ignored.

    Returns
    -------
    LineSpec
        The lines, on the same grid.
    """
    longer = 1.0 + values.get("longest_wavelength", 0.0)
    shorter = 1.0 + values.get("shortest_wavelength", 0.0)
    lines = []
    for line, height in zip(spec.lines, deviating_heights(spec, values), strict=True):
        q_min = line.q_min / longer
        update = {
            "rms_height": height,
            "q_min": q_min,
            "q_roll_off": max(line.q_roll_off, q_min) if line.has_roll_off else q_min,
            "q_max": line.q_max / shorter,
            "hurst_exponent": values.get("hurst_exponent", line.hurst_exponent),
        }
        lines.append(line.model_copy(update=update))
    return spec.model_copy(update={"lines": tuple(lines)})


def deviating_heights(spec: LineSpec, values: Mapping[str, Values]) -> tuple[Values, Values]:
    """Rms height of each line whose parameters deviate, m.

    Parameters
    ----------
    spec : LineSpec
        The lines of the study.
    values : dict of str to float or xarray.DataArray
        As in `deviating_lines`.

    Returns
    -------
    tuple of float or xarray.DataArray
        The heights.
    """
    higher = 1.0 + values.get("rms_roughness", 0.0)
    own = (1.0 + values.get(f"{name}_rms_roughness", 0.0) for name in ROLLERS)
    each = zip(spec.lines, own, strict=True)
    return tuple(line.rms_height * higher * one * _in_band(line, values) for line, one in each)


def _in_band(line, values):
    """Rms height of a line whose band deviates, over that of the line.

    It is 1 unless the height was stated for waves within cutoffs.
    """
    cutoffs = line.long_cutoff, line.short_cutoff
    roll_off = 2.0 * math.pi / line.q_roll_off if line.has_roll_off else None

    def beyond(values):
        longest = 2.0 * math.pi / line.q_min * (1.0 + values.get("longest_wavelength", 0.0))
        shortest = line.shortest_wavelength * (1.0 + values.get("shortest_wavelength", 0.0))
        hurst = values.get("hurst_exponent", line.hurst_exponent)
        return beyond_cutoffs(hurst, longest, shortest, cutoffs, roll_off)

    return beyond(values) / beyond({})


def check_uncertainty(study) -> None:
    """Refuse ranges and choices for which the model has no answer.

    Parameters
    ----------
    study : Study
        A study with the section ``uncertainty``.

    Raises
    ------
    LubeError
        Which key, what came, and what is needed.
    """
    uncertain, spec = study.uncertainty, study.line_spec
    if study.load_sharing != "none":
        raise StudyError(
            f"load_sharing: got {study.load_sharing}, need none: probabilities of random values "
            "are sampled without the load that asperities carry"
        )
    if uncertain.temperature:
        _check_temperatures(study, uncertain.temperature.ends)
    for force in _extreme_forces(study):
        study.check_window(force, _ranges(uncertain, "force", "young_modulus"))
    for name in ("hurst_exponent", *BAND):
        if getattr(uncertain, name) and not all(line.hurst_exponent for line in spec.lines):
            came = "got a range for lines whose spectrum and height are measured"
            raise StudyError(f"{name}: {came}, need none")
    if uncertain.resistivity and not study.conducts:
        raise StudyError("resistivity: got a range for an insulator, need none")
    if uncertain.pressure_viscosity_definition:
        for record in study.lubricants:
            if record.pressure_viscosity.gold_base is None:
                came = f"choices, but {record.name} states the definition of its coefficient"
                raise StudyError(f"pressure_viscosity_definition: got {came}, need none")
    if uncertain.inlet_shear_heating:
        study.check_conductivity("got choices, need")
    _check_bands(study)


def _extreme_forces(study):
    """Find the forces at which contact of the rollers as given is narrowest and widest."""
    uncertain, forces = study.uncertainty, study.operating_grid.force
    given = uncertain.force, uncertain.young_modulus
    force, modulus = (one.ends if one else (0.0, 0.0) for one in given)
    # Contact of softer rollers is as wide as at a force greater in proportion.
    least, greatest = 1.0 + force[0], 1.0 + force[1]
    return min(forces) * least / (1.0 + modulus[1]), max(forces) * greatest / (1.0 + modulus[0])


def _ranges(uncertain, *names):
    """Name those of some ranges that are given."""
    return ", ".join(f"{name}.range" for name in names if getattr(uncertain, name))


def _check_temperatures(study, ends):
    levels = study.operating_grid.temperature
    for record in study.lubricants:
        coldest, hottest = record.valid_temperatures
        for level, end in ((min(levels), ends[0]), (max(levels), ends[1])):
            if not coldest - BEYOND <= level + end <= hottest + BEYOND:
                needed = f"{coldest - BEYOND:g} to {hottest + BEYOND:g} degC for {record.name}"
                raise StudyError(f"temperature.range: got {level + end:g} degC, need {needed}")


def _check_bands(study):
    """Refuse bands of wavelengths that the grid of lines or surfaces cannot have."""
    uncertain, spec = study.uncertainty, study.line_spec
    given = (getattr(uncertain, name) for name in BAND)
    long, short = (one.ends if one else (0.0, 0.0) for one in given)
    narrow = deviating_lines(spec, {"longest_wavelength": long[0], "shortest_wavelength": short[1]})
    wide = deviating_lines(spec, {"longest_wavelength": long[1], "shortest_wavelength": short[0]})
    shorter = min(line.longest_wavelength for line in narrow.lines)
    longer = max(line.shortest_wavelength for line in narrow.lines)
    if longer >= shorter:
        came = f"got up to {with_unit(longer, 'm', 3)}"
        needed = f"need less than the longest wavelength, {with_unit(shorter, 'm', 3)}"
        raise StudyError(f"shortest_wavelength.range: {came}, {needed}")
    least = 2.0 * math.pi / wide.q_max
    if least < 2.0 * spec.spacing:
        came = f"got down to {with_unit(least, 'm', 3)}"
        needed = f"need two points of the grid or more, {with_unit(2.0 * spec.spacing, 'm', 3)}"
        raise StudyError(f"shortest_wavelength.range: {came}, {needed}")
    models = uncertain.contact_model.choices if uncertain.contact_model else study.contact_model
    if "line" in models:
        spec.check_follows_rolling()
    if "surface" in models:
        with located(_ranges(uncertain, "force", "young_modulus", *BAND) or "contact_model"):
            study.check_surfaces(wide, max(_extreme_forces(study)))
