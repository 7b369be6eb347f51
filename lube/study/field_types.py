"""Field types shared by studies, lubricant records and manifests, and their error messages.

All three kinds of file become frozen pydantic models. Here are their strict base class, the types
of fields that are written with a unit and kept in SI, and the one-line message on a refused value.
"""

import ast
import inspect
import operator
import re
import textwrap
from collections import Counter
from collections.abc import Callable, Iterable
from itertools import pairwise
from typing import Annotated, Any, TypeVar, get_args

from pydantic import BaseModel, BeforeValidator, StringConstraints, ValidationError, WithJsonSchema

from lube.errors import LubeError, located, right_one, shown
from lube.types import File
from lube.units import parse_number, parse_quantity


class StrictModel(BaseModel, extra="forbid", frozen=True):
    """Frozen model that refuses unknown keys; the text under a field describes it."""

    @classmethod
    def __get_pydantic_json_schema__(cls, core_schema, handler):
        """Describe the fields: pydantic would read their texts at every start, which is slow."""
        schema = handler(core_schema)
        found, texts = handler.resolve_ref_schema(schema), _texts(cls)
        for name, field in cls.model_fields.items():
            if name in texts:
                found["properties"][field.alias or name]["description"] = texts[name]
        return schema

    def given_keys(self, keys: Iterable[str]) -> list[str]:
        """Return the keys, among some of the model, that have a value."""
        return [key for key in keys if getattr(self, key) is not None]


def _texts(model):
    """Text under each field in the source of a model and of those that it is based on."""
    found = {}
    for base in reversed(model.__mro__):
        if issubclass(base, StrictModel) and not base.__pydantic_generic_metadata__["origin"]:
            (source,) = ast.parse(textwrap.dedent(inspect.getsource(base))).body
            for field, text in pairwise(source.body):
                if isinstance(field, ast.AnnAssign) and isinstance(text, ast.Expr):
                    found[field.target.id] = inspect.cleandoc(text.value.value)
    return found


_LIMITS = {
    "above": (operator.gt, "above"),
    "below": (operator.lt, "below"),
    "least": (operator.ge, "at least"),
    "most": (operator.le, "at most"),
    "other_than": (operator.ne, "other than"),
}


def _in_words(limits):
    """``{"above": 0.0, "most": 0.5}`` -> ``above 0 and at most 0.5``."""
    return " and ".join(f"{_LIMITS[name][1]} {limit:g}" for name, limit in limits.items())


def bounded(number: float, units: str | None, came: object = None, **limits: float) -> float:
    """Return the number if it lies within its limits.

    Unless it is 0, its magnitude must be from 1e-30 to 1e30, so that no power of it overflows.

    Parameters
    ----------
    number : float
        The value.
    units : str or None
        Its unit, for the message; None for a pure number.
    came : object, optional
        What the user wrote, for the message; by default the number.
    **limits : float
        Any of ``above``, ``below``, ``least``, ``most`` and ``other_than``.

    Returns
    -------
    float
        `number`.

    Raises
    ------
    LubeError
        If it lies outside.

    Examples
    --------
    >>> bounded(3.0, "mm", above=0.0, most=2.0)
    Traceback (most recent call last):
    lube.errors.LubeError: got 3, need a value above 0 and at most 2 mm
    """
    within = all(_LIMITS[name][0](number, limit) for name, limit in limits.items())
    if within and (number == 0.0 or 1e-30 <= abs(number) <= 1e30):
        return number
    needed = f"value {_in_words(limits)}" if not within else "magnitude from 1e-30 to 1e+30"
    came = f"{number:g}" if came is None else came
    raise LubeError(f"got {came}, need a {needed} {units or ''}".rstrip())


def read_by(
    parse: Callable[[Any], object], schema: dict[str, Any], hint: str = ""
) -> BeforeValidator:
    """Say how to read a field whose value is converted, such as ``50 mm`` to 0.05.

    Parameters
    ----------
    parse : callable
        Function that converts the written value to the kept one; raises LubeError.
    schema : dict
        How it is written, for the JSON schema. ``format`` says in words what is needed; from
        ``form`` and the other keys, ``docs/tools/written_forms.py`` makes the schema for
        editors.
    hint : str, optional
        Text to add to an error message.

    Returns
    -------
    pydantic.BeforeValidator
        Metadata of an annotated type.
    """
    checked = located(kind=ValueError, hint=hint)(parse)
    return BeforeValidator(checked, json_schema_input_type=Annotated[Any, WithJsonSchema(schema)])


