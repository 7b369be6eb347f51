"""One pair of rollers: how far the contact share of its record scatters about the mean.

The confidence interval of an ensemble is that of the mean over pairs. A record comes from one
pair, and its share scatters about that mean with the variance s^2 between realisations, however
long it is: equal rollers without slip show the same roughness in every revolution. It scatters
less only if the two lines come into new alignments, by slip or unequal circumferences, or if the
roughness changes.
"""

import math
from collections.abc import Callable

import numpy as np
import scipy.special

from lube.statistics.confidence import CONFIDENCE
from lube.types import Array, Pair, Points, Ratios, Values


def quantile(realisations: int, among: int = 1) -> float:
    """Two-sided 95 % quantile for a scatter estimated from realisations.

    Parameters
    ----------
    realisations : int
        Number R of realisations. With one there is no scatter, and the quantile of the normal
        distribution is returned.
    among : int, optional
        Number of values that are compared with the quantile; in 95 of 100 cases none of them
        exceeds it (Bonferroni's bound).

    Returns
    -------
    float
        Student's t with R - 1 degrees of freedom.

    Examples
    --------
    >>> f"{quantile(8):.3f}", f"{quantile(1):.3f}"
    ('2.365', '1.960')
    """
    level = 1.0 - (1.0 - CONFIDENCE) / 2.0 / among
    if realisations < 2:
        return scipy.special.ndtri(level)
    return scipy.special.stdtrit(realisations - 1, level)


def repeat_factor(turns: Values) -> Values:
    r"""Variance of a share over several turns of one line, over that of one whole turn.

    In :math:`T = k + f` turns a fraction :math:`f` of the line passes :math:`k + 1` times and the
    rest :math:`k` times. Different sections of the line are taken as independent:

    .. math:: \frac{(k + 1)^2 f + k^2 (1 - f)}{T^2}

    The factor is 1/T below one turn, 1 for whole turns and nearly 1 for all longer records.

    Parameters
    ----------
    turns : float or numpy.ndarray
        Number of turns :math:`T`, above 0.

    Returns
    -------
    float or numpy.ndarray
        The factor.

    Examples
    --------
    >>> repeat_factor(np.array([0.5, 1.0, 1.5, 7.0])).round(3)
    array([2.   , 1.   , 1.111, 1.   ])
    """
    whole = np.floor(turns)
    part = turns - whole
    return ((whole + 1.0) ** 2 * part + whole**2 * (1.0 - part)) / turns**2


