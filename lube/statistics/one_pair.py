"""One pair of rollers: how far the share of its record may lie from the mean over all pairs.

An ensemble's interval is that of the mean over pairs. A record comes from one pair, and its
share scatters about that mean with the variance s^2 between realisations, however long it is:
equal rollers without slip show the same roughness each revolution. Only new alignments of the
two lines, by slip or unequal circumferences, and a roughness that changes make it scatter less.
"""

import math

import numpy as np
import scipy.special

CONFIDENCE = 0.95

MOST_TURNS = 100_000
"""Turns in which alignments are counted, and drift; longer records are taken as so long."""


def quantile(realisations, among=1):
    """Two-sided 95 % quantile for a scatter that so many realisations tell.

    Parameters
    ----------
    realisations : int
        Number R; with one there is no scatter, and the normal distribution stands in.
    among : int, optional
        Values of which, 95 times out of 100, none is to exceed it (Bonferroni's bound).

    Returns
    -------
    float
        Student's t of R - 1 degrees of freedom.
    """
    level = 1.0 - (1.0 - CONFIDENCE) / 2.0 / among
    if realisations < 2:
        return scipy.special.ndtri(level)
    return scipy.special.stdtrit(realisations - 1, level)


def repeat_factor(turns):
    """Variance of a share over some turns of one line, over that of one whole turn.

    Of T = k + f turns a fraction f of the line is seen k + 1 times and the rest k times, so
    that the factor is ((k + 1)^2 f + k^2 (1 - f)) / T^2: 1/T below one turn, one for whole
    turns, and nearly one for all longer records. Stretches of the line count as independent.

    Parameters
    ----------
    turns : float or numpy.ndarray
        T, above 0.

    Returns
    -------
    float or numpy.ndarray
        The factor.
    """
    whole = np.floor(turns)
    part = turns - whole
    return ((whole + 1.0) ** 2 * part + whole**2 * (1.0 - part)) / turns**2


