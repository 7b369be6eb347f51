"""The comparison stage: simulated breakthrough against the rig's share of time in contact.

A record comes from one pair of rollers, the simulated probability is a mean over pairs. So a
record is judged by a prediction interval: where the share of a single pair's record lies,
95 times out of 100, if the model is right. All records of a pair see the same roughness, and
are off together; how far the figures of agreement then stray is taken from the ensemble, each of
whose realisations is left out in turn and compared as if it were the rig's pair.
"""

import itertools
import logging
import math

import numpy as np
import pandas as pd
import scipy.special
import xarray as xr

from lube.rig.study_shares import at_comparison_threshold, levels_named, log_lines
from lube.schema import AT_RECORDS, LIMITS, label
from lube.statistics.confidence import probability_interval
from lube.statistics.one_pair import independent_windows, prediction_limits, quantile, sample_size

log = logging.getLogger(__name__)

GROUPS = ("force", "speed", "temperature")
PROBABILITY = "breakthrough_probability"
FIGURES = ("bias", "rms_difference", "logit_rms_difference", "overlap_share")
"""Figures of agreement that have a range for a perfect model."""


def compare(model, experiment, levels):
    """Set simulated probabilities beside measured contact shares, record by record and as a whole.

    Parameters
    ----------
    model : xarray.Dataset
        From `lube.rig.at_records.model_at_records`.
    experiment : xarray.Dataset
        The ``experiment`` dataset that it was made for.
    levels : xarray.Dataset
        Any dataset of the study with its lubricants, forces, speeds and temperatures.

    Returns
    -------
    xarray.Dataset
        The ``comparison`` file of `lube.schema`: for each record the simulated probability with
        its 95 % interval, the prediction interval of one pair's record and whether the measured
        share lies in it; figures of agreement for every film formula and threshold, with the
        range that a perfect model's would have; and the means of both sides over the records
        at every force, speed and temperature. The attribute ``missing`` names operating points
        without a record, ``remarks`` records of one point that contradict each other.

    Raises
    ------
    DataError
        If the experiment was not evaluated at its comparison threshold.
    """
    table = _side_by_side(model, experiment)
    table = table.merge(_agreement(table, experiment), join="exact")
    table = table.merge(_expected(table), join="exact")
    table = table.merge(_calibration(table), join="exact")
    table = table.set_coords([*AT_RECORDS, "origin"])
    missing, remarks = _missing(table, levels), _contradictions(table)
    log_lines(log, missing)
    log_lines(log, remarks)
    notes = {"missing": "\n".join(missing), "remarks": "\n".join(remarks)}
    return label(table.assign_attrs(notes), "comparison")


def _side_by_side(model, experiment):
    """Both sides at the comparison threshold, and the prediction interval."""
    names = [*AT_RECORDS, "origin", "pairs", "drift", "comparison_threshold", "share_error"]
    table = experiment[names]
    model = model.assign_coords(record=table["record"])
    table = table.drop_attrs().merge(model, join="exact", compat="no_conflicts")
    table.attrs = model.attrs
    for limit, share in zip(LIMITS, _shares(at_comparison_threshold(experiment)), strict=True):
        table[f"measured_share{limit}"] = "record", share
    dims = ("film_formula", "record")
    for limit, values in zip(LIMITS, _mean_and_limits(table), strict=True):
        table[f"simulated_probability{limit}"] = dims, values
    for side, values in zip(("lower", "upper"), _prediction(table), strict=True):
        table[f"predicted_share_{side}"] = dims, values
    with xr.set_options(keep_attrs=False):
        share = table["measured_share"]
        lower, upper = (table[f"predicted_share_{side}"] for side in ("lower", "upper"))
        inside = (share >= lower) & (share <= upper)
    table["within_prediction"] = inside.transpose(*dims)
    return table


def _shares(shares):
    return [shares[f"contact_share{limit}"].values for limit in LIMITS]


