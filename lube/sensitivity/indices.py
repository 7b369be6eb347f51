"""Sensitivity indices of the logarithm of the probability, by SALib.

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

import numpy as np
from SALib.analyze import morris as morris_analysis
from SALib.analyze import sobol as sobol_analysis
from SALib.sample import morris as morris_sample
from SALib.sample import sobol as sobol_sample

from lube.threads import on_threads
from lube.types import Array

BASE_SAMPLES = 1024
TRAJECTORIES = 200
"""Paths of Morris' design; each changes every factor once."""
LEVELS = 10
"""Levels of each factor in Morris' design."""
EVEN = 4096
"""Sizes of a factor from which its variance follows."""
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
    base_samples: int = BASE_SAMPLES,
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
    base_samples : int, optional
        Number of base samples, a power of 2.

    Returns
    -------
    indices : dict of str to numpy.ndarray
        ``first_order``, ``total_effect`` and the half-widths of their 95 % intervals,
        ``first_order_error`` and ``total_effect_error``, of shape (factors or groups, points);
        NaN where the film of a sample is not known, or nothing changes.
    values : numpy.ndarray
        Values of independent samples among them, shape (2 base samples, points).
    """
    problem = _problem(names, groups)
    design = partial(sobol_sample.sample, calc_second_order=False, seed=seed)
    values = predict(design(problem, base_samples))
    keys = {"first_order": "S1", "first_order_error": "S1_conf"}
    keys |= {"total_effect": "ST", "total_effect_error": "ST_conf"}
    # SALib takes a seed of 0 for none.
    options = {"calc_second_order": False, "num_resamples": RESAMPLES, "seed": seed + 1}
    sizes = len(dict.fromkeys(groups)) if groups else len(names)

    def of_point(column):
        if not np.isfinite(column).all() or np.ptp(column) == 0.0:
            return np.full((len(keys), sizes), np.nan)
        found = sobol_analysis.analyze(problem, column, **options)
        return np.array([found[key] for key in keys.values()])

    found = np.stack([of_point(column) for column in values.T], axis=-1)
    blocks = values.reshape(base_samples, -1, values.shape[1])
    return dict(zip(keys, found, strict=True)), np.concatenate([blocks[:, 0], blocks[:, -1]])


def morris(
    names: Sequence[str],
    predict: Callable[[Array], Array],
    seed: int,
    choices: Mapping[str, int] | None = None,
    sizes: Callable[[Array], Array] = np.asarray,
) -> dict[str, Array]:
    r"""Screen the factors by Morris' method.

    The levels of a factor are the middles of `LEVELS` equal parts of its distribution. A step leads
    half-way through them, or from one choice to any other.

    Parameters
    ----------
    names, predict, seed
        As in `sobol`.
    choices : mapping of str to int, optional
        Factors that are choices, with the number of each.
    sizes : callable, optional
        From samples to sizes of the factors, both of shape (samples, factors); by default the
        factors are uniformly distributed.

    Returns
    -------
    dict of str to numpy.ndarray
        Shape (factors, points): ``elementary_effect``, the mean of the absolute effects of two such
        steps, or from one choice to another; ``elementary_effect_error`` and
        ``elementary_effect_deviation``; and ``screened_deviation``, the standard deviation that the
        factor gives by itself to a function that changes by d with a step. It is
        :math:`\sqrt{\langle d^2 \rangle (1 - 1/k) / 2}` of a choice among k, else the standard
        deviation of the factor's size x times
        :math:`\sqrt{\langle d^2 \rangle / \langle \Delta x^2 \rangle}`.
    """
    problem = _problem(names)
    unit = morris_sample.sample(problem, TRAJECTORIES, num_levels=LEVELS, seed=seed)
    choices = choices or {}
    paths = _between_any_choices(unit, names, choices, seed)
    values = predict(paths)
    options = {"num_levels": LEVELS, "num_resamples": RESAMPLES, "seed": seed}
    # SALib divides each change by the step between its own levels.
    step = LEVELS / (2.0 * (LEVELS - 1.0))
    scale = step * np.array([1.0 if name in choices else 2.0 for name in names])
    parts = _variances(sizes, paths)
    for name, count in choices.items():
        parts[names.index(name)] = 0.5 - 0.5 / count

    def of_point(column):
        if not np.isfinite(column).all():
            return np.full((4, len(names)), np.nan)
        found = morris_analysis.analyze(problem, unit, column, **options)
        own = "mu", "mu_star", "mu_star_conf", "sigma"
        mean, absolute, error, deviation = (np.ma.filled(found[key], np.nan) for key in own)
        square = mean**2 + deviation**2 * (1.0 - 1.0 / TRAJECTORIES)
        effects = np.array([absolute, error, deviation], float) * scale
        return np.concatenate([effects, [np.sqrt(square * parts) * step]])

    found = np.stack(on_threads(of_point, values.T), axis=-1)
    keys = ("elementary_effect", "elementary_effect_error", "elementary_effect_deviation")
    return dict(zip((*keys, "screened_deviation"), found, strict=True))


def _between_any_choices(unit, names, choices, seed):
    """Paths through the middles of the levels, each of which changes a choice to any other."""
    paths = (np.rint((LEVELS - 1) * unit) + 0.5) / LEVELS
    paths = paths.reshape(TRAJECTORIES, -1, len(names))
    generator = np.random.default_rng(seed)
    for name, count in choices.items():
        ends = np.tile(np.arange(count), (TRAJECTORIES, 1))
        ends = generator.permuted(ends, axis=1)[:, :2]
        column = paths[..., names.index(name)]
        chosen = np.take_along_axis(ends, (column > 0.5).astype(int), axis=1)
        column[:] = (chosen + 0.5) / count
    return paths.reshape(unit.shape)


def _variances(sizes, paths):
    """Variance of each factor over the mean square of its steps along the paths."""
    factors = paths.shape[1]
    even = np.tile((np.arange(EVEN) + 0.5)[:, None] / EVEN, factors)
    steps = np.diff(sizes(paths).reshape(TRAJECTORIES, -1, factors), axis=1)
    return np.var(sizes(even), axis=0) * TRAJECTORIES / np.sum(steps**2, axis=(0, 1))
