"""The master map as curves: breakthrough probability against the film, at one contact width."""

from collections.abc import Callable

import numpy as np
import xarray as xr

from lube.contact.ensemble import windows_in
from lube.statistics.curves import Curve, peaked_curve
from lube.statistics.sample_size import effective_sample_size

PROBABILITY = "breakthrough_probability"


def curve_at(master: xr.Dataset, width: float) -> Curve:
    """Curve of the mean breakthrough probability and of its effective sample size.

    Parameters
    ----------
    master : xarray.Dataset
        A ``master`` dataset.
    width : float
        Contact width, m.

    Returns
    -------
    Curve
        Against the logarithm of the lambda ratio.
    """
    mean = master[f"{PROBABILITY}_mean"]
    widths = master["contact_width"].values
    sample_size = effective_sample_size(master[PROBABILITY].values, windows_in(master, widths))
    here = np.array([np.interp(width, widths, row) for row in sample_size])
    return _curve(mean, master, width, here)


def layer_curve_at(probability: xr.DataArray, master: xr.Dataset, width: float) -> Curve:
    """Curve of the mean breakthrough probability of another boundary layer.

    Parameters
    ----------
    probability : xarray.DataArray
        Mean over the realisations, over layer_lambda_ratio and layer_contact_width.
    master : xarray.Dataset
        The ``master`` dataset from which it is taken.
    width : float
        Contact width, m.

    Returns
    -------
    Curve
        Against the logarithm of the lambda ratio; its sample size is unknown, NaN.
    """
    return _curve(probability, master, width, np.full(probability.shape[0], np.nan))


def _curve(probability, master, width, sample_size):
    """Curve through the levels of a map.

    If contacts occur independently along the line, -ln(1 - p) is proportional to the width. It is
    extrapolated so beyond the map's widths, and interpolated linearly between them.
    """
    ratios, widths = (probability[name].values for name in probability.dims)
    intensity = -np.log1p(-np.minimum(probability.values, 1.0 - 1e-12))
    nearest = np.clip(width, widths[0], widths[-1])
    here = np.array([np.interp(width, widths, row) for row in intensity]) * width / nearest
    resolution = 1.0 / (windows_in(master, width) * master.sizes["realisation"])
    return peaked_curve(np.log(ratios), -np.expm1(-here), sample_size, resolution)


def logits_on(
    curve_of_width: Callable[[float], Curve], widths: xr.DataArray, ratios: xr.DataArray
) -> xr.DataArray:
    """Logits of the probability at the films of records, each from the curve of its own width.

    Parameters
    ----------
    curve_of_width : callable
        The curve at a contact width, m, such as `curve_at` of a master map.
    widths : xarray.DataArray
        Contact width of each record, m, over ``record``.
    ratios : xarray.DataArray
        Lambda ratios over ``record`` and other dimensions.

    Returns
    -------
    xarray.DataArray
        Over the same dimensions, ``record`` last.

    Examples
    --------
    >>> curve = Curve(np.array([0.0, 1.0]), np.array([2.0, -2.0]), np.full(2, 50.0))
    >>> widths = xr.DataArray([1e-4, 2e-4], dims="record")
    >>> logits_on(lambda width: curve, widths, xr.ones_like(widths)).values
    array([2., 2.])
    """
    films = np.log(ratios.transpose(..., "record"))
    logits = films.copy()
    for width in np.unique(widths.values):
        here = widths.values == width
        logits.values[..., here] = curve_of_width(width).logit_at(films.values[..., here])
    return logits
