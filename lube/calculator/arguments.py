"""Check the arguments of the calculator: numbers with units, names and counts."""

import functools
import inspect
from collections.abc import Callable, Iterable, Mapping
from numbers import Integral, Real
from typing import TypeVar

import numpy as np
import xarray as xr

from lube.errors import LubeError, StudyError, located, right_one, shown
from lube.study.field_types import bounded, each_once
from lube.study.rig_settings import RIG_REALISATIONS
from lube.threads import progress_bars
from lube.types import Amount
from lube.units import convert, parse_number, parse_quantity

Point = Mapping[str, xr.DataArray]
"""Force, speed and temperature by name."""
_TAKEN_BY = {
    "bands": "only contact_probability, duty, plan and the required_ functions take it",
    "contact_model": "only contact_probability, duty, trace, plan and the required_ functions do",
    "load_sharing": "the oil carries the whole load here",
    "slide_to_roll_ratio": "duty takes both surface speeds, required_film and profile no slip",
}
"""Choices that some functions lack, and which have them."""
_Function = TypeVar("_Function", bound=Callable)


def checked(function: _Function) -> _Function:
    """Make a function refuse unknown arguments, and `rollers` and `oil` of other types.

    If it takes long, it shows its progress.
    """
    # Annotations are texts, so that `help` shows short names of types.
    signature = inspect.signature(function, eval_str=True)
    owner = function.__qualname__.split(".")[0]
    parameters = signature.parameters

    @functools.wraps(function)
    def call(*args, **kwargs):
        if unknown := [name for name in kwargs if name not in parameters]:
            meant = _meant(unknown[0], parameters)
            raise StudyError(f"{owner}: {unknown[0]}: unknown argument, {meant}")
        try:
            given = signature.bind(*args, **kwargs).arguments
        except TypeError as error:
            raise StudyError(f"{owner}: {error}") from None
        for name in ("rollers", "oil"):
            if name in given and not isinstance(given[name], kind := parameters[name].annotation):
                needed = f"need lube.{kind.__name__}(...)"
                raise StudyError(f"{name}: got {shown(given[name])}, {needed}")
        with progress_bars():
            return function(*args, **kwargs)

    return call


def _meant(name, parameters):
    """Name the arguments that were probably meant: those that contain the name, or the nearest."""
    if name in _TAKEN_BY:
        return _TAKEN_BY[name]
    names = [each for each in parameters if each != "self"]
    longer = [each for each in names if name in each]
    return f"did you mean {' or '.join(longer)}?" if longer else right_one(name, names)


def in_words(value: object) -> object:
    """Write a quantity as text, as the models of a study read it; also those in a dict.

    Examples
    --------
    >>> in_words({"radius": (50, "mm"), "poisson_ratio": 0.3})
    {'radius': '50.0 mm', 'poisson_ratio': 0.3}
    """
    match value:
        case Mapping():
            return {name: in_words(each) for name, each in value.items()}
        case (Real() as number, str(unit)):
            return f"{float(number)!r} {unit}"
        case _ if hasattr(value, "magnitude"):
            return f"{float(value.magnitude)!r} {value.units}"
    return value


def amount(
    name: str, value: Amount, units: str, *, may_repeat: bool = False, **limits: float
) -> xr.DataArray:
    """Convert an argument to numbers in the units that the study computes in.

    Parameters
    ----------
    name : str
        Name of the argument, for messages, and of the dimension of several numbers.
    value : str, sequence of str, tuple or pint.Quantity
        One number with its unit, such as ``"800 N"``; or several, as ``["400 N", "800 N"]`` or
        ``([400, 800], "N")``.
    units : str
        Unit of the result.
    may_repeat : bool, optional
        Whether several numbers may be the same.
    **limits : float
        As in `lube.study.field_types.bounded`, in `units`.

    Returns
    -------
    xarray.DataArray
        Without dimensions, or over `name`.

    Raises
    ------
    StudyError
        Which argument, what came, what is needed.

    Examples
    --------
    >>> amount("force", ([0.4, 0.8], "kN"), "N").values
    array([400., 800.])
    """
    with located(name, StudyError):
        numbers = np.asarray(_numbers(value, units), float)
        came = value if isinstance(value, str) else None
        for number in numbers.ravel():
            bounded(number, None if units == "1" else units, came, **limits)
        if numbers.ndim > 1 or not numbers.size:
            came, needed = value, "one number with its unit"
            if units == "1":
                came, needed = value[0], "one number"
            raise LubeError(f"got {shown(came)}, need {needed}, or a list of them")
    if not may_repeat:
        unit = "" if units == "1" else f" {units}"
        no_repetition(name, [f"{number:.15g}{unit}" for number in numbers.ravel()])
    return xr.DataArray(numbers, {name: numbers} if numbers.ndim else None, [name] * numbers.ndim)


