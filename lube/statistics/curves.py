r"""Curves of probability against the film, read in either direction, and fits along them.

Films enter as the logarithm of the lambda ratio, :math:`x = \ln \Lambda`, and probabilities as
the logit, :math:`\ln(p / (1 - p))`. On these scales the curves are smooth enough for linear
interpolation.
"""

from dataclasses import dataclass
from functools import partial

import numpy as np
import scipy

from lube.statistics.one_pair import quantile, standard_error
from lube.types import Array, Values

FINER = 32
"""Levels of a curve of contacts for each film at which the probability is known."""
LEAST = 1e-12
"""Probabilities of contact closer than this to 0 or to 1 are not read from it."""
STEPS = 16
"""Steps between two levels of a curve in the search for the limits of a film."""


@dataclass(frozen=True)
class Curve:
    """A probability that falls as the film grows, but may rise before, at the thinnest films.

    Attributes
    ----------
    films : numpy.ndarray
        Logarithms of the lambda ratio, shape (n,), rising.
    logits : numpy.ndarray
        Logits of the probability there, shape (n,), strictly falling from the peak on and strictly
        rising before.
    sample_size : numpy.ndarray
        Effective sample size of one realisation there, shape (n,).
    peak : int
        Index of the largest probability; by default 0, for a curve that rises nowhere.

    Examples
    --------
    >>> curve = Curve(np.array([0.0, 1.0]), np.array([2.0, -2.0]), np.array([50.0, 50.0]))
    >>> float(curve.logit_at(0.5)), float(curve.film_at(0.5))
    (0.0, 0.5)
    """

    films: Array
    logits: Array
    sample_size: Array
    peak: int = 0

    def logit_at(self, films: Values) -> Array:
        """Logit of the probability at given films, extrapolated linearly beyond the ends.

        Parameters
        ----------
        films : numpy.ndarray
            Logarithms of the lambda ratio, any shape.

        Returns
        -------
        numpy.ndarray
            Same shape; NaN if the curve has fewer than two levels.
        """
        if self.films.size < 2:
            return np.full(np.shape(films), np.nan)
        slopes = np.diff(self.logits) / np.diff(self.films)
        segment = np.searchsorted(self.films, films).clip(1, slopes.size) - 1
        return self.logits[segment] + slopes[segment] * (films - self.films[segment])

    def film_at(self, share: float) -> float:
        """Film beyond the peak at which the probability has a given value.

        Parameters
        ----------
        share : float
            Probability from 0 to 1.

        Returns
        -------
        float
            Logarithm of the lambda ratio: -inf if the share is above all values of the curve, +inf
            if it is below them; NaN if the curve is empty.
        """
        if not self.films.size:
            return np.nan
        logit, falling = scipy.special.logit(share), slice(self.peak, None)
        films = self.films[falling]
        return np.interp(-logit, -self.logits[falling], films, left=-np.inf, right=np.inf)

    def thinner_film_at(self, share: float) -> float:
        """Film before the peak at which the probability has a given value as well.

        Parameters
        ----------
        share : float
            Probability from 0 to 1.

        Returns
        -------
        float
            Logarithm of the lambda ratio; NaN if there is no such film on the curve.
        """
        if not self.peak:
            return np.nan
        logit, rising = scipy.special.logit(share), slice(self.peak + 1)
        return np.interp(logit, self.logits[rising], self.films[rising], left=np.nan, right=np.nan)


def falling_curve(
    films: Array, probabilities: Array, sample_size: Array, resolution: float
) -> Curve:
    """Fit a falling curve to estimated probabilities.

    Neighbours out of order are replaced by their common mean (isotonic regression), and levels of
    equal probability by one level with their mean film and mean sample size.

    Parameters
    ----------
    films : numpy.ndarray
        Logarithms of the lambda ratio, shape (n,), rising.
    probabilities : numpy.ndarray
        Shape (n,).
    sample_size : numpy.ndarray
        Effective sample size of one realisation at each film, shape (n,).
    resolution : float
        Levels closer than this to 0 or to 1 are omitted.

    Returns
    -------
    Curve
        The remaining levels; it may be empty.

    Examples
    --------
    >>> curve = falling_curve(
    ...     np.arange(4.0), np.array([0.8, 0.3, 0.5, 0.1]), np.array([10.0, 20.0, 40.0, 80.0]), 1e-6
    ... )
    >>> curve.films, curve.sample_size
    (array([0. , 1.5, 3. ]), array([10., 30., 80.]))
    """
    falling = scipy.optimize.isotonic_regression(probabilities, increasing=False).x
    inside = (falling >= resolution) & (falling <= 1.0 - resolution)
    sinking, level = np.unique(-scipy.special.logit(falling[inside]), return_inverse=True)
    films = np.bincount(level, films[inside]) / np.bincount(level)
    sample_size = np.bincount(level, sample_size[inside]) / np.bincount(level)
    return Curve(films, -sinking, sample_size)


