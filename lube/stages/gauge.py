"""The gauge stage: from the contact share of a record to the film thickness that explains it.

The curve of a record gives the probability of contact for every film thickness at its conditions.
Read in the other direction it turns a resistance measurement into a film thickness. If instead the
film thickness is taken from its formula, all records together determine one unknown of the model:
the pressure-viscosity coefficient, or the strength of the boundary layer.

A record comes from one pair of rollers. How far its share may lie from the mean follows from the
scatter between the realisations; the interval includes it, and the error of the mean. Records that
are compared with surfaces are also read as contact of surfaces.
"""

from dataclasses import replace

import numpy as np
import scipy.special
import xarray as xr

from lube.contact.surface_strip import SURFACES
from lube.inference.fits import fit_alpha, fit_layer_strength, pooled_shift
from lube.inference.record_curves import RecordCurves, gauged_ratios, map_curves, own_curves
from lube.inference.surface_records import reading_errors, surface_curves
from lube.inference.surface_scatter import pair_shares
from lube.schema import AT_RECORDS, label, values_with_limits, with_dims
from lube.statistics.confidence import mean_or_nan
from lube.statistics.curves import film_interval
from lube.statistics.one_pair import quantile, standard_error
from lube.study.study import Study
from lube.types import Datasets

_KEPT = ("film_thickness", "lambda_ratio", "contact_half_width", "comparison_threshold")


def make(study: Study, inputs: Datasets, threads: int = 1) -> xr.Dataset:
    """Make ``gauge.nc``; see `lube.stages`."""
    comparison = inputs["comparison"]

    def by_line(comparison):
        if "master" in inputs:
            return map_curves(inputs["master"], comparison)
        return own_curves(study, comparison, threads)

    if not study.compares_surfaces:
        return gauge_records(by_line(comparison), study, comparison)
    inferred = []
    for model in comparison["contact_model"].values:
        records = comparison.sel(contact_model=model, drop=True)
        if model == "surface":
            records = _of_surfaces(records, inputs["surface_records"], study.seed)
            curves = surface_curves(inputs["surface_records"], records, study.gap.has_shape)
        else:
            curves = by_line(records)
        inferred.append(_inferred(curves, study, records))
    by_model = xr.concat(inferred, comparison["contact_model"], join="exact")
    return _with_records(by_model, study.boundary_layer.strength, comparison)


def _of_surfaces(comparison, surfaces, seed):
    """Comparison with surfaces, as the fits read it, with drawn records.

    Its probability has no error from realisations, but that of its curve adds to the noise.
    """
    comparison = comparison.drop_dims("realisation", errors="ignore")
    probability, noise = comparison["simulated_probability"], comparison["share_error"]
    errors = reading_errors(surfaces, comparison["measured_share"].values)
    drawn = pair_shares(surfaces, comparison["pair"], seed)
    return comparison.assign(
        pooled_probability=probability,
        pooled_error=xr.zeros_like(probability),
        share_error=noise.copy(data=np.hypot(noise.values, errors)),
        scatter_ratio=xr.zeros_like(probability) + surfaces["scatter_ratio"].drop_attrs(),
        sample_size=surfaces["sample_size"].drop_attrs(),
        drawn_share=(("drawn_pair", "film_formula", "record"), drawn),
    )


def gauge_records(curves: RecordCurves, study: Study, comparison: xr.Dataset) -> xr.Dataset:
    """Infer films, the pressure-viscosity coefficient and the boundary layer from the records.

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
        The ``gauge`` file of `lube.schema`, from `gauge_film`, `gauge_coverage`, `fit_alpha` and
        `fit_layer_strength`.
    """
    inferred = _inferred(curves, study, comparison)
    return _with_records(inferred, study.boundary_layer.strength, comparison)


def _inferred(curves, study, comparison):
    """Infer films, the pressure-viscosity coefficient and the boundary layer."""
    films = gauge_film(curves, comparison), gauge_coverage(curves, comparison)
    fits = (fit(curves, study, comparison) for fit in (fit_alpha, fit_layer_strength))
    return xr.merge((*films, *fits), join="exact", combine_attrs="drop")


def _with_records(inferred, strength, comparison):
    """Add the records' conditions and films to what was inferred from them."""
    records = comparison[[*_KEPT, *AT_RECORDS, "origin", "pairs", "drift"]]
    gauged = xr.merge((records, inferred), join="exact", combine_attrs="drop")
    known = np.isfinite(comparison["measured_share"].values)
    oils = comparison["lubricant"].values[known]
    counts = [np.count_nonzero(oils == oil) for oil in gauged["fitted_lubricant"].values]
    gauged["study_layer_strength"] = strength
    gauged["fitted_records"] = "fitted_lubricant", counts
    return label(gauged.drop_attrs(deep=False), "gauge")


