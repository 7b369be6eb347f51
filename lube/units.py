"""Numbers with units, as people write them: ``50 mm``, ``335 mm^2/s``, ``40 degC``.

The YAML files of a study may not contain a dimensional number without its unit.
This module turns such a text into a float in the unit that the study computes in,
and says in one line what is wrong when it cannot.
"""

import contextlib
import functools
import math
import re
import unicodedata

from lube.errors import LubeError, shown

_NUMBER = r"[+-]?(?:\d+\.?\d*|\.\d+)(?:[eE][+-]?\d+)?"
_FRACTION = re.compile(rf"({_NUMBER})\s*/\s*(\d+)")
_QUANTITY = re.compile(rf"({_NUMBER}(?:\s*/\s*\d+)?)\s*(\S.*)?", re.DOTALL)

# A long run of digits would keep the patterns busy for hours.
_LONGEST = 100

# Units are products and quotients of names with one-digit exponents. Pint would read far
# more, arithmetic that never ends included; a file from elsewhere must not reach that.
_FACTOR = r"(?:delta_)?[A-Za-zµμΩ°%]+(?:(?:\^|\*\*)?[+-]?\d|[²³])?"
_UNITS = re.compile(rf"(?:1|{_FACTOR})(?:\s*[*/·]\s*{_FACTOR}|\s+{_FACTOR})*")

# Of a rotation. To pint an angle is a pure number, so 100 1/min would be 15.9 rpm; but who gives a
# rotation as so many per minute, or in hertz, means turns.
_ANGLE = re.compile("rpm|turn|revolution|cycle|rad|deg")
_TURN = re.compile(r"(?<![A-Za-z])(?:U|r|rev)(?![A-Za-z])")
_INVERSE = re.compile(r"(?<=[A-Za-z])(?:(?:\^|\*\*)?-1|⁻¹)(?!\d)")
_FREQUENCY = re.compile(r"1?\s*/\s*[A-Za-zµμ]+|[A-Za-zµμ]+\^-1|[A-Za-zµμ]*Hz|[a-z]*hertz")

ELECTRICAL = {"voltage": "V", "resistance": "ohm"}
"""What a record of the rig may hold, and the unit that it is kept in."""

_LOOSE_UNIT = re.compile("(ohm|volt|second)s?$", re.IGNORECASE)

# How a number is printed: with a prefix, in the unit of the trade, or with the unit's own sign.
_PREFIXES = {-12: "p", -9: "n", -6: "µ", -3: "m", 0: "", 3: "k", 6: "M", 9: "G", 12: "T"}
_PREFIXED = {"m", "s", "Pa", "V", "Hz", "ohm", "ohm*m"}
_USUAL = {"m^2/s": (1e6, "mm²/s"), "1/Pa": (1e9, "1/GPa")}
_SIGNS = {"ohm": "Ω", "ohm*m": "Ω m", "degC": "°C", "rpm": "r/min", "Pa*s": "Pa s",
          "kg/m^3": "kg/m³"}  # fmt: skip


@functools.cache
def _registry():
    import pint  # imported on first use: it costs more than the rest of the package

    return pint.UnitRegistry()


def parse_number(value):
    """Turn a bare number, or an exact fraction such as ``600/7``, into a float.

    Parameters
    ----------
    value : int, float or str
        The number as the YAML reader gave it.

    Returns
    -------
    float
        The finite number.

    Raises
    ------
    LubeError
        If `value` is not a number or not finite.
    """
    if isinstance(value, bool) or not isinstance(value, (int, float, str)):
        raise LubeError(f"got {shown(value)}, need a number")
    if isinstance(value, str) and len(value) > _LONGEST:
        raise LubeError(f"got {shown(value)}, need a number of {_LONGEST} characters at most")
    try:
        fraction = _FRACTION.fullmatch(value.strip()) if isinstance(value, str) else None
        number = float(fraction[1]) / float(fraction[2]) if fraction else float(value)
    except (ValueError, ZeroDivisionError, OverflowError):
        raise LubeError(f"got {shown(value)}, need a number") from None
    if not math.isfinite(number):
        raise LubeError(f"got {shown(value)}, need a finite number")
    return number


