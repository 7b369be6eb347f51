"""What keeps contact rare: the film, viscosity, speed or temperature that it takes.

Each answer lies where the breakthrough probability equals the given share of time, and its limits
lie where the limits of the probability do. So the 95 % interval is that of the mean over pairs of
rollers. The oil carries the whole load unless asked otherwise: films that keep contact rare leave
little to asperities.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr

from lube import types
from lube.calculator.answers import Answer
from lube.calculator.arguments import amount, checked, rotation_speed, single
from lube.calculator.bands import Assumptions
from lube.calculator.choices import FORMULA, REALISATIONS, SEED, Choices, Inlet
from lube.calculator.film import film_in_si
from lube.calculator.film_search import FilmSearch, labelled
from lube.calculator.oil import Oil
from lube.calculator.rollers import Rollers
from lube.ehl.film_formulas import formula
from lube.grid.film_profiles import scaled_film
from lube.grid.gap import PLAIN, Gap
from lube.grid.load_sharing import surface_load_share
from lube.physics.pressure_laws import ROELANDS_VISCOSITY

FACTORS = np.geomspace(1e-3, 1e3, 601)
"""Factors of the viscosity, and entrainment speeds in m/s, that are tried."""
TEMPERATURES = 241
"""Number of temperatures that are tried in the range of the lubricant record."""
_ANY_OIL, _ANY = "mobilgear-shc-xmp-320", {"speed": 100.0, "temperature": 60.0}
"""Oil, speed in rpm and temperature in degC of a film that is given and depends on none of them."""


@checked
def required_film(
    rollers: Rollers,
    force: types.OneAmount,
    *,
    share: float | str = 0.01,
    contact_model: types.ContactModel = "line",
    realisations: int = REALISATIONS,
    seed: int = SEED,
    bands: bool | Mapping[str, Any] = False,
) -> Answer:
    """Film thickness that keeps metal contact below a share of time.

    Parameters
    ----------
    rollers : Rollers
        The two rollers.
    force : str, tuple or pint.Quantity
        Normal force, such as ``"800 N"``; it sets the contact width.
    share : float or str, optional
        Largest breakthrough probability allowed, such as 0.01 or ``"1 %"``.
    contact_model : str, optional
        ``"line"`` or ``"surface"``, as in `lube.contact_probability`; the surface takes a minute.
    realisations, seed : int, optional
        As in `lube.contact_probability`.
    bands : bool or dict, optional
        Whether to find the band of the answer over what is not known exactly; ranges are as in
        `lube.contact_probability`. The range of what is sought is left out, and here also those of
        oil, film formula, speed and temperature, on which the film sought does not depend. It takes
        some ten seconds, and some minutes for surfaces.

    Returns
    -------
    Answer
        ``film_thickness`` (um) and ``lambda_ratio``, each with ``_lower`` and ``_upper``. With
        `bands` also, as in the other functions, ``assumed_film_thickness_lower`` and so on: between
        them lie the answers of 90 % of the samples. They are zero or infinite if they do not lie
        within films of 0.37 to 2.7 times the one found. The attribute ``remarks`` is as in
        `lube.contact_probability`, at the film found.

    Raises
    ------
    LubeError
        Which argument, what came, what is needed.

    Examples
    --------
    >>> rollers = Rollers(radius="5 mm", rms_roughness="0.2 um")
    >>> found = required_film(rollers, "100 N", share=0.05, realisations=4)
    >>> bool(found.film_thickness_lower < found.film_thickness < found.film_thickness_upper)
    True
    """
    choices = Choices.of(FORMULA, PLAIN, Inlet(), contact_model=contact_model)
    left_out = "oil", "film", "speed", "temperature"
    assumed = Assumptions(bands, rollers, Oil(_ANY_OIL), choices, seed, left_out)
    search = FilmSearch(assumed, share, realisations)
    force = single(amount("force", force, "N", above=0.0))
    half_width = float(rollers.pair.contact_half_width(force))

    def points_at(ratios):
        film = xr.DataArray(ratios * rollers.pair.composite_rms_roughness, dims="film")
        return _ANY | {"force": force, "film_thickness": film}

    found = search.films(half_width, points_at)
    film = film_in_si(rollers, Oil(_ANY_OIL), (force, "N"), "100 rpm", "60 degC", choices)
    factor = xr.DataArray(found["film_thickness"][0]) / film["film_thickness"]
    film = scaled_film(film, factor, has_shape=False).assign(
        lambda_ratio=factor * film["lambda_ratio"],
        in_validity_range=xr.ones_like(film["in_validity_range"]),  # no formula is used
    )
    if choices.has_surfaces:
        film["surface_load_share"] = surface_load_share(film, rollers.lines, has_shape=False)
    return labelled(found, film, rollers, choices)


@checked
def required_viscosity(
    rollers: Rollers,
    oil: Oil,
    force: types.OneAmount,
    speed: types.OneAmount,
    temperature: types.OneAmount,
    *,
    share: float | str = 0.01,
    film_formula: str = FORMULA,
    film_shape: types.FilmShape = "flat",
    roughness_deformation: types.RoughnessDeformation = "none",
    inlet_shear_heating: types.InletHeating = "none",
    inlet_meniscus: types.OneAmount | None = None,
    load_sharing: types.LoadSharing = "none",
    slide_to_roll_ratio: float = 0.0,
    contact_model: types.ContactModel = "line",
    realisations: int = REALISATIONS,
    seed: int = SEED,
    bands: bool | Mapping[str, Any] = False,
) -> Answer:
    """Viscosity that keeps metal contact below a share of time.

    Parameters
    ----------
    rollers, oil, force, speed, temperature, film_formula, film_shape, roughness_deformation
        As in `lube.contact_probability`, one value of each. The pressure-viscosity coefficient and
        the density are those of the oil at that temperature.
    inlet_shear_heating, inlet_meniscus, slide_to_roll_ratio
        As in `lube.film`. Computed heating takes some seconds more.
    load_sharing
        As in `lube.contact_probability`.
    share, contact_model, realisations, seed
        As in `required_film`.
    bands
        As in `required_film`; the range of the viscosity is left out. Film and lambda ratio at the
        limits are those of the other quantities as given.

    Returns
    -------
    Answer
        ``dynamic_viscosity`` (mPa s) and ``kinematic_viscosity`` (mm2/s) at the temperature, and
        the variables of `required_film`, each with ``_lower`` and ``_upper``.

    Raises
    ------
    LubeError
        Which argument, what came, what is needed; or that no viscosity is enough.
    """
    rotation = single(rotation_speed(speed, rollers.pair.first.radius))

    def table(factors, choices):
        # Formulas depend on the product of viscosity and speed, so the speed is varied for both.
        # Heating does not.
        speeds, is_heated = (rotation * factors, "rpm"), choices.inlet.shear_heating != "none"
        if choices.gap.is_plain and not (is_heated or formula(film_formula).depends_on_oil):
            return film_in_si(rollers, oil, force, speeds, temperature, choices)
        thicker = _Thicker(oil, xr.DataArray(factors, dims="factor"))
        found = film_in_si(rollers, thicker, force, speed, temperature, choices)
        return found.assign_coords(viscosity_factor=("factor", factors))

    gap, inlet = Gap(film_shape, roughness_deformation), Inlet(inlet_shear_heating, inlet_meniscus)
    choices = Choices.of(film_formula, gap, inlet, load_sharing, slide_to_roll_ratio, contact_model)
    assumed = Assumptions(bands, rollers, oil, choices, seed, ["viscosity"])
    search = FilmSearch(assumed, share, realisations)
    tried = f"viscosity within a factor of {FACTORS[-1]:g} of the oil's"
    films, factors, film = search.along(table, FACTORS, tried)
    properties = oil.at(amount("temperature", temperature, "degC"))
    viscosity = properties["dynamic_viscosity"].item() * factors
    kinematic = viscosity / properties["density"].item()
    found = {"dynamic_viscosity": viscosity, "kinematic_viscosity": kinematic} | films
    return labelled(found, film, rollers, choices)


@checked
def required_speed(
    rollers: Rollers,
    oil: Oil,
    force: types.OneAmount,
    temperature: types.OneAmount,
    *,
    share: float | str = 0.01,
    film_formula: str = FORMULA,
    film_shape: types.FilmShape = "flat",
    roughness_deformation: types.RoughnessDeformation = "none",
    inlet_shear_heating: types.InletHeating = "none",
    inlet_meniscus: types.OneAmount | None = None,
    load_sharing: types.LoadSharing = "none",
    slide_to_roll_ratio: float = 0.0,
    contact_model: types.ContactModel = "line",
    realisations: int = REALISATIONS,
    seed: int = SEED,
    bands: bool | Mapping[str, Any] = False,
) -> Answer:
    """Speed that keeps metal contact below a share of time.

    Parameters
    ----------
    rollers, oil, force, temperature, film_formula, film_shape, roughness_deformation
        As in `lube.contact_probability`, one value of each.
    inlet_shear_heating, inlet_meniscus, slide_to_roll_ratio
        As in `lube.film`. Computed heating takes some seconds more.
    load_sharing
        As in `lube.contact_probability`.
    share, contact_model, realisations, seed
        As in `required_film`.
    bands
        As in `required_viscosity`; the range of the speed is left out.

    Returns
    -------
    Answer
        ``speed`` (rpm, of the first roller in pure rolling), ``entrainment_speed`` (m/s), and the
        variables of `required_film`, each with ``_lower`` and ``_upper``.

    Raises
    ------
    LubeError
        Which argument, what came, what is needed; or that no speed is enough.
    """

    def table(speeds, choices):
        return film_in_si(rollers, oil, force, (speeds, "m/s"), temperature, choices)

    gap, inlet = Gap(film_shape, roughness_deformation), Inlet(inlet_shear_heating, inlet_meniscus)
    choices = Choices.of(film_formula, gap, inlet, load_sharing, slide_to_roll_ratio, contact_model)
    assumed = Assumptions(bands, rollers, oil, choices, seed, ["speed"])
    search = FilmSearch(assumed, share, realisations)
    films, speeds, film = search.along(table, FACTORS, f"speed up to {FACTORS[-1]:g} m/s")
    turns = rotation_speed("1 m/s", rollers.pair.first.radius).item()
    found = {"entrainment_speed": speeds, "speed": speeds * turns} | films
    return labelled(found, film, rollers, choices)


@checked
def required_temperature(
    rollers: Rollers,
    oil: Oil,
    force: types.OneAmount,
    speed: types.OneAmount,
    *,
    share: float | str = 0.01,
    film_formula: str = FORMULA,
    film_shape: types.FilmShape = "flat",
    roughness_deformation: types.RoughnessDeformation = "none",
    inlet_shear_heating: types.InletHeating = "none",
    inlet_meniscus: types.OneAmount | None = None,
    load_sharing: types.LoadSharing = "none",
    slide_to_roll_ratio: float = 0.0,
    contact_model: types.ContactModel = "line",
    realisations: int = REALISATIONS,
    seed: int = SEED,
    bands: bool | Mapping[str, Any] = False,
) -> Answer:
    """Highest temperature at which metal contact stays below a share of time.

    Parameters
    ----------
    rollers, oil, force, speed, film_formula, film_shape, roughness_deformation
        As in `lube.contact_probability`, one value of each.
    inlet_shear_heating, inlet_meniscus, slide_to_roll_ratio
        As in `lube.film`. Computed heating takes some seconds more.
    load_sharing
        As in `lube.contact_probability`.
    share, contact_model, realisations, seed
        As in `required_film`.
    bands
        As in `required_viscosity`; the range of the temperature is left out.

    Returns
    -------
    Answer
        ``temperature`` (degC) and the variables of `required_film`, each with ``_lower`` and
        ``_upper``. Infinite if the film is still thick enough at the oil's highest temperature; a
        film with a shape, or with a deformed roughness, is then 0, as none thinner is known. A
        limit is minus infinity if no temperature of the oil is low enough for it.

    Raises
    ------
    LubeError
        Which argument, what came, what is needed; or that no temperature is low enough.
    """

    def table(temperatures, choices):
        return film_in_si(rollers, oil, force, speed, (temperatures, "degC"), choices)

    gap, inlet = Gap(film_shape, roughness_deformation), Inlet(inlet_shear_heating, inlet_meniscus)
    choices = Choices.of(film_formula, gap, inlet, load_sharing, slide_to_roll_ratio, contact_model)
    assumed = Assumptions(bands, rollers, oil, choices, seed, ["temperature"])
    search = FilmSearch(assumed, share, realisations)
    levels = np.linspace(*oil.record.valid_temperatures, TEMPERATURES)
    films, found, film = search.along(table, levels, "temperature of this oil", is_rising=False)
    return labelled({"temperature": found} | films, film, rollers, choices)


@dataclass(frozen=True)
class _Thicker:
    """An oil of some times the viscosity, but the same density and pressure-viscosity coefficient.

    Unknown where no law of viscosity under pressure holds.
    """

    oil: Oil
    factor: xr.DataArray

    def at(self, temperature):
        """Properties as from `Oil.at`, over the factor too."""
        properties = self.oil.at(temperature)
        viscosity = properties["dynamic_viscosity"] * self.factor
        return properties.assign(dynamic_viscosity=viscosity.where(viscosity > ROELANDS_VISCOSITY))