def distinct_alignments(turns, shift, perimeter, reach):
    """Count the alignments of two lines that share no roughness, within some turns.

    Parameters
    ----------
    turns : float
        Turns of the roller with the faster surface.
    shift : int
        Points by which the other line moves past it in each turn.
    perimeter : int
        Points around the other roller.
    reach : float
        Points that two alignments must be apart to share no roughness.

    Returns
    -------
    int
        At least one: rollers that repeat themselves have one alignment for ever.
    """
    offsets = np.arange(math.ceil(min(turns, MOST_TURNS))) * (shift % perimeter) % perimeter
    # Bins about the multiples of the reach, so that a return to the start is in the first.
    return np.unique((offsets + reach / 2.0) % perimeter // reach).size


def drift_factor(turns, drift):
    """Variance of a share over some turns of rollers whose roughness drifts, over one turn's.

    Each turn renews the share `drift` of the variance of the heights, so that heights k turns
    apart have the correlation c^k with c^2 = 1 - drift. Shares are correlated no more than the
    heights they follow from (Gebelein's inequality), which bounds the variance of their mean
    by that of a first-order autoregressive series.

    Parameters
    ----------
    turns : float
        T, above 0.
    drift : float
        From 0 (the roughness stays) to 1 (another each turn).

    Returns
    -------
    float
        At most one.

    References
    ----------
    H. Gebelein, Das statistische Problem der Korrelation als Variations- und
    Eigenwertproblem, Z. Angew. Math. Mech. 21 (1941) 364-379.
    """
    turns = min(max(turns, 1.0), MOST_TURNS)  # the variance does not grow with more of them
    lags = np.arange(1, math.ceil(turns))
    correlation = np.sqrt(1.0 - drift) ** lags
    return min((1.0 + 2.0 * np.sum((1.0 - lags / turns) * correlation)) / turns, 1.0)


def scatter_ratio(turns, ratios, points, reach, persistent=0.0, drift=0.0):
    """Variance of the share of one pair's record about the mean, over that of one revolution.

    The share of one alignment varies from pair to pair by what either line alone does, which
    no new alignment averages out, and by what the two do together, which each new one draws
    again: s^2(M) = s_inf^2 + (s_1^2 - s_inf^2) / M for M alignments. Below one revolution both
    grow as 1 / turns. Where the roughness drifts, an alignment that comes again is less and less
    the same, and the scatter of its visits falls as `drift_factor` says.

    Parameters
    ----------
    turns : float
        Revolutions of the roller with the faster surface in the record.
    ratios : tuple of float
        Surface speeds over the faster one's, from `lube.grid.discretise.speed_ratios`.
    points : tuple of int
        Points around either roller.
    reach : float
        Points that two alignments must be apart to share no roughness.
    persistent : float, optional
        s_inf^2 / s_1^2, what no alignment averages out; it does not matter for equal rollers
        in rolling, which have one alignment.
    drift : float, optional
        As in `drift_factor`.

    Returns
    -------
    float
        s^2 of the record over s_1^2.
    """
    if turns <= 1.0:
        return 1.0 / turns
    faster = 0 if ratios[0] == 1.0 else 1
    travel = points[faster] * np.array(ratios)
    weights = 1.0 / np.array(points) / np.sum(1.0 / np.array(points))

    def alone(turns):
        """Scatter by either line alone; a roller at rest shows one place for ever."""
        of_each = np.maximum(turns * travel, reach) / points
        return np.sum(weights * repeat_factor(of_each))

    shift = round(travel[1 - faster])
    alignments = min(distinct_alignments(turns, shift, points[1 - faster], reach), turns)
    visits, renewed = turns / alignments, 1.0 - (1.0 - drift) ** alignments
    together = repeat_factor(visits) / alignments * drift_factor(visits, renewed)
    by_either = min(persistent * alone(1.0), 1.0)
    later = alone(turns) / alone(1.0) * drift_factor(turns, drift)
    return by_either * later + (1.0 - by_either) * together


def prediction_limits(mean, looks, ratio, realisations, noise=0.0):
    """Limits within which the share of one pair's record lies, 95 times out of 100.

    The share scatters about the mean over pairs with the variance s^2 v of one pair's record,
    and that mean is known to s^2 / R from R realisations. The errors are taken as normal, with
    Student's quantile for few realisations, and shares end at 0 and 1.

    Parameters
    ----------
    mean : numpy.ndarray
        Mean probability p over the realisations.
    looks : numpy.ndarray
        Effective sample size of one realisation, p (1 - p) / s^2.
    ratio : numpy.ndarray
        v, from `scatter_ratio`.
    realisations : int
        R.
    noise : numpy.ndarray, optional
        Standard error of the record's share by what is not its roughness: electrical noise.

    Returns
    -------
    lower, upper : numpy.ndarray
        Within 0 and 1. Where all realisations agree on 0 or 1, the mean is taken as far from
        it as they allow, at 95 % one-sided.
    """
    never_met = 1.0 - (1.0 - CONFIDENCE) ** (1.0 / (looks * realisations))
    likely = np.clip(mean, never_met, 1.0 - never_met)
    likely = np.where((mean == 0.0) | (mean == 1.0), likely, mean)
    half = quantile(realisations) * standard_error(likely, looks, ratio, realisations, noise)
    lower = np.where(mean == 0.0, 0.0, np.maximum(likely - half, 0.0))
    upper = np.where(mean == 1.0, 1.0, np.minimum(likely + half, 1.0))
    return lower, upper


def standard_error(mean, looks, ratio, realisations, noise=0.0):
    """Take the standard error of one pair's share about the ensemble's mean.

    Parameters
    ----------
    mean, looks, ratio, realisations, noise
        As in `prediction_limits`.

    Returns
    -------
    numpy.ndarray
        (p (1 - p) (v / n + 1 / (n R)) + noise^2)^(1/2).
    """
    here = np.maximum(looks / ratio, 1.0)  # a record is at least one look
    variance = mean * (1.0 - mean) * (1.0 / here + 1.0 / (looks * realisations))
    return np.sqrt(variance + np.square(noise))


def persistent_share(probabilities):
    """Share of one alignment's scatter that no number of alignments averages out.

    It is what either line does whatever it meets. Each first line is paired with each second
    one, so that both their parts follow from the analysis of variance of two crossed factors:
    twice as many degrees of freedom as there are pairs of lines.

    Parameters
    ----------
    probabilities : numpy.ndarray
        Shape (R, K, P): of each of R first lines with each of K second ones, at each point.

    Returns
    -------
    numpy.ndarray
        Shape (P,), s_inf^2 / s_1^2, from 0 to 1; NaN where nothing scatters.
    """
    firsts, seconds = probabilities.shape[:2]
    first, second = (probabilities.mean(axis=axis, keepdims=True) for axis in (1, 0))
    rest = probabilities - first - second + probabilities.mean(axis=(0, 1))
    together = np.sum(rest**2, axis=(0, 1)) / ((firsts - 1) * (seconds - 1))
    alone = np.clip(first.var(axis=(0, 1), ddof=1) - together / seconds, 0.0, None)
    alone += np.clip(second.var(axis=(0, 1), ddof=1) - together / firsts, 0.0, None)
    with np.errstate(invalid="ignore"):
        return alone / (alone + together)


def sample_size(probabilities, windows):
    """Effective sample size of one realisation, by the scatter between realisations.

    Parameters
    ----------
    probabilities : numpy.ndarray
        Shape (R, ...), of each realisation.
    windows : numpy.ndarray or float
        Windows of one realisation that share no roughness, which stand in where nothing
        scatters; broadcastable to shape (...).

    Returns
    -------
    numpy.ndarray
        Shape (...), p (1 - p) / s^2.
    """
    windows = np.broadcast_to(windows, probabilities.shape[1:]).astype(float)
    if probabilities.shape[0] == 1:
        return windows
    mean, variance = probabilities.mean(axis=0), probabilities.var(axis=0, ddof=1)
    # Asked of the values themselves: the variance of equal ones need not round to zero.
    scattered = np.ptp(probabilities, axis=0) > 0.0
    return np.where(scattered, mean * (1.0 - mean) / np.where(scattered, variance, 1.0), windows)


def independent_windows(dataset, width):
    """Windows of one realisation that share no roughness: they are a longest wavelength apart.

    Parameters
    ----------
    dataset : xarray.Dataset
        With the attributes ``travel`` and ``longest_wavelength``, m.
    width : float or numpy.ndarray
        Contact width, m.

    Returns
    -------
    float or numpy.ndarray
        At least one.
    """
    reach = width + dataset.attrs["longest_wavelength"]
    return np.maximum(dataset.attrs["travel"] / reach, 1.0)
