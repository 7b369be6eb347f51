"""Fits of one unknown of the model to all records together.

The film thickness is taken from its formula and the probability from the records' curves. The fit
varies the pressure-viscosity coefficient, or the strength of the boundary layer.
"""

from dataclasses import replace

import numpy as np
import scipy
import xarray as xr

from lube.contact.ensemble import windows_at_records
from lube.contact.surface_strip import SURFACES
from lube.ehl.film_formulas import formula
from lube.grid.films import FilmGroups, unreported
from lube.grid.load_sharing import MOST
from lube.inference.record_curves import PROBABILITY, RecordCurves, realised_shares
from lube.inference.surface_scatter import pair_correlation
from lube.schema import LIMITS, values_with_limits, with_dims
from lube.statistics.curves import fit_factor, realisation_correlation
from lube.statistics.one_pair import quantile
from lube.study.study import Study
from lube.types import Array

Data = xr.Dataset

ALPHA_FACTORS = np.geomspace(1.0 / 8.0, 8.0, 193)
"""Factors of the pressure-viscosity coefficient that are tried."""
COMPUTED_FACTORS = np.array([0.125, 0.25, 0.5, 1.0, 2.0])
"""Factors at which a computed film is solved for. Beyond them it is taken to grow as a power of the
factor: the pressure spike of so viscous an oil is too steep to be resolved."""
STRENGTH_LEVELS = 193
"""Number of layer strengths that are tried, from the weakest of the curves to the strongest."""


def fit_alpha(curves: RecordCurves, study: Study, comparison: Data) -> Data:
    """Fit the factor of the pressure-viscosity coefficient to all records together.

    For every lubricant and film formula there is one factor, common to all records. The film
    thickness is recomputed with the formula, and the probability read from the records' curves.

    All records of a pair see the same rollers, so their errors are correlated as the
    realisations are; those of different pairs are independent, except for the curves' own error.
    It is assumed that the film formula is correct except for the coefficient, and that the
    simulated roughness is that of the rollers.

    Parameters
    ----------
    curves : RecordCurves
        Curves of the records of the comparison.
    study : Study
        Its lubricants and boundary layer.
    comparison : xarray.Dataset
        A ``comparison`` dataset of the study.

    Returns
    -------
    xarray.Dataset
        ``alpha_factor`` with ``_lower`` and ``_upper`` over (fitted_lubricant, film_formula): 1
        is the coefficient of the study. Beyond `ALPHA_FACTORS` the factor is NaN, a limit 0 or
        infinity. For ``alpha_factor_coverage`` each realisation in turn is left out of the ensemble
        and taken as the records, or each drawn pair of surfaces; it is the fraction of these cases
        whose interval contains 1, or NaN if none has contact. ``alpha_factor_explained`` is the
        fraction of the records whose share lies in the 95 % prediction interval of one pair with
        the factor, NaN without a factor: the best factor need not explain any.
    """
    logits = alpha_logits(curves, comparison)
    model = curves.contact_model
    return _fits("alpha_factor", ALPHA_FACTORS, 1.0, logits, study, comparison, model)


def alpha_logits(curves: RecordCurves, comparison: Data) -> xr.DataArray:
    """Logits of the mean probability at the records, for each of `ALPHA_FACTORS`.

    Parameters
    ----------
    curves, comparison
        As in `fit_alpha`.

    Returns
    -------
    xarray.DataArray
        Over (factor, film_formula, record).
    """
    logits = curves.logits(_lambda_ratios(comparison, xr.DataArray(ALPHA_FACTORS, dims="factor")))
    return logits.transpose("factor", "film_formula", "record")


