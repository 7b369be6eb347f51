r"""How far the contact share of one pair of surfaces lies from the mean over all pairs.

Two strips a distance s apart along the circumference have the fraction :math:`\rho(s)` of their
contacts in common (`lube.contact.strip_film`). If groups of contacts come independently of one
another, :math:`n_g = -\ln(1 - P)` of them are in the strip on average, and contact of both strips
has the covariance

.. math:: c(s) = (1 - P)^2 \left( e^{n_g \rho(s)} - 1 \right)

From it follows how far the share of time of one pair of rollers lies from the mean P over all.

With slip, or rollers of different size, the surfaces meet in new alignments. A summit of one
surface that touched then meets other heights of the other, and touches more often than any place
does. The contacts that two alignments with the surface i in common share beyond chance are the
fraction

.. math:: \chi_i = \frac{\int \left( \Phi_2(u, u; w_i \rho_i(r)) - p^2 \right) dr}
          {\int \left( \Phi_2(u, u; \rho(r)) - p^2 \right) dr}

of those of one alignment. :math:`\Phi_2` is the probability that both of two normal variables
exceed the film u in rms heights, p that one does, :math:`w_i` the surface's part of the mean square
height, and :math:`\rho_i` the correlation of its heights over the distance r. The part of the
variance that new alignments do not average out follows from c(s) with :math:`n_g \chi_i`.

With slip a contact also ends because the surfaces move apart. Then contacts are on average in the
strip for a shorter way of the rollers, d in place of :math:`d_0`. If they end at a constant rate,
two times between which the rollers move by s, and the surfaces by :math:`v_i s / v`, have in common

.. math:: \rho_S(s) = \left( 1 - \sum_i \chi_i \right) \rho(s)\, e^{-s (1/d - 1/d_0)}
          + \sum_i \chi_i\, \rho(s\, v_i / v)

A summit of the slower surface stays in the strip for long, and one of a surface at rest for ever,
where it touches again and again. One of a small roller returns with each of its turns.

The layer breaks at a fraction f of the contacts only. If a summit touches again in a new alignment,
its curvature has changed. Curvatures are taken to be normal, and to have the correlation
:math:`w_i^2` in alignments with the surface i in common, by its part :math:`w_i` of the mean square
curvature. So :math:`\chi_i` is multiplied by the fraction of broken layers that break again,

.. math:: q_i = \Phi_2(t, t; w_i^2) / f, \qquad f = 1 - \Phi(t)

With slip layers also break and hold while a contact lasts, until no more of them are broken than of
other contacts. If a layer is broken on the way :math:`d_b` of the rollers,

.. math:: f + (1 - f) \exp\left( -\frac{s}{1 - f} \left( \frac{1}{d_b} - \frac1d \right) \right)

is another factor of the first term.

If the roughness of both surfaces drifts, and heights have the correlation c with those of an
earlier turn, both turns share the fraction :math:`\chi` with :math:`c \rho` in place of
:math:`w_i \rho_i`. With it the correlation of their shares follows in the same way.
"""

from collections.abc import Callable

import numpy as np
import scipy

from lube.grid.operating_points import surface_speeds
from lube.surfaces.rough_surface import field, rough_surface, surface_waves
from lube.surfaces.synthetic import LineSpecLike
from lube.types import Array, Pair

_LEVELS = np.sin(np.linspace(-0.5 * np.pi, 0.5 * np.pi, 4001))
"""Correlations at which places of a surface are counted."""
_ANGLES = 65
"""Angles whose cosines are the correlations of a drift."""


def pair_deviation(probability: float, lags: Array, common: Array, perimeter: float) -> float:
    """Compute how far the share of a revolution scatters between pairs of rollers.

    The rollers are equal and roll without slip, so that a revolution shows all of their alignment.

    Parameters
    ----------
    probability : float
        Mean probability P over pairs of rollers.
    lags, common : numpy.ndarray
        From `lube.contact.strip_film.StripFilm.common`.
    perimeter : float
        Way of a revolution, m.

    Returns
    -------
    float
        Standard deviation of the share.
    """
    known = np.clip(probability, 1e-300, 1.0 - 1e-12)
    correlation = (1.0 - known) / known * np.expm1(-np.log1p(-known) * common)
    # Both ways along the circumference.
    windows = perimeter / (2.0 * np.trapezoid(correlation, lags))
    return np.sqrt(probability * (1.0 - probability) / max(windows, 1.0))


