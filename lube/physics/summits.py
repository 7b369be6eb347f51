"""Theory of the summits of a Gaussian line or surface above a high film: how sharp they are.

References
----------
S. O. Rice, Mathematical analysis of random noise, Bell Syst. Tech. J. 23 (1944) 282-332 and
24 (1945) 46-156.
"""

import itertools
import math
from collections.abc import Callable, Sequence
from typing import NamedTuple

import numpy as np
import scipy
from numpy.polynomial.laguerre import laggauss
from numpy.polynomial.legendre import leggauss

from lube.physics.excursions import SurfaceMoments
from lube.types import Array, Values

_MANY, _FEW = 60, 20
"""Nodes for heights and for curvatures; with the few, and the others for d and t, fractions are off
by 0.001."""
_NODES = {count: (*laggauss(count), *leggauss(count)) for count in (_MANY, _FEW)}
_OTHERS = leggauss(12)
_LOWEST = 0.2
"""Rms heights: summits above lower levels are taken as those above this one."""
_WIDE, _NEAR = 9.0, 5.0
"""Standard deviations beyond which the normal density of mean curvatures, or of d and t, is cut."""


class SummitMotion(NamedTuple):
    """How summits change while two surfaces slide over one another, per rolled distance.

    Attributes
    ----------
    change : numpy.ndarray, shape (levels,) or (1,)
        Mean square change of the mean curvature at a fixed place, 1/m^4.
    slopes : numpy.ndarray, shape (2, 2, levels) or (2, 2, 1)
        Mean products of the changes of the slopes along rolling and along the rollers, 1/m^2.
    gradients : numpy.ndarray, of the same shape
        Mean products of the changes of the mean curvature along rolling and along the rollers, at
        places without slope, 1/m^4.
    """

    change: Array
    slopes: Array
    gradients: Array


def breaking_curvature(
    reduced_modulus: float, critical_thickness: float, shear_strength: float
) -> float:
    r"""Curvature of a summit above which its boundary layer breaks (paper, Eqs. 5 and 6).

    A parabolic summit of curvature :math:`\kappa` that overlaps over the length D carries
    :math:`F = E^* \kappa D^3 / 12`, so the layer's thickness is the same at any overlap:

    .. math::

        h_l = \frac{\pi \tau_0}{12} \frac{D^3}{F} = \frac{\pi \tau_0}{E^* \kappa} < h_c
        \quad\Leftrightarrow\quad \kappa > \frac{\pi \tau_0}{E^* h_c}

    Parameters
    ----------
    reduced_modulus : float
        Reduced modulus :math:`E^*`, Pa.
    critical_thickness : float
        Critical thickness :math:`h_c` of the boundary layer, m.
    shear_strength : float
        Limiting shear stress :math:`\tau_0` of the boundary layer, Pa.

    Returns
    -------
    float
        1/m.

    Examples
    --------
    >>> f"{breaking_curvature(1.154e11, 5e-9, 1e6):.0f}"
    '5445'
    """
    return math.pi * shear_strength / (reduced_modulus * critical_thickness)


def sharp_summit_share(level: Array, moments: Sequence[float], curvature: float) -> Array:
    r"""Fraction of a line's summits above a level that are sharper than a given curvature.

    Summits at the height z with the curvature :math:`\kappa = -z''` have the density

    .. math:: \frac{\kappa}{\sqrt{2 \pi m_2}} \, p(z, \kappa) ,

    where p is Gaussian with the variances :math:`m_0` and :math:`m_4` and the covariance
    :math:`m_2`.

    Parameters
    ----------
    level : numpy.ndarray
        Levels, above zero, m.
    moments : sequence of float
        As in `lube.physics.excursions.crossing_rate`.
    curvature : float
        Curvature, 1/m.

    Returns
    -------
    numpy.ndarray
        Fraction at each level, from 0 to 1.

    Examples
    --------
    >>> sharp_summit_share(np.array([5.0]), (1.0, 4.0, 100.0), 20.0).round(3)
    array([0.707])
    """
    return _share(level, moments, curvature, lambda kappa, _: kappa)


