"""From realisations to probabilities with honest intervals.

The scatter between realisations says how many independent looks at the contact an ensemble
is worth: were each look a coin that shows contact with probability p, the variance of the
mean would be p (1 - p) / n. With this effective number n, Wilson's score interval stays
within 0 and 1, is lopsided near either end as it should be, and becomes the usual
mean +- t s / sqrt(R) in between.
"""

import numpy as np
import xarray as xr

from lube.errors import DataError
from lube.intervals import mean_over_first, probability_limits
from lube.schema import label
from lube.steps import speed_ratios

PROBABILITIES = ("breakthrough_probability", "geometric_contact_probability")


def effective_looks(probabilities):
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
    in for it, as where contact was seen never or always (`lube.intervals`): so many windows
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
    looks = np.where(scattered, effective_looks(probabilities), np.nan)
    lower, upper = probability_limits(mean, looks, max(realisations - 1, 1), windows * realisations)
    return mean, lower, upper


def independent_windows(contact, film):
    """Windows that share no roughness, in one realisation, for each force and slip.

    Two windows see independent roughness where they are a longest wavelength apart on both
    surfaces, so it is the travel of the slower one that counts: a roller at rest shows all
    windows the same.

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
    reach = 2.0 * half_width + contact.attrs["longest_wavelength"]
    slower = xr.apply_ufunc(
        lambda ratio: min(speed_ratios(ratio)), contact["slide_to_roll_ratio"], vectorize=True
    )
    return np.maximum(contact.attrs["travel"] * slower / reach, 1.0)


def gather(batches, film):
    """Join batches of realisations and give every probability its interval.

    Parameters
    ----------
    batches : list of xarray.Dataset
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
        If a realisation is missing or comes twice, or the operating points differ.
    """
    return with_intervals(_join(batches), film)


def gather_map(batches):
    """Join batches of a master map and give every probability its interval.

    Parameters
    ----------
    batches : list of xarray.Dataset
        ``master_batch`` datasets, together the realisations 0 .. R - 1.

    Returns
    -------
    xarray.Dataset
        The ``master`` file of `lube.schema`.

    Raises
    ------
    DataError
        As `gather`.
    """
    joined = _join(batches)
    reach = joined["contact_width"] + joined.attrs["longest_wavelength"]
    return _add_intervals(joined, np.maximum(joined.attrs["travel"] / reach, 1.0), "master")


def _join(batches):
    """All realisations in order, each once."""
    # Batches of one study may have been made at different commits, and say so.
    batches = [_with_attributes(batch) for batch in batches]
    try:
        joined = xr.concat(
            batches,
            "realisation",
            data_vars="minimal",
            coords="minimal",
            compat="equals",
            join="exact",
            combine_attrs="identical",
        )
    except ValueError as error:
        raise DataError(f"the batches belong to different studies: {error}") from None
    joined = joined.sortby("realisation")
    found = joined["realisation"].values
    if not np.array_equal(found, np.arange(found.size)):
        raise DataError(f"need realisations 0 to {found.size - 1}, each once, got {found.tolist()}")
    return joined


def _with_attributes(batch):
    """Keep of a batch's attributes those that its values follow from."""
    kept = batch.copy()
    kept.attrs = {name: batch.attrs[name] for name in ("travel", "longest_wavelength")}
    return kept


def with_intervals(contact, film):
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
    """
    return _add_intervals(contact, independent_windows(contact, film), "contact")


def _add_intervals(dataset, windows, kind):
    dataset = dataset.copy()
    for name in PROBABILITIES:
        dims = dataset[name].dims[1:]
        everywhere = windows.broadcast_like(dataset[name][0]).transpose(*dims)
        limits = probability_interval(dataset[name].values, everywhere.values)
        for suffix, values in zip(("mean", "lower", "upper"), limits, strict=True):
            dataset[f"{name}_{suffix}"] = (dims, values)
    return label(dataset, kind)
