"""The sensitivity stage: what the probability of breakthrough rests on."""

from functools import partial

import numpy as np
import xarray as xr

from lube.digits import six_digits
from lube.ehl.line_contact import one_blas_thread
from lube.schema import POINT_DIMS, label
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
    deviating = Deviating.of(study)
    factors = deviating.factors
    names = [*(factor.name for factor in factors), SEED]
    of_factor = [*(factor.group for factor in factors), SEED]
    sizes = [len(each) for each in deviating.levels.values()]

    with one_blas_thread():  # the number of threads would change the last digits
        predictor = Predictor.of(
            deviating, inputs["sensitivity_runs"], inputs.get("sensitivity_responses")
        )
        predicted = partial(predictor.log_probability, threads=threads)
        sampled = names, predicted, study.seed
        single, values = sobol(*sampled)
        grouped, _ = sobol(*sampled, of_factor)
        choices = {one.name: len(one.given.choices) for one in factors if one.name in CHOICES}
        choices[SEED] = SEEDS
        screened = morris(*sampled, choices)
    table = _limits(single, "factor") | _limits(grouped, "factor_group", "group_")
    table |= _limits(screened, "factor")
    with np.errstate(invalid="ignore"):
        lower, median, upper = np.exp(np.quantile(values, (BAND[0], 0.5, BAND[1]), axis=0))
    table |= {
        "log_probability_deviation": ((), values.std(axis=0)),
        "breakthrough_probability_median": ((), median),
        "breakthrough_probability_lower": ((), lower),
        "breakthrough_probability_upper": ((), upper),
    }
    found = {
        name: ((*dims, *POINT_DIMS), six_digits(each.reshape(*each.shape[:-1], *sizes)))
        for name, (dims, each) in table.items()
    }
    found |= predictor.errors(inputs["sensitivity_runs"], values.std(axis=0))
    given = [factor.given for factor in factors]
    found |= {
        "group_of_factor": ("factor", of_factor),
        "range_of_factor": ("factor", [*(one.in_words for one in given), "any"]),
        "source_of_factor": ("factor", [*(one.source for one in given), "the study's seed"]),
    }
    groups = list(dict.fromkeys(of_factor))
    coordinates = deviating.levels | {"factor": names, "factor_group": groups}
    return label(xr.Dataset(found, coordinates), "sensitivity")


def _limits(found, dim, prefix=""):
    """Values with their limits, and what has none, with their first dimension."""
    table = {}
    for name, values in found.items():
        if name.endswith("_error"):
            of, error = name.removesuffix("_error"), values
            table[f"{prefix}{of}_lower"] = (dim,), found[of] - error
            table[f"{prefix}{of}_upper"] = (dim,), found[of] + error
        else:
            table[f"{prefix}{name}"] = (dim,), values
    return table
