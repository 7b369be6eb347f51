"""The sensitivity_runs stage: probabilities for random values of what a study does not know."""

import numpy as np
import xarray as xr

from lube.grid.film_profiles import six_digits
from lube.schema import POINT_DIMS, label
from lube.sensitivity.conditions import Deviating
from lube.sensitivity.runs import SEEDS, design, models, run
from lube.study.study import Study
from lube.types import Datasets


def make(study: Study, inputs: Datasets, threads: int = 1) -> xr.Dataset:
    """Make ``sensitivity_runs.nc``; see `lube.stages`. All runs draw the same random numbers."""
    deviating = Deviating.of(study)
    tables = []
    for model in models(deviating):
        unit, points = design(deviating, model)
        found = run(deviating, model, unit, points, threads)
        found = found.reset_coords(drop=True).drop_attrs()
        table = found.map(six_digits).merge(points)
        table["factor_quantile"] = ("run", "factor"), unit
        for name, choice in model._asdict().items():
            table[name] = "run", np.full(len(unit), choice)
        tables.append(table)
    table = xr.concat(tables, "run").set_coords(POINT_DIMS)
    factors = [factor.name for factor in deviating.factors]
    return label(table.assign_coords(factor=factors, seed=range(SEEDS)), "sensitivity_runs")
