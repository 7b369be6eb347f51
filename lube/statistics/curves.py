"""Curves of probability against the film, read in either direction, and fits along them.

Films enter by the logarithm of the lambda ratio, x, and probabilities by the logit
ln(p / (1 - p)): on these scales a curve is smooth, and straight lines between its levels do.
"""

from dataclasses import dataclass

import numpy as np
import scipy.optimize
import scipy.special

from lube.statistics.one_pair import quantile, standard_error

STEPS = 16
"""Steps between two levels of a curve on which the limits of a film are looked for."""


@dataclass(frozen=True)
class Curve:
    """A probability that falls as the film grows.

    Attributes
    ----------
    films : numpy.ndarray
        Logarithms of the lambda ratio, shape (n,), rising.
    logits : numpy.ndarray
        Logits of the probability there, shape (n,), strictly falling.
    looks : numpy.ndarray
        Effective sample size of one realisation there, shape (n,).
    """

    films: np.ndarray
    logits: np.ndarray
    looks: np.ndarray

    def logit_at(self, films):
        """Logit of the probability at some films, straight on beyond the ends.

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

    def film_at(self, share):
        """Film at which the probability is so large.

        Parameters
        ----------
        share : float
            Probability from 0 to 1.

        Returns
        -------
        float
            Logarithm of the lambda ratio: -inf if the share is above the whole curve, +inf if
            below; NaN if the curve is empty.
        """
        if not self.films.size:
            return np.nan
        logit = scipy.special.logit(share)
        return np.interp(-logit, -self.logits, self.films, left=-np.inf, right=np.inf)


def falling_curve(films, probabilities, looks, resolution):
    """Curve through estimated probabilities, made non-increasing.

    Neighbours out of order get their common mean (isotonic regression), and levels of equal
    probability their mean film and sample size.

    Parameters
    ----------
    films : numpy.ndarray
        Logarithms of the lambda ratio, shape (n,), rising.
    probabilities : numpy.ndarray
        Shape (n,).
    looks : numpy.ndarray
        Effective sample size of one realisation at each film, shape (n,).
    resolution : float
        Levels closer than this to 0 or to 1 are left out.

    Returns
    -------
    Curve
        What remains; it may be empty.
    """
    falling = scipy.optimize.isotonic_regression(probabilities, increasing=False).x
    inside = (falling >= resolution) & (falling <= 1.0 - resolution)
    sinking, level = np.unique(-scipy.special.logit(falling[inside]), return_inverse=True)
    films, looks = (
        np.bincount(level, each[inside]) / np.bincount(level) for each in (films, looks)
    )
    return Curve(films, -sinking, looks)


def film_interval(curve, share, ratio, realisations, noise=0.0):
    """Film that explains the contact share of one pair's record, with its 95 % interval.

    The interval holds all films whose predicted share the record does not contradict: those
    at which it lies within `lube.statistics.one_pair.prediction_limits`.

    Parameters
    ----------
    curve : Curve
        Mean probability over the realisations, against the film.
    share : float
        The record's share of time in contact.
    ratio : float
        From `lube.statistics.one_pair.scatter_ratio`.
    realisations : int
        Number of realisations behind the curve.
    noise : float, optional
        Standard error of the share by what is not the roughness.

    Returns
    -------
    film, lower, upper : float
        Logarithms of the lambda ratio. Where the curve ends before it contradicts the share, a
        limit is -inf or +inf, and so is the film where the share is beyond the curve; where all
        of the curve contradicts it, the other limit is the curve's end. All are NaN without a
        share or a curve.
    """
    if np.isnan(share) or curve.films.size < 2:
        return np.nan, np.nan, np.nan
    films, distance = _distances(curve, share, ratio, realisations, noise)
    limit = quantile(realisations)
    lower = np.interp(-limit, distance, films, left=-np.inf, right=films[-1])
    upper = np.interp(limit, distance, films, left=films[0], right=np.inf)
    return curve.film_at(share), lower, upper


def _distances(curve, share, ratio, realisations, noise):
    """Distance of a share from a curve's, over its standard error, made non-decreasing."""
    levels = np.arange(STEPS * (curve.films.size - 1) + 1) / STEPS
    films = np.interp(levels, np.arange(curve.films.size), curve.films)
    model = scipy.special.expit(curve.logit_at(films))
    looks = np.interp(films, curve.films, curve.looks)
    error = standard_error(model, looks, ratio, realisations, noise)
    return films, np.maximum.accumulate((share - model) / error)


