"""The film response stage: how the oil changes waves of the roughness, by Reynolds' equation."""

import numpy as np
import xarray as xr

from lube.grid.film_responses import VARIABLES
from lube.grid.films import answered_films
from lube.schema import FILES, label
from lube.study.line_spec import LineSpec
from lube.study.rollers import RollerPair
from lube.study.study import Study
from lube.types import Datasets


def make(study: Study, inputs: Datasets, threads: int = 1) -> xr.Dataset:
    """Make ``film_response.nc``; see `lube.stages`."""
    oil, film, rollers = inputs["lubricant"], inputs["film"], study.rough_rollers
    if study.answered_lines is not None:
        return _as_file(film)  # it has the responses already
    choices = study.inlet_model | {"threads": threads}
    return film_responses(oil, film, rollers, study.line_spec, **choices)


def film_responses(
    lubricant: xr.Dataset,
    film: xr.Dataset,
    rollers: RollerPair,
    spec: LineSpec,
    inlet_shear_heating: str = "none",
    inlet_meniscus: float | None = None,
    threads: int = 1,
) -> xr.Dataset:
    """Compute the linear response of the film to waves of the roughness of either roller.

    Parameters
    ----------
    lubricant, rollers, inlet_shear_heating, inlet_meniscus
        As in `lube.stages.film.film_table`.
    film : xarray.Dataset
        A ``film`` dataset of these oils and rollers.
    spec : LineSpec
        The roughness lines, for whose waves the response is computed.
    threads : int, optional
        Threads that share the work; they do not change the results.

    Returns
    -------
    xarray.Dataset
        The ``film_response`` file of `lube.schema`, by `lube.grid.film_responses.wave_responses`.
        Where the film did not converge, the response is NaN and the log says so.
    """
    inlet = {"inlet_shear_heating": inlet_shear_heating, "inlet_meniscus": inlet_meniscus}
    choices = inlet | {"answered_lines": spec, "threads": threads}
    return _as_file(answered_films(film, lubricant, rollers, **choices))


def _as_file(film):
    """Responses of a film table, as they are stored."""
    table = film[[*VARIABLES, "contact_half_width"]].rename(response_position="film_position")
    central = table.sel(film_position=0.0, drop=True)
    table["amplitude_ratio"] = np.abs(central["response_real"] + 1j * central["response_imaginary"])
    dims = FILES["film_response"]["response_real"].dims
    return label(table.drop_attrs().transpose(*dims), "film_response")