def distinct_alignments(turns: float, ratios: Ratios, points: Points, reach: float) -> float:
    """Count the alignments of two lines that have no roughness in common.

    Parameters
    ----------
    turns, ratios, points, reach
        As in `scatter_ratio`.

    Returns
    -------
    float
        Number of alignments, from 1, for equal rollers without slip, to the number of turns, which
        may be below 1.

    Examples
    --------
    Rollers of 1000 and 800 points meet again after four turns of the first:

    >>> distinct_alignments(100, (1.0, 1.0), (1000, 800), 40.0)
    4
    """
    faster = 0 if ratios[0] == 1.0 else 1
    # The other surface advances by so many points in each of these turns.
    shift, perimeter = round(points[faster] * ratios[1 - faster]), points[1 - faster]
    offsets = np.arange(math.ceil(turns)) * (shift % perimeter) % perimeter
    # Bins centred on the multiples of the reach, so that a return to the start is in the first.
    return min(np.unique((offsets + reach / 2.0) % perimeter // reach).size, turns)


def drift_factor(
    turns: float, drift: float, alike: Callable[[Array], Array] | None = None
) -> float:
    r"""Variance of a share over several turns while the roughness drifts, over that of one turn.

    Each turn renews the fraction `drift` of the variance of the heights, so heights :math:`k`
    turns apart have the correlation :math:`c^k`, and shares some correlation :math:`r(c^k)`:

    .. math::

        \frac{1}{T} \left( 1 + 2 \sum_{k=1}^{T-1} \left( 1 - \frac{k}{T} \right) r(c^k) \right),
        \qquad c^2 = 1 - \mathrm{drift}

    Shares are correlated no more than the heights from which they follow (Gebelein's inequality).
    So where r is not known, :math:`r(c) = c` gives an upper limit.

    Parameters
    ----------
    turns : float
        Number of turns :math:`T`, above 0.
    drift : float
        From 0 (the roughness stays the same) to 1 (it is new in each turn).
    alike : callable, optional
        Function r of the correlation of the heights; by default r(c) = c.

    Returns
    -------
    float
        The factor, at most one.

    References
    ----------
    H. Gebelein, Das statistische Problem der Korrelation als Variations- und Eigenwertproblem und
    sein Zusammenhang mit der Ausgleichsrechnung, Z. Angew. Math. Mech. 21 (1941) 364-379.

    Examples
    --------
    >>> [f"{drift_factor(4, drift):.3f}" for drift in (0.0, 0.1, 1.0)]
    ['1.000', '0.937', '0.250']
    """
    turns = max(turns, 1.0)
    lags = np.arange(1, math.ceil(turns))
    correlation = np.sqrt(1.0 - drift) ** lags
    correlation = correlation if alike is None else alike(correlation)
    return min((1.0 + 2.0 * np.sum((1.0 - lags / turns) * correlation)) / turns, 1.0)


def scatter_ratio(
    turns: float,
    ratios: Ratios,
    points: Points,
    reach: float,
    persistent: Pair,
    drift: float,
    known: float = 1.0,
    alike: Callable[[Array], Array] | None = None,
) -> float:
    r"""Variance of the share of one pair's record about the mean, over that of a known record.

    The share of one alignment differs between pairs of rollers by an effect of either line alone,
    which new alignments do not average out, and by a joint effect of the two lines, which is drawn
    anew with each alignment. For :math:`M` alignments:

    .. math:: s_M^2 = s_\infty^2 + \frac{s_1^2 - s_\infty^2}{M}

    Below the known record, of one revolution or more, both parts grow as 1 / turns. If the
    roughness drifts, a recurring alignment is less and less the same, and the scatter of its
    recurrences falls by `drift_factor`.

    Parameters
    ----------
    turns : float
        Revolutions of the roller with the faster surface in the record.
    ratios : tuple of float
        Surface speeds over that of the faster surface, `lube.grid.discretise.speed_ratios`.
    points : tuple of int
        Points around either roller.
    reach : float
        Distance of two alignments that have no roughness in common, points.
    persistent : tuple of float
        :math:`s_\infty^2 / s_1^2`, the part of the variance that new alignments do not average out,
        by either line. For equal rollers in pure rolling, which keep one alignment, it has no
        effect.
    drift : float
        As in `drift_factor`.
    known : float, optional
        Revolutions of the known record, whose variance is :math:`s_1^2`; without drift.
    alike : callable, optional
        As in `drift_factor`, for the joint effect of both lines. For the effects of either line
        alone the upper limit is taken.

    Returns
    -------
    float
        :math:`s^2` of the record over :math:`s_1^2`.

    Examples
    --------
    A slip of a tenth of the perimeter has ten alignments:

    >>> f"{scatter_ratio(20, (1.0, 0.9), (10_000, 10_000), 40.0, (0.1, 0.1), 0.0):.2f}"
    '0.28'
    """
    if turns <= known:
        return known / turns
    faster = 0 if ratios[0] == 1.0 else 1
    travel = points[faster] * np.array(ratios)

    def alone(turns):
        """Scatter by either line alone; a roller at rest shows the same points all the time."""
        turns_of_each = np.maximum(turns * travel, reach) / points
        return np.sum(persistent * repeat_factor(turns_of_each))

    def together(turns, drift):
        alignments = distinct_alignments(turns, ratios, points, reach)
        visits, renewed = turns / alignments, 1.0 - (1.0 - drift) ** alignments
        return repeat_factor(visits) / alignments * drift_factor(visits, renewed, alike)

    by_either = alone(known)
    later = alone(turns) / max(by_either, 1.0) * drift_factor(turns, drift)
    joint = together(turns, drift) / together(known, 0.0)
    return later + max(1.0 - by_either, 0.0) * joint


def prediction_limits(
    mean: Array,
    sample_size: Values,
    ratio: Values,
    realisations: int,
    noise: Values = 0.0,
    mean_error: Values = 1.0,
) -> Pair:
    r"""95 % prediction limits of the contact share of one pair's record.

    .. math:: p \pm t_{R-1} \sigma

    with the standard error :math:`\sigma` of `standard_error` and Student's quantile. The errors
    are taken as normal, and the limits are cut at 0 and 1.

    Parameters
    ----------
    mean : numpy.ndarray
        Mean probability :math:`p` over the realisations.
    sample_size : float or numpy.ndarray
        Effective sample size of one realisation, :math:`n = p (1 - p) / s^2`.
    ratio : float or numpy.ndarray
        :math:`v`, from `scatter_ratio`.
    realisations : int
        Number :math:`R` of realisations.
    noise : float or numpy.ndarray, optional
        Standard error of the record's share from causes other than the roughness, such as
        electrical noise.
    mean_error : float or numpy.ndarray, optional
        :math:`m`, variance of the mean over that of R independent realisations.

    Returns
    -------
    lower, upper : numpy.ndarray
        Within 0 and 1. Where all realisations are 0, or all are 1, the mean is replaced by its
        one-sided 95 % limit.

    Examples
    --------
    >>> lower, upper = prediction_limits(np.array([0.0, 0.3]), 100.0, 1.0, 64)
    >>> lower.round(4), upper.round(4)
    (array([0.    , 0.2077]), array([0.0048, 0.3923]))
    """
    never_met = 1.0 - (1.0 - CONFIDENCE) ** (1.0 / (sample_size * realisations))
    likely = np.clip(mean, never_met, 1.0 - never_met)
    likely = np.where((mean == 0.0) | (mean == 1.0), likely, mean)
    half = quantile(realisations) * standard_error(
        likely, sample_size, ratio, realisations, noise, mean_error
    )
    lower = np.where(mean == 0.0, 0.0, np.maximum(likely - half, 0.0))
    upper = np.where(mean == 1.0, 1.0, np.minimum(likely + half, 1.0))
    return lower, upper


def standard_error(
    mean: Values,
    sample_size: Values,
    ratio: Values,
    realisations: int,
    noise: Values = 0.0,
    mean_error: Values = 1.0,
) -> Array:
    r"""Calculate the standard error of one pair's share about the mean of the ensemble.

    .. math:: \sigma^2 = p (1 - p) \left( \frac{v}{n} + \frac{m}{n R} \right) + \epsilon^2

    The first term is the scatter of the record, the second the error of the mean over realisations.

    Parameters
    ----------
    mean, sample_size, ratio, realisations
        :math:`p`, :math:`n`, :math:`v` and :math:`R`, as in `prediction_limits`.
    noise : float or numpy.ndarray, optional
        :math:`\epsilon`, as in `prediction_limits`.
    mean_error : float or numpy.ndarray, optional
        :math:`m`, as in `prediction_limits`.

    Returns
    -------
    numpy.ndarray
        :math:`\sigma`; a record counts as one trial at least, :math:`n / v \ge 1`.

    Examples
    --------
    >>> float(standard_error(0.5, 25.0, 1.0, 10**9).round(6))
    0.1
    """
    of_record = np.maximum(sample_size / ratio, 1.0)
    variance = mean * (1.0 - mean) * (1.0 / of_record + mean_error / (sample_size * realisations))
    return np.sqrt(variance + np.square(noise))


def persistent_share(in_first: Array, in_second: Array) -> Array:
    """Part of one turn's scatter that new alignments do not average out, by either line.

    This part is the effect of either line alone, whatever line it is paired with. Each first line
    is paired with each second line, and the effects follow from the analysis of variance of two
    crossed factors. The effect of a line is taken from its whole turns.

    Parameters
    ----------
    in_first, in_second : numpy.ndarray
        Shape (R, K, P): contact shares of each of R first lines with each of K second lines, at
        each of P points, in whole turns of the first and of the second line. For equally long
        lines both arrays are the same.

    Returns
    -------
    numpy.ndarray
        Shape (2, P), s_inf^2 over s_1^2 in a turn of the first line; NaN where nothing scatters.

    Examples
    --------
    >>> first, second = np.array([0.1, 0.2, 0.4]), np.array([0.0, 0.3, 0.1])
    >>> shares = (first[:, None] + second)[..., None]
    >>> persistent_share(shares, shares).round(6)
    array([[0.5],
           [0.5]])
    """
    first, passing, together = _effects(in_first)
    _, second, _ = _effects(in_second)
    with np.errstate(invalid="ignore"):
        return np.array([first, second]) / (first + passing + together)


def _effects(shares):
    """Variances due to two crossed factors, each alone, and to their interaction, shape (P,)."""
    firsts, seconds = shares.shape[:2]
    together = np.sum(joint_effects(shares) ** 2, axis=(0, 1)) / ((firsts - 1) * (seconds - 1))
    of_first = shares.mean(axis=1).var(axis=0, ddof=1) - together / seconds
    of_second = shares.mean(axis=0).var(axis=0, ddof=1) - together / firsts
    return np.clip(of_first, 0.0, None), np.clip(of_second, 0.0, None), together


def joint_effects(shares: Array) -> Array:
    """Effects of pairs of lines beyond those of each line alone.

    Parameters
    ----------
    shares : numpy.ndarray
        Shape (R, K, P), of first lines with second lines at some points.

    Returns
    -------
    numpy.ndarray
        Same shape; zero on average over the first lines, and over the second.
    """
    first, second = (shares.mean(axis=axis, keepdims=True) for axis in (1, 0))
    return shares - first - second + shares.mean(axis=(0, 1))
