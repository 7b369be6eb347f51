"""Curves of probability against the film, read in either direction, and fits along them.

Films enter by the logarithm of the lambda ratio, x, and probabilities by the logit
ln(p / (1 - p)): on these scales a curve is smooth, and straight lines between its levels do.
"""

from dataclasses import dataclass

import numpy as np
import scipy.optimize
import scipy.special
import scipy.stats

QUANTILE = scipy.stats.norm.ppf(0.975)
"""Half-width of a 95 % interval of a normal error, over its standard deviation."""


@dataclass(frozen=True)
class Curve:
    """A probability that falls as the film grows.

    Attributes
    ----------
    films : numpy.ndarray
        Logarithms of the lambda ratio, shape (n,), rising.
    logits : numpy.ndarray
        Logits of the probability there, shape (n,), strictly falling.
    """

    films: np.ndarray
    logits: np.ndarray

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


def falling_curve(films, probabilities, resolution):
    """Curve through estimated probabilities, made non-increasing.

    Neighbours out of order get their common mean (isotonic regression), and levels of equal
    probability their mean film.

    Parameters
    ----------
    films : numpy.ndarray
        Logarithms of the lambda ratio, shape (n,), rising.
    probabilities : numpy.ndarray
        Shape (n,).
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
    return Curve(np.bincount(level, films[inside]) / np.bincount(level), -sinking)


def film_interval(curves, record):
    """Film that explains a record's contact share, with the interval of both.

    The record's interval and the curve's are independent errors of one film: on the scale of
    ln(lambda) their distances from it add in quadrature, on either side by themselves.

    Parameters
    ----------
    curves : tuple of Curve
        Mean probability, its lower and its upper limit.
    record : tuple of float
        Share, its lower and its upper limit.

    Returns
    -------
    film, lower, upper : float
        Logarithms of the lambda ratio. A share below the whole curve has no film but a lower
        limit, and +inf for the upper one; a share above it has an upper limit and -inf for the
        lower one. Without a share all are NaN, without its limits those are.
    """
    (mean, low, high), (share, least, most) = curves, record
    film = mean.film_at(share)
    if np.isfinite(film):
        thinner = [film - mean.film_at(most), film - _earliest(low, share)]
        thicker = [mean.film_at(least) - film, _latest(high, share) - film]
        # A hair below zero where curves were made non-increasing.
        lower = film - np.hypot(*np.maximum(thinner, 0.0))
        upper = film + np.hypot(*np.maximum(thicker, 0.0))
    else:
        lower = _earliest(low, most) if film == np.inf else -np.inf
        upper = _latest(high, least) if film == -np.inf else np.inf
        film = np.nan
    if np.isnan(least + most):
        lower = upper = np.nan
    return film, lower, upper


def _earliest(curve, share):
    """Film by a lower limit of the probability: at least this, where the curve ends before."""
    film = curve.film_at(share)
    return -np.inf if np.isnan(film) else min(film, curve.films.max(initial=-np.inf))


def _latest(curve, share):
    """Film by an upper limit of the probability: at most this, where the curve begins later."""
    film = curve.film_at(share)
    return np.inf if np.isnan(film) else max(film, curve.films.min(initial=np.inf))


def independent_looks(mean, lower, upper):
    """Count the independent looks that a probability's interval amounts to.

    Inverse of Wilson's score interval: with q = m (1 - m), half-width w and z = 1.96, N = n + z^2
    solves w^2 N^2 - z^2 q N - z^4 (1/4 - q) = 0. It has an answer for m = 0 and 1 too.

    Parameters
    ----------
    mean, lower, upper : numpy.ndarray
        Probability and its 95 % interval, any shape.

    Returns
    -------
    numpy.ndarray
        Same shape, n; infinite for an interval without width.
    """
    spread = mean * (1.0 - mean)
    half = 0.5 * (upper - lower)
    with np.errstate(divide="ignore", invalid="ignore"):
        root = np.sqrt(spread**2 + 4.0 * half**2 * (0.25 - spread))
        total = QUANTILE**2 * (spread + root) / (2.0 * half**2)
    # An interval wider than that of no look at all is worth next to nothing.
    return np.where(half > 0.0, np.maximum(total - QUANTILE**2, 1e-3), np.inf)


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


def fit_factor(log_factors, logits, shares, weights, looks, correlation, realisations):
    """Fit the one factor that explains the contact shares of all operating points.

    At each level of the factor the misfit of all points is added up as in a quasi-likelihood
    with binomial variances: the sum of w l (m - p), with the share m, the model's probability p,
    the weight w and l = d logit(p) / d ln(factor). It is set over its standard error, in which
    the points are correlated and m - p has the variance p (1 - p) / n of n looks. The factor is
    where the misfit is zero; its 95 % interval is all that the misfit does not contradict (a
    score interval). So points where the share is 0 or 1 count as well. The weights are no part
    of what is assumed: poor ones widen the interval.

    Parameters
    ----------
    log_factors : numpy.ndarray
        Logarithms of the factor, shape (F,), rising.
    logits : numpy.ndarray
        Logits of the model's probability, shape (F, P), falling with the factor.
    shares : numpy.ndarray
        Measured shares, shape (P,).
    weights : numpy.ndarray
        Shape (P,); the best are proportional to the looks, but they must not follow the chance
        of the shares.
    looks : numpy.ndarray
        Independent looks behind the difference of share and model, shape (P,).
    correlation : numpy.ndarray
        Between the errors of the points, shape (P, P).
    realisations : int
        Behind the correlation; for few of them the interval is Student's.

    Returns
    -------
    factor, lower, upper : float
        Beyond the levels a limit is 0 or +inf and the factor NaN.

    References
    ----------
    R. W. M. Wedderburn, Quasi-likelihood functions, Biometrika 61 (1974) 439-447; K.-Y. Liang
    and S. L. Zeger, Longitudinal data analysis using generalized linear models, Biometrika 73
    (1986) 13-22, for the standard error under correlation.
    """
    if not shares.size:
        return np.nan, 0.0, np.inf
    model = scipy.special.expit(logits)
    pull = weights * np.gradient(logits, log_factors, axis=0)
    errors = pull * np.sqrt(model * (1.0 - model) / looks)
    variance = np.einsum("fi,ij,fj->f", errors, correlation, errors)
    misfit = np.sum(pull * (shares - model), axis=1) / np.sqrt(variance)
    falling = np.minimum.accumulate(misfit)
    quantile = scipy.stats.t.ppf(0.975, max(realisations - 1, 1))
    wanted = np.array([0.0, -quantile, quantile])
    found = np.exp(np.interp(wanted, -falling, log_factors, left=-np.inf, right=np.inf))
    factor = found[0] if 0.0 < found[0] < np.inf else np.nan
    return factor, found[1], found[2]
