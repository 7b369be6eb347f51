"""Confidence intervals of a probability, from its effective sample size.

The realisations of an ensemble and the blocks of a record both scatter about a share of time.
Either scatter is equivalent to a number of independent trials, the effective sample size. From
there on both are treated alike, so that the intervals of simulation and experiment mean the same.
Without scatter, the number of independent windows is used instead.
"""

from collections.abc import Callable, Sequence

import numpy as np
import scipy.special

from lube.types import Array, Pair, Values

CONFIDENCE = 0.95
"""Confidence level of all intervals."""


def mean_over_first(values: Array) -> Array:
    """Mean over the first axis, with the terms added one after the other.

    NumPy's own sum pairs the terms by the array's shape and memory layout, so the last digit of
    one column depends on the other columns. With Python's it does not, and one operating point
    computed by itself is bit-identical to the same point computed among others.

    Parameters
    ----------
    values : numpy.ndarray
        Shape (R, ...).

    Returns
    -------
    numpy.ndarray
        Shape (...).

    Examples
    --------
    >>> mean_over_first(np.array([[1.0, 2.0], [3.0, 6.0]]))
    array([2., 4.])
    """
    return sum(values) / len(values)


def error_of_limits(limits: Sequence[Array]) -> Array:
    """Find the standard error of a probability of contact of surfaces.

    Parameters
    ----------
    limits : sequence of numpy.ndarray
        The probability, its lower and its upper 95 % limit, as from
        `lube.contact.surface_strip.surface_contact`: by the same factor of -log(1 - P) to either
        side, or 0 and an upper limit.

    Returns
    -------
    numpy.ndarray
        Of their shape.

    Examples
    --------
    >>> rare_and_frequent = np.array([[0.02, 0.9], [0.01, 0.8], [0.04, 0.95]])
    >>> error_of_limits(rare_and_frequent).round(3)
    array([0.007, 0.041])
    """
    mean, lower, upper = (-np.log1p(-np.minimum(limit, 1.0 - 1e-12)) for limit in limits)
    seen, rare = mean > 0.0, mean < 0.5
    factor = np.where(rare, upper, mean) / np.where(seen, np.where(rare, mean, lower), 1.0)
    return 0.5 * np.exp(-mean) * np.where(seen, mean * np.log(np.where(seen, factor, 1.0)), upper)


def mean_or_nan(values: Array) -> float:
    """Mean; NaN if there are no values."""
    return np.mean(values) if values.size else np.nan


def score_interval(mean: Values, sample_size: Values, quantile: Values) -> Pair:
    r"""Wilson's score interval of a probability.

    .. math::

        \frac{1}{1 + z^2/n} \left( p + \frac{z^2}{2n}
        \pm z \sqrt{\frac{p (1 - p)}{n} + \frac{z^2}{4 n^2}} \right)

    Parameters
    ----------
    mean : float or numpy.ndarray
        Estimated probability :math:`p`.
    sample_size : float or numpy.ndarray
        Effective sample size :math:`n` of the estimate.
    quantile : float or numpy.ndarray
        Two-sided quantile :math:`z`: 1.96 for 95 % and many realisations, Student's t for few.

    Returns
    -------
    lower, upper : numpy.ndarray
        Limits within 0 and 1 that enclose `mean`.

    References
    ----------
    E. B. Wilson, Probable inference, the law of succession, and statistical inference,
    J. Am. Stat. Assoc. 22 (1927) 209-212.

    Examples
    --------
    >>> [f"{limit:.3f}" for limit in score_interval(0.1, 100, 1.96)]
    ['0.055', '0.174']
    """
    # Products, not powers: NumPy may round the power of a single number otherwise than of many.
    square = quantile * quantile
    shrink = 1.0 + square / sample_size
    centre = (mean + square / (2.0 * sample_size)) / shrink
    variance = mean * (1.0 - mean) / sample_size + square / (4.0 * sample_size * sample_size)
    half = quantile * np.sqrt(variance) / shrink
    return np.maximum(centre - half, 0.0), np.minimum(centre + half, 1.0)


