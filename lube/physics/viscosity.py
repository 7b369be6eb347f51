"""Viscosity, density and pressure-viscosity coefficient of an oil.

Temperatures are absolute, in kelvin. Kinematic viscosities are in mm2/s, not in SI units, because
the constants of ASTM D341, ASTM D2270 and Gold's form hold for mm2/s only. Callers convert.

The viscosity-temperature laws are listed in the registry `VISCOSITY_LAWS`. Each is a straight line
in suitable coordinates, and is fitted by linear least squares in these: exactly through two points,
with the least squared residuals through more.
"""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from lube.errors import RangeError
from lube.types import Array, Values

ZERO_CELSIUS = 273.15
DENSITY_REFERENCE = ZERO_CELSIUS + 15.0

# Cameron's convention for Vogel's law with only two data points: nu = a exp(b/(theta + 95)),
# theta in degC.
CAMERON_POLE = ZERO_CELSIUS - 95.0

ASTM_D341_LEAST = 0.21
_NEWTON_STEPS = 8
_POLE_GRID = 200


def _straight_line(x, y):
    """Intercept and slope of the least-squares line, computed about the centroid."""
    x_mean, y_mean = np.mean(x), np.mean(y)
    slope = np.sum((x - x_mean) * (y - y_mean)) / np.sum((x - x_mean) ** 2)
    return float(y_mean - slope * x_mean), float(slope)


def _data(temperature, kinematic_viscosity, least=0.0):
    """Return the data as float arrays; refuse those that no law can be fitted to."""
    temperature = np.asarray(temperature, dtype=float)
    viscosity = np.asarray(kinematic_viscosity, dtype=float)
    if np.unique(temperature).size < 2:
        raise RangeError("got one temperature, need viscosities at two or more for a fit")
    if np.any(viscosity <= least):
        raise RangeError(f"got {viscosity.min():g} mm2/s, the law needs more than {least:g} mm2/s")
    return temperature, viscosity


def _low_viscosity_term(kinematic_viscosity):
    """C of ASTM D341, with the natural base; it matters below 2 mm2/s only."""
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
        If there are fewer than two temperatures, or a viscosity is 0.21 mm2/s or less.

    Examples
    --------
    >>> a, b = fit_astm_d341([313.15, 373.15], [335.0, 38.3])
    >>> f"{a:.4f}", f"{b:.4f}"
    ('6.9831', '2.6367')
    """
    temperature, viscosity = _data(temperature, kinematic_viscosity, least=ASTM_D341_LEAST)
    z = viscosity + 0.7 + _low_viscosity_term(viscosity)
    intercept, slope = _straight_line(np.log10(temperature), np.log10(np.log10(z)))
    return intercept, -slope


def evaluate_astm_d341(temperature: Values, a: float, b: float) -> Values:
    """Kinematic viscosity by ASTM D341.

    Parameters
    ----------
    temperature : float or numpy.ndarray
        Absolute temperature, K.
    a, b : float
        A and B of `fit_astm_d341`.

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
    >>> a, b = fit_astm_d341([313.15, 373.15], [335.0, 38.3])
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
        If there are fewer than two temperatures, a viscosity is zero or less, or there are two
        temperatures only and one is at or below Cameron's pole of -95 degC.

    Notes
    -----
    With two temperatures the pole c is Cameron's: T - c = theta + 95, with theta in degC. With
    more, ln nu is a straight line in 1/(T - c) for any pole. The pole with the least squared
    residuals in ln nu is searched between 0 K, where the law becomes Andrade's, and 1 K below
    the lowest temperature: first on a grid, then by bounded minimisation, so that the result
    does not depend on a starting value.

    References
    ----------
    H. Vogel, Das Temperaturabhängigkeitsgesetz der Viskosität von Flüssigkeiten, Phys. Z. 22
    (1921) 645-646.

    Examples
    --------
    >>> a, b, c = fit_vogel([313.15, 373.15], [335.0, 38.3])
    >>> f"{a:.4f}", f"{b:.1f}", f"{c:.2f}"
    ('0.2911', '951.5', '178.15')
    """
    temperature, viscosity = _data(temperature, kinematic_viscosity)
    log_viscosity = np.log(viscosity)
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
    """Find the pole c of Vogel's law with the least squared residuals in ln nu, K."""
    from scipy.optimize import minimize_scalar  # on first use: Snakemake imports this module

    def squared_residuals(pole):
        reciprocal = 1.0 / (temperature - pole)
        intercept, slope = _straight_line(reciprocal, log_viscosity)
        return np.sum((intercept + slope * reciprocal - log_viscosity) ** 2)

    grid = np.linspace(0.0, temperature.min() - 1.0, _POLE_GRID)
    best = int(np.argmin([squared_residuals(pole) for pole in grid]))
    bounds = grid[max(best - 1, 0)], grid[min(best + 1, _POLE_GRID - 1)]
    return minimize_scalar(squared_residuals, bounds=bounds, options={"xatol": 1e-9}).x


