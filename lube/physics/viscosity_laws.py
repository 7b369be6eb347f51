"""Viscosity-temperature laws: the viscosity of an oil at any temperature, from a few data points.

Temperatures are absolute, in kelvin. Kinematic viscosities are in mm2/s, not in SI units, because
the constants of ASTM D341 hold for mm2/s only. Callers convert.

The laws are listed in the registry `VISCOSITY_LAWS`. Each is a straight line in suitable
coordinates, and is fitted to the data in these coordinates by linear least squares. Through two
points the fit is exact.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from lube.errors import RangeError
from lube.physics import ZERO_CELSIUS
from lube.types import Array, Values

CAMERON_POLE = ZERO_CELSIUS - 95.0
"""Pole of Vogel's law through two points only, nu = a exp(b/(theta + 95)), by Cameron, K."""

ASTM_D341_LEAST = 0.21
"""Viscosity above which ASTM D341 holds, mm2/s."""

_NEWTON_STEPS = 8
_POLE_GRID = 200


def _straight_line(x, y):
    """Intercept and slope of the least-squares line, computed about the centroid."""
    x_mean, y_mean = np.mean(x), np.mean(y)
    slope = np.sum((x - x_mean) * (y - y_mean)) / np.sum((x - x_mean) ** 2)
    return float(y_mean - slope * x_mean), float(slope)


def _low_viscosity_term(kinematic_viscosity):
    """Exponential term of Z in ASTM D341; it matters below 2 mm2/s only."""
    return np.exp(-1.47 - 1.84 * kinematic_viscosity - 0.51 * kinematic_viscosity**2)


def fit_astm_d341(temperature: Array, kinematic_viscosity: Array) -> tuple[float, float]:
    r"""Fit the law of ASTM D341 (Ubbelohde-Walther).

    .. math::

        \log_{10} \log_{10} Z = A - B \log_{10} T, \qquad
        Z = \nu + 0.7 + e^{-1.47 - 1.84 \nu - 0.51 \nu^2}

    Parameters
    ----------
    temperature : numpy.ndarray, shape (n,)
        Absolute temperatures of n >= 2 data points, K.
    kinematic_viscosity : numpy.ndarray, shape (n,)
        Their viscosities, above 0.21 mm2/s.

    Returns
    -------
    tuple of float
        A and B: exact for two points, by least squares in log10 log10 Z for more.

    Raises
    ------
    RangeError
        If a viscosity is 0.21 mm2/s or less.

    Examples
    --------
    >>> a, b = fit_astm_d341(np.array([313.15, 373.15]), np.array([335.0, 38.3]))
    >>> f"{a:.4f}", f"{b:.4f}"
    ('6.9831', '2.6367')
    """
    least = kinematic_viscosity.min()
    if least <= ASTM_D341_LEAST:
        raise RangeError(
            f"got {least:g} mm2/s, ASTM D341 needs viscosities above {ASTM_D341_LEAST} mm2/s"
        )
    z = kinematic_viscosity + 0.7 + _low_viscosity_term(kinematic_viscosity)
    intercept, slope = _straight_line(np.log10(temperature), np.log10(np.log10(z)))
    return intercept, -slope


def evaluate_astm_d341(temperature: Values, a: float, b: float) -> Values:
    """Kinematic viscosity by ASTM D341.

    Parameters
    ----------
    temperature : float or numpy.ndarray
        Absolute temperature, K.
    a, b : float
        From `fit_astm_d341`.

    Returns
    -------
    float or numpy.ndarray
        Kinematic viscosity, mm2/s; infinite or NaN where Z overflows.

    Notes
    -----
    Z(nu) is inverted by Newton's method. Z rises with nu and is convex, so the iteration, started
    above the root at nu = Z - 0.7, converges from one side.

    Examples
    --------
    >>> a, b = fit_astm_d341(np.array([313.15, 373.15]), np.array([335.0, 38.3]))
    >>> f"{evaluate_astm_d341(333.15, a, b):.3f}"
    '139.100'
    """
    with np.errstate(over="ignore", invalid="ignore"):
        z = 10.0 ** (10.0 ** (a - b * np.log10(temperature)))
        viscosity = z - 0.7
        for _ in range(_NEWTON_STEPS):
            low = _low_viscosity_term(viscosity)
            slope = 1.0 - low * (1.84 + 1.02 * viscosity)
            viscosity = viscosity - (viscosity + 0.7 + low - z) / slope
    return viscosity


