"""The film stage: film thickness, lambda ratio and regime at every operating point."""

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt
import xarray as xr

from lube import schema
from lube.ehl.film_formulas import formula
from lube.ehl.line_contact import FilmProfile
from lube.grid.film_profiles import film_positions, profiles_of, sampled
from lube.physics import dimensionless, hertz
from lube.physics.inlet_heating import inlet_shear_heating_factor
from lube.physics.regimes import regime
from lube.study.rollers import RollerPair


def film_table(
    lubricant: xr.Dataset,
    rollers: RollerPair,
    force: npt.ArrayLike,
    speed: npt.ArrayLike,
    formulas: Sequence[str],
    with_shape: bool = False,
) -> xr.Dataset:
    """Tabulate the film thickness of a pair of rollers over the operating grid.

    Parameters
    ----------
    lubricant : xarray.Dataset
        A ``lubricant`` dataset, with ``dynamic_viscosity`` (Pa s),
        ``pressure_viscosity_coefficient`` (1/Pa), ``temperature_viscosity_coefficient`` (1/K)
        and ``thermal_conductivity`` (W/(m K)) over lubricant and temperature.
    rollers : RollerPair
        Geometry, elasticity and roughness of the two rollers.
    force : array_like, shape (force,)
        Normal forces F_N, N.
    speed : array_like, shape (speed,)
        Rotation speeds n of the first roller in pure rolling, rpm. Slip leaves the entrainment
        speed as it is, so the film does not depend on it.
    formulas : sequence of str
        Names of film formulas, keys of `lube.ehl.film_formulas.FORMULAS`.
    with_shape : bool, optional
        Whether the film has the shape of the computed one; by default it is flat.

    Returns
    -------
    xarray.Dataset
        The ``film`` file of `lube.schema`. The film thickness is not reduced by inlet shear
        heating; the reduction factor is a variable of its own.

    Raises
    ------
    StudyError
        If a film formula is unknown.
    DataError
        If a dimension of the lubricant dataset has no coordinate.

    Examples
    --------
    >>> from lube import film_table, load_study, lubricant_table
    >>> study = load_study("workflow/config/paper.yaml")
    >>> oil = lubricant_table(study.lubricants, [40.0])
    >>> film = film_table(oil, study.rollers, [800.0], [100.0], ["paper"])
    >>> f"{1e6 * film.film_thickness.item():.3f} um"
    '1.070 um'
    >>> f"lambda ratio {film.lambda_ratio.item():.2f}"
    'lambda ratio 3.78'
    """
    axes = xr.Dataset(coords={"force": np.asarray(force, float), "speed": np.asarray(speed, float)})
    table = film_at(lubricant, rollers, axes["force"], axes["speed"], formulas, with_shape)
    return schema.label(table.transpose(*schema.OPERATING_DIMS, ...), "film")


def film_profile_table(
    lubricant: xr.Dataset, rollers: RollerPair, force: npt.ArrayLike, speed: npt.ArrayLike
) -> xr.Dataset:
    """Compute pressure and film across the contact at every operating point.

    Parameters
    ----------
    lubricant, rollers, force, speed
        As in `film_table`.

    Returns
    -------
    xarray.Dataset
        The ``film_profile`` file of `lube.schema`. Where the film did not converge, the values are
        NaN and the log says so.
    """
    axes = xr.Dataset(coords={"force": np.asarray(force, float), "speed": np.asarray(speed, float)})
    with xr.set_options(arithmetic_join="exact", keep_attrs=False):
        contact = _hertz_contact(rollers, axes["force"], axes["speed"])
        groups = _groups(lubricant, rollers, axes["force"], contact)
        solved = xr.apply_ufunc(profiles_of, *groups, join="exact").transpose(*schema.POINT_DIMS)
    table = contact[["contact_half_width", "hertz_pressure"]]
    table["film"] = _sampled(solved, FilmProfile.film_at, rollers, contact) * rollers.reduced_radius
    table["pressure"] = _sampled(solved, FilmProfile.pressure_at, rollers, contact)
    table["pressure"] = table["pressure"] * table["hertz_pressure"]
    for name, value in _NUMBERS.items():
        found = [float(f"{value(one):.6g}") if one else np.nan for one in solved.values.ravel()]
        table[name] = solved.copy(data=np.array(found).reshape(solved.shape))
    for name in ("central_film", "minimum_film"):
        table[name] = table[name] * rollers.reduced_radius
    return schema.label(table.transpose(*schema.POINT_DIMS, "film_position"), "film_profile")


def _sampled(solved, sample, rollers, contact):
    """Something of all film profiles, over their dimensions and film_position."""
    half_width = float(contact["contact_half_width"].min())
    positions = film_positions(half_width, rollers.reduced_radius, rollers.composite_rms_roughness)
    values = sampled(solved.values, sample, positions)
    coordinates = solved.coords.merge({"film_position": positions}).coords
    return xr.DataArray(values, coordinates, (*solved.dims, "film_position"))


_NUMBERS = {
    "central_film": lambda one: one.central_film,
    "minimum_film": lambda one: one.minimum_film,
    "film_end": lambda one: one.nodes[one.end],
    "mass_flux_defect": lambda one: float(f"{one.mass_flux_defect:.0e}"),
}
"""Numbers of a film profile by the names of their variables."""


