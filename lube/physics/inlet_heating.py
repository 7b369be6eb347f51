r"""Shear heating of the oil at the inlet, where the film forms.

All factors depend on the thermal loading :math:`Q = \eta \beta v^2 / k` and the slide-to-roll ratio
S. In pure rolling they agree; with slip they do not. At Q = 1 and S = 0.5 the published factors are
0.68 (Zhu and Cheng) and 0.42 (Wilson and Sheu). The inlet equation to which Wilson and Sheu fitted
their formula gives 0.54.
"""

from typing import get_args

import numpy as np

from lube.physics.hertz import hertz_gap
from lube.physics.starvation import inlet_integral
from lube.types import Array, InletHeating, Values

INLET_HEATING = get_args(InletHeating)
"""Models of inlet heating that a study may choose."""
_REACH, _NEAREST, _STEPS = 1e3, 1e-7, 200
"""Distances before the contact, over the length of the inlet, at which the integration begins and
ends, and number of its steps."""


def thermal_loading(
    viscosity: Values,
    temperature_viscosity_coefficient: Values,
    entrainment_speed: Values,
    thermal_conductivity: Values,
) -> Values:
    r"""Thermal loading of the inlet.

    .. math:: Q = \frac{\eta \beta v^2}{k}

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

    Returns
    -------
    float or numpy.ndarray
        The loading.

    Examples
    --------
    >>> f"{thermal_loading(0.28, 0.05, 0.52, 0.14):.3f}"
    '0.027'
    """
    heat = viscosity * temperature_viscosity_coefficient * entrainment_speed**2
    return heat / thermal_conductivity


def heating_factor(
    model: str, loading: Values, slip: Values, relative_pressure: Values, film: Values
) -> Values:
    """Factor by which heating at the inlet thins the film.

    Parameters
    ----------
    model : str
        One of `INLET_HEATING`. For ``"none"`` the factor of ``"zhu-cheng-1988"`` is returned; the
        films are not multiplied by it.
    loading, slip, relative_pressure, film
        As in `zhu_cheng` and `inlet_equation`.

    Returns
    -------
    float or numpy.ndarray
        The factor, over all dimensions of loading, slip and film.
    """
    if model == "computed":
        return inlet_equation(loading, slip, film)
    if model == "wilson-sheu-1983":
        return wilson_sheu(loading, slip) * np.ones_like(film)  # over its dimensions, too
    return zhu_cheng(loading, slip, relative_pressure)


def zhu_cheng(loading: Values, slip: Values, relative_pressure: Values) -> Values:
    r"""Factor of Zhu and Cheng.

    .. math::

        C = \frac{1 - 13.2\, (p_H / E')\, Q^{0.42}}{1 + 0.213\, (1 + 2.23\, |S|^{0.83})\, Q^{0.64}}

    Parameters
    ----------
    loading : float or numpy.ndarray
        Thermal loading :math:`Q`.
    slip : float or numpy.ndarray
        Slide-to-roll ratio :math:`S`, from -2 to 2.
    relative_pressure : float or numpy.ndarray
        Maximum Hertzian pressure over the film modulus, :math:`p_H / E'` with E' = 2 E*.

    Returns
    -------
    float or numpy.ndarray
        Factor :math:`C` on the film thickness, above 0 and at most 1. It is NaN where the
        numerator is not above 0, since the speed is beyond the formula's range.

    References
    ----------
    D. Zhu and H. S. Cheng, private communication (1988), printed by R. S. Zhou and M. R. Hoeprich,
    Torque of tapered roller bearings, J. Tribol. 113 (1991) 590-597, Eq. 21, read in a
    transcription.
    P. K. Gupta and others, Tribol. Trans. 35 (1992) 269-274, print the formula too.

    Examples
    --------
    >>> [f"{factor:.3f}" for factor in zhu_cheng(1.0, np.array([0.0, 0.5, 2.0]), 0.0)]
    ['0.824', '0.676', '0.486']
    """
    numerator = 1.0 - 13.2 * relative_pressure * loading**0.42
    sliding = 1.0 + 2.23 * np.abs(slip) ** 0.83
    factor = numerator / (1.0 + 0.213 * sliding * loading**0.64)
    return np.where(numerator > 0.0, factor, np.nan)[()]


def wilson_sheu(loading: Values, slip: Values) -> Values:
    r"""Factor of Wilson and Sheu.

    .. math:: C = \frac{1}{1 + 0.241\, (1 + 14.8\, |S / 2|^{0.83})\, Q^{0.64}}

    Parameters
    ----------
    loading, slip
        As in `zhu_cheng`.

    Returns
    -------
    float or numpy.ndarray
        Factor :math:`C` on the film thickness, above 0 and at most 1.

    References
    ----------
    W. R. D. Wilson and S. Sheu, Effect of inlet shear heating due to sliding on
    elastohydrodynamic film thickness, J. Lubr. Technol. 105 (1983) 187-188, read in a
    transcription.

    Examples
    --------
    >>> [f"{factor:.3f}" for factor in wilson_sheu(1.0, np.array([0.0, 0.5, 2.0]))]
    ['0.806', '0.422', '0.208']
    """
    sliding = 1.0 + 14.8 * np.abs(0.5 * slip) ** 0.83
    return 1.0 / (1.0 + 0.241 * sliding * loading**0.64)


