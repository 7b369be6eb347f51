"""Samples of uncertain quantities: from numbers between 0 and 1 to deviations and choices."""

from collections.abc import Sequence

import numpy as np
import scipy.special
import xarray as xr
from scipy.stats import qmc

from lube.study.uncertainty import CHOICES, FARTHEST, Factor
from lube.types import Array

SEED = "seed"
"""Name of the factor that stands for the random numbers of the lines."""


def quantiles(count: int, factors: int, seed: int) -> Array:
    """Draw samples that fill the space of the factors evenly (Sobol' points).

    Parameters
    ----------
    count : int
        Number of samples, a power of 2.
    factors : int
        Number of factors.
    seed : int
        Seed of the study.

    Returns
    -------
    numpy.ndarray
        Shape (samples, factors), numbers from 0 to 1.
    """
    return qmc.Sobol(factors, seed=np.random.default_rng(seed)).random(count)


def deviations(factors: Sequence[Factor], unit: Array) -> dict[str, Array]:
    """Find the value of each factor in some samples.

    Parameters
    ----------
    factors : sequence of Factor
        Factors of a study.
    unit : numpy.ndarray
        Numbers from 0 to 1, shape (samples, factors): the probability of a smaller value.

    Returns
    -------
    dict of str to numpy.ndarray
        Deviation, or value, of each quantity in the unit of its range; of a choice its number.
        Shape (samples,) each.

    Examples
    --------
    >>> from lube.study.uncertainty import Uncertainty
    >>> section = {"force": {"range": "+- 2 %", "source": "assumed"}}
    >>> factors = Uncertainty.model_validate(section).factors()
    >>> deviations(factors, np.array([[0.0], [1.0]]))["force"].tolist()
    [-0.02, 0.02]
    """
    columns = zip(factors, np.transpose(unit), strict=True)
    return {factor.name: _at(factor, column) for factor, column in columns}


def over_run(values: dict[str, Array]) -> dict[str, xr.DataArray]:
    """Label deviations from `deviations`, one for each run."""
    return {name: xr.DataArray(column, dims="run") for name, column in values.items()}


def _at(factor, unit):
    given = factor.given
    if factor.name in CHOICES:
        return np.minimum((unit * len(given.choices)).astype(int), len(given.choices) - 1)
    lower, upper = given.range
    if given.distribution == "uniform":
        return lower + (upper - lower) * unit
    # 95 % of a normal distribution lie within 1.96 standard deviations.
    normal = np.clip(scipy.special.ndtri(unit) / scipy.special.ndtri(0.975), -FARTHEST, FARTHEST)
    return 0.5 * (lower + upper) + 0.5 * (upper - lower) * normal
