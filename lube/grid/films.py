"""The film over any operating conditions: the contact, its groups, film thickness and profile."""

import logging
from collections.abc import Sequence
from dataclasses import dataclass, replace
from functools import partial

import numpy as np
import xarray as xr

from lube.ehl.film_formulas import Formula, formula
from lube.ehl.line_contact import FilmProfile, profiles_of
from lube.grid.film_profiles import film_positions, sampled
from lube.grid.film_responses import thinned, wave_responses
from lube.physics import dimensionless, hertz
from lube.physics.inlet_heating import heating_factor, thermal_loading
from lube.physics.regimes import asymptotic_gap, regime

log = logging.getLogger(__name__)


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
    chosen = [formula(name) for name in formulas]
    # "exact": coordinates that differ in one value would otherwise be cut to their intersection.
    with xr.set_options(arithmetic_join="exact", keep_attrs=False):
        contact = hertz_contact(rollers, force, speed)
        groups = FilmGroups.at(lubricant, rollers, force, contact, inlet_meniscus)
        table = contact.merge(_regime(groups), join="exact")
        table = table.merge(_film(chosen, rollers, groups, table), join="exact")
        heat = inlet_shear_heating, lubricant, contact, groups, slide_to_roll_ratio
        factor = _heating_factor(*heat)
        if inlet_shear_heating != "none":
            for name in ("film_thickness", "lambda_ratio"):
                table[name] = table[name] * factor
            _warn(factor)
        table["inlet_shear_heating_factor"] = factor
        is_answered = answered_lines is not None
        solved = groups.profiles() if with_shape or is_answered else None
        if with_shape:
            profile = over_positions(solved, FilmProfile.film_at, rollers, contact)
            table["film_profile"] = profile * rollers.reduced_radius
        if is_answered:
            if inlet_shear_heating != "none":
                solved = thinned(groups, solved, factor)
            responses = contact, xr.DataArray(slide_to_roll_ratio), answered_lines, threads
            table = table.merge(wave_responses(solved, *responses), compat="override", join="exact")
            # With slip the oil answers otherwise: each slip has a film of its own.
            for name in ("film_thickness", "lambda_ratio"):
                table[name] = table[name].broadcast_like(table["interpolation_error"])
                table[name] = table[name].isel(roller=0, drop=True)
    return table


def _heating_factor(model, lubricant, contact, groups, slip):
    loading = thermal_loading(
        lubricant["dynamic_viscosity"],
        lubricant["temperature_viscosity_coefficient"],
        contact["entrainment_speed"],
        lubricant["thermal_conductivity"],
    )
    pressure = contact["hertz_pressure"] / (2.0 * contact["reduced_modulus"])
    film = xr.apply_ufunc(asymptotic_gap, *groups.moes_numbers, join="exact")
    arguments = loading, slip, pressure, film
    return xr.apply_ufunc(partial(heating_factor, model), *arguments, join="exact")


def _warn(factor):
    unknown = int(factor.isnull().sum())
    if unknown:
        log.warning(
            "inlet_shear_heating: the film is not known at %d of %d conditions, where the heating "
            "is beyond the range of the formula",
            unknown,
            factor.size,
        )


