"""Answers at one operating point, along the time or across the contact: trace and profile."""

from __future__ import annotations

import numpy as np

from lube import types
from lube.calculator.answers import Answer, described
from lube.calculator.arguments import checked, conditions, one_name, single
from lube.calculator.choices import FORMULA, SEED, Choices, Inlet
from lube.calculator.film import check_contact, film_in_si, film_model, with_remarks
from lube.calculator.oil import Oil
from lube.calculator.rollers import Rollers
from lube.contact.rough_pair import roughness_batch
from lube.contact.surface_trace import surface_traces
from lube.errors import RangeError
from lube.grid.gap import Gap
from lube.physics.electrical import contact_resistance
from lube.schema import OPERATING_DIMS, POINT_DIMS
from lube.stages.film import film_table
from lube.stages.film_profile import film_profile_table
from lube.stages.trace import contact_trace
from lube.study.oil_properties import lubricant_table


@checked
def trace(
    rollers: Rollers,
    oil: Oil,
    force: types.OneAmount,
    speed: types.OneAmount,
    temperature: types.OneAmount,
    *,
    film_formula: str = FORMULA,
    film_shape: types.FilmShape = "flat",
    roughness_deformation: types.RoughnessDeformation = "none",
    inlet_shear_heating: types.InletHeating = "none",
    inlet_meniscus: types.OneAmount | None = None,
    load_sharing: types.LoadSharing = "none",
    slide_to_roll_ratio: float = 0.0,
    contact_model: types.ContactModel = "line",
    seed: int = SEED,
) -> Answer:
    """Contact length and electrical resistance over one revolution, or a stretch of surfaces.

    Parameters
    ----------
    rollers, oil, force, speed, temperature, film_formula, inlet_shear_heating, inlet_meniscus
        As in `film`, one value of each.
    film_shape, roughness_deformation, load_sharing, slide_to_roll_ratio, seed
        As in `contact_probability`; the trace is that of realisation 0.
    contact_model : str, optional
        ``"line"``, over one revolution; or ``"surface"``, over the length of the rollers, while
        they move by a few of the longest waves. It takes some ten seconds.

    Returns
    -------
    Answer
        ``contact_length`` (um) and ``contact_resistance`` (ohm) over time (ms). The resistance
        is infinite without contact. For the surface the length is the sum of the diameters of all
        contacts whose layer is broken; also the numbers ``contacts`` and ``breakthroughs``, and
        ``contact_length_at`` over roller_position (um). The attribute ``remarks`` is as in
        `contact_probability`.

    Raises
    ------
    LubeError
        Which argument, what came, what is needed.

    Examples
    --------
    >>> rollers = Rollers(radius="5 mm", rms_roughness="0.2 um")
    >>> found = trace(rollers, Oil("mobilgear-shc-xmp-320"), "300 N", "500 rpm", "80 degC")
    >>> f"{found.time.values[-1]:.0f} ms"
    '120 ms'
    """
    one_name("contact_model", contact_model)
    one_name("film_formula", film_formula)
    gap, inlet = Gap(film_shape, roughness_deformation), Inlet(inlet_shear_heating, inlet_meniscus)
    choices = Choices.of(film_formula, gap, inlet, load_sharing, slide_to_roll_ratio, contact_model)
    slip = choices.slip
    one = _one_point(rollers, oil, force, speed, temperature)
    if contact_model == "surface":
        film = film_in_si(rollers, oil, force, speed, temperature, choices)
        return _surface_trace(rollers, film, rollers.rough_pair(seed, gap), slip)
    check_contact(rollers, rollers.pair.contact_half_width(*one[2]), choices)
    options = film_model(rollers, choices) | {"slide_to_roll_ratio": [slip]}
    table = film_table(*one, **options)
    point = {name: table[name].item() for name in OPERATING_DIMS} | {"slide_to_roll_ratio": slip}
    lines = roughness_batch(rollers.lines, seed, [0])
    found = contact_trace(lines, table, [point], rollers.layer, rollers.resistivity, gap)
    names = ["film_thickness", "contact_half_width", "contact_length", "contact_resistance"]
    if inlet_shear_heating == "none":  # the factor is known, but thins no film
        del table["inlet_shear_heating_factor"]
    return with_remarks(found[names].isel(operating_point=0).drop_attrs(), table, rollers)


def _surface_trace(rollers, film, pair, slip):
    """Trace of the surfaces under a film."""
    found = surface_traces(pair, film.expand_dims("operating_point"), slip)
    found = found.isel(operating_point=0).rename(step="time")
    found = found.assign_coords(time=found["time"] / film["entrainment_speed"].item())
    resistance = contact_resistance(found["contact_length"].values, rollers.resistivity)
    found = found.assign(film[["film_thickness", "contact_half_width"]])
    found = found.assign(contact_resistance=("time", resistance)).drop_attrs()
    return with_remarks(found, film, rollers, ["surface"])


@checked
def profile(
    rollers: Rollers,
    oil: Oil,
    force: types.OneAmount,
    speed: types.OneAmount,
    temperature: types.OneAmount,
) -> Answer:
    """Pressure and film across the contact, from Reynolds' equation.

    Parameters
    ----------
    rollers, oil, force, speed, temperature
        As in `film`, one value of each. The contact is fully flooded, isothermal and smooth.

    Returns
    -------
    Answer
        ``pressure`` (MPa) and ``film`` (um), which is the gap outside the contact, over
        ``position`` (um) from the line of centres, negative at the inlet, where it begins at a
        thousandth of the greatest pressure, so that some 0.4 % of the load are missing; also
        ``central_film``, ``minimum_film``, ``hertz_pressure`` and ``contact_half_width``.

    Raises
    ------
    LubeError
        Which argument, what came, what is needed; or that the film did not converge.

    Examples
    --------
    >>> rollers = Rollers(radius="50 mm", rms_roughness="0.2 um")
    >>> found = profile(rollers, Oil("mobilgear-shc-xmp-320"), "800 N", "100 rpm", "40 degC")
    >>> f"{found.central_film.item():.2f} um, least {found.minimum_film.item():.2f} um"
    '1.02 um, least 0.85 um'
    """
    one = _one_point(rollers, oil, force, speed, temperature)
    table = film_profile_table(*one)
    found = table.isel(dict.fromkeys(POINT_DIMS, 0))
    if np.isnan(found["central_film"]):
        raise RangeError(f"the film at {force}, {speed} and {temperature} did not converge")
    place = found["film_position"] * found["contact_half_width"]
    found = found.assign_coords(position=place).swap_dims(film_position="position")
    names = ["pressure", "film", "central_film", "minimum_film"]
    return described(found[[*names, "hertz_pressure", "contact_half_width"]].drop_attrs())


def _one_point(rollers, oil, force, speed, temperature):
    """Oil at the temperature, pair of rollers, force in N and speed in rpm, of one point."""
    given = conditions(force, speed, temperature, rollers.pair.first.radius)
    force, speed, temperature = ([single(one)] for one in given.values())
    return lubricant_table([oil.record], temperature), rollers.pair, force, speed
