"""Hertzian line contact of two cylinders.

The pair is replaced by an elastic cylinder of the reduced radius on a rigid plane, with the
reduced modulus E* of the paper (section 2). Film formulas are written with E' = 2 E*; the name of
a modulus says which of the two it is.
"""

import numpy as np

from lube.types import Values


def reduced_radius(radius_1: float, radius_2: float) -> float:
    r"""Radius of the equivalent cylinder on a plane (paper, section 2).

    .. math:: \frac{1}{R^*} = \frac{1}{R_1} + \frac{1}{R_2}

    Parameters
    ----------
    radius_1, radius_2 : float
        Radii of the two cylinders, m.

    Returns
    -------
    float
        Reduced radius :math:`R^*`, m.

    Examples
    --------
    >>> reduced_radius(0.05, 0.05)
    0.025
    """
    return 1.0 / (1.0 / radius_1 + 1.0 / radius_2)


def reduced_modulus(
    young_modulus_1: float, poisson_ratio_1: float, young_modulus_2: float, poisson_ratio_2: float
) -> float:
    r"""Reduced modulus of the pair (paper, section 2).

    .. math:: \frac{1}{E^*} = \frac{1 - \nu_1^2}{E_1} + \frac{1 - \nu_2^2}{E_2}

    Parameters
    ----------
    young_modulus_1, young_modulus_2 : float
        Young's moduli, Pa.
    poisson_ratio_1, poisson_ratio_2 : float
        Poisson's ratios.

    Returns
    -------
    float
        Reduced modulus :math:`E^*`, Pa. The film formulas' :math:`E'` is twice this value.

    Examples
    --------
    >>> f"{reduced_modulus(210e9, 0.3, 210e9, 0.3):.4g}"
    '1.154e+11'
    """
    compliance_1 = (1.0 - poisson_ratio_1**2) / young_modulus_1
    compliance_2 = (1.0 - poisson_ratio_2**2) / young_modulus_2
    return 1.0 / (compliance_1 + compliance_2)


def contact_half_width(
    force: Values, length: float, reduced_radius: float, reduced_modulus: float
) -> Values:
    r"""Half the width of the Hertzian contact strip (paper, Eq. 2).

    .. math:: a = \sqrt{\frac{4 F_N R^*}{\pi L' E^*}}

    Parameters
    ----------
    force : float or numpy.ndarray
        Normal force :math:`F_N`, N.
    length : float
        Length :math:`L'` of the line contact, m.
    reduced_radius : float
        :math:`R^*`, m.
    reduced_modulus : float
        :math:`E^*`, Pa.

    Returns
    -------
    float or numpy.ndarray
        Half-width :math:`a`, m; the contact strip is :math:`2a` wide.

    Examples
    --------
    >>> f"{contact_half_width(1600.0, 0.01, 0.025, 1.154e11):.3g}"
    '0.00021'
    """
    return np.sqrt(4.0 * force * reduced_radius / (np.pi * length * reduced_modulus))


def maximum_pressure(force: Values, half_width: Values, length: float) -> Values:
    r"""Maximum Hertzian pressure, on the centre line of the contact strip.

    .. math:: p_H = \frac{2 F_N}{\pi a L'}

    Parameters
    ----------
    force, length
        As in `contact_half_width`.
    half_width : float or numpy.ndarray
        :math:`a`, m, from there.

    Returns
    -------
    float or numpy.ndarray
        Pressure :math:`p_H`, Pa.

    Examples
    --------
    >>> f"{maximum_pressure(1600.0, 2.1e-4, 0.01):.3g}"
    '4.85e+08'
    """
    return 2.0 * force / (np.pi * half_width * length)


def hertz_gap(position: Values) -> Values:
    r"""Gap around a dry line contact.

    .. math:: \frac{h R^*}{a^2} = \frac12 \left( |X| \sqrt{X^2 - 1} - \mathrm{arcosh} |X| \right)

    Parameters
    ----------
    position : float or numpy.ndarray
        Positions X over the half-width.

    Returns
    -------
    float or numpy.ndarray
        The gap over a^2 / R*; zero in the contact.

    Examples
    --------
    >>> hertz_gap(np.array([-2.0, 0.5, 1.0])).round(4).tolist()
    [1.0736, 0.0, 0.0]
    """
    distance = np.maximum(np.abs(position), 1.0)
    return 0.5 * (distance * np.sqrt(distance**2 - 1.0) - np.arccosh(distance))
