"""Dimensionless groups of a lubricated line contact.

With the load w' per length, the entrainment speed v (the *mean* of the surface speeds), the
reduced radius R* and E' = 2 E* (twice the reduced modulus of `lube.physics.hertz`)::

    W = w' / (E' R*)        U = eta0 v / (E' R*)        G = alpha E'

On two of these alone, Moes' M and L, hangs the film over R* (2U)^(1/2).
"""

import numpy as np


def dimensionless_load(load_per_length, film_modulus, reduced_radius):
    """Load parameter W = w' / (E' R*).

    Parameters
    ----------
    load_per_length : float or numpy.ndarray
        Force per length of the contact w' = F_N / L', N/m.
    film_modulus, reduced_radius : float
        E' = 2 E* in Pa and R* in m.

    Returns
    -------
    float or numpy.ndarray
        Load parameter W.
    """
    return load_per_length / (film_modulus * reduced_radius)


def dimensionless_speed(viscosity, entrainment_speed, film_modulus, reduced_radius):
    """Speed parameter U = eta0 v / (E' R*), with the mean of the surface speeds.

    Parameters
    ----------
    viscosity : float or numpy.ndarray
        Dynamic viscosity eta0 at ambient pressure, Pa s.
    entrainment_speed : float or numpy.ndarray
        Mean surface speed v = (v1 + v2) / 2, m/s.
    film_modulus, reduced_radius : float
        E' = 2 E* in Pa and R* in m.

    Returns
    -------
    float or numpy.ndarray
        Speed parameter U.
    """
    return viscosity * entrainment_speed / (film_modulus * reduced_radius)


def dimensionless_material(pressure_viscosity_coefficient, film_modulus):
    """Materials parameter G = alpha E'.

    Parameters
    ----------
    pressure_viscosity_coefficient : float or numpy.ndarray
        Pressure-viscosity coefficient alpha, 1/Pa.
    film_modulus : float
        E' = 2 E*, Pa.

    Returns
    -------
    float or numpy.ndarray
        Materials parameter G.
    """
    return pressure_viscosity_coefficient * film_modulus


def moes_numbers(load, speed, material):
    """Moes' load number M = W (2U)^(-1/2) and material number L = G (2U)^(1/4).

    Parameters
    ----------
    load, speed, material : float or numpy.ndarray
        W, U and G. Moes' own speed parameter is made with the sum of the surface speeds,
        twice the mean; hence 2U.

    Returns
    -------
    tuple of float or numpy.ndarray
        M and L.

    References
    ----------
    Moes, Wear 159 (1992).
    """
    return load / np.sqrt(2.0 * speed), material * (2.0 * speed) ** 0.25
