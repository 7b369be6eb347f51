"""Properties of pure liquids from CoolProp, with checks of their range.

CoolProp does not refuse states outside a fluid's range: it returns negative viscosities above the
maximum pressure, and properties of the gas above the boiling point. Here the state is checked
before the call, and the result after it. CoolProp is imported on first use, because the import
takes a second or two. Temperatures are in kelvin.
"""

import functools
import re
from contextlib import suppress

import numpy as np

from lube.errors import RangeError, RecordError
from lube.physics import ZERO_CELSIUS
from lube.types import Array

ATMOSPHERIC_PRESSURE = 101325.0
"""Standard atmosphere, Pa."""

# Pressure step of the difference quotient of ln(viscosity), Pa. CoolProp is smooth to ten digits
# and the curvature cancels, so the slope is accurate to about 1e-5.
_SLOPE_STEP = 3e5

# Distance kept from the boiling point, where CoolProp may return either phase, and from the
# triple point's temperature, where the fluid is solid at atmospheric pressure, K.
_MARGIN = 0.1

# Temperatures converted from degC to K may miss a limit by rounding, K.
_ROUNDING = 1e-6

_PROPERTIES = {"viscosity": "V", "density": "D", "conductivity": "L"}

# Mixtures (A&B, A[0.5]) and other backends (INCOMP::S800, with oils whose viscosity does not
# depend on pressure) lack properties that the study needs.
_PURE_FLUID = re.compile(r"[A-Za-z0-9()-]{1,60}")


def _unfit(fluid, need):
    return RecordError(f"coolprop_fluid: got {fluid!r}, need a {need}")


def _coolprop(*arguments):
    from CoolProp import CoolProp

    return CoolProp.PropsSI(*arguments)


@functools.cache
def liquid_range(fluid: str) -> tuple[float, float]:
    """Temperature range in which a fluid is liquid at atmospheric pressure.

    Parameters
    ----------
    fluid : str
        CoolProp's name of a pure fluid, such as ``n-Dodecane``.

    Returns
    -------
    tuple of float
        Lowest and highest temperature, K: from 0.1 K above the lower limit of the equation
        of state to 0.1 K below the boiling point.

    Raises
    ------
    RecordError
        If CoolProp has no such pure fluid, or the fluid is never liquid at this pressure.

    Examples
    --------
    >>> lowest, highest = liquid_range("n-Dodecane")
    >>> f"{lowest:.1f}", f"{highest:.1f}"
    ('263.7', '489.3')
    """
    try:
        if not _PURE_FLUID.fullmatch(fluid):
            raise ValueError("not the name of a pure fluid")
        lowest = _coolprop("Tmin", fluid) + _MARGIN
    except ValueError:
        raise _unfit(fluid, "pure fluid by CoolProp's spelling, such as 'n-Dodecane'") from None
    with suppress(ValueError):  # some fluids do not boil at this pressure
        boiling = _coolprop("T", "P", ATMOSPHERIC_PRESSURE, "Q", 0, fluid)
        highest = min(_coolprop("Tmax", fluid), boiling - _MARGIN)
        if lowest < highest:
            return lowest, highest
    raise _unfit(fluid, "fluid that is liquid at atmospheric pressure")


def _within_range(fluid, temperature, pressure):
    """Return temperatures as a float array; refuse states outside the fluid's range."""
    lowest, highest = liquid_range(fluid)
    temperature = np.asarray(temperature, dtype=float)
    beyond = np.maximum(lowest - temperature, temperature - highest)
    if not beyond.max() <= _ROUNDING:
        raise RangeError(
            f"{fluid}: got {temperature[beyond.argmax()] - ZERO_CELSIUS:g} degC, CoolProp's liquid "
            f"range at atmospheric pressure is {lowest - ZERO_CELSIUS:.2f} to "
            f"{highest - ZERO_CELSIUS:.2f} degC"
        )
    most = _coolprop("pmax", fluid)
    if not ATMOSPHERIC_PRESSURE <= pressure <= most:
        raise RangeError(
            f"{fluid}: got a pressure of {pressure / 1e6:g} MPa, CoolProp's range is "
            f"{ATMOSPHERIC_PRESSURE / 1e6:g} to {most / 1e6:g} MPa"
        )
    return np.clip(temperature, lowest, highest)


