"""The film across the strip 2a x L', and what theory says of contact under it.

Contacts of surfaces are small and far apart where they do not merge. So a contact is in the strip
while it passes the contact width, and a little longer, as it has an extent of its own: on the way
w, the *passage width*.
"""

import functools
from collections.abc import Callable, Sequence
from dataclasses import dataclass, field, replace

import numpy as np
import scipy

from lube.contact.surface_answers import (
    AnsweredStrip,
    moments_in_gap,
    summit_moments,
    waves_in_gap,
)
from lube.grid.operating_points import surface_speeds
from lube.physics import excursions, summits
from lube.surfaces.lay import cosine_and_sine
from lube.surfaces.rare_contact import likely_part
from lube.surfaces.rough_surface import Surface, surface_waves
from lube.surfaces.spectra import wave_moments
from lube.surfaces.synthetic import LineSpecLike
from lube.types import Array, Pair

COLUMNS = 200
"""Columns of a strip, for the contacts that theory expects."""
HIGHEST = 37.0
"""Lambda ratio under which contacts are looked for at most: under thicker films their number is 0
in floating point, and so are numbers that they are divided by."""
UNCHANGED = ((1.0, 0.0), (1.0, 0.0))
"""Waves of both surfaces that the oil does not change, as from
`lube.contact.surface_answers.waves_in_gap`."""


