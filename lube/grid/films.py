"""The film over any operating conditions: the contact, its groups, film thickness and profile."""

import logging
from collections.abc import Iterator, Sequence
from contextlib import contextmanager
from dataclasses import dataclass, replace
from functools import cached_property, partial
from typing import Any

import numpy as np
import xarray as xr

from lube.digits import six_digits
from lube.ehl.film_formulas import Formula, formula
from lube.ehl.line_contact import FilmProfile, profiles_of
from lube.grid.film_profiles import film_positions, over_positions
from lube.grid.film_responses import surface_responses, wave_responses
from lube.grid.load_sharing import MOST, share_load, surface_load_share
from lube.physics import dimensionless, hertz
from lube.physics.inlet_heating import heating_factor, thermal_loading
from lube.physics.regimes import asymptotic_gap, regime
from lube.physics.starvation import starvation_factor

log = logging.getLogger(__name__)


@contextmanager
def unreported() -> Iterator[None]:
    """Log no films that did not converge, where most conditions tried are far from those sought."""
    whole = logging.getLogger("lube")
    level = whole.level
    whole.setLevel(logging.ERROR)
    try:
        yield
    finally:
        whole.setLevel(level)


_THINNED = ["film_thickness", "lambda_ratio"]
"""Variables that heating at the inlet reduces."""


def film_at(
    lubricant: xr.Dataset,
    rollers,
    force: xr.DataArray,
    speed: xr.DataArray,
    formulas: Sequence[str],
    with_shape: bool = False,
    slide_to_roll_ratio: xr.DataArray | float = 0.0,
    inlet_shear_heating: str = "none",
    inlet_meniscus: float | None = None,
    answered_lines=None,
    answered_surfaces=None,
    rough_surfaces=None,
    load_sharing: str = "none",
    threads: int | None = None,
) -> xr.Dataset:
    """Film thickness over the dimensions that the lubricant, force and speed have.

    Parameters
    ----------
    lubricant : xarray.Dataset
        As in `lube.stages.film.film_table`, over lubricant and temperature or others.
    rollers : RollerPair
        Geometry, elasticity and roughness of the two rollers.
    force, speed : xarray.DataArray
        Normal force, N, and rotation speed of the first roller in pure rolling, rpm.
    formulas : sequence of str
        Names of film formulas.
    slide_to_roll_ratio : xarray.DataArray or float, optional
        Slide-to-roll ratio.
    with_shape, inlet_shear_heating, inlet_meniscus, answered_lines
        As in `lube.stages.film.film_table`.
    answered_surfaces : LineSpec, optional
        Roughness lines of surfaces that the oil answers; adds `surface_responses`.
    rough_surfaces, load_sharing
        As in `lube.stages.film.film_table`.
    threads : int, optional
        Threads that share the responses' work; they do not change the results.

    Returns
    -------
    xarray.Dataset
        The variables of the ``film`` file, without attributes.

    Raises
    ------
    StudyError
        If a film formula is unknown.
    RangeError
        If the meniscus lies inside a contact.
    """
    is_heated = inlet_shear_heating != "none"
    # "exact": coordinates that differ in one value would otherwise be cut to their intersection.
    with xr.set_options(arithmetic_join="exact", keep_attrs=False):
        contact = hertz_contact(rollers, force, speed)
        groups = FilmGroups.at(lubricant, rollers, force, contact, inlet_meniscus)
        rows = [formula(name) for name in formulas]
        table = _films(rows, groups, contact)
        table["inlet_shear_heating_factor"] = factor = _heating_factor(
            inlet_shear_heating, lubricant, contact, groups, slide_to_roll_ratio
        )
        if is_heated:
            table.update(table[_THINNED] * factor)
        if with_shape:
            positions = film_positions(contact)
            profile = over_positions(groups.profiles, FilmProfile.film_at, positions)
            table["film_profile"] = profile * rollers.reduced_radius
        if load_sharing == "iterated":
            films_at = partial(
                _films_at, rows, rollers.reduced_radius, factor if is_heated else 1.0
            )
            table = _with_shared_load(table, films_at, groups, rough_surfaces, with_shape)
        elif rough_surfaces is not None:
            table["surface_load_share"] = surface_load_share(table, rough_surfaces, with_shape)
        if answered_lines is not None or answered_surfaces is not None:
            solved = groups.thinned(factor).profiles if is_heated else groups.profiles
            slip, specs = xr.DataArray(slide_to_roll_ratio), (answered_lines, answered_surfaces)
            table = _with_responses(table, solved, slip, specs, threads)
    return table


def answered_films(film: xr.Dataset, lubricant: xr.Dataset, rollers, **model: Any) -> xr.Dataset:
    """Compute films at the levels of a film table, with responses; arguments as in `film_at`."""
    force, speed, slip = (film[name] for name in ("force", "speed", "slide_to_roll_ratio"))
    choices = model | {"slide_to_roll_ratio": slip}
    return film_at(lubricant, rollers, force, speed, ["computed"], **choices)


