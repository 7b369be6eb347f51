"""The sensitivity stage: what the probability of breakthrough rests on."""

from functools import partial

import numpy as np
import xarray as xr

from lube.digits import six_digits
from lube.ehl.line_contact import one_blas_thread
from lube.schema import LIMITS, label, values_with_limits, with_dims
from lube.sensitivity.conditions import Deviating
from lube.sensitivity.indices import morris, sobol
from lube.sensitivity.predictor import BAND, Predictor
from lube.sensitivity.runs import SEEDS
from lube.sensitivity.samples import SEED
from lube.study.study import Study
from lube.study.uncertainty import CHOICES
from lube.types import Datasets


def make(study: Study, inputs: Datasets, threads: int = 1) -> xr.Dataset:
    """Make ``sensitivity.nc``; see `lube.stages`.

    The indices are those of the logarithm of the probability of breakthrough, whose values come
    from surrogates that are fitted to ``sensitivity_runs.nc``. The seed of the random numbers is a
    factor, too: what it does is noise, and smaller indices than its own mean nothing.
    """
    deviating, runs = Deviating.of(study), inputs["sensitivity_runs"]
    factors = deviating.factors
    names = [*(factor.name for factor in factors), SEED]
    of_factor = [*(factor.group for factor in factors), SEED]
    sizes = [len(each) for each in deviating.levels.values()]

    with one_blas_thread():  # the number of threads would change the last digits
        predictor = Predictor.of(deviating, runs, inputs.get("sensitivity_responses"))
        predicted = partial(predictor.log_probability, threads=threads)
        single, values = sobol(names, predicted, study.seed)
        grouped, _ = sobol(names, predicted, study.seed, of_factor)
        choices = {one.name: len(one.given.choices) for one in factors if one.name in CHOICES}
        choices[SEED] = SEEDS
        screened = morris(names, predicted, study.seed, choices)
    table = single | {f"group_{name}": each for name, each in grouped.items()} | screened
    table["log_probability_deviation"] = values.std(axis=0)
    with np.errstate(invalid="ignore"):
        band = np.exp(np.quantile(values, (0.5, *BAND), axis=0))
    table |= values_with_limits("breakthrough_probability", band, names=("_median", *LIMITS[1:]))
    found = {name: six_digits(one.reshape(*one.shape[:-1], *sizes)) for name, one in table.items()}
    found |= predictor.errors(runs, values.std(axis=0))
    given = [factor.given for factor in factors]
    found |= {
        "group_of_factor": of_factor,
        "range_of_factor": [*(one.in_words for one in given), "any"],
        "source_of_factor": [*(one.source for one in given), "the study's seed"],
    }
    groups = list(dict.fromkeys(of_factor))
    coordinates = deviating.levels | {"factor": names, "factor_group": groups}
    return label(xr.Dataset(with_dims("sensitivity", found), coordinates), "sensitivity")
