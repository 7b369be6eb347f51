r"""Pressure-viscosity coefficient of an oil: estimates, fits to measurements, conversions.

The coefficient :math:`\alpha` has three definitions. With the pressure :math:`p` above atmospheric
and the viscosity :math:`\eta_0` at :math:`p = 0` they are

.. math::

    \alpha_0 = \left. \frac{d \ln \eta}{d p} \right|_0, \qquad
    \alpha_P = \frac{\ln(\eta(P) / \eta_0)}{P}, \qquad
    \frac{1}{\alpha^*} = \int_0^\infty \frac{\eta_0}{\eta(p)}\, dp ,

the slope at atmospheric pressure, the secant to a pressure P, and the reciprocal asymptotic
isoviscous pressure (Arana, Larrañaga & Ulacia, Proc. IMechE J 233 (2019) 303, Eq. 23, who integrate
to the Hertzian pressure). With Barus' law, :math:`\eta = \eta_0 e^{\alpha p}`, all three agree.
"""

import numpy as np

from lube.errors import RangeError
from lube.physics.pressure_laws import ROELANDS_PRESSURE, ROELANDS_VISCOSITY
from lube.types import Array, Values

GOLD_BASES = {
    "mineral": (9.904, 0.1390),
    "polyalphaolefin": (7.382, 0.1335),
    "ester": (6.605, 0.1360),
    "polyglycol": (5.489, 0.1485),
}
"""Gold's s and t by base oil."""


def gold_pressure_viscosity(kinematic_viscosity: Values, base: str) -> Values:
    r"""Pressure-viscosity coefficient by Gold's form.

    .. math:: \alpha = s\, \nu^t \times 10^{-9}\ \mathrm{Pa}^{-1}

    Parameters
    ----------
    kinematic_viscosity : float or numpy.ndarray
        Kinematic viscosity :math:`\nu` at the temperature of interest, mm2/s, not SI.
    base : str
        A key of `GOLD_BASES`.

    Returns
    -------
    float or numpy.ndarray
        Pressure-viscosity coefficient :math:`\alpha`, 1/Pa.

    References
    ----------
    P. W. Gold, A. Schmidt, H. Dicke, J. Loos and C. Assmann, Viscosity-pressure-temperature
    behaviour of mineral and synthetic oils, J. Synth. Lubr. 18 (2001) 51-79.

    Examples
    --------
    >>> f"{gold_pressure_viscosity(335.0, 'polyalphaolefin'):.3g}"
    '1.6e-08'
    """
    s, t = GOLD_BASES[base]
    return s * np.asarray(kinematic_viscosity, dtype=float) ** t * 1e-9


DEFINITIONS = {
    "slope-at-atmospheric": "slope of ln viscosity at atmospheric pressure",
    "secant": "secant of ln viscosity from atmospheric pressure to {pressure:g} MPa",
    "reciprocal-asymptotic": "reciprocal asymptotic isoviscous pressure",
}
"""Definitions of the pressure-viscosity coefficient, with the words for files and figures."""

FORMULA_DEFINITION = "slope-at-atmospheric"
"""Definition that the film formulas take: the slope of an oil that follows Roelands' law.

This is a convention of the study. The errors and ranges of validity in `lube.ehl.film_formulas`
were determined with this law and the slope.
"""

_SLOPES = 1e-11, 1e-6  # 1/Pa: limits within which the slope of an oil is sought


def roelands_coefficient(
    slope: float, dynamic_viscosity: float, definition: str, span: float | None = None
) -> float:
    r"""Pressure-viscosity coefficient of an oil that follows Roelands' law, by any definition.

    .. math::

        \ln \frac{\eta}{\eta_0} = c \left[ \left( 1 + \frac{p}{p_r} \right)^Z - 1 \right], \qquad
        c = \ln \eta_0 + 9.67, \qquad Z = \frac{\alpha_0 p_r}{c}

    Its reciprocal asymptotic isoviscous pressure follows by substituting
    :math:`u = c\,(1 + p/p_r)^Z`:

    .. math:: \frac{1}{\alpha^*} = \frac{p_r}{Z}\, e^c\, c^{-1/Z}\, \Gamma(1/Z, c)

    Parameters
    ----------
    slope : float
        Slope :math:`\alpha_0` at atmospheric pressure, 1/Pa.
    dynamic_viscosity : float
        Viscosity :math:`\eta_0` at atmospheric pressure, Pa s.
    definition : str
        A key of `DEFINITIONS`.
    span : float, optional
        Pressure :math:`P` above atmospheric to which the secant goes, Pa; for ``"secant"`` only.

    Returns
    -------
    float
        Coefficient, 1/Pa.

    Raises
    ------
    RangeError
        If the viscosity is at or below the law's limit of 6.3e-5 Pa s.

    References
    ----------
    C. J. A. Roelands, Correlational Aspects of the Viscosity-Temperature-Pressure Relationship of
    Lubricating Oils, Delft, 1966.

    Examples
    --------
    >>> f"{roelands_coefficient(20e-9, 0.1, 'reciprocal-asymptotic'):.3g}"
    '1.79e-08'
    """
    from scipy.special import gammaincc, gammaln  # on first use: Snakemake imports this module

    c = np.log(dynamic_viscosity / ROELANDS_VISCOSITY)
    if not c > 0.0:
        raise RangeError(
            f"got a viscosity of {dynamic_viscosity:g} Pa s, Roelands' law, which converts between "
            "definitions of the pressure-viscosity coefficient, needs more than "
            f"{ROELANDS_VISCOSITY:.2g} Pa s"
        )
    z = slope * ROELANDS_PRESSURE / c
    match definition:
        case "secant":
            return c * np.expm1(z * np.log1p(span / ROELANDS_PRESSURE)) / span
        case "reciprocal-asymptotic":
            log_gamma = gammaln(1.0 / z) + np.log(gammaincc(1.0 / z, c))
            return z / ROELANDS_PRESSURE * np.exp(np.log(c) / z - c - log_gamma)
        case _:
            return slope


