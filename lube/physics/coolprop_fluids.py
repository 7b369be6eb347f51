"""Properties of pure liquids from CoolProp, guarded.

CoolProp does not refuse states outside a fluid's range: it returns negative viscosities
beyond the highest pressure, and a gas above the boiling point. Here every state is checked
before it is asked for, and every answer before it is passed on. CoolProp is imported on
first use, because that takes a second or two. Temperatures are in kelvin.
"""

import functools
import re

import numpy as np

from lube.errors import RangeError, RecordError
from lube.physics.viscosity import ZERO_CELSIUS

ATMOSPHERIC_PRESSURE = 101325.0

# Over this pressure the slope of ln(viscosity) is taken by three points. CoolProp is smooth
# to ten digits and the curvature term is cancelled: the slope is right to about 1e-5.
_SLOPE_STEP = 3e5

# CoolProp is undecided within a hair of the boiling point, and at the triple point's
# temperature atmospheric pressure already means a solid.
_MARGIN = 0.1

# Numbers read as degC and turned into K may miss a limit by rounding.
_ROUNDING = 1e-6

_PROPERTIES = {"viscosity": "V", "density": "D", "conductivity": "L"}

# Neither mixtures (A&B, A[0.5]) nor other backends (INCOMP::S800, whose oils do not know
# pressure) have what the study needs.
_PURE_FLUID = re.compile(r"[A-Za-z0-9()-]{1,60}")


def _coolprop():
    from CoolProp import CoolProp

    return CoolProp


@functools.cache
def liquid_range(fluid):
    """Temperatures at which a fluid is liquid at atmospheric pressure.

    Parameters
    ----------
    fluid : str
        CoolProp's name of a pure fluid, such as ``n-Dodecane``.

    Returns
    -------
    tuple of float
        Lowest and highest temperature, K: from 0.1 K above the lower limit of the equation
        of state to 0.1 K below boiling.

    Raises
    ------
    RecordError
        If CoolProp has no such pure fluid, or it is nowhere liquid at this pressure.
    """
    coolprop = _coolprop()
    try:
        if not _PURE_FLUID.fullmatch(fluid):
            raise ValueError("not the name of a pure fluid")
        coolprop.get_fluid_param_string(fluid, "CAS")
    except ValueError:
        raise RecordError(
            f"coolprop_fluid: got {fluid!r}, need a pure fluid by CoolProp's spelling, "
            "such as 'n-Dodecane'"
        ) from None
    lowest = coolprop.PropsSI("Tmin", fluid) + _MARGIN
    try:
        boiling = coolprop.PropsSI("T", "P", ATMOSPHERIC_PRESSURE, "Q", 0, fluid)
    except ValueError:
        boiling = -np.inf
    highest = min(coolprop.PropsSI("Tmax", fluid), boiling - _MARGIN)
    if not lowest < highest:
        raise RecordError(
            f"coolprop_fluid: got {fluid!r}, need a fluid that is liquid at atmospheric pressure"
        )
    return lowest, highest


def _within_range(fluid, temperature, pressure):
    """Temperatures as a float array, refused outside the fluid's range of states."""
    lowest, highest = liquid_range(fluid)
    temperature = np.asarray(temperature, dtype=float)
    beyond = np.maximum(lowest - temperature, temperature - highest)
    if not beyond.max() <= _ROUNDING:
        came, low, high = (
            kelvin - ZERO_CELSIUS for kelvin in (temperature[beyond.argmax()], lowest, highest)
        )
        raise RangeError(
            f"{fluid}: got {came:g} degC, CoolProp's liquid range at atmospheric pressure is "
            f"{low:.2f} to {high:.2f} degC"
        )
    most = _coolprop().PropsSI("pmax", fluid)
    if not ATMOSPHERIC_PRESSURE <= pressure <= most:
        raise RangeError(
            f"{fluid}: got a pressure of {pressure / 1e6:g} MPa, CoolProp's range is "
            f"{ATMOSPHERIC_PRESSURE / 1e6:g} to {most / 1e6:g} MPa"
        )
    return np.clip(temperature, lowest, highest)


def liquid_property(fluid, name, temperature, pressure=ATMOSPHERIC_PRESSURE):
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
        Pressure, Pa. Whether the liquid freezes under it CoolProp knows for some fluids only.

    Returns
    -------
    numpy.ndarray, shape (n,)
        The property, positive and finite.

    Raises
    ------
    RecordError
        If CoolProp does not know the fluid, or this property of it.
    RangeError
        If a state lies outside CoolProp's range for the fluid, or gives no positive value.
    """
    temperature = _within_range(fluid, temperature, pressure)
    try:
        pressures = np.full(temperature.shape, pressure)
        values = _coolprop().PropsSI(_PROPERTIES[name], "T", temperature, "P", pressures, fluid)
    except ValueError:
        raise RecordError(
            f"coolprop_fluid: got {fluid!r}, need a fluid whose {name} CoolProp knows"
        ) from None
    wrong = ~(np.isfinite(values) & (values > 0.0))
    if wrong.any():
        raise RangeError(
            f"{fluid}: CoolProp gives a {name} of {values[wrong][0]:g} at "
            f"{temperature[wrong][0] - ZERO_CELSIUS:g} degC and {pressure / 1e6:g} MPa, need a "
            "positive one"
        )
    return values


def secant_pressure_viscosity(fluid, temperature, pressure):
    """Mean rise of ln(viscosity) with pressure from atmospheric pressure p0 to p.

    Parameters
    ----------
    fluid : str
        CoolProp's name of a pure fluid.
    temperature : numpy.ndarray, shape (n,)
        Temperatures, K.
    pressure : float
        Pressure p, Pa.

    Returns
    -------
    numpy.ndarray, shape (n,)
        ln(eta(p)/eta(p0))/(p - p0), 1/Pa.

    Raises
    ------
    RecordError, RangeError
        As of `liquid_property`.
    """
    ratio = liquid_property(fluid, "viscosity", temperature, pressure) / liquid_property(
        fluid, "viscosity", temperature
    )
    return np.log(ratio) / (pressure - ATMOSPHERIC_PRESSURE)


def initial_pressure_viscosity(fluid, temperature):
    """Slope of ln(viscosity) against pressure at atmospheric pressure.

    Two secants, of which one is twice as long, are extrapolated to length zero.

    Parameters
    ----------
    fluid : str
        CoolProp's name of a pure fluid.
    temperature : numpy.ndarray, shape (n,)
        Temperatures, K.

    Returns
    -------
    numpy.ndarray, shape (n,)
        d ln(eta)/dp, 1/Pa.

    Raises
    ------
    RecordError, RangeError
        As of `liquid_property`.
    """
    short = secant_pressure_viscosity(fluid, temperature, ATMOSPHERIC_PRESSURE + _SLOPE_STEP)
    long = secant_pressure_viscosity(fluid, temperature, ATMOSPHERIC_PRESSURE + 2.0 * _SLOPE_STEP)
    return 2.0 * short - long
