"""The surface response stage: how the oil changes waves that run at any angle to rolling."""

import xarray as xr

from lube.grid.films import answered_films
from lube.schema import FILES, label
from lube.study.study import Study
from lube.types import Datasets


def make(study: Study, inputs: Datasets, threads: int = 1) -> xr.Dataset:
    """Make ``surface_response.nc``; see `lube.stages`."""
    choices = study.inlet_model | {"answered_surfaces": study.line_spec, "threads": threads}
    table = answered_films(inputs["film"], inputs["lubricant"], study.rough_rollers, **choices)
    table = table.rename(response_position="film_position")
    variables = FILES["surface_response"]
    dims = variables["surface_response_real"].dims
    return label(table[list(variables)].drop_attrs().transpose(*dims), "surface_response")
