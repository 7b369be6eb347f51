"""Rollers, their roughness and the boundary layer.

Written in YAML with units, kept in SI. A notebook makes them in the same way:
``Roller(radius="50 mm", ...)``.
"""

import math
from typing import Annotated, Any

import numpy as np
from pydantic import Field, StrictInt, model_validator

from lube.physics.hertz import contact_half_width, reduced_modulus, reduced_radius
from lube.study.field_types import Length, StrictModel, bounded, quantity, quantity_or_words
from lube.study.roller_topography import RollerTopography
from lube.study.size_limits import LEAST_POINTS, MOST_POINTS
from lube.types import Values
from lube.units import parse_number

ROLLERS = ("first", "second")
"""Keys of the two rollers."""
ROUGHNESS_KEYS = ("rms_roughness", "ra_roughness", "topography")
"""Keys that give a roller's roughness; a roller has at most one of them."""
_OF_SPECTRUM = (
    "hurst_exponent roll_off_wavelength long_cutoff short_cutoff lay_ratio lay_angle"
).split()
"""Keys of its section `roughness` that a measured spectrum replaces."""
INSULATOR = "insulator"
"""Resistivity of rollers if either does not conduct."""

AUTOMATIC_WAVELENGTH = "contact width at the largest force"

LONGEST_WAVELENGTH = "0.8 mm"
"""Default longest wavelength: the cutoff of ISO 4288 and ISO 21920-3 for an Ra from 0.1 to 2 um,
so that the lines have an Ra or Rq as it is customarily measured."""

SHORTEST_WAVELENGTH = "3.1416 um"
"""Default shortest wavelength: the paper's."""

_POINTS_PER_WAVE = 10  # of the shortest waves, as in the paper


def grid_points(radius: float, shortest: float) -> int:
    """Return a number of points around a roller with at least ten in the shortest wavelength.

    Parameters
    ----------
    radius, shortest : float
        Radius of the roller and shortest wavelength, m.

    Returns
    -------
    int
        A number with small prime factors, for which Fourier transforms are fast.

    Examples
    --------
    >>> grid_points(0.05, 3.1416e-6)
    1000000
    """
    import scipy.fft  # not needed to load a study

    points = math.ceil(2.0 * math.pi * radius / shortest * _POINTS_PER_WAVE)
    return scipy.fft.next_fast_len(points, real=True)


def _points_of(wavelength):
    """``"10 points"`` -> 10.0; a wave has at least two."""
    number = parse_number(wavelength.removesuffix(" points"))
    return bounded(number, "points", least=2.0, most=MOST_POINTS)


_LongestWavelength = Annotated[
    float | str,
    quantity_or_words("m", f"the words `{AUTOMATIC_WAVELENGTH}`", f"^{AUTOMATIC_WAVELENGTH}$"),
]
_ShortestWavelength = Annotated[
    float | str, quantity_or_words("m", "a number of grid points such as `10 points`", " points$")
]
_Skewness = Annotated[float, quantity(None, least=-3.0, most=3.0)]
_Kurtosis = Annotated[float, quantity(None, above=1.0, most=20.0)]
_Stress = Annotated[float, quantity("Pa", above=0.0)]
_LayRatio = Annotated[float, quantity(None, least=1.0, most=1e4)]


class OwnRoughness(StrictModel):
    """Values of one roller that override those of the study's section `roughness`."""

    hurst_exponent: Annotated[float, quantity(None, above=0.0, below=1.0)] | None = None
    """Hurst exponent H; a measured surface needs none"""
    longest_wavelength: _LongestWavelength | None = None
    """longest wavelength of the line, 2 pi / q_min"""
    shortest_wavelength: _ShortestWavelength | None = None
    """shortest wavelength of the line, 2 pi / q_max"""
    roll_off_wavelength: Length | None = None
    """wavelength 2 pi / q_r beyond which the spectral density of the isotropic surface is constant;
    by default there is no roll-off
    """
    long_cutoff: Length | None = None
    """cutoff lambda_c of the measurement: the stated rms height is that of the waves up to this
    length, and longer waves add to it; by default the longest wavelength
    """
    short_cutoff: Length | None = None
    """cutoff lambda_s of the measurement: the stated rms height is that of the waves down to this
    length, and shorter waves add to it; by default the shortest wavelength
    """
    lay_ratio: _LayRatio | None = None
    """how many times longer than wide the ridges of the surface are, 1 for an isotropic surface;
    wavelengths, cutoffs and Hurst exponent are those across the ridges
    """
    lay_angle: Annotated[float, quantity("deg", least=-90.0, most=90.0)] | None = None
    """angle between the ridges and rolling: 0 deg along rolling, as on a ground roller, 90 deg
    across; seen from the same side for both rollers
    """
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
    young_modulus: _Stress
    """Young's modulus"""
    poisson_ratio: Annotated[float, quantity(None, least=0.0, most=0.5)]
    """Poisson's ratio"""
    rms_roughness: Length | None = None
    """rms height Rq of the roughness"""
    ra_roughness: Length | None = None
    """mean absolute height Ra, in place of the rms height, which is taken as Ra (pi / 2)^0.5"""
    roughness: OwnRoughness | None = None
    topography: RollerTopography | None = None

    @property
    def kinds(self) -> list[str]:
        """Keys of its roughness that are given: one, or none if only the composite is known."""
        return self.given_keys(ROUGHNESS_KEYS)

    @property
    def rms_height(self) -> float | None:
        """Rms height of the roughness, m.

        None if it is measured, or only the composite roughness is known.
        """
        return RA_TO_RMS * self.ra_roughness if self.ra_roughness else self.rms_roughness

    @model_validator(mode="after")
    def _check_roughness(self):
        if len(self.kinds) > 1:
            one, other, *_ = self.kinds
            raise ValueError(f"{other}: got one together with {one}, need one of the two")
        if self.topography and self.roughness:
            for name in self.roughness.given_keys(_OF_SPECTRUM):
                raise ValueError(
                    f"roughness.{name}: got {getattr(self.roughness, name):g} together with a "
                    "topography, whose spectrum replaces it, need one of the two"
                )
        return self


