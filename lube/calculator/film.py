"""Film at operating points."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
import xarray as xr

from lube.calculator.answers import Answer, described
from lube.calculator.arguments import Point, checked, conditions
from lube.calculator.choices import FORMULA, Choices, Inlet
from lube.calculator.oil import Oil
from lube.calculator.rollers import Rollers
from lube.errors import StudyError, located
from lube.grid.films import film_with_oil
from lube.grid.plausibility import remarks
from lube.study.rollers import RollerPair
from lube.study.surface_checks import check_surfaces
from lube.surfaces.rare_contact import check_stands_for_surface
from lube.types import Amount, InletHeating, OneAmount, Values
from lube.units import with_unit

_FILM = (
    "film_thickness lambda_ratio regime in_validity_range hertz_pressure contact_half_width "
    "entrainment_speed dynamic_viscosity"
).split()
_THINNING = "inlet_shear_heating_factor", "starvation_factor"
"""Factors by which the film is thinner, where they are asked for."""


@checked
def film(
    rollers: Rollers,
    oil: Oil,
    force: Amount,
    speed: Amount,
    temperature: Amount,
    *,
    film_formula: str | Sequence[str] = FORMULA,
    inlet_shear_heating: InletHeating = "none",
    inlet_meniscus: OneAmount | None = None,
    slide_to_roll_ratio: float = 0.0,
) -> Answer:
    """Film thickness, lambda ratio and regime.

    Parameters
    ----------
    rollers : Rollers
        The two rollers.
    oil : Oil
        The oil between them.
    force : str, sequence of str or tuple
        Normal force, such as ``"800 N"``, or several: ``["400 N", "800 N"]`` or
        ``([400, 800], "N")``.
    speed : str, sequence of str or tuple
        Rotation speed of the first roller in pure rolling, such as ``"100 rpm"``, or entrainment
        speed, such as ``"0.5 m/s"``.
    temperature : str, sequence of str or tuple
        Temperature of rollers and oil, such as ``"60 degC"``.
    film_formula : str or sequence of str, optional
        Keys of `lube.FORMULAS`.
    inlet_shear_heating : str, optional
        How heating of the oil at the inlet thins the film, the more so the more the rollers slip:
        ``"none"``; ``"zhu-cheng-1988"`` or ``"wilson-sheu-1983"`` by a formula; or ``"computed"``,
        by the equation behind the latter.
    inlet_meniscus : str, optional
        Distance of the oil's meniscus before the line of centres, such as ``"1 mm"``, more than the
        half-width of the contact. Without it the contact is fully flooded.
    slide_to_roll_ratio : float, optional
        Difference of the surface speeds over their mean, on which the heating depends.

    Returns
    -------
    Answer
        The film in customary units, with ``inlet_shear_heating_factor`` and ``starvation_factor``,
        by which heating and starvation thin it, where they are asked for. Its dimensions are those
        of film_formula, temperature, speed and force that have several values. Like ``lube
        check``, its attribute ``remarks`` has a line for each value that may be a mistake or is
        beyond the limits of the model, by the first film formula.

    Raises
    ------
    LubeError
        Which argument, what came, what is needed.

    Examples
    --------
    >>> rollers = Rollers(radius="50 mm", rms_roughness="0.2 um")
    >>> found = film(rollers, Oil("mobilgear-shc-xmp-320"), "800 N", "100 rpm", "40 degC")
    >>> f"{found.film_thickness.item():.2f} um, lambda ratio {found.lambda_ratio.item():.1f}"
    '1.05 um, lambda ratio 3.7'
    """
    inlet = Inlet(inlet_shear_heating, inlet_meniscus)
    choices = Choices.of_smooth_rollers(film_formula, inlet, slide_to_roll_ratio)
    table = film_in_si(rollers, oil, force, speed, temperature, choices)
    return with_remarks(of_film(table), table, rollers)


def of_film(table: xr.Dataset) -> xr.Dataset:
    """Variables of a film table that answers have."""
    return table[[*_FILM, *(name for name in _THINNING if name in table)]]


def film_in_si(
    rollers: Rollers, oil: Oil, force: Amount, speed: Amount, temperature: Amount, choices: Choices
) -> xr.Dataset:
    """All variables of the film table in SI units, and the oil's viscosity.

    The arguments are those of `film`, `contact_probability` and `ensemble`.
    """
    point = conditions(force, speed, temperature, rollers.pair.first.radius)
    check_contact(rollers, rollers.pair.contact_half_width(point["force"].values), choices)
    table = film_of_oil(oil, rollers.pair, point, **film_model(rollers, choices))
    dims = ("film_formula", "temperature", "speed", "force")
    table = table.assign_coords(force=point["force"], speed=point["speed"])
    table = table.transpose(*dims, ..., missing_dims="ignore")
    return table if np.ndim(choices.film_formula) else table.isel(film_formula=0)


def check_contact(rollers: Rollers, half_width: Values, choices: Choices) -> None:
    """Refuse contacts that lines or surfaces do not have, before films take their time.

    Parameters
    ----------
    rollers : Rollers
        The two rollers.
    half_width : float or numpy.ndarray
        Half-widths of the contacts, m.
    choices : Choices
        With the contact models.

    Raises
    ------
    LubeError
        As from `lube.study.surface_checks.check_surfaces`; or that a contact is finer than the grid
        or wider than a roller's perimeter, or reaches the meniscus, or that no line stands for the
        rollers, or the lines for no surfaces that could share the load.
    """
    spec, widest = rollers.lines, 2.0 * np.max(half_width).item()
    meniscus = choices.inlet.meniscus
    if meniscus is not None and meniscus <= 0.5 * widest:
        needed = f"more than {with_unit(0.5 * widest, 'm', 3)}, the half-width of the contact"
        raise StudyError(f"inlet_meniscus: got {with_unit(meniscus, 'm', 3)}, need {needed}")
    if "line" in choices.models:
        for width in (2.0 * np.min(half_width).item(), widest):
            spec.check_width(width, "force: the contact")
        spec.check_follows_rolling()
    if "surface" in choices.models:
        check_surfaces(spec, rollers.pair.length, widest, choices.gap)
    elif choices.load_sharing != "none":
        with located(f"load_sharing: got {choices.load_sharing}, need none"):
            check_stands_for_surface(spec)


def film_model(rollers: Rollers, choices: Choices) -> dict[str, Any]:
    """Arguments of `film_of_oil` for some choices."""
    choices.gap.check_slip(choices.slip)
    answered = {"line": "answered_lines", "surface": "answered_surfaces"}
    used = choices.models if choices.gap.is_answered else ()
    return {
        "formulas": choices.formulas,
        "with_shape": choices.gap.has_shape,
        "slide_to_roll_ratio": choices.slip,
        "rough_surfaces": rollers.lines if choices.has_surfaces else None,
        "load_sharing": choices.load_sharing,
        "inlet_shear_heating": choices.inlet.shear_heating,
        "inlet_meniscus": choices.inlet.meniscus,
        **{answered[model]: rollers.lines for model in used},
    }


def film_of_oil(oil: Oil, pair: RollerPair, point: Point, **choices: Any) -> xr.Dataset:
    """Film table with the oil's viscosity; the point's numbers are in N, rpm and degC.

    Raises
    ------
    StudyError
        If the inlet heats up, and the oil's thermal conductivity is not known.
    """
    properties, heating = oil.at(point["temperature"]), choices["inlet_shear_heating"]
    if heating != "none" and properties["thermal_conductivity"].isnull().any():
        needed = "need none, or an oil with thermal_conductivity"
        raise StudyError(f"inlet_shear_heating: got {heating}, {needed}")
    return film_with_oil(properties, pair, point["force"], point["speed"], **choices)


def with_remarks(
    found: xr.Dataset, table: xr.Dataset, rollers: Rollers, models: Sequence[str] = ("line",)
) -> Answer:
    """Answer in customary units, with its remarks and those of `lube check`.

    Parameters
    ----------
    found : xarray.Dataset
        Results in SI units.
    table : xarray.Dataset
        The film table that it comes from.
    rollers : Rollers
        The two rollers.
    models : sequence of str, optional
        Contact models of the answer.

    Returns
    -------
    Answer
        With the attribute ``remarks``, one line for each remark.
    """
    notes = [found.attrs.get("remarks"), *remarks(table, rollers.lines, rollers.pair, models)]
    if halved := int((table.get("inlet_shear_heating_factor", xr.DataArray(1.0)) < 0.5).sum()):
        notes.append(
            f"inlet_shear_heating: at {halved} operating points the film is less than half as "
            "thick, where no model of the heating is reliable"
        )
    notes += _outside(table)
    return described(found.assign_attrs(remarks="\n".join(filter(None, notes))))


def _outside(table):
    """Remark on film formulas that are used outside their range of validity."""
    invalid = ~table["in_validity_range"].astype(bool) & table["film_thickness"].notnull()
    size = invalid.size // table["film_formula"].size
    counts = invalid.sum(set(invalid.dims) - {"film_formula"})
    for name, count in zip(*map(np.ravel, (table["film_formula"], counts)), strict=True):
        if count:
            other = "" if name == "computed" else "; `computed` solves Reynolds' equation instead"
            yield (
                f"film_formula: at {int(count)} of {size} operating points `{name}` is outside its "
                f"range of validity{other}"
            )


def conditions_of(table: xr.Dataset, choices: Choices) -> dict[str, xr.DataArray | float]:
    """Force in N, speed in rpm, temperature in degC and slip of a table from `film_in_si`.

    And ``viscosity_factor`` if the table has it.
    """
    names = "force", "speed", "temperature", "viscosity_factor"
    conditions = {name: table[name] for name in names if name in table.coords}
    return conditions | {"slide_to_roll_ratio": choices.slip}
