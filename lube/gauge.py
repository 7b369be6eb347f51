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
from lube.schema import OPERATING_DIMS, POINT_DIMS, label
from lube.shares import (
    LIMITS,
    at_comparison_threshold,
    in_pure_rolling,
    limited,
    lines_of,
    log_lines,
    on_study_levels,
)

log = logging.getLogger(__name__)

ALPHA_FACTORS = np.geomspace(1.0 / 8.0, 8.0, 193)
"""Factors of the pressure-viscosity coefficient that are tried."""
STRENGTH_LEVELS = 193
"""Strengths of the boundary layer that are tried, between the map's weakest and strongest."""


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
        `fit_layer_strength`. The attribute ``missing`` lists the points without a record.

    Raises
    ------
    DataError
        If the records have a level that is not the study's, or were not evaluated at their
        comparison threshold.
    """
    shares = _shares(film, experiment)
    gauged = gauge_film(master, film, experiment)
    strength = fit_layer_strength(master, film, contact, experiment)
    gauged = gauged.merge(fit_alpha(master, film, contact, experiment)).merge(strength)
    gauged["film_thickness"], gauged["lambda_ratio"] = film["film_thickness"], film["lambda_ratio"]
    gauged["interval_coverage"] = gauge_coverage(master, film, experiment)
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
        As `gauge_records`.
    """
    shares = _shares(film, experiment)
    records = np.stack([shares[f"contact_share{limit}"].values for limit in LIMITS], axis=-1)
    ratios = np.empty(records.shape)
    for number, half_width in enumerate(film["contact_half_width"].values):
        curves = _curves(master, 2.0 * half_width)
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
        curves = _curves(master, 2.0 * half_width)
        for *place, revolution in np.ndindex(records.shape[:-3] + records.shape[-2:-1]):
            index = (*place, number, revolution)
            _, lower, upper = film_interval(curves, records[index])
            if not np.isnan(lower):
                held[index] = lower <= true[index[:-1]] <= upper
    return xr.DataArray(held.mean(axis=-1), dims=POINT_DIMS)


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
        As `gauge_records`.
    """
    factor = xr.DataArray(ALPHA_FACTORS, dims="factor")
    logits = _read_off(lambda width: _curves(master, width)[0], film, _ratios(film, factor))
    return _fits("alpha_factor", np.log(ALPHA_FACTORS), logits, film, contact, experiment)


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
        As `gauge_records`.
    """
    tried = np.geomspace(*master["layer_strength"].values[[0, -1]], STRENGTH_LEVELS)
    logits = _strength_logits(master, film, _study_strength(contact))
    # A point at which some layer's contact is too rare for the map is left out.
    known = logits.notnull().all("layer_strength")
    spline = scipy.interpolate.PchipInterpolator(
        np.log(logits["layer_strength"]), logits.fillna(0.0)
    )
    logits = known.expand_dims(factor=tried.size).copy(data=spline(np.log(tried))).where(known)
    name = "fitted_layer_strength"
    return _fits(name, np.log(tried), logits, film, contact, experiment)


def _shares(film, experiment):
    """Shares in pure rolling at the comparison threshold, on the levels of the film table."""
    rolling = in_pure_rolling(experiment)
    shares = at_comparison_threshold(on_study_levels(rolling, film), experiment)
    return shares.drop_vars("duration").transpose(*POINT_DIMS)


def _curves(master, width):
    """Curves of the mean probability and of its limits, at one contact width (m)."""
    resolution = _resolution(master, width)
    return tuple(_curve(each, width, resolution) for each in _mean_and_limits(master))


def _mean_and_limits(dataset):
    """Mean probability over the realisations, and its limits."""
    return [dataset[f"breakthrough_probability_{each}"] for each in ("mean", "lower", "upper")]


def _resolution(master, width):
    """Share of one window among all that share no roughness and were seen."""
    windows = master.attrs["travel"] / (width + master.attrs["longest_wavelength"])
    return 1.0 / (max(windows, 1.0) * master.sizes["realisation"])


def _curve(probability, width, resolution):
    """Curve over the lambda ratio at one contact width of a map over the two.

    Contacts that come along the line independently of one another make -ln(1 - p) grow in
    proportion to the width, so it is taken as straight between widths.
    """
    ratios, widths = (probability[name].values for name in probability.dims)
    intensity = -np.log1p(-np.minimum(probability.values, 1.0 - 1e-12))
    here = np.array([np.interp(width, widths, row) for row in intensity])
    return falling_curve(np.log(ratios), -np.expm1(-here), resolution)