def evaluate_vogel(temperature: Values, a: float, b: float, c: float) -> Values:
    r"""Kinematic viscosity by Vogel's law.

    .. math:: \nu = a\, e^{b / (T - c)}

    Parameters
    ----------
    temperature : float or numpy.ndarray
        Absolute temperature, K.
    a, b, c : float
        As of `fit_vogel`.

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

    Raises
    ------
    RangeError
        If there are fewer than two temperatures, or a viscosity is zero or less.

    Examples
    --------
    >>> a, b = fit_andrade([313.15, 373.15], [335.0, 38.3])
    >>> f"{a:.3g}", f"{b:.0f}"
    ('0.000465', '4224')
    """
    temperature, viscosity = _data(temperature, kinematic_viscosity)
    intercept, slope = _straight_line(1.0 / temperature, np.log(viscosity))
    return float(np.exp(intercept)), slope


def evaluate_andrade(temperature: Values, a: float, b: float) -> Values:
    r"""Kinematic viscosity by Andrade's law.

    .. math:: \nu = a\, e^{b / T}

    Parameters
    ----------
    temperature : float or numpy.ndarray
        Absolute temperature, K.
    a, b : float
        As of `fit_andrade`.

    Returns
    -------
    float or numpy.ndarray
        Kinematic viscosity, mm2/s.

    Examples
    --------
    >>> f"{evaluate_andrade(333.15, 4.6e-4, 4225.0):.1f}"
    '148.1'
    """
    return a * np.exp(b / np.asarray(temperature, dtype=float))


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
        fit_andrade, evaluate_andrade, ("a", "b"), "nu = a exp(b/T) (Andrade 1930)"
    ),
}
"""Viscosity-temperature laws by name."""

PARAMETER_UNITS = {"A": "1", "B": "1", "a": "mm2 s-1", "b": "K", "c": "K"}
"""Units of the laws' parameters; parameters of the same name have the same unit in every law."""

# Quadratic fits of the standard to its table of reference oils: from Y = KV100 upwards,
# L = a Y^2 + b Y + c and H = d Y^2 + e Y + f. The last row is an equation in its text.
_REFERENCE_OILS = np.array(
    [
        # Y        a         b         c        d        e        f
        [2.0, 1.14673, 1.7576, -0.109, 0.84155, 1.5521, -0.077],
        [3.8, 3.38095, -15.4952, 33.196, 0.78571, 1.7929, -0.183],
        [4.4, 2.50000, -7.2143, 13.812, 0.82143, 1.5679, 0.119],
        [5.0, 0.10100, 16.6350, -45.469, 0.04985, 9.1613, -18.557],
        [6.4, 3.35714, -23.5643, 78.466, 0.22619, 7.7369, -16.656],
        [7.0, 0.01191, 21.4750, -72.870, 0.79762, -0.7321, 14.610],
        [7.7, 0.41858, 16.1558, -56.040, 0.05794, 10.5156, -28.240],
        [9.0, 0.88779, 7.5527, -16.600, 0.26665, 6.7015, -10.810],
        [12.0, 0.76720, 10.7972, -38.180, 0.20073, 8.4658, -22.490],
        [15.0, 0.97305, 5.3135, -2.200, 0.28889, 5.9741, -4.930],
        [18.0, 0.97256, 5.2500, -0.980, 0.24504, 7.4160, -16.730],
        [22.0, 0.91413, 7.4759, -21.820, 0.20323, 9.1267, -34.230],
        [28.0, 0.87031, 9.7157, -50.770, 0.18411, 10.1015, -46.750],
        [40.0, 0.84703, 12.6752, -133.310, 0.17029, 11.4866, -80.620],
        [55.0, 0.85921, 11.1009, -83.190, 0.17130, 11.3680, -76.940],
        [70.0, 0.83530, 14.6700, -216.000, 0.16840, 11.8500, -97.000],
    ]
)


