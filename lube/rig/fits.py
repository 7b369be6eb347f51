"""One unknown of the model, from all records together.

The film is taken from its formula and the probability from the master map; what is looked for is
the pressure-viscosity coefficient, or the strength of the boundary layer, that explains the
records best.
"""

import numpy as np
import scipy.interpolate
import scipy.special
import xarray as xr

from lube.physics.film_formulas import formula
from lube.rig.study_shares import values_with_limits
from lube.schema import LIMITS
from lube.statistics.curves import fit_factor, realisation_correlation
from lube.statistics.map_curves import curve_at, layer_curve_at, logits_on
from lube.statistics.one_pair import quantile
from lube.statistics.sample_size import effective_sample_size, independent_windows

ALPHA_FACTORS = np.geomspace(1.0 / 8.0, 8.0, 193)
"""Factors of the pressure-viscosity coefficient that are tried."""
STRENGTH_LEVELS = 193
"""Strengths of the boundary layer that are tried, between the map's weakest and strongest."""


def fit_alpha(master, contact, comparison):
    """Factor of the pressure-viscosity coefficient that explains all records together.

    For every lubricant and film formula one factor, common to all records. The film is
    recomputed by the formula itself, and the probability read from the map.

    All records of a pair see the same rollers, so their errors are correlated as the
    realisations are; those of different pairs are not, but the map's own error is common to
    all. Assumed besides: that the film formula is right but for the coefficient, and that the
    simulated roughness is the rollers'.

    Parameters
    ----------
    master, contact, comparison : xarray.Dataset
        Datasets of these kinds, of one study.

    Returns
    -------
    xarray.Dataset
        ``alpha_factor`` with ``_lower`` and ``_upper`` over (fitted_lubricant, film_formula): 1
        is the coefficient of the study. Beyond `ALPHA_FACTORS` the factor is NaN, a limit 0 or
        infinity. ``alpha_factor_coverage`` is the share of realisations whose interval, each
        left out and taken as the records, holds 1.
    """
    logits = alpha_logits(master, comparison)
    return _fits("alpha_factor", ALPHA_FACTORS, 1.0, logits, contact, comparison)


def alpha_logits(master, comparison):
    """Logits of the map's mean probability at the records, for each of `ALPHA_FACTORS`.

    Parameters
    ----------
    master, comparison : xarray.Dataset
        Datasets of these kinds, of one study.

    Returns
    -------
    xarray.DataArray
        Over (factor, film_formula, record).
    """
    factor = xr.DataArray(ALPHA_FACTORS, dims="factor")
    logits = _mean_logits(master, comparison, _ratios(comparison, factor))
    return logits.transpose("factor", "film_formula", "record")


def fit_layer_strength(master, contact, comparison):
    """Strength tau0 / h_c of the boundary layer that explains all records together.

    As `fit_alpha`, with the film left as the formula gives it.

    Parameters
    ----------
    master, contact, comparison : xarray.Dataset
        Datasets of these kinds, of one study.

    Returns
    -------
    xarray.Dataset
        ``fitted_layer_strength`` (Pa/m) with ``_lower`` and ``_upper`` over (fitted_lubricant,
        film_formula). Beyond the strengths of the map it is NaN, a limit 0 or infinity.
        ``fitted_layer_strength_coverage`` as in `fit_alpha`.
    """
    tried, logits = strength_logits(master, contact, comparison)
    truth = study_strength(contact)
    return _fits("fitted_layer_strength", tried, truth, logits, contact, comparison)


def strength_logits(master, contact, comparison):
    """Logits of the map's mean probability at the records, for many strengths of the layer.

    Parameters
    ----------
    master, contact, comparison : xarray.Dataset
        Datasets of these kinds, of one study.

    Returns
    -------
    tried : numpy.ndarray
        The strengths, shape (factor,), Pa/m, rising.
    logits : xarray.DataArray
        Over (factor, film_formula, record).
    """
    tried = np.geomspace(*master["layer_strength"].values[[0, -1]], STRENGTH_LEVELS)
    logits = _strength_logits(master, comparison, study_strength(contact))
    # A record at which some layer's contact is too rare for the map is left out.
    known = logits.notnull().all("layer_strength")
    spline = scipy.interpolate.PchipInterpolator(
        np.log(logits["layer_strength"]), logits.fillna(0.0)
    )
    return tried, known.expand_dims(factor=tried.size).copy(data=spline(np.log(tried))).where(known)


def _ratios(comparison, factor):
    """Lambda ratios with the pressure-viscosity coefficient times a factor.

    The dimensionless groups follow from the film at the records: W = pi/8 (a / R*)^2 from Hertz'
    half-width, U and G from Moes' numbers M = W (2U)^(-1/2) and L = G (2U)^(1/4).
    """
    with xr.set_options(arithmetic_join="exact", keep_attrs=False):
        load = np.pi / 8.0 * (comparison["contact_half_width"] / comparison["reduced_radius"]) ** 2
        speed = 0.5 * (load / comparison["moes_load"]) ** 2
        material = factor * comparison["moes_material"] / (2.0 * speed) ** 0.25
        names = comparison["film_formula"]
        films = [formula(name).evaluate(load, speed, material) for name in names.values]
        scale = comparison["reduced_radius"] / comparison["composite_rms_roughness"]
        return xr.concat(films, names, join="exact") * scale


