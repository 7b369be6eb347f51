"""Viscosity and density of an oil under pressure, relative to those at ambient pressure.

Each law of viscosity returns the natural logarithm of the viscosity ratio, which is finite where
the ratio itself overflows, and its slope against pressure.
"""

import numpy as np

from lube.types import Pair, Values

ROELANDS_PRESSURE = 1.962e8
"""Pressure p0 of Roelands' law, Pa."""
ROELANDS_VISCOSITY = np.exp(-9.67)
"""Viscosity at which all oils meet in Roelands' law, Pa s."""

_DENSITY_PRESSURE, _DENSITY_LIMIT = 0.59e9, 1.34


def barus(pressure: Values, pressure_viscosity_coefficient: float, viscosity: float) -> Pair:
    r"""Logarithm of the viscosity ratio by Barus' law, and its slope.

    .. math:: \ln \frac{\eta}{\eta_0} = \alpha p

    Parameters
    ----------
    pressure : float or numpy.ndarray
        Pressure :math:`p` above ambient, Pa.
    pressure_viscosity_coefficient : float
        :math:`\alpha`, 1/Pa.
    viscosity : float
        Dynamic viscosity :math:`\eta_0` at ambient pressure, Pa s. Not used; all laws take it.

    Returns
    -------
    tuple of float or numpy.ndarray
        :math:`\ln(\eta / \eta_0)`, and its slope against pressure, 1/Pa.

    Examples
    --------
    >>> barus(1e8, 2e-8, 0.1)
    (2.0, 2e-08)
    """
    slope = pressure_viscosity_coefficient + 0.0 * pressure
    return pressure_viscosity_coefficient * pressure, slope


def roelands(pressure: Values, pressure_viscosity_coefficient: float, viscosity: float) -> Pair:
    r"""Logarithm of the viscosity ratio by Roelands' law, and its slope.

    .. math::

        \ln \frac{\eta}{\eta_0} = (\ln \eta_0 + 9.67)
        \left[ \left( 1 + \frac{p}{p_0} \right)^Z - 1 \right], \qquad
        Z = \frac{\alpha p_0}{\ln \eta_0 + 9.67}

    Parameters
    ----------
    pressure : float or numpy.ndarray
        Pressure :math:`p` above ambient, Pa.
    pressure_viscosity_coefficient : float
        :math:`\alpha`, 1/Pa: the slope at ambient pressure.
    viscosity : float
        Dynamic viscosity :math:`\eta_0` at ambient pressure, Pa s; above `ROELANDS_VISCOSITY`.

    Returns
    -------
    tuple of float or numpy.ndarray
        :math:`\ln(\eta / \eta_0)`, and its slope against pressure, 1/Pa.

    References
    ----------
    C. J. A. Roelands, Correlational aspects of the viscosity-temperature-pressure relationship of
    lubricating oils, thesis, TH Delft (1966).

    Examples
    --------
    >>> logarithm, slope = roelands(1e8, 2e-8, 0.1)
    >>> f"{logarithm:.4f}", f"{slope:.3g}"
    ('1.8073', '1.65e-08')
    """
    scale = np.log(viscosity / ROELANDS_VISCOSITY)
    exponent = pressure_viscosity_coefficient * ROELANDS_PRESSURE / scale
    relative = 1.0 + pressure / ROELANDS_PRESSURE
    logarithm = scale * (relative**exponent - 1.0)
    return logarithm, pressure_viscosity_coefficient * relative ** (exponent - 1.0)


PRESSURE_LAWS = {"roelands": roelands, "barus": barus}
"""Laws of viscosity under pressure, by name."""


def dowson_higginson_density(pressure: Values) -> Pair:
    r"""Density ratio by the law of Dowson and Higginson, and its slope.

    .. math:: \frac{\rho}{\rho_0} = \frac{0.59 \times 10^9 + 1.34\, p}{0.59 \times 10^9 + p}

    Parameters
    ----------
    pressure : float or numpy.ndarray
        Pressure :math:`p` above ambient, Pa.

    Returns
    -------
    tuple of float or numpy.ndarray
        :math:`\rho / \rho_0`, and its slope against pressure, 1/Pa.

    References
    ----------
    D. Dowson and G. R. Higginson, Elasto-hydrodynamic Lubrication, Pergamon Press, 1966.

    Examples
    --------
    >>> f"{dowson_higginson_density(0.59e9)[0]:.2f}"
    '1.17'
    """
    sum_ = _DENSITY_PRESSURE + pressure
    slope = (_DENSITY_LIMIT - 1.0) * _DENSITY_PRESSURE / sum_**2
    return (_DENSITY_PRESSURE + _DENSITY_LIMIT * pressure) / sum_, slope
