"""Limits of a probability, from the independent looks at it or, for want of scatter, from windows.

Both the realisations of an ensemble and the stretches of a record scatter about a share of
time. Either scatter amounts to a number of independent looks, and from there on they are
treated alike, so that the intervals of simulation and experiment mean the same.
"""

import numpy as np
import scipy.special

CONFIDENCE = 0.95


def mean_over_first(values):
    """Mean over the first axis, its terms added one after the other.

    NumPy's own sum pairs the terms by the array's shape and memory layout, and so the last digit
    of one column depends on the columns beside it. Here it does not, and one operating point
    made again by itself has the bits that it had among many.

    Parameters
    ----------
    values : numpy.ndarray
        Shape (R, ...).

    Returns
    -------
    numpy.ndarray
        Shape (...).
    """
    total = np.zeros(values.shape[1:])
    for row in values:
        total = total + row
    return total / len(values)


def score_interval(mean, looks, quantile):
    """Wilson's score interval of a probability.

    Parameters
    ----------
    mean : numpy.ndarray
        Estimated probability.
    looks : numpy.ndarray
        Number of independent looks behind it.
    quantile : float
        Two-sided quantile: 1.96 for 95 % and many realisations, Student's t for few.

    Returns
    -------
    lower, upper : numpy.ndarray
        Limits within 0 and 1 that enclose `mean`.

    References
    ----------
    E. B. Wilson, Probable inference, the law of succession, and statistical inference,
    J. Am. Stat. Assoc. 22 (1927) 209-212.
    """
    # Products, not powers: NumPy may round the power of a single number otherwise than of many.
    square = quantile * quantile
    shrink = 1.0 + square / looks
    centre = (mean + square / (2.0 * looks)) / shrink
    variance = mean * (1.0 - mean) / looks + square / (4.0 * looks * looks)
    half = quantile * np.sqrt(variance) / shrink
    return np.maximum(centre - half, 0.0), np.minimum(centre + half, 1.0)


def probability_limits(mean, looks, degrees, windows):
    """Limits of the 95 % interval of a probability, which never is a point.

    Where contact was seen never, or always, or the scatter is unknown, `windows` stands in for
    the number of looks. Never seen then means a one-sided upper limit, 1 - 0.05^(1/n), the
    exact binomial one for n windows without contact. No upper limit is below this one, nor a
    lower one above its mirror image: what was seen often and evenly says nothing of what is
    rare and was not met so far.

    Parameters
    ----------
    mean : numpy.ndarray
        Estimated probability, shape (...).
    looks : numpy.ndarray
        Number of independent looks that the scatter amounts to, shape (...); NaN where there
        is no scatter to tell.
    degrees : numpy.ndarray or int
        Degrees of freedom of that scatter, broadcastable to shape (...).
    windows : numpy.ndarray or float
        Independent windows behind the estimate, broadcastable to shape (...).

    Returns
    -------
    lower, upper : numpy.ndarray
        Shape (...) each, within 0 and 1.
    """
    windows = np.broadcast_to(windows, np.shape(mean)).astype(float)
    scattered = ~np.isnan(looks)
    student = scipy.special.stdtrit(degrees, 0.5 + CONFIDENCE / 2.0)
    normal = scipy.special.ndtri(0.5 + CONFIDENCE / 2.0)
    lower, upper = score_interval(
        mean, np.where(scattered, looks, windows), np.where(scattered, student, normal)
    )
    bound = 1.0 - (1.0 - CONFIDENCE) ** (1.0 / windows)
    lower = np.select(
        [mean == 0.0, mean == 1.0], [0.0, 1.0 - bound], np.minimum(lower, 1.0 - bound)
    )
    upper = np.select([mean == 0.0, mean == 1.0], [bound, 1.0], np.maximum(upper, bound))
    return lower, upper


def effective_sample_size(probabilities):
    """Count the independent looks that the scatter between realisations amounts to.

    Parameters
    ----------
    probabilities : numpy.ndarray
        Shape (R, ...), one probability for each realisation.

    Returns
    -------
    numpy.ndarray
        Shape (...): p (1 - p) / (s^2 / R), infinite where there is no scatter, NaN for a
        single realisation.
    """
    mean = mean_over_first(probabilities)
    realisations = probabilities.shape[0]
    if realisations == 1:
        return np.full(mean.shape, np.nan)
    offsets = probabilities - mean
    with np.errstate(divide="ignore", invalid="ignore"):
        return mean * (1.0 - mean) * (realisations - 1) / mean_over_first(offsets * offsets)


def probability_interval(probabilities, windows):
    """Mean over realisations and its 95 % interval.

    With one realisation the scatter is unknown, and what it has of independent windows stands
    in for it, as where contact was seen never or always (`probability_limits`): so many windows
    that share no roughness fit into one revolution. They also bound the limits, since segments
    cut by the window's edges break for a few steps in every realisation: their small scatter
    says nothing of the whole segments, rare and seen for the whole passage, not met so far.

    Parameters
    ----------
    probabilities : numpy.ndarray
        Shape (R, ...), one probability for each realisation.
    windows : numpy.ndarray
        Independent windows in one realisation, broadcastable to shape (...).

    Returns
    -------
    mean, lower, upper : numpy.ndarray
        Shape (...) each.
    """
    realisations = probabilities.shape[0]
    mean = mean_over_first(probabilities)
    # Asked of the values themselves: the variance of equal ones need not round to zero.
    scattered = np.ptp(probabilities, axis=0) > 0.0
    looks = np.where(scattered, effective_sample_size(probabilities), np.nan)
    lower, upper = probability_limits(mean, looks, max(realisations - 1, 1), windows * realisations)
    return mean, lower, upper
