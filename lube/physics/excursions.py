r"""Theory of a Gaussian line that rises above a high film.

A stationary Gaussian line z(x) is described by its moments :math:`m_0 = \langle z^2 \rangle`,
:math:`m_2 = \langle z'^2 \rangle` and :math:`m_4 = \langle z''^2 \rangle`.

References
----------
S. O. Rice, Mathematical analysis of random noise, Bell Syst. Tech. J. 23 (1944) 282-332 and
24 (1945) 46-156.
"""

import math
from collections.abc import Sequence

import numpy as np
import scipy.special

from lube.types import Array, Values

_NODES, _WEIGHTS = np.polynomial.laguerre.laggauss(60)


def crossing_rate(level: Values, moments: Sequence[float]) -> Values:
    r"""Upward crossings of a level per unit length (Rice).

    .. math:: \nu = \frac{1}{2 \pi} \sqrt{\frac{m_2}{m_0}} \exp\left( -\frac{h^2}{2 m_0} \right)

    Parameters
    ----------
    level : float or numpy.ndarray
        Level h, m.
    moments : sequence of float
        :math:`m_0` (m^2), :math:`m_2` and :math:`m_4` (1/m^2).

    Returns
    -------
    float or numpy.ndarray
        1/m.

    Examples
    --------
    >>> f"{crossing_rate(0.0, (1.0, 4.0, 100.0)):.4f}"
    '0.3183'
    """
    m0, m2, _ = moments
    return math.sqrt(m2 / m0) / (2.0 * math.pi) * np.exp(-0.5 * np.square(level) / m0)


def sharp_summit_share(level: Array, moments: Sequence[float], curvature: float) -> Array:
    r"""Share of the summits above a level that are sharper than a given curvature.

    Summits at the height z with the curvature :math:`\kappa = -z''` have the density

    .. math:: \frac{\kappa}{\sqrt{2 \pi m_2}} \, p(z, \kappa) ,

    where p is Gaussian with the variances :math:`m_0` and :math:`m_4` and the covariance
    :math:`m_2`.

    Parameters
    ----------
    level : numpy.ndarray
        Levels, above zero, m.
    moments : sequence of float
        As in `crossing_rate`.
    curvature : float
        Curvature, 1/m.

    Returns
    -------
    numpy.ndarray
        Share of each level, from 0 to 1.

    Examples
    --------
    >>> sharp_summit_share(np.array([5.0]), (1.0, 4.0, 100.0), 20.0).round(3)
    array([0.707])
    """
    return _summits(level, moments, curvature) / _summits(level, moments, 0.0)


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


def _summits(level, moments, least_curvature):
    """Count the summits above levels and a curvature, up to a factor of each level."""
    m0, m2, m4 = moments
    # Gauss-Laguerre quadrature over t, where z = h + m0 t / h.
    scale = np.asarray(level)[..., None]
    height = scale + m0 / scale * _NODES
    mean = m2 / m0 * height  # of the curvature at this height
    deviation = math.sqrt(m4 - m2**2 / m0)
    excess = (mean - least_curvature) / deviation
    normal = np.exp(-0.5 * excess**2) / math.sqrt(2.0 * math.pi)
    expected = mean * scipy.special.ndtr(excess) + deviation * normal
    return np.sum(_WEIGHTS * np.exp(-0.5 * m0 * (_NODES / scale) ** 2) * expected, axis=-1)