def film_with_oil(
    lubricant: xr.Dataset,
    rollers,
    force: xr.DataArray,
    speed: xr.DataArray,
    formulas: Sequence[str],
    **model: Any,
) -> xr.Dataset:
    """Film by `film_at`, with all that `FilmGroups.of` needs.

    Parameters
    ----------
    lubricant, rollers, force, speed, formulas, **model
        As in `film_at`.

    Returns
    -------
    xarray.Dataset
        The same and ``dynamic_viscosity``, with a meniscus also ``inlet_meniscus``; without heating
        at the inlet no factor of it.
    """
    table = film_at(lubricant, rollers, force, speed, formulas, **model)
    if model.get("inlet_shear_heating", "none") == "none":
        del table["inlet_shear_heating_factor"]
    if model.get("inlet_meniscus") is not None:
        table["inlet_meniscus"] = model["inlet_meniscus"]
    return table.assign(dynamic_viscosity=lubricant["dynamic_viscosity"])


def _films(rows, groups, contact):
    """Contact, Moes' numbers, and the films by some formulas."""
    moes_numbers = groups.moes_numbers
    names = xr.DataArray([row.name for row in rows], dims="film_formula", name="film_formula")

    def films(groups):
        of_formulas = [groups.film(row) for row in rows]
        return xr.concat(of_formulas, dim=names, join="exact") * contact["reduced_radius"]

    film, starved = films(groups), {}
    if groups.meniscus is not None:
        starved["starvation_factor"] = film / films(replace(groups, meniscus=None))
    flag = xr.apply_ufunc(regime, *moes_numbers)
    valid = xr.concat([row.holds(*moes_numbers) for row in rows], dim=names, join="exact")
    return contact.assign(
        moes_load=moes_numbers[0],
        moes_material=moes_numbers[1],
        regime=flag.astype("int8"),  # the type of its flag_values, as CF requires
        film_thickness=film,
        lambda_ratio=film / contact["composite_rms_roughness"],
        in_validity_range=valid & film.notnull(),  # a computed film need not converge
        formula_place=("film_formula", [row.thickness for row in rows]),
        formula_source=("film_formula", [row.source for row in rows]),
        **starved,
    )


def _films_at(rows, radius, thinner, groups, part):
    """Film thickness by some formulas if the oil carries a part of the load, m."""
    names, films = part["film_formula"], []
    for number, row in enumerate(rows):
        load = groups.load * part.isel(film_formula=number, drop=True)
        films.append(replace(groups, load=load).film(row))
    return thinner * radius * xr.concat(films, names, join="exact")


def _with_shared_load(table, films_at, groups, rough_surfaces, with_shape):
    """Films that carry the load together with the asperities, whose share is added."""
    film, share = share_load(table, partial(films_at, groups), rough_surfaces, with_shape)
    found = {
        "film_thickness": film,
        "surface_load_share": share,
        "lambda_ratio": film / table["composite_rms_roughness"],
    }
    if groups.meniscus is not None:
        # Where no balance was found, the film is that of the least load on the oil.
        flooded = films_at(replace(groups, meniscus=None), 1.0 - share.clip(max=MOST))
        found["starvation_factor"] = film / flooded
    return table.assign(found)


def _with_responses(table, solved, slip, specs, threads):
    """Films with their responses to the waves of roughness lines, and of surfaces, if wanted."""
    for responses, spec in zip((wave_responses, surface_responses), specs, strict=True):
        if spec is not None:
            found = responses(solved, table, slip, spec, threads)
            table = table.merge(found, compat="override", join="exact")
    # The response depends on slip, so the film is stored for each slip.
    stored = [name for name in (*_THINNED, "surface_load_share") if name in table]
    table.update(table[stored].broadcast_like(slip))
    return table


def _heating_factor(model, lubricant, contact, groups, slip):
    loading = inlet_loading(lubricant, contact["entrainment_speed"])
    pressure = contact["hertz_pressure"] / (2.0 * contact["reduced_modulus"])
    film = xr.apply_ufunc(asymptotic_gap, *groups.moes_numbers)
    factor = xr.apply_ufunc(partial(heating_factor, model), loading, slip, pressure, film)
    unknown = int(factor.isnull().sum())
    if unknown and model != "none":
        log.warning(
            "inlet_shear_heating: the film is not known at %d of %d conditions, where the heating "
            "is beyond the range of the formula",
            unknown,
            factor.size,
        )
    return factor


def inlet_loading(lubricant: xr.Dataset, speed: xr.DataArray) -> xr.DataArray:
    """Thermal loading of the inlet by oils, at entrainment speeds, m/s."""
    viscosity, conductivity = lubricant["dynamic_viscosity"], lubricant["thermal_conductivity"]
    slope = lubricant["temperature_viscosity_coefficient"]
    return thermal_loading(viscosity, slope, speed, conductivity)