def fit_layer_strength(curves: RecordCurves, study: Study, comparison: Data) -> Data:
    """Fit the strength tau0 / h_c of the boundary layer to all records together.

    As `fit_alpha`, with the film thickness as the formula gives it.

    Parameters
    ----------
    curves : RecordCurves
        Curves of the records of the comparison.
    study : Study
        Its lubricants and boundary layer.
    comparison : xarray.Dataset
        A ``comparison`` dataset of the study.

    Returns
    -------
    xarray.Dataset
        ``fitted_layer_strength`` (Pa/m) with ``_lower`` and ``_upper`` over (fitted_lubricant,
        film_formula). Beyond the strengths of the curves it is NaN, a limit 0 or infinity.
        ``fitted_layer_strength_coverage`` and ``_explained`` as in `fit_alpha`.
    """
    strength, model = study.boundary_layer.strength, curves.contact_model
    tried, logits = strength_logits(curves, strength, comparison)
    return _fits("fitted_layer_strength", tried, strength, logits, study, comparison, model)


def strength_logits(
    curves: RecordCurves, strength: float, comparison: Data
) -> tuple[Array, xr.DataArray]:
    """Logits of the mean probability at the records, for many layer strengths.

    Parameters
    ----------
    curves : RecordCurves
        Curves of the records of the comparison.
    strength : float
        Strength of the study's layer, Pa/m.
    comparison : xarray.Dataset
        A ``comparison`` dataset of the study.

    Returns
    -------
    tried : numpy.ndarray
        The strengths, shape (factor,), Pa/m, increasing.
    logits : xarray.DataArray
        Over (factor, film_formula, record).
    """
    tried = np.geomspace(*curves.strengths[[0, -1]], STRENGTH_LEVELS)
    # Curves of layers are coarse, so only their difference from the study's layer is used.
    ratios = comparison["lambda_ratio"]
    coarse = curves.layer_logits(ratios)
    own = coarse.sel(layer_strength=strength, method="nearest", drop=True)
    logits = curves.logits(ratios) + coarse - own
    logits = logits.transpose("layer_strength", "film_formula", "record")
    # A record is left out if contact with any of the layers is too rare for the curves there.
    known = logits.notnull().all("layer_strength")
    strengths = np.log(logits["layer_strength"])
    spline = scipy.interpolate.PchipInterpolator(strengths, logits.fillna(0.0))
    return tried, known.expand_dims(factor=tried.size).copy(data=spline(np.log(tried))).where(known)


def _lambda_ratios(comparison, factor):
    """Lambda ratios with the pressure-viscosity coefficient multiplied by a factor.

    Starvation depends on the film, but inlet shear heating does not depend on the coefficient. The
    load that asperities carry stays that of the study's coefficient.
    """
    with xr.set_options(arithmetic_join="exact", keep_attrs=False):
        groups, names = FilmGroups.of(comparison), comparison["film_formula"]
        share = comparison.get("surface_load_share", xr.zeros_like(comparison["lambda_ratio"]))
        oil = (1.0 - share).where(share <= MOST)  # no balance was found of larger shares
        films = [
            _films(formula(name), replace(groups, load=groups.load * part), factor)
            for name, part in zip(names.values, oil, strict=True)
        ]
        scale = comparison["reduced_radius"] / comparison["composite_rms_roughness"]
        scale = scale * comparison.get("inlet_shear_heating_factor", 1.0)
        return xr.concat(films, names, join="exact") * scale