def _numbers(value, units):
    match value.tolist() if isinstance(value, np.ndarray) else value:
        case (numbers, str(given)) if not isinstance(numbers, str):
            return convert(_floats(numbers), given, units)
        case [str(), *_] as texts:
            return [parse_quantity(text, units) for text in texts]
        case [first, *_] as quantities if hasattr(first, "magnitude"):
            return _floats([_numbers(one, units) for one in quantities])
        case _ if hasattr(value, "magnitude"):
            return convert(_floats(value.magnitude), f"{value.units}", units)
    return parse_quantity(value, units)


def _floats(numbers):
    try:
        return np.asarray(numbers, float)
    except (TypeError, ValueError):
        each = numbers if np.iterable(numbers) else [numbers]
        commas = any("," in one for one in each if isinstance(one, str))
        points = ", with decimal points" if commas else ""
        raise LubeError(f"got {shown(numbers)}, need numbers and their unit{points}") from None


def bare_number(name: str, value: object, **limits: float) -> float:
    """Check a number that needs no unit but may be in %; `limits` as for `amount`.

    Raises
    ------
    StudyError
        Which argument, what came, what is needed.
    """
    with located(name, StudyError):
        if np.ndim(value):
            raise LubeError(f"got {shown(value)}, need one number")
        in_percent = isinstance(value, str) and value.endswith("%")
        number = parse_quantity(value, "1") if in_percent else parse_number(value)
        return bounded(number, None, **limits)


def conditions(force: Amount, speed: Amount, temperature: Amount, radius: float) -> Point:
    """Force in N, speed in rpm and temperature in degC; the radius as for `rotation_speed`."""
    return {
        "force": amount("force", force, "N", above=0.0),
        "speed": rotation_speed(speed, radius),
        "temperature": amount("temperature", temperature, "degC", above=-273.15),
    }


def rotation_speed(speed: Amount, radius: float) -> xr.DataArray:
    """Rotation speed in rpm, from a rotation speed or an entrainment speed; the radius in m.

    Raises
    ------
    StudyError
        If the unit is that of neither, or the speed is not above 0.
    """
    units = [unit for unit in ("m/s", "rpm") if _is_in(speed, unit)]
    if not units:
        needed = "need rotation speeds, such as '100 rpm', or entrainment speeds, such as '0.5 m/s'"
        raise StudyError(f"speed: got {shown(speed)}, {needed}")
    found = amount("speed", speed, units[0], above=0.0)
    if units == ["rpm"]:
        return found
    rotation = found * (60.0 / (2.0 * np.pi * radius))
    return rotation.assign_coords(speed=rotation) if rotation.dims else rotation


def _is_in(value, unit):
    """Whether a value converts to a unit."""
    try:
        _numbers(value, unit)
    except LubeError:
        return False
    return True


def no_repetition(name: str, values: Iterable[str]) -> None:
    """Refuse several names, or numbers with their units, if one of them is repeated.

    Raises
    ------
    StudyError
        With the first such value, and the name of the argument.
    """
    try:
        each_once(tuple(values))
    except ValueError as error:
        raise StudyError(f"{name}: {error}") from None


def single(values: xr.DataArray) -> float:
    """Return the value of an argument that must be a single number.

    Raises
    ------
    StudyError
        If there are several numbers, with the name of the argument.
    """
    for name, size in values.sizes.items():
        several = size > 1
        came, needed = (f"{size} values", "one") if several else ("a list of one value", "no list")
        raise StudyError(f"{name}: got {came}, need {needed}")
    return values.item()


def one_name(argument: str, name: str) -> str:
    """Return a name that an argument must have one of; refuse several.

    Raises
    ------
    StudyError
        If there are several, with the name of the argument.
    """
    if not isinstance(name, str):
        raise StudyError(f"{argument}: got {shown(name)}, need one name")
    return name


def check_realisations(realisations: int, seed: int) -> int:
    """Return the number of realisations, if it and the seed are suitable whole numbers.

    Raises
    ------
    StudyError
        If one of them is not.
    """
    for name, number, least in (("realisations", realisations, 1), ("seed", seed, 0)):
        if isinstance(number, bool) or not isinstance(number, Integral) or number < least:
            raise StudyError(f"{name}: got {shown(number)}, need a whole number, at least {least}")
    if realisations > RIG_REALISATIONS:
        raise StudyError(f"realisations: got {realisations}, need at most {RIG_REALISATIONS}")
    return int(realisations)
