"""The master map as curves: the probability of breakthrough over the film, at one contact width."""

import numpy as np

from lube.statistics.curves import falling_curve
from lube.statistics.one_pair import independent_windows, sample_size

PROBABILITY = "breakthrough_probability"


def curve_at(master, width):
    """Curve of the mean probability of breakthrough, and of how far single pairs scatter about it.

    Parameters
    ----------
    master : xarray.Dataset
        A ``master`` dataset.
    width : float
        Contact width, m.

    Returns
    -------
    lube.statistics.curves.Curve
        Over the logarithm of the lambda ratio.
    """
    mean = master[f"{PROBABILITY}_mean"]
    widths = master["contact_width"].values
    looks = sample_size(master[PROBABILITY].values, independent_windows(master, widths))
    here = np.array([np.interp(width, widths, row) for row in looks])
    return _curve(mean, master, width, here)


def layer_curve_at(probability, master, width):
    """Curve of the probability that another boundary layer breaks; its scatter is not known.

    Parameters
    ----------
    probability : xarray.DataArray
        Mean over the realisations, over layer_lambda_ratio and layer_contact_width.
    master : xarray.Dataset
        The ``master`` dataset that it is from.
    width : float
        Contact width, m.

    Returns
    -------
    lube.statistics.curves.Curve
        Over the logarithm of the lambda ratio.
    """
    return _curve(probability, master, width, np.full(probability.shape[0], np.nan))


def _curve(probability, master, width, looks):
    """Curve through the levels of a map.

    Contacts that come along the line independently of one another make -ln(1 - p) grow in
    proportion to the width: so it is taken beyond the map's widths, and as straight between.
    """
    ratios, widths = (probability[name].values for name in probability.dims)
    intensity = -np.log1p(-np.minimum(probability.values, 1.0 - 1e-12))
    nearest = np.clip(width, widths[0], widths[-1])
    here = np.array([np.interp(width, widths, row) for row in intensity]) * width / nearest
    resolution = 1.0 / (independent_windows(master, width) * master.sizes["realisation"])
    return falling_curve(np.log(ratios), -np.expm1(-here), looks, resolution)


def logits_on(curve_of_width, widths, ratios):
    """Logits of the probability at the films of some records, each read off its own curve.

    Parameters
    ----------
    curve_of_width : callable
        From a contact width (m) to a `lube.statistics.curves.Curve`.
    widths : xarray.DataArray
        Contact width of each record, m, over ``record``.
    ratios : xarray.DataArray
        Lambda ratios over ``record``, and other dimensions.

    Returns
    -------
    xarray.DataArray
        Over the same dimensions, ``record`` last.
    """
    films = np.log(ratios.transpose(..., "record"))
    logits = films.copy()
    for width in np.unique(widths.values):
        here = widths.values == width
        logits.values[..., here] = curve_of_width(width).logit_at(films.values[..., here])
    return logits
