"""The comparison stage: simulated breakthrough against the rig's share of time in contact."""

import logging

import numpy as np
import scipy.special
import scipy.stats
import xarray as xr

from lube.schema import COMPARISON_DIMS, EXPERIMENT_DIMS, LIMITS, label
from lube.shares import at_comparison_threshold, lines_of, log_lines, on_study_levels

log = logging.getLogger(__name__)

GROUPS = ("force", "speed", "temperature")


def compare(contact, experiment):
    """Set simulated probabilities beside measured contact shares, point by point and as a whole.

    Parameters
    ----------
    contact : xarray.Dataset
        A ``contact`` dataset.
    experiment : xarray.Dataset
        An ``experiment`` dataset; it need not have all levels of the study.

    Returns
    -------
    xarray.Dataset
        The ``comparison`` file of `lube.schema`: both probabilities with their 95 % intervals
        at every operating point, agreement figures for every film formula and threshold, and
        the means of both sides at every force, speed and temperature, over the points that
        both have. The attribute ``missing`` tells the points that one side lacks, a line
        each.

    Raises
    ------
    DataError
        If the experiment has a level that is not the study's, or was not evaluated at its
        comparison threshold.
    """
    shares = on_study_levels(experiment, contact)
    table = _side_by_side(contact, at_comparison_threshold(shares, experiment))
    table["comparison_threshold"] = experiment["comparison_threshold"].item()
    table = table.merge(_agreement(table, shares), join="exact")
    table = table.merge(_calibration(table), join="exact")
    missing = _missing(table)
    log_lines(log, missing)
    return label(table.assign_attrs(missing="\n".join(missing)), "comparison")


def _side_by_side(contact, shares):
    """Both sides at the comparison threshold, under the names of the comparison."""
    table = xr.Dataset(coords={"origin": shares["origin"].item()})
    for limit in LIMITS:
        simulated = contact[f"breakthrough_probability{limit or '_mean'}"]
        table[f"simulated_probability{limit}"] = simulated.transpose(*COMPARISON_DIMS)
        table[f"measured_share{limit}"] = shares[f"contact_share{limit}"].transpose(
            *EXPERIMENT_DIMS
        )
    with xr.set_options(arithmetic_join="exact"):
        overlap = (table["simulated_probability_lower"] <= table["measured_share_upper"]) & (
            table["measured_share_lower"] <= table["simulated_probability_upper"]
        )
    table["intervals_overlap"] = overlap.transpose(*COMPARISON_DIMS)
    return table


def _agreement(table, shares):
    """Agreement figures over (film_formula, threshold)."""
    formulas, thresholds = table["film_formula"].values, shares["threshold"].values
    figures = [
        [_figures(table.sel(film_formula=formula), shares.sel(threshold=t)) for t in thresholds]
        for formula in formulas
    ]
    dims = ("film_formula", "threshold")
    return xr.Dataset(
        {
            name: (dims, np.array([[cell[name] for cell in row] for row in figures]))
            for name in figures[0][0]
        },
        coords={"film_formula": formulas, "threshold": thresholds},
    )


def _figures(table, shares):
    """Agreement figures of one film formula at one threshold, as plain numbers."""
    simulated = [table[f"simulated_probability{limit}"].values.ravel() for limit in LIMITS]
    measured = [
        shares[f"contact_share{limit}"].transpose(*EXPERIMENT_DIMS).values.ravel()
        for limit in LIMITS
    ]
    both = np.isfinite(simulated[0]) & np.isfinite(measured[0])
    return agreement(*([side[both] for side in sides] for sides in (simulated, measured)))


def agreement(simulated, measured):
    """Figures of agreement between two sets of probabilities.

    On the plain scale rare contact counts for nothing; the logit ln(p / (1 - p)) makes a factor
    between two small probabilities (or small odds against contact) count as much as in
    mid-range, but has no value at 0 and 1, so it is taken where both are within.

    Parameters
    ----------
    simulated, measured : sequence of numpy.ndarray
        Probability, lower and upper limit, shape (n,) each; limits may be NaN.

    Returns
    -------
    dict of str to float or int
        ``bias`` (mean of simulated less measured), ``rms_difference``, ``logit_rms_difference``,
        ``rank_correlation`` (Spearman's), ``overlap_share`` of the points with two intervals,
        ``compared_points`` and ``logit_points``. A figure without points is NaN.
    """
    (p, p_lower, p_upper), (m, m_lower, m_upper) = simulated, measured
    within = (p > 0.0) & (p < 1.0) & (m > 0.0) & (m < 1.0)
    logits = scipy.special.logit(p[within]) - scipy.special.logit(m[within])
    limits = np.isfinite(p_lower + p_upper + m_lower + m_upper)
    overlap = (p_lower <= m_upper) & (m_lower <= p_upper)
    return {
        "bias": _mean(p - m),
        "rms_difference": np.sqrt(_mean((p - m) ** 2)),
        "logit_rms_difference": np.sqrt(_mean(logits**2)),
        "rank_correlation": _rank_correlation(p, m),
        "overlap_share": _mean(overlap[limits]),
        "compared_points": p.size,
        "logit_points": int(np.count_nonzero(within)),
    }


def _mean(values):
    return np.mean(values) if values.size else np.nan


def _rank_correlation(first, second):
    """Spearman's rank correlation, which equal values do not have."""
    if first.size < 2 or np.ptp(first) == 0.0 or np.ptp(second) == 0.0:
        return np.nan
    # Ranks are halves of whole numbers, so that these sums are exact in whatever order.
    first, second = (scipy.stats.rankdata(each) - (each.size + 1) / 2 for each in (first, second))
    return np.sum(first * second) / np.sqrt(np.sum(first**2) * np.sum(second**2))


def _calibration(table):
    """Mean of both sides at every level of force, speed and temperature."""
    simulated, measured = table["simulated_probability"], table["measured_share"]
    measured = measured.where(simulated.notnull().all("film_formula"))
    simulated = simulated.where(measured.notnull())
    means = {}
    for level in GROUPS:
        others = [name for name in EXPERIMENT_DIMS if name != level]
        means[f"simulated_mean_by_{level}"] = simulated.mean(others).transpose(
            "film_formula", level
        )
        means[f"measured_mean_by_{level}"] = measured.mean(others)
    return xr.Dataset(means)


def _missing(table):
    """Operating points that the records or the simulation lack, a line each."""
    simulated = table["simulated_probability"].isnull().any("film_formula")
    measured = table["measured_share"].isnull()
    return lines_of(measured, "no record") + lines_of(simulated, "no simulation")
