"""Shear heating of the oil at the inlet, where the film forms."""

from lube.types import Values


def inlet_shear_heating_factor(
    viscosity: Values,
    temperature_viscosity_coefficient: Values,
    entrainment_speed: Values,
    thermal_conductivity: Values,
) -> Values:
    r"""Factor by which shear heating in the inlet thins the film.

    .. math:: C = \frac{1}{1 + 0.254\, Q^{0.62}}, \qquad Q = \frac{\eta \beta v^2}{k}

    Parameters
    ----------
    viscosity : float or numpy.ndarray
        Dynamic viscosity :math:`\eta` at ambient pressure, Pa s.
    temperature_viscosity_coefficient : float or numpy.ndarray
        Temperature-viscosity coefficient :math:`\beta = -d(\ln \eta)/dT`, 1/K.
    entrainment_speed : float or numpy.ndarray
        Entrainment speed :math:`v`, m/s.
    thermal_conductivity : float or numpy.ndarray
        Thermal conductivity of the oil :math:`k`, W/(m K).

    Returns
    -------
    float or numpy.ndarray
        Factor :math:`C` on the film thickness, from 0 to 1.

    References
    ----------
    L. E. Murch and W. R. D. Wilson, A thermal elastohydrodynamic inlet zone analysis,
    J. Lubr. Technol. 97 (1975) 212-216. Derived for rolling without sliding.

    Examples
    --------
    >>> f"{inlet_shear_heating_factor(0.28, 0.05, 0.52, 0.14):.3f}"
    '0.974'
    """
    heating = viscosity * temperature_viscosity_coefficient * entrainment_speed**2
    loading = heating / thermal_conductivity
    return 1.0 / (1.0 + 0.254 * loading**0.62)