@dataclass(frozen=True)
class StripFilm:
    """Film across the strip, where contact is likely.

    Attributes
    ----------
    thickness : callable
        Film (m) at positions across the strip (m), by a cubic spline. With a second argument n, its
        n-th derivative.
    begin, width : float
        Where the strip begins, and its width, m.
    has_edges : bool
        Whether contacts are cut where the strip ends.
    answers : tuple of lube.contact.surface_answers.SurfaceAnswer, optional
        How the oil answers both surfaces; by default it does not change them.
    """

    thickness: Callable
    begin: float
    width: float
    has_edges: bool
    answers: Pair | None = field(default=None, repr=False)

    @classmethod
    def flat(cls, thickness: float, half_width: float) -> "StripFilm":
        """Film of one thickness, as wide as the contact."""
        film = scipy.interpolate.CubicSpline([-half_width, half_width], [thickness, thickness])
        return cls(film, -half_width, 2.0 * half_width, True)

    @classmethod
    def shaped(cls, position: Array, film: Array, rms: float) -> "StripFilm":
        """Film with a shape, given at positions in m, on a surface of an rms height in m."""
        part = likely_part(film, np.broadcast_to(rms, film.shape))[1]
        begin, end = position[max(part.start - 1, 0)], position[min(part.stop, film.size - 1)]
        return cls(scipy.interpolate.CubicSpline(position, film), begin, end - begin, False)

    def thicker(self, times: float) -> "StripFilm":
        """Make the film thicker, on the same part of the strip."""

        def thickness(position, derivative=0):
            return times * self.thickness(position, derivative)

        return replace(self, thickness=thickness)

    def columns(self, spacing: float) -> Array:
        """Positions of the columns of a grid at which contacts are looked for, m.

        Edges are at columns, so that what covers a column is in the strip.
        """
        number = max(round(self.width / spacing), 1) + self.has_edges
        middle = self.begin + 0.5 * self.width
        return middle + spacing * (np.arange(number) - 0.5 * (number - 1))

    @property
    def middles(self) -> Array:
        """Positions in the middle of `COLUMNS` even parts of the strip, m."""
        return self.begin + self.width / COLUMNS * (np.arange(COLUMNS) + 0.5)

    def films(self, spacing: float) -> Array:
        """Film at the columns of a grid, m."""
        return self.thickness(self.columns(spacing))

    def breaking_curvatures(self, position: Array, sharp: float) -> Array:
        """Mean curvature of the surface at which a summit breaks its layer, at positions, 1/m.

        The mean curvature of the overlap is then `sharp`. Half of the film's second derivative
        contributes to it.
        """
        return sharp - 0.5 * self.thickness(position, 2)

    def answered(self, surface: Surface) -> AnsweredStrip | None:
        """Find what the oil adds to a surface."""
        if self.answers is None or not any(one.shapes.size for one in self.answers):
            return None
        return AnsweredStrip(self.answers, surface, self.columns(surface.spacing[1]))

    def contacts(
        self, spec: LineSpecLike, length: float, slide_to_roll_ratio: float = 0.0
    ) -> excursions.PassingContacts:
        """Find how many contacts theory expects in the strip, and how many appear in it.

        Parameters
        ----------
        spec : LineSpecLike
            Parameters of the lines that stand for the surfaces.
        length : float
            Length of the strip along the rollers, m.
        slide_to_roll_ratio : float, optional
            Slide-to-roll ratio, by default pure rolling.

        Returns
        -------
        PassingContacts
            At `COLUMNS` columns.
        """
        speeds = np.ones((2, 4))
        speeds[:, 3] = surface_speeds(1.0, slide_to_roll_ratio)
        moments = np.einsum("rcij,ri,rj->cij", self._moments(spec), speeds, speeds)
        square, along = moments[:, :1, :1], moments[:, 0, 1:]
        # The rms height changes along the strip, too.
        changes = (moments[:, 1:, 1:] - along[:, :, None] * along[:, None] / square) / square
        level = self.thickness(self.middles) / np.sqrt(moments[:, 0, 0])
        level = level - max(level.min() - HIGHEST, 0.0)
        apart = self.width / COLUMNS
        return excursions.passing_contacts(level, changes, length, apart, self.has_edges)

    def levels(self, spec: LineSpecLike) -> Array:
        """Film over the rms height in the gap, at `COLUMNS` columns.

        Parameters
        ----------
        spec : LineSpecLike
            As in `contacts`.
        """
        square = self._moments(spec)[..., 0, 0].sum(axis=0)
        return self.thickness(self.middles) / np.sqrt(square)

    def expected(self, spec: LineSpecLike, length: float, sharp: float) -> Pair:
        """Find the numbers of contacts, and of breakthroughs, that theory expects in the strip.

        Parameters
        ----------
        spec, length
            As in `contacts`.
        sharp : float
            Mean curvature of the overlap at which the boundary layer breaks, 1/m.

        Returns
        -------
        tuple of float
            Of the roughness in the gap.
        """
        number = self.contacts(spec, length).number
        return number, number * self.breaking_part(spec, length, sharp)

    def breaking_part(self, spec: LineSpecLike, length: float, sharp: float) -> float:
        """Find at which fraction of the contacts theory expects the layer to break.

        Parameters
        ----------
        spec, length, sharp
            As in `expected`.
        """
        known, weights = self._summits(spec, sharp, self.contacts(spec, length).density)
        share = summits.sharp_surface_summit_share(*known)
        return np.average(share, weights=weights)

    def _summits(self, spec, sharp, density):
        """Films, moments and curvatures of summits at columns, and the columns' weights."""
        films, sharp = self.thickness(self.middles), self.breaking_curvatures(self.middles, sharp)
        moments, curvatures = surface_moments(spec), curvature_moments(spec)
        if self.answers:
            products = sum(self._of_each(summit_moments, spec, self.middles)).T
            height, mean, half, mixed = products[0]
            moments = excursions.SurfaceMoments(
                height, mean + half, mean - half, mixed, 4.0 * products[1, 1]
            )
            curvatures = products[1:, 1:]
        elif self.has_edges:  # the same everywhere
            films, sharp, density = films[:1], sharp[:1], density[:1]
        return (films, moments, sharp, curvatures), density

    def passage_width(
        self, spec: LineSpecLike, length: float, slide_to_roll_ratio: float = 0.0
    ) -> float:
        """Find how far the rollers move on average while a contact is in the strip, m.

        Parameters
        ----------
        spec, length, slide_to_roll_ratio
            As in `contacts`.
        """
        _, number, appearing = self.contacts(spec, length, slide_to_roll_ratio)
        return number / appearing

    def breakthrough_width(
        self, spec: LineSpecLike, length: float, sharp: float, slide_to_roll_ratio: float = 0.0
    ) -> float:
        """Find how far the rollers move on average while the layer of a contact is broken, m.

        With slip, and where the oil answers the surfaces, a layer also breaks where a summit
        becomes sharper while it touches, and holds again where it becomes blunter. Else it is
        broken as long as the contact is in the strip.

        Parameters
        ----------
        spec, length, sharp
            As in `expected`.
        slide_to_roll_ratio : float, optional
            Slide-to-roll ratio, by default pure rolling.
        """
        found = self.contacts(spec, length, slide_to_roll_ratio)
        passage = found.number / found.appearing
        if slide_to_roll_ratio == 0.0 and not self.answers:
            return passage
        known, weights = self._summits(spec, sharp, found.density)
        share = summits.sharp_surface_summit_share(*known)
        answered = UNCHANGED
        if self.answers:
            answered = self._of_each(waves_in_gap, spec, self.middles)
        motion = summit_motion(spec, slide_to_roll_ratio, answered)
        more = summits.sharpening_summits(*known, motion)
        share, more = (np.average(each, weights=weights) for each in (share, more))
        # Curvatures are integrated as far as 9 standard deviations: a smaller share tells nothing.
        return share / (share / passage + more) if share > 1e-30 else passage

    def common(self, spec: LineSpecLike, length: float) -> Pair:
        """Find which contacts two strips have in common, in pure rolling.

        Parameters
        ----------
        spec, length
            As in `contacts`.

        Returns
        -------
        lags, common : numpy.ndarray
            Distances of both strips along the circumference, m, and the fraction of their contacts
            that they have in common.
        """
        density, number, _ = self.contacts(spec, length)
        lags, whole = np.arange(density.size + 1), density.sum()
        # A contact of both strips touches at the place where contacts are rarer.
        shared = [np.minimum(density[lag:], density[: density.size - lag]).sum() for lag in lags]
        return number / whole * lags, np.array(shared) / whole

    def gap(self, spec: LineSpecLike, half_width: float) -> Pair:
        """Find the mean gap and the rms height of the roughness in it, across the contact.

        Parameters
        ----------
        spec : LineSpecLike
            As in `contacts`.
        half_width : float
            Half of the contact width, m.

        Returns
        -------
        tuple of numpy.ndarray
            Both at `COLUMNS` even positions from edge to edge, m.
        """
        position = half_width * np.linspace(-1.0, 1.0, COLUMNS)
        square = self._moments_at(spec, position)[..., 0, 0].sum(axis=0)
        return self.thickness(position), np.broadcast_to(np.sqrt(square), position.shape)

    def _moments(self, spec):
        """Compute the `height_moments` in the gap, at `COLUMNS` columns."""
        return _moments_under_any_film(replace(self, thickness=None), spec)

    def _moments_at(self, spec, position):
        if not self.answers:
            return height_moments(spec)
        return np.stack(self._of_each(moments_in_gap, spec, position))

    def _of_each(self, moments_of, spec, position):
        """Moments of either surface in the gap."""
        each = enumerate(self.answers)
        return [moments_of(surface_waves(spec, one), answer, position) for one, answer in each]