def peaked_curve(
    films: Array, probabilities: Array, sample_size: Array, resolution: float
) -> Curve:
    """Fit a curve that falls from its largest probability on, and rises before.

    Where contact is frequent and the film very thin, segments merge and hold: their boundary layers
    are squeezed less than those of the segments that they are made of. Then the probability of a
    breakthrough is largest at some film, and smaller at thinner ones.

    Parameters
    ----------
    films, probabilities, sample_size, resolution
        As in `falling_curve`.

    Returns
    -------
    Curve
        The levels of `falling_curve` on both sides of the largest probability.

    Examples
    --------
    >>> curve = peaked_curve(np.arange(1.0, 4.0), np.array([0.4, 0.5, 0.1]), np.full(3, 9.0), 1e-6)
    >>> curve.peak, float(curve.film_at(0.4)) > 2.0, float(curve.thinner_film_at(0.4))
    (1, True, 1.0)
    """
    peak = int(np.argmax(probabilities))
    beyond, before = slice(peak, None), slice(peak, None, -1)
    falling = falling_curve(films[beyond], probabilities[beyond], sample_size[beyond], resolution)
    # The other side falls too if it is read backwards.
    rising = falling_curve(-films[before], probabilities[before], sample_size[before], resolution)
    if not falling.films.size or rising.films.size < 2:
        return falling
    thin = -rising.films, rising.logits, rising.sample_size
    thick = falling.films, falling.logits, falling.sample_size
    joined = (np.concatenate([a[:0:-1], b]) for a, b in zip(thin, thick, strict=True))
    return Curve(*joined, peak=rising.films.size - 1)


def contact_curve(films: Array, probabilities: Array, sample_size: Array) -> Curve:
    r"""Fit a falling curve to probabilities of contact of a surface, at few films.

    Contacts in a strip come nearly independently. So their number :math:`n_g = -\ln(1 - p)` is
    interpolated between the films: its logarithm is nearly linear in the square of the film.

    Parameters
    ----------
    films, probabilities, sample_size
        As in `falling_curve`. Probabilities of 0, of 1 and unknown ones are left out.

    Returns
    -------
    Curve
        With `FINER` levels for each film; empty if fewer than two films are left.

    Examples
    --------
    >>> ratios = np.array([3.0, 3.5, 4.0])
    >>> curve = contact_curve(np.log(ratios), -np.expm1(-np.exp(5.0 - 0.5 * ratios**2)), np.ones(3))
    >>> print(f"{np.exp(curve.film_at(-np.expm1(-np.exp(5.0 - 0.5 * 3.2**2)))):.3f}")
    3.200
    """
    known = (probabilities > 0.0) & (probabilities < 1.0)
    if np.count_nonzero(known) < 2:
        return Curve(*np.zeros((3, 0)))
    films, sample_size = films[known], sample_size[known]
    numbers = np.arange(FINER * (films.size - 1) + 1) / FINER
    finer = np.interp(numbers, np.arange(films.size), films)
    contacts = np.log(-np.log1p(-probabilities[known]))
    shares = -np.expm1(-np.exp(log_groups_between(films, contacts, finer)))
    peak = np.argmax(shares)  # under thinner films contacts merge, and break fewer layers
    sizes = np.interp(finer, films, sample_size)
    return falling_curve(finer[peak:], shares[peak:], sizes[peak:], LEAST)


def log_groups_between(films: Array, contacts: Array, wanted: Values) -> Array:
    """Interpolate the logarithm of the number of groups of contacts between films.

    Parameters
    ----------
    films : numpy.ndarray
        Logarithms of the lambda ratio, shape (n,), rising.
    contacts : numpy.ndarray
        Logarithms of the number, shape (n,).
    wanted : float or numpy.ndarray
        Logarithms of other lambda ratios.

    Returns
    -------
    numpy.ndarray
        Of the shape of `wanted`.
    """
    between = scipy.interpolate.PchipInterpolator(np.exp(2.0 * films), contacts)
    return between(np.exp(2.0 * np.asarray(wanted)))