def read_number(value: object, units: str | None, **limits: float) -> float:
    """Read a number with its unit, or one without dimension.

    Parameters
    ----------
    value : object
        As written.
    units : str or None
        Unit of the returned number; None, or empty, for one without dimension.
    **limits : float
        As in `bounded`, in `units`.

    Returns
    -------
    float
        The number, within its limits.

    Raises
    ------
    LubeError
        If it is no such number.

    Examples
    --------
    >>> read_number("50 mm", "m", above=0.0)
    0.05
    """
    number = parse_quantity(value, units) if units else parse_number(value)
    return bounded(number, units, value, **limits)


def _schema(form, kind, units, limits):
    """Describe a field that is written in such a form, with ``quantity in m, above 0``."""
    needed = f"{kind}, {_in_words(limits)}" if limits else kind
    return {"form": form, "format": needed, "units": units, "limits": limits}


def quantity(units: str | None, **limits: float) -> BeforeValidator:
    """Say how to read a number written with its unit and kept in `units`.

    Parameters
    ----------
    units : str or None
        Unit of the kept number; None for a number without dimension, which may also be a fraction
        such as ``600/7``.
    **limits : float
        As in `bounded`, in `units`.

    Returns
    -------
    pydantic.BeforeValidator
        Metadata of an annotated float.
    """
    form, kind = ("quantity", f"quantity in {units}") if units else ("number", "number")
    schema = _schema(form, kind, units, limits)
    return read_by(lambda value: read_number(value, units, **limits), schema)


def checked_text(check: Callable[[str], object], kind: str) -> BeforeValidator:
    """Say how to read a text that a function accepts; it is kept as written.

    Parameters
    ----------
    check : callable
        Takes the text; raises LubeError.
    kind : str
        What it is, for the JSON schema and the table of keys.

    Returns
    -------
    pydantic.BeforeValidator
        Metadata of an annotated str.
    """

    def parse(value):
        check(value)
        return value

    return read_by(parse, {"type": "string", "format": kind})


def quantity_or_words(units: str, words: str, pattern: str) -> BeforeValidator:
    """Say how to read a quantity or, in its place, certain words, which are kept as written.

    Parameters
    ----------
    units : str
        Unit of the kept number, which is above 0.
    words : str
        What the words are, for messages and for the JSON schema.
    pattern : str
        Regular expression of the words.

    Returns
    -------
    pydantic.BeforeValidator
        Metadata of an annotated float or str.
    """
    limits = {"above": 0.0}

    def parse(value):
        is_words = isinstance(value, str) and re.search(pattern, value)
        return value if is_words else read_number(value, units, **limits)

    schema = _schema("words", f"quantity in {units}, or {words}", units, {})
    return read_by(parse, schema | {"limits": limits, "pattern": pattern}, f", or {words}")


def levels(units: str | None, **limits: float) -> BeforeValidator:
    """Say how to read the levels of an operating variable.

    With a unit they are written ``{values: [40, 50], units: degC}``, without as a list.

    Parameters
    ----------
    units : str or None
        Unit of the kept numbers, None for pure numbers.
    **limits : float
        As in `bounded`, in `units`.

    Returns
    -------
    pydantic.BeforeValidator
        Metadata of an annotated tuple of floats: not empty, rising, each level once.
    """
    pair = f"values and their unit, such as {{values: [1, 2], units: {units}}}"
    needed = pair if units else "a list such as [0, 0.1]"

    def parse(value):
        match value:
            case [_, *_] if units is None:
                typed = value
            case {"values": [_, *_] as values, "units": str(given), **rest} if units and not rest:
                typed = [f"{one} {given}" for one in values]
            case _:
                raise LubeError(f"got {shown(value)}, need {needed}")
        numbers = tuple(read_number(one, units, **limits) for one in typed)
        for (lower, before), (upper, came) in pairwise(zip(numbers, typed, strict=True)):
            if upper <= lower:
                raise LubeError(f"got {came} after {before}, need rising levels without repetition")
        return numbers

    kind = f"values and units in {units}" if units else "list of numbers"
    return read_by(parse, _schema("levels", kind, units, limits))


def each_once(values: tuple) -> tuple:
    """Accept a tuple without repetitions; a validator for pydantic.

    Parameters
    ----------
    values : tuple
        Its entries.

    Returns
    -------
    tuple
        `values`.

    Raises
    ------
    ValueError
        At the first entry that is repeated.
    """
    for value, times in Counter(values).items():
        if times > 1:
            raise ValueError(f"got {value} repeatedly, need it once")
    return values