def sharp_surface_summit_share(
    level: Array, moments: SurfaceMoments, curvature: Values, curvatures: Array | None = None
) -> Array:
    r"""Fraction of a surface's summits above a level that are sharper than a given curvature.

    With the mean curvature :math:`\kappa`, half the difference d of the curvatures along rolling
    and along the rollers, and the twist t, summits have the density

    .. math::

        \left\langle \left( \kappa^2 - d^2 - t^2 \right)^+ \right\rangle_{d, t \mid z, \kappa}
        p(z, \kappa) ,

    where p is Gaussian with the variances :math:`m_0` and :math:`\mu` and the covariance
    :math:`(m_a + m_b)/2`, the mean square slope of all directions; :math:`4 \mu` is the mean square
    of the sum of both curvatures. If the surface is isotropic, d and t are independent of z and
    :math:`\kappa`, and the mean is :math:`\kappa^2 - \mu (1 - e^{-\kappa^2/\mu})` (Nayak).

    Parameters
    ----------
    level : numpy.ndarray
        Levels, m, shape (levels,).
    moments : SurfaceMoments
        As in `lube.physics.excursions.expected_contacts`, for all levels or for each.
    curvature : float or numpy.ndarray
        Mean curvature, 1/m, for all levels or for each.
    curvatures : numpy.ndarray, shape (3, 3) or (3, 3, levels), optional
        Mean squares and products of :math:`\kappa`, d and t, 1/m^2; by default those of an
        isotropic surface.

    Returns
    -------
    numpy.ndarray
        Fraction at each level, from 0 to 1; 0 where there are no summits.

    References
    ----------
    P. R. Nayak, Random process model of rough surfaces, J. Lubr. Technol. 93 (1971) 398-407.

    Examples
    --------
    >>> moments = SurfaceMoments(1.0, along=2.0, across=2.0, mixed=0.0, curvature=100.0)
    >>> sharp_surface_summit_share(np.array([5.0]), moments, 10.0).round(3)
    array([0.866])
    >>> curvatures = 25.0 * np.diag([1.0, 0.5, 0.5])
    >>> sharp_surface_summit_share(np.array([5.0]), moments, 10.0, curvatures).round(3)
    array([0.866])
    """
    summits = _every_summit(level, moments, curvatures)
    # The sums are not exact to the last digits.
    return np.minimum(_over(summits.sharper(curvature), summits.sharper(0.0)), 1.0)


def sharpening_summits(
    level: Array,
    moments: SurfaceMoments,
    curvature: Values,
    curvatures: Array | None,
    motion: SummitMotion,
) -> Array:
    r"""How often the summits above a level become sharper than a given curvature.

    While two surfaces slide over one another, the mean curvature of a summit of their sum changes:
    at a fixed place by :math:`\dot\kappa`, and because the summit moves. It follows the place where
    both slopes are zero, with the velocity :math:`-H^{-1} \dot{\vec s}`, by the changes
    :math:`\dot{\vec s}` of the slopes and the matrix H of second derivatives. With the covariances
    C of these changes, and G of the gradient of :math:`\kappa` at a summit, the change has the
    mean square

    .. math:: \langle \dot\kappa^2 \rangle + \mathrm{tr}(H^{-1} C H^{-1} G)

    and is taken as normal: summits of the curvature :math:`\kappa` become sharper at
    :math:`(2 \pi)^{-1/2}` times its square root. This is some 4 % too much, since velocities are
    normal, too.

    Parameters
    ----------
    level, moments, curvature, curvatures
        As in `sharp_surface_summit_share`.
    motion : SummitMotion
        How the curvature changes.

    Returns
    -------
    numpy.ndarray
        Per rolled distance, over the number of all summits above each level, 1/m; 0 where there are
        none.

    References
    ----------
    S. O. Rice, as above, of the curvature of summits in place of heights.

    Examples
    --------
    Surfaces that do not slide over one another keep their summits:

    >>> moments = SurfaceMoments(1.0, along=2.0, across=2.0, mixed=0.0, curvature=100.0)
    >>> motion = SummitMotion(np.zeros(1), np.zeros((2, 2, 1)), 300.0 * np.eye(2)[..., None])
    >>> sharpening_summits(np.array([5.0]), moments, 10.0, None, motion)
    array([0.])
    """
    change, slopes, gradients = motion
    every = _every_summit(level, moments, curvatures).sharper(0.0)
    if curvatures is None:
        curvatures = 0.25 * moments.curvature * np.diag([1.0, 0.5, 0.5])

    def speed(kappa, difference, twist):
        determinant = kappa**2 - difference**2 - twist**2
        # The inverse of H times its determinant; both signs are alike.
        rows = (kappa - difference, -twist), (-twist, kappa + difference)
        square = _apart(change, 2) * determinant**2
        for i, j, k, m in itertools.product(range(2), repeat=4):
            both = _apart(slopes[j, k] * gradients[m, i], 2)
            square = square + rows[i][j] * rows[k][m] * both
        return np.sqrt(square)

    def mean_speed(kappa, difference, twist, spread):
        bound = np.sqrt(np.maximum(kappa**2 - difference**2, 0.0))
        return _mean(lambda twist: speed(kappa, difference, twist), twist, spread, bound)

    summits = _summits(level, moments, _weight(moments, curvatures, mean_speed), _FEW)
    return _over(summits.at(curvature), every) / math.sqrt(2.0 * math.pi)


def _over(some, every):
    """Ratio; 0 where heights far above the mean are no summits, as the oil may flatten them."""
    some, every = np.broadcast_arrays(some, every)
    return np.divide(some, every, out=np.zeros(every.shape), where=every > 0.0)


def _every_summit(level, moments, curvatures):
    """Summits of a surface above levels, each of which counts."""
    if curvatures is not None:
        return _summits(level, moments, _weight(moments, curvatures, _mean_determinant), _FEW)
    spread = 0.25 * moments.curvature

    def determinant(kappa, _):
        return kappa**2 + spread * np.expm1(-(kappa**2) / spread)

    return _summits(level, moments, determinant, _MANY)


