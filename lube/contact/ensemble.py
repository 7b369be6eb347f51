r"""Ensembles: from realisations to probabilities with 95 % intervals.

The scatter between realisations determines the effective sample size n of an ensemble. It is the
number of independent trials, each with contact at probability p, whose mean varies as much as the
mean over the realisations,

.. math:: s_{\bar p}^2 = \frac{p (1 - p)}{n}

With this n, Wilson's score interval stays within 0 and 1, is asymmetric near either end, and in
between is close to the usual interval, :math:`p \pm t s_{\bar p}` with Student's t.
"""

from collections.abc import Sequence

import numpy as np
import xarray as xr

from lube.errors import DataError
from lube.grid.operating_points import surface_speeds
from lube.schema import LIMITS, MEAN_LIMITS, label, values_with_limits
from lube.statistics.confidence import probability_interval
from lube.statistics.one_pair import prediction_limits
from lube.statistics.sample_size import effective_sample_size, independent_windows
from lube.types import Array, Values

PROBABILITIES = ("breakthrough_probability", "geometric_contact_probability")
ATTRIBUTES = ("travel", "longest_wavelength")


def windows_by_force(contact: xr.Dataset, film: xr.Dataset) -> xr.DataArray:
    """Count the independent contact windows in one realisation.

    Two windows see independent roughness if they are a longest wavelength apart on both surfaces.
    So the travel of the slower surface counts: if one roller stands still, all windows see the same
    part of it.

    Parameters
    ----------
    contact : xarray.Dataset
        A ``contact_batch`` or ``contact`` dataset.
    film : xarray.Dataset
        The ``film`` dataset it was made with.

    Returns
    -------
    xarray.DataArray
        Over force and slide_to_roll_ratio; at least one.

    Raises
    ------
    DataError
        If the film table lacks a force of the contact results.
    """
    try:
        half_width = film["contact_half_width"].sel(force=contact["force"])
    except KeyError:
        raise DataError(
            f"the contact results are at forces {contact['force'].values.tolist()} N, the film "
            f"table has {film['force'].values.tolist()} N"
        ) from None
    speeds = surface_speeds(1.0, contact["slide_to_roll_ratio"])
    return windows_in(contact, 2.0 * half_width, np.minimum(*speeds) / np.maximum(*speeds))


def windows_in(dataset: xr.Dataset, width: Values, slower: Values = 1.0) -> Values:
    """Count the independent contact windows in one realisation of a dataset.

    Parameters
    ----------
    dataset : xarray.Dataset
        With the attributes ``travel`` and ``longest_wavelength`` of a realisation, m.
    width : float, numpy.ndarray or xarray.DataArray
        Contact width, m.
    slower : float or xarray.DataArray, optional
        Speed of the slower surface over that of the faster; by default they roll without slip.

    Returns
    -------
    float, numpy.ndarray or xarray.DataArray
        From `lube.statistics.sample_size.independent_windows`.
    """
    travel = dataset.attrs["travel"] * slower
    return independent_windows(travel, width, dataset.attrs["longest_wavelength"])


def windows_at_records(records: xr.Dataset) -> Array:
    """Count the independent contact windows in one realisation, at the film of each record.

    Parameters
    ----------
    records : xarray.Dataset
        With ``contact_half_width`` over record, and the attributes that `windows_in` needs.

    Returns
    -------
    numpy.ndarray
        Shape (record,).
    """
    return windows_in(records, 2.0 * records["contact_half_width"].values)


def gather(batches: Sequence[xr.Dataset], film: xr.Dataset) -> xr.Dataset:
    """Join batches of realisations, and add the interval of every probability.

    Parameters
    ----------
    batches : sequence of xarray.Dataset
        ``contact_batch`` datasets, together the realisations 0 .. R - 1.
    film : xarray.Dataset
        The ``film`` dataset they were made with.

    Returns
    -------
    xarray.Dataset
        The ``contact`` file of `lube.schema`.

    Raises
    ------
    DataError
        If a realisation is missing or repeated, or the operating points differ.
    """
    return with_intervals(_join(batches), film)


def gather_map(batches: Sequence[xr.Dataset]) -> xr.Dataset:
    """Join batches of a master map, and add the interval of every probability.

    Parameters
    ----------
    batches : sequence of xarray.Dataset
        ``master_batch`` datasets, together the realisations 0 .. R - 1.

    Returns
    -------
    xarray.Dataset
        The ``master`` file of `lube.schema`.

    Raises
    ------
    DataError
        As from `gather`.
    """
    joined = _join(batches)
    return label(with_limits(joined, windows_in(joined, joined["contact_width"])), "master")


