"""The gauge stage: from the contact share of a record back to the film that explains it.

The master map says how probable contact is at every film and window; read the other way
round it turns an ohmmeter into a film gauge, with no further run of the model. With the film
taken from its formula instead, all records together tell one unknown of the model: the
pressure-viscosity coefficient, or the strength of the boundary layer.
"""

import logging

import numpy as np
import xarray as xr

from lube.curves import film_interval
from lube.fits import fit_alpha, fit_layer_strength, study_strength
from lube.map_curves import curves_at
from lube.schema import LIMITS, POINT_DIMS, label
from lube.shares import (
    compared_in_pure_rolling,
    in_pure_rolling,
    lines_of,
    log_lines,
    on_study_levels,
)

log = logging.getLogger(__name__)


def gauge_records(master, film, contact, experiment):
    """Gauge films, the pressure-viscosity coefficient and the boundary layer.

    Parameters
    ----------
    master, film, contact, experiment : xarray.Dataset
        Datasets of these kinds, of one study.

    Returns
    -------
    xarray.Dataset
        The ``gauge`` file of `lube.schema`, from `gauge_film`, `fit_alpha` and
        `fit_layer_strength`. The attribute ``missing`` tells the points without a
        record, a line each.

    Raises
    ------
    DataError
        If the records have a level that is not the study's, or were not evaluated at their
        comparison threshold.
    """
    shares = compared_in_pure_rolling(film, experiment)
    gauged = gauge_film(master, film, experiment)
    strength = fit_layer_strength(master, film, contact, experiment)
    gauged = gauged.merge(fit_alpha(master, film, contact, experiment)).merge(strength)
    gauged["film_thickness"], gauged["lambda_ratio"] = film["film_thickness"], film["lambda_ratio"]
    gauged["interval_coverage"] = gauge_coverage(master, film, experiment)
    gauged["study_layer_strength"] = study_strength(contact)
    gauged["comparison_threshold"] = experiment["comparison_threshold"].item()
    recorded = shares["contact_share"].notnull()
    gauged["fitted_points"] = recorded.sum([name for name in POINT_DIMS if name != "lubricant"])
    missing = lines_of(~recorded, "no record in pure rolling")
    log_lines(log, missing)
    return label(gauged.assign_attrs(missing="\n".join(missing)), "gauge")


def gauge_film(master, film, experiment):
    """Film thickness and lambda ratio that explain the contact share of every record.

    Only records in pure rolling are gauged, as the map is made for that.

    Parameters
    ----------
    master, film, experiment : xarray.Dataset
        Datasets of these kinds, of one study.

    Returns
    -------
    xarray.Dataset
        ``gauged_film_thickness`` (m) and ``gauged_lambda_ratio`` with ``_lower`` and ``_upper``
        over (lubricant, temperature, speed, force), NaN without a record. A share below what
        the map resolves has no value but a lower limit, and infinity for the upper; one above
        that of the map's thinnest film an upper limit, and zero for the lower. The intervals
        are of 95 %, of the record and the ensemble together.

    Raises
    ------
    DataError
        As `gauge_records`.
    """
    shares = compared_in_pure_rolling(film, experiment)
    records = np.stack([shares[f"contact_share{limit}"].values for limit in LIMITS], axis=-1)
    ratios = np.empty(records.shape)
    for number, half_width in enumerate(film["contact_half_width"].values):
        curves = curves_at(master, 2.0 * half_width)
        for place in np.ndindex(records.shape[:-2]):
            ratios[place][number] = np.exp(film_interval(curves, records[place][number]))
    gauged = xr.Dataset(coords=shares.coords)
    for limit, ratio in zip(LIMITS, np.moveaxis(ratios, -1, 0), strict=True):
        gauged[f"gauged_lambda_ratio{limit}"] = (POINT_DIMS, ratio)
        thickness = ratio * film["composite_rms_roughness"].item()
        gauged[f"gauged_film_thickness{limit}"] = (POINT_DIMS, thickness)
    return gauged


def gauge_coverage(master, film, experiment):
    """Tell how often the interval of a gauged film holds the true one.

    Each revolution of a simulated rig has a roughness of its own, so each is gauged as the
    record of another rig. The truth is the film of the table's first formula, which the
    simulated rig runs with.

    Parameters
    ----------
    master, film, experiment : xarray.Dataset
        Datasets of these kinds, of one study.

    Returns
    -------
    xarray.DataArray
        Share of the revolutions, over (lubricant, temperature, speed, force); NaN of measured
        records, whose true film nobody knows.
    """
    rolling = on_study_levels(in_pure_rolling(experiment), film, "revolution_share")
    dims = (*POINT_DIMS, "revolution")
    records = np.stack(
        [rolling[f"revolution_share{limit}"].transpose(*dims).values for limit in LIMITS], axis=-1
    )
    true = np.log(film["lambda_ratio"].isel(film_formula=0).transpose(*POINT_DIMS).values)
    held = np.full(records.shape[:-1], np.nan)
    for number, half_width in enumerate(film["contact_half_width"].values):
        curves = curves_at(master, 2.0 * half_width)
        for *place, revolution in np.ndindex(records.shape[:-3] + records.shape[-2:-1]):
            index = (*place, number, revolution)
            _, lower, upper = film_interval(curves, records[index])
            if not np.isnan(lower):
                held[index] = lower <= true[index[:-1]] <= upper
    return xr.DataArray(held.mean(axis=-1), dims=POINT_DIMS)
