"""The master map as curves: the probability of breakthrough over the film, at one contact width."""

import numpy as np
import xarray as xr

from lube.curves import falling_curve
from lube.schema import OPERATING_DIMS


def mean_and_limits(dataset):
    """Mean probability of breakthrough over the realisations, and its limits.

    Parameters
    ----------
    dataset : xarray.Dataset
        A ``contact`` or ``master`` dataset.

    Returns
    -------
    list of xarray.DataArray
        Mean, lower and upper limit.
    """
    return [dataset[f"breakthrough_probability_{each}"] for each in ("mean", "lower", "upper")]


def curves_at(master, width):
    """Curves of the mean probability and of its limits.

    Parameters
    ----------
    master : xarray.Dataset
        A ``master`` dataset.
    width : float
        Contact width, m.

    Returns
    -------
    list of lube.curves.Curve
        Of mean, lower and upper limit.
    """
    return [curve_at(each, master, width) for each in mean_and_limits(master)]


def curve_at(probability, master, width):
    """Curve of one probability of the map.

    Parameters
    ----------
    probability : xarray.DataArray
        Over lambda ratio and contact width, in this order.
    master : xarray.Dataset
        The ``master`` dataset that it is from.
    width : float
        Contact width, m.

    Returns
    -------
    lube.curves.Curve
        Over the logarithm of the lambda ratio.

    Notes
    -----
    Contacts that come along the line independently of one another make -ln(1 - p) grow in
    proportion to the width, so it is taken as straight between widths.
    """
    ratios, widths = (probability[name].values for name in probability.dims)
    intensity = -np.log1p(-np.minimum(probability.values, 1.0 - 1e-12))
    here = np.array([np.interp(width, widths, row) for row in intensity])
    return falling_curve(np.log(ratios), -np.expm1(-here), _resolution(master, width))


def _resolution(master, width):
    """Share of one window among all that share no roughness and were seen."""
    windows = master.attrs["travel"] / (width + master.attrs["longest_wavelength"])
    return 1.0 / (max(windows, 1.0) * master.sizes["realisation"])


def logits_on(curve_of_width, film, ratios):
    """Logits of the probability, read off the curve of each force.

    Parameters
    ----------
    curve_of_width : callable
        From a contact width (m) to a `lube.curves.Curve`.
    film : xarray.Dataset
        A ``film`` dataset, for its contact half-widths.
    ratios : xarray.DataArray
        Lambda ratios over the operating dimensions, and others.

    Returns
    -------
    xarray.DataArray
        Over the same dimensions, the operating ones last.
    """
    parts = [
        xr.apply_ufunc(
            curve_of_width(2.0 * half_width.item()).logit_at, np.log(ratios.sel(force=force))
        )
        for force, half_width in film["contact_half_width"].groupby("force")
    ]
    return xr.concat(parts, film["force"], join="exact").transpose(..., *OPERATING_DIMS)
