"""The lubricant stage: properties of every oil at the temperatures of the study."""

import xarray as xr

from lube.study.oil_properties import lubricant_table
from lube.study.study import Study
from lube.types import Datasets


def make(study: Study, inputs: Datasets, threads: int = 1) -> xr.Dataset:
    """Make ``lubricant.nc``; see `lube.stages`."""
    return lubricant_table(study.lubricants, study.operating_grid.temperature)