def convert(number, units, target):
    """Convert a number, or an array, between two units of the same dimension.

    Two targets say what is meant. With ``rpm`` it is a speed of rotation: ``1/min`` and ``Hz``
    count turns, and only a unit that names another angle, such as ``rad/s``, does not. With ``K``
    it is a difference of temperatures: 1 degC is 1 K.

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
    """
    if units == target:
        return number
    written, units = units, _in_turns(units) if target == "rpm" else units
    if len(units) > 40 or not _UNITS.fullmatch(units):
        raise LubeError(f"{written[:40]!r} is no unit, need one of the kind {target!r}")
    registry = _registry()
    try:
        value = registry.Quantity(number, units)
        if target == "K":
            value = value - registry.Quantity(0.0, units)
        converted = value.to(target).magnitude
    except Exception as error:  # pint's parser raises many kinds, all meaning one thing
        kind = type(error).__name__
        reason = "unknown unit" if "Undefined" in kind else "wrong dimension or unit"
        raise LubeError(f"{reason} {shown(written)}, need a unit of the kind {target!r}") from None
    if target == "rpm" and not _ANGLE.search(units):
        raise LubeError(
            f"{shown(written)} names no angle, need a unit such as 'rpm', '1/s' or 'rad/s'"
        )
    return converted


def _in_turns(units):
    """Name the turns of a speed of rotation: ``1/min``, ``Hz``, ``U/min`` and the like."""
    units = _INVERSE.sub("^-1", _TURN.sub("turn", units.strip()[:_LONGEST]))
    if _FREQUENCY.fullmatch(units):
        return f"turn{units.lstrip('1 ')}" if "/" in units else f"turn*{units}"
    return units


def usual_spelling(text):
    """Spell a unit at the end of a text as `convert` knows it.

    Parameters
    ----------
    text : str
        Such as ``kOhm``, ``Volts`` or ``3 MOhm``, with any of Unicode's signs for ohm and micro.

    Returns
    -------
    str
        Such as ``kohm``, ``volts`` or ``3 Mohm``.
    """
    text = unicodedata.normalize("NFKC", text.strip())
    return _LOOSE_UNIT.sub(lambda match: match[0].lower(), text)


def electrical_quantity(units):
    """Tell whether a unit is one of voltage or of resistance.

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
    """
    for quantity, target in ELECTRICAL.items() if isinstance(units, str) else ():
        with contextlib.suppress(LubeError):
            convert(1.0, usual_spelling(units), target)
            return quantity
    raise LubeError(
        f"got the unit {shown(units)}, need one of voltage or resistance, such as 'mV' or 'kohm'"
    )


def parse_quantity(value, target):
    """Turn ``'50 mm'`` into a float in the target unit.

    Parameters
    ----------
    value : str
        A number and its unit.
    target : str
        The unit of the returned number, such as ``m``.

    Returns
    -------
    float
        The finite value in `target`.

    Raises
    ------
    LubeError
        If the text has no number or no unit, or the unit's dimension is wrong.
    """
    match = _QUANTITY.fullmatch(value.strip()) if isinstance(value, str) else None
    if match is None:
        raise LubeError(f"got {shown(value)}, need a number with its unit, such as '1 {target}'")
    number, units = match.groups()
    if units is None:
        raise LubeError(f"got {shown(value)} without a unit, need one such as '{number} {target}'")
    converted = float(convert(parse_number(number), units, target))
    if not math.isfinite(converted):
        raise LubeError(f"got {shown(value)}, need a finite number")
    return converted


def parse_electrical(value):
    """Turn ``'3 mV'`` or ``'2 kOhm'`` into a float in V or ohm.

    Parameters
    ----------
    value : str
        A number and its unit.

    Returns
    -------
    number : float
        The finite value, V or ohm.
    quantity : str
        ``voltage`` or ``resistance``.

    Raises
    ------
    LubeError
        If the text has no number or no unit, or the unit is another's.
    """
    match = _QUANTITY.fullmatch(value.strip()) if isinstance(value, str) else None
    if match is None or match[2] is None:
        raise LubeError(
            f"got {shown(value)}, need a voltage or a resistance with its unit, such as '3 mV'"
        )
    quantity = electrical_quantity(match[2])
    return parse_quantity(usual_spelling(value), ELECTRICAL[quantity]), quantity


def with_unit(value, unit):
    """Print a number with its unit, scaled so that it is easily read.

    Parameters
    ----------
    value : float
        The number.
    unit : str
        Its unit, as in a study's schema; empty for a pure number.

    Returns
    -------
    str
        Such as ``0.2 µm``, ``210 GPa``, ``86 r/min``.
    """
    if unit in _USUAL:
        factor, sign = _USUAL[unit]
        return f"{value * factor:.6g} {sign}"
    prefix = ""
    if unit in _PREFIXED and value:
        # Roughness is told in micrometres: 0.2 µm reads better than 200 nm.
        size = abs(value) * (10.0 if unit == "m" and abs(value) < 1e-6 else 1.0)
        power = 3 * math.floor(math.log10(size * (1.0 + 1e-9)) / 3)
        power = min(max(power, min(_PREFIXES)), max(_PREFIXES))
        value, prefix = value / 10.0**power, _PREFIXES[power]
    return f"{value:.6g} {prefix}{_SIGNS.get(unit, unit)}".strip()
