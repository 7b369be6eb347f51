"""What the oil adds to rough surfaces across a strip: the response of the film to their waves."""

import copy
import itertools
from collections.abc import Sequence
from dataclasses import dataclass
from typing import ClassVar, Self

import numpy as np
import scipy

from lube.contact.waves import FINER, PRECISION, STEEPNESS, Answer, expanded
from lube.ehl.response import at_wavelengths
from lube.kernels.moved_surface import Answered
from lube.surfaces.rough_surface import Surface
from lube.threads import on_threads
from lube.types import Array, Pair

FINER_ANGLES = 3
"""Number of angles at which answers are expanded, for each of the stored angles."""
COARSEST = 5
"""Binary logarithm of the largest number of points from node to node."""


@dataclass(frozen=True, eq=False)
class SurfaceAnswer(Answer):
    r"""What the oil adds to the waves of a surface at an operating point.

    The response of the film to waves at the angle :math:`\theta` to rolling is expanded as that to
    the waves of lines is in `lube.contact.waves.Answer`,

    .. math:: T_k(X, \theta) - 1 = \sum_m u_m(X)\, f_m(k, \theta)

    Attributes
    ----------
    angle : numpy.ndarray, shape (A,)
        Angles from 0 to 90, degrees. The shape of the filters is (K, A, M).
    """

    angle: Array
    response: ClassVar[str] = "surface_response"
    waves: ClassVar[tuple[str, ...]] = ("wave_angle", "wavelength")
    coarsest: ClassVar[int] = COARSEST

    @classmethod
    def of(cls, response: Array, levels: list[Array], half_width: float, importance: Array) -> Self:
        """Expand a response of the film.

        Parameters
        ----------
        response : numpy.ndarray of complex, shape (a, w, n)
            The response.
        levels : list of numpy.ndarray
            Angles from 0 to 90 degrees, shape (a,), wavelengths in m, falling, shape (w,), and
            positions over the half-width, rising, shape (n,).
        half_width : float
            Half-width of the contact, m.
        importance : numpy.ndarray, shape (n,)
            Weight of an error at each position, 1 at most.

        Returns
        -------
        SurfaceAnswer
            The expansion.
        """
        angles, wavelength, position = levels
        changed = np.flatnonzero(np.abs(response - 1.0).max(axis=(0, 2)) > PRECISION)
        last = max([1, *changed])
        finer = np.geomspace(wavelength[0], wavelength[last], FINER * last + 1)
        scaled = finer / half_width, wavelength / half_width
        each = zip(response, angles, strict=True)
        at_angles = [at_wavelengths(*scaled, one, position, angle) - 1.0 for one, angle in each]
        # As over the wavelengths, the phase outside the contact is that at the contact's edge.
        outside = 2j * np.pi * (position - np.clip(position, -1.0, 1.0)) / scaled[0][:, None]
        more = np.linspace(angles[0], angles[-1], FINER_ANGLES * (angles.size - 1) + 1)
        along, along_more = (np.cos(np.radians(each))[:, None, None] for each in (angles, more))
        spline = scipy.interpolate.CubicSpline(angles, at_angles * np.exp(outside * along))
        change = np.swapaxes(spline(more) * np.exp(-outside * along_more), 0, 1)
        # Half as many waves run at the first and the last angle as at one between.
        waves = finer[:, None] ** STEEPNESS * np.sqrt(np.where(more % angles[-1], 1.0, 0.5))
        shapes, filters = expanded(change.reshape(-1, position.size), waves.ravel(), importance)
        filters = filters.reshape(finer.size, more.size, -1)
        return cls(half_width, position, shapes, 2.0 * np.pi / finer, filters, more)

    def filters_at(self, along: Array, across: Array) -> Array:
        """Functions :math:`f_m` of waves with wavenumbers along rolling and across, (waves, M)."""
        wavenumber, angle = np.hypot(along, across), np.degrees(np.arctan2(np.abs(across), along))
        # Beyond the longest wave the response is that of the longest.
        longest = np.maximum(np.log(wavenumber), np.log(self.wavenumber[0]))
        grid = np.log(self.wavenumber), self.angle
        beyond = {"bounds_error": False, "fill_value": 0.0}  # the oil does not change shorter waves
        filters = scipy.interpolate.RegularGridInterpolator(grid, self.filters, **beyond)
        return filters((longest, angle))


def moments_in_gap(waves: Sequence[Array], answer: SurfaceAnswer, position: Array) -> Array:
    """Compute second moments of the heights of a surface in the gap, and of their changes.

    Parameters
    ----------
    waves : tuple of numpy.ndarray
        From `lube.surfaces.rough_surface.surface_waves`.
    answer : SurfaceAnswer
        The answer to them.
    position : numpy.ndarray, shape (columns,)
        Columns of a strip, evenly apart, m from the line of centres.

    Returns
    -------
    numpy.ndarray, shape (columns, 4, 4)
        As `lube.contact.strip_film.height_moments` of one surface.
    """
    filters = answer.filters_at(*waves[:2])
    changed = np.any(filters, axis=1)
    kept, slopes = itertools.islice(_kept(filters[changed], answer, position), 2)

    def moments(some, kept, slopes):
        along, across, power = (each[some] for each in waves)
        changes = slopes + 1j * along * kept, 1j * across * kept, -1j * along * kept
        each = np.sqrt(power) * np.stack([kept, *changes])
        return np.einsum("icw,jcw->cij", each.conj(), each).real

    others = np.ones((1, np.count_nonzero(~changed)))
    return moments(changed, kept, slopes) + moments(~changed, others, 0.0)