def film_at_records(
    experiment: xr.Dataset,
    lubricant: xr.Dataset,
    rollers: RollerPair,
    formulas: Sequence[str],
    with_shape: bool = False,
) -> xr.Dataset:
    """Film thickness at the conditions of each record.

    Parameters
    ----------
    experiment : xarray.Dataset
        An ``experiment`` dataset.
    lubricant : xarray.Dataset
        A ``lubricant`` dataset at all temperatures of the records.
    rollers, formulas, with_shape
        As in `film_table`.

    Returns
    -------
    xarray.Dataset
        ``film_thickness``, ``lambda_ratio``, ``moes_load``, ``moes_material``,
        ``contact_half_width`` and ``dynamic_viscosity`` over film_formula and record;
        ``reduced_radius``, ``reduced_modulus`` and ``composite_rms_roughness``. If they have a
        shape, ``film_profile`` over record and film_position, and ``formula_place``.
    """
    force, speed, temperature, oil = (
        xr.DataArray(experiment[name].values, dims="record")
        for name in ("force", "speed", "temperature", "lubricant")
    )
    properties = lubricant.sel(lubricant=oil, temperature=temperature).reset_coords(drop=True)
    table = film_at(properties, rollers, force, speed, formulas, with_shape)
    table["dynamic_viscosity"] = properties["dynamic_viscosity"]
    names = ["film_thickness", "lambda_ratio", "moes_load", "moes_material", "contact_half_width"]
    names += ["reduced_radius", "reduced_modulus", "composite_rms_roughness", "dynamic_viscosity"]
    names += ["film_profile", "formula_place"] if with_shape else []
    return table[names].transpose("film_formula", "record", ...)


def film_at(
    lubricant: xr.Dataset,
    rollers: RollerPair,
    force: xr.DataArray,
    speed: xr.DataArray,
    formulas: Sequence[str],
    with_shape: bool = False,
) -> xr.Dataset:
    """Film thickness over the dimensions that the lubricant, force and speed have.

    Parameters
    ----------
    lubricant : xarray.Dataset
        As in `film_table`, over lubricant and temperature or over other dimensions.
    rollers : RollerPair
        Geometry, elasticity and roughness of the two rollers.
    force, speed : xarray.DataArray
        Normal force, N, and rotation speed of the first roller in pure rolling, rpm.
    formulas : sequence of str
        Names of film formulas.
    with_shape : bool, optional
        As in `film_table`.

    Returns
    -------
    xarray.Dataset
        The variables of the ``film`` file, without attributes.

    Raises
    ------
    StudyError
        If a film formula is unknown.
    """
    chosen = [formula(name) for name in formulas]
    # "exact": coordinates that differ in one value would otherwise be cut to their intersection.
    with xr.set_options(arithmetic_join="exact", keep_attrs=False):
        contact = _hertz_contact(rollers, force, speed)
        groups = _groups(lubricant, rollers, force, contact)
        table = contact.merge(_regime(*groups[:3]), join="exact")
        table = table.merge(_film(chosen, rollers, groups, table), join="exact")
        table["inlet_shear_heating_factor"] = inlet_shear_heating_factor(
            lubricant["dynamic_viscosity"],
            lubricant["temperature_viscosity_coefficient"],
            contact["entrainment_speed"],
            lubricant["thermal_conductivity"],
        )
        if with_shape:
            solved = xr.apply_ufunc(profiles_of, *groups, join="exact")
            profile = _sampled(solved, FilmProfile.film_at, rollers, contact)
            table["film_profile"] = profile * rollers.reduced_radius
    return table


def _hertz_contact(rollers, force, speed):
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


def _groups(lubricant, rollers, force, contact):
    """W, U and G of each operating point, with the oil's viscosity and E'."""
    film_modulus = 2.0 * rollers.reduced_modulus
    scale = film_modulus, rollers.reduced_radius
    viscosity, alpha = lubricant["dynamic_viscosity"], lubricant["pressure_viscosity_coefficient"]
    return (
        dimensionless.dimensionless_load(force / rollers.length, *scale),
        dimensionless.dimensionless_speed(viscosity, contact["entrainment_speed"], *scale),
        dimensionless.dimensionless_material(alpha, film_modulus),
        viscosity,
        film_modulus,
    )


def _regime(load, speed, material):
    moes_load, moes_material = dimensionless.moes_numbers(load, speed, material)
    flag = xr.apply_ufunc(regime, moes_load, moes_material, join="exact")
    flag = flag.astype("int8")  # the type of its flag_values, as CF requires
    return xr.Dataset({"moes_load": moes_load, "moes_material": moes_material, "regime": flag})


def _film(formulas, rollers, groups, table):
    names = xr.DataArray([row.name for row in formulas], dims="film_formula", name="film_formula")
    films = [xr.apply_ufunc(row.film, *groups, join="exact") for row in formulas]
    film = xr.concat(films, dim=names, join="exact") * rollers.reduced_radius
    valid = [row.holds(table["moes_load"], table["moes_material"]) for row in formulas]
    return xr.Dataset(
        {
            "film_thickness": film,
            "lambda_ratio": film / rollers.composite_rms_roughness,
            "in_validity_range": xr.concat(valid, dim=names, join="exact"),
            "formula_place": ("film_formula", [row.thickness for row in formulas]),
            "formula_source": ("film_formula", [row.source for row in formulas]),
        }
    )