def probability_limits(mean: Array, sample_size: Values, degrees: Values, windows: Values) -> Pair:
    r"""Limits of the 95 % confidence interval of a probability; they never coincide.

    The limits are Wilson's, with Student's quantile. Where the scatter is unknown, `windows` takes
    the place of the effective sample size. If contact was never seen, the upper limit is the
    exact one-sided binomial one for :math:`n_w` windows without contact,

    .. math:: 1 - 0.05^{1/n_w} ,

    and if it was always seen, the lower limit is one minus this bound. No upper limit is below the
    bound and no lower limit above one minus it, because frequent and evenly spread events say
    nothing about rare ones that have not occurred so far.

    Parameters
    ----------
    mean : numpy.ndarray
        Estimated probability, shape (...).
    sample_size : float or numpy.ndarray
        Effective sample size of the estimate, shape (...); NaN where there is no scatter.
    degrees : int or numpy.ndarray
        Degrees of freedom of that scatter, broadcastable to shape (...).
    windows : float or numpy.ndarray
        Number :math:`n_w` of independent windows in all, broadcastable to shape (...).

    Returns
    -------
    lower, upper : numpy.ndarray
        Shape (...) each, within 0 and 1.

    Examples
    --------
    >>> lower, upper = probability_limits(np.array([0.0, 0.1]), np.array([np.nan, 100.0]), 63, 500)
    >>> lower.round(3), upper.round(3)
    (array([0.   , 0.055]), array([0.006, 0.176]))
    """
    windows = np.broadcast_to(windows, np.shape(mean)).astype(float)
    scattered = ~np.isnan(sample_size)
    student = scipy.special.stdtrit(degrees, 0.5 + CONFIDENCE / 2.0)
    normal = scipy.special.ndtri(0.5 + CONFIDENCE / 2.0)
    quantile = np.where(scattered, student, normal)
    lower, upper = score_interval(mean, np.where(scattered, sample_size, windows), quantile)
    bound = _unseen_limit(windows)
    one_sided = [mean == 0.0, mean == 1.0]
    lower = np.select(one_sided, [0.0, 1.0 - bound], np.minimum(lower, 1.0 - bound))
    upper = np.select(one_sided, [bound, 1.0], np.maximum(upper, bound))
    return lower, upper


def _unseen_limit(windows):
    """Upper limit of the probability of what none of some independent windows shows."""
    return 1.0 - (1.0 - CONFIDENCE) ** (1.0 / windows)


def breakthrough_limit(upper: Values, contact: Values, sampled: Values) -> Values:
    """Upper limit of breakthrough, also where no or few of the sampled contacts have one.

    Parameters
    ----------
    upper : float or numpy.ndarray
        Upper limit by the scatter, which is 0 without any, and says little of a few.
    contact : float or numpy.ndarray
        Upper limit of the probability of geometric contact, or of the number of contacts.
    sampled : int or numpy.ndarray of int
        Number of sampled contacts.

    Returns
    -------
    numpy.ndarray
        `upper`, but at least `contact` times the limit of what none of so many contacts shows.

    Examples
    --------
    >>> breakthrough_limit(np.array([0.0, 0.2]), np.array([0.1, 0.4]), 1000).round(4)
    array([0.0003, 0.2   ])
    """
    return np.maximum(upper, contact * _unseen_limit(sampled))


def ratio_interval(values: Array, reference: Array) -> tuple[Array, Array, Array]:
    """Ratio of two means over the same lines, and its 95 % confidence interval.

    Where one value is large for a pair of lines, the other is large too. So the ratio is better
    known than either mean.

    Parameters
    ----------
    values, reference : numpy.ndarray
        Shapes (R, ...), which broadcast: one value for each pair of lines.

    Returns
    -------
    ratio, lower, upper : numpy.ndarray
        Shape (...) each; NaN where a mean is zero, except that the ratio may be zero.

    Examples
    --------
    >>> values = np.array([0.2, 0.3, 0.4])
    >>> limits = ratio_interval(2.0 * values, values)
    >>> [f"{limit:.3f}" for limit in limits]
    ['2.000', '2.000', '2.000']
    """
    means = values.mean(axis=0), reference.mean(axis=0)
    with np.errstate(divide="ignore", invalid="ignore"):
        _, _, upper = mean_interval(1.0 + values / means[0] - reference / means[1])
        ratio = np.where(means[1] > 0.0, means[0] / means[1], np.nan)
        half = upper - 1.0  # of the logarithm
    return ratio, ratio * np.exp(-half), ratio * np.exp(half)


