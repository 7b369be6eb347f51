"""How values are written in YAML, as JSON Schema for editors.

The fields of `lube.study.field_types` name the form that they have. It accepts every value that the
field accepts, and refuses the usual mistakes: a number without its unit, a unit of another
dimension, a negative length. ``format`` says in words what is needed.
"""

import functools

from lube.study.lubricant_record import shipped_records
from lube.units import converts

_EXAMPLES = {
    **{"m": "50 mm", "N": "800 N", "Pa": "210 GPa", "rpm": "100 rpm", "degC": "40 degC"},
    **{"K": "1 K", "s": "10 us", "Hz": "50 kHz", "V": "50 mV", "ohm": "100 ohm"},
    **{"ohm*m": "0.2 uohm*m", "m^2/s": "335 mm^2/s", "Pa*s": "0.3 Pa*s", "kg/m^3": "860 kg/m^3"},
    **{"1/K": "6.4e-4 1/K", "1/GPa": "16 1/GPa", "W/m/K": "0.16 W/m/K"},
}
_UNITS = (
    "m cm mm um µm nm pm N kN Pa kPa MPa GPa bar rpm 1/min Hz kHz degC K s ms us V mV uV ohm kohm "
    "Mohm mm^2/s Pa*s mPa*s kg/m^3 1/K 1/GPa W/m/K"
).split()
"""Units that people use; each is refused where it is of the wrong dimension."""

_NUMBER = r"(\d+\.?\d*|\.\d+)([eE][+-]?\d+)?(\s*/\s*\d+)?"


@functools.cache
def _of_other_dimension(target):
    return [unit for unit in _UNITS if not converts(unit, target)]


def _escaped(unit):
    return "".join(rf"\{sign}" if sign in "/*^" else sign for sign in unit)


def quantity(needed, units, limits):
    """Describe a number with its unit, such as ``50 mm``."""
    wrong = "|".join(map(_escaped, _of_other_dimension(units)))
    sign = r"\+?" if limits.get("above") == 0.0 else "[+-]?"
    number = rf"\s*{sign}{_NUMBER}\s*"
    example = _EXAMPLES.get(units, f"1 {units}")
    return {
        "examples": [example],
        "format": needed,
        "pattern": rf"^(?!{number}({wrong})\s*$){number}([^\s\d.,]|\s\S)",
        "patternErrorMessage": f"need a {needed}, such as {example}",
        "type": "string",
    }


def number(needed, units, limits):
    """Describe a number without dimension; also a fraction such as ``600/7``, which is a text."""
    names = {"above": "exclusiveMinimum", "below": "exclusiveMaximum"}
    names |= {"least": "minimum", "most": "maximum"}
    within = {names[name]: limit for name, limit in limits.items() if name in names}
    pattern = r"^\s*[+-]?[\d.][\d._eE+-]*(\s*/\s*[\d.][\d._eE+-]*)?\s*$"
    plain = dict(sorted((within | {"type": "number"}).items()))
    return {"anyOf": [plain, {"pattern": pattern, "type": "string"}], "format": needed}


def words(needed, units, limits, pattern):
    """Describe a quantity, or certain words in its place."""
    choices = [{"pattern": pattern}, quantity(needed, units, limits)]
    return {"anyOf": choices, "format": needed, "type": "string"}


def levels(needed, units, limits):
    """Describe ``{values: [40, 50], units: degC}``, or a list of pure numbers."""
    if units is not None:  # in another unit only 0 is the same
        limits = {"above": 0.0} if limits.get("above") == 0.0 else {}
    one = number("number, or a fraction such as 600/7", None, limits)
    values = {"items": one, "minItems": 1, "type": "array"}
    if units is None:
        return {"examples": [[0, 0.1]], "format": needed} | values
    unit = {"examples": [units], "not": {"enum": _of_other_dimension(units)}, "type": "string"}
    return {
        "additionalProperties": False,
        "format": needed,
        "properties": {"values": values, "units": unit},
        "required": ["values", "units"],
        "type": "object",
    }


def records(needed):
    """Describe a list of shipped lubricant records, by name, and of others, by path."""
    path = {"pattern": r"\.ya?ml$", "type": "string"}
    one = {"anyOf": [{"enum": list(shipped_records())}, path]}
    return {"format": needed, "items": one, "minItems": 1, "type": "array"}


_FORMS = {"quantity": quantity, "number": number, "words": words, "levels": levels}
_FORMS |= {"records": records}
_GIVEN = ("units", "limits", "pattern")


def with_form(schema):
    """Put the schema of its form in place of the form's name and what it is made of."""
    if "form" not in schema:
        return schema
    given = {name: schema[name] for name in _GIVEN if name in schema}
    others = {name: schema[name] for name in schema.keys() - {"form", *_GIVEN}}
    form = _FORMS[schema["form"]](schema["format"], **given)
    return dict(sorted((others | form).items()))
