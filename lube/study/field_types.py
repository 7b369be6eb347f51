"""Field types shared by studies, lubricant records and manifests, and their error messages.

All three kinds of file become frozen pydantic models. Here are their strict base class, the types
of fields that are written with a unit and kept in SI, and the one-line message on a refused value.
"""

import ast
import inspect
import operator
import re
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from itertools import pairwise
from typing import Annotated, Any, TypeVar, get_args

from pydantic import BaseModel, StringConstraints, ValidationError
from pydantic_core.core_schema import CoreSchema, no_info_before_validator_function

from lube.errors import LubeError, right_one, shown
from lube.types import File
from lube.units import convert, parse_number, parse_quantity


def _with_descriptions(schema, model):
    """Add the text under each field of a model to its JSON schema.

    Pydantic's own `use_attribute_docstrings` reads the source at every import, which is slow.
    """
    for base in model.__mro__[: model.__mro__.index(StrictModel)]:
        for field, below in pairwise(ast.parse(inspect.getsource(base)).body[0].body):
            match field, below:
                case ast.AnnAssign(), ast.Expr(ast.Constant(str(text))):
                    name = base.model_fields[field.target.id].alias or field.target.id
                    schema["properties"][name]["description"] = " ".join(text.split())


class StrictModel(BaseModel, extra="forbid", frozen=True, json_schema_extra=_with_descriptions):
    """Frozen model that refuses unknown keys; the text under a field describes it."""


@dataclass(frozen=True, eq=False)  # hashed by identity, as an annotation must be
class Written:
    """Annotation of a field that is not kept as it is written, for its JSON schema.

    A field keeps ``0.05`` where people write ``50 mm``.

    Attributes
    ----------
    schema : dict
        How it is written. ``format`` says in words what is needed; from ``form`` and the keys
        beside it, ``docs/tools/written_forms.py`` makes the schema for editors.
    """

    schema: dict[str, Any]

    def __get_pydantic_json_schema__(self, core_schema: object, handler: object) -> dict[str, Any]:
        """Answer pydantic."""
        return dict(self.schema)


@contextmanager
def collected(key: str = "", hint: str = "") -> Iterator[None]:
    """Turn a LubeError into an error that pydantic collects; also a decorator of validators.

    Parameters
    ----------
    key : str, optional
        The key of the model that the error is about.
    hint : str, optional
        Added to the message.

    Raises
    ------
    ValueError
        In place of the LubeError.
    """
    try:
        yield
    except LubeError as error:
        raise ValueError(f"{key}: {error}{hint}".removeprefix(": ")) from None


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


@dataclass(frozen=True, eq=False)
class Read(Written):
    """Tell pydantic how a field is read, too.

    Attributes
    ----------
    parse : callable
        From what people write to what is kept; raises LubeError.
    hint : str
        Added to its message.
    """

    parse: Callable[[Any], object]
    hint: str = ""

    def __get_pydantic_core_schema__(self, source: object, handler: Callable) -> CoreSchema:
        """Answer pydantic."""
        parse = collected(hint=self.hint)(self.parse)
        return no_info_before_validator_function(parse, handler(source))


def _needed(kind, limits):
    """``quantity in m, above 0``."""
    return f"{kind}, {_in_words(limits)}" if limits else kind


def _form(form, needed, units, limits):
    return {"form": form, "format": needed, "units": units, "limits": limits}


def quantity(units: str, **limits: float) -> Read:
    """Say how to read a number written with its unit and kept in `units`.

    Parameters
    ----------
    units : str
        Unit of the kept number.
    **limits : float
        As in `bounded`, in `units`.

    Returns
    -------
    Read
        Metadata of an annotated float.
    """

    def parse(value):
        return bounded(parse_quantity(value, units), units, value, **limits)

    needed = _needed(f"quantity in {units}", limits)
    return Read(_form("quantity", needed, units, limits), parse)


def pure_number(**limits: float) -> Read:
    """Say how to read a number without dimension; also a fraction such as ``600/7``.

    Parameters
    ----------
    **limits : float
        As in `bounded`.

    Returns
    -------
    Read
        Metadata of an annotated float.
    """

    def parse(value):
        return bounded(parse_number(value), None, value, **limits)

    return Read(_form("number", _needed("number", limits), None, limits), parse)