def roelands_slope(
    coefficient: float, dynamic_viscosity: float, definition: str, span: float | None = None
) -> float:
    """Slope at atmospheric pressure of the oil that follows Roelands' law and has a coefficient.

    Parameters
    ----------
    coefficient : float
        Pressure-viscosity coefficient by its definition, 1/Pa.
    dynamic_viscosity, definition, span
        As in `roelands_coefficient`, whose inverse this is.

    Returns
    -------
    float
        Slope, 1/Pa.

    Raises
    ------
    RangeError
        As from `roelands_coefficient`; or if no such oil has the coefficient.

    Examples
    --------
    >>> f"{roelands_slope(18e-9, 0.1, 'reciprocal-asymptotic'):.3g}"
    '2.01e-08'
    """
    from scipy.optimize import brentq

    if definition == FORMULA_DEFINITION:
        return coefficient

    def excess(log_slope):
        slope = np.exp(log_slope)
        return roelands_coefficient(slope, dynamic_viscosity, definition, span) - coefficient

    ends = np.log(_SLOPES)
    if not excess(ends[0]) < 0.0 < excess(ends[1]):
        raise RangeError(
            f"got a pressure-viscosity coefficient of {1e9 * coefficient:g} 1/GPa, which no oil of "
            f"{dynamic_viscosity:g} Pa s has by Roelands' law"
        )
    return float(np.exp(brentq(excess, *ends, xtol=1e-13)))


def mcewen_log_ratio(pressure: Values, slope: float, curvature: float) -> Values:
    r"""Logarithm of the viscosity under pressure over that at atmospheric pressure.

    .. math:: \ln \frac{\eta}{\eta_0} = \frac{\ln(1 + s\, \alpha_0\, p)}{s}

    Parameters
    ----------
    pressure : float or numpy.ndarray
        Pressure :math:`p` above atmospheric, Pa.
    slope : float
        Slope :math:`\alpha_0` at atmospheric pressure, 1/Pa.
    curvature : float
        :math:`s = 1/q` with McEwen's exponent q, 0 or more; with 0 the law is Barus' law.

    Returns
    -------
    float or numpy.ndarray
        Logarithm of the ratio.

    References
    ----------
    E. McEwen, J. Inst. Petroleum 38 (1952) 646, as :math:`\eta_0 (1 + \alpha_0 p / q)^q`. S. Bair
    (High Temp. High Press. 44 (2015) 415) names it for viscosities that rise more slowly than
    exponentially, as those of most oils do below some hundred MPa.

    Examples
    --------
    >>> f"{mcewen_log_ratio(100e6, 20e-9, 0.1):.4f}"
    '1.8232'
    """
    if curvature == 0.0:
        return slope * pressure
    return np.log1p(curvature * slope * pressure) / curvature


def mcewen_coefficient(
    slope: float, curvature: float, definition: str, span: float | None = None
) -> float:
    r"""Pressure-viscosity coefficient of an oil that follows McEwen's law, by any definition.

    Its reciprocal asymptotic isoviscous pressure is

    .. math:: \alpha^* = \alpha_0\, (1 - s)

    Parameters
    ----------
    slope, curvature
        :math:`\alpha_0` and :math:`s`, as in `mcewen_log_ratio`.
    definition, span
        As in `roelands_coefficient`.

    Returns
    -------
    float
        Coefficient, 1/Pa.

    Raises
    ------
    RangeError
        If the viscosity rises too slowly (s is 1 or more) for a reciprocal asymptotic isoviscous
        pressure.

    Examples
    --------
    >>> f"{mcewen_coefficient(20e-9, 0.1, 'reciprocal-asymptotic'):.3g}"
    '1.8e-08'
    """
    match definition:
        case "secant":
            return mcewen_log_ratio(span, slope, curvature) / span
        case "reciprocal-asymptotic":
            if curvature >= 1.0:
                raise RangeError(
                    "the viscosity rises too slowly with pressure for definition "
                    "'reciprocal-asymptotic', need another definition"
                )
            return slope * (1.0 - curvature)
        case _:
            return slope


def fit_mcewen(pressure: Array, viscosity_ratio: Array) -> tuple[float, float]:
    """Fit McEwen's law to viscosities under pressure at one temperature.

    Parameters
    ----------
    pressure : numpy.ndarray, shape (n,)
        Pressures above atmospheric, all positive, Pa.
    viscosity_ratio : numpy.ndarray, shape (n,)
        Viscosities there over that at atmospheric pressure, above 1.

    Returns
    -------
    tuple of float
        ``slope`` (1/Pa) and ``curvature`` of `mcewen_log_ratio`, by least squares in ln viscosity.

    Examples
    --------
    >>> pressure = np.array([50e6, 100e6, 200e6])
    >>> slope, curvature = fit_mcewen(pressure, np.exp(mcewen_log_ratio(pressure, 2e-8, 0.1)))
    >>> f"{slope:.4g}", f"{curvature:.4f}"
    ('2e-08', '0.1000')
    """
    from scipy.optimize import least_squares

    logarithm = np.log(viscosity_ratio)
    scale = float(np.max(logarithm / pressure))

    def residuals(parameters):
        return mcewen_log_ratio(pressure, parameters[0] * scale, parameters[1]) - logarithm

    fit = least_squares(residuals, (1.0, 0.1), bounds=([1e-6, 0.0], np.inf), xtol=1e-14, ftol=1e-14)
    return float(fit.x[0] * scale), float(fit.x[1])