def turn_ratio(
    probability: float, lags: Array, common: Array, recurring: Array, perimeters: Pair
) -> float:
    """Compute the variance of a turn of pure rolling, over that of equal rollers.

    Parameters
    ----------
    probability, lags, common, recurring
        As in `persistent_part`.
    perimeters : tuple of float
        As in `slip_ratio`.

    Returns
    -------
    float
        The ratio.
    """
    return slip_ratio(probability, lags, common, recurring, lags[[-1, -1]], 0.0, perimeters)


def persistent_part(probability: float, lags: Array, common: Array, recurring: Array) -> Array:
    r"""Compute the part of the variance between pairs that new alignments do not average out.

    Parameters
    ----------
    probability, lags, common
        As in `pair_deviation`.
    recurring : numpy.ndarray, shape (roller,)
        :math:`\chi_i`, from `RecurringContacts`.

    Returns
    -------
    numpy.ndarray, shape (roller,)
        The part, by either surface.
    """
    groups = -np.log1p(-np.clip(probability, 1e-300, 1.0 - 1e-12))
    parts = np.reshape(recurring, (-1, 1)), 1.0
    alone, whole = (np.trapezoid(np.expm1(groups * part * common), lags) for part in parts)
    return alone / whole


def slip_ratio(
    probability: float,
    lags: Array,
    common: Array,
    recurring: Array,
    passages: Pair,
    slide_to_roll_ratio: float,
    perimeters: Pair,
    turns: float = 1.0,
    broken: Pair | None = None,
) -> float:
    """Compute the variance of the share of up to a turn, over that of rolling of equal rollers.

    Parameters
    ----------
    probability, lags, common, recurring
        As in `persistent_part`.
    passages : tuple of float
        Way d of the rollers while a contact is in the strip, with slip, and without slip, m.
    slide_to_roll_ratio : float
        Slide-to-roll ratio.
    perimeters : tuple of float
        Perimeters of both rollers, m; a turn of pure rolling is that of the first.
    turns : float, optional
        Turns of the roller with the faster surface, 1 at most.
    broken : tuple of float, optional
        Fraction of contacts whose layer breaks, and way of the rollers while it is broken, m; by
        default it breaks at all of them, as long as they last.

    Returns
    -------
    float
        The ratio.
    """
    if slide_to_roll_ratio == 0.0 and perimeters[0] == perimeters[1]:
        return 1.0 / turns
    speeds = surface_speeds(1.0, slide_to_roll_ratio)
    whole_way = turns * perimeters[int(np.argmax(speeds))] / max(speeds)
    fraction, shortest = broken or (1.0, passages[0])
    ways = [[0.0], np.geomspace(1e-3 * min(shortest, whole_way), whole_way, 2000)]
    for speed, perimeter in zip(speeds, perimeters, strict=True):
        passed = perimeter * np.arange(1.0, speed * whole_way / perimeter + 1.0)
        ways += [np.add.outer(passed, side * lags).ravel() / max(speed, 1e-9) for side in (-1, 1)]
    way = np.unique(np.clip(np.concatenate(ways), 0.0, whole_way))
    ending = max(1.0 / passages[0] - 1.0 / passages[1], 0.0)
    holding = max(1.0 / shortest - 1.0 / passages[0], 0.0) / max(1.0 - fraction, 1e-9)

    def rest(way):
        return np.interp(way, lags, common, right=0.0)

    alike = (1.0 - np.sum(recurring)) * rest(way) * np.exp(-way * ending)
    alike *= fraction + (1.0 - fraction) * np.exp(-way * holding)
    for part, speed, perimeter in zip(recurring, speeds, perimeters, strict=True):
        moved = speed * way % perimeter
        alike += part * rest(np.minimum(moved, perimeter - moved))
    groups = -np.log1p(-np.clip(probability, 1e-300, 1.0 - 1e-12))
    rolling = np.trapezoid(np.expm1(groups * common), lags) / perimeters[0]
    weight = (1.0 - way / whole_way) / whole_way
    return np.trapezoid(weight * np.expm1(groups * alike), way) / rolling