class RollerPair(StrictModel):
    """Two rollers in line contact."""

    length: Length
    """length L' of the line contact"""
    first: Roller
    second: Roller
    composite: Length | None = Field(None, alias="composite_rms_roughness")
    """rms height of both rough surfaces together, in place of one for each roller; each roller
    then has this value / 2^0.5
    """

    @property
    def geometry(self) -> dict[str, Any]:
        """Length, radii and elastic constants, as plain data."""
        names = {"radius", "young_modulus", "poisson_ratio"}
        return self.model_dump(include={"length": True, "first": names, "second": names})

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
        """Rms height of the roughness of each roller, m."""
        if self.composite is None:
            return self.first.rms_height, self.second.rms_height
        return self.composite / math.sqrt(2.0), self.composite / math.sqrt(2.0)

    def with_rms_heights(self, rms_heights: tuple[float, float]) -> "RollerPair":
        """Return the same rollers with the rms heights, m, of their lines."""
        if rms_heights == self.rms_heights:
            return self
        changed = {"composite": None}
        for name, rms in zip(ROLLERS, rms_heights, strict=True):
            known = {"topography": None, "ra_roughness": None, "rms_roughness": rms}
            changed[name] = getattr(self, name).model_copy(update=known)
        return self.model_copy(update=changed)

    def with_radii(self, first: Values, second: Values) -> "RollerPair":
        """Return the same rollers with other radii, m, also with several of each."""
        one = self.first.model_copy(update={"radius": first})
        other = self.second.model_copy(update={"radius": second})
        return self.model_copy(update={"first": one, "second": other})

    @property
    def composite_rms_roughness(self) -> float:
        r"""Composite roughness :math:`(\sigma_1^2 + \sigma_2^2)^{1/2}` of independent lines, m."""
        return math.hypot(*self.rms_heights)

    @property
    def mean_ra_roughness(self) -> float:
        """Mean of the two Ra of the lines, m, as if their heights were Gaussian."""
        return sum(self.rms_heights) / 2.0 / RA_TO_RMS

    def contact_half_width(self, force: float | np.ndarray) -> float | np.ndarray:
        """Hertzian half-width a, m, at a normal force, N (the paper's Eq. 2)."""
        return contact_half_width(force, self.length, self.reduced_radius, self.reduced_modulus)

    @model_validator(mode="after")
    def _check_roughness(self):
        for name in ROLLERS:
            kinds = getattr(self, name).kinds
            if not kinds and self.composite is None:
                raise ValueError(
                    f"{name}.rms_roughness: missing, need it, or ra_roughness, or a topography, or "
                    "composite_rms_roughness for both rollers"
                )
            if kinds and self.composite is not None:
                raise ValueError(
                    f"composite_rms_roughness: got one together with {name}.{kinds[0]}, need one "
                    "of the two"
                )
        return self


class Roughness(OwnRoughness):
    """Statistics and grid of the random roughness lines of both rollers."""

    longest_wavelength: _LongestWavelength
    """longest wavelength of the lines, 2 pi / q_min; if it is the contact width, a larger force
    level redraws all lines and changes the probability at all points: adding 3200 N to the paper's
    study multiplies it by 0.85 to 0.64
    """
    shortest_wavelength: _ShortestWavelength
    """shortest wavelength of the lines, 2 pi / q_max; break-up of the layer depends on it"""
    skewness: _Skewness = 0.0
    """skewness of the heights, 0 for Gaussian heights; negative where peaks are worn"""
    kurtosis: _Kurtosis = 3.0
    """kurtosis of the heights, 3 for Gaussian heights; at least 1.5 plus 1.25 times the skewness
    squared
    """
    lay_ratio: _LayRatio = 1.0
    points: Annotated[StrictInt, Field(ge=LEAST_POINTS, le=MOST_POINTS)]
    """points N around the first roller"""
    height_step: Length
    """heights and films are integer multiples of this length, so sums are exact"""

    def of(self, own: OwnRoughness | None) -> "Roughness":
        """Return the roughness of one roller, whose values override these."""
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
    shear_strength: _Stress
    """limiting shear stress tau0"""

    @property
    def strength(self) -> float:
        """Strength tau0 / h_c, Pa/m, its only property on which contact depends."""
        return self.shear_strength / self.critical_thickness
