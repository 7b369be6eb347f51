"""Parameters of the roughness lines of a pair of rollers, checked against the grid."""

import functools
import hashlib
import math
from typing import Annotated

import numpy as np
from pydantic import Field, PlainSerializer

from lube.errors import StudyError, located
from lube.statistics.sample_size import independent_windows
from lube.study.field_types import StrictModel
from lube.study.rollers import AUTOMATIC_WAVELENGTH, ROLLERS, RollerPair, Roughness
from lube.surfaces.lay import MOST_ALONG_ROLLING, from_other_side, waves_along_rolling
from lube.types import Values
from lube.units import with_unit


@functools.lru_cache(maxsize=2)
def _digest(heights):
    """SHA-256 sum of a measured line, which replaces its heights in plain data."""
    return hashlib.sha256(heights).hexdigest()


class RoughLine(StrictModel):
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
        Wave number below which C1D ~ q, rad/m; by default `q_min`, which means no roll-off.
    skewness, kurtosis : float
        Skewness and kurtosis of the heights; by default 0 and 3, those of Gaussian heights.
    spectrum : tuple of tuple of float, optional
        Measured spectrum: wave vectors, rad/m, and densities, m^3, between which it is a power law.
    heights : bytes, optional
        Measured heights of the line itself: `points` numbers int32, in height steps.
    long_cutoff, short_cutoff : float, optional
        Longest and shortest of the waves whose rms height was stated, m; by default those of the
        line.
    isotropic : bool
        Whether the line stands for a surface that is isotropic, apart from its lay; by default it
        does.
    lay_ratio, lay_angle : float
        Length over width of the surface's ridges, by default 1, no lay; and the angle between them
        and rolling, degrees. The spectrum is then that of waves across the lay.
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
    heights: Annotated[bytes, PlainSerializer(_digest)] | None = Field(None, repr=False)
    long_cutoff: float | None = None
    short_cutoff: float | None = None
    isotropic: bool = True
    lay_ratio: float = 1.0
    lay_angle: float = 90.0

    @property
    def longest_wavelength(self) -> float:
        """Longest wavelength of the line, m."""
        return 2.0 * math.pi / self.q_min * self.lay_ratio

    @property
    def shortest_wavelength(self) -> float:
        """Shortest wavelength of the line, m."""
        return 2.0 * math.pi / self.q_max

    @property
    def has_roll_off(self) -> bool:
        """Whether the spectrum of the surface is constant for the longest waves."""
        return self.q_roll_off != self.q_min

    @property
    def follows_rolling(self) -> bool:
        """Whether a line along rolling can stand for the surface.

        It cannot if ridges run along rolling, or nearly so.
        """
        least = waves_along_rolling(MOST_ALONG_ROLLING, 0.0)
        return waves_along_rolling(self.lay_ratio, self.lay_angle) >= least

    @property
    def is_gaussian(self) -> bool:
        """Whether the line is drawn, with Gaussian heights."""
        return (self.skewness, self.kurtosis, self.heights) == (0.0, 3.0, None)