def checked_text(check: Callable[[str], object], kind: str) -> Read:
    """Say how to read a text that a function accepts; it is kept as written.

    Parameters
    ----------
    check : callable
        Takes the text; raises LubeError.
    kind : str
        What it is, for the JSON schema and the table of keys.

    Returns
    -------
    Read
        Metadata of an annotated str.
    """

    def parse(value):
        check(value)
        return value

    return Read({"type": "string", "format": kind}, parse)


def quantity_or_words(units: str, accepts: Callable[..., bool], words: str, pattern: str) -> Read:
    """Say how to read a quantity or, in its place, certain words, which are kept as written.

    Parameters
    ----------
    units : str
        Unit of the kept number, which is above 0.
    accepts : callable
        Takes the value and says whether it is such words; may raise LubeError.
    words : str
        What the words are, for messages and for the JSON schema.
    pattern : str
        Regular expression of the words, for the JSON schema.

    Returns
    -------
    Read
        Metadata of an annotated float or str.
    """

    def parse(value):
        number = None if accepts(value) else parse_quantity(value, units)
        return value if number is None else bounded(number, units, value, above=0.0)

    needed = f"quantity in {units}, or {words}"
    written = _form("words", needed, units, {"above": 0.0}) | {"pattern": pattern}
    return Read(written, parse, hint=f", or {words}")


def levels(units: str | None, **limits: float) -> Read:
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
    Read
        Metadata of an annotated tuple of floats: not empty, rising, each level once.
    """

    def parse(value):
        numbers, typed = _level_list(value, units)
        for number, came in zip(numbers, typed, strict=True):
            bounded(number, units, came, **limits)
        for (lower, before), (upper, came) in pairwise(zip(numbers, typed, strict=True)):
            if upper <= lower:
                raise LubeError(f"got {came} after {before}, need rising levels, each once")
        return numbers

    needed = _needed("list of numbers" if units is None else f"values and units in {units}", limits)
    return Read(_form("levels", needed, units, limits), parse)


def _level_list(value, target):
    """Levels in the target unit, and as they are written."""
    match value:
        case [_, *_] if target is None:
            return tuple(map(parse_number, value)), value
        case {"values": [_, *_] as values, "units": str(units), **rest} if target and not rest:
            numbers = tuple(float(convert(parse_number(one), units, target)) for one in values)
            return numbers, [f"{one} {units}" for one in values]
    needed = f"values and their unit, such as {{values: [1, 2], units: {target}}}"
    raise LubeError(f"got {shown(value)}, need {needed if target else 'a list such as [0, 0.1]'}")


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
            raise ValueError(f"{value} is repeated, need each once")
    return values


Slug = Annotated[str, StringConstraints(pattern=r"^[a-z0-9][a-z0-9_-]{0,62}$")]
"""Name of a folder and label in files: lower-case letters, digits, ``-`` and ``_``."""

Text = Annotated[str, StringConstraints(strip_whitespace=True, min_length=1)]
Length = Annotated[float, quantity("m", above=0.0)]
Pressure = Annotated[float, quantity("Pa", above=0.0)]


Model = TypeVar("Model", bound=StrictModel)


def validate(
    model: type[Model],
    content: dict,
    where: File,
    error_type: type,
    context: dict[str, Any] | None = None,
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
        # A misspelt key comes first: that the right one is missing only follows from it.
        mistakes = sorted(error.errors(), key=lambda mistake: mistake["type"] not in _UNKNOWN)
        more = f" (and {len(mistakes) - 1} more)" if len(mistakes) > 1 else ""
        line = _as_written(_in_one_line(mistakes[0], model), content)
        raise error_type(f"{where}: {line}{more}") from None


def _as_written(line, content):
    """Quote in an error message the value as it is written, not as it is understood, in SI."""
    message = re.match(
        r"([\w.]+): got (-?[\d.]+(?:e[+-]?\d+)?(?: (?!beside)[^\s,]+)?)(?![^\s,])", line
    )
    value = content
    for part in message[1].split(".") if message else ():
        value = value.get(part) if isinstance(value, dict) else None
    return line.replace(message[2], value, 1) if message and isinstance(value, str) else line


_UNKNOWN = ("extra_forbidden", "invalid_key")

# What pydantic's own kinds of mistake mean to someone who writes YAML.
_NEEDED = {
    "model_type": "need keys with their values",
    "tuple_type": "need a list such as [a, b]",
    "too_short": "need at least {min_length}",
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
