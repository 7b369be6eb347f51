"""Rollers, their roughness and the boundary layer.

Written in YAML with units, kept in SI. A notebook makes them in the same way:
``Roller(radius="50 mm", ...)``.
"""

import math
from typing import Annotated

import numpy as np
from pydantic import Field, PlainSerializer, StrictInt, model_validator

from lube.errors import LubeError, StudyError
from lube.physics.hertz import contact_half_width, reduced_modulus, reduced_radius
from lube.study.field_types import (
    Length,
    Pressure,
    StrictModel,
    bounded,
    length_or_words,
    pure_number,
)
from lube.study.roller_topography import MeasuredHeights, RollerTopography
from lube.study.size_limits import MOST_POINTS
from lube.units import parse_number

ROLLERS = ("first", "second")
"""Keys of the two rollers."""
AUTOMATIC_WAVELENGTH = "contact width at the largest force"


def _is_points(value):
    return isinstance(value, str) and value.endswith(" points") and bool(_points_of(value))


def _points_of(wavelength):
    """``"10 points"`` -> 10.0; a wave has at least two."""
    number = parse_number(wavelength.removesuffix(" points"))
    return bounded(number, "points", least=2.0, most=MOST_POINTS)


_LongestWavelength = length_or_words(
    lambda text: text == AUTOMATIC_WAVELENGTH,
    f"the words `{AUTOMATIC_WAVELENGTH}`",
    f"^{AUTOMATIC_WAVELENGTH}$",
)
_ShortestWavelength = length_or_words(
    _is_points, "a number of grid points such as `10 points`", " points$"
)
_Hurst = pure_number(above=0.0, below=1.0)
_Skewness = pure_number(least=-3.0, most=3.0)
_Kurtosis = pure_number(above=1.0, most=20.0)


class OwnRoughness(StrictModel):
    """What one roller has in place of the values of the study's section `roughness`."""

    hurst_exponent: _Hurst | None = None
    """Hurst exponent H"""
    longest_wavelength: _LongestWavelength | None = None
    """2 pi / q_min"""
    shortest_wavelength: _ShortestWavelength | None = None
    """2 pi / q_max"""
    roll_off_wavelength: Length | None = None
    """2 pi / q_r"""
    skewness: _Skewness | None = None
    """skewness of the heights"""
    kurtosis: _Kurtosis | None = None
    """kurtosis of the heights"""


RA_TO_RMS = math.sqrt(math.pi / 2.0)
"""Rms height over the mean absolute height Ra, of Gaussian heights."""


class Roller(StrictModel):
    """One roller: a cylinder of some material with a rough surface."""

    radius: Length
    """radius of the cylinder"""
    young_modulus: Pressure
    """Young's modulus"""
    poisson_ratio: pure_number(least=0.0, most=0.5)
    """Poisson's ratio"""
    rms_roughness: Length | None = None
    """rms height Rq of the roughness"""
    ra_roughness: Length | None = None
    """mean absolute height Ra, in place of the rms height, which is taken as Ra (pi / 2)^0.5"""
    roughness: OwnRoughness | None = None
    topography: RollerTopography | None = None

    @property
    def rms_height(self) -> float | None:
        """Rms height of the roughness, m.

        None if it is measured, or only that of both rollers together is known.
        """
        return RA_TO_RMS * self.ra_roughness if self.ra_roughness else self.rms_roughness

    @model_validator(mode="after")
    def _check_roughness(self):
        if self.rms_roughness and self.ra_roughness:
            raise ValueError(
                f"ra_roughness: got {self.ra_roughness:g} m beside an rms_roughness of "
                f"{self.rms_roughness:g} m, need one of the two"
            )
        if self.topography and self.rms_height:
            raise ValueError(
                f"topography: got {self.topography.file} beside a roughness of "
                f"{self.rms_height:.3g} m rms, need one of the two"
            )
        for name in ("hurst_exponent", "roll_off_wavelength"):
            if self.topography and self.roughness and getattr(self.roughness, name):
                raise ValueError(
                    f"roughness.{name}: got {getattr(self.roughness, name):g} beside a topography, "
                    "whose spectrum has its own, need one of the two"
                )
        return self


