"""The film across the strip 2a x L', and what theory says of contact under it.

Contacts of surfaces are small and far apart where they do not merge. So a contact is in the strip
while it passes the contact width, and a little longer, as it has an extent of its own: on the way
w, the *passage width*.
"""

import math
from collections.abc import Callable
from dataclasses import dataclass, field, replace

import numpy as np
import scipy

from lube.contact.surface_answers import AnsweredStrip
from lube.grid.operating_points import surface_speeds
from lube.physics.excursions import (
    SurfaceMoments,
    SurfaceMotion,
    appearing_contacts,
    expected_contacts,
    sharp_surface_summit_share,
)
from lube.surfaces.lay import cosine_and_sine
from lube.surfaces.rare_contact import likely_part
from lube.surfaces.rough_surface import Surface
from lube.surfaces.spectra import pair_moments, spectrum_moments
from lube.surfaces.synthetic import LineSpecLike
from lube.types import Array, Pair

COLUMNS = 200
"""Columns of a film with a shape, for the contacts that theory expects."""
HIGHEST = 37.0
"""Lambda ratio up to which the number of contacts is a number above zero."""


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

    def films(self, spacing: float) -> Array:
        """Film at the columns of a grid, m."""
        return self.thickness(self._columns(spacing))

    def breaking_curvatures(self, spacing: float, sharp: float) -> Array:
        """Mean curvature of the surface at which a summit breaks its layer, at each column, 1/m.

        The mean curvature of the overlap is then `sharp`. Half of the film's second derivative
        contributes to it.
        """
        return sharp - 0.5 * self.thickness(self._columns(spacing), 2)

    def answered(self, surface: Surface, rows: Pair) -> AnsweredStrip | None:
        """Find what the oil adds to a surface, for covariances over rows before and after."""
        if self.answers is None or not any(one.shapes.size for one in self.answers):
            return None
        columns = self._columns(surface.spacing[1])
        return AnsweredStrip(self.answers, surface, columns[0], columns.size, *rows)

    def expected(self, moments: SurfaceMoments, length: float, sharp: float) -> Pair:
        """Find the numbers of contacts, and of breakthroughs, that theory expects in the strip.

        Parameters
        ----------
        moments : SurfaceMoments
            As in `lube.physics.excursions.expected_contacts`.
        length : float
            Length of the strip along the rollers, m.
        sharp : float
            Mean curvature of the overlap at which the boundary layer breaks, 1/m.
        """
        if self.has_edges:
            films = self.thickness([self.begin])
            contacts = expected_contacts(films, moments, length, self.width)
        else:
            spacing = self.width / COLUMNS
            films, sharp = self.films(spacing), self.breaking_curvatures(spacing, sharp)
            contacts = _without_edges(films, moments, length, spacing)
        broken = contacts * sharp_surface_summit_share(films, moments, sharp)
        return contacts.sum(), broken.sum()

    def passage(self, moments: SurfaceMoments, length: float) -> tuple[float, Array, Array]:
        """Find how far a contact moves while it is in the strip.

        Parameters
        ----------
        moments, length
            As in `expected`.

        Returns
        -------
        width : float
            Mean way of a contact through the strip, m.
        lags, common : numpy.ndarray
            Distances of two strips along the circumference, m, and the fraction of their contacts
            that they have in common.
        """
        if self.has_edges:
            films = _lowered(self.thickness([0.0]), moments)
            contacts = expected_contacts(films, moments, length, self.width)
            passing = _without_edges(films, moments, length, 1.0)
            width = (contacts / passing).item()
            common = np.linspace(1.0, 0.0, COLUMNS + 1)
            return width, width * (1.0 - common), common
        spacing = self.width / COLUMNS
        films = _lowered(self.films(spacing), moments)
        columns = _without_edges(films, moments, length, spacing)
        # A contact of both strips reaches above the film at both places.
        common = np.zeros(films.size + 1)
        for lag in range(films.size):
            higher = np.maximum(films[lag:], films[: films.size - lag])
            common[lag] = _without_edges(higher, moments, length, spacing).sum()
        width = spacing * columns.sum() / columns.max()
        return width, spacing * np.arange(common.size), common / common[0]

    def appearing(self, moments: SurfaceMoments, motion: SurfaceMotion, length: float) -> float:
        """Find how many times more contacts appear in the strip than in pure rolling.

        Parameters
        ----------
        moments, length
            As in `expected`.
        motion : SurfaceMotion
            From `surface_motion`.
        """
        rolling = SurfaceMotion(moments.along, -moments.along, -moments.mixed)
        if self.has_edges:
            film, size = _lowered(self.thickness([0.0]), moments), (length, self.width)
            more = appearing_contacts(film, moments, motion, *size)
            return (more / appearing_contacts(film, moments, rolling, *size)).item()
        spacing = self.width / COLUMNS
        films = _lowered(self.films(spacing), moments)
        # Without slip contacts come in where the film is thinnest. With slip, others appear inside.
        inside = [
            appearing_contacts(films, moments, motion, length, width) for width in (spacing, 0.0)
        ]
        columns = _without_edges(films, moments, length, spacing)
        return 1.0 + spacing * np.sum(inside[0] - inside[1]) / columns.max()

    def _columns(self, spacing):
        return self.begin + spacing * (np.arange(max(int(self.width / spacing), 1)) + 0.5)


def _lowered(films, moments):
    """Films as they are, or so much lower that there are contacts, for ratios of their numbers."""
    return films - max(films.min() - HIGHEST * math.sqrt(moments.height), 0.0)


def _without_edges(films, moments, length, spacing):
    """Contacts that theory expects in columns of a strip whose films go on beyond them."""
    # Without edges along the rollers, contacts are in proportion to the width.
    widths = expected_contacts(films, moments, length, spacing)
    return widths - expected_contacts(films, moments, length, 0.0)


def surface_moments(spec: LineSpecLike) -> SurfaceMoments:
    """Moments of the surface that a pair of lines stands for, expected from their spectra.

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
    m0, _, m4 = pair_moments(spec)
    return SurfaceMoments(m0, *slopes.tolist(), m4)


def surface_motion(spec: LineSpecLike, slide_to_roll_ratio: float) -> SurfaceMotion:
    """Moments of both surfaces in motion, per way of the entrainment speed.

    Parameters
    ----------
    spec : LineSpecLike
        As in `surface_moments`.
    slide_to_roll_ratio : float
        Slide-to-roll ratio.
    """
    speeds = surface_speeds(1.0, slide_to_roll_ratio)
    both = [(speed, _slopes(spec, roller)) for roller, speed in enumerate(speeds)]
    along, _, across = sum(-speed * slopes for speed, slopes in both)
    return SurfaceMotion(sum(speed**2 * slopes[0] for speed, slopes in both), along, across)


def _slopes(spec, roller):
    """Mean square slopes of a surface along rolling and along the rollers, and their product."""
    line, slope = spec.lines[roller], spectrum_moments(spec, roller)["rms_slope"] ** 2
    ridges = slope / (1.0 + line.lay_ratio**2)
    across = slope - ridges
    cosine, sine = cosine_and_sine(line.lay_angle)
    return np.array(
        [
            ridges * cosine**2 + across * sine**2,
            ridges * sine**2 + across * cosine**2,
            (ridges - across) * cosine * sine,
        ]
    )