def with_intervals(contact: xr.Dataset, film: xr.Dataset) -> xr.Dataset:
    """Add mean, lower and upper limit of each probability, over the realisations present.

    Parameters
    ----------
    contact : xarray.Dataset
        A ``contact_batch`` dataset, or a selection of realisations from a ``contact`` one.
    film : xarray.Dataset
        The ``film`` dataset it was made with.

    Returns
    -------
    xarray.Dataset
        The ``contact`` file of `lube.schema`.

    Raises
    ------
    DataError
        As from `windows_by_force`.
    """
    windows = windows_by_force(contact, film)
    return label(with_pair_limits(with_limits(contact, windows), windows), "contact")


def with_pair_limits(dataset: xr.Dataset, windows: xr.DataArray) -> xr.Dataset:
    """Add the limits between which one pair's probability of breakthrough lies in 95 % of cases.

    Parameters
    ----------
    dataset, windows
        As in `with_limits`. Each realisation is as long as the pair's record.

    Returns
    -------
    xarray.Dataset
        The same, and ``breakthrough_probability_pair_lower`` and ``_pair_upper``, which hold the
        interval of the mean.
    """
    shares = dataset["breakthrough_probability"]
    size, windows = sample_size(shares, windows), _at_each(windows, shares)
    mean, *of_mean = probability_interval(shares.values, windows)
    lower, upper = prediction_limits(mean, size, 1.0, len(shares))
    # What a few realisations have not shown is unknown of one pair, too.
    limits = np.fmin(lower, of_mean[0]), np.fmax(upper, of_mean[1])
    name, dims = "breakthrough_probability_pair", shares.dims[1:]
    ends = zip(LIMITS[1:], limits, strict=True)
    return dataset.assign({f"{name}{end}": (dims, limit) for end, limit in ends})


def sample_size(shares: xr.DataArray, windows: xr.DataArray) -> Array:
    """Find the effective sample size of one realisation at each operating point.

    Parameters
    ----------
    shares : xarray.DataArray
        Shares of time with contact, over realisation and other dimensions.
    windows : xarray.DataArray
        Independent windows in one realisation, over any of these dimensions.

    Returns
    -------
    numpy.ndarray
        From `lube.statistics.sample_size.effective_sample_size`, over the other dimensions.
    """
    return effective_sample_size(shares.values, _at_each(windows, shares))


def _at_each(windows, shares):
    """Windows at each point of the shares."""
    return windows.broadcast_like(shares[0]).transpose(*shares.dims[1:]).values


def _join(batches):
    """Join all realisations in order, and check that none is missing or repeated."""
    # Other attributes may differ: batches of one study may come from different commits.
    batches = [
        batch.drop_attrs(deep=False).assign_attrs({name: batch.attrs[name] for name in ATTRIBUTES})
        for batch in batches
    ]
    minimal = {"data_vars": "minimal", "coords": "minimal", "compat": "equals"}
    strict = {"join": "exact", "combine_attrs": "identical"}
    try:
        joined = xr.concat(batches, "realisation", **minimal, **strict)
    except ValueError as error:
        raise DataError(f"the batches belong to different studies: {error}") from None
    joined = joined.sortby("realisation")
    found = joined["realisation"].values
    if not np.array_equal(found, np.arange(found.size)):
        raise DataError(
            f"realisations: got {found.tolist()}, need each of 0 to {found.size - 1} exactly once"
        )
    return joined


def with_limits(dataset: xr.Dataset, windows: xr.DataArray) -> xr.Dataset:
    """Add mean, lower and upper limit of each probability over the realisations.

    Parameters
    ----------
    dataset : xarray.Dataset
        With `PROBABILITIES` over realisation and other dimensions.
    windows : xarray.DataArray
        Independent windows in one realisation, over any of these dimensions.

    Returns
    -------
    xarray.Dataset
        The same, and the variables ``_mean``, ``_lower`` and ``_upper`` of each probability.
    """
    for name in PROBABILITIES:
        shares = dataset[name]
        interval = probability_interval(shares.values, _at_each(windows, shares))
        dataset = dataset.assign(values_with_limits(name, interval, shares.dims[1:], MEAN_LIMITS))
    return dataset