def _mean_logits(master, comparison, ratios):
    """Logits of the map's mean probability, at some lambda ratios."""
    widths = 2.0 * comparison["contact_half_width"]
    return logits_on(lambda width: curve_at(master, width), widths, ratios)


def study_strength(contact):
    """Strength of the study's boundary layer: nothing else of the layer matters.

    Parameters
    ----------
    contact : xarray.Dataset
        A ``contact`` dataset.

    Returns
    -------
    float
        tau0 / h_c, Pa/m.
    """
    return contact["shear_strength"].item() / contact["critical_thickness"].item()


def _strength_logits(master, comparison, study):
    """Logits over (layer_strength, film_formula, record).

    The study's layer has the fine map; the coarse one tells how much other layers differ.
    """
    maps = master["layer_breakthrough_probability"].mean("realisation")
    ratios, widths = comparison["lambda_ratio"], 2.0 * comparison["contact_half_width"]
    coarse = [
        logits_on(lambda width, one=one: layer_curve_at(one, master, width), widths, ratios)
        for one in (maps.sel(layer_strength=strength) for strength in maps.layer_strength)
    ]
    coarse = xr.concat(coarse, maps["layer_strength"], join="exact")
    fine = _mean_logits(master, comparison, ratios)
    logits = fine + coarse - coarse.sel(layer_strength=study, method="nearest", drop=True)
    return logits.transpose("layer_strength", "film_formula", "record")


def _fits(name, tried, truth, logits, contact, comparison):
    """Fit a factor, with its limits and coverage, for every lubricant and film formula."""
    oils, formulas = contact["lubricant"].values, comparison["film_formula"].values
    fits = np.full((oils.size, formulas.size, len(LIMITS) + 1), np.nan)
    for o, f in np.ndindex(fits.shape[:-1]):
        records = comparison["lubricant"].values == oils[o]
        here = comparison.isel(film_formula=f, record=records)
        model = logits.isel(film_formula=f, record=records).values
        coverage = _coverage(np.log(tried), np.log(truth), model, here)
        fits[o, f] = *fit_records(np.log(tried), model, here), coverage
    *found, coverage = np.moveaxis(fits, -1, 0)
    variables = values_with_limits(name, found) | {f"{name}_coverage": coverage}
    dims = ("fitted_lubricant", "film_formula")
    return xr.Dataset(
        {each: (dims, values) for each, values in variables.items()},
        coords={"fitted_lubricant": oils, "film_formula": formulas},
    )


def fit_records(log_factors, logits, comparison):
    """Fit a factor to records of one lubricant, by one film formula.

    Parameters
    ----------
    log_factors : numpy.ndarray
        Logarithms of the factor, shape (F,), rising.
    logits : numpy.ndarray
        Of the model's probability, shape (F, P).
    comparison : xarray.Dataset
        A ``comparison`` dataset of these P records and one film formula, without its dimension.

    Returns
    -------
    factor, lower, upper : float
        From `lube.statistics.curves.fit_factor`.
    """
    shares = comparison["measured_share"].values
    used = np.isfinite(shares) & np.isfinite(logits).all(axis=0)
    comparison = comparison.isel(record=used)
    probabilities, looks = _members(comparison)
    count = probabilities.shape[0]
    covariance = _correlation(comparison["record_deviation"].values) * _of_records(comparison)
    covariance += realisation_correlation(probabilities) / count
    noise = comparison["share_error"].values
    return fit_factor(log_factors, logits[:, used], shares[used], looks, covariance, count, noise)


def _correlation(deviations):
    """Correlation between the records of one pair, by the realisations that tell it."""
    return realisation_correlation(deviations[np.isfinite(deviations).all(axis=1)])


def _members(comparison):
    """Probabilities of the realisations at the records, and their effective sample size."""
    probabilities = comparison["breakthrough_probability"].values
    widths = 2.0 * comparison["contact_half_width"].values
    attributes = comparison.attrs
    windows = independent_windows(attributes["travel"], widths, attributes["longest_wavelength"])
    return probabilities, effective_sample_size(probabilities, windows)


def _of_records(comparison):
    """Scatter ratio of the records, and between those of one pair; none between pairs."""
    ratio = np.sqrt(comparison["scatter_ratio"].values)
    pair = comparison["pair"].values
    return np.where(pair[:, None] == pair, ratio[:, None] * ratio, 0.0)


def _coverage(log_factors, truth, logits, comparison):
    """Share of the realisations, each left out and taken as the records, whose interval is right.

    The interval is all that the misfit does not contradict, so it holds the truth where the
    misfit there is within its quantile.
    """
    used = np.isfinite(comparison["measured_share"].values) & np.isfinite(logits).all(axis=0)
    logits = logits[:, used]
    probabilities, looks = _members(comparison.isel(record=used))
    count = probabilities.shape[0]
    if count < 3 or not looks.size:
        return np.nan
    slopes = np.gradient(logits, log_factors, axis=0)
    place = int(np.argmin(np.abs(log_factors - truth)))
    model = scipy.special.expit(logits[place])
    pull = looks * slopes[place]
    others = (count * model - probabilities) / (count - 1)
    misfit = np.sum(pull * (probabilities - others), axis=1)
    sums = np.sum(pull * probabilities, axis=1)
    scatter = np.array([np.delete(sums, one).std(ddof=1) for one in range(count)])
    error = scatter * np.sqrt(1.0 + 1.0 / (count - 1))
    return np.mean(np.abs(misfit) <= quantile(count - 1) * error)
