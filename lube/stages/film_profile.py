"""The film profile stage: pressure and film across the contact at every operating point."""

import numpy as np
import numpy.typing as npt
import xarray as xr

from lube.digits import rounded
from lube.ehl.line_contact import FilmProfile
from lube.grid.film_profiles import film_positions, over_positions
from lube.grid.films import FilmGroups, hertz_contact
from lube.schema import POINT_DIMS, label
from lube.study.rollers import RollerPair
from lube.study.study import Study
from lube.types import Datasets

_DIGITS = dict.fromkeys(("central_film", "minimum_film", "film_end"), 6)
_DIGITS |= {"rolling_resistance": 5, "mass_flux_defect": 1}
"""Numbers of a film profile that become variables, and how many of their digits are kept."""


def make(study: Study, inputs: Datasets, threads: int = 1) -> xr.Dataset:
    """Make ``film_profile.nc``; see `lube.stages`."""
    grid, meniscus = study.operating_grid, study.inlet_model["inlet_meniscus"]
    rollers = study.rough_rollers
    return film_profile_table(inputs["lubricant"], rollers, grid.force, grid.speed, meniscus)


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
        As in `lube.stages.film.film_table`.

    Returns
    -------
    xarray.Dataset
        The ``film_profile`` file of `lube.schema`. Its positions reach as far as the pressure does
        and as far as roughness may touch. Where the film did not converge, the values are
        NaN and the log says so.
    """
    axes = xr.Dataset(coords={"force": np.asarray(force, float), "speed": np.asarray(speed, float)})
    with xr.set_options(arithmetic_join="exact", keep_attrs=False):
        contact = hertz_contact(rollers, axes["force"], axes["speed"])
        groups = FilmGroups.at(lubricant, rollers, axes["force"], contact, inlet_meniscus)
        solved = groups.profiles.transpose(*POINT_DIMS)
    table = contact[["contact_half_width", "hertz_pressure"]]
    positions = film_positions(contact, reach=groups.of_profiles("pressure_reach").max().item())
    film = over_positions(solved, FilmProfile.film_at, positions)
    pressure = over_positions(solved, FilmProfile.pressure_at, positions)
    table["film"] = film * rollers.reduced_radius
    table["pressure"] = pressure * table["hertz_pressure"]
    for name, digits in _DIGITS.items():
        table[name] = xr.apply_ufunc(rounded, groups.of_profiles(name), kwargs={"digits": digits})
    for name in ("central_film", "minimum_film"):
        table[name] = table[name] * rollers.reduced_radius
    table["rolling_resistance"] *= 2.0 * rollers.reduced_modulus * rollers.reduced_radius
    return label(table.transpose(*POINT_DIMS, "film_position"), "film_profile")