def drifting_shares(
    probability: float, lags: Array, common: Array, kept: Callable[[Array], Array]
) -> Callable[[Array], Array]:
    """Find how the shares of two turns are correlated while the roughness drifts.

    Parameters
    ----------
    probability, lags, common
        As in `pair_deviation`.
    kept : callable
        Fraction of contacts that both turns share, by the correlation of the heights in them.

    Returns
    -------
    callable
        Correlation of the shares, by that of the heights, from 0 to 1.
    """
    # Near the correlation 1 the fraction falls as its angle does.
    angles = np.linspace(0.0, 0.5 * np.pi, _ANGLES)
    alike = persistent_part(probability, lags, common, kept(np.cos(angles)))
    return lambda correlation: np.interp(np.arccos(correlation), angles, alike)


class RecurringContacts:
    """The fraction of contacts that recurs if one surface meets another part of the other.

    Parameters
    ----------
    spec : LineSpecLike
        Parameters of the lines that stand for the surfaces.
    """

    def __init__(self, spec: LineSpecLike) -> None:
        surface = rough_surface(spec)
        parts = surface.first_part, 1.0 - surface.first_part, 1.0
        edges = np.concatenate([[-2.0], 0.5 * (_LEVELS[1:] + _LEVELS[:-1]), [2.0]])
        covariances = (field(surface.variances * part, surface.points) for part in parts)
        self._counts = [np.histogram(each / surface.rms**2, edges)[0] for each in covariances]
        waves = (surface_waves(spec, roller) for roller in range(len(spec.lines)))
        curved = [np.sum(power * (along**2 + down**2) ** 2) for along, down, power in waves]
        self._curved = np.array(curved) / sum(curved)

    def at(self, film: float, broken: float = 1.0) -> Array:
        """Find the fraction for either surface.

        Parameters
        ----------
        film : float
            Film over the rms height of both surfaces together.
        broken : float, optional
            Fraction of contacts whose layer breaks; only those that break it are counted.

        Returns
        -------
        numpy.ndarray, shape (2,)
        """
        *alone, both = np.einsum("pl,l->p", self._counts, _excess(film))
        found = np.divide(alone, both, out=np.zeros(2), where=both > 0.0)
        broken = np.clip(broken, 1e-12, 1.0 - 1e-12)
        again = np.interp(self._curved**2, _LEVELS, _excess(scipy.special.ndtri(broken)))
        return found * (broken + again / broken)

    def drifted(self, film: float, correlation: Array) -> Array:
        """Find the fraction that is left after a drift of both surfaces.

        Parameters
        ----------
        film : float
            As in `at`.
        correlation : numpy.ndarray
            Correlations of the heights with those before the drift, from 0 to 1.

        Returns
        -------
        numpy.ndarray
            Of the same shape.
        """
        excess, counts = _excess(film), self._counts[-1]
        left = np.interp(np.multiply.outer(correlation, _LEVELS), _LEVELS, excess)
        return np.einsum("...l,l->...", left, counts) / np.einsum("l,l->", excess, counts)


def _excess(film):
    """Probability that two normal variables exceed a film, beyond chance, at `_LEVELS`."""
    # Its derivative with the correlation sin(t) is the density of both at the film (Plackett).
    angles = np.arcsin(_LEVELS)
    with np.errstate(divide="ignore"):
        density = np.exp(-max(film**2, 1e-12) / (1.0 + _LEVELS)) / (2.0 * np.pi)
    sums = scipy.integrate.cumulative_trapezoid(density, angles, initial=0.0)
    return sums - np.interp(0.0, angles, sums)