def _mean_determinant(kappa, difference, twist, spread):
    """Mean of the Gaussian curvature, where it is positive, over a normal twist."""
    square = np.maximum(kappa**2 - difference**2, 0.0)
    half = np.sqrt(square)
    low, high = (-half - twist) / spread, (half - twist) / spread
    inside = scipy.special.ndtr(high) - scipy.special.ndtr(low)
    at_low, at_high = (np.exp(-0.5 * end**2) / math.sqrt(2.0 * math.pi) for end in (low, high))
    found = (square - twist**2 - spread**2) * inside - 2.0 * twist * spread * (at_low - at_high)
    return found - spread**2 * (low * at_low - high * at_high)


def _weight(moments, curvatures, of_curvatures):
    """Mean of a function of a summit's mean curvature, d and t, by the first and its mean.

    The function is given the mean and the spread of t, over which it takes its own mean.
    """
    height, along, across, mixed, square = moments
    spread, slopes = 0.25 * square, 0.5 * (along + across)
    # The two others at a given height, then at a given mean curvature, too: normal, with means that
    # follow both, and with what is left of their mean squares and product.
    by_height = np.array(np.broadcast_arrays(slopes, 0.5 * (along - across), mixed))
    by_height = by_height.reshape(3, -1, 1, 1)
    left = np.reshape(curvatures, (3, 3, -1, 1, 1))
    left = left - by_height[:, None] * by_height / _apart(height, 2)
    by_curvature = left[1:, 0] / left[0, 0]
    left = left[1:, 1:] - left[0, 0] * by_curvature[:, None] * by_curvature
    least = 1e-12 * _apart(spread, 2)  # long ridges have no curvature along them
    first = np.sqrt(np.maximum(left[0, 0], least))
    shared = left[0, 1] / first
    second = np.sqrt(np.maximum(left[1, 1] - shared**2, least))

    def weight(kappa, mean):
        difference = by_height[1] / by_height[0] * mean + by_curvature[0] * (kappa - mean)
        twist = by_height[2] / by_height[0] * mean + by_curvature[1] * (kappa - mean)

        def at(differs):
            given = twist + shared / first * (differs - difference)
            return of_curvatures(kappa, differs, given, second)

        return _mean(at, difference, first, np.abs(kappa))

    return weight


def _mean(function, mean, spread, bound):
    """Mean of a function of a normal variable that is 0 beyond a bound to either side."""
    low, high = (np.clip(mean + side * spread, -bound, bound) for side in (-_NEAR, _NEAR))
    total, half = 0.0, 0.5 * (high - low)
    for one, part in zip(*_OTHERS, strict=True):
        at = low + half * (1.0 + one)
        total = total + part * np.exp(-0.5 * ((at - mean) / spread) ** 2) * function(at)
    return total * half / (spread * math.sqrt(2.0 * math.pi))


class _Summits(NamedTuple):
    """Summits above levels: those sharper than a curvature, and those of one, per curvature."""

    sharper: Callable[[Values], Array]
    at: Callable[[Values], Array]


def _summits(level, moments, weight, nodes):
    """Summits of a surface, which have a weight as in `_share`."""
    slopes = 0.5 * (moments.along + moments.across)
    return _above(level, (moments.height, slopes, 0.25 * moments.curvature), weight, nodes)


def _share(level, moments, least_curvature, weight):
    """Fraction of the summits above levels that are sharper than a curvature.

    They have a weight that depends on their curvature, and on its mean at their height.
    """
    summits = _above(level, moments, weight, _MANY)
    return summits.sharper(least_curvature) / summits.sharper(0.0)


def _above(level, moments, weight, nodes):
    """Summits above levels."""
    m0, covariance, variance = (_apart(each) for each in moments)
    above, above_weights, curvatures, curvature_weights = _NODES[nodes]
    # Heights are integrated by Gauss-Laguerre quadrature, with z = h + m0 t / h.
    # Lower levels would need more nodes, and change little.
    scale = np.maximum(_apart(level), _LOWEST * np.sqrt(m0))
    height = scale + m0 / scale * above
    heights = above_weights * np.exp(-0.5 * m0 * (above / scale) ** 2)
    # Curvatures, which are normal at a given height, by Gauss-Legendre quadrature.
    mean = covariance / m0 * height
    deviation = np.sqrt(variance - covariance**2 / m0)

    def at_heights(kappa, weights=1.0):
        normal = np.exp(-0.5 * ((kappa - mean[..., None]) / deviation[..., None]) ** 2)
        return weights * weight(kappa, mean[..., None]) * normal

    def sharper(least):
        low = np.maximum(_apart(least), mean - _WIDE * deviation)
        half = 0.5 * np.maximum(mean + _WIDE * deviation - low, 0.0)
        kappa = (low + half)[..., None] + half[..., None] * curvatures
        inner = half * np.sum(at_heights(kappa, curvature_weights), axis=-1)
        return np.sum(heights * inner, axis=-1)

    def at(kappa):
        return np.sum(heights * at_heights(_apart(kappa, 2))[..., 0], axis=-1)

    return _Summits(sharper, at)


def _apart(values, axes=1):
    """Values with some more axes, which are those of the nodes of a quadrature."""
    return np.reshape(values, (-1, *(1,) * axes))
