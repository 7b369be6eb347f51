"""The sensitivity_runs stage: probabilities for random values of what a study does not know."""

import numpy as np
import xarray as xr

from lube.digits import six_digits
from lube.schema import POINT_DIMS, label
from lube.sensitivity.conditions import Deviating
from lube.sensitivity.runs import SEEDS, Model, design, models, run, runs_of_batch
from lube.study.study import Study
from lube.types import Datasets


def make(study: Study, inputs: Datasets, threads: int = 1) -> xr.Dataset:
    """Make ``sensitivity_runs.nc``, one model after the other; see `lube.stages`."""
    batches = [batch.drop_attrs() for batch in inputs["batches"]]
    minimal = {"data_vars": "minimal", "coords": "minimal", "compat": "equals"}
    table = xr.concat(batches, "run", join="exact", **minimal)
    chosen = list(zip(*(table[name].values for name in Model._fields), strict=True))
    order = list(dict.fromkeys(chosen))  # the first batch has the first sample of each model
    number = [order.index(model) for model in chosen]
    return label(table.isel(run=np.argsort(number, kind="stable")), "sensitivity_runs")


def make_batch(study: Study, inputs: Datasets, number: int) -> xr.Dataset:
    """Make a batch of ``sensitivity_runs.nc``: part of the samples of all models.

    All runs draw the same random numbers.

    Parameters
    ----------
    study : Study
        The study.
    inputs : dict of str to xarray.Dataset
        With ``sensitivity_responses`` if the oil answers the roughness in some samples.
    number : int
        Number of the batch, from 0.

    Returns
    -------
    xarray.Dataset
        The ``sensitivity_runs_batch`` file of `lube.schema`.
    """
    deviating = Deviating.of(study)
    tables, responses = [], inputs.get("sensitivity_responses")
    for model in models(deviating):
        unit, points = design(deviating, model)
        own = runs_of_batch(unit, number)
        if own.size == 0:
            continue
        points = points.isel(run=own)
        found = run(deviating, model, unit[own], points, 1, responses)
        found = found.reset_coords(drop=True).drop_attrs()
        table = found.map(six_digits).merge(points)
        table["factor_quantile"] = ("run", "factor"), unit[own]
        for name, choice in model._asdict().items():
            table[name] = "run", np.full(own.size, choice)
        tables.append(table)
    table = xr.concat(tables, "run").set_coords(POINT_DIMS)
    factors = [factor.name for factor in deviating.factors]
    return label(table.assign_coords(factor=factors, seed=range(SEEDS)), "sensitivity_runs_batch")
