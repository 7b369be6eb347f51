"""Break-up of the boundary layer on one segment (paper, Eq. 6)."""

import math

from lube.kernels.compiler import inlined
from lube.types import Array, Values


def layer_factor(
    reduced_modulus: float,
    critical_thickness: float,
    shear_strength: float,
    spacing: float,
    height_step: float,
) -> float:
    r"""Combine the constants of Eqs. 5 and 6 into the one factor that decides on break-up.

    Parameters
    ----------
    reduced_modulus : float
        Reduced modulus :math:`E^*`, Pa.
    critical_thickness : float
        Critical thickness :math:`h_c` of the boundary layer, m.
    shear_strength : float
        Limiting shear stress :math:`\tau_0` of the boundary layer, Pa.
    spacing : float
        Distance :math:`\Delta x` of neighbouring points, m.
    height_step : float
        Height step :math:`q`, m.

    Returns
    -------
    float
        The factor :math:`c`, per height step of overlap.

    Notes
    -----
    A segment of :math:`n` points whose overlaps sum to :math:`S` height steps has the length
    :math:`D = n \Delta x` and carries the force :math:`F = E^* \Delta x\, q S` (Eq. 5). Its
    boundary layer breaks where the remaining thickness (Eq. 6) is below the critical one:

    .. math::

        h_l = \frac{\pi \tau_0}{12} \frac{D^3}{F} < h_c
        \quad\Leftrightarrow\quad
        n^3 < c\, S, \qquad c = \frac{12 E^* q h_c}{\pi \tau_0 \Delta x^2}

    Examples
    --------
    The paper's rollers, with a million points around each and height steps of 1 pm:

    >>> factor = layer_factor(1.154e11, 5e-9, 1e6, 3.1416e-7, 1e-12)
    >>> f"{factor:.4f}"
    '0.0223'
    """
    strength = math.pi * shear_strength * spacing**2
    return 12.0 * reduced_modulus * height_step * critical_thickness / strength


@inlined
def layer_breaks(points: Values, overlap: Values, factor: float) -> bool | Array:
    """Decide whether the boundary layer on a segment breaks, h_l < h_c (paper, Eq. 6).

    Parameters
    ----------
    points : int or numpy.ndarray
        Number n of points in the segment.
    overlap : int or numpy.ndarray
        Sum S of their overlaps, height steps.
    factor : float
        c of `layer_factor`.

    Returns
    -------
    bool or numpy.ndarray
        True if n^3 < c S. A layer of exactly the critical thickness holds.

    Examples
    --------
    >>> layer_breaks(2, 8, 1.0), layer_breaks(2, 9, 1.0)
    (False, True)
    """
    return 1.0 * points * points * points < factor * overlap
