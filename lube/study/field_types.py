"""Field types shared by studies and lubricant records, and how their errors are told.

Both are YAML files turned into frozen pydantic models. Here is what the two have in
common: a strict base model, fields that hold SI numbers but are written with units, a YAML
reader that refuses repeated keys, and the one line that reports a refused value.
"""

import math
from contextlib import contextmanager
from itertools import pairwise
from typing import Annotated

import yaml
from pydantic import (
    BaseModel,
    BeforeValidator,
    ConfigDict,
    StringConstraints,
    ValidationError,
    WithJsonSchema,
)

from lube.errors import LONGEST_VALUE, LubeError, shown
from lube.study.texts import read_text
from lube.units import convert, parse_number, parse_quantity

MOST_LEVELS = 1000
"""Levels of an operating variable, at most."""

LEAST_MAGNITUDE, MOST_MAGNITUDE = 1e-30, 1e30
"""Between these lies, in SI, all that a study is made of, and what follows from it is finite."""


class StrictModel(BaseModel):
    """Frozen model that refuses unknown keys."""

    model_config = ConfigDict(extra="forbid", frozen=True)


def _as_value_error(parse):
    """Let pydantic collect a LubeError as one of its own."""

    def validate(value):
        try:
            return parse(value)
        except LubeError as error:
            raise ValueError(str(error)) from None

    return validate


def bounded(
    number,
    units,
    above=-math.inf,
    below=math.inf,
    least=-math.inf,
    most=math.inf,
    other_than=math.nan,
):
    """Return the number if it lies within its limits, else raise LubeError.

    Parameters
    ----------
    number : float
        The value.
    units : str or None
        Its unit, for the message; None for a pure number.
    above, below : float, optional
        Limits that it may not touch.
    least, most : float, optional
        Limits that it may touch.
    other_than : float, optional
        What it may not be.

    Returns
    -------
    float
        `number`.

    Raises
    ------
    LubeError
        If it lies outside.
    """
    if not (above < number < below and least <= number <= most and number != other_than):
        limits = {"above": above, "below": below, "least": least, "most": most}
        needed = _in_words(limits | {"other_than": other_than})
        unit = f" {units}" if units else ""
        raise LubeError(f"got {number:g}, need a value {needed}{unit}")
    return number


def _sensible(number, units):
    """Refuse what no machine part has, and whose powers overflow."""
    if number != 0.0 and not LEAST_MAGNITUDE <= abs(number) <= MOST_MAGNITUDE:
        unit = f" {units}" if units else ""
        raise LubeError(
            f"got {number:g}{unit}, need a magnitude from {LEAST_MAGNITUDE:g} to {MOST_MAGNITUDE:g}"
        )
    return number


def sensible_quantity(value, units, **limits):
    """Read a number written with its unit, of a size that machine parts have.

    Parameters
    ----------
    value : str
        A number and its unit.
    units : str
        Unit of the returned number.
    **limits
        As in `bounded`, in `units`.

    Returns
    -------
    float
        The value in `units`.

    Raises
    ------
    LubeError
        If it is no such quantity, or outside its limits.
    """
    return _sensible(bounded(parse_quantity(value, units), units, **limits), units)


_WORDS = {"least": "at least", "most": "at most", "other_than": "other than"}


def _in_words(limits):
    """``{"above": 0.0, "most": 0.5}`` -> ``above 0 and at most 0.5``."""
    return " and ".join(
        f"{_WORDS.get(name, name)} {value:g}"
        for name, value in limits.items()
        if math.isfinite(value)
    )


def _described(kind, limits):
    """Kind of a field and its limits, for the JSON schema and the README's table."""
    return f"{kind}, {_in_words(limits)}" if limits else kind


def quantity(units, **limits):
    """Field type for a number written with its unit and kept in `units`.

    Parameters
    ----------
    units : str
        Unit of the kept number.
    **limits
        As in `bounded`, in `units`.

    Returns
    -------
    type
        An annotated float.
    """

    def parse(value):
        return sensible_quantity(value, units, **limits)

    schema = {"type": "string", "format": _described(f"quantity in {units}", limits)}
    return Annotated[float, BeforeValidator(_as_value_error(parse)), WithJsonSchema(schema)]


