"""The indicators stage: what engineers look at, by its published formulas."""

import xarray as xr

from lube.grid.indicators import indicators
from lube.grid.operating_points import at_slip
from lube.schema import FILES, label
from lube.study.study import Study
from lube.types import Datasets


def make(study: Study, inputs: Datasets, threads: int = 1) -> xr.Dataset:
    """Make ``indicators.nc``; see `lube.stages`. With slip, the film is that nearest to rolling."""
    film = at_slip(inputs["film"]).assign(inputs["lubricant"][["dynamic_viscosity"]])
    found = indicators(film, inputs["film_profile"]["rolling_resistance"], study.rough_rollers)
    table = {name: found[name].transpose(*row.dims) for name, row in FILES["indicators"].items()}
    return label(xr.Dataset(table), "indicators")
