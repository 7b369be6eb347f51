"""What keeps contact rare: the film, viscosity, speed, temperature or roughness that it takes.

Each answer lies where the breakthrough probability equals the given share of time, and its limits
lie where the limits of the probability do. So the 95 % interval is that of the mean over pairs of
rollers. The oil carries the whole load unless asked otherwise: films that keep contact rare leave
little to asperities.
"""

from collections.abc import Mapping
from copy import copy
from dataclasses import dataclass
from typing import Any

import numpy as np
import xarray as xr
from scipy.interpolate import PchipInterpolator

from lube import types
from lube.calculator.answers import Answer
from lube.calculator.arguments import amount, checked, one_name, rotation_speed, single
from lube.calculator.bands import Assumptions
from lube.calculator.choices import FORMULA, REALISATIONS, SEED, Choices
from lube.calculator.film import conditions_of, film_in_si, with_remarks
from lube.calculator.film_search import FilmSearch, check_known
from lube.calculator.oil import Oil
from lube.calculator.rollers import Rollers
from lube.ehl.film_formulas import formula
from lube.grid.film_profiles import scaled_film
from lube.grid.gap import Gap
from lube.grid.load_sharing import MOST, surface_load_share
from lube.physics.pressure_laws import ROELANDS_VISCOSITY
from lube.schema import LIMITS, values_with_limits
from lube.study.uncertainty import deviating_lines