def pure_number(**limits):
    """Field type for a number without dimension; fractions such as ``600/7`` are exact.

    Parameters
    ----------
    **limits
        As in `bounded`.

    Returns
    -------
    type
        An annotated float.
    """

    def parse(value):
        return _sensible(bounded(parse_number(value), None, **limits), None)

    schema = {"type": "number", "format": _described("number", limits)}
    return Annotated[float, BeforeValidator(_as_value_error(parse)), WithJsonSchema(schema)]


def checked_text(check, kind):
    """Field type for a text that stays as it is written, once a function has accepted it.

    Parameters
    ----------
    check : callable
        Takes the text; raises LubeError.
    kind : str
        What it is, for the JSON schema and the README's table.

    Returns
    -------
    type
        An annotated str.
    """

    def parse(value):
        check(value)
        return value

    schema = {"type": "string", "format": kind}
    return Annotated[str, BeforeValidator(_as_value_error(parse)), WithJsonSchema(schema)]


def levels(units, **limits):
    """Field type for the levels of an operating variable.

    With a unit they are written ``{values: [40, 50], units: degC}``, without as a list.

    Parameters
    ----------
    units : str or None
        Unit of the kept numbers, None for pure numbers.
    **limits
        As in `bounded`, in `units`.

    Returns
    -------
    type
        An annotated tuple of floats: not empty, rising, each level once.
    """

    def parse(value):
        numbers = [parse_number(one) for one in _level_list(value, units)]
        if units is not None:
            numbers = [float(convert(number, value["units"], units)) for number in numbers]
        for number in numbers:
            _sensible(bounded(number, units, **limits), units)
        for lower, upper in pairwise(numbers):
            if upper <= lower:
                raise LubeError(f"got {upper:g} after {lower:g}, need rising levels, each once")
        return tuple(numbers)

    shape = "list of numbers" if units is None else f"values and units in {units}"
    schema = {"type": "object", "format": _described(shape, limits)}
    return Annotated[
        tuple[float, ...], BeforeValidator(_as_value_error(parse)), WithJsonSchema(schema)
    ]


def _level_list(value, units):
    if units is None:
        numbers, needed = value, "a list such as [0, 0.1]"
    else:
        needed = f"values and their unit, such as {{values: [1, 2], units: {units}}}"
        if not isinstance(value, dict) or set(value) != {"values", "units"}:
            raise LubeError(f"got {shown(value)}, need {needed}")
        if not isinstance(value["units"], str):
            raise LubeError(f"got units {shown(value['units'])}, need {needed}")
        numbers = value["values"]
    if not isinstance(numbers, list) or not numbers:
        raise LubeError(f"got {shown(value)}, need {needed}")
    if len(numbers) > MOST_LEVELS:
        raise LubeError(f"got {len(numbers)} levels, need {MOST_LEVELS} at most")
    return numbers


@contextmanager
def collected(key):
    """Turn a LubeError about a key into an error that pydantic collects.

    Parameters
    ----------
    key : str
        The key of the model that the error is about.
    """
    try:
        yield
    except LubeError as error:
        raise ValueError(f"{key}: {error}") from None


Slug = Annotated[str, StringConstraints(pattern=r"^[a-z0-9][a-z0-9_-]{0,62}$")]
"""Name fit for a folder and a label: small letters, digits, hyphens."""

Length = quantity("m", above=0.0)
Pressure = quantity("Pa", above=0.0)
Resistivity = quantity("ohm*m", above=0.0)


