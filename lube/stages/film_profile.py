"""The film profile stage: pressure and film across the contact at every operating point."""

import numpy as np
import numpy.typing as npt
import xarray as xr

from lube.ehl.line_contact import FilmProfile
from lube.grid.film_profiles import over_positions
from lube.grid.films import FilmGroups, hertz_contact
from lube.schema import POINT_DIMS, label
from lube.study.rollers import RollerPair
from lube.study.study import Study
from lube.types import Datasets

_NUMBERS = {
    "central_film": lambda one: one.central_film,
    "minimum_film": lambda one: one.minimum_film,
    "film_end": lambda one: one.film_end,
    "mass_flux_defect": lambda one: float(f"{one.mass_flux_defect:.0e}"),
}
"""Numbers of a film profile by the names of their variables."""


def make(study: Study, inputs: Datasets, threads: int = 1) -> xr.Dataset:
    """Make ``film_profile.nc``; see `lube.stages`."""
    grid, meniscus = study.operating_grid, study.film_model["inlet_meniscus"]
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
        The ``film_profile`` file of `lube.schema`. Where the film did not converge, the values are
        NaN and the log says so.
    """
    axes = xr.Dataset(coords={"force": np.asarray(force, float), "speed": np.asarray(speed, float)})
    with xr.set_options(arithmetic_join="exact", keep_attrs=False):
        contact = hertz_contact(rollers, axes["force"], axes["speed"])
        groups = FilmGroups.at(lubricant, rollers, axes["force"], contact, inlet_meniscus)
        solved = groups.profiles.transpose(*POINT_DIMS)
    table = contact[["contact_half_width", "hertz_pressure"]]
    table["film"] = over_positions(solved, FilmProfile.film_at, contact) * rollers.reduced_radius
    table["pressure"] = over_positions(solved, FilmProfile.pressure_at, contact)
    table["pressure"] = table["pressure"] * table["hertz_pressure"]
    for name, value in _NUMBERS.items():
        found = [float(f"{value(one):.6g}") if one else np.nan for one in solved.values.ravel()]
        table[name] = solved.copy(data=np.array(found).reshape(solved.shape))
    for name in ("central_film", "minimum_film"):
        table[name] = table[name] * rollers.reduced_radius
    return label(table.transpose(*POINT_DIMS, "film_position"), "film_profile")