@functools.lru_cache(maxsize=1)  # of one strip at a time
def _moments_under_any_film(strip, spec):
    return strip._moments_at(spec, strip.middles)


@functools.lru_cache(maxsize=1)
def surface_moments(spec: LineSpecLike) -> excursions.SurfaceMoments:
    """Moments of the surface that a pair of lines stands for, expected from their spectra.

    They are those of its waves. On the grid of the lines, where slopes are finite differences,
    slopes and curvatures are smaller.

    Parameters
    ----------
    spec : LineSpecLike
        Parameters of the lines. Their mean square slope is the surface's in both directions.

    Returns
    -------
    SurfaceMoments
        Moments of the sum of both rollers' surfaces.
    """
    slopes = _slopes(spec, 0) + _slopes(spec, 1)
    m0, _, m4 = sum(wave_moments(spec, roller) for roller in range(len(spec.lines))).tolist()
    return excursions.SurfaceMoments(m0, *slopes.tolist(), m4)


def curvature_moments(spec: LineSpecLike) -> Array | None:
    """Mean squares and products of the curvatures of the surface that a pair of lines stands for.

    Parameters
    ----------
    spec : LineSpecLike
        Parameters of the lines. Their mean square curvature is that of the sum of the surface's.

    Returns
    -------
    numpy.ndarray, shape (3, 3)
        As in `lube.physics.summits.sharp_surface_summit_share`; None without a lay.
    """
    if all(line.lay_ratio == 1.0 for line in spec.lines):
        return None
    found = np.zeros((3, 3))
    for roller, line in enumerate(spec.lines):
        # Curvatures along the lay and across it.
        part, square = line.lay_ratio**-2.0, wave_moments(spec, roller)[2]
        scale = square / (3.0 + 2.0 * part + 3.0 * part**2)
        ridges, both, across = np.array([3.0 * part**2, part, 3.0]) * scale
        own = [ridges + across + 2.0 * both, ridges - across, ridges + across - 2.0 * both]
        mean, mixed, difference = 0.25 * np.array(own)
        cosine, sine = cosine_and_sine(line.lay_angle)
        turned = np.array([cosine**2 - sine**2, 2.0 * cosine * sine])  # by twice the angle
        found[0, 0] += mean
        found[0, 1:] += mixed * turned
        found[1:, 1:] += both * np.eye(2) + (difference - both) * np.outer(turned, turned)
    found[1:, 0] = found[0, 1:]
    return found


