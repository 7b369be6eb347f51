"""The surface records stage: contact of the surfaces at the conditions of measured records."""

import xarray as xr

from lube.inference.at_records import study_films_at_records
from lube.inference.surface_records import surfaces_at_records
from lube.schema import label
from lube.study.study import Study
from lube.types import Datasets


def make(study: Study, inputs: Datasets, threads: int = 1) -> xr.Dataset:
    """Make ``surface_records.nc``; see `lube.stages`.

    Parameters
    ----------
    study, inputs, threads
        As in `lube.stages`.

    Returns
    -------
    xarray.Dataset
        The ``surface_records`` file of `lube.schema`, by
        `lube.inference.surface_records.surfaces_at_records`.
    """
    films = study_films_at_records(study, inputs["experiment"])
    return label(surfaces_at_records(study, films, inputs, threads), "surface_records")