class LineSpec(StrictModel):
    """Everything that determines the roughness lines, except seed and realisation.

    Attributes
    ----------
    lines : tuple of RoughLine
        Line of each roller.
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
        """Points around each roller."""
        return tuple(line.points for line in self.lines)

    @property
    def rms_height(self) -> tuple[float, float]:
        """Rms height of each line, m."""
        return tuple(line.rms_height for line in self.lines)

    @property
    def is_gaussian(self) -> bool:
        """Whether both lines are drawn, with Gaussian heights."""
        return all(line.is_gaussian for line in self.lines)

    @property
    def has_surface(self) -> bool:
        """Whether both lines stand for surfaces."""
        return all(line.isotropic for line in self.lines)

    @property
    def follows_rolling(self) -> bool:
        """Whether lines along rolling can stand for both surfaces."""
        return all(line.follows_rolling for line in self.lines)

    @property
    def has_like_lines(self) -> bool:
        """Whether both lines differ by their rms height and their number of points alone."""
        first, second = self.lines
        alike = {"rms_height": first.rms_height, "points": first.points}
        return first == second.model_copy(update=alike)

    @property
    def is_isotropic(self) -> bool:
        """Whether both lines stand for isotropic surfaces."""
        return self.has_surface and all(line.lay_ratio == 1.0 for line in self.lines)

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
        return min(line.q_min / line.lay_ratio for line in self.lines)

    @property
    def q_max(self) -> float:
        """Largest wave number of both lines, rad/m."""
        return max(line.q_max for line in self.lines)

    @property
    def longest_wavelength(self) -> float:
        """Longest wavelength of both lines, m."""
        return 2.0 * math.pi / self.q_min

    @property
    def travel(self) -> float:
        """Perimeter of the smaller roller, m."""
        return self.spacing * min(self.points)

    def independent_windows(self, width: Values, slower: float = 1.0) -> Values:
        """Count the windows of a contact width, m, in a turn of the smaller roller.

        As in `lube.statistics.sample_size.independent_windows`. A slower surface, whose speed is
        this fraction of the faster one's, shows less of its line.
        """
        return independent_windows(self.travel * slower, width, self.longest_wavelength)

    def check_width(self, width: float, what: str) -> None:
        """Refuse a contact that is finer than the grid or wider than a roller's perimeter.

        Parameters
        ----------
        width : float
            Width of the contact, m.
        what : str
            Name of the contact, for the message.

        Raises
        ------
        StudyError
            With the contact width, and what is needed.
        """
        least, most = 2.0 * self.spacing, self.travel
        if not least <= width < most:
            raise StudyError(
                f"{what} is {_length(width)} wide, need at least two grid spacings, "
                f"{_length(least)}, and less than a roller's perimeter, {_length(most)}"
            )

    def check_follows_rolling(self) -> None:
        """Refuse surfaces for which lines cannot stand, as their waves run across rolling.

        Raises
        ------
        StudyError
            With the lay, and what is needed.
        """
        for line in self.lines:
            if not line.follows_rolling:
                raise StudyError(
                    f"lay_angle: got ridges {line.lay_ratio:g} times longer than wide at "
                    f"{line.lay_angle:g} deg to rolling, need a contact_model of surface alone: a "
                    "line cannot stand for a surface whose waves mostly run across rolling"
                )


def line_spec(rollers: RollerPair, roughness: Roughness, largest_force: float) -> LineSpec:
    """Determine the roughness lines of a pair of rollers.

    Parameters
    ----------
    rollers : RollerPair
        The rollers.
    roughness : Roughness
        Statistics and grid of the lines; the values of a roller override these.
    largest_force : float
        Largest force of the study, N; its contact width may set the longest wavelength.

    Returns
    -------
    LineSpec
        Everything that determines the lines, except seed and realisation.

    Raises
    ------
    StudyError
        If the grid is too coarse for the shortest wavelength of a line, a perimeter too short for
        the longest, the height step unsuitable for the roughness, or the kurtosis too small for
        the skewness.
    """
    spacing = 2.0 * math.pi * rollers.first.radius / roughness.points
    width = 2.0 * float(rollers.contact_half_width(largest_force))
    each = zip(ROLLERS, rollers.rms_heights, strict=True)
    lines = tuple(_rough_line(rollers, roughness, *one, spacing, width) for one in each)
    return LineSpec(lines=lines, spacing=spacing, height_step=roughness.height_step)


def band_in_words(rollers: RollerPair, roughness: Roughness, spec: LineSpec) -> str:
    """State the band of wavelengths of the roughness.

    Parameters
    ----------
    rollers, roughness
        As in `line_spec`.
    spec : LineSpec
        Their lines.

    Returns
    -------
    str
        Such as ``waves 0.8 mm to 3.14 µm, heights stated for 0.8 mm to 2.5 µm``; for each roller,
        if they differ.
    """
    bands = []
    for name, line in zip(ROLLERS, spec.lines, strict=True):
        own = roughness.of(getattr(rollers, name).roughness)
        longest, shortest = line.longest_wavelength / line.lay_ratio, line.shortest_wavelength
        automatic = line.heights is None and own.longest_wavelength == AUTOMATIC_WAVELENGTH
        why = f" ({AUTOMATIC_WAVELENGTH})" if automatic else ""
        band = f"waves {with_unit(longest, 'm', 3)}{why} to {with_unit(shortest, 'm', 3)}"
        if line.lay_ratio > 1.0:
            band += f" across ridges {line.lay_ratio:g} times longer, at {line.lay_angle:g} deg"
        if line.hurst_exponent is not None and (own.long_cutoff or own.short_cutoff):
            cutoffs = own.long_cutoff or longest, own.short_cutoff or shortest
            band += f", heights stated for {' to '.join(with_unit(one, 'm', 3) for one in cutoffs)}"
        bands.append(band)
    return bands[0] if bands[0] == bands[1] else f"first: {bands[0]}; second: {bands[1]}"


def _rough_line(rollers, roughness, name, rms, spacing, width):
    """Line of one roller, at a grid spacing and the largest contact width."""
    roller = getattr(rollers, name)
    own, key = roughness.of(roller.roughness), functools.partial(_key, name, roller.roughness)
    with located(key("shortest_wavelength")):
        longest, shortest = own.wavelengths(width, spacing)
    points = round(roughness.points * roller.radius / rollers.first.radius)
    if roller.topography and roller.topography.is_line:
        longest = roller.topography.long_cutoff or points * spacing
    roll_off = own.roll_off_wavelength
    if roller.topography or roll_off is None:
        roll_off = longest
    _check_band(longest, shortest, roughness.points, spacing, key)
    _check_roll_off(longest, shortest, roll_off, key)
    _check_distribution(own, key)
    if roller.topography:
        with located(f"rollers.{name}.topography", StudyError):
            grid = points, spacing, (longest, shortest)
            shape = roller.topography.line(grid, width, roughness.height_step)
            shape["isotropic"] = roller.topography.texture != "along rolling"
            if name == "second" and "lay_angle" in shape:
                # Either map is seen from outside its roller, both surfaces from the second roller.
                shape["lay_angle"] = from_other_side(shape["lay_angle"])
    elif own.hurst_exponent is None:
        raise StudyError(f"{key('hurst_exponent')}: missing, need it for the {name} roller")
    else:
        cutoffs = own.long_cutoff, own.short_cutoff
        _check_cutoffs(cutoffs, longest, shortest, key)
        beyond = own.hurst_exponent, longest, shortest, cutoffs, own.roll_off_wavelength
        shape = {"rms_height": rms * beyond_cutoffs(*beyond), "hurst_exponent": own.hurst_exponent}
        shape |= {"long_cutoff": cutoffs[0], "short_cutoff": cutoffs[1]} | _lay(own, key)
    _check_perimeter(points * spacing, longest * shape.get("lay_ratio", 1.0), shortest, name)
    _check_height_step(shape["rms_height"], roughness.height_step, name, roller)
    return RoughLine(
        points=points,
        q_min=2.0 * math.pi / longest,
        q_max=2.0 * math.pi / shortest,
        q_roll_off=2.0 * math.pi / roll_off,
        skewness=own.skewness,
        kurtosis=own.kurtosis,
        **shape,
    )


def _key(roller, own, name):
    """Name the key that set a value of the roughness: the roller's, else the study's."""
    is_own = getattr(own, name, None) is not None
    return f"rollers.{roller}.roughness.{name}" if is_own else f"roughness.{name}"


def _lay(own, key):
    """Lay of a roller's surface, nothing if it has none."""
    if own.lay_ratio == 1.0:
        return {}
    if own.lay_angle is None:
        raise StudyError(
            f"{key('lay_angle')}: missing, need it with a lay_ratio of {own.lay_ratio:g}: 0 deg "
            "for ridges along rolling, 90 deg for ridges across"
        )
    return {"lay_ratio": own.lay_ratio, "lay_angle": own.lay_angle}