FACTORS = np.geomspace(1e-3, 1e3, 601)
"""Factors of the viscosity, and entrainment speeds in m/s, that are tried."""
TEMPERATURES = 241
"""Number of temperatures that are tried in the range of the lubricant record."""
_ANY_OIL, _ANY = "mobilgear-shc-xmp-320", {"speed": 100.0, "temperature": 60.0}
"""Oil, speed in rpm and temperature in degC of a film that is given and depends on none of them."""
_HEIGHTS = "rms_roughness", "first_rms_roughness", "second_rms_roughness"
_CHANGED = "rms_deformation", "surface_rms_deformation"
"""Variables of a film in proportion to the heights."""
RATIOS = np.geomspace(0.25, 5.0, 24)
"""Lambda ratios, under the film of the heights as given, of the heights that are tried. Asperities
carry nothing beyond the last, and nearly all of the load below the first."""


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
    choices = Choices.of(contact_model=contact_model)
    left_out = "oil", "film", "speed", "temperature"
    assumed = Assumptions(bands, rollers, Oil(_ANY_OIL), choices, FORMULA, seed, left_out)
    search = FilmSearch(assumed, share, realisations)
    force = single(amount("force", force, "N", above=0.0))
    half_width = float(rollers.pair.contact_half_width(force))

    def points_at(ratios):
        film = xr.DataArray(ratios * rollers.pair.composite_rms_roughness, dims="film")
        return _ANY | {"force": force, "film_thickness": film}

    found = search.films(half_width, points_at)
    film = film_in_si(rollers, Oil(_ANY_OIL), (force, "N"), "100 rpm", "60 degC", FORMULA, choices)
    factor = xr.DataArray(found["film_thickness"][0]) / film["film_thickness"]
    film = scaled_film(film, factor).assign(lambda_ratio=factor * film["lambda_ratio"])
    if "surface_load_share" in film:
        film["surface_load_share"] = surface_load_share(film, rollers.lines, has_shape=False)
    return _labelled(found, film, rollers, choices)


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
    one = one_name("film_formula", film_formula)

    def table(factors, choices):
        # Formulas depend on the product of viscosity and speed, so the speed is varied for both.
        # Heating does not.
        speeds, is_heated = (rotation * factors, "rpm"), choices.inlet_shear_heating != "none"
        if choices.gap.is_plain and not (is_heated or formula(one).depends_on_oil):
            return film_in_si(rollers, oil, force, speeds, temperature, one, choices)
        thicker = _Thicker(oil, xr.DataArray(factors, dims="factor"))
        found = film_in_si(rollers, thicker, force, speed, temperature, one, choices)
        return found.assign_coords(viscosity_factor=("factor", factors))

    gap = Gap(film_shape, roughness_deformation)
    choices = Choices.of(
        gap, contact_model, inlet_shear_heating, inlet_meniscus, slide_to_roll_ratio, load_sharing
    )
    assumed = Assumptions(bands, rollers, oil, choices, one, seed, ["viscosity"])
    search = FilmSearch(assumed, share, realisations)
    tried = f"viscosity within a factor of {FACTORS[-1]:g} of the oil's"
    films, factors, film = search.along(table, FACTORS, tried)
    properties = oil.at(amount("temperature", temperature, "degC"))
    viscosity = properties["dynamic_viscosity"].item() * factors
    kinematic = viscosity / properties["density"].item()
    found = {"dynamic_viscosity": viscosity, "kinematic_viscosity": kinematic} | films
    return _labelled(found, film, rollers, choices)


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
    one = one_name("film_formula", film_formula)

    def table(speeds, choices):
        return film_in_si(rollers, oil, force, (speeds, "m/s"), temperature, one, choices)

    gap = Gap(film_shape, roughness_deformation)
    choices = Choices.of(
        gap, contact_model, inlet_shear_heating, inlet_meniscus, slide_to_roll_ratio, load_sharing
    )
    assumed = Assumptions(bands, rollers, oil, choices, one, seed, ["speed"])
    search = FilmSearch(assumed, share, realisations)
    films, speeds, film = search.along(table, FACTORS, f"speed up to {FACTORS[-1]:g} m/s")
    turns = rotation_speed("1 m/s", rollers.pair.first.radius).item()
    found = {"entrainment_speed": speeds, "speed": speeds * turns} | films
    return _labelled(found, film, rollers, choices)


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
        film with a shape, or with a deformed roughness, is then 0, as none thinner is known.

    Raises
    ------
    LubeError
        Which argument, what came, what is needed; or that no temperature is low enough.
    """
    one = one_name("film_formula", film_formula)

    def table(temperatures, choices):
        return film_in_si(rollers, oil, force, speed, (temperatures, "degC"), one, choices)

    gap = Gap(film_shape, roughness_deformation)
    choices = Choices.of(
        gap, contact_model, inlet_shear_heating, inlet_meniscus, slide_to_roll_ratio, load_sharing
    )
    assumed = Assumptions(bands, rollers, oil, choices, one, seed, ["temperature"])
    search = FilmSearch(assumed, share, realisations)
    levels = np.linspace(*oil.record.valid_temperatures, TEMPERATURES)
    films, found, film = search.along(table, levels, "temperature of this oil", is_rising=False)
    return _labelled({"temperature": found} | films, film, rollers, choices)


@checked
def required_roughness(
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
    r"""Roughness that keeps metal contact below a share of time.

    The heights of both rollers are multiplied by the same factor. Overlaps and the forces on
    segments grow with it, so lines of :math:`s` times the height, at a film :math:`h`, break as
    the given lines do at a film :math:`h / s` with a boundary layer :math:`s` times weaker.

    Parameters
    ----------
    rollers, oil, force, speed, temperature, film_formula, film_shape, roughness_deformation
        As in `lube.contact_probability`, one value of each.
    inlet_shear_heating, inlet_meniscus, slide_to_roll_ratio
        As in `lube.film`.
    load_sharing
        As in `lube.contact_probability`. The film is then computed for twenty other heights, too.
    share, contact_model, realisations, seed
        As in `required_film`.
    bands
        As in `required_viscosity`; the ranges of the rms roughness are left out.

    Returns
    -------
    Answer
        ``composite_rms_roughness`` (um), ``lambda_ratio`` and ``roughness_factor``, the factor of
        both rollers' heights, each with ``_lower`` and ``_upper``.

    Raises
    ------
    LubeError
        Which argument, what came, what is needed; or that no roughness tried is low enough.
    """
    one = one_name("film_formula", film_formula)
    gap = Gap(film_shape, roughness_deformation)
    choices = Choices.of(
        gap, contact_model, inlet_shear_heating, inlet_meniscus, slide_to_roll_ratio, load_sharing
    )
    assumed = Assumptions(bands, rollers, oil, choices, one, seed, _HEIGHTS)
    search = FilmSearch(assumed, share, realisations)

    def film_of(rougher):
        return film_in_si(rougher, oil, force, speed, temperature, one, choices)

    film = film_of(rollers)
    own = single(film["lambda_ratio"])
    check_known(np.isfinite(own))

    def factor_at(ratios):
        return own / ratios

    if load_sharing != "none":
        factor_at = _factors(film_of, rollers, own / RATIOS)

    def table_at(ratios):
        # Lines of s times the height break as the given ones do under the film over s.
        return scaled_film(film, xr.DataArray(ratios / own, dims="film"))

    def points_at(ratios):
        factors = xr.DataArray(factor_at(ratios), dims="film")
        return conditions_of(film, choices) | {"roughness_factor": factors}

    half_width = film["contact_half_width"].item()
    with np.errstate(divide="ignore"):  # a limit may be 0
        found = search.films(half_width, points_at, table_at, factor_at=factor_at)
        ratios = found["lambda_ratio"]
        factor = factor_at(ratios)
    sigma = rollers.pair.composite_rms_roughness * factor
    found = {"roughness_factor": factor, "composite_rms_roughness": sigma, "lambda_ratio": ratios}
    changed = {name: factor[0] * film[name] for name in _CHANGED if name in film}
    if "surface_load_share" in film:  # pressures grow with heights and film
        share_here = surface_load_share(table_at(ratios[:1]), rollers.lines, gap.has_shape)
        changed["surface_load_share"] = factor[0] * share_here
    changed["lambda_ratio"] = xr.full_like(film["lambda_ratio"], ratios[0])
    return _labelled(found, film.assign(changed), _rougher(rollers, factor[0]), choices)


def _factors(film_of, rollers, levels):
    """Return a function that finds the factor of the heights at some lambda ratios.

    Where asperities share the load, the film grows with the heights, too.
    """
    films = xr.concat([film_of(_rougher(rollers, one)) for one in levels], "film")
    known = (films["lambda_ratio"].notnull() & (films["surface_load_share"] < MOST)).values
    check_known(known.any())
    # The film over the rms height as given changes smoothly with the heights.
    heights = np.log(levels[known])[::-1]
    films = np.log(films["lambda_ratio"].values[known])[::-1] + heights
    every = np.linspace(*heights[[0, -1]], 1000)
    film = PchipInterpolator(heights, films)(every)

    def factor_at(ratio):
        ratio = np.log(ratio)
        return np.exp(np.interp(ratio, (film - every)[::-1], film[::-1]) - ratio)

    return factor_at


def _rougher(rollers, factor):
    """Return the rollers with some times their heights."""
    changed = copy(rollers)
    changed.lines = deviating_lines(rollers.lines, {"rms_roughness": factor - 1.0})
    changed.pair = rollers.pair.with_rms_heights(changed.lines.rms_height)
    return changed


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


def _labelled(found, film, rollers, choices):
    """Answer of values and their limits, the smaller limit first; remarks on the film found."""
    rows = {}
    for name, (value, *limits) in found.items():
        rows |= values_with_limits(name, [value, *np.sort(limits[:2])])
        assumed = zip(LIMITS[1:], np.sort(limits[2:]), strict=False)
        rows |= {f"assumed_{name}{end}": limit for end, limit in assumed}
    return with_remarks(xr.Dataset(rows), film, rollers, choices.models)
