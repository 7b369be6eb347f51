"""Heating of the oil by shear at the inlet, where a film is made."""


def inlet_shear_heating_factor(
    viscosity, temperature_viscosity_coefficient, entrainment_speed, thermal_conductivity
):
    """Film reduction by shear heating in the inlet, C = 1 / (1 + 0.254 Q^0.62).

    Parameters
    ----------
    viscosity : float or numpy.ndarray
        Dynamic viscosity eta at ambient pressure, Pa s.
    temperature_viscosity_coefficient : float or numpy.ndarray
        Relative fall of viscosity with temperature beta = -d(ln eta)/dT, 1/K.
    entrainment_speed : float or numpy.ndarray
        Mean surface speed v, m/s.
    thermal_conductivity : float or numpy.ndarray
        Of the oil, k, W/(m K).

    Returns
    -------
    float or numpy.ndarray
        Factor C between 0 and 1, with the thermal loading Q = eta beta v^2 / k.

    References
    ----------
    Murch and Wilson, J. Lubr. Technol. 97 (1975). Derived for rolling without sliding.
    """
    loading = (
        viscosity * temperature_viscosity_coefficient * entrainment_speed**2 / thermal_conductivity
    )
    return 1.0 / (1.0 + 0.254 * loading**0.62)