def gauge_film(curves: RecordCurves, comparison: xr.Dataset) -> xr.Dataset:
    """Film thickness and lambda ratio that explain the contact share of every record.

    Parameters
    ----------
    curves, comparison
        As in `gauge_records`.

    Returns
    -------
    xarray.Dataset
        ``gauged_film_thickness`` (m) and ``gauged_lambda_ratio`` with ``_lower`` and ``_upper``
        over ``record``, NaN without a share. A share below the resolution of its curve has no
        value, only a lower limit, and infinity as the upper limit; a share above the probability at
        the curve's thinnest film has only an upper limit, and zero as the lower limit. The 95 %
        intervals include the scatter of one pair's record and the error of the ensemble. Where
        contact is so frequent that its probability falls as the film thins, a share belongs to two
        films: these variables give the thicker film, and ``gauged_thinner_film_thickness`` (m) the
        thinner one, NaN where there is none.
    """
    sigma = comparison["composite_rms_roughness"].item()
    # The pooled probability is known better than that of the realisations, from which curves are.
    each = zip(curves.of_records, pooled_shift(comparison.isel(film_formula=0)), strict=True)
    shifted = [replace(curve, logits=curve.logits + shift) for curve, shift in each]
    ratios = gauged_ratios(shifted, comparison, comparison["share_error"].values)
    shared = zip(shifted, comparison["measured_share"].values, strict=True)
    thinner = [curve.thinner_film_at(share) for curve, share in shared]
    found = {
        **values_with_limits("gauged_lambda_ratio", ratios),
        **values_with_limits("gauged_film_thickness", ratios * sigma),
        "gauged_thinner_film_thickness": sigma * np.exp(thinner),
    }
    return xr.Dataset(with_dims("gauge", found))


def gauge_coverage(curves: RecordCurves, comparison: xr.Dataset) -> xr.Dataset:
    """How often the interval of a gauged film contains the true film thickness.

    Each realisation in turn is left out of the ensemble and gauged with the others, as a record of
    one pair of rollers, one revolution long, at the films of the first formula. Its interval
    contains the true film if its share lies within the prediction interval of the others there.
    Of surfaces, records of drawn pairs are gauged.

    Parameters
    ----------
    curves, comparison
        As in `gauge_records`.

    Returns
    -------
    xarray.Dataset
        Over ``record``: ``interval_coverage`` of all intervals, ``closed_coverage`` of those
        with two limits, ``one_sided_coverage`` of the others, and ``closed_share``, the fraction
        of intervals with two limits; NaN where there are no such intervals, or the ensemble has
        fewer than three realisations.
    """
    coverage = np.full((4, comparison.sizes["record"]), np.nan)
    is_line = curves.contact_model == "line"
    members = comparison["breakthrough_probability" if is_line else "drawn_share"].values[:, 0]
    if len(members) > 2:
        films = np.log(comparison["lambda_ratio"].values[0])
        ratios, noise = comparison["scatter_ratio"].values[0], comparison["share_error"].values
        for record, (curve, film) in enumerate(zip(curves.of_records, films, strict=True)):
            shares = members[:, record]
            if is_line:
                held, closed = _leave_one_out(curve, film, shares)
            else:
                held, closed = _of_drawn(curve, film, shares, ratios[record], noise[record])
            cases = held, held[closed], held[~closed], closed
            coverage[:, record] = [mean_or_nan(each) for each in cases]
    names = ("interval_coverage", "closed_coverage", "one_sided_coverage", "closed_share")
    return xr.Dataset(with_dims("gauge", dict(zip(names, coverage, strict=True))))


def _leave_one_out(curve, film, shares):
    """Whether the interval of each realisation contains a film, and whether it has two limits."""
    if curve.films.size < 2:
        return np.ones(shares.size, bool), np.zeros(shares.size, bool)
    ends = curve.films[curve.peak], film, curve.films[-1]
    thinnest, here, thickest = (_distance(curve, each, shares) for each in ends)
    limit = quantile(shares.size - 1)
    return np.abs(here) <= limit, (thinnest < -limit) & (thickest > limit)


def _of_drawn(curve, film, shares, ratio, noise):
    """As `_leave_one_out`, of drawn records; none where their film is not known."""
    known = shares[np.isfinite(shares)]
    limits = [film_interval(curve, share, ratio, SURFACES, noise)[1:] for share in known.tolist()]
    lower, upper = np.reshape(limits, (-1, 2)).T
    return (lower <= film) & (film <= upper), np.isfinite(lower) & np.isfinite(upper)


def _distance(curve, film, shares):
    """Distance of each realisation from the mean of the others, over its standard error."""
    count = shares.size
    mean = scipy.special.expit(curve.logit_at(film))
    others = np.clip((count * mean - shares) / (count - 1), 0.0, 1.0)
    size = np.interp(film, curve.films, curve.sample_size)
    with np.errstate(divide="ignore", invalid="ignore"):
        distance = (shares - others) / standard_error(others, size, 1.0, count - 1)
    return np.where(shares == others, 0.0, distance)