def summit_moments(waves: Sequence[Array], answer: SurfaceAnswer, position: Array) -> Array:
    """Compute second moments of the heights of a surface in the gap, and of its curvatures.

    Parameters
    ----------
    waves, answer, position
        As in `moments_in_gap`.

    Returns
    -------
    numpy.ndarray, shape (columns, 4, 4)
        Mean squares and products of the height, m, of the mean of the curvatures along rolling and
        along the rollers, of half their difference, and of the twist, 1/m, positive at summits.
    """
    along, across, power = waves
    filters = answer.filters_at(along, across)
    kept, slopes, bent = itertools.islice(_kept(filters, answer, position), 3)
    first = along**2 * kept - 2j * along * slopes - bent
    second, twist = across**2 * kept, across * (along * kept - 1j * slopes)
    each = np.stack([kept, 0.5 * (first + second), 0.5 * (first - second), twist])
    return np.einsum("icw,jcw,w->cij", each.conj(), each, power).real


def waves_in_gap(waves: Sequence[Array], answer: SurfaceAnswer, position: Array) -> list[Array]:
    """Compute what becomes of waves in the gap.

    Parameters
    ----------
    waves, answer, position
        As in `moments_in_gap`.

    Returns
    -------
    list of numpy.ndarray of complex, shape (columns, waves)
        Height of each wave over that as drawn, and its derivative along rolling, 1/m.
    """
    filters = answer.filters_at(*waves[:2])
    return list(itertools.islice(_kept(filters, answer, position), 2))


def _kept(filters, answer, position):
    """Yield the heights of waves in the gap over those as drawn, then derivatives along rolling."""
    shapes = answer.at(position / answer.half_width)
    kept = 1.0 + np.einsum("cm,wm->cw", shapes, filters)
    while True:
        yield kept
        shapes = np.gradient(shapes, position, axis=0)
        kept = np.einsum("cm,wm->cw", shapes, filters)