def summit_motion(
    spec: LineSpecLike, slide_to_roll_ratio: float, answered: Sequence[Pair] = UNCHANGED
) -> summits.SummitMotion:
    """How the summits of both surfaces together change while they slide over one another.

    Parameters
    ----------
    spec : LineSpecLike
        As in `surface_moments`.
    slide_to_roll_ratio : float
        Slide-to-roll ratio.
    answered : tuple of tuple of numpy.ndarray, optional
        What becomes of either surface's waves, from `lube.contact.surface_answers.waves_in_gap`; by
        default they stay as drawn.

    Returns
    -------
    SummitMotion
        Of the surfaces in the gap.
    """
    waves = [surface_waves(spec, roller) for roller in range(len(spec.lines))]
    means = [0.5 * (along**2 + across**2) for along, across, _ in waves]
    powers = [
        np.atleast_2d(_square(kept) * power)
        for (kept, _), (*_, power) in zip(answered, waves, strict=True)
    ]
    # Seen in motion with the mean of both, their changes are independent of what they are.
    curved = [np.sum(power * mean**2, axis=1) for power, mean in zip(powers, means, strict=True)]
    speeds = np.array(surface_speeds(1.0, slide_to_roll_ratio))
    mean_speed = np.average(np.broadcast_to(speeds[:, None], np.shape(curved)), 0, curved)
    change, moving, standing = 0.0, 0.0, 0.0
    for roller, (along, across, drawn) in enumerate(waves):
        (kept, changing), mean = answered[roller], means[roller]
        own = (mean_speed - speeds[roller])[:, None]
        moved = drawn * _square(1j * own * along * kept + mean_speed[:, None] * changing)
        change = change + np.sum(moved * mean**2, axis=1)
        slopes, by_curvature = np.stack([along, across]), mean ** np.arange(3)[:, None]
        moving = moving + np.einsum("iw,jw,cw->ijc", slopes, slopes, moved)
        each = slopes, slopes, by_curvature, powers[roller]
        standing = standing + np.einsum("iw,jw,kw,cw->kijc", *each)
    (first, second), mixed, gradients = standing
    inverse = np.array([[second[1], -first[1]], [-first[1], first[0]]])
    inverse /= first[0] * second[1] - first[1] ** 2
    gradients = gradients - np.einsum("ijc,jkc,kmc->imc", mixed, inverse, mixed)
    return summits.SummitMotion(change, moving, gradients)


def _square(complex_values):
    return np.real(complex_values) ** 2 + np.imag(complex_values) ** 2


@functools.lru_cache(maxsize=1)
def height_moments(spec: LineSpecLike) -> Array:
    """Second moments of the heights of both surfaces and of their changes.

    Parameters
    ----------
    spec : LineSpecLike
        As in `surface_moments`.

    Returns
    -------
    numpy.ndarray, shape (2, 1, 4, 4)
        Mean squares and products of each surface's heights, of their slopes along rolling and along
        the rollers, and of their change at a fixed place per way of the surface, m^2 times 1/m for
        each change.
    """
    found = np.zeros((2, 1, 4, 4))
    for roller, moments in enumerate(found[:, 0]):
        along, across, mixed = _slopes(spec, roller)
        moments[0, 0] = wave_moments(spec, roller)[0]
        moments[1:3, 1:3] = [[along, mixed], [mixed, across]]
    # What moves along rolling changes by the slope there, with the opposite sign.
    found[..., 3] = -found[..., 1]
    found[..., 3, :] = -found[..., 1, :]
    return found


def _slopes(spec, roller):
    """Mean square slopes of a surface along rolling and along the rollers, and their product."""
    line, slope = spec.lines[roller], wave_moments(spec, roller)[1]
    ridges = slope / (1.0 + line.lay_ratio**2)
    across = slope - ridges
    cosine, sine = cosine_and_sine(line.lay_angle)
    along_rolling = ridges * cosine**2 + across * sine**2
    along_rollers = ridges * sine**2 + across * cosine**2
    return np.array([along_rolling, along_rollers, (ridges - across) * cosine * sine])