def reference_oils(viscosity_100: float) -> tuple[float, float]:
    """Viscosities at 40 degC of the reference oils of VI 0 and VI 100 (ASTM D2270).

    Parameters
    ----------
    viscosity_100 : float
        Kinematic viscosity of the reference oils at 100 degC, 2 mm2/s or more.

    Returns
    -------
    tuple of float
        L of the oil of viscosity index 0 and H of the oil of viscosity index 100, mm2/s, by the
        standard's quadratic fits, which agree with its table within 0.2 %.

    Raises
    ------
    RangeError
        Below 2 mm2/s, where the viscosity index is not defined.

    Examples
    --------
    >>> low, high = reference_oils(10.0)
    >>> f"{low:.1f}", f"{high:.2f}"
    ('147.7', '82.87')
    """
    if not viscosity_100 >= 2.0:
        raise RangeError(
            f"got {viscosity_100:g} mm2/s at 100 degC, the viscosity index needs 2 mm2/s or more"
        )
    row = np.searchsorted(_REFERENCE_OILS[:, 0], viscosity_100, side="right") - 1
    of_low, of_high = _REFERENCE_OILS[row, 1:].reshape(2, 3)
    return float(np.polyval(of_low, viscosity_100)), float(np.polyval(of_high, viscosity_100))


def viscosity_index(viscosity_40: float, viscosity_100: float) -> float:
    r"""Viscosity index by ASTM D2270, procedure A up to 100 and procedure B above.

    .. math::

        VI = 100 \frac{L - Y_{40}}{L - H} \quad (Y_{40} \ge H), \qquad
        VI = 100 + \frac{10^N - 1}{0.00715}, \;
        N = \frac{\ln(H / Y_{40})}{\ln Y_{100}} \quad (Y_{40} < H)

    Parameters
    ----------
    viscosity_40, viscosity_100 : float
        Kinematic viscosities :math:`Y_{40}` and :math:`Y_{100}` at 40 and at 100 degC, mm2/s.

    Returns
    -------
    float
        Viscosity index, not rounded to the whole number that the standard reports.

    Raises
    ------
    RangeError
        Below 2 mm2/s at 100 degC.

    Examples
    --------
    >>> f"{viscosity_index(335.0, 38.3):.1f}"
    '164.4'
    """
    low, high = reference_oils(viscosity_100)
    if viscosity_40 >= high:
        return 100.0 * (low - viscosity_40) / (low - high)
    exponent = float(np.log(high / viscosity_40) / np.log(viscosity_100))
    return (10.0**exponent - 1.0) / 0.00715 + 100.0


GOLD_BASES = {
    "mineral": (9.904, 0.1390),
    "polyalphaolefin": (7.382, 0.1335),
    "ester": (6.605, 0.1360),
    "polyglycol": (5.489, 0.1485),
}
"""Gold's s and t by base oil (Gold et al., J. Synth. Lubr. 18, 2001)."""


def gold_pressure_viscosity(kinematic_viscosity: Values, base: str) -> Values:
    r"""Pressure-viscosity coefficient by Gold's form.

    .. math:: \alpha = s\, \nu^t \times 10^{-9}\ \mathrm{Pa}^{-1}

    Parameters
    ----------
    kinematic_viscosity : float or numpy.ndarray
        Kinematic viscosity :math:`\nu` at the temperature of interest, mm2/s.
    base : str
        A key of `GOLD_BASES`.

    Returns
    -------
    float or numpy.ndarray
        Pressure-viscosity coefficient :math:`\alpha`, 1/Pa.

    Examples
    --------
    >>> f"{gold_pressure_viscosity(335.0, 'polyalphaolefin'):.3g}"
    '1.6e-08'
    """
    s, t = GOLD_BASES[base]
    return s * np.asarray(kinematic_viscosity, dtype=float) ** t * 1e-9


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