class _PlainLoader(yaml.SafeLoader):
    """Safe YAML, without its habit of letting the last of two equal keys win, and without `<<`."""

    def construct_mapping(self, node, deep=False):
        seen = set()
        for key_node, _ in node.value:
            line = f"line {key_node.start_mark.line + 1}"
            if key_node.tag == "tag:yaml.org,2002:merge":
                # Merges of merges grow without end, and hide what a section holds.
                raise LubeError(f"{line}: got '<<', need the keys written out")
            if not isinstance(key_node, yaml.ScalarNode):
                raise LubeError(f"{line}: a key must be a word")
            key = self.construct_object(key_node, deep=True)
            if key in seen:
                raise LubeError(f"{line}: key {shown(key)} is repeated")
            seen.add(key)
        return super().construct_mapping(node, deep)

    def construct_object(self, node, deep=False):
        try:
            return super().construct_object(node, deep)
        except (ValueError, LookupError, TypeError, AttributeError, ArithmeticError):
            if not isinstance(node, yaml.ScalarNode):
                raise
        raise LubeError(
            f"line {node.start_mark.line + 1}: got {shown(node.value)}, not valid as the day, "
            "number or other value that it looks like"
        )


_YAML_KINDS = {dict: "a mapping of keys to values", list: "a list of mappings"}


def read_yaml(path, error_type, kind=dict):
    """Read a YAML file that must hold one mapping, or one list.

    Parameters
    ----------
    path : str or Path
        File to read.
    error_type : type
        The child of LubeError to raise.
    kind : type, optional
        ``dict`` or ``list``.

    Returns
    -------
    dict or list
        The content, values as YAML gives them.

    Raises
    ------
    LubeError
        Of `error_type`, if the file cannot be read, is not YAML, repeats a key or holds
        anything else.
    """
    text = read_text(path, error_type)
    try:
        content = yaml.load(text, Loader=_PlainLoader)
    except LubeError as error:
        raise error_type(f"{path}: {error}") from None
    except Exception as error:  # the YAML library raises many kinds, all meaning one thing
        mark = getattr(error, "problem_mark", None)
        line = f" at line {mark.line + 1}" if mark else ""
        reason = getattr(error, "problem", None) or "a value is none of its kind"
        raise error_type(f"{path}: not valid YAML{line}: {reason}") from None
    if not isinstance(content, kind):
        raise error_type(f"{path}: need {_YAML_KINDS[kind]}, got {type(content).__name__}")
    return content


def validate(model, content, where, error_type):
    """Build a model from a mapping, telling the first mistake in one line.

    Parameters
    ----------
    model : type
        A `StrictModel`.
    content : dict
        Its raw values.
    where : str or Path
        File the values came from, for the message.
    error_type : type
        The child of LubeError to raise.

    Returns
    -------
    StrictModel
        The checked, frozen model.

    Raises
    ------
    LubeError
        Of `error_type`: which key, what came, what is needed.
    """
    try:
        return model.model_validate(content)
    except ValidationError as error:
        mistakes = error.errors(include_url=False)
        more = f" (and {len(mistakes) - 1} more)" if len(mistakes) > 1 else ""
        raise error_type(f"{where}: {_tell(mistakes[0])}{more}") from None


# What pydantic's own kinds of mistake mean to someone who writes YAML.
_NEEDED = {
    "model_type": "need keys with their values",
    "tuple_type": "need a list such as [a, b]",
    "too_short": "need at least {min_length}",
    "too_long": "need at most {max_length}",
    "int_type": "need a whole number",
    "string_type": "need text",
    "string_unicode": "need text",
    "string_too_short": "need some text",
    "string_pattern_mismatch": "need lower-case letters, digits, '-' or '_', 63 at most",
    "greater_than_equal": "need at least {ge}",
    "less_than_equal": "need at most {le}",
}


def _tell(mistake):
    """Say in one line which key is mistaken, what came and what is needed."""
    key = ".".join(" ".join(str(part).split())[:LONGEST_VALUE] for part in mistake["loc"]) or "file"
    came = shown(mistake.get("input"))
    match mistake["type"]:
        case "extra_forbidden" | "invalid_key":
            return f"{key}: unknown key"
        case "missing":
            return f"{key}: missing, and it has no default"
        case "value_error":
            return f"{key}: {mistake['ctx']['error']}".replace("file: ", "")
        case kind if kind in _NEEDED:
            return f"{key}: got {came}, {_NEEDED[kind].format(**mistake.get('ctx', {}))}"
        case _:
            needed = mistake["msg"].replace("Input should be", "need")
            needed = needed if needed.startswith("need") else f"need another: {needed}"
            return f"{key}: got {came}, {needed}"
