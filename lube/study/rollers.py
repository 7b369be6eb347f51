"""Rollers, their roughness and the boundary layer.

Written in YAML with units, kept in SI. A notebook makes them in the same way:
``Roller(radius="50 mm", ...)``.
"""

import math
from typing import Annotated

import numpy as np
from pydantic import Field, StrictInt

from lube.errors import StudyError
from lube.physics.hertz import contact_half_width, reduced_modulus, reduced_radius
from lube.study.field_types import (
    Length,
    Pressure,
    StrictModel,
    bounded,
    length_or_words,
    pure_number,
)
from lube.study.size_limits import MOST_POINTS
from lube.units import parse_number

AUTOMATIC_WAVELENGTH = "contact width at the largest force"


class Roller(StrictModel):
    """One roller: a cylinder of some material with a rough surface."""

    radius: Length
    """radius of the cylinder"""
    young_modulus: Pressure
    """Young's modulus"""
    poisson_ratio: pure_number(least=0.0, most=0.5)
    """Poisson's ratio"""
    rms_roughness: Length
    """rms height of the roughness"""


class RollerPair(StrictModel):
    """Two rollers in line contact."""

    length: Length
    """length L' of the line contact"""
    first: Roller
    second: Roller

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
    def composite_rms_roughness(self) -> float:
        r"""Composite roughness :math:`(\sigma_1^2 + \sigma_2^2)^{1/2}` of independent lines, m."""
        return math.hypot(self.first.rms_roughness, self.second.rms_roughness)

    def contact_half_width(self, force: float | np.ndarray) -> float | np.ndarray:
        """Hertzian half-width a, m, at a normal force, N (the paper's Eq. 2)."""
        return contact_half_width(force, self.length, self.reduced_radius, self.reduced_modulus)


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


class Roughness(StrictModel):
    """Statistics and grid of the random roughness lines of both rollers."""

    points: Annotated[StrictInt, Field(ge=64, le=MOST_POINTS)]
    """points N around the first roller"""
    hurst_exponent: pure_number(above=0.0, below=1.0)
    """Hurst exponent H"""
    longest_wavelength: _LongestWavelength
    """2 pi / q_min; with the automatic choice a larger force level redraws all lines and changes
    the probability at all points: adding 3200 N to the paper's study multiplies it by 0.86 to
    0.61
    """
    shortest_wavelength: _ShortestWavelength
    """2 pi / q_max; the break-up of the boundary layer depends on it"""
    height_step: Length
    """heights and films are whole multiples of this length, so sums are exact"""


class BoundaryLayer(StrictModel):
    """Boundary layer on the rollers; metal contact is where it breaks.

    Equations 4 and 6 of the paper.
    """

    critical_thickness: Length
    """critical thickness h_c"""
    shear_strength: Pressure
    """limiting shear stress tau0"""


class LineSpec(StrictModel):
    """Everything that determines the roughness lines, except seed and realisation.

    Attributes
    ----------
    points : tuple of int
        Points around either roller.
    spacing : float
        Distance dx of neighbouring points, m.
    rms_height : tuple of float
        Rms height of either line, m.
    hurst_exponent : float
        Hurst exponent H of C1D ~ q^(-2H - 1).
    q_min, q_max : float
        Smallest and largest wave number, rad/m.
    height_step : float
        Height of one step of the whole-number heights, m.
    """

    points: tuple[int, int]
    spacing: float
    rms_height: tuple[float, float]
    hurst_exponent: float
    q_min: float
    q_max: float
    height_step: float


def line_spec(rollers: RollerPair, roughness: Roughness, largest_force: float) -> LineSpec:
    """Determine the roughness lines of a pair of rollers.

    Parameters
    ----------
    rollers : RollerPair
        The rollers.
    roughness : Roughness
        Statistics and grid of their lines.
    largest_force : float
        Largest force of the study, N; its contact width may set the longest wavelength.

    Returns
    -------
    LineSpec
        Everything that determines the lines, except seed and realisation.

    Raises
    ------
    StudyError
        If the grid is too coarse for the shortest wavelength, a perimeter too short for the
        longest, or the height step unsuitable for the roughness.
    """
    first, second = rollers.first, rollers.second
    spacing = 2.0 * math.pi * first.radius / roughness.points
    longest = roughness.longest_wavelength
    if longest == AUTOMATIC_WAVELENGTH:
        longest = 2.0 * float(rollers.contact_half_width(largest_force))
    shortest = roughness.shortest_wavelength
    if isinstance(shortest, str):
        shortest = _points_of(shortest) * spacing
    spec = LineSpec(
        points=(roughness.points, round(roughness.points * second.radius / first.radius)),
        spacing=spacing,
        rms_height=(first.rms_roughness, second.rms_roughness),
        hurst_exponent=roughness.hurst_exponent,
        q_min=2.0 * math.pi / longest,
        q_max=2.0 * math.pi / shortest,
        height_step=roughness.height_step,
    )
    _check_waves(spec, longest, shortest)
    _check_height_step(spec)
    return spec


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


def _check_waves(spec, longest, shortest):
    if shortest < 2.0 * spec.spacing * (1.0 - 1e-9):
        raise StudyError(
            f"roughness.points: got {spec.points[0]}, too coarse a grid: its spacing is "
            f"{spec.spacing:.3g} m, need at most half the shortest wavelength, {shortest:.3g} m"
        )
    if shortest >= longest:
        least = math.ceil(spec.points[0] * shortest / longest) + 1
        raise StudyError(
            f"roughness.shortest_wavelength: got {shortest:.3g} m, need less than the longest, "
            f"{longest:.3g} m; if it is given in points, need {least} roughness.points or more"
        )
    for roller, points in zip(("first", "second"), spec.points, strict=True):
        perimeter = points * spec.spacing
        if perimeter < longest or math.ceil(perimeter / longest) > math.floor(perimeter / shortest):
            raise StudyError(
                f"rollers.{roller}.radius: the perimeter, {perimeter:.3g} m, is too short, need a "
                f"whole number of waves between {shortest:.3g} and {longest:.3g} m long around it"
            )


def _check_height_step(spec):
    """Rms heights must be many height steps, and peaks must fit a 32-bit integer."""
    for rms in spec.rms_height:
        if not 1e3 <= rms / spec.height_step <= 1e7:
            raise StudyError(
                f"roughness.height_step: got {spec.height_step:.3g} m, need {rms / 1e7:.3g} "
                f"to {rms / 1e3:.3g} m for a roughness of {rms:.3g} m"
            )
