"""The film stage: film thickness, lambda ratio and regime at every operating point."""

import numpy as np
import xarray as xr

from lube import schema
from lube.physics import dimensionless, hertz
from lube.physics.film_formulas import formula
from lube.physics.inlet_heating import inlet_shear_heating_factor
from lube.physics.regimes import regime


def film_table(lubricant, rollers, force, speed, formulas):
    """Film thickness of a pair of rollers over the operating grid.

    Parameters
    ----------
    lubricant : xarray.Dataset
        Result of the lubricant stage, with ``dynamic_viscosity`` (Pa s),
        ``pressure_viscosity_coefficient`` (1/Pa) and ``temperature_viscosity_coefficient`` (1/K)
        along lubricant and temperature, ``thermal_conductivity`` (W/(m K)) along lubricant.
    rollers : lube.study.study.RollerPair
        Geometry, elasticity and roughness of the two rollers.
    force : array_like
        Normal forces F_N, shape (force,), N.
    speed : array_like
        Rotation speeds n of the first roller in pure rolling, shape (speed,), rpm. Slip shares
        the same entrainment speed out between the rollers, so the film does not depend on it.
    formulas : sequence of str
        Names of film formulas, keys of `lube.physics.film_formulas.FORMULAS`.

    Returns
    -------
    xarray.Dataset
        The file ``film`` of `lube.schema`; the film thickness is not reduced by inlet shear
        heating, whose factor stands beside it.

    Raises
    ------
    StudyError
        If a film formula is unknown.
    DataError
        If the result does not fit the schema, for want of a dimension or coordinate.
    """
    table = film_at(lubricant, rollers, _axis("force", force), _axis("speed", speed), formulas)
    return schema.label(table.transpose(*schema.OPERATING_DIMS), "film")


def film_at_records(experiment, lubricant, rollers, formulas):
    """Film thickness at the conditions of each record.

    Parameters
    ----------
    experiment : xarray.Dataset
        An ``experiment`` dataset.
    lubricant : xarray.Dataset
        Result of the lubricant stage, at all temperatures of the records.
    rollers, formulas
        As in `film_table`.

    Returns
    -------
    xarray.Dataset
        ``film_thickness``, ``lambda_ratio``, ``moes_load``, ``moes_material`` and
        ``contact_half_width`` over film_formula and record; ``reduced_radius`` and
        ``composite_rms_roughness``.
    """
    force, speed, temperature, oil = (
        xr.DataArray(experiment[name].values, dims="record")
        for name in ("force", "speed", "temperature", "lubricant")
    )
    here = lubricant.sel(lubricant=oil, temperature=temperature).reset_coords(drop=True)
    table = film_at(here, rollers, force, speed, formulas)
    names = ("film_thickness", "lambda_ratio", "moes_load", "moes_material", "contact_half_width")
    scales = ("reduced_radius", "composite_rms_roughness")
    return table[[*names, *scales]].transpose("film_formula", "record")


def film_at(lubricant, rollers, force, speed, formulas):
    """Film thickness and all that goes with it, over whatever dimensions its arguments have.

    Parameters
    ----------
    lubricant : xarray.Dataset
        As in `film_table`, or with a row of it for each record in place of its dimensions.
    rollers : lube.study.study.RollerPair
        Geometry, elasticity and roughness of the two rollers.
    force, speed : xarray.DataArray
        Normal force, N, and rotation speed of the first roller in pure rolling, rpm.
    formulas : sequence of str
        Names of film formulas.

    Returns
    -------
    xarray.Dataset
        The variables of the file ``film``, without labels.

    Raises
    ------
    StudyError
        If a film formula is unknown.
    """
    rows = [formula(name) for name in formulas]
    # Grids that differ in one value would otherwise be cut to their intersection.
    with xr.set_options(arithmetic_join="exact", keep_attrs=False):
        contact = _hertz_contact(rollers, force, speed)
        numbers = _dimensionless_groups(lubricant, rollers, force, contact)
        table = contact.merge(_regime(*numbers), join="exact")
        table = table.merge(_film(rows, rollers, numbers, table), join="exact")
        table["inlet_shear_heating_factor"] = _inlet_shear_heating(lubricant, contact)
    return table


def _axis(name, values):
    values = np.asarray(values, dtype=np.float64)
    return xr.DataArray(values, dims=name, coords={name: values})


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


def _dimensionless_groups(lubricant, rollers, force, contact):
    film_modulus = 2.0 * rollers.reduced_modulus
    scale = (film_modulus, rollers.reduced_radius)
    load = dimensionless.dimensionless_load(force / rollers.length, *scale)
    speed = dimensionless.dimensionless_speed(
        lubricant["dynamic_viscosity"], contact["entrainment_speed"], *scale
    )
    material = dimensionless.dimensionless_material(
        lubricant["pressure_viscosity_coefficient"], film_modulus
    )
    return load, speed, material


def _regime(load, speed, material):
    moes_load, moes_material = dimensionless.moes_numbers(load, speed, material)
    flag = xr.apply_ufunc(regime, moes_load, moes_material, join="exact")
    return xr.Dataset(
        {
            "moes_load": moes_load,
            "moes_material": moes_material,
            "regime": flag.astype("int8"),  # the type of its flag_values, as CF demands
        }
    )


def _film(rows, rollers, numbers, table):
    names = xr.DataArray([row.name for row in rows], dims="film_formula", name="film_formula")
    film = xr.concat([row.evaluate(*numbers) for row in rows], dim=names, join="exact")
    film = film * rollers.reduced_radius
    valid = [row.holds(table["moes_load"], table["moes_material"]) for row in rows]
    return xr.Dataset(
        {
            "film_thickness": film,
            "lambda_ratio": film / rollers.composite_rms_roughness,
            "in_validity_range": xr.concat(valid, dim=names, join="exact"),
            "formula_place": ("film_formula", [row.thickness for row in rows]),
            "formula_source": ("film_formula", [row.source for row in rows]),
        }
    )


def _inlet_shear_heating(lubricant, contact):
    return inlet_shear_heating_factor(
        lubricant["dynamic_viscosity"],
        lubricant["temperature_viscosity_coefficient"],
        contact["entrainment_speed"],
        lubricant["thermal_conductivity"],
    )