class RollerPair(StrictModel):
    """Two rollers in line contact."""

    length: Length
    """length L' of the line contact"""
    first: Roller
    second: Roller
    composite: Length | None = Field(None, alias="composite_rms_roughness")
    """rms height of both rough surfaces together, in place of one of each roller, which is taken
    as this / 2^0.5
    """

    @property
    def reduced_radius(self) -> float:
        """Radius R* of the equivalent cylinder on a plane, m."""
        return reduced_radius(self.first.radius, self.second.radius)

    @property
    def reduced_modulus(self) -> float:
        """Reduced modulus E*, Pa."""
        one, other = self.first, self.second
        return reduced_modulus(
            one.young_modulus, one.poisson_ratio, other.young_modulus, other.poisson_ratio
        )

    @property
    def rms_heights(self) -> tuple[float, float]:
        """Rms height of the roughness of either roller, m."""
        if self.composite is None:
            return self.first.rms_height, self.second.rms_height
        return self.composite / math.sqrt(2.0), self.composite / math.sqrt(2.0)

    def with_lines(self, spec: "LineSpec") -> "RollerPair":
        """Return the same rollers, each measured one with the rms height of its line."""
        changed = {}
        for name, line in zip(ROLLERS, spec.lines, strict=True):
            roller = getattr(self, name)
            if roller.topography:
                known = {"topography": None, "rms_roughness": line.rms_height}
                changed[name] = roller.model_copy(update=known)
        return self.model_copy(update=changed)

    @property
    def composite_rms_roughness(self) -> float:
        r"""Composite roughness :math:`(\sigma_1^2 + \sigma_2^2)^{1/2}` of independent lines, m."""
        return math.hypot(*self.rms_heights)

    def contact_half_width(self, force: float | np.ndarray) -> float | np.ndarray:
        """Hertzian half-width a, m, at a normal force, N (the paper's Eq. 2)."""
        return contact_half_width(force, self.length, self.reduced_radius, self.reduced_modulus)

    @model_validator(mode="after")
    def _check_roughness(self):
        for name in ROLLERS:
            roller = getattr(self, name)
            rms = roller.rms_height
            if rms is None and self.composite is None and not roller.topography:
                raise ValueError(
                    f"{name}.rms_roughness: missing, need it, or ra_roughness, or a topography, or "
                    "composite_rms_roughness of both rollers"
                )
            if roller.topography and self.composite is not None:
                raise ValueError(
                    f"composite_rms_roughness: got {self.composite:g} m beside a topography of the "
                    f"{name} roller, need one of the two"
                )
            if rms is not None and self.composite is not None:
                raise ValueError(
                    f"composite_rms_roughness: got {self.composite:g} m beside a roughness of the "
                    f"{name} roller, {rms:.3g} m rms, need one of the two"
                )
        return self


class Roughness(StrictModel):
    """Statistics and grid of the random roughness lines of both rollers."""

    points: Annotated[StrictInt, Field(ge=64, le=MOST_POINTS)]
    """points N around the first roller"""
    hurst_exponent: _Hurst
    """Hurst exponent H"""
    longest_wavelength: _LongestWavelength
    """2 pi / q_min; with the automatic choice a larger force level redraws all lines and changes
    the probability at all points: adding 3200 N to the paper's study multiplies it by 0.86 to
    0.61
    """
    shortest_wavelength: _ShortestWavelength
    """2 pi / q_max; the break-up of the boundary layer depends on it"""
    roll_off_wavelength: Length | None = None
    """2 pi / q_r: longer waves have the spectral density of the isotropic surface at q_r; by
    default there is no roll-off
    """
    skewness: _Skewness = 0.0
    """skewness of the heights, 0 for Gaussian heights; negative where peaks are worn"""
    kurtosis: _Kurtosis = 3.0
    """kurtosis of the heights, 3 for Gaussian heights; at least 1.5 plus 1.25 times the skewness
    squared
    """
    height_step: Length
    """heights and films are whole multiples of this length, so sums are exact"""

    def of(self, own: OwnRoughness | None) -> "Roughness":
        """Return the roughness of one roller, which may have values of its own."""
        given = {name: value for name, value in own or () if value is not None}
        return self.model_copy(update=given)

    def wavelengths(self, contact_width: float, spacing: float) -> tuple[float, float]:
        """Longest and shortest wavelength, m, at the largest contact width and a grid spacing."""
        longest, shortest = self.longest_wavelength, self.shortest_wavelength
        return (
            contact_width if longest == AUTOMATIC_WAVELENGTH else longest,
            _points_of(shortest) * spacing if isinstance(shortest, str) else shortest,
        )


class BoundaryLayer(StrictModel):
    """Boundary layer on the rollers; metal contact is where it breaks.

    Equations 4 and 6 of the paper.
    """

    critical_thickness: Length
    """critical thickness h_c"""
    shear_strength: Pressure
    """limiting shear stress tau0"""