def _films(row, groups, factor):
    """Films over R* with G multiplied by factors."""

    def film(factors):
        return replace(groups, material=factors * groups.material).film(row)

    if not row.depends_on_oil:
        # A few factors at a time: the integral of starvation takes a hundred times their memory.
        parts = np.array_split(range(factor.size), 1 + factor.size // 20)
        return xr.concat([film(factor[some]) for some in parts], "factor", join="exact")
    with unreported():
        films = film(xr.DataArray(COMPUTED_FACTORS, dims="factor"))
    core = {"input_core_dims": [["node"], ["factor"]], "output_core_dims": [["factor"]]}
    nodes = films.rename(factor="node")
    return xr.apply_ufunc(_between_nodes, nodes, factor, **core, vectorize=True)


def _between_nodes(films, factor):
    """Film at each factor, from the films at `COMPUTED_FACTORS` that converged."""
    known = np.isfinite(films)
    if known.sum() < 2:
        return np.full(factor.size, np.nan)
    nodes, last = np.log(COMPUTED_FACTORS[known]), np.log(COMPUTED_FACTORS[known][-1])
    curve = scipy.interpolate.CubicSpline(nodes, np.log(films[known]))
    beyond = np.maximum(np.log(factor) - last, 0.0)
    return np.exp(curve(np.minimum(np.log(factor), last)) + beyond * curve(last, 1))


def _fits(name, tried, truth, logits, study, comparison, contact_model):
    """Fit a factor, with its limits and coverage, for every lubricant and film formula."""
    oils = np.array([record.name for record in study.lubricants])
    formulas = comparison["film_formula"].values
    fits = np.full((len(LIMITS) + 2, oils.size, formulas.size), np.nan)
    for oil, number in np.ndindex(fits.shape[1:]):
        here = {"film_formula": number, "record": comparison["lubricant"].values == oils[oil]}
        model, records = logits.isel(here).values, comparison.isel(here)
        best = fit_records(np.log(tried), model, records, contact_model)
        coverage = _coverage if contact_model == "line" else _coverage_of_surfaces
        covers = coverage(np.log(tried), np.log(truth), model, records)
        explained = _explained(np.log(tried), np.log(best[0]), model, records, contact_model)
        fits[:, oil, number] = *best, covers, explained
    *limits, coverages, explains = fits
    variables = values_with_limits(name, limits)
    variables |= {f"{name}_coverage": coverages, f"{name}_explained": explains}
    variables |= {"fitted_lubricant": oils, "film_formula": formulas}
    return xr.Dataset(with_dims("gauge", variables))


def fit_records(
    log_factors: Array, logits: Array, comparison: Data, contact_model: str = "line"
) -> tuple[float, float, float]:
    """Fit a factor to the records of one lubricant, with one film formula.

    Parameters
    ----------
    log_factors : numpy.ndarray
        Logarithms of the factor, shape (F,), increasing.
    logits : numpy.ndarray
        Logits of the model's probability, shape (F, P).
    comparison : xarray.Dataset
        A ``comparison`` dataset of these P records and one film formula, without its dimension.
    contact_model : str, optional
        ``line``; or ``surface``, whose records have the ``sample_size`` of the ``surface_records``
        file, and are correlated as `lube.inference.surface_scatter.pair_correlation` says.

    Returns
    -------
    factor, lower, upper : float
        From `lube.statistics.curves.fit_factor`.
    """
    logits, comparison = _usable(logits, comparison)
    fit = _fit(log_factors, logits, comparison, contact_model)
    return fit(comparison["measured_share"].values)


def _fit(log_factors, logits, comparison, contact_model):
    """Return the fit of a factor, as a function of the shares of the records."""
    logits, noise = logits + pooled_shift(comparison), comparison["share_error"].values
    scatter = _scatter(comparison, contact_model)
    return lambda shares: fit_factor(log_factors, logits, shares, *scatter, noise)


def _scatter(comparison, contact_model):
    """Trials by which records weigh, covariance of their errors, and number of realisations."""
    covariance = _pair_scatter(comparison)
    if contact_model == "surface":
        size, count = comparison["sample_size"].values, SURFACES
        covariance *= pair_correlation(comparison["simulated_probability"].values)
    else:
        probabilities, trials = realised_shares(comparison)
        deviations = comparison["record_deviation"].values
        # Only the first realisations were run as records of several revolutions.
        deviations = deviations[np.isfinite(deviations).all(axis=1)]
        covariance = realisation_correlation(deviations) * covariance
        error, count = np.sqrt(comparison["pooled_error"].values), len(probabilities)
        of_mean = realisation_correlation(probabilities) * (error[:, None] * error)
        covariance += of_mean / count
        # Records weigh by their windows. The scatter between realisations is in their errors only:
        # as weights, it would make fits from few realisations look too good.
        size = windows_at_records(comparison)
        scale = np.sqrt(size / trials)
        covariance *= scale[:, None] * scale
    return size, covariance, count


def _explained(log_factors, log_factor, logits, comparison, contact_model):
    """Fraction of the records that the model explains with a factor, for one pair of rollers."""
    logits, comparison = _usable(logits, comparison)
    if np.isnan(log_factor):
        return np.nan
    curves = scipy.interpolate.make_interp_spline(log_factors, logits, k=1)
    model = scipy.special.expit(curves(log_factor) + pooled_shift(comparison))
    size, covariance, count = _scatter(comparison, contact_model)
    variance = model * (1.0 - model) / size * np.diagonal(covariance)
    error = np.sqrt(variance + comparison["share_error"].values ** 2)
    off = np.abs(comparison["measured_share"].values - model)
    return np.mean(off <= quantile(count) * error)


def _usable(logits, comparison):
    """Keep the records that have a share and a probability at every factor."""
    used = np.isfinite(comparison["measured_share"].values) & np.isfinite(logits).all(axis=0)
    return logits[:, used], comparison.isel(record=used)


def pooled_shift(comparison: xr.Dataset) -> Array:
    """Logits of the pooled probability less those of the mean; 0 where either is not finite.

    Parameters
    ----------
    comparison : xarray.Dataset
        As in `fit_records`.

    Returns
    -------
    numpy.ndarray
        Shape (record,).
    """
    pooled, mean = (comparison[f"{name}_probability"].values for name in ("pooled", "simulated"))
    with np.errstate(invalid="ignore"):
        shift = scipy.special.logit(pooled) - scipy.special.logit(mean)
    return np.where(np.isfinite(shift), shift, 0.0)


def _pair_scatter(comparison):
    """Scatter ratio of any two records of one pair; 0 for records of different pairs."""
    ratio = np.sqrt(comparison["scatter_ratio"].values)
    pair = comparison["pair"].values
    return np.where(pair[:, None] == pair, ratio[:, None] * ratio, 0.0)


def _coverage(log_factors, truth, logits, comparison):
    """Fraction of realisations whose interval is correct, if each is left out and taken as records.

    The interval holds all factors that the misfit does not contradict, so it contains the truth
    where the misfit there is within its quantile.
    """
    logits, comparison = _usable(logits, comparison)
    probabilities, windows = comparison[PROBABILITY].values, windows_at_records(comparison)
    count = len(probabilities)
    if count < 3 or not windows.size:
        return np.nan
    slopes = np.gradient(logits, log_factors, axis=0)
    nearest = int(np.argmin(np.abs(log_factors - truth)))
    model = scipy.special.expit(logits[nearest])
    weight = windows * slopes[nearest]
    others = (count * model - probabilities) / (count - 1)
    misfit = np.sum(weight * (probabilities - others), axis=1)
    sums = np.sum(weight * probabilities, axis=1)
    scatter = np.array([np.delete(sums, one).std(ddof=1) for one in range(count)])
    if not scatter.any():  # no realisation has contact
        return np.nan
    error = scatter * np.sqrt(1.0 + 1.0 / (count - 1))
    return np.mean(np.abs(misfit) <= quantile(count - 1) * error)


def _coverage_of_surfaces(log_factors, truth, logits, comparison):
    """As `_coverage`, if drawn records are taken as the records."""
    logits, comparison = _usable(logits, comparison)
    drawn = comparison["drawn_share"].values
    if not drawn.any():
        return np.nan
    fit = _fit(log_factors, logits, comparison, "surface")
    limits = [fit(shares)[1:] for shares in drawn]
    return np.mean([lower <= np.exp(truth) <= upper for lower, upper in limits])
