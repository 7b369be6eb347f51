"""One unknown of the model, from all records together.

The film is taken from its formula and the probability from the master map; what is looked for is
the pressure-viscosity coefficient, or the strength of the boundary layer, that explains the
records best.
"""

import numpy as np
import scipy.interpolate
import xarray as xr

from lube.curves import fit_factor, independent_looks, realisation_correlation
from lube.formulas import formula
from lube.map_curves import curve_at, logits_on, mean_and_limits
from lube.schema import LIMITS, OPERATING_DIMS, POINT_DIMS
from lube.shares import compared_in_pure_rolling, in_pure_rolling, limited

ALPHA_FACTORS = np.geomspace(1.0 / 8.0, 8.0, 193)
"""Factors of the pressure-viscosity coefficient that are tried."""
STRENGTH_LEVELS = 193
"""Strengths of the boundary layer that are tried, between the map's weakest and strongest."""


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
        As `lube.shares.compared_in_pure_rolling`.
    """
    factor = xr.DataArray(ALPHA_FACTORS, dims="factor")
    logits = _mean_logits(master, film, _ratios(film, factor))
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
        As `lube.shares.compared_in_pure_rolling`.
    """
    tried = np.geomspace(*master["layer_strength"].values[[0, -1]], STRENGTH_LEVELS)
    logits = _strength_logits(master, film, study_strength(contact))
    # A point at which some layer's contact is too rare for the map is left out.
    known = logits.notnull().all("layer_strength")
    spline = scipy.interpolate.PchipInterpolator(
        np.log(logits["layer_strength"]), logits.fillna(0.0)
    )
    logits = known.expand_dims(factor=tried.size).copy(data=spline(np.log(tried))).where(known)
    name = "fitted_layer_strength"
    return _fits(name, np.log(tried), logits, film, contact, experiment)


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


def _mean_logits(master, film, ratios):
    """Logits of the map's mean probability, at some lambda ratios."""
    mean, _, _ = mean_and_limits(master)
    return logits_on(lambda width: curve_at(mean, master, width), film, ratios)


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


def _strength_logits(master, film, study):
    """Logits over (layer_strength, operating dimensions).

    The study's layer has the fine map; the coarse one tells how much other layers differ.
    """
    maps = master["layer_breakthrough_probability"].mean("realisation")
    coarse = [_strength_map(maps.sel(layer_strength=s), master, film) for s in maps.layer_strength]
    coarse = xr.concat(coarse, maps["layer_strength"], join="exact")
    fine = _mean_logits(master, film, film["lambda_ratio"])
    logits = fine + coarse - coarse.sel(layer_strength=study, method="nearest", drop=True)
    return logits.transpose("layer_strength", *OPERATING_DIMS)


def _strength_map(probability, master, film):
    """Logits at the film table's lambda ratios, from the coarse map of one layer strength."""
    ratios = film["lambda_ratio"]
    return logits_on(lambda width: curve_at(probability, master, width), film, ratios)


def _fits(name, log_factors, logits, film, contact, experiment):
    """Fit a factor, with its limits, for every lubricant and film formula."""
    shares, contact = compared_in_pure_rolling(film, experiment), in_pure_rolling(contact)
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
    ensemble = [_points(array).ravel() for array in mean_and_limits(contact)]
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