Slug = Annotated[str, StringConstraints(pattern=r"^[a-z0-9][a-z0-9_-]{0,62}$")]
"""Name of a folder and label in files: lower-case letters, digits, ``-`` and ``_``."""

Text = Annotated[str, StringConstraints(strip_whitespace=True, min_length=1)]
Length = Annotated[float, quantity("m", above=0.0)]


Model = TypeVar("Model", bound=StrictModel)


def validate(
    model: type[Model], content: dict, where: File, error_type: type, context: dict | None = None
) -> Model:
    """Build a model from a mapping, or report the first mistake in one line.

    Parameters
    ----------
    model : type
        A `StrictModel`.
    content : dict
        Its raw values.
    where : str or Path
        File the values came from, for the message.
    error_type : type
        The subclass of LubeError to raise.
    context : dict, optional
        For pydantic's validators.

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
        return model.model_validate(content, context=context)
    except ValidationError as error:
        # A misspelt key comes first: the missing key only follows from it.
        mistakes = sorted(error.errors(), key=lambda mistake: mistake["type"] not in _UNKNOWN)
        # A list whose entries are refused is reported as too short as well.
        entries = {one["loc"][:depth] for one in mistakes for depth in range(len(one["loc"]))}
        mistakes = [m for m in mistakes if m["type"] != "too_short" or m["loc"] not in entries]
        more = f" (and {len(mistakes) - 1} more)" if len(mistakes) > 1 else ""
        line = _as_written(_in_one_line(mistakes[0], model), content)
        raise error_type(f"{where}: {line}{more}") from None


def _as_written(line, content):
    """Quote in an error message the value as written in the file, not as converted to SI."""
    message = _KEY_AND_NUMBER.match(line)
    value = content
    for part in message[1].split(".") if message else ():
        value = value.get(part) if isinstance(value, dict) else None
    return line.replace(message[2], value, 1) if message and isinstance(value, str) else line


_UNKNOWN = ("extra_forbidden", "invalid_key")
_KEY_AND_NUMBER = re.compile(
    r"([\w.]+): got (-?[\d.]+(?:e[+-]?\d+)?(?: (?!together)[^\s,]+)?)(?![^\s,])"
)

# What pydantic's own kinds of mistake mean to someone who writes YAML.
_NEEDED = {
    "model_type": "need keys with their values",
    "tuple_type": "need a list such as [a, b]",
    "too_short": "need {min_length} or more entries",
    "int_type": "need a whole number",
    "int_parsing_size": "need a smaller number",
    "string_type": "need text",
    "string_too_short": "need some text",
    "string_pattern_mismatch": "need lower-case letters, digits, '-' or '_', 63 at most",
    "greater_than_equal": "need at least {ge}",
    "less_than_equal": "need at most {le}",
}


def _in_one_line(mistake, model):
    """Say in one line which key is mistaken, what came and what is needed."""
    key, kind = ".".join(map(str, mistake["loc"])), mistake["type"]
    if kind in _UNKNOWN:
        # For YAML {name: Somebody, Else} has two keys, the second without a value.
        hint = "; a text with a comma needs quotes" if mistake["input"] is None else ""
        if hint and key.rpartition(".")[2][:1].isdigit():  # {length: 0,2 um}
            hint = "; a number needs a decimal point, not a comma"
        return f"{key}: unknown key, {_right_key(mistake['loc'], model)}{hint}"
    if kind == "missing":
        return f"{key}: missing, and it has no default"
    if kind == "value_error":
        error = str(mistake["ctx"]["error"])
        names_key = re.match(r"[\w.]+: ", error)  # of a key inside this one
        return f"{key}{'.' if names_key and key else ': '}{error}".removeprefix(": ")
    needed = mistake["msg"].replace("Input should be", "need")
    needed = _NEEDED.get(kind, needed).format(**mistake.get("ctx", {}))
    if kind == "tuple_type" and isinstance(mistake["input"], str):
        needed = needed.replace("a, b", mistake["input"])
    return f"{key}: got {shown(mistake['input'])}, {needed}"


def _right_key(location, model):
    """Name the key that was meant, or all keys of the section."""
    *sections, wrong = location
    for part in sections:
        if isinstance(part, str):
            model = next(_models(model.model_fields[part].annotation))
    keys = [field.alias or name for name, field in model.model_fields.items()]
    return right_one(str(wrong), keys)


def _models(annotation):
    """Models that an annotation such as ``tuple[Creator, ...] | None`` holds."""
    if isinstance(annotation, type) and issubclass(annotation, BaseModel):
        yield annotation
    for inner in get_args(annotation):
        yield from _models(inner)
