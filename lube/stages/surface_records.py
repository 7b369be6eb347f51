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
    experiment = inputs["experiment"]
    films = study_films_at_records(study, experiment)
    found = surfaces_at_records(study, experiment, films, inputs, threads)
    return label(found.assign_coords(record=experiment["record"].values), "surface_records")