def _windows(table):
    """Windows of one realisation that share no roughness, shape (record,)."""
    return independent_windows(table, 2.0 * table["contact_half_width"].values)


def _mean_and_limits(table):
    """Mean over realisations, and its 95 % interval, shapes (film_formula, record)."""
    return probability_interval(table[PROBABILITY].values, _windows(table))


def _prediction(table):
    """Limits of one pair's share, shapes (film_formula, record)."""
    probabilities = table[PROBABILITY].values
    return prediction_limits(
        table["simulated_probability"].values,
        sample_size(probabilities, _windows(table)),
        table["scatter_ratio"].values,
        probabilities.shape[0],
        table["share_error"].values,
    )


def _agreement(table, experiment):
    """Agreement figures over (film_formula, threshold)."""
    thresholds = experiment["threshold"].values
    every = experiment["contact_share"].transpose("threshold", "record").values
    figures = [
        [_figures(table.sel(film_formula=formula), shares) for shares in every]
        for formula in table["film_formula"].values
    ]
    dims = ("film_formula", "threshold")
    return xr.Dataset(
        {
            name: (dims, np.array([[cell[name] for cell in row] for row in figures]))
            for name in figures[0][0]
        },
        coords={"film_formula": table["film_formula"].values, "threshold": thresholds},
    )


def _figures(table, shares):
    """Agreement figures of one film formula with the shares at one threshold."""
    both = np.isfinite(shares)
    sides = ("simulated_probability", "predicted_share_lower", "predicted_share_upper")
    return agreement(*(table[name].values[both] for name in sides), shares[both])


def agreement(simulated, lower, upper, measured):
    """Figures of agreement between simulated probabilities and measured shares.

    On the plain scale rare contact counts for nothing; the logit ln(p / (1 - p)) makes a factor
    between two small probabilities (or small odds against contact) count as much as in
    mid-range, but has no value at 0 and 1, so it is taken where both are within.

    Parameters
    ----------
    simulated : numpy.ndarray
        Mean probability over realisations, shape (n,).
    lower, upper : numpy.ndarray
        Prediction interval of one pair's share, shape (n,).
    measured : numpy.ndarray
        Shares, shape (n,).

    Returns
    -------
    dict of str to float or int
        ``bias`` (mean of simulated less measured), ``rms_difference``, ``logit_rms_difference``,
        ``rank_correlation`` (Spearman's), ``overlap_share`` of the records within their
        prediction interval, ``compared_records`` and ``logit_records``. A figure without
        records is NaN.
    """
    within = (simulated > 0.0) & (simulated < 1.0) & (measured > 0.0) & (measured < 1.0)
    logits = scipy.special.logit(simulated[within]) - scipy.special.logit(measured[within])
    return {
        "bias": _mean(simulated - measured),
        "rms_difference": np.sqrt(_mean((simulated - measured) ** 2)),
        "logit_rms_difference": np.sqrt(_mean(logits**2)),
        "rank_correlation": _rank_correlation(simulated, measured),
        "overlap_share": _mean((measured >= lower) & (measured <= upper)),
        "compared_records": simulated.size,
        "logit_records": int(np.count_nonzero(within)),
    }


def _mean(values):
    return np.mean(values) if values.size else np.nan


def _rank_correlation(first, second):
    """Spearman's rank correlation, which equal values do not have."""
    if first.size < 2 or np.ptp(first) == 0.0 or np.ptp(second) == 0.0:
        return np.nan
    # Ranks are halves of whole numbers, so that these sums are exact in whatever order.
    first, second = (
        pd.Series(each).rank().values - (each.size + 1) / 2 for each in (first, second)
    )
    return np.sum(first * second) / np.sqrt(np.sum(first**2) * np.sum(second**2))