_Heights = Annotated[MeasuredHeights, PlainSerializer(lambda heights: heights.sha256)]


class RoughLine(StrictModel, arbitrary_types_allowed=True):
    """Everything that determines the roughness line of one roller, except seed and realisation.

    Attributes
    ----------
    points : int
        Points N around the roller.
    rms_height : float
        Rms height, m.
    hurst_exponent : float
        Hurst exponent H of C1D ~ q^(-2H - 1); None if the line has a measured spectrum or heights.
    q_min, q_max : float
        Smallest and largest wave number, rad/m.
    q_roll_off : float
        Wave number below which C1D ~ q, rad/m; by default `q_min`: nowhere.
    skewness, kurtosis : float
        Of the heights; by default 0 and 3: Gaussian.
    spectrum : tuple of tuple of float, optional
        Measured spectrum: wave vectors, rad/m, and densities, m^3, between which it is a power law.
    heights : MeasuredHeights, optional
        Measured heights of the line itself.
    isotropic : bool
        Whether the line stands for an isotropic surface; by default it does.
    """

    points: int
    rms_height: float
    hurst_exponent: float | None = None
    q_min: float
    q_max: float
    q_roll_off: float = Field(default_factory=lambda given: given["q_min"])
    skewness: float = 0.0
    kurtosis: float = 3.0
    spectrum: tuple[tuple[float, ...], tuple[float, ...]] | None = None
    heights: _Heights | None = None
    isotropic: bool = True

    @property
    def is_gaussian(self) -> bool:
        """Whether the line is drawn, with Gaussian heights."""
        return (self.skewness, self.kurtosis, self.heights) == (0.0, 3.0, None)


class LineSpec(StrictModel):
    """Everything that determines the roughness lines, except seed and realisation.

    Attributes
    ----------
    lines : tuple of RoughLine
        Line of either roller.
    spacing : float
        Distance dx of neighbouring points, m.
    height_step : float
        Height of one step of the whole-number heights, m.
    """

    lines: tuple[RoughLine, RoughLine]
    spacing: float
    height_step: float

    @property
    def points(self) -> tuple[int, int]:
        """Points around either roller."""
        return tuple(line.points for line in self.lines)

    @property
    def rms_height(self) -> tuple[float, float]:
        """Rms height of either line, m."""
        return tuple(line.rms_height for line in self.lines)

    @property
    def is_gaussian(self) -> bool:
        """Whether both lines are drawn, with Gaussian heights."""
        return all(line.is_gaussian for line in self.lines)

    @property
    def is_drawn(self) -> bool:
        """Whether both lines are drawn."""
        return all(line.heights is None for line in self.lines)

    @property
    def is_one_pair(self) -> bool:
        """Whether both lines are measured profiles, so that there is no ensemble."""
        return all(line.heights is not None for line in self.lines)

    @property
    def q_min(self) -> float:
        """Smallest wave number of both lines, rad/m."""
        return min(line.q_min for line in self.lines)

    @property
    def q_max(self) -> float:
        """Largest wave number of both lines, rad/m."""
        return max(line.q_max for line in self.lines)


def line_spec(rollers: RollerPair, roughness: Roughness, largest_force: float) -> LineSpec:
    """Determine the roughness lines of a pair of rollers.

    Parameters
    ----------
    rollers : RollerPair
        The rollers.
    roughness : Roughness
        Statistics and grid of their lines, where a roller has none of its own.
    largest_force : float
        Largest force of the study, N; its contact width may set the longest wavelength.

    Returns
    -------
    LineSpec
        Everything that determines the lines, except seed and realisation.

    Raises
    ------
    StudyError
        If the grid is too coarse for a shortest wavelength, a perimeter too short for a
        longest, the height step unsuitable for the roughness, or the kurtosis too small for
        the skewness.
    """
    spacing = 2.0 * math.pi * rollers.first.radius / roughness.points
    width = 2.0 * float(rollers.contact_half_width(largest_force))
    lines = tuple(
        _rough_line(rollers, roughness, name, rms, (spacing, width))
        for name, rms in zip(ROLLERS, rollers.rms_heights, strict=True)
    )
    return LineSpec(lines=lines, spacing=spacing, height_step=roughness.height_step)


