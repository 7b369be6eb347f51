"""Numbers with units, as people write them: ``50 mm``, ``335 mm^2/s``, ``40 degC``.

A dimensional number in the YAML files of a study must carry its unit. This module converts such
a text to a float in the unit that the study computes in, and says in one line what is wrong
when it cannot.
"""

import functools
import math
import re
import unicodedata

import numpy as np

from lube.errors import LubeError, shown

_NUMBER = r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?"
_QUANTITY = re.compile(rf"((?>{_NUMBER})(?:\s*/\s*\d+)?)\s*([^\s,;].*)?")

# For speeds of rotation and frequencies.
_TURNS = {"rpm": "rpm", "Hz": "turn/s"}
_TURN = re.compile(r"(?<![A-Za-z])(?:U|r|rev)(?![A-Za-z])")
_POWER = re.compile(r"(?<=[A-Za-z])-?[1-9](?!\w)")
_PASCAL_SECOND = re.compile(r"\b(\w?Pa)s\b")  # pint would read mPas as millipascals

ELECTRICAL = {"voltage": "V", "resistance": "ohm"}
"""Quantities that a record may hold, each with the unit of its values in memory."""

_LOOSE_UNIT = re.compile("(ohm|volt|second)s?$", re.IGNORECASE)

# How `with_unit` formats a number: with a prefix, in the customary unit, or with a symbol.
_PREFIXES = {-12: "p", -9: "n", -6: "µ", -3: "m", 0: "", 3: "k", 6: "M", 9: "G", 12: "T"}
_PREFIXED = {"m", "s", "Pa", "V", "Hz", "ohm", "ohm*m"}
_CUSTOMARY = {"m^2/s": (1e6, "mm²/s"), "1/Pa": (1e9, "1/GPa")}
SYMBOLS = {"ohm": "Ω", "ohm*m": "Ω m", "degC": "°C", "rpm": "r/min", "Pa*s": "Pa s",
           "kg/m^3": "kg/m³", "um": "µm", "mm2 s-1": "mm²/s", "m2 s-1": "m²/s", "kg m-3": "kg/m³",
           "m s-1": "m/s", "Pa-1": "1/Pa", "GPa-1": "1/GPa", "s-1": "1/s",
           "h-1": "1/h", "K-1": "1/K", "m-1": "1/m"}  # fmt: skip
"""Printed form of each unit, from the notation of pint (``kg/m^3``) or of files (``kg m-3``)."""


@functools.cache
def _registry():
    import pint  # imported on first use: it costs more than the rest of the package

    try:
        # Every job needs pint's definitions, and to parse them takes ten times as long as to read
        # them from the cache in the user's folder.
        return pint.UnitRegistry(cache_folder=":auto:", preprocessors=[_as_in_pint])
    except Exception:  # a folder that cannot be written, or a file that another job is writing
        return pint.UnitRegistry(preprocessors=[_as_in_pint])


def _as_in_pint(units):
    """Spell ``mm2/s``, ``kg m-3`` or ``mPas``, as data sheets and files have them, as in pint."""
    return _PASCAL_SECOND.sub(r"(\1*s)", _POWER.sub(r"^\g<0>", units))


def parse_number(value: object) -> float:
    """Convert a bare number, or a fraction such as ``600/7``, to a float.

    Parameters
    ----------
    value : int, float or str
        The number, from a YAML or CSV file.

    Returns
    -------
    float
        The finite number.

    Raises
    ------
    LubeError
        If `value` is not a number or not finite.

    Examples
    --------
    >>> parse_number("600/7")
    85.71428571428571
    """
    try:
        numerator, _, denominator = str(value).partition("/")
        number = float(numerator) / float(denominator) if denominator else float(value)
    except (TypeError, ValueError, ZeroDivisionError, OverflowError):
        number = math.nan
    if isinstance(value, bool | bytes) or not math.isfinite(number):
        raise LubeError(f"got {shown(value)}, need a finite number{_decimal_point(value)}")
    return number


def convert(number: float | np.ndarray, units: str, target: str) -> float | np.ndarray:
    """Convert a number, or an array, between two units of the same dimension.

    Three targets are special. ``rpm`` and ``Hz`` are a speed of rotation and a frequency: ``1/min``
    and ``Hz`` count turns, unless the unit names another angle, such as ``rad/s``. ``K`` is a
    difference of temperatures: 1 degC is 1 K.

    Parameters
    ----------
    number : float or numpy.ndarray
        The value in `units`.
    units, target : str
        Units that pint understands, such as ``mm^2/s`` and ``m^2/s``.

    Returns
    -------
    float or numpy.ndarray
        The value in `target`.

    Raises
    ------
    LubeError
        If a unit is unknown or the dimensions differ.

    Examples
    --------
    >>> convert(2.0, "Hz", "rpm")
    120.0
    """
    if units == target:
        return number
    registry = _registry()
    try:
        turns = _TURNS.get(target)
        value = registry.Quantity(number, _in_turns(units, registry) if turns else units)
        if target == "K":
            value = value - registry.Quantity(0.0, units)
        return value.to(turns or target).magnitude
    except Exception as error:  # pint's parser raises errors of many kinds
        unknown = "Undefined" in type(error).__name__
        reason = "unknown unit" if unknown else "wrong dimension or unit"
        raise LubeError(f"{reason} {shown(units)}, need a unit of the kind {target!r}") from None


