"""The film stage: film thickness, lambda ratio and regime at every operating point."""

import logging
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

log = logging.getLogger(__name__)


def film_table(
    lubricant: xr.Dataset,
    rollers: RollerPair,
    force: npt.ArrayLike,
    speed: npt.ArrayLike,
    formulas: Sequence[str],
    with_shape: bool = False,
    slide_to_roll_ratio: npt.ArrayLike = (0.0,),
    inlet_shear_heating: str = "none",
    inlet_meniscus: float | None = None,
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
        speed as it is, so the film depends on it by inlet shear heating alone.
    formulas : sequence of str
        Names of film formulas, keys of `lube.ehl.film_formulas.FORMULAS`.
    with_shape : bool, optional
        Whether the film has the shape of the computed one; by default it is flat.
    slide_to_roll_ratio : array_like, shape (slide_to_roll_ratio,), optional
        Levels of the slide-to-roll ratio; the default is pure rolling.
    inlet_shear_heating : str, optional
        One of `lube.physics.inlet_heating.INLET_HEATING`; by default the film is not reduced. The
        factor is a variable of the result in any case.
    inlet_meniscus : float, optional
        Distance before the line of centres at which the oil begins, m; by default the contact is
        fully flooded.

    Returns
    -------
    xarray.Dataset
        The ``film`` file of `lube.schema`. With inlet shear heating the film thickness depends on
        slip; it is NaN, and the log says so, where there is no factor.

    Raises
    ------
    StudyError
        If a film formula is unknown.
    DataError
        If a dimension of the lubricant dataset has no coordinate.
    RangeError
        If the meniscus lies inside a contact.

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
    levels = {"force": force, "speed": speed, "slide_to_roll_ratio": slide_to_roll_ratio}
    axes = xr.Dataset(coords={name: np.asarray(each, float) for name, each in levels.items()})
    slip = axes["slide_to_roll_ratio"]
    options = with_shape, slip, inlet_shear_heating, inlet_meniscus
    table = film_at(lubricant, rollers, axes["force"], axes["speed"], formulas, *options)
    return schema.label(table.transpose(*schema.CONTACT_DIMS, ...), "film")


def film_profile_table(
    lubricant: xr.Dataset,
    rollers: RollerPair,
    force: npt.ArrayLike,
    speed: npt.ArrayLike,
    inlet_meniscus: float | None = None,
) -> xr.Dataset:
    """Compute pressure and film across the contact at every operating point.

    Parameters
    ----------
    lubricant, rollers, force, speed, inlet_meniscus
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
        solved = _profiles(groups, rollers, inlet_meniscus).transpose(*schema.POINT_DIMS)
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
    inlet_shear_heating: str = "none",
    inlet_meniscus: float | None = None,
) -> xr.Dataset:
    """Film thickness at the conditions of each record.

    Parameters
    ----------
    experiment : xarray.Dataset
        An ``experiment`` dataset.
    lubricant : xarray.Dataset
        A ``lubricant`` dataset at all temperatures of the records.
    rollers, formulas, with_shape, inlet_shear_heating, inlet_meniscus
        As in `film_table`; the slip is that of each record.

    Returns
    -------
    xarray.Dataset
        ``film_thickness``, ``lambda_ratio``, ``moes_load``, ``moes_material``,
        ``contact_half_width`` and ``dynamic_viscosity`` over film_formula and record;
        ``reduced_radius``, ``reduced_modulus`` and ``composite_rms_roughness``. If they have a
        shape, ``film_profile`` over record and film_position, and ``formula_place``. With inlet
        shear heating its factor over record, and with a meniscus its distance.
    """
    force, speed, temperature, oil, slip = (
        xr.DataArray(experiment[name].values, dims="record")
        for name in ("force", "speed", "temperature", "lubricant", "slide_to_roll_ratio")
    )
    properties = lubricant.sel(lubricant=oil, temperature=temperature).reset_coords(drop=True)
    options = with_shape, slip, inlet_shear_heating, inlet_meniscus
    table = film_at(properties, rollers, force, speed, formulas, *options)
    table["dynamic_viscosity"] = properties["dynamic_viscosity"]
    names = ["film_thickness", "lambda_ratio", "moes_load", "moes_material", "contact_half_width"]
    names += ["reduced_radius", "reduced_modulus", "composite_rms_roughness", "dynamic_viscosity"]
    names += ["film_profile", "formula_place"] if with_shape else []
    if inlet_shear_heating != "none":
        names.append("inlet_shear_heating_factor")
    if inlet_meniscus is not None:
        names.append("inlet_meniscus")
        table["inlet_meniscus"] = inlet_meniscus
    return table[names].transpose("film_formula", "record", ...)


def film_at(
    lubricant: xr.Dataset,
    rollers: RollerPair,
    force: xr.DataArray,
    speed: xr.DataArray,
    formulas: Sequence[str],
    with_shape: bool = False,
    slide_to_roll_ratio: xr.DataArray | float = 0.0,
    inlet_shear_heating: str = "none",
    inlet_meniscus: float | None = None,
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
    slide_to_roll_ratio : xarray.DataArray or float, optional
        Slide-to-roll ratio.
    with_shape, inlet_shear_heating, inlet_meniscus
        As in `film_table`.

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
        contact = _hertz_contact(rollers, force, speed)
        groups = _groups(lubricant, rollers, force, contact)
        table = contact.merge(_regime(*groups[:3]), join="exact")
        table = table.merge(_film(chosen, rollers, groups, table, inlet_meniscus), join="exact")
        factor = _heating_factor(lubricant, contact, slide_to_roll_ratio)
        if inlet_shear_heating != "none":
            for name in ("film_thickness", "lambda_ratio"):
                table[name] = table[name] * factor
            _warn(factor)
        table["inlet_shear_heating_factor"] = factor
        if with_shape:
            solved = _profiles(groups, rollers, inlet_meniscus)
            profile = _sampled(solved, FilmProfile.film_at, rollers, contact)
            table["film_profile"] = profile * rollers.reduced_radius
    return table


def _heating_factor(lubricant, contact, slide_to_roll_ratio):
    film_modulus = 2.0 * contact["reduced_modulus"]
    return xr.apply_ufunc(
        inlet_shear_heating_factor,
        lubricant["dynamic_viscosity"],
        lubricant["temperature_viscosity_coefficient"],
        contact["entrainment_speed"],
        lubricant["thermal_conductivity"],
        contact["hertz_pressure"] / film_modulus,
        slide_to_roll_ratio,
        join="exact",
    )


def _warn(factor):
    unknown = int(factor.isnull().sum())
    if unknown:
        log.warning(
            "inlet_shear_heating: the film is not known at %d of %d conditions, where the heating "
            "is beyond the range of the formula",
            unknown,
            factor.size,
        )


def _profiles(groups, rollers, inlet_meniscus):
    """Film profile of each operating point."""
    meniscus = {"meniscus": _over_radius(inlet_meniscus, rollers)}
    return xr.apply_ufunc(profiles_of, *groups, join="exact", kwargs=meniscus)


def _over_radius(inlet_meniscus, rollers):
    return None if inlet_meniscus is None else inlet_meniscus / rollers.reduced_radius


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


def _film(formulas, rollers, groups, table, inlet_meniscus):
    names = xr.DataArray([row.name for row in formulas], dims="film_formula", name="film_formula")
    meniscus = _over_radius(inlet_meniscus, rollers)

    def films(meniscus):
        options = {"join": "exact", "kwargs": {"meniscus": meniscus}}
        of_formulas = [xr.apply_ufunc(row.film, *groups, **options) for row in formulas]
        return xr.concat(of_formulas, dim=names, join="exact") * rollers.reduced_radius

    film = films(meniscus)
    starved = {} if meniscus is None else {"starvation_factor": film / films(None)}
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
