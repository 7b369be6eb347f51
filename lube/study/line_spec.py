"""Parameters of the roughness lines of a pair of rollers."""

import functools
import hashlib
import math
from typing import Annotated

from pydantic import Field, PlainSerializer

from lube.errors import StudyError
from lube.statistics.sample_size import independent_windows
from lube.study.field_types import StrictModel
from lube.surfaces.lay import MOST_ALONG_ROLLING, waves_along_rolling
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
    def longest_across_lay(self) -> float:
        """Longest wavelength across the lay of the surface, m; without a lay that of the line."""
        return 2.0 * math.pi / self.q_min

    @property
    def longest_wavelength(self) -> float:
        """Longest wavelength of the line, m."""
        return self.longest_across_lay * self.lay_ratio

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
    def shortest_wavelength(self) -> float:
        """Shortest wavelength of both lines, m."""
        return 2.0 * math.pi / self.q_max

    def wave_step(self, roller: int) -> float:
        """Wavenumber of a wave as long as the perimeter of a roller, 0 or 1, rad/m."""
        return 2.0 * math.pi / (self.points[roller] * self.spacing)

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
            wide, least, most = (with_unit(each, "m", 3) for each in (width, least, most))
            raise StudyError(
                f"{what} is {wide} wide, need at least two grid spacings, {least}, and less than "
                f"a roller's perimeter, {most}"
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