def liquid_property(
    fluid: str, name: str, temperature: Array, pressure: float = ATMOSPHERIC_PRESSURE
) -> Array:
    """Viscosity, density or thermal conductivity of a pure liquid.

    Parameters
    ----------
    fluid : str
        CoolProp's name of a pure fluid.
    name : str
        ``viscosity`` (dynamic, Pa s), ``density`` (kg/m3) or ``conductivity`` (thermal,
        W/(m K)).
    temperature : numpy.ndarray, shape (n,)
        Temperatures, K.
    pressure : float, optional
        Pressure, Pa. Only for some fluids does CoolProp refuse a pressure under which they
        freeze.

    Returns
    -------
    numpy.ndarray, shape (n,)
        The property, positive and finite.

    Raises
    ------
    RecordError
        If CoolProp does not know the fluid, or this property of it.
    RangeError
        If a state lies outside CoolProp's range for the fluid, or CoolProp's value is not
        positive.

    Examples
    --------
    >>> liquid_property("n-Dodecane", "viscosity", np.array([313.15])).round(6)
    array([0.001061])
    """
    temperature = _within_range(fluid, temperature, pressure)
    try:
        pressures = np.full(temperature.shape, pressure)
        values = _coolprop(_PROPERTIES[name], "T", temperature, "P", pressures, fluid)
    except ValueError:
        raise _unfit(fluid, f"fluid whose {name} CoolProp knows") from None
    wrong = ~(np.isfinite(values) & (values > 0.0))
    if wrong.any():
        raise RangeError(
            f"{fluid}: CoolProp gives a {name} of {values[wrong][0]:g} at "
            f"{temperature[wrong][0] - ZERO_CELSIUS:g} degC and {pressure / 1e6:g} MPa, need a "
            "positive one"
        )
    return values


def secant_pressure_viscosity(fluid: str, temperature: Array, pressure: float) -> Array:
    r"""Secant pressure-viscosity coefficient, from atmospheric pressure to a given one.

    .. math:: \alpha = \frac{\ln(\eta(p) / \eta(p_0))}{p - p_0}

    Parameters
    ----------
    fluid : str
        CoolProp's name of a pure fluid.
    temperature : numpy.ndarray, shape (n,)
        Temperatures, K.
    pressure : float
        Pressure :math:`p`, Pa.

    Returns
    -------
    numpy.ndarray, shape (n,)
        :math:`\alpha`, 1/Pa.

    Raises
    ------
    RecordError, RangeError
        As in `liquid_property`.

    Examples
    --------
    >>> f"{secant_pressure_viscosity('n-Dodecane', np.array([313.15]), 200e6)[0]:.3g}"
    '8.68e-09'
    """
    under_pressure = liquid_property(fluid, "viscosity", temperature, pressure)
    ratio = under_pressure / liquid_property(fluid, "viscosity", temperature)
    return np.log(ratio) / (pressure - ATMOSPHERIC_PRESSURE)


def initial_pressure_viscosity(fluid: str, temperature: Array) -> Array:
    r"""Pressure-viscosity coefficient as the slope of ln(viscosity) at atmospheric pressure.

    .. math:: \alpha = \left. \frac{d \ln \eta}{d p} \right|_{p_0}

    The slopes of two secants, one over twice the pressure step of the other, are extrapolated to
    a step of zero.

    Parameters
    ----------
    fluid : str
        CoolProp's name of a pure fluid.
    temperature : numpy.ndarray, shape (n,)
        Temperatures, K.

    Returns
    -------
    numpy.ndarray, shape (n,)
        :math:`\alpha`, 1/Pa.

    Raises
    ------
    RecordError, RangeError
        As in `liquid_property`.

    Examples
    --------
    >>> f"{initial_pressure_viscosity('n-Dodecane', np.array([313.15]))[0]:.3g}"
    '1.27e-08'
    """
    short = secant_pressure_viscosity(fluid, temperature, ATMOSPHERIC_PRESSURE + _SLOPE_STEP)
    long = secant_pressure_viscosity(fluid, temperature, ATMOSPHERIC_PRESSURE + 2.0 * _SLOPE_STEP)
    return 2.0 * short - long
