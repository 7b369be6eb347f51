"""Numbers with units as they are given in Python, and results in the units people use."""

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr

from lube.calculator.answers import Answer
from lube.errors import LubeError, StudyError, shown
from lube.schema import COORDINATES, FILES, REGIMES
from lube.study.field_types import bounded
from lube.units import convert, parse_number, parse_quantity

Amount = str | Sequence[str] | tuple[Any, str] | Any
"""``"800 N"``, ``["400 N", "800 N"]``, ``([400, 800], "N")``, or a quantity of pint."""

_CUSTOMARY = {
    "m": ("um", 1e6),
    "Pa": ("MPa", 1e-6),
    "Pa s": ("mPa s", 1e3),
    "m2 s-1": ("mm2 s-1", 1e6),
    "Pa-1": ("GPa-1", 1e9),
    "s": ("ms", 1e3),
    "s-1": ("h-1", 3600.0),
    **dict.fromkeys(("radius", "second_radius", "reduced_radius"), ("mm", 1e3)),
    "reduced_modulus": ("GPa", 1e-9),
}
"""Customary unit, and its number in one SI unit, of all in that unit or of a variable."""
_TAIL, _WHOLE = "by importance sampling", "of the whole duty cycle"
_OWN = {
    "radius": ("radius of the first roller", "m"),
    "second_radius": ("radius of the second roller", "m"),
    "surface_speed": ("surface speed of the first roller", "m s-1"),
    "second_surface_speed": ("surface speed of the second roller", "m s-1"),
    "share": ("share of the duty cycle", "1"),
    "roughness_factor": ("factor of the roughness of both rollers", "1"),
    "position": ("position from the line of centres", "m"),
    "whole_probability": (f"breakthrough probability {_WHOLE}", "1"),
    "whole_tail_probability": (f"breakthrough probability {_WHOLE}, {_TAIL}", "1"),
    "whole_tail_rate": (f"breakthroughs per time {_WHOLE}, {_TAIL}", "s-1"),
}
"""Variables of no file: what each is, and its SI unit."""
_KINDS = ("film_profile", "lubricant", "trace", "film", "contact")
_ROWS = (COORDINATES, *(FILES[kind] for kind in _KINDS))
_WORDS = {name: (row.long_name, row.units) for rows in _ROWS for name, row in rows.items()}
_WORDS |= _OWN
# Those of `tail.nc` get a prefix: some of `contact.nc` have the same names.
_WORDS |= {
    f"tail_{name}": (f"{row.long_name}, {_TAIL}", row.units) for name, row in FILES["tail"].items()
}


def amount(name: str, value: Amount, units: str, **limits: float) -> xr.DataArray:
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
    try:
        numbers = np.asarray(_numbers(value, units), float)
        for number in numbers.ravel():
            bounded(number, None if units == "1" else units, **limits)
        if numbers.ndim > 1 or not numbers.size:
            raise LubeError(f"got {shown(value)}, need one number with its unit, or a list of them")
    except LubeError as error:
        raise StudyError(f"{name}: {error}") from None
    return xr.DataArray(numbers, {name: numbers} if numbers.ndim else None, [name] * numbers.ndim)


def bare_number(name: str, value: object, units: str | None = None, **limits: float) -> float:
    """Check a number that is given without unit, such as a share; `limits` as of `amount`.

    Raises
    ------
    StudyError
        Which argument, what came, what is needed.
    """
    try:
        return bounded(parse_number(value), units, **limits)
    except LubeError as error:
        raise StudyError(f"{name}: {error}") from None


def _numbers(value, units):
    match value.tolist() if isinstance(value, np.ndarray) else value:
        case (str(), *_) | [str(), *_] if not _has_unit_last(value):
            return [parse_quantity(one, units) for one in value]
        case (numbers, str(given)):
            return convert(_floats(numbers), given, units)
        case _ if hasattr(value, "magnitude"):
            return convert(_floats(value.magnitude), f"{value.units}", units)
    return parse_quantity(value, units)


def _floats(numbers):
    try:
        return np.asarray(numbers, float)
    except (TypeError, ValueError):
        raise LubeError(f"got {shown(numbers)}, need numbers and their unit") from None


def _has_unit_last(value):
    """Whether a pair is numbers and their unit, rather than two numbers with units."""
    return len(value) == 2 and not isinstance(value[0], str)


def described(results: xr.Dataset) -> Answer:
    """Convert results to customary units, and label them.

    Parameters
    ----------
    results : xarray.Dataset
        Variables of the ``lubricant``, ``film``, ``contact`` or ``trace`` file, in SI units.

    Returns
    -------
    Answer
        Films and lengths in um, pressures in MPa; each variable with ``units`` and
        ``long_name``, the regime in words.

    Examples
    --------
    >>> described(xr.Dataset({"film_thickness": 1.07e-6})).film_thickness.attrs["units"]
    'um'
    """
    found = Answer(results.data_vars, results.coords, results.attrs)
    for name in results.variables:
        # A limit has the words of its variable where it has none of its own.
        known = name if name in _WORDS else name.removesuffix("_lower").removesuffix("_upper")
        if known not in _WORDS:
            continue
        (long_name, si), values = _WORDS[known], results[name].values
        units, factor = _CUSTOMARY.get(known, _CUSTOMARY.get(si, (si, None)))
        if factor is not None:
            values = factor * values
        elif name == "regime":
            values = np.array(REGIMES)[values]
        labels = {"long_name": long_name, "units": units or ""}
        found[name] = xr.Variable(results[name].dims, values, labels)
    return found