class AnsweredStrip:
    """Both surfaces across a strip, with what the oil adds to them.

    Parameters
    ----------
    answers : tuple of SurfaceAnswer
        The answers to both rollers' surfaces; the same object if they are alike.
    surface : Surface
        The sum of both surfaces. The number of points along a side is a multiple of
        2^`COARSEST`.
    columns : numpy.ndarray
        Positions of the strip's columns, m from the line of centres.

    Attributes
    ----------
    rms : numpy.ndarray, shape (columns,)
        Rms height in the gap at each column, over that of the surfaces as drawn; from
        `with_covariances` on.
    shift : int
        Binary logarithm of the number of points of the surface from node to node.
    points : tuple of int
        Nodes along the sides of the surface.
    apart : tuple of float
        Distances of neighbouring nodes along the rollers and along rolling, m.
    """

    def __init__(self, answers: Pair, surface: Surface, columns: Array) -> None:
        self.answers = answers[:1] if answers[0] is answers[1] else answers
        self.shift = self.answers[0].shift(surface.spacing[1])
        self.points = tuple(number >> self.shift for number in surface.points)
        self.apart = tuple(side * (1 << self.shift) for side in surface.spacing)
        self._surface, self._columns = surface, np.arange(columns.size)
        # One more on either side, from which curvatures follow.
        self._nodes = np.arange(-1, ((columns.size - 1) >> self.shift) + 3) << self.shift
        position = columns[0] + self._nodes * surface.spacing[1]
        self._shapes = [one.at(position / one.half_width) for one in self.answers]
        # The waves that the oil changes: their places among those of the surface.
        coarser = zip(self.points, surface.coarse, strict=True)
        halves = [(min(both) - 1) // 2 for both in coarser]
        down = np.arange(-halves[0], halves[0] + 1)
        down, along = np.meshgrid(down, np.arange(halves[1] + 1), indexing="ij")
        units = [2.0 * np.pi / side for side in surface.sides]
        length = np.hypot(units[0] * down, units[1] * along)
        changed = length < max(one.wavenumber[-1] for one in self.answers)
        changed[halves[0], 0] = False  # the mean height is no wave
        self._down, self._along = down[changed], along[changed]
        waves = units[1] * self._along, units[0] * self._down
        filters = [one.filters_at(*waves) for one in self.answers]
        self._filters = [each.astype(np.complex64) for each in filters]
        self._first, self._covariances = 0, np.zeros((0, 0, 0), np.float32)

    def with_covariances(self, before: int, after: int, threads: int | None) -> "AnsweredStrip":
        """Return the strip with covariances, for points that are known to touch.

        Parameters
        ----------
        before, after : int
            Rows before and after that of a known height that are looked at.
        threads : int or None
            Threads that share the work, None for one on each core; they do not change the results.
        """
        surface, place = self._surface, (self._down, self._along)
        variances = surface.variances[place] / surface.rms**2
        first_part = surface.first_part[place]
        parts = [first_part, 1.0 - first_part] if len(self.answers) > 1 else [1.0]
        rows = np.arange((-before >> self.shift) - 1, (after >> self.shift) + 3)
        each = zip(parts, self._filters, self._shapes, strict=True)
        added = [self._added(rows, part * variances, *own, threads) for part, *own in each]
        found = copy.copy(self)
        found._first, found._covariances = rows[1].item(), np.ascontiguousarray(sum(added))
        own = np.diagonal(found._covariances[:, -rows[0]])
        found.rms = np.sqrt(1.0 + np.interp(self._columns, self._nodes, own))
        return found

    def _added(self, rows, variances, filters, shapes, threads):
        """Sum what the oil adds to the covariances of one surface's heights."""
        surface, shapes = self._surface, shapes.astype(np.float32)
        down_unit, unit = (2.0 * np.pi / number for number in surface.points)
        phases = unit * self._nodes[:, None] * np.arange(self._along.max() + 1)
        at_nodes = np.exp(1j * phases).astype(np.complex64)
        by_down = np.argsort(np.abs(self._down), kind="stable")
        counts = np.bincount(np.abs(self._down))
        downs, ends = np.arange(counts.size), np.cumsum([0, *counts])
        # Waves up and down the rollers together: their sums, and differences unless they are alike.
        parts = [np.cos] if surface.is_mirrored else [np.cos, np.sin]
        sides = self._nodes.size, self._nodes.size
        of_waves = np.empty((len(parts), downs.size, *sides), np.float32)

        def fill(down):
            here = by_down[ends[down] : ends[down + 1]]
            drawn = at_nodes.take(self._along[here], axis=1)
            changed = drawn + (shapes @ filters[here].T) * drawn
            # Waves along rolling stand for their mirror images too.
            power = (variances[here] * np.where(self._along[here], 2.0, 1.0)).astype(np.float32)
            ahead = np.sign(self._down[here]).astype(np.complex64)
            for part, signs in enumerate([np.complex64(1.0), 1j * ahead][: len(parts)]):
                as_drawn = drawn * (power * signs)
                stays = _products(drawn, as_drawn[:1]), _products(drawn[:1], as_drawn)
                heights = _products(changed, changed * (power * signs))
                # As drawn, covariances are the same for all nodes equally far apart.
                heights -= scipy.linalg.toeplitz(*map(np.ravel, stays))
                of_waves[part, down] = heights

        on_threads(fill, downs, threads)
        lags = rows[:, None] << self.shift
        along = np.stack([one(down_unit * lags * downs) for one in parts]).astype(np.float32)
        return np.einsum("prd,pdtc->trc", along, of_waves, optimize=True)

    def of_waves(self, waves: list[Array]) -> Answered:
        """Filter the waves of drawn surfaces, on the coarser grid of the nodes.

        Parameters
        ----------
        waves : list of numpy.ndarray
            Waves as from `Surface.draw`, of the sum of both surfaces if the answers are alike,
            else of each surface.

        Returns
        -------
        Answered
            For `lube.kernels.areal`.
        """
        rows, columns = self.points
        changed, fields = np.zeros((rows, columns // 2 + 1), np.complex64), []
        for own, filters in zip(waves, self._filters, strict=True):
            for each in filters.T:
                changed[self._down, self._along] = own[self._down, self._along] * each
                rough = scipy.fft.irfft2(changed, self.points, norm="forward")
                fields.append(np.pad(rough, (1, 2), mode="wrap"))
        shapes = np.hstack(self._shapes).astype(np.float32)
        # For another layout in memory Numba would compile the kernels once more.
        stacked = np.ascontiguousarray(np.stack(fields, axis=-1))
        return Answered(stacked, shapes, self._covariances, self._first, self.shift, self.apart)

    def curvatures(self, heights: Array) -> Array:
        """Mean curvature of heights at nodes, positive at summits.

        Parameters
        ----------
        heights : numpy.ndarray, shape (rows, nodes, ...)
            Heights.

        Returns
        -------
        numpy.ndarray, shape (rows - 2, nodes - 2, ...)
            Height over square metres, at all nodes but the outermost.
        """
        here = 2.0 * heights[1:-1, 1:-1]
        down = here - heights[:-2, 1:-1] - heights[2:, 1:-1]
        along = here - heights[1:-1, :-2] - heights[1:-1, 2:]
        return 0.5 * (down / self.apart[0] ** 2 + along / self.apart[1] ** 2)

    def slopes(self, heights: Array) -> Pair:
        """As `curvatures`, the slopes of heights along rolling and along the rollers."""
        along = heights[1:-1, 2:] - heights[1:-1, :-2]
        down = heights[2:, 1:-1] - heights[:-2, 1:-1]
        return along / (2.0 * self.apart[1]), down / (2.0 * self.apart[0])


def _products(some, others):
    """Real part of the products of conjugate waves with others, summed over the waves."""
    return some.view(np.float32) @ others.view(np.float32).T