def _check_cutoffs(cutoffs, longest, shortest, key):
    long_cutoff, short_cutoff = cutoffs[0] or longest, cutoffs[1] or shortest
    if long_cutoff <= short_cutoff:
        name = "long_cutoff" if cutoffs[0] else "short_cutoff"
        raise StudyError(
            f"{key(name)}: got a height stated for waves of {_length(long_cutoff)} to "
            f"{_length(short_cutoff)}, need a long cutoff above the short one; by default they are "
            "the ends of the band"
        )


def beyond_cutoffs(
    hurst_exponent: Values,
    longest: Values,
    shortest: Values,
    cutoffs: tuple[float | None, float | None],
    roll_off: float | None,
) -> Values:
    r"""Ratio of the rms height of all waves of a line to that of the waves within the cutoffs.

    Both follow from the integral of :math:`C \propto q^{-2H-1}`, below the roll-off
    :math:`C \propto q`.

    Parameters
    ----------
    hurst_exponent : float or array_like
        Hurst exponent H.
    longest, shortest : float or array_like
        Longest and shortest wavelength of the line, m.
    cutoffs : tuple of float or None
        Longest and shortest wavelength within the cutoffs, m; by default those of the line.
    roll_off : float or None
        Wavelength of the roll-off, m, if there is one.

    Returns
    -------
    float or array_like
        The ratio, exactly 1 without cutoffs.

    Examples
    --------
    >>> f"{beyond_cutoffs(0.7, 0.2e-3, 2.5e-6, (0.8e-3, None), None):.3f}"
    '0.379'
    """
    if cutoffs == (None, None):
        return 1.0
    stated = cutoffs[0] or longest, cutoffs[1] or shortest
    bend, exponent = roll_off or np.maximum(longest, stated[0]), 2.0 * hurst_exponent

    def power(wavelength):  # of all waves from the roll-off to this one
        ratio = wavelength / bend
        shorter = (1.0 - np.minimum(ratio, 1.0) ** exponent) / exponent
        return shorter + 0.5 * (np.maximum(ratio, 1.0) ** -2.0 - 1.0)

    whole, within = (power(short) - power(long) for long, short in ((longest, shortest), stated))
    return np.sqrt(whole / within)


