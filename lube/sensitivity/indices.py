"""Sensitivity indices of the logarithm of the probability, with the samples of SALib.

References
----------
A. Saltelli and others, Variance based sensitivity analysis of model output, Comput. Phys. Commun.
181 (2010) 259-270.
M. D. Morris, Factorial sampling plans for preliminary computational experiments, Technometrics 33
(1991) 161-174.
T. Iwanaga, W. Usher and J. Herman, Toward SALib 2.0, SESMO 4 (2022) 18155.
"""

from collections.abc import Callable, Mapping, Sequence
from functools import partial
from itertools import permutations

import numpy as np
from SALib.analyze import sobol as sobol_analysis
from SALib.sample import morris as morris_sample
from SALib.sample import sobol as sobol_sample

from lube.schema import values_with_limits
from lube.types import Array

BASE_SAMPLES = 1024
"""Base samples of Sobol' indices, a power of 2."""
TRAJECTORIES = 760
"""Paths of Morris' design; each changes every factor once. Twice the pairs of `LEVELS`."""
LEVELS = 20
"""Levels of each factor in Morris' design."""
RESAMPLES = 100
"""Samples drawn anew for the intervals."""


def _problem(names, groups=None):
    found = {"num_vars": len(names), "names": list(names), "bounds": [[0.0, 1.0]] * len(names)}
    return found | ({"groups": list(groups)} if groups else {})


def sobol(
    names: Sequence[str],
    predict: Callable[[Array], Array],
    seed: int,
    groups: Sequence[str] | None = None,
) -> tuple[dict[str, Array], Array]:
    """Compute Sobol' indices of all operating points.

    Parameters
    ----------
    names : sequence of str
        Names of the factors.
    predict : callable
        From samples, numbers from 0 to 1 of shape (samples, factors), to shape (samples, points).
    seed : int
        Seed of the samples and of the intervals.
    groups : sequence of str, optional
        Group of each factor; the indices are then those of groups, in the order of their names'
        first use.

    Returns
    -------
    indices : dict of str to numpy.ndarray
        ``first_order`` and ``total_effect``, with the limits ``_lower`` and ``_upper`` of their
        95 % intervals, of shape (factors or groups, points); NaN where the film of a sample is not
        known, or nothing changes.
    values : numpy.ndarray
        Values of independent samples among them, shape (2 `BASE_SAMPLES`, points).
    """
    problem = _problem(names, groups)
    design = partial(sobol_sample.sample, calc_second_order=False, seed=seed)
    values = predict(design(problem, BASE_SAMPLES))
    keys = "S1", "S1_conf", "ST", "ST_conf"
    # SALib takes a seed of 0 for none.
    options = {"calc_second_order": False, "num_resamples": RESAMPLES, "seed": seed + 1}
    sizes = len(dict.fromkeys(groups)) if groups else len(names)

    def of_point(column):
        if not np.isfinite(column).all() or np.ptp(column) == 0.0:
            return np.full((len(keys), sizes), np.nan)
        found = sobol_analysis.analyze(problem, column, **options)
        return np.array([found[key] for key in keys])

    first, error, total, total_error = np.stack([of_point(one) for one in values.T], axis=-1)
    found = _with_limits("first_order", first, error)
    found |= _with_limits("total_effect", total, total_error)
    blocks = values.reshape(BASE_SAMPLES, -1, values.shape[1])
    return found, np.concatenate([blocks[:, 0], blocks[:, -1]])


def _with_limits(name, value, error):
    return values_with_limits(name, (value, value - error, value + error))


def morris(
    names: Sequence[str], predict: Callable[[Array], Array], seed: int, choices: Mapping[str, int]
) -> dict[str, Array]:
    r"""Screen the factors by Morris' method.

    The levels of a factor are the middles of `LEVELS` equal parts of its distribution. A step leads
    from any of them to any other, so that the mean square of the changes d tells what the factor
    does to the variance, however it acts.

    Parameters
    ----------
    names, predict, seed
        As in `sobol`.
    choices : mapping of str to int
        Factors that are choices, with the number of each.

    Returns
    -------
    dict of str to numpy.ndarray
        Shape (factors, points): ``elementary_effect``, the mean of the absolute changes, each over
        the part of the distribution that its step leads through, or from one choice to another,
        with ``_lower`` and ``_upper``; ``elementary_effect_deviation``; and
        ``screened_deviation``, :math:`\sqrt{\langle d^2 \rangle (1 - 1/k) / 2}` with k levels: the
        standard deviation that the factor causes while all others stay as they are. NaN where the
        film of a sample is not known.
    """
    counts = np.array([choices.get(name, LEVELS) for name in names])
    ends = morris_sample.sample(_problem(names), TRAJECTORIES, num_levels=2, seed=seed).astype(int)
    ends = ends.reshape(TRAJECTORIES, -1, len(names))
    generator = np.random.default_rng(seed)
    levels = np.stack([_pairs_of_levels(count, generator) for count in counts], axis=-1)
    paths = (np.take_along_axis(levels, ends, axis=1) + 0.5) / counts
    values = predict(paths.reshape(-1, len(names))).reshape(*paths.shape[:2], -1)
    values[..., ~np.isfinite(values).all(axis=(0, 1))] = np.nan
    # Each step changes one factor.
    steps = np.diff(paths, axis=1)
    order = np.argsort(np.abs(steps).argmax(axis=2), axis=1)
    steps = np.take_along_axis(steps.sum(axis=2), order, axis=1)
    changes = np.take_along_axis(np.diff(values, axis=1), order[..., None], axis=1)
    steps[:, [name in choices for name in names]] = 1.0
    effects = changes / steps[..., None]
    size = np.abs(effects)
    part = (0.5 - 0.5 / counts)[:, None]
    error = 1.96 * size.std(axis=0, ddof=1) / np.sqrt(TRAJECTORIES)
    return {
        **_with_limits("elementary_effect", size.mean(axis=0), error),
        "elementary_effect_deviation": effects.std(axis=0, ddof=1),
        "screened_deviation": np.sqrt(part * np.mean(changes**2, axis=0)),
    }


def _pairs_of_levels(count, generator):
    """Draw the ends of the steps of a factor, all pairs of its levels equally often."""
    pairs = generator.permutation(list(permutations(range(count), 2)))
    return generator.permutation(np.resize(pairs, (TRAJECTORIES, 2)))
