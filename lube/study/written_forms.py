"""How a value is written in YAML, as JSON Schema: for editors and for the tables of keys.

A field keeps ``0.05`` where people write ``50 mm``. A fragment of these describes what is written.
It accepts every value that the field accepts, and refuses the usual mistakes: a number without
its unit, a unit of another dimension, a negative length. ``format`` says in words what is needed.
"""

import functools
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from typing import Any

from lube.units import converts

_EXAMPLES = {
    **{"m": "50 mm", "N": "800 N", "Pa": "210 GPa", "rpm": "100 rpm", "degC": "40 degC"},
    **{"K": "1 K", "s": "10 us", "Hz": "50 kHz", "V": "50 mV", "ohm": "100 ohm"},
    **{"ohm*m": "0.2 uohm*m", "m^2/s": "335 mm^2/s", "Pa*s": "0.3 Pa*s", "kg/m^3": "860 kg/m^3"},
    **{"1/K": "6.4e-4 1/K", "1/GPa": "16 1/GPa", "W/m/K": "0.16 W/m/K"},
}
_UNITS = (
    *("m", "cm", "mm", "um", "µm", "nm", "pm", "N", "kN", "Pa", "kPa", "MPa", "GPa", "bar", "rpm"),
    *("1/min", "Hz", "kHz", "degC", "K", "s", "ms", "us", "V", "mV", "uV", "ohm", "kohm", "Mohm"),
    *("mm^2/s", "Pa*s", "mPa*s", "kg/m^3", "1/K", "1/GPa", "W/m/K"),
)
"""Units that people use; each is refused where it is of the wrong dimension."""

_NUMBER = r"(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?(\s*/\s*\d+)?"


@dataclass(frozen=True)
class Written:
    """Annotation of a field: a function that makes its JSON schema, called when one is asked for.

    Attributes
    ----------
    schema : callable
        Returns the fragment.
    """

    schema: Callable[[], dict[str, Any]]

    def __get_pydantic_json_schema__(self, core_schema: object, handler: object) -> dict[str, Any]:
        """Answer pydantic."""
        return self.schema()


@functools.cache
def _of_other_dimension(target):
    return [unit for unit in _UNITS if not converts(unit, target)]


def _escaped(unit):
    return "".join(rf"\{sign}" if sign in "/*^" else sign for sign in unit)


def written_quantity(units: str, needed: str, limits: Mapping[str, float]) -> dict[str, Any]:
    """Describe a number with its unit, such as ``50 mm``.

    Parameters
    ----------
    units : str
        Unit that the number is kept in.
    needed : str
        What is needed, in words.
    limits : dict
        Limits of the number, as of `lube.study.field_types.bounded`.

    Returns
    -------
    dict
        JSON schema.
    """
    wrong = "|".join(map(_escaped, _of_other_dimension(units)))
    sign = r"\+?" if limits.get("above") == 0.0 else "[+-]?"
    number = rf"\s*{sign}{_NUMBER}\s*"
    example = _EXAMPLES.get(units, f"1 {units}")
    return {
        "type": "string",
        "format": needed,
        "pattern": rf"^(?!{number}({wrong})\s*$){number}([^\s\d.,]|\s\S)",
        "patternErrorMessage": f"need a {needed}, such as {example}",
        "examples": [example],
    }


def written_number(needed: str, limits: Mapping[str, float]) -> dict[str, Any]:
    """Describe a number without dimension; also a fraction such as ``600/7``, which is a text.

    Parameters
    ----------
    needed, limits
        As of `written_quantity`.

    Returns
    -------
    dict
        JSON schema.
    """
    names = {"above": "exclusiveMinimum", "below": "exclusiveMaximum"}
    names |= {"least": "minimum", "most": "maximum"}
    within = {names[name]: limit for name, limit in limits.items() if name in names}
    text = {"type": "string", "pattern": r"^\s*[+-]?[\d.][\d._eE+-]*(\s*/\s*[\d.][\d._eE+-]*)?\s*$"}
    return {"format": needed, "anyOf": [{"type": "number"} | within, text]}


def written_levels(units: str | None, needed: str, limits: Mapping[str, float]) -> dict[str, Any]:
    """Describe levels: ``{values: [40, 50], units: degC}``, or a list of pure numbers.

    Parameters
    ----------
    units : str or None
        Unit that the levels are kept in, None for pure numbers.
    needed, limits
        As of `written_quantity`.

    Returns
    -------
    dict
        JSON schema.
    """
    if units is not None:  # in another unit only 0 is the same
        limits = {"above": 0.0} if limits.get("above") == 0.0 else {}
    one = {**written_number("number", limits), "format": "number, or a fraction such as 600/7"}
    values = {"type": "array", "items": one, "minItems": 1}
    if units is None:
        return values | {"format": needed, "examples": [[0, 0.1]]}
    unit = {"type": "string", "not": {"enum": _of_other_dimension(units)}, "examples": [units]}
    return {
        "type": "object",
        "format": needed,
        "properties": {"values": values, "units": unit},
        "required": ["values", "units"],
        "additionalProperties": False,
    }
