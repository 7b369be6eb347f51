"""Hertzian line contact of two cylinders, as plain functions of numbers or arrays.

The pair is replaced by an elastic cylinder of the reduced radius on a rigid plane, with
the reduced modulus E* of the paper (section 2). Film-thickness formulas are written with
E' = 2 E*; wherever a modulus is passed on, its name says which of the two it is.
"""

import numpy as np


def reduced_radius(radius_1, radius_2):
    """Radius R* of the equivalent cylinder on a plane, 1/R* = 1/R1 + 1/R2.

    Parameters
    ----------
    radius_1, radius_2 : float
        Radii of the two cylinders, m.

    Returns
    -------
    float
        Reduced radius R*, m.
    """
    return 1.0 / (1.0 / radius_1 + 1.0 / radius_2)


def reduced_modulus(young_modulus_1, poisson_ratio_1, young_modulus_2, poisson_ratio_2):
    """Reduced modulus E* of the pair, 1/E* = (1 - nu1^2)/E1 + (1 - nu2^2)/E2.

    Parameters
    ----------
    young_modulus_1, young_modulus_2 : float
        Young's moduli, Pa.
    poisson_ratio_1, poisson_ratio_2 : float
        Poisson's ratios.

    Returns
    -------
    float
        Reduced modulus E*, Pa. The film formulas' E' is twice this value.
    """
    compliance_1 = (1.0 - poisson_ratio_1**2) / young_modulus_1
    compliance_2 = (1.0 - poisson_ratio_2**2) / young_modulus_2
    return 1.0 / (compliance_1 + compliance_2)


def contact_half_width(force, length, reduced_radius, reduced_modulus):
    """Half the width of the Hertzian contact strip, the paper's Eq. 2.

    Parameters
    ----------
    force : float or numpy.ndarray
        Normal force F_N, N.
    length : float
        Length L' of the cylinders' contact, m.
    reduced_radius, reduced_modulus : float
        R* in m and E* in Pa.

    Returns
    -------
    float or numpy.ndarray
        Half-width a, m; the contact strip is 2a wide.
    """
    return np.sqrt(4.0 * force * reduced_radius / (np.pi * length * reduced_modulus))


def maximum_pressure(force, length, reduced_radius, reduced_modulus):
    """Maximum Hertzian pressure, p_H = 2 F_N / (pi a L').

    Parameters
    ----------
    force, length, reduced_radius, reduced_modulus
        As in `contact_half_width`.

    Returns
    -------
    float or numpy.ndarray
        Pressure in the middle of the strip, Pa.
    """
    half_width = contact_half_width(force, length, reduced_radius, reduced_modulus)
    return 2.0 * force / (np.pi * half_width * length)