def _read_off(curve_at, film, ratios):
    """Logits of the probability at some lambda ratios, on the curve of each force."""
    parts = [
        xr.apply_ufunc(curve_at(2.0 * half_width.item()).logit_at, np.log(ratios.sel(force=force)))
        for force, half_width in film["contact_half_width"].groupby("force")
    ]
    return xr.concat(parts, film["force"], join="exact").transpose(..., *OPERATING_DIMS)


def _ratios(film, factor):
    """Lambda ratios with the pressure-viscosity coefficient times a factor.

    The dimensionless groups follow from the film table: W = pi/8 (a / R*)^2 from Hertz' half-
    width, U and G from Moes' numbers M = W (2U)^(-1/2) and L = G (2U)^(1/4).
    """
    with xr.set_options(arithmetic_join="exact", keep_attrs=False):
        load = np.pi / 8.0 * (film["contact_half_width"] / film["reduced_radius"]) ** 2
        speed = 0.5 * (load / film["moes_load"]) ** 2
        material = factor * film["moes_material"] / (2.0 * speed) ** 0.25
        names = film["film_formula"]
        films = [formula(name).evaluate(load, speed, material) for name in names.values]
        scale = film["reduced_radius"] / film["composite_rms_roughness"]
        return xr.concat(films, names, join="exact") * scale


def _study_strength(contact):
    """Strength tau0 / h_c of the study's layer, Pa/m: nothing else of the layer matters."""
    return contact["shear_strength"].item() / contact["critical_thickness"].item()


def _strength_logits(master, film, study):
    """Logits over (layer_strength, operating dimensions).

    The study's layer has the fine map; the coarse one tells how much other layers differ.
    """
    maps = master["layer_breakthrough_probability"].mean("realisation")
    coarse = [_strength_map(maps.sel(layer_strength=s), master, film) for s in maps.layer_strength]
    coarse = xr.concat(coarse, maps["layer_strength"], join="exact")
    fine = _read_off(lambda width: _curves(master, width)[0], film, film["lambda_ratio"])
    logits = fine + coarse - coarse.sel(layer_strength=study, method="nearest", drop=True)
    return logits.transpose("layer_strength", *OPERATING_DIMS)


def _strength_map(probability, master, film):
    """Logits at the film table's lambda ratios, from the coarse map of one layer strength."""

    def curve_at(width):
        return _curve(probability, width, _resolution(master, width))

    return _read_off(curve_at, film, film["lambda_ratio"])


def _fits(name, log_factors, logits, film, contact, experiment):
    """Fit a factor, with its limits, for every lubricant and film formula."""
    shares, contact = _shares(film, experiment), in_pure_rolling(contact)
    oils, formulas = film["lubricant"].values, film["film_formula"].values
    fits = np.empty((oils.size, formulas.size, len(LIMITS)))
    for o, f in np.ndindex(fits.shape[:-1]):
        place = {"lubricant": oils[o], "film_formula": formulas[f]}
        measured = shares.sel(lubricant=oils[o])
        fits[o, f] = _fit(log_factors, logits.sel(place), contact.sel(place), measured)
    found = limited(name, np.moveaxis(fits, -1, 0))
    return xr.Dataset(
        {each: (("lubricant", "film_formula"), values) for each, values in found.items()},
        coords={"lubricant": oils, "film_formula": formulas},
    )


def _fit(log_factors, logits, contact, shares):
    """Fit a factor to the points of one lubricant, by one film formula."""
    logits, probabilities = (
        _points(array).reshape(array.shape[0], -1)
        for array in (logits, contact["breakthrough_probability"])
    )
    measured = [_points(shares[f"contact_share{limit}"]).ravel() for limit in LIMITS]
    ensemble = [_points(array).ravel() for array in _mean_and_limits(contact)]
    used = np.isfinite(sum(measured)) & np.isfinite(logits).all(axis=0)
    simulated = independent_looks(*ensemble)
    # The variances of record and ensemble add.
    looks = 1.0 / (1.0 / independent_looks(*measured) + 1.0 / simulated)
    return fit_factor(
        log_factors,
        logits[:, used],
        measured[0][used],
        # Not the records' own looks: their intervals are estimates too, rough ones if a record
        # is short, and a point that by chance seems sure would decide alone.
        simulated[used],
        looks[used],
        realisation_correlation(probabilities[:, used]),
        probabilities.shape[0],
    )


def _points(array):
    """Values over (..., temperature, speed, force)."""
    return array.transpose(..., *POINT_DIMS[1:]).values
