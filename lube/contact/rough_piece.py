r"""A piece of two rough lines, its waves, and the gap as it passes through the contact."""

from dataclasses import dataclass
from functools import cached_property

import numpy as np
import scipy.fft

from lube.ehl.line_contact import FilmProfile
from lube.ehl.response import at_wavelengths
from lube.grid.discretise import LineGrid, speed_ratios
from lube.grid.film_responses import FINER_RATIO, SHORTEST, changed_waves
from lube.grid.operating_points import surface_speeds
from lube.types import Array, Pair

HALF_LENGTH, TAPER = 2.0, 0.25
"""Half the length of a piece, and length of the taper at each end, in half-widths."""


@dataclass(frozen=True)
class RoughPiece:
    """Piece of two rough lines, two contact widths long, centred where their sum is highest.

    Its ends are tapered. When its middle is at the line of centres, it covers the contact.

    Attributes
    ----------
    pair : tuple of numpy.ndarray
        The lines, int32 height steps.
    grid : LineGrid
        Their grid.
    half_width : float
        Half-width of the contact, m.
    slide_to_roll_ratio : float
        Slide-to-roll ratio.
    """

    pair: Pair
    grid: LineGrid
    half_width: float
    slide_to_roll_ratio: float

    @cached_property
    def middle_step(self) -> int:
        """Time step at which the two lines together are highest at the line of centres."""
        steps = np.arange(self.pair[0].size)
        both = zip(self.pair, speed_ratios(self.slide_to_roll_ratio), strict=True)
        at = (line[np.floor(steps * ratio + 0.5).astype(int) % line.size] for line, ratio in both)
        return int(np.argmax(sum(at)))

    @property
    def speeds(self) -> tuple[float, float]:
        """Surface speeds over the entrainment speed."""
        return surface_speeds(1.0, self.slide_to_roll_ratio)

    @cached_property
    def _cut(self):
        """Indices of the piece's points in each line, and their tapered heights."""
        reach = int(HALF_LENGTH * self.half_width / self.grid.spacing)
        points = np.arange(-reach, reach + 1)
        part = np.clip((reach - np.abs(points)) / (reach * TAPER / HALF_LENGTH), 0.0, 1.0)
        part = part * part * (3.0 - 2.0 * part)
        found = []
        for line, ratio in zip(self.pair, speed_ratios(self.slide_to_roll_ratio), strict=True):
            index = (points + int(np.floor(self.middle_step * ratio + 0.5))) % line.size
            found.append((index, np.rint(part * line[index]).astype(np.int32)))
        return found

    @property
    def lines(self) -> Pair:
        """The two lines, zero outside the piece."""
        lines = tuple(np.zeros_like(line) for line in self.pair)
        for line, (index, heights) in zip(lines, self._cut, strict=True):
            line[index] = heights
        return lines

    @property
    def highest(self) -> float:
        """Height of both lines together, m, if their highest points met."""
        return sum(heights.max() for _, heights in self._cut) * self.grid.height_step

    def steps(self, least: float, greatest: float) -> tuple[int, int]:
        """First time step, and number of steps, between two travels of the oil, half-widths."""
        by_step = self.grid.spacing / self.half_width / max(self.speeds)
        return self.middle_step + round(least / by_step), round((greatest - least) / by_step) + 1

    def heights(self, position: Array, travel: Array, profile: FilmProfile | None = None) -> Array:
        """Heights of both lines together as they pass through the contact.

        Parameters
        ----------
        position : numpy.ndarray, shape (n,)
            Positions over the half-width, in the direction of motion.
        travel : numpy.ndarray, shape (t,)
            How far the oil has travelled since the middle was at the line of centres, half-widths.
        profile : FilmProfile, optional
            Film that answers the waves of the lines; by default they stay as drawn.

        Returns
        -------
        numpy.ndarray, shape (n, t)
            Heights, m.
        """
        heights = np.zeros((position.size, travel.size))
        for speed, (_, cut) in zip(self.speeds, self._cut, strict=True):
            size = 2 * cut.size
            waves = scipy.fft.rfft(np.roll(np.pad(cut, (0, size - cut.size)), -(cut.size // 2)))
            unit = 2.0 * np.pi / (size * self.grid.spacing)
            waves = waves[:-1] * (2.0 / size)
            waves[0] /= 2.0
            wavenumber = unit * self.half_width * np.arange(waves.size)
            # Points of a line that are ahead come first, so its waves are conjugate.
            passing = waves.conj() * np.exp(1j * position[:, None] * wavenumber)
            if profile is not None:
                passing[:, 1:] *= _response(profile, wavenumber[1:], speed, position)
                passing[:, 0] = 0.0  # the load is fixed, so the rollers give way
            heights += (passing @ np.exp(-1j * speed * wavenumber[:, None] * travel)).real
        return heights * self.grid.height_step


def _response(profile, wavenumber, speed, position):
    """Response of a film to waves, shape (positions, waves)."""
    wanted = 2.0 * np.pi / wavenumber
    count = int(np.log(wanted[0] / SHORTEST) / np.log(FINER_RATIO)) + 2
    solved = np.geomspace(wanted[0], SHORTEST, count)
    transfer = changed_waves(profile, solved, np.array([speed]), position)[0]
    return at_wavelengths(wanted, solved, transfer, position).T
