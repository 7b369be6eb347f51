"""The scatter of a record's contact share between pairs of surfaces.

As for lines (`lube.inference.record_scatter`) it depends on how long a record is, on slip, and on
the rollers' sizes. Its parts follow from the theory of `lube.contact.pair_scatter`.
"""

import itertools
from collections.abc import Sequence
from functools import partial

import numpy as np
import scipy
import xarray as xr

from lube.contact.pair_scatter import (
    RecurringContacts,
    drifting_shares,
    persistent_part,
    slip_ratio,
    turn_ratio,
)
from lube.contact.rough_pair import RoughPair
from lube.contact.surface_strip import SURFACES, mean_breaking_curvature, strip_films
from lube.grid.discretise import speed_ratios
from lube.schema import LIMITS
from lube.statistics.confidence import error_of_limits
from lube.statistics.one_pair import prediction_limits, scatter_ratio
from lube.surfaces.rough_surface import longest_waves
from lube.surfaces.synthetic import LineSpecLike
from lube.types import Array, Pair, Values

PAIRS = 200
"""Number of pairs of rollers whose records are drawn."""
CERTAIN = 1.0 - 1e-9
"""At this probability and above, every pair counts as in contact all the time."""


def revolution_size(spec: LineSpecLike, contact: xr.Dataset) -> Array:
    """Find the effective sample size of a revolution of pure rolling.

    Parameters
    ----------
    spec : LineSpecLike
        Parameters of the lines that stand for the surfaces.
    contact : xarray.Dataset
        From `lube.contact.surface_strip.surface_contact`.

    Returns
    -------
    numpy.ndarray
        Over the dimensions of `contact`.
    """
    names = "breakthrough_probability", "pair_deviation", "passage_width"
    share, deviation, passage = (contact[name].values for name in names)
    scatters = deviation > 1e-9  # not where contact is certain
    size = share * (1.0 - share) / np.where(scatters, deviation, 1.0) ** 2
    return np.where(scatters, size, spec.points[0] * spec.spacing / passage)


def surface_prediction(
    limits: Sequence[Array], size: Values, ratio: Values = 1.0, noise: Values = 0.0
) -> Pair:
    """Predict between which limits the share of one pair of surfaces lies in 95 % of cases.

    Parameters
    ----------
    limits : sequence of numpy.ndarray
        Probability of breakthrough of sampled surfaces, and its lower and upper limit.
    size, ratio, noise
        As `sample_size`, `ratio` and `noise` of `lube.statistics.one_pair.prediction_limits`.

    Returns
    -------
    tuple of numpy.ndarray
        Lower and upper limit.
    """
    noise = np.hypot(noise, error_of_limits(limits))
    # A probability of 1 is only rounded: it was not counted in so many windows.
    share = np.minimum(limits[0], np.nextafter(1.0, 0.0))
    lower, upper = prediction_limits(share, size, ratio, SURFACES, noise, 0.0)
    # No pair is better known than the mean, whose limits are not as far from it near 0 and 1.
    return np.minimum(lower, limits[1]), np.maximum(upper, limits[2])


def revolution_limits(tail: xr.Dataset) -> Pair:
    """Predict between which limits the share of one pair lies in a revolution of pure rolling.

    Parameters
    ----------
    tail : xarray.Dataset
        A ``tail`` dataset, of surfaces.

    Returns
    -------
    tuple of xarray.DataArray
        Lower and upper limit of 95 % of the shares; NaN with slip.
    """
    names = (f"breakthrough_probability{end}" for end in LIMITS)
    limits = [tail[name].where(tail["slide_to_roll_ratio"] == 0.0) for name in names]
    share, deviation = xr.broadcast(limits[0], tail["surface_pair_deviation"])
    deviation = deviation.transpose(*share.dims)
    # Where contact is certain no pair differs.
    size = (share * (1.0 - share) / deviation**2).where(deviation > 1e-9, 1e18)
    predicted = surface_prediction([each.values for each in limits], size.values)
    return tuple(share.copy(data=limit) for limit in predicted)


def pair_correlation(share: Array) -> Array:
    r"""Correlation of the shares of records of one pair of surfaces.

    Contacts under a thick film are also contacts under a thinner one, and their mean number in the
    strip is :math:`t = -\ln(1 - p)`. So two records share the fraction :math:`t_1 / t_2` of the
    contacts under the thinner film, and have the correlation :math:`(t_1 / t_2)^{1/2}`. On 600
    pairs of rollers drawn whole, at films under which they touch for 2 to 90 % of the time, it was
    0.12 less to 0.09 more.

    Parameters
    ----------
    share : numpy.ndarray, shape (record,)
        Probability p of breakthrough.

    Returns
    -------
    numpy.ndarray, shape (record, record)
    """
    number = -np.log1p(-np.clip(share, 1e-12, 1.0 - 1e-12))
    return np.sqrt(np.minimum(number, number[:, None]) / np.maximum(number, number[:, None]))


