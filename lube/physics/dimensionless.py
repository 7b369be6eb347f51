r"""Dimensionless groups of a lubricated line contact.

With the load :math:`w'` per length, the entrainment speed :math:`v` (the *mean* of the surface
speeds), the reduced radius :math:`R^*` and :math:`E' = 2 E^*` (twice the reduced modulus of
`lube.physics.hertz`):

.. math::

    W = \frac{w'}{E' R^*}, \qquad U = \frac{\eta_0 v}{E' R^*}, \qquad G = \alpha E'

The film thickness over :math:`R^* \sqrt{2U}` depends on only two combinations of these, the Moes
numbers :math:`M` and :math:`L`.
"""

import numpy as np

from lube.types import Values


def dimensionless_load(
    load_per_length: Values, film_modulus: float, reduced_radius: float
) -> Values:
    r"""Load parameter W of a line contact.

    .. math:: W = \frac{w'}{E' R^*}

    Parameters
    ----------
    load_per_length : float or numpy.ndarray
        Force per length of the contact :math:`w' = F_N / L'`, N/m.
    film_modulus : float
        :math:`E' = 2 E^*`, Pa.
    reduced_radius : float
        :math:`R^*`, m.

    Returns
    -------
    float or numpy.ndarray
        Load parameter :math:`W`.

    Examples
    --------
    >>> f"{dimensionless_load(8e4, 2.31e11, 0.025):.3g}"
    '1.39e-05'
    """
    return load_per_length / (film_modulus * reduced_radius)


def dimensionless_speed(
    viscosity: Values, entrainment_speed: Values, film_modulus: float, reduced_radius: float
) -> Values:
    r"""Speed parameter U of a line contact, from the entrainment speed.

    .. math:: U = \frac{\eta_0 v}{E' R^*}, \qquad v = \frac{v_1 + v_2}{2}

    Parameters
    ----------
    viscosity : float or numpy.ndarray
        Dynamic viscosity :math:`\eta_0` at ambient pressure, Pa s.
    entrainment_speed : float or numpy.ndarray
        Entrainment speed :math:`v`, m/s.
    film_modulus : float
        :math:`E' = 2 E^*`, Pa.
    reduced_radius : float
        :math:`R^*`, m.

    Returns
    -------
    float or numpy.ndarray
        Speed parameter :math:`U`.

    Examples
    --------
    >>> f"{dimensionless_speed(0.28, 0.52, 2.31e11, 0.025):.3g}"
    '2.52e-11'
    """
    return viscosity * entrainment_speed / (film_modulus * reduced_radius)


def dimensionless_material(pressure_viscosity_coefficient: Values, film_modulus: float) -> Values:
    r"""Materials parameter G of a line contact.

    .. math:: G = \alpha E'

    Parameters
    ----------
    pressure_viscosity_coefficient : float or numpy.ndarray
        Pressure-viscosity coefficient :math:`\alpha`, 1/Pa.
    film_modulus : float
        :math:`E' = 2 E^*`, Pa.

    Returns
    -------
    float or numpy.ndarray
        Materials parameter :math:`G`.

    Examples
    --------
    >>> f"{dimensionless_material(16e-9, 2.31e11):.0f}"
    '3696'
    """
    return pressure_viscosity_coefficient * film_modulus


def moes_numbers(load: Values, speed: Values, material: Values) -> tuple[Values, Values]:
    r"""Moes numbers: dimensionless load M and material parameter L.

    .. math:: M = \frac{W}{\sqrt{2U}}, \qquad L = G\,(2U)^{1/4}

    Parameters
    ----------
    load, speed, material : float or numpy.ndarray
        :math:`W`, :math:`U` and :math:`G`. Moes defines his speed parameter with the sum of the
        surface speeds, twice their mean; hence :math:`2U`.

    Returns
    -------
    tuple of float or numpy.ndarray
        :math:`M` and :math:`L`.

    References
    ----------
    H. Moes, Optimum similarity analysis with applications to elastohydrodynamic lubrication,
    Wear 159 (1992) 57-66.

    Examples
    --------
    >>> moes_load, moes_material = moes_numbers(1.39e-5, 2.52e-11, 3696.0)
    >>> f"{moes_load:.3g}", f"{moes_material:.3g}"
    ('1.96', '9.85')
    """
    return load / np.sqrt(2.0 * speed), material * (2.0 * speed) ** 0.25
