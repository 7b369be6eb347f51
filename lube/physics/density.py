"""Density of an oil."""

from lube.physics import ZERO_CELSIUS
from lube.types import Values

DENSITY_REFERENCE = ZERO_CELSIUS + 15.0
"""Temperature at which data sheets give the density, K."""


def linear_density(temperature: Values, density_15: float, thermal_coefficient: float) -> Values:
    r"""Density, falling linearly with temperature.

    .. math:: \rho = \rho_{15}\, (1 - \kappa\, (T - 288.15\ \mathrm{K}))

    Parameters
    ----------
    temperature : float or numpy.ndarray
        Absolute temperature :math:`T`, K.
    density_15 : float
        Density :math:`\rho_{15}` at 15 degC, kg/m3.
    thermal_coefficient : float
        Relative fall of density :math:`\kappa` per kelvin, 1/K.

    Returns
    -------
    float or numpy.ndarray
        Density :math:`\rho`, kg/m3.

    Examples
    --------
    >>> f"{linear_density(313.15, 860.0, 6.4e-4):.1f}"
    '846.2'
    """
    return density_15 * (1.0 - thermal_coefficient * (temperature - DENSITY_REFERENCE))