def _rough_line(rollers, roughness, name, rms, lengths):
    """Line of one roller, at a grid spacing and the largest contact width."""
    spacing, width = lengths
    roller = getattr(rollers, name)
    own, key = roughness.of(roller.roughness), _Keys(name, roller.roughness)
    longest, shortest = own.wavelengths(width, spacing)
    points = round(roughness.points * roller.radius / rollers.first.radius)
    if roller.topography and roller.topography.is_line:
        longest = roller.topography.long_cutoff or points * spacing
    roll_off = own.roll_off_wavelength
    if roller.topography or roll_off is None:
        roll_off = longest
    _check_band(longest, shortest, roughness.points, spacing, key)
    _check_roll_off(longest, shortest, roll_off, key)
    _check_perimeter(points * spacing, longest, shortest, name)
    _check_distribution(own, key)
    if roller.topography:
        try:
            grid = points, spacing, (longest, shortest)
            shape = roller.topography.line(grid, width, roughness.height_step)
            shape["isotropic"] = roller.topography.texture == "isotropic"
        except LubeError as error:
            raise StudyError(f"rollers.{name}.topography: {error}") from None
    else:
        shape = {"rms_height": rms, "hurst_exponent": own.hurst_exponent}
    _check_height_step(shape["rms_height"], roughness.height_step)
    return RoughLine(
        points=points,
        q_min=2.0 * math.pi / longest,
        q_max=2.0 * math.pi / shortest,
        q_roll_off=2.0 * math.pi / roll_off,
        skewness=own.skewness,
        kurtosis=own.kurtosis,
        **shape,
    )


def check_width(spec: LineSpec, width: float, what: str) -> None:
    """Refuse a contact that is finer than the grid or wider than a roller's perimeter.

    Parameters
    ----------
    spec : LineSpec
        The roughness lines.
    width : float
        Width of the contact, m.
    what : str
        What is so wide, for the message.

    Raises
    ------
    StudyError
        With the contact width, and what is needed.
    """
    least, most = 2.0 * spec.spacing, min(spec.points) * spec.spacing
    if not least <= width < most:
        raise StudyError(
            f"{what} is {width:.3g} m wide, need at least two grid spacings of {least:.3g} m, and "
            f"less than a perimeter, {most:.3g} m"
        )


class _Keys:
    """Key of a value of a roller's roughness: its own, or else that of the study."""

    def __init__(self, roller, own):
        self._roller, self._own = roller, dict(own or ())

    def __call__(self, name):
        own = self._own.get(name) is not None
        return f"rollers.{self._roller}.roughness.{name}" if own else f"roughness.{name}"


def _check_band(longest, shortest, points, spacing, key):
    if shortest < 2.0 * spacing * (1.0 - 1e-9):
        raise StudyError(
            f"roughness.points: got {points}, too coarse a grid: its spacing is "
            f"{spacing:.3g} m, need at most half the shortest wavelength, {shortest:.3g} m"
        )
    if shortest >= longest:
        least = math.ceil(points * shortest / longest) + 1
        raise StudyError(
            f"{key('shortest_wavelength')}: got {shortest:.3g} m, need less than the longest, "
            f"{longest:.3g} m; if it is given in points, need {least} roughness.points or more"
        )


def _check_roll_off(longest, shortest, roll_off, key):
    if not shortest * (1.0 - 1e-9) <= roll_off <= longest * (1.0 + 1e-9):
        raise StudyError(
            f"{key('roll_off_wavelength')}: got {roll_off:.3g} m, need one from the shortest to "
            f"the longest wavelength, {shortest:.3g} to {longest:.3g} m"
        )


def _check_perimeter(perimeter, longest, shortest, roller):
    if perimeter < longest or math.ceil(perimeter / longest) > math.floor(perimeter / shortest):
        raise StudyError(
            f"rollers.{roller}.radius: the perimeter, {perimeter:.3g} m, is too short, need a "
            f"whole number of waves between {shortest:.3g} and {longest:.3g} m long around it"
        )


def _check_height_step(rms, step):
    """Rms heights must be many height steps, and peaks must fit a 32-bit integer."""
    if not 1e3 <= rms / step <= 1e7:
        raise StudyError(
            f"roughness.height_step: got {step:.3g} m, need {rms / 1e7:.3g} "
            f"to {rms / 1e3:.3g} m for a roughness of {rms:.3g} m"
        )


def _check_distribution(own, key):
    """Close to the least kurtosis the heights are two levels, whose spectrum cannot be chosen."""
    square = own.skewness**2
    least = 1.5 + 1.25 * square
    if own.kurtosis < least:
        raise StudyError(
            f"{key('kurtosis')}: got {own.kurtosis:g} with a skewness of {own.skewness:g}, need at "
            f"least {least:g}: none is below {square + 1.0:g}, the skewness squared plus one, and "
            "close to it the spectrum cannot be kept"
        )
