"""Check the arguments of the calculator: numbers with units, choices and counts."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from typing import TypedDict, get_args

import numpy as np
import xarray as xr

from lube.errors import LubeError, StudyError, located, right_one, shown
from lube.grid.gap import PLAIN, Gap
from lube.study.field_types import bounded
from lube.study.rig_settings import RIG_REALISATIONS
from lube.study.study import Study
from lube.types import (
    Amount,
    ContactModel,
    FilmShape,
    InletHeating,
    LoadSharing,
    OneAmount,
    RoughnessDeformation,
)
from lube.units import convert, parse_number, parse_quantity

FORMULA = "pan-hamrock"
"""Film formula if none is named: the source of the paper's Eq. 3, without its misprint."""


class Model(TypedDict):
    """Arguments that choose the model of an answer."""

    film_formula: str
    film_shape: FilmShape
    roughness_deformation: RoughnessDeformation
    contact_model: ContactModel
    inlet_shear_heating: InletHeating


COMPLETE: Model = {
    "film_formula": "computed",
    "film_shape": "computed",
    "inlet_shear_heating": "computed",
    "roughness_deformation": "computed",
    "contact_model": "surface",
}
"""The most complete model of this package: film, its shape and its response to the roughness by
Reynolds' equation, heating at the inlet, and contact of the rollers' surfaces over their length.
The contact is fully flooded unless ``inlet_meniscus`` is given, and the oil carries the whole load
unless ``load_sharing`` says otherwise."""
REALISATIONS = 64
SEED = 1
Point = Mapping[str, xr.DataArray]
"""Force, speed and temperature by name."""


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
    with located(name, StudyError):
        numbers = np.asarray(_numbers(value, units), float)
        came = value if isinstance(value, str) else None
        for number in numbers.ravel():
            bounded(number, None if units == "1" else units, came, **limits)
        if numbers.ndim > 1 or not numbers.size:
            raise LubeError(f"got {shown(value)}, need one number with its unit, or a list of them")
    return xr.DataArray(numbers, {name: numbers} if numbers.ndim else None, [name] * numbers.ndim)


def _numbers(value, units):
    match value.tolist() if isinstance(value, np.ndarray) else value:
        case (numbers, str(given)) if not isinstance(numbers, str):
            return convert(_floats(numbers), given, units)
        case [str(), *_] as texts:
            return [parse_quantity(text, units) for text in texts]
        case _ if hasattr(value, "magnitude"):
            return convert(_floats(value.magnitude), f"{value.units}", units)
    return parse_quantity(value, units)


def _floats(numbers):
    try:
        return np.asarray(numbers, float)
    except (TypeError, ValueError):
        raise LubeError(f"got {shown(numbers)}, need numbers and their unit") from None


def bare_number(name: str, value: object, **limits: float) -> float:
    """Check a number that is given without unit, such as a share of time; `limits` as for `amount`.

    Raises
    ------
    StudyError
        Which argument, what came, what is needed.
    """
    with located(name, StudyError):
        return bounded(parse_number(value), None, **limits)


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
        If the unit is that of neither.
    """
    try:
        return amount("speed", speed, "rpm", above=0.0)
    except LubeError as error:
        try:
            entrainment = amount("speed", speed, "m/s", above=0.0)
        except LubeError:
            raise StudyError(f"{error}, or 'm/s'") from None
        rotation = entrainment * (60.0 / (2.0 * np.pi * radius))
        return rotation.assign_coords(speed=rotation) if rotation.dims else rotation


def single(values: xr.DataArray) -> float:
    """Return the value of an argument that must be a single number.

    Raises
    ------
    StudyError
        If there are several numbers, with the name of the argument.
    """
    for name, size in values.sizes.items():
        raise StudyError(f"{name}: got {size} values, need one")
    return values.item()


@dataclass(frozen=True)
class Choices:
    """What film and contact are made of, apart from the film formula.

    Attributes
    ----------
    gap : Gap
        How film and roughness make up the gap.
    models : tuple of str
        Contact models.
    load_sharing : str
        ``none``, or ``iterated``: the asperities carry a share of the load.
    inlet_shear_heating : str
        How heating at the inlet thins the film, as in a study.
    inlet_meniscus : float, optional
        Distance of the oil's meniscus before the line of centres, m; None if the contact is fully
        flooded.
    """

    gap: Gap = PLAIN
    models: tuple[ContactModel, ...] = ("line",)
    load_sharing: LoadSharing = "none"
    inlet_shear_heating: InletHeating = "none"
    inlet_meniscus: float | None = None

    @classmethod
    def of(
        cls,
        film_shape: FilmShape = "flat",
        roughness_deformation: RoughnessDeformation = "none",
        contact_model: ContactModel | Sequence[ContactModel] = "line",
        inlet_shear_heating: InletHeating = "none",
        inlet_meniscus: OneAmount | None = None,
        load_sharing: LoadSharing = "none",
    ) -> "Choices":
        """Choose by the values of a study's keys.

        Raises
        ------
        StudyError
            If a study has no such choice.
        """
        gap = {"film_shape": film_shape, "roughness_deformation": roughness_deformation}
        film = {"load_sharing": load_sharing, "inlet_shear_heating": inlet_shear_heating}
        for name, value in (gap | film).items():
            _check_choice(name, value, get_args(Study.model_fields[name].annotation))
        models = tuple(np.ravel(contact_model).tolist())
        for model in models or [contact_model]:
            _check_choice("contact_model", model, get_args(ContactModel))
        if inlet_meniscus is not None:
            inlet_meniscus = single(amount("inlet_meniscus", inlet_meniscus, "m", above=0.0))
        return cls(Gap(**gap), models, **film, inlet_meniscus=inlet_meniscus)

    @classmethod
    def of_smooth_rollers(
        cls, inlet_shear_heating: InletHeating, inlet_meniscus: OneAmount | None
    ) -> "Choices":
        """As `of`, of a film without contact, which no lines or surfaces can refuse."""
        choices = cls.of(inlet_shear_heating=inlet_shear_heating, inlet_meniscus=inlet_meniscus)
        return replace(choices, models=())


def _check_choice(name, value, options):
    if value not in options:
        raise StudyError(f"{name}: got {shown(value)}, {right_one(value, options)}")


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
        if isinstance(number, bool) or not isinstance(number, int) or number < least:
            raise StudyError(f"{name}: got {shown(number)}, need a whole number, at least {least}")
    if realisations > RIG_REALISATIONS:
        raise StudyError(f"realisations: got {realisations}, need at most {RIG_REALISATIONS}")
    return realisations