@dataclass(frozen=True)
class FilmGroups:
    """What the film over R* depends on, at some operating points.

    Attributes
    ----------
    load, speed, material : xarray.DataArray
        W, U and G of `lube.physics.dimensionless`.
    viscosity : xarray.DataArray
        Viscosity of the oil at ambient pressure, Pa s.
    film_modulus : float or xarray.DataArray
        E' = 2 E*, Pa.
    meniscus : float or None
        Distance over R* at which the oil begins; None if the contact is fully flooded.
    """

    load: xr.DataArray
    speed: xr.DataArray
    material: xr.DataArray
    viscosity: xr.DataArray
    film_modulus: float | xr.DataArray
    meniscus: float | None

    @classmethod
    def at(
        cls, lubricant: xr.Dataset, rollers, force, contact: xr.Dataset, inlet_meniscus=None
    ) -> "FilmGroups":
        """Form the groups of an oil in the contact of `hertz_contact`; others as in `film_at`."""
        film_modulus = 2.0 * rollers.reduced_modulus
        scale = film_modulus, rollers.reduced_radius
        viscosity = lubricant["dynamic_viscosity"]
        alpha = lubricant["pressure_viscosity_coefficient"]
        return cls(
            dimensionless.dimensionless_load(force / rollers.length, *scale),
            dimensionless.dimensionless_speed(viscosity, contact["entrainment_speed"], *scale),
            dimensionless.dimensionless_material(alpha, film_modulus),
            viscosity,
            film_modulus,
            None if inlet_meniscus is None else inlet_meniscus / rollers.reduced_radius,
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
        known = "inlet_meniscus" in film
        meniscus = (film["inlet_meniscus"] / radius).item() if known else None
        oil = film["dynamic_viscosity"], 2.0 * film["reduced_modulus"]
        return cls(load, speed, material, *oil, meniscus)

    @property
    def moes_numbers(self) -> tuple[xr.DataArray, xr.DataArray]:
        """M and L."""
        return dimensionless.moes_numbers(self.load, self.speed, self.material)

    def film(self, row: Formula) -> xr.DataArray:
        """Film over R* by a film formula."""
        return self._applied(row.film)

    def profiles(self) -> xr.DataArray:
        """Solve for the profile of each film; None where it did not converge."""
        return self._applied(profiles_of)

    def _applied(self, function):
        groups = self.load, self.speed, self.material, self.viscosity, self.film_modulus
        options = {"join": "exact", "kwargs": {"meniscus": self.meniscus}}
        return xr.apply_ufunc(function, *groups, **options)


def hertz_contact(rollers, force: xr.DataArray, speed: xr.DataArray) -> xr.Dataset:
    """Contact without roughness and oil; arguments as in `film_at`."""
    pair = (rollers.length, rollers.reduced_radius, rollers.reduced_modulus)
    return xr.Dataset(
        {
            "reduced_radius": rollers.reduced_radius,
            "reduced_modulus": rollers.reduced_modulus,
            "composite_rms_roughness": rollers.composite_rms_roughness,
            "contact_half_width": hertz.contact_half_width(force, *pair),
            "hertz_pressure": hertz.maximum_pressure(force, *pair),
            "entrainment_speed": 2.0 * np.pi * rollers.first.radius * speed / 60.0,
        }
    )


def _regime(groups):
    moes_load, moes_material = groups.moes_numbers
    flag = xr.apply_ufunc(regime, moes_load, moes_material, join="exact")
    flag = flag.astype("int8")  # the type of its flag_values, as CF requires
    return xr.Dataset({"moes_load": moes_load, "moes_material": moes_material, "regime": flag})


def _film(formulas, rollers, groups, table):
    names = xr.DataArray([row.name for row in formulas], dims="film_formula", name="film_formula")

    def films(groups):
        of_formulas = [groups.film(row) for row in formulas]
        return xr.concat(of_formulas, dim=names, join="exact") * rollers.reduced_radius

    film, starved = films(groups), {}
    if groups.meniscus is not None:
        starved["starvation_factor"] = film / films(replace(groups, meniscus=None))
    valid = [row.holds(table["moes_load"], table["moes_material"]) for row in formulas]
    return xr.Dataset(
        {
            "film_thickness": film,
            "lambda_ratio": film / rollers.composite_rms_roughness,
            "in_validity_range": xr.concat(valid, dim=names, join="exact"),
            "formula_place": ("film_formula", [row.thickness for row in formulas]),
            "formula_source": ("film_formula", [row.source for row in formulas]),
            **starved,
        }
    )


def over_positions(solved: xr.DataArray, sample, rollers, contact: xr.Dataset) -> xr.DataArray:
    """Sample a quantity of every profile, over their dimensions and film_position."""
    half_width = float(contact["contact_half_width"].min())
    positions = film_positions(half_width, rollers.reduced_radius, rollers.composite_rms_roughness)
    values = sampled(solved.values, sample, positions)
    coordinates = solved.coords.merge({"film_position": positions}).coords
    return xr.DataArray(values, coordinates, (*solved.dims, "film_position"))
