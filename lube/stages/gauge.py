"""The gauge stage: from the contact share of a record back to the film that explains it.

The master map says how probable contact is at every film and window; read the other way
round it turns an ohmmeter into a film gauge, with no further run of the model. With the film
taken from its formula instead, all records together tell one unknown of the model: the
pressure-viscosity coefficient, or the strength of the boundary layer.

A record comes from one pair of rollers. How far its share may lie from the mean of the map is
the scatter between the map's realisations, which its interval holds besides the map's own error.
"""

import logging
from functools import cache

import numpy as np
import scipy.special
import xarray as xr

from lube.rig.fits import fit_alpha, fit_layer_strength, study_strength
from lube.schema import AT_RECORDS, LIMITS, label
from lube.statistics.curves import film_interval
from lube.statistics.map_curves import curve_at
from lube.statistics.one_pair import quantile, standard_error

log = logging.getLogger(__name__)

_KEPT = ("film_thickness", "lambda_ratio", "contact_half_width", "comparison_threshold")


def gauge_records(master, contact, comparison):
    """Gauge films, the pressure-viscosity coefficient and the boundary layer.

    Parameters
    ----------
    master, contact, comparison : xarray.Dataset
        Datasets of these kinds, of one study.

    Returns
    -------
    xarray.Dataset
        The ``gauge`` file of `lube.schema`, from `gauge_film`, `gauge_coverage`, `fit_alpha` and
        `fit_layer_strength`.
    """
    gauged = comparison[[*_KEPT, *AT_RECORDS, "origin", "pairs", "drift"]]
    parts = (
        gauge_film(master, comparison),
        gauge_coverage(master, comparison),
        fit_alpha(master, contact, comparison),
        fit_layer_strength(master, contact, comparison),
    )
    for part in parts:
        gauged = gauged.merge(part, join="exact", combine_attrs="drop")
    gauged["study_layer_strength"] = study_strength(contact)
    oils = gauged["fitted_lubricant"].values
    recorded = np.isfinite(comparison["measured_share"].values)
    counts = [np.count_nonzero(recorded & (comparison["lubricant"].values == oil)) for oil in oils]
    gauged["fitted_records"] = "fitted_lubricant", counts
    return label(gauged.drop_attrs(deep=False), "gauge")


def gauge_film(master, comparison):
    """Film thickness and lambda ratio that explain the contact share of every record.

    Parameters
    ----------
    master, comparison : xarray.Dataset
        Datasets of these kinds, of one study.

    Returns
    -------
    xarray.Dataset
        ``gauged_film_thickness`` (m) and ``gauged_lambda_ratio`` with ``_lower`` and ``_upper``
        over ``record``, NaN without a share. A share below what the map resolves has no value
        but a lower limit, and infinity for the upper; one above that of the map's thinnest film
        an upper limit, and zero for the lower. The intervals are of 95 %, of one pair's record
        and the ensemble together.
    """
    curve = cache(lambda width: curve_at(master, width))
    count = master.sizes["realisation"]
    records = zip(
        2.0 * comparison["contact_half_width"].values,
        comparison["measured_share"].values,
        comparison["scatter_ratio"].values[0],
        comparison["share_error"].values,
        strict=True,
    )
    films = [
        film_interval(curve(width), share, ratio, count, noise)
        for width, share, ratio, noise in records
    ]
    ratios = np.exp(films)
    ratios[:, 0] = np.where(np.isfinite(films)[:, 0], ratios[:, 0], np.nan)
    gauged = xr.Dataset()
    for limit, ratio in zip(LIMITS, ratios.T, strict=True):
        gauged[f"gauged_lambda_ratio{limit}"] = "record", ratio
        thickness = ratio * comparison["composite_rms_roughness"].item()
        gauged[f"gauged_film_thickness{limit}"] = "record", thickness
    return gauged


def gauge_coverage(master, comparison):
    """How often the interval of a gauged film holds the true one, were each realisation the rig.

    Each realisation in turn is left out of the map and gauged by the others as the record of
    one pair of rollers, one revolution long, at the films of the first formula. Its interval
    holds the true film where its share lies within the prediction of the others there.

    Parameters
    ----------
    master, comparison : xarray.Dataset
        Datasets of these kinds, of one study.

    Returns
    -------
    xarray.Dataset
        Over ``record``: ``interval_coverage``, of all intervals, ``closed_coverage`` of those
        with two limits, ``one_sided_coverage`` of the others, and ``closed_share``, how many
        have two; NaN where there are none, or the ensemble has fewer than three realisations.
    """
    members = comparison["breakthrough_probability"].values[:, 0]
    count, records = members.shape
    coverage = np.full((4, records), np.nan)
    places = range(records) if count > 2 else ()
    films = np.log(comparison["lambda_ratio"].values[0])
    widths = 2.0 * comparison["contact_half_width"].values
    curve = cache(lambda width: curve_at(master, width))
    for place in places:
        held, closed = _left_out(curve(widths[place]), films[place], members[:, place])
        apart = (_mean(held[closed]), _mean(held[~closed]))
        coverage[:, place] = np.mean(held), *apart, np.mean(closed)
    names = ("interval_coverage", "closed_coverage", "one_sided_coverage", "closed_share")
    return xr.Dataset({name: ("record", row) for name, row in zip(names, coverage, strict=True)})


def _mean(held):
    return np.mean(held) if held.size else np.nan


def _left_out(curve, film, shares):
    """Whether the interval of each realisation holds a film, and whether it has two limits."""
    count = shares.size
    if curve.films.size < 2:
        return np.ones(count, bool), np.zeros(count, bool)
    places = (curve.films[0], film, curve.films[-1])
    distances = [_distance(curve, place, shares) for place in places]
    limit = quantile(count - 1)
    closed = (distances[0] < -limit) & (distances[2] > limit)
    return np.abs(distances[1]) <= limit, closed


def _distance(curve, film, shares):
    """Distance of each realisation from the mean of the others, over its standard error."""
    count = shares.size
    mean = scipy.special.expit(curve.logit_at(film))
    others = (count * mean - shares) / (count - 1)
    others = np.clip(others, 0.0, 1.0)
    sample_size = np.interp(film, curve.films, curve.sample_size)
    with np.errstate(divide="ignore", invalid="ignore"):
        distance = (shares - others) / standard_error(others, sample_size, 1.0, count - 1)
    return np.where(shares == others, 0.0, distance)