def _expected(table):
    """Range of each figure of agreement if the model is right, over film_formula.

    Each realisation in turn is left out of the ensemble and compared with the others as the
    record of a pair of rollers, at all records at once.
    """
    ranges = np.full((len(FIGURES), 2, table.sizes["film_formula"]), np.nan)
    recorded = np.isfinite(table["measured_share"].values)
    if table.sizes["realisation"] > 2 and recorded.any():
        for number in range(table.sizes["film_formula"]):
            members = table[PROBABILITY].values[:, number, recorded]
            figures = _left_out(members, _windows(table)[recorded])
            for place, values in enumerate(figures.T):
                known = values[np.isfinite(values)]
                if known.size:
                    ranges[place, :, number] = np.quantile(known, [0.025, 0.975])
    return xr.Dataset(
        {
            f"{name}_expected_{side}": ("film_formula", ranges[place, end])
            for place, name in enumerate(FIGURES)
            for end, side in enumerate(("lower", "upper"))
        }
    )


def _left_out(members, windows):
    """Figures of agreement of each realisation with all others, shape (R, figures)."""
    count = members.shape[0]
    rows = []
    for number in range(count):
        others = np.delete(members, number, axis=0)
        mean, looks = others.mean(axis=0), sample_size(others, windows)
        limits = prediction_limits(mean, looks, np.ones(mean.size), count - 1)
        figures = agreement(mean, *limits, members[number])
        rows.append([figures[name] for name in FIGURES])
    return np.array(rows)


def _calibration(table):
    """Mean of both sides over the records near every level of force, speed and temperature."""
    simulated, measured = table["simulated_probability"].values, table["measured_share"].values
    means = {}
    for name in GROUPS:
        labels = table[f"{name}_level"].values
        levels = np.unique(labels[np.isfinite(labels)])
        at = [(labels == level) & np.isfinite(measured) for level in levels]
        rows = np.array([[_mean(row[here]) for here in at] for row in simulated])
        means |= {
            f"{name}_group": levels,
            f"simulated_mean_by_{name}": (("film_formula", f"{name}_group"), rows),
            f"measured_mean_by_{name}": (f"{name}_group", [_mean(measured[here]) for here in at]),
        }
    return xr.Dataset(means)


def _missing(table, levels):
    """Operating points of the study near which there is no record, a line each."""
    recorded = np.isfinite(table["measured_share"].values)
    columns = [table["lubricant"].values, *(table[f"{name}_level"].values for name in GROUPS)]
    found = set(zip(*(column[recorded].tolist() for column in columns), strict=True))
    grid = itertools.product(*(levels[name].values.tolist() for name in ("lubricant", *GROUPS)))
    return [
        f"{levels_named(dict(zip(GROUPS, point[1:], strict=True)))}"
        f"{f', {point[0]}' if levels.sizes['lubricant'] > 1 else ''}: no record"
        for point in grid
        if point not in found
    ]


def _contradictions(table):
    """Name records of one operating point that differ more than two pairs of rollers do.

    Among all that are compared, one by chance in twenty experiments.
    """
    names = ("lubricant", "slide_to_roll_ratio", *(f"{name}_level" for name in GROUPS))
    columns = pd.DataFrame({name: table[name].values for name in names})
    of_points = columns.groupby(list(names)).indices.values()  # without those near no level
    couples = [couple for rows in of_points for couple in itertools.combinations(rows, 2)]
    share, record = table["measured_share"].values, table["record"].values
    reach = _reach(table, max(len(couples), 1))
    return [
        f"{record[one]} and {record[other]} are of one operating point, but contradict each "
        f"other: shares {share[one]:.4g} and {share[other]:.4g}"
        for one, other in couples
        if abs(share[one] - share[other]) > math.hypot(reach[one], reach[other])
    ]


def _reach(table, among):
    """Tell how far each record's share may lie from the mean, by the first formula."""
    first, count = table.isel(film_formula=0), table.sizes["realisation"]
    mean = first["simulated_probability"].values
    sides = [abs(first[f"predicted_share_{side}"].values - mean) for side in ("lower", "upper")]
    return np.maximum(*sides) * quantile(count, among) / quantile(count)