def inlet_equation(loading: Values, slip: Values, film: Values) -> Values:
    r"""Factor from the inlet equation to which Wilson and Sheu fitted their formula.

    Where the film forms, heat makes the oil thinner by :math:`R`,

    .. math::

        \frac{dp}{dx} = 12 \eta v \frac{h - h_0}{h^3} R, \qquad
        R = \frac{1}{1 + 0.5\, F^{0.85} + 0.2\, D^{0.9}},

        F = \frac{\eta \beta v^2}{k} \left( \frac{h - h_0}{h} \right)^2, \qquad
        D = \frac{\eta \beta (v_1 - v_2)^2}{k}

    with the viscosity :math:`\eta = \eta_0 e^{\alpha p}` at the local pressure. As in the inlet
    analysis of Grubin, the gap is that of the dry contact lifted by the film, and the pressure has
    to become infinite at the edge of Hertz' contact.

    Parameters
    ----------
    loading, slip
        As in `zhu_cheng`.
    film : float or numpy.ndarray
        Film without heating over a^2 / R*, with the half-width a of the contact. The factor hardly
        depends on it.

    Returns
    -------
    float or numpy.ndarray
        Factor on the film thickness, above 0 and at most 1; the arguments broadcast. It is NaN
        where an argument is NaN.

    Notes
    -----
    It is for a Barus oil between rollers that are flattened as by Hertz, and cannot hold at rigid,
    isoviscous points.

    With the reduced pressure q = 1 - exp(-alpha p), from 0 to 1, and y = (1 - q)^(1/10)

    .. math::

        \frac{dy}{dX} = -\frac{K}{10} \frac{G}{(H + G)^3}
        \frac{1}{y^9 + 0.5\, Q^{0.85} (G / (H + G))^{1.7} y^{0.5} + 0.2\, (Q S^2)^{0.9}}

    which is smooth where the pressure goes to infinity, y to 0. Without heating the film is the
    known one, which gives K.

    References
    ----------
    The paper of `wilson_sheu`, read in a transcription.

    Examples
    --------
    >>> [f"{factor:.3f}" for factor in inlet_equation(1.0, np.array([0.0, 0.5, 2.0]), 0.05)]
    ['0.817', '0.541', '0.191']
    """
    from scipy.optimize.elementwise import find_root  # slow to import

    arguments = np.broadcast_arrays(*(np.asarray(each, float) for each in (loading, slip, film)))
    scale = np.exp(-inlet_integral(np.log(arguments[2]), arguments[2], np.inf)[0])
    # Up to a little above 1, which is the root without loading. The error of the integration is
    # larger than this tolerance.
    bounds, tolerances = (np.log(1e-4), 0.01), {"xatol": 1e-12}
    found = find_root(_pressure_missing, bounds, args=(*arguments, scale), tolerances=tolerances)
    return np.minimum(np.exp(found.x), 1.0)[()]


def _pressure_missing(log_factor: Array, loading: Array, slip: Array, film: Array, scale: Array):
    """Evaluate y at the edge of the contact; below 0 if the pressure is infinite before it."""
    heated = film * np.exp(log_factor)
    rolling, sliding = 0.5 * loading**0.85, 0.2 * (loading * slip * slip) ** 0.9

    size = 1.0 + np.sqrt(film)

    def at(position):
        """Terms of the rate that do not depend on y."""
        distance = size * np.exp(position)
        gap = hertz_gap(1.0 + distance)
        total = heated + gap
        return 0.1 * scale * distance * gap / total**3, rolling * (gap / total) ** 1.7

    def rate(terms, y):
        height, (driving, heating) = np.abs(y), terms
        return driving / np.maximum(height**9 + heating * np.sqrt(height) + sliding, 1e-300)

    positions, half = np.linspace(np.log(_REACH), np.log(_NEAREST), 2 * _STEPS + 1, retstep=True)
    y, start = np.ones_like(film), at(positions[0])
    for middle, end in zip(map(at, positions[1::2]), map(at, positions[2::2]), strict=True):
        # Runge and Kutta's fourth order.
        first = rate(start, y)
        second = rate(middle, y + half * first)
        third = rate(middle, y + half * second)
        fourth = rate(end, y + 2.0 * half * third)
        y, start = y + half / 3.0 * (first + 2.0 * second + 2.0 * third + fourth), end
    return y