def converts(units: str, target: str) -> bool:
    """Whether `convert` knows a unit and can convert it to the target.

    Examples
    --------
    >>> converts("mV", "V"), converts("mV", "ohm")
    (True, False)
    """
    try:
        convert(1.0, units, target)
    except LubeError:
        return False
    return True


def _in_turns(units, registry):
    """Read a unit such as ``rad/s``; ``1/min`` and ``Hz`` count turns.

    Pint treats an angle as a pure number, so 100 1/min would be 15.9 rpm.
    """
    units = registry.Unit("turn " + _TURN.sub("turn", units))
    is_angle_twice = "radian ** 2" in f"{registry.get_root_units(units)[1]}"
    return units / registry.turn if is_angle_twice else units


def usual_spelling(units: str) -> str:
    """Spell a unit as `convert` knows it.

    Parameters
    ----------
    units : str
        Such as ``kOhm`` or ``Volts``, with any of Unicode's characters for ohm and micro.

    Returns
    -------
    str
        Such as ``kohm`` or ``volts``.

    Examples
    --------
    >>> usual_spelling("kOhm")
    'kohm'
    """
    units = unicodedata.normalize("NFKC", units.strip())
    return _LOOSE_UNIT.sub(lambda match: match[0].lower(), units)


def electrical_quantity(units: object) -> str:
    """Find out whether a unit is one of voltage or of resistance.

    Parameters
    ----------
    units : str
        The unit, in any usual spelling.

    Returns
    -------
    str
        ``voltage`` or ``resistance``.

    Raises
    ------
    LubeError
        If it is neither.

    Examples
    --------
    >>> electrical_quantity("kOhm")
    'resistance'
    """
    for quantity, target in ELECTRICAL.items() if isinstance(units, str) else ():
        if converts(usual_spelling(units), target):
            return quantity
    raise LubeError(f"got the unit {shown(units)}, need one of voltage or resistance")


def parse_quantity(value: object, target: str) -> float:
    """Convert a text such as ``'50 mm'`` to a float in the target unit.

    Parameters
    ----------
    value : str
        A number and its unit.
    target : str
        The unit of the returned number, such as ``m``.

    Returns
    -------
    float
        The value in `target`.

    Raises
    ------
    LubeError
        If the text has no number or no unit, or the unit's dimension is wrong.

    Examples
    --------
    >>> parse_quantity("50 mm", "m")
    0.05
    """
    such = "50 %" if target == "1" else f"1 {target}"
    number, units = _parts(value, f"a number with its unit, such as '{such}'")
    return float(convert(number, units, target))


def parse_electrical(value: object) -> tuple[float, str]:
    """Convert a text such as ``'3 mV'`` or ``'2 kOhm'`` to a float in V or ohm.

    Parameters
    ----------
    value : str
        A number and its unit.

    Returns
    -------
    number : float
        The value in V or ohm.
    quantity : str
        ``voltage`` or ``resistance``.

    Raises
    ------
    LubeError
        If the text has no number or no unit, or the unit is of another quantity.

    Examples
    --------
    >>> parse_electrical("2 kOhm")
    (2000.0, 'resistance')
    """
    number, units = _parts(value, "a voltage or a resistance with its unit, such as '3 mV'")
    quantity = electrical_quantity(units)
    return float(convert(number, usual_spelling(units), ELECTRICAL[quantity])), quantity


def _parts(value, needed):
    """Split a text into its number and its unit."""
    match = _QUANTITY.fullmatch(value.strip()) if isinstance(value, str) else None
    if match is None or match[2] is None:
        raise LubeError(f"got {shown(value)}, need {needed}{_decimal_point(value)}")
    return parse_number(match[1]), match[2]


def _decimal_point(value):
    """Say that a decimal comma should be a point, if there is one."""
    if not isinstance(value, str) or not re.match(r"\s*[+-]?\d*,\d", value):
        return ""
    return f", with a decimal point: {shown(value.replace(',', '.', 1))}"


def with_unit(value: float, unit: str, digits: int = 17) -> str:
    """Format a number with its unit, with a prefix or in the customary unit.

    Parameters
    ----------
    value : float
        The number.
    unit : str
        Its unit, as in a study's schema; empty for a pure number.
    digits : int, optional
        Significant digits; six at most are printed.

    Returns
    -------
    str
        Such as ``0.2 µm``, ``210 GPa``, ``86 r/min``.

    Examples
    --------
    >>> with_unit(2.1e11, "Pa")
    '210 GPa'
    """
    value = float(f"{value:.{digits}g}")
    if unit in _CUSTOMARY:
        factor, symbol = _CUSTOMARY[unit]
        return f"{value * factor:.6g} {symbol}"
    prefix = ""
    if unit in _PREFIXED and 0.0 < abs(value) < math.inf:
        # Roughness is customarily given in micrometres: 0.2 µm reads better than 200 nm.
        size = abs(value) * (10.0 if unit == "m" and abs(value) < 1e-6 else 1.0)
        power = 3 * math.floor(math.log10(size * (1.0 + 1e-9)) / 3)
        power = min(max(power, min(_PREFIXES)), max(_PREFIXES))
        value, prefix = value / 10.0**power, _PREFIXES[power]
    return f"{value:.6g} {prefix}{SYMBOLS.get(unit, unit)}".strip()