@dataclass(frozen=True)
class FilmGroups:
    """Dimensionless groups that determine the film over R*, at some operating points.

    Attributes
    ----------
    load, speed, material : xarray.DataArray
        W, U and G of `lube.physics.dimensionless`.
    viscosity : xarray.DataArray
        Viscosity of the oil at ambient pressure, Pa s.
    film_modulus : float or xarray.DataArray
        E' = 2 E*, Pa.
    meniscus : float, xarray.DataArray or None
        Distance from the line of centres to the meniscus of the oil, over R*; None if the contact
        is fully flooded.
    """

    load: xr.DataArray
    speed: xr.DataArray
    material: xr.DataArray
    viscosity: xr.DataArray
    film_modulus: float | xr.DataArray
    meniscus: float | xr.DataArray | None

    @classmethod
    def at(
        cls, lubricant: xr.Dataset, rollers, force, contact: xr.Dataset, inlet_meniscus=None
    ) -> "FilmGroups":
        """Form the groups for a contact from `hertz_contact`; other arguments as in `film_at`."""
        modulus, radius = 2.0 * rollers.reduced_modulus, rollers.reduced_radius
        viscosity, speed = lubricant["dynamic_viscosity"], contact["entrainment_speed"]
        alpha = lubricant["pressure_viscosity_coefficient"]
        return cls(
            dimensionless.dimensionless_load(force / rollers.length, modulus, radius),
            dimensionless.dimensionless_speed(viscosity, speed, modulus, radius),
            dimensionless.dimensionless_material(alpha, modulus),
            viscosity,
            modulus,
            None if inlet_meniscus is None else inlet_meniscus / radius,
        )

    @classmethod
    def of(cls, film: xr.Dataset) -> "FilmGroups":
        """Find the groups of known films, such as those of a comparison.

        W = pi/8 (a / R*)^2 follows from Hertz' half-width, U and G from Moes' numbers
        M = W (2U)^(-1/2) and L = G (2U)^(1/4).
        """
        radius = film["reduced_radius"]
        load = np.pi / 8.0 * (film["contact_half_width"] / radius) ** 2
        speed = 0.5 * (load / film["moes_load"]) ** 2
        material = film["moes_material"] / (2.0 * speed) ** 0.25
        meniscus = (film["inlet_meniscus"] / radius).item() if "inlet_meniscus" in film else None
        viscosity, modulus = film["dynamic_viscosity"], 2.0 * film["reduced_modulus"]
        return cls(load, speed, material, viscosity, modulus, meniscus)

    @property
    def moes_numbers(self) -> tuple[xr.DataArray, xr.DataArray]:
        """M and L."""
        return dimensionless.moes_numbers(self.load, self.speed, self.material)

    @cached_property
    def profiles(self) -> xr.DataArray:
        """Profile of each film, solved numerically; None where it did not converge."""
        return xr.apply_ufunc(
            profiles_of,
            self.load,
            self.speed,
            self.material,
            self.viscosity,
            self.film_modulus,
            self.meniscus,
        )

    @cached_property
    def central_film(self) -> xr.DataArray:
        """Film over R* at the line of centres of each profile; NaN where there is none."""
        return self.of_profiles("central_film")

    def of_profiles(self, name: str) -> xr.DataArray:
        """Read a number of each profile, by its name; NaN where there is no profile."""
        of_each = np.vectorize(lambda one: getattr(one, name) if one else np.nan, otypes=[float])
        return xr.apply_ufunc(of_each, self.profiles)

    def film(self, row: Formula) -> xr.DataArray:
        """Film over R* by a formula, reduced by starvation if the inlet has a meniscus.

        The computed film is solved for with its meniscus, and rounded to six digits.
        """
        if row.depends_on_oil:
            return xr.apply_ufunc(six_digits, self.central_film)
        film = xr.apply_ufunc(row.evaluate, self.load, self.speed, self.material)
        if self.meniscus is None:
            return film
        half_width = np.sqrt(8.0 * self.load / np.pi)
        before = self.meniscus / half_width
        return film * xr.apply_ufunc(starvation_factor, film / half_width**2, before)

    def thinned(self, factor: xr.DataArray) -> "FilmGroups":
        """Find the groups of films that heating thins by a factor.

        Heating acts as a lower viscosity at the inlet, at which the central film is thinner by the
        factor. The film is nearly a power of the viscosity at the inlet; the power follows from the
        film at two viscosities.
        """
        thinner = factor
        for _ in range(2):
            film = replace(self, speed=self.speed * thinner).central_film
            thinner = thinner ** (np.log(factor) / np.log(film / self.central_film))
        return replace(self, speed=self.speed * thinner)


def hertz_contact(rollers, force: xr.DataArray, speed: xr.DataArray) -> xr.Dataset:
    """Hertz contact of smooth, dry rollers; arguments as in `film_at`."""
    half_width = hertz.contact_half_width(
        force, rollers.length, rollers.reduced_radius, rollers.reduced_modulus
    )
    found = {
        "reduced_radius": rollers.reduced_radius,
        "reduced_modulus": rollers.reduced_modulus,
        "composite_rms_roughness": rollers.composite_rms_roughness,
        "contact_half_width": half_width,
        "hertz_pressure": hertz.maximum_pressure(force, half_width, rollers.length),
        "entrainment_speed": 2.0 * np.pi * rollers.first.radius * speed / 60.0,
    }
    return xr.Dataset(found)