def probability_interval(probabilities: Array, windows: Values) -> tuple[Array, Array, Array]:
    r"""Mean over realisations and its 95 % confidence interval.

    The effective sample size of the mean is

    .. math:: R\, n = \frac{p (1 - p)}{s^2 / R}

    with :math:`n` of `lube.statistics.sample_size.effective_sample_size`. Where realisations do
    not scatter, or where there is only one, their independent windows take its place. The windows
    also bound the limits (`probability_limits`), because segments cut by the window's edges break
    for a few time steps in every realisation: their small scatter says nothing about uncut
    segments, which are rare, break throughout their passage and may not have occurred so far.

    Parameters
    ----------
    probabilities : numpy.ndarray
        Shape (R, ...), one probability for each realisation.
    windows : float or numpy.ndarray
        Independent windows in one realisation, broadcastable to shape (...).

    Returns
    -------
    mean, lower, upper : numpy.ndarray
        Shape (...) each.

    Examples
    --------
    >>> limits = probability_interval(np.array([0.28, 0.31, 0.30, 0.29]), 500.0)
    >>> [f"{limit:.3f}" for limit in limits]
    ['0.295', '0.275', '0.316']
    """
    realisations = probabilities.shape[0]
    mean = mean_over_first(probabilities)
    offsets = probabilities - mean
    # Summed column by column, unlike in `effective_sample_size`: see `mean_over_first`.
    with np.errstate(divide="ignore", invalid="ignore"):
        sample_size = mean * (1.0 - mean) * (realisations - 1) / mean_over_first(offsets * offsets)
    # The values themselves decide: the variance of equal values need not round to zero.
    sample_size = np.where(np.ptp(probabilities, axis=0) > 0.0, sample_size, np.nan)
    degrees = max(realisations - 1, 1)
    return mean, *probability_limits(mean, sample_size, degrees, windows * realisations)


def mean_interval(values: Array, most: float = np.inf) -> tuple[Array, Array, Array]:
    r"""Mean of independent, unbiased estimates of a positive number, and its 95 % interval.

    .. math:: \bar x \pm t \frac{s}{\sqrt R}

    with Student's t for R - 1 degrees of freedom.

    Parameters
    ----------
    values : numpy.ndarray
        Shape (R, ...), the estimates, with R of two or more.
    most : float, optional
        Largest possible mean, such as 1 for a probability.

    Returns
    -------
    mean, lower, upper : numpy.ndarray
        Shape (...) each, from zero to `most`.

    Examples
    --------
    >>> [f"{limit:.2f}" for limit in mean_interval(np.array([1.0, 2.0, 3.0]))]
    ['2.00', '0.00', '4.48']
    """
    count = values.shape[0]
    mean = mean_over_first(values)
    error = np.sqrt(mean_over_first(np.square(values - mean)) / (count - 1))
    half = _student(count) * error
    limits = mean, np.maximum(mean - half, 0.0), mean + half
    return tuple(np.minimum(limit, most) for limit in limits)


def jackknife_interval(
    values: Array, function: Callable[[Array], Array]
) -> tuple[Array, Array, Array]:
    r"""Compute a function of the mean of independent values, and its 95 % interval.

    Each value is left out once. With the results :math:`f_{(r)}` and their mean
    :math:`f_{(\cdot)}` the error of f is

    .. math:: s^2 = \frac{R - 1}{R} \sum_r \left( f_{(r)} - f_{(\cdot)} \right)^2

    and the interval is, with Student's t for R - 1 degrees of freedom, from
    :math:`f e^{-t s/f}` to :math:`f e^{t s/f}`: a mean of few large values scatters upwards.

    Parameters
    ----------
    values : numpy.ndarray
        Shape (R, ...), with R of two or more.
    function : callable
        Function of the mean over R, of positive values.

    Returns
    -------
    result, lower, upper : numpy.ndarray
        Shape of the function's result; all are zero where it is.

    References
    ----------
    J. W. Tukey, Bias and confidence in not quite large samples, Ann. Math. Stat. 29 (1958) 614.

    Examples
    --------
    >>> [f"{x:.2f}" for x in jackknife_interval(np.array([1.0, 2.0, 3.0]), lambda mean: mean)]
    ['2.00', '0.58', '6.93']
    """
    error = jackknife_error(left_out(values, function))
    result = function(mean_over_first(values))
    factor = np.exp(_student(values.shape[0]) * error / np.where(result > 0.0, result, 1.0))
    return result, result / factor, result * factor


def left_out(values: Array, function: Callable[[Array], Array]) -> Array:
    """Compute a function of the mean of values with each of them left out once.

    Parameters
    ----------
    values, function
        As in `jackknife_interval`.

    Returns
    -------
    numpy.ndarray
        Shape (R, ...), of the function's results.
    """
    count, mean = values.shape[0], mean_over_first(values)
    return np.stack([function((count * mean - one) / (count - 1)) for one in values])


def jackknife_error(without: Array) -> Array:
    """Find the standard error of a result from the results without each value, shape (R, ...).

    The equation is that of `jackknife_interval`.

    Examples
    --------
    >>> f"{jackknife_error(np.array([2.5, 2.0, 1.5])):.3f}"
    '0.577'
    """
    deviation = without - mean_over_first(without)
    return np.sqrt((without.shape[0] - 1) * mean_over_first(np.square(deviation)))


def _student(count):
    """Student's quantile of a mean of so many values."""
    return scipy.special.stdtrit(count - 1, 0.5 + CONFIDENCE / 2.0)
