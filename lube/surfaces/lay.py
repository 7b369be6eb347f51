r"""Surfaces with a lay, such as ground ones, and the lines that stand for them.

A surface with a lay is an isotropic one, stretched: its ridges are r times longer along the lay
than across it. The wave with the components :math:`q_l` along the lay and :math:`q_c` across it
has the power of the isotropic surface's waves of the wavenumber

.. math:: q' = \sqrt{q_c^2 + r^2 q_l^2}

The line that stands for the surface has the surface's distribution of wavenumbers q. So line and
surface agree in the mean squares of the height, of the gradient (the line's slope) and of the sum
of both curvatures (the line's curvature), as they do without a lay. If the ridges are long, and run
across rolling, the line is the profile along rolling.

The line runs along rolling, as most waves of the surface must, or as many as of an isotropic one.
"""

import math

import numpy as np

from lube.types import Array, Pair, Values

DIRECTIONS = 64
"""Number of directions in a quarter of the plane of wave vectors."""
MOST_ALONG_ROLLING = 1.4
"""Largest ratio of ridges along rolling for which a line can stand; a measured surface with such
ridges still counts as isotropic."""


def stretched_wavenumbers(ratio: float) -> Array:
    r"""Wavenumbers of a stretched surface, over that of the isotropic surface's wave.

    .. math:: s = \sqrt{\cos^2 \psi + r^{-2} \sin^2 \psi}

    Parameters
    ----------
    ratio : float
        Length of the ridges over their width r.

    Returns
    -------
    numpy.ndarray
        Shape (`DIRECTIONS`,), for directions :math:`\psi` of equal weight.

    Examples
    --------
    The mean square gradient falls to that of the profile across the lay, one half:

    >>> f"{np.mean(stretched_wavenumbers(1e6) ** 2):.3f}"
    '0.500'
    """
    psi = 0.5 * np.pi * (np.arange(DIRECTIONS) + 0.5) / DIRECTIONS
    return np.hypot(np.cos(psi), np.sin(psi) / ratio)


def waves_of_line(first_wave: int, variances: Array, ratio: float) -> tuple[int, Array]:
    """Distribute the variance of waves across the lay over the waves of the line.

    Parameters
    ----------
    first_wave : int
        Number of waves around the circumference for the first variance; the others follow in
        steps of one.
    variances : numpy.ndarray
        Shape (waves,), of the waves before the surface is stretched.
    ratio : float
        Length of the ridges over their width.

    Returns
    -------
    first_wave : int
        As above, for the waves of the line.
    variances : numpy.ndarray
        Shape (waves,).

    Examples
    --------
    >>> first, variances = waves_of_line(100, np.ones(1), 4.0)
    >>> first, variances.size, f"{variances.sum():.3f}"
    (25, 76, '1.000')
    """
    last_wave = first_wave + variances.size - 1
    known = np.arange(first_wave, last_wave + 2) - 0.5
    power = np.concatenate([[0.0], np.cumsum(variances)])
    stretched = stretched_wavenumbers(ratio)
    first = max(math.floor(first_wave * stretched.min()), 1)
    edges = np.arange(first, last_wave + 2) - 0.5
    below = sum(np.interp(edges / one, known, power) for one in stretched) / DIRECTIONS
    below[0] = 0.0  # the first wave takes what lies below it
    return first, np.diff(below)


def unstretched(along: Array, across: Array, ratio: float, angle: float) -> Array:
    """Wavenumbers of the isotropic surface's waves that become these ones.

    Parameters
    ----------
    along, across : numpy.ndarray
        Wavenumbers along rolling and along the rollers, any shapes and unit.
    ratio : float
        Length of the ridges over their width.
    angle : float
        Angle between ridges and rolling, degrees.

    Returns
    -------
    numpy.ndarray
        In the same unit.
    """
    if ratio == 1.0:
        return np.hypot(along, across)
    cosine, sine = cosine_and_sine(angle)
    ridges, across_lay = along * cosine + across * sine, across * cosine - along * sine
    return np.hypot(across_lay, ratio * ridges)


def stretched(wavenumber: Values, direction: Array, ratio: float, angle: float) -> Pair:
    """Waves that the isotropic surface's waves become, the inverse of `unstretched`.

    Parameters
    ----------
    wavenumber : float or numpy.ndarray
        Wavenumber on the isotropic surface, any unit.
    direction : numpy.ndarray
        Angle there between the direction of the wave and that across the lay, rad.
    ratio, angle
        As in `unstretched`.

    Returns
    -------
    along, across : numpy.ndarray
        Wavenumbers along rolling and along the rollers, in the same unit.
    """
    across_lay, ridges = wavenumber * np.cos(direction), wavenumber * np.sin(direction) / ratio
    cosine, sine = cosine_and_sine(angle)
    return ridges * cosine - across_lay * sine, ridges * sine + across_lay * cosine


def extents(ratio: float, angle: float) -> tuple[float, float]:
    """Reach of a stretched circle along rolling and along the rollers, over its radius.

    Parameters
    ----------
    ratio, angle
        As in `unstretched`.

    Returns
    -------
    tuple of float
        From 1 to the ratio.

    Examples
    --------
    >>> extents(4.0, 90.0)
    (1.0, 4.0)
    """
    cosine, sine = cosine_and_sine(angle)
    return math.hypot(ratio * cosine, sine), math.hypot(cosine, ratio * sine)


def cosine_and_sine(angle: float) -> tuple[float, float]:
    """Cosine and sine of an angle in degrees, exact along and across rolling."""
    if angle % 90.0 == 0.0:
        return float(angle % 180.0 == 0.0), float(angle % 180.0 == 90.0)
    return math.cos(math.radians(angle)), math.sin(math.radians(angle))


def from_other_side(angle: float) -> float:
    """Angle between ridges and rolling, degrees, seen from the other side of the surface.

    Examples
    --------
    >>> from_other_side(30.0), from_other_side(90.0)
    (-30.0, 90.0)
    """
    return 90.0 - (90.0 + angle) % 180.0


def waves_along_rolling(ratio: float, angle: float) -> float:
    r"""Measure how far the waves of a surface run along rolling.

    Waves of the isotropic surface run in all directions. Once it is stretched, they run at the
    angles :math:`\theta` to rolling, with the mean

    .. math:: \langle \cos 2 \theta \rangle = -\frac{r - 1}{r + 1} \cos 2 \varphi

    Parameters
    ----------
    ratio, angle
        Ratio r and angle :math:`\varphi`, as in `unstretched`.

    Returns
    -------
    float
        1 if all waves run along rolling, 0 as for an isotropic surface, -1 if all run across.

    Examples
    --------
    >>> " ".join(f"{waves_along_rolling(3.0, angle):.2f}" for angle in (0.0, 90.0))
    '-0.50 0.50'
    """
    cosine, sine = cosine_and_sine(angle)
    return (ratio - 1.0) / (ratio + 1.0) * (sine**2 - cosine**2)