def film_interval(
    curve: Curve, share: float, ratio: float, realisations: int, noise: float = 0.0
) -> tuple[float, float, float]:
    """Film that explains the contact share of one pair's record, with its 95 % interval.

    The interval holds all films that are compatible with the record: those at which its share
    lies within `lube.statistics.one_pair.prediction_limits`.

    Parameters
    ----------
    curve : Curve
        Mean probability over the realisations, against the film.
    share : float
        Contact share of the record.
    ratio : float
        From `lube.statistics.one_pair.scatter_ratio`.
    realisations : int
        Number of realisations from which the curve is estimated.
    noise : float, optional
        Standard error of the share from causes other than the roughness.

    Returns
    -------
    film, lower, upper : float
        Logarithms of the lambda ratio. The film lies beyond the peak of the curve, and the
        interval holds all films around it. The film is -inf or +inf if the share lies beyond the
        range of the curve. A limit is -inf or +inf if even the last film of the curve on that
        side agrees with the record. If no film of the curve agrees with it, the finite limit is
        the last film of the curve. All three are NaN if the share is NaN or the curve has fewer
        than two levels.

    Examples
    --------
    >>> curve = Curve(np.array([0.0, 1.0]), np.array([2.0, -2.0]), np.array([1e3, 1e3]))
    >>> [f"{film:.3f}" for film in film_interval(curve, 0.5, ratio=1.0, realisations=64)]
    ['0.500', '0.468', '0.532']
    """
    if np.isnan(share) or curve.films.size < 2:
        return np.nan, np.nan, np.nan
    limit = quantile(realisations)
    distances = partial(_distances, share, ratio, realisations, noise, curve, curve.peak)
    films, distance = distances(curve.films.size - 1)
    lower = np.interp(-limit, distance, films, left=-np.inf, right=films[-1])
    upper = np.interp(limit, distance, films, left=films[0], right=np.inf)
    if lower == -np.inf and curve.peak and distance[0] <= limit:
        thinner, distance = distances(0)
        lower = np.interp(limit, distance, thinner, right=-np.inf)
    return curve.film_at(share), lower, upper


def _distances(share, ratio, realisations, noise, curve, first, last):
    """Films, and the distances of a share from the curve there, in standard errors.

    The films go from one end to the other, both given as indices of the curve's levels. The
    distances are made non-decreasing.
    """
    levels = np.linspace(first, last, STEPS * abs(last - first) + 1)
    films = np.interp(levels, np.arange(curve.films.size), curve.films)
    model = scipy.special.expit(curve.logit_at(films))
    sample_size = np.interp(films, curve.films, curve.sample_size)
    error = standard_error(model, sample_size, ratio, realisations, noise)
    return films, np.maximum.accumulate((share - model) / error)


def realisation_correlation(probabilities: Array) -> Array:
    """Pearson correlation of the probabilities at different operating points.

    Parameters
    ----------
    probabilities : numpy.ndarray
        Shape (R, P), probability of each realisation at each operating point.

    Returns
    -------
    numpy.ndarray
        Shape (P, P). A point at which the realisations do not scatter counts as independent of the
        others; with a single realisation all points count as fully correlated.

    Examples
    --------
    >>> realisation_correlation(np.array([[0.1, 0.4], [0.2, 0.6], [0.3, 0.8]])).round(6)
    array([[1., 1.],
           [1., 1.]])
    """
    realisations, points = probabilities.shape
    if realisations == 1:
        return np.ones((points, points))
    offsets = probabilities - probabilities.mean(axis=0)
    length = np.sqrt(np.sum(offsets**2, axis=0))
    offsets /= np.where(length > 0.0, length, 1.0)
    # Not the matrix product, whose last digits depend on the processor that BLAS finds.
    correlation = np.einsum("ri,rj->ij", offsets, offsets)
    np.fill_diagonal(correlation, 1.0)
    return correlation


