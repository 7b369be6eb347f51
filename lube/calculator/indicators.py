"""Indicators that engineers know, at operating points."""

from __future__ import annotations

from collections.abc import Sequence

import xarray as xr

from lube.calculator.answers import Answer, variable_of
from lube.calculator.arguments import amount, checked, single
from lube.calculator.choices import FORMULA, Choices, Inlet
from lube.calculator.film import film_in_si, with_remarks
from lube.calculator.oil import Oil
from lube.calculator.rollers import Rollers
from lube.grid.films import FilmGroups
from lube.grid.indicators import indicators as published
from lube.physics.indicators import bearing_speed, viscosity_ratio
from lube.types import Amount, InletHeating, OneAmount


@checked
def indicators(
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
    pitch_diameter: OneAmount | None = None,
) -> Answer:
    """Find indicators of lubrication by their published formulas, and the rolling resistance.

    None of them is a probability of contact: the load share of asperities is a share of load, not
    of time.

    Parameters
    ----------
    rollers, oil, force, speed, temperature, film_formula
        As in `film`.
    inlet_shear_heating, inlet_meniscus, slide_to_roll_ratio
        As in `film`; the rolling resistance is without heating.
    pitch_diameter : str, optional
        Pitch diameter of a rolling bearing, such as ``"200 mm"``; its viscosity ratio is found,
        too. `rollers` are its ring and, with the smaller radius, a rolling element; the bearing
        turns so fast that they have the entrainment speed of this point.

    Returns
    -------
    Answer
        ``lambda_ratio``; ``micropitting_film_ratio``, lambda_GF of ISO/TR 15144-1 without flash
        temperature; ``viscosity_ratio``, kappa of ISO 281, if the pitch diameter is given. The
        names of the others end with that of their formula: ``asperity_load_share_``, by published
        curves, each with its own lambda ratio and NaN beyond the pressures it is meant for; and
        ``rolling_resistance_`` (N) of either roller, computed and by published formulas.

    Raises
    ------
    LubeError
        Which argument, what came, what is needed.

    Examples
    --------
    >>> rollers = Rollers(radius="50 mm", rms_roughness="0.2 um")
    >>> oil = Oil("mobilgear-shc-xmp-320")
    >>> found = indicators(rollers, oil, "800 N", "100 rpm", "80 degC", pitch_diameter="200 mm")
    >>> f"{found.micropitting_film_ratio.item():.2f}, kappa {found.viscosity_ratio.item():.2f}"
    '1.63, kappa 1.25'
    >>> resistance = found.rolling_resistance_computed
    >>> f"{resistance.item():.2f} {resistance.attrs['units']}"
    '0.56 N'
    """
    inlet = Inlet(inlet_shear_heating, inlet_meniscus)
    choices = Choices.of_smooth_rollers(film_formula, inlet, slide_to_roll_ratio)
    table = film_in_si(rollers, oil, force, speed, temperature, choices)
    pair, groups = rollers.pair, FilmGroups.of(table)
    scale = 2.0 * pair.reduced_modulus * pair.reduced_radius
    resistance = scale * groups.of_profiles("rolling_resistance")
    found = table[["lambda_ratio"]].assign(_each_by_name(published(table, resistance, pair)))
    if pitch_diameter is not None:
        element = 2.0 * min(pair.first.radius, pair.second.radius)
        diameter = single(amount("pitch_diameter", pitch_diameter, "m", above=element))
        speed = bearing_speed(table["entrainment_speed"], diameter, element)
        found["viscosity_ratio"] = xr.apply_ufunc(
            viscosity_ratio, oil.at(table["temperature"])["kinematic_viscosity"], speed, diameter
        )
    return with_remarks(found, table, rollers)


def _each_by_name(found):
    """Variables without the dimensions of curves and formulas: one for each of them."""
    flat = {}
    for name, values in found.items():
        by = {"load_share_curve", "resistance_formula"}.intersection(values.dims)
        if by:
            flat |= {variable_of(name, one): value for one, value in values.to_dataset(*by).items()}
        else:
            flat[name] = values
    return flat
