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
from lube.grid.discretise import speed_ratios
from lube.schema import label
from lube.statistics import sample_size
from lube.statistics.confidence import probability_interval

PROBABILITIES = ("breakthrough_probability", "geometric_contact_probability")


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
    slower = xr.apply_ufunc(
        lambda ratio: min(speed_ratios(ratio)), contact["slide_to_roll_ratio"], vectorize=True
    )
    return sample_size.independent_windows(
        contact.attrs["travel"] * slower, 2.0 * half_width, contact.attrs["longest_wavelength"]
    )


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
    windows = sample_size.independent_windows(
        joined.attrs["travel"], joined["contact_width"], joined.attrs["longest_wavelength"]
    )
    return _add_intervals(joined, windows, "master")


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