def pair_shares(surfaces: xr.Dataset, pair: xr.DataArray, seed: int) -> Array:
    r"""Draw the contact shares of all records of many pairs of rollers.

    Contacts pass independently, so the share of a record is to p as a number with Poisson's
    distribution is to its mean,

    .. math:: \mu = \frac{p n}{(1 - p) v} ,

    but 1 at most: it then has the variance :math:`p (1 - p) v / n`. Records of one pair are
    correlated as `pair_correlation` says, those of different pairs are independent.

    Parameters
    ----------
    surfaces : xarray.Dataset
        A ``surface_records`` dataset: probability p of breakthrough, effective sample size n of a
        revolution, and ratio v.
    pair : xarray.DataArray
        Name of the pair that each record is of, over record.
    seed : int
        Seed of the study.

    Returns
    -------
    numpy.ndarray, shape (PAIRS, film_formula, record)
        Shares, which of each formula are of the same pairs; NaN where the film is not known.
    """
    names = "breakthrough_probability", "sample_size", "scatter_ratio"
    share, size, ratio = (surfaces[name].values for name in names)
    numbers, _ = pair.to_series().factorize()
    found = np.broadcast_to(share, (PAIRS, *share.shape)).copy()
    scatters = (share > 0.0) & (share < CERTAIN) & np.isfinite(size * ratio)
    for row, number in itertools.product(range(len(share)), np.unique(numbers)):
        some = np.flatnonzero(scatters[row] & (numbers == number))
        mean = share[row, some]
        expected = mean * size[row, some] / ((1.0 - mean) * ratio[some])
        generator = np.random.default_rng((seed, PAIRS, number))
        # In the order of the mean numbers of contacts each depends on the last alone.
        rising = np.argsort(mean, kind="stable")
        rate = -np.log1p(-mean[rising])
        steps = generator.standard_normal((PAIRS, some.size))
        normal = np.empty_like(steps)
        normal[:, rising] = np.cumsum(steps * np.sqrt(np.diff(rate, prepend=0.0)), axis=1)
        normal[:, rising] /= np.sqrt(rate)
        contacts = scipy.stats.poisson.ppf(scipy.special.ndtr(normal), expected)
        found[:, row, some] = np.minimum(mean / expected * contacts, 1.0)
    return found


def surface_scatter(
    pair: RoughPair, films: xr.Dataset, shares: Array, slips: Array, turns: Array, drift: float
) -> Array:
    """Find how far the share of each record scatters between pairs of surfaces.

    Parameters
    ----------
    pair : RoughPair
        The rollers.
    films : xarray.Dataset
        Films at the records by one film formula, with their responses if the oil answers.
    shares : numpy.ndarray, shape (record,)
        Probability of breakthrough at the records.
    slips : numpy.ndarray, shape (record,)
        Slide-to-roll ratios.
    turns : numpy.ndarray, shape (..., record)
        Revolutions of the records, of one or of several durations.
    drift : float
        As in `lube.statistics.one_pair.drift_factor`.

    Returns
    -------
    numpy.ndarray
        Of the shape of `turns`: variance of the record's share over that of one revolution of pure
        rolling; NaN where the film is not known.
    """
    spec, length = pair.spec, pair.length
    # Ridges across rolling are no longer along it.
    reach, recurring = longest_waves(spec)[1] / spec.spacing, RecurringContacts(spec)
    strips, sharp = strip_films(pair, films), mean_breaking_curvature(pair, films)
    perimeters = np.multiply(spec.points, spec.spacing)
    durations = turns.reshape(-1, shares.size).T.tolist()

    def of_record(slip, turns, share, strip):
        if strip is None or np.isnan(share):
            return [np.nan] * len(turns)
        film, (lags, common) = strip.levels(spec).min(), strip.common(spec, length)
        breaking = strip.breaking_part(spec, length, sharp)
        alone = recurring.at(film, breaking)
        broken = breaking, strip.breakthrough_width(spec, length, sharp, slip)
        passages = [strip.passage_width(spec, length, each) for each in (slip, 0.0)]
        slipping = partial(
            slip_ratio, share, lags, common, alone, passages, slip, perimeters, broken=broken
        )
        part = persistent_part(share, lags, common, alone) * spec.points[0] / spec.points
        part = part / slipping()
        if slip == 0.0 and spec.points[0] == spec.points[1]:
            part = np.zeros(2)  # both surfaces recur together
        alike = drifting_shares(share, lags, common, partial(recurring.drifted, film))
        rolling = turn_ratio(share, lags, common, alone, perimeters)
        ratios, found = speed_ratios(slip), []
        for one in turns:
            later = scatter_ratio(
                max(one, 1.0), ratios, spec.points, reach, part, drift, alike=alike
            )
            found.append(slipping(min(one, 1.0)) * later / rolling)
        return found

    found = map(of_record, slips.tolist(), durations, shares, strips)
    return np.reshape(np.transpose(list(found)), turns.shape)
