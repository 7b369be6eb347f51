"""Shear heating of the oil at the inlet, where the film forms."""

import numpy as np

from lube.types import Values

INLET_HEATING = ("none", "gupta-1992")
"""How a study may take the heating into account."""


def inlet_shear_heating_factor(
    viscosity: Values,
    temperature_viscosity_coefficient: Values,
    entrainment_speed: Values,
    thermal_conductivity: Values,
    relative_pressure: Values,
    slide_to_roll_ratio: Values,
) -> Values:
    r"""Factor by which shear heating in the inlet thins the film.

    .. math::

        C = \frac{1 - 13.2\, (p_H / E')\, Q^{0.42}}{1 + 0.213\, (1 + 2.23\, |S|^{0.83})\, Q^{0.64}},
        \qquad Q = \frac{\eta \beta v^2}{k}

    Parameters
    ----------
    viscosity : float or numpy.ndarray
        Dynamic viscosity :math:`\eta` at ambient pressure, Pa s.
    temperature_viscosity_coefficient : float or numpy.ndarray
        Temperature-viscosity coefficient :math:`\beta = -d(\ln \eta)/dT`, 1/K.
    entrainment_speed : float or numpy.ndarray
        Entrainment speed :math:`v`, the mean of both surfaces, m/s.
    thermal_conductivity : float or numpy.ndarray
        Thermal conductivity of the oil :math:`k`, W/(m K).
    relative_pressure : float or numpy.ndarray
        Maximum Hertzian pressure over the film modulus, :math:`p_H / E'` with E' = 2 E*.
    slide_to_roll_ratio : float or numpy.ndarray
        Slide-to-roll ratio :math:`S`, from -2 to 2.

    Returns
    -------
    float or numpy.ndarray
        Factor :math:`C` on the film thickness, above 0 and at most 1. NaN where the numerator is
        not above 0: there the speed is beyond the formula's range.

    References
    ----------
    P. K. Gupta, H. S. Cheng, D. Zhu, N. H. Forster and J. B. Schrand, Viscoelastic effects in
    MIL-L-7808-type lubricant, Part I: analytical formulation, Tribol. Trans. 35 (1992) 269-274.
    Taken from secondary literature; the article itself was not read.

    Examples
    --------
    >>> slip = np.array([0.0, 2.0])
    >>> rolling, sliding = inlet_shear_heating_factor(0.28, 0.05, 0.52, 0.14, 2e-3, slip)
    >>> f"{rolling:.3f}, {sliding:.3f}"
    '0.974, 0.900'
    """
    heating = viscosity * temperature_viscosity_coefficient * entrainment_speed**2
    loading = heating / thermal_conductivity
    numerator = 1.0 - 13.2 * relative_pressure * loading**0.42
    slip = 1.0 + 2.23 * np.abs(slide_to_roll_ratio) ** 0.83
    factor = numerator / (1.0 + 0.213 * slip * loading**0.64)
    return np.where(numerator > 0.0, factor, np.nan)[()]