def fit_factor(
    log_factors: Array,
    logits: Array,
    shares: Array,
    sample_size: Array,
    covariance: Array,
    realisations: int,
    noise: Array,
) -> tuple[float, float, float]:
    r"""Fit one factor, common to all records, to their contact shares.

    The estimating function is that of a quasi-likelihood with binomial variances,

    .. math:: S(f) = \sum_i n_i l_i (m_i - p_i), \qquad
              l_i = \frac{d\, \mathrm{logit}(p_i)}{d \ln f}

    with the measured share :math:`m`, the model's probability :math:`p` and the number :math:`n` of
    trials by which a record weighs. It is divided by its standard error, in which the records are
    correlated. The estimate is where it is zero; the 95 % interval holds all factors at which it
    lies within its quantile (a score interval), so records with a share of 0 or 1 count as well.
    The covariance is never inverted: from R realisations its rank is R - 1 only.

    Parameters
    ----------
    log_factors : numpy.ndarray
        Logarithms of the factor, shape (F,), rising.
    logits : numpy.ndarray
        Logits of the model's probability, shape (F, P). They fall with the factor, except where
        contact is so frequent that segments merge.
    shares : numpy.ndarray
        Measured shares, shape (P,).
    sample_size : numpy.ndarray
        Numbers :math:`n`, shape (P,).
    covariance : numpy.ndarray
        Covariance of the errors m - p, each over (p (1 - p) / n)^(1/2), shape (P, P).
    realisations : int
        Number R of realisations from which the covariance is estimated.
    noise : numpy.ndarray
        Standard errors of the shares from causes other than the roughness, shape (P,).

    Returns
    -------
    factor, lower, upper : float
        The factor is NaN if it lies beyond the levels; a limit there is 0 or +inf. If no level is
        compatible with the records, the finite limit is the nearest level. If several factors
        solve the equation, the one with the largest quasi-likelihood, the integral of S, is taken.

    References
    ----------
    R. W. M. Wedderburn, Quasi-likelihood functions, generalized linear models, and the
    Gauss-Newton method, Biometrika 61 (1974) 439-447; K.-Y. Liang and S. L. Zeger, Longitudinal
    data analysis using generalized linear models, Biometrika 73 (1986) 13-22, for the standard
    error under correlation.

    Examples
    --------
    Two independent records, of which the model explains the shares if the factor is 1:

    >>> log_factors = np.linspace(-1.0, 1.0, 201)
    >>> logits = np.array([0.5, -0.5]) - 4.0 * log_factors[:, None]
    >>> shares = scipy.special.expit(np.array([0.5, -0.5]))
    >>> found = fit_factor(
    ...     log_factors, logits, shares, np.full(2, 1e3), np.eye(2), 64, np.zeros(2)
    ... )
    >>> [f"{factor:.2f}" for factor in found]
    ['1.00', '0.98', '1.02']
    """
    if not shares.size:
        return np.nan, 0.0, np.inf
    model = scipy.special.expit(logits)
    weights = sample_size * np.gradient(logits, log_factors, axis=0)
    errors = weights * np.sqrt(model * (1.0 - model) / sample_size)
    variance = np.einsum("fi,ij,fj->f", errors, covariance, errors, optimize=False)
    variance += np.sum((weights * noise) ** 2, axis=1)
    score = np.sum(weights * (shares - model), axis=1)
    # Records where contact is certain tell nothing: both are 0.
    misfit = np.divide(score, np.sqrt(variance), out=np.zeros_like(score), where=variance > 0.0)
    limit = quantile(realisations)
    likeliest = np.argmax(scipy.integrate.cumulative_trapezoid(score, log_factors, initial=0.0))
    # From the factor where the score becomes positive, it falls to its zero at the likeliest one.
    # At smaller factors, with films so thin that segments merge, it may have another zero, below
    # which it is clearly negative.
    dip = np.max(np.flatnonzero(misfit[:likeliest] < -limit), initial=0)
    first = dip + np.argmax(score[dip : likeliest + 1] >= 0.0)
    log_factors, falling = log_factors[first:], np.minimum.accumulate(misfit[first:])
    first, last = log_factors[[0, -1]]
    factor = np.interp(0.0, -falling, log_factors, left=np.nan) if falling[-1] < 0.0 else np.nan
    lower = np.interp(-limit, -falling, log_factors, left=-np.inf, right=last)
    upper = np.interp(limit, -falling, log_factors, left=first, right=np.inf)
    return np.exp(factor), np.exp(lower), np.exp(upper)