def _length(value):
    return with_unit(value, "m", 3)


def _check_band(longest, shortest, points, spacing, key):
    if shortest < 2.0 * spacing * (1.0 - 1e-9):
        raise StudyError(
            f"roughness.points: got {points}, too coarse a grid: its spacing is "
            f"{_length(spacing)}, need at most half the shortest wavelength of {_length(shortest)}"
        )
    if shortest >= longest:
        least = math.ceil(points * shortest / longest) + 1
        raise StudyError(
            f"{key('shortest_wavelength')}: got {_length(shortest)}, need less than the longest, "
            f"{_length(longest)}; if it is given in points, need {least} roughness.points or more"
        )


def _check_roll_off(longest, shortest, roll_off, key):
    if not shortest * (1.0 - 1e-9) <= roll_off <= longest * (1.0 + 1e-9):
        raise StudyError(
            f"{key('roll_off_wavelength')}: got {_length(roll_off)}, need one from the shortest to "
            f"the longest wavelength, {_length(shortest)} to {_length(longest)}"
        )


def _check_perimeter(perimeter, longest, shortest, roller):
    if perimeter < longest or math.ceil(perimeter / longest) > math.floor(perimeter / shortest):
        raise StudyError(
            f"rollers.{roller}.radius: got a perimeter of {_length(perimeter)}, need room for the "
            f"longest wave and for a whole number of waves of {_length(shortest)} to "
            f"{_length(longest)}"
        )


def _check_height_step(rms, step, name, roller):
    """Rms heights must be many height steps, and peaks must fit a 32-bit integer."""
    if 1e3 <= rms / step <= 1e7:
        return
    if 1e-9 <= rms <= 1e-5:
        needed = f"need {_length(rms / 1e7)} to {_length(rms / 1e3)} for a roughness of"
        raise StudyError(f"roughness.height_step: got {_length(step)}, {needed} {_length(rms)}")
    key = f"{name}.{roller.kinds[0]}" if roller.kinds else "composite_rms_roughness"
    raise StudyError(f"rollers.{key}: got {_length(rms)}, need an rms height of 1 nm to 10 µm")


def _check_distribution(own, key):
    """Close to the least kurtosis, heights take only two values, which no given spectrum allows."""
    square = own.skewness**2
    least = 1.5 + 1.25 * square
    if own.kurtosis < least:
        raise StudyError(
            f"{key('kurtosis')}: got {own.kurtosis:g} with a skewness of {own.skewness:g}, need at "
            f"least {least:g}: no kurtosis is below {square + 1.0:g}, the skewness squared plus "
            "one, and close to that the spectrum cannot be kept"
        )
