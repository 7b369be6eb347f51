"""The gauge stage: from the contact share of a record back to the film that explains it.

The master map says how probable contact is at every film and window; read the other way
round it turns an ohmmeter into a film gauge, with no further run of the model. With the film
taken from its formula instead, all records together tell one unknown of the model: the
pressure-viscosity coefficient, or the strength of the boundary layer.
"""

import logging

import numpy as np
import scipy.interpolate
import xarray as xr

from lube.curves import (
    falling_curve,
    film_interval,
    fit_factor,
    independent_looks,
    realisation_correlation,
)
from lube.formulas import formula
from lube.schema import POINT_DIMS, label
from lube.shares import (
    LIMITS,
    at_comparison_threshold,
    in_pure_rolling,
    lines_of,
    log_lines,
    on_study_levels,
)

log = logging.getLogger(__name__)

ALPHA_FACTORS = np.geomspace(1.0 / 8.0, 8.0, 193)
"""Factors of the pressure-viscosity coefficient that are tried."""
STRENGTH_LEVELS = 193
"""Strengths of the boundary layer that are tried, between the map's weakest and strongest."""


def gauge(master, film, contact, experiment):
    """Gauge films, the pressure-viscosity coefficient and the boundary layer.

    Parameters
    ----------
    master, film, contact, experiment : xarray.Dataset
        Datasets of these kinds, of one study.

    Returns
    -------
    xarray.Dataset
        The ``gauge`` file of `lube.schema`, from `gauge_film`, `fit_alpha` and
        `fit_layer_strength`. The attribute ``missing`` lists the points without a record.

    Raises
    ------
    DataError
        If the records are all with slip, have a level that is not the study's, or were not
        evaluated at their comparison threshold.
    """
    shares = _shares(film, experiment)
    gauged = gauge_film(master, film, experiment)
    strength = fit_layer_strength(master, film, contact, experiment)
    gauged = gauged.merge(fit_alpha(master, film, contact, experiment)).merge(strength)
    gauged["film_thickness"], gauged["lambda_ratio"] = film["film_thickness"], film["lambda_ratio"]
    gauged["study_layer_strength"] = _study_strength(contact)
    gauged["comparison_threshold"] = experiment["comparison_threshold"].item()
    recorded = shares["contact_share"].notnull()
    gauged["fitted_points"] = recorded.sum([name for name in POINT_DIMS if name != "lubricant"])
    missing = lines_of(~recorded, "no record in pure rolling")
    log_lines(log, missing)
    return label(gauged.assign_attrs(missing=missing), "gauge")


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
        As `gauge`.
    """
    shares = _shares(film, experiment)
    curves = {
        force: _curves(master, 2.0 * half_width)
        for force, half_width in zip(
            film["force"].values, film["contact_half_width"].values, strict=True
        )
    }
    records = np.stack([shares[f"contact_share{limit}"].values for limit in LIMITS], axis=-1)
    ratios = np.empty(records.shape)
    for place in np.ndindex(records.shape[:-1]):
        ratios[place] = np.exp(film_interval(curves[film["force"].values[place[-1]]], records[place]))
    gauged = xr.Dataset(coords=shares.coords)
    for limit, ratio in zip(LIMITS, np.moveaxis(ratios, -1, 0), strict=True):
        gauged[f"gauged_lambda_ratio{limit}"] = (POINT_DIMS, ratio)
        thickness = ratio * film["composite_rms_roughness"].item()
        gauged[f"gauged_film_thickness{limit}"] = (POINT_DIMS, thickness)
    return gauged


def fit_alpha(master, film, contact, experiment):
    """Factor of the pressure-viscosity coefficient that explains all records together.

    For every lubricant and film formula one factor, common to all operating points. The film is
    recomputed by the formula itself, and the probability read from the map.

    All points see the same rollers, so their errors are correlated: as the realisations in
    `contact` are at those points, for the records and for the ensemble behind the map alike.
    The size of a record's error is its own interval's, that of the map the ensemble's. Assumed
    besides: that the film formula is right but for the coefficient, that the simulated
    roughness is the rollers', and that the records' intervals hold each for itself.

    Parameters
    ----------
    master, film, contact, experiment : xarray.Dataset
        Datasets of these kinds, of one study.

    Returns
    -------
    xarray.Dataset
        ``alpha_factor`` with ``_lower`` and ``_upper`` over (lubricant, film_formula): 1 is the
        coefficient of the study. Beyond `ALPHA_FACTORS` the factor is NaN, a limit 0 or
        infinity.

    Raises
    ------
    DataError
        As `gauge`.
    """

    def logits(table):
        ratios = _ratios_by_alpha(table)
        return _over_forces(table, lambda force: _logits(master, ratios.sel(force=force), force))

    factors = np.log(ALPHA_FACTORS)
    return _fits("alpha_factor", factors, logits, film, contact, experiment)


def fit_layer_strength(master, film, contact, experiment):
    """Strength tau0 / h_c of the boundary layer that explains all records together.

    As `fit_alpha`, with the film left as the formula gives it.

    Parameters
    ----------
    master, film, contact, experiment : xarray.Dataset
        Datasets of these kinds, of one study.

    Returns
    -------
    xarray.Dataset
        ``fitted_layer_strength`` (Pa/m) with ``_lower`` and ``_upper`` over (lubricant,
        film_formula). Beyond the strengths of the map it is NaN, a limit 0 or infinity.

    Raises
    ------
    DataError
        As `gauge`.
    """