def fit_vogel(temperature: Array, kinematic_viscosity: Array) -> tuple[float, float, float]:
    r"""Fit Vogel's law.

    .. math:: \nu = a\, e^{b / (T - c)}

    Parameters
    ----------
    temperature : numpy.ndarray, shape (n,)
        Absolute temperatures of n >= 2 data points, K.
    kinematic_viscosity : numpy.ndarray, shape (n,)
        Their viscosities, mm2/s.

    Returns
    -------
    tuple of float
        a in mm2/s, b in K and c in K.

    Raises
    ------
    RangeError
        If there are two temperatures only, and one is at or below Cameron's pole of -95 degC.

    Notes
    -----
    With two temperatures the pole c is Cameron's: T - c = theta + 95, with theta in degC. With
    more, ln nu is fitted by a straight line in 1/(T - c), and the pole is the one that gives the
    smallest sum of squared residuals. It is sought between 0 K, where the law becomes Andrade's
    law, and 1 K below the lowest temperature: first on a grid, then by bounded minimisation, so
    that the result does not depend on a starting value.

    References
    ----------
    H. Vogel, Das Temperaturabhängigkeitsgesetz der Viskosität von Flüssigkeiten, Phys. Z. 22
    (1921) 645-646.

    Examples
    --------
    >>> a, b, c = fit_vogel(np.array([313.15, 373.15]), np.array([335.0, 38.3]))
    >>> f"{a:.4f}", f"{b:.1f}", f"{c:.2f}"
    ('0.2911', '951.5', '178.15')
    """
    log_viscosity = np.log(kinematic_viscosity)
    if np.unique(temperature).size > 2:
        pole = _best_pole(temperature, log_viscosity)
    elif temperature.min() > CAMERON_POLE:
        pole = CAMERON_POLE
    else:
        raise RangeError(
            f"got {temperature.min() - ZERO_CELSIUS:g} degC, Vogel's law through two points "
            "needs temperatures above -95 degC"
        )
    intercept, slope = _straight_line(1.0 / (temperature - pole), log_viscosity)
    return float(np.exp(intercept)), slope, float(pole)


def _best_pole(temperature, log_viscosity):
    """Find the pole c of Vogel's law with the smallest squared residuals in ln nu, K."""
    from scipy.optimize import minimize_scalar  # on first use: Snakemake imports this module

    def squared_residuals(pole):
        reciprocal = 1.0 / (temperature - pole)
        intercept, slope = _straight_line(reciprocal, log_viscosity)
        return np.sum((intercept + slope * reciprocal - log_viscosity) ** 2)

    grid = np.linspace(0.0, temperature.min() - 1.0, _POLE_GRID)
    best = int(np.argmin([squared_residuals(pole) for pole in grid]))
    bounds = grid[max(best - 1, 0)], grid[min(best + 1, _POLE_GRID - 1)]
    return minimize_scalar(squared_residuals, bounds=bounds, options={"xatol": 1e-9}).x


def evaluate_vogel(temperature: Values, a: float, b: float, c: float = 0.0) -> Values:
    r"""Kinematic viscosity by Vogel's law, or by Andrade's, in which c is zero.

    .. math:: \nu = a\, e^{b / (T - c)}

    Parameters
    ----------
    temperature : float or numpy.ndarray
        Absolute temperature, K.
    a, b, c : float
        From `fit_vogel`; without c from `fit_andrade`.

    Returns
    -------
    float or numpy.ndarray
        Kinematic viscosity, mm2/s; infinite at the pole c and below it.

    Examples
    --------
    >>> f"{evaluate_vogel(333.15, 0.3, 950.0, 178.0):.1f}"
    '136.9'
    """
    above_pole = np.maximum(np.asarray(temperature, dtype=float) - c, 0.0)
    with np.errstate(over="ignore", divide="ignore"):
        return a * np.exp(b / above_pole)


def fit_andrade(temperature: Array, kinematic_viscosity: Array) -> tuple[float, float]:
    r"""Fit Andrade's law, which has Arrhenius' form.

    .. math:: \nu = a\, e^{b / T}

    Parameters
    ----------
    temperature : numpy.ndarray, shape (n,)
        Absolute temperatures of n >= 2 data points, K.
    kinematic_viscosity : numpy.ndarray, shape (n,)
        Their viscosities, mm2/s.

    Returns
    -------
    tuple of float
        a in mm2/s and b in K: exact for two points, by least squares in ln nu for more.

    Examples
    --------
    >>> a, b = fit_andrade(np.array([313.15, 373.15]), np.array([335.0, 38.3]))
    >>> f"{a:.3g}", f"{b:.0f}"
    ('0.000465', '4224')
    """
    intercept, slope = _straight_line(1.0 / temperature, np.log(kinematic_viscosity))
    return float(np.exp(intercept)), slope


@dataclass(frozen=True)
class ViscosityLaw:
    """A viscosity-temperature law, with temperatures in K and viscosities in mm2/s.

    Attributes
    ----------
    fit : callable
        ``fit(temperature, kinematic_viscosity)`` returns the parameters as a tuple.
    evaluate : callable
        ``evaluate(temperature, *parameters)`` returns the kinematic viscosity.
    parameters : tuple of str
        Names of the parameters, in order; keys of `PARAMETER_UNITS`.
    source : str
        The equation and its publication.
    """

    fit: Callable[[Array, Array], tuple[float, ...]]
    evaluate: Callable[..., Values]
    parameters: tuple[str, ...]
    source: str


VISCOSITY_LAWS = {
    "astm-d341": ViscosityLaw(
        fit_astm_d341,
        evaluate_astm_d341,
        ("A", "B"),
        "log10 log10 (nu + 0.7 + exp(-1.47 - 1.84 nu - 0.51 nu^2)) = A - B log10 T (ASTM D341)",
    ),
    "vogel": ViscosityLaw(
        fit_vogel,
        evaluate_vogel,
        ("a", "b", "c"),
        "nu = a exp(b/(T - c)) (Vogel 1921; c by Cameron's -95 degC for two temperatures)",
    ),
    "andrade": ViscosityLaw(
        fit_andrade, evaluate_vogel, ("a", "b"), "nu = a exp(b/T) (Andrade 1930)"
    ),
}
"""Viscosity-temperature laws by name."""

PARAMETER_UNITS = {"A": "1", "B": "1", "a": "mm2 s-1", "b": "K", "c": "K"}
"""Units of the laws' parameters; parameters of the same name have the same unit in every law."""