def realisation_correlation(probabilities):
    """Correlation between operating points that see the same realisation.

    Parameters
    ----------
    probabilities : numpy.ndarray
        Shape (R, P), of each realisation at each operating point.

    Returns
    -------
    numpy.ndarray
        Shape (P, P). A point where realisations do not differ is taken as independent of the
        others; with one realisation, which tells nothing, all are taken as the same.
    """
    realisations, points = probabilities.shape
    if realisations == 1:
        return np.ones((points, points))
    offsets = probabilities - probabilities.mean(axis=0)
    length = np.sqrt(np.sum(offsets**2, axis=0))
    offsets /= np.where(length > 0.0, length, 1.0)
    # Not the matrix product: its last digits hang on which processor the BLAS finds.
    correlation = np.einsum("ri,rj->ij", offsets, offsets)
    np.fill_diagonal(correlation, 1.0)
    return correlation


def fit_factor(log_factors, logits, shares, looks, covariance, realisations, noise):
    """Fit the one factor that explains the contact shares of all records.

    At each level of the factor the misfit of all records is added up as in a quasi-likelihood
    with binomial variances: the sum of n l (m - p), with the share m, the model's probability p,
    the effective sample size n and l = d logit(p) / d ln(factor). It is set over its standard
    error, in which the records are correlated. The factor is where the misfit is zero; its 95 %
    interval is all that the misfit does not contradict (a score interval). So records whose
    share is 0 or 1 count as well. The covariance is never inverted: from R realisations its
    rank is R - 1, too low for that where there are more records.

    Parameters
    ----------
    log_factors : numpy.ndarray
        Logarithms of the factor, shape (F,), rising.
    logits : numpy.ndarray
        Logits of the model's probability, shape (F, P), falling with the factor.
    shares : numpy.ndarray
        Measured shares, shape (P,).
    looks : numpy.ndarray
        Effective sample size of one realisation, shape (P,).
    covariance : numpy.ndarray
        Of the errors m - p, each over (p (1 - p) / n)^(1/2), shape (P, P).
    realisations : int
        Behind the covariance; for few of them the interval is Student's.
    noise : numpy.ndarray
        Standard errors of the shares by what is not the roughness, shape (P,).

    Returns
    -------
    factor, lower, upper : float
        Beyond the levels the factor is NaN and a limit 0 or +inf; where all levels are
        contradicted, the other limit is their end.

    References
    ----------
    R. W. M. Wedderburn, Quasi-likelihood functions, Biometrika 61 (1974) 439-447; K.-Y. Liang
    and S. L. Zeger, Longitudinal data analysis using generalized linear models, Biometrika 73
    (1986) 13-22, for the standard error under correlation.
    """
    if not shares.size:
        return np.nan, 0.0, np.inf
    model = scipy.special.expit(logits)
    pull = looks * np.gradient(logits, log_factors, axis=0)
    errors = pull * np.sqrt(model * (1.0 - model) / looks)
    variance = np.einsum("fi,ij,fj->f", errors, covariance, errors, optimize=False)
    variance += np.sum((pull * noise) ** 2, axis=1)
    misfit = np.sum(pull * (shares - model), axis=1) / np.sqrt(variance)
    falling = np.minimum.accumulate(misfit)
    limit = quantile(realisations)
    first, last = log_factors[[0, -1]]
    factor = np.interp(0.0, -falling, log_factors, left=np.nan, right=np.nan)
    lower = np.interp(-limit, -falling, log_factors, left=-np.inf, right=last)
    upper = np.interp(limit, -falling, log_factors, left=first, right=np.inf)
    return np.exp(factor), np.exp(lower), np.exp(upper)
