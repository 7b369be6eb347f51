"""The comparison stage: simulated breakthrough against the contact shares of the records.

A record comes from one pair of rollers, while the simulated probability is a mean over pairs. So a
record is compared with a prediction interval: the range that contains the contact share of a
single pair's record in 95 % of cases if the model is correct. All records of a pair see the same
roughness, so their deviations are correlated. The resulting scatter of the figures of agreement is
estimated from the ensemble: each realisation in turn is left out and compared with the others as
if it were the pair in the rig. Of surfaces, records of many pairs are drawn for it.

Measured records are compared with contact of the surfaces too, if the study asks for it. Those of a
simulated rig that runs with lines are compared with lines alone.
"""

import itertools
import logging
import math
from collections.abc import Sequence

import numpy as np
import pandas as pd
import scipy
import xarray as xr

from lube.contact.ensemble import windows_at_records
from lube.contact.surface_strip import SURFACES
from lube.grid.operating_points import over_contact_models
from lube.inference.at_records import model_at_records, study_films_at_records
from lube.inference.study_shares import levels_named, log_lines
from lube.inference.surface_scatter import pair_shares, surface_prediction
from lube.schema import AT_RECORDS, LIMITS, label, values_with_limits, with_dims
from lube.statistics.confidence import mean_or_nan, probability_interval
from lube.statistics.one_pair import prediction_limits, quantile
from lube.statistics.sample_size import effective_sample_size
from lube.study.study import Study
from lube.types import Array, Datasets

log = logging.getLogger(__name__)

GROUPS = ("force", "speed", "temperature")
FIGURES = ("bias", "rms_difference", "logit_rms_difference", "overlap_share")
"""Figures of agreement whose range for a correct model is estimated."""


def make(study: Study, inputs: Datasets, threads: int = 1) -> xr.Dataset:
    """Make ``comparison.nc``; see `lube.stages`."""
    film, contact, experiment = (inputs.get(kind) for kind in ("film", "contact", "experiment"))
    if contact is None:
        model = study_films_at_records(study, experiment)
    else:
        model = model_at_records(experiment, film, contact, study)
    surfaces = inputs.get("surface_records")
    return compare(model, experiment, film, study.contact_model, surfaces, study.seed)


def compare(
    model: xr.Dataset,
    experiment: xr.Dataset,
    levels: xr.Dataset,
    contact_models: Sequence[str] = ("line",),
    surfaces: xr.Dataset | None = None,
    seed: int = 0,
) -> xr.Dataset:
    """Compare simulated probabilities with measured contact shares, for each record and overall.

    Parameters
    ----------
    model : xarray.Dataset
        From `lube.inference.at_records.model_at_records`; of rollers for which no line stands, the
        films at the records alone, with its attributes.
    experiment : xarray.Dataset
        The ``experiment`` dataset that it was made for.
    levels : xarray.Dataset
        Any dataset of the study with its lubricants, forces, speeds and temperatures.
    contact_models : sequence of str, optional
        What records are compared with: the ``line``, the ``surface``, or both.
    surfaces : xarray.Dataset, optional
        A ``surface_records`` dataset, if records are compared with surfaces.
    seed : int, optional
        Seed of the study, for the records of surfaces that are drawn.

    Returns
    -------
    xarray.Dataset
        The ``comparison`` file of `lube.schema`: for each record the simulated probability with
        its 95 % interval, the prediction interval of the contact share of one pair, and whether
        the measured share lies in it; figures of agreement for every film formula and
        threshold, with their range for a correct model; and the simulated and measured means over
        the records at every force, speed and temperature. With surfaces these are also over
        contact_model. The attribute
        ``missing`` lists operating points without a record, ``remarks`` records of one point that
        contradict each other.
    """
    table = _table(model, experiment).set_coords([*AT_RECORDS, "origin"])
    tables = {}
    if "realisation" in table.dims:
        tables["line"] = _judged(table, experiment, _of_lines(table), _ranges_of_lines(table))
    if surfaces is not None:
        ranges = _ranges_of_surfaces(table, surfaces, seed)
        tables["surface"] = _judged(table, experiment, _of_surfaces(table, surfaces), ranges)
        tables = {name: tables[name] for name in contact_models}
    first = next(iter(tables.values()))
    notes = {"missing": _missing(first, levels), "remarks": _contradictions(tables)}
    for lines in notes.values():
        log_lines(log, lines)
    if surfaces is not None:
        first = over_contact_models("comparison", tables)
    texts = {name: "\n".join(lines) for name, lines in notes.items()}
    return label(first.assign_attrs(texts), "comparison")


def _table(model, experiment):
    """Variables of the model, and of the records at the comparison threshold."""
    names = [*AT_RECORDS, "origin", "pairs", "drift", "comparison_threshold", "share_error"]
    table = experiment[names].drop_attrs()
    model = model.assign_coords(record=experiment["record"])
    table = table.merge(model, join="exact", compat="no_conflicts").assign_attrs(model.attrs)
    measured = experiment.sel(threshold=experiment["comparison_threshold"].item())
    measured = [measured[f"contact_share{limit}"].values for limit in LIMITS]
    table = table.assign(values_with_limits("measured_share", measured, "record"))
    return table.assign_coords(threshold=experiment["threshold"].values)


def _of_lines(table):
    """Probability with its limits, and prediction interval, from the realisations of lines."""
    probabilities = table["breakthrough_probability"].values
    windows = windows_at_records(table)
    limits = probability_interval(probabilities, windows)
    size, noise = effective_sample_size(probabilities, windows), table["share_error"].values
    names = "pooled_probability", "scatter_ratio", "pooled_error"
    pooled, ratio, error = (table[name].values for name in names)
    return limits, prediction_limits(pooled, size, ratio, len(probabilities), noise, error)


def _of_surfaces(table, surfaces):
    """Probability with its limits, and prediction interval, of sampled surfaces."""
    limits = [surfaces[f"breakthrough_probability{limit}"].values for limit in LIMITS]
    size, ratio = surfaces["sample_size"].values, surfaces["scatter_ratio"].values
    return limits, surface_prediction(limits, size, ratio, table["share_error"].values)


def _judged(table, experiment, sides, ranges):
    """Add values of one contact model, figures of agreement and means at levels to the table."""
    limits, (lower, upper) = sides
    measured = table["measured_share"].values
    found = {
        **values_with_limits("simulated_probability", limits),
        "predicted_share_lower": lower,
        "predicted_share_upper": upper,
        "within_prediction": (measured >= lower) & (measured <= upper),
        **_agreement((limits[0], lower, upper), experiment),
        **_level_means(table, limits[0]),
        **_expected(ranges),
    }
    return table.assign(with_dims("comparison", found))


def _agreement(values, experiment):
    """Figures of agreement for each film formula and threshold."""
    rows = []
    for sides in zip(*values, strict=True):
        for shares in experiment["contact_share"].transpose("threshold", "record").values:
            known = np.isfinite(shares) & np.isfinite(sides[0])
            rows.append(agreement(*(each[known] for each in (*sides, shares))))
    return {name: np.reshape([row[name] for row in rows], (len(values[0]), -1)) for name in rows[0]}


def agreement(
    simulated: Array, lower: Array, upper: Array, measured: Array
) -> dict[str, float | int]:
    r"""Figures of agreement between simulated probabilities and measured shares.

    The difference of probabilities gives little weight to rare contact. The difference of logits,

    .. math:: \ln \frac{p}{1 - p}

    weights a factor between two small probabilities (or two small odds against contact) as much
    as in mid-range. It is undefined at 0 and 1, so it is taken where both lie in between.

    Parameters
    ----------
    simulated : numpy.ndarray
        Mean probability over realisations, shape (n,).
    lower, upper : numpy.ndarray
        Prediction interval of the share of one pair, shape (n,); NaN if there is none.
    measured : numpy.ndarray
        Measured shares, shape (n,).

    Returns
    -------
    dict of str to float or int
        ``bias`` (mean of simulated minus measured), ``rms_difference``,
        ``logit_rms_difference``, ``rank_correlation`` (Spearman's), ``overlap_share`` (fraction of
        the records within their prediction interval), ``compared_records`` and ``logit_records``
        (their numbers). A figure without records is NaN.

    Examples
    --------
    >>> simulated, measured = np.array([0.1, 0.4]), np.array([0.2, 0.4])
    >>> figures = agreement(simulated, simulated - 0.05, simulated + 0.05, measured)
    >>> print(f"{figures['bias']:.2f}, {figures['overlap_share']:.1f} within the prediction")
    -0.05, 0.5 within the prediction
    """
    inside = (simulated > 0.0) & (simulated < 1.0) & (measured > 0.0) & (measured < 1.0)
    within = (measured >= lower) & (measured <= upper)
    logits = scipy.special.logit(simulated[inside]) - scipy.special.logit(measured[inside])
    return {
        "bias": mean_or_nan(simulated - measured),
        "rms_difference": np.sqrt(mean_or_nan((simulated - measured) ** 2)),
        "logit_rms_difference": np.sqrt(mean_or_nan(logits**2)),
        "rank_correlation": _rank_correlation(simulated, measured),
        "overlap_share": mean_or_nan(np.where(np.isnan(lower), np.nan, within)),
        "compared_records": simulated.size,
        "logit_records": int(np.count_nonzero(inside)),
    }


def _rank_correlation(first, second):
    """Spearman's rank correlation; NaN if all values of one side are equal."""
    if first.size < 2 or np.ptp(first) == 0.0 or np.ptp(second) == 0.0:
        return np.nan
    # Ranks are multiples of 1/2, so these sums are exact in any order.
    first, second = scipy.stats.rankdata([first, second], axis=1) - (first.size + 1) / 2
    return np.sum(first * second) / np.sqrt(np.sum(first**2) * np.sum(second**2))


def _expected(ranges):
    """Variables of the 95 % ranges of the figures of agreement if the model is correct."""
    return {
        f"{name}_expected{side}": ranges[:, figure, end]
        for figure, name in enumerate(FIGURES)
        for end, side in enumerate(LIMITS[1:])
    }


def _ranges_of_lines(table):
    """95 % range of each figure of agreement, shape (formulas, figures, 2).

    Each realisation in turn is left out of the ensemble and compared with the others as the
    records of a pair of rollers, at all of its records at once; a second pair's is the next
    realisation. It deviates from all pairs as much more or less than in one revolution as records
    do, while the error of the others' mean stays.
    """
    ranges = np.full((table.sizes["film_formula"], len(FIGURES), 2), np.nan)
    measured = np.isfinite(table["measured_share"].values)
    windows = windows_at_records(table)
    by_formula = table["breakthrough_probability"].values.swapaxes(0, 1)
    scatter, pair = table["scatter_ratio"].values, table["pair"].to_series().factorize()[0]
    for row, (members, ratio) in enumerate(zip(by_formula, scatter, strict=True)):
        if len(members) > 2:
            known = measured & np.isfinite(members).all(axis=0)
            ranges[row] = _left_out(members[:, known], windows[known], ratio[known], pair[known])
    return ranges


def _ranges_of_surfaces(table, surfaces, seed):
    """As `_ranges_of_lines`, of drawn records."""
    measured, ranges = np.isfinite(table["measured_share"].values), []
    drawn = pair_shares(surfaces, table["pair"], seed).swapaxes(0, 1)
    names = "breakthrough_probability", "sample_size"
    ratio, known = surfaces["scatter_ratio"].values, (surfaces[name].values for name in names)
    for mean, size, shares in zip(*known, drawn, strict=True):
        some = measured & np.isfinite(mean)
        limits = prediction_limits(mean, size, ratio, SURFACES, mean_error=0.0)
        sides = [each[some] for each in (mean, *limits)]
        ranges.append(_range([agreement(*sides, each[some]) for each in shares]))
    return np.array(ranges)


def _range(rows):
    """95 % range of each figure over some rows of figures, shape (figures, 2)."""
    return pd.DataFrame(rows)[list(FIGURES)].quantile([0.025, 0.975]).T  # of the known ones


def _left_out(members, windows, ratio, pair):
    """Range of each figure over the realisations left out, shape (figures, 2)."""
    sides = []
    # Variance of a record less the others' mean, over that of a revolution.
    deviation = np.sqrt((ratio * (len(members) - 1) + 1.0) / len(members))
    for number, member in enumerate(members):
        others = np.delete(members, number, axis=0)
        mean, size = others.mean(axis=0), effective_sample_size(others, windows)
        limits = prediction_limits(mean, size, ratio, len(others))
        shares = np.clip(member + (deviation - 1.0) * (member - mean), 0.0, 1.0)
        # A pair that never touches, or always, stays one.
        shares = np.where(member * (1.0 - member), shares, member)
        sides.append(np.broadcast_arrays(mean, *limits, shares))
    left_out = (np.arange(len(members))[:, None] + pair) % len(members)
    by_record = np.array(sides)[left_out, :, np.arange(pair.size)]
    return _range([agreement(*one.T) for one in by_record])


def _level_means(table, simulated):
    """Means of simulated and measured values at every level of force, speed and temperature."""
    measured, means = table["measured_share"].values, {}
    for name in GROUPS:
        assigned = table[f"{name}_level"].values
        levels = np.unique(assigned[np.isfinite(assigned)])
        at = [(assigned == level) & np.isfinite(measured) for level in levels]
        rows = [[mean_or_nan(row[here & np.isfinite(row)]) for here in at] for row in simulated]
        means |= {
            f"{name}_group": levels,
            f"simulated_mean_by_{name}": rows,
            f"measured_mean_by_{name}": [mean_or_nan(measured[here]) for here in at],
        }
    return means


def _missing(table, levels):
    """One line for each operating point of the study without a record."""
    known = np.isfinite(table["measured_share"].values)
    columns = [table["lubricant"].values, *(table[f"{name}_level"].values for name in GROUPS)]
    found = set(zip(*(column[known].tolist() for column in columns), strict=True))
    grid = itertools.product(*(levels[name].values.tolist() for name in ("lubricant", *GROUPS)))
    return [
        f"{levels_named(dict(zip(GROUPS, point[1:], strict=True)))}"
        f"{f', {point[0]}' if levels.sizes['lubricant'] > 1 else ''}: no record"
        for point in grid
        if point not in found
    ]


def _contradictions(tables):
    """One line for any two records of one operating point whose shares differ too much.

    They differ too much for every contact model that records are compared with. If one of them is
    correct, one experiment in twenty has such a line by chance.
    """
    table = next(iter(tables.values()))
    names = ["lubricant", "slide_to_roll_ratio", *(f"{name}_level" for name in GROUPS)]
    columns = pd.DataFrame({name: table[name].values for name in names})
    points = columns.groupby(names).indices.values()  # records without a level are dropped
    couples = [couple for rows in points for couple in itertools.combinations(rows, 2)]
    share, record = table["measured_share"].values, table["record"].values
    many = max(len(couples), 1)
    half = np.max([_half_widths(each, model, many) for model, each in tables.items()], axis=0)
    return [
        f"{record[one]} and {record[other]} are of one operating point, but contradict each "
        f"other: shares {share[one]:.4g} and {share[other]:.4g}"
        for one, other in couples
        if abs(share[one] - share[other]) > math.hypot(half[one], half[other])
    ]


def _half_widths(table, contact_model, comparisons):
    """Half-width of the interval of each record's share, for many comparisons at once.

    It is that of the prediction by the first formula, widened as pairs scatter at the share of the
    record, if this is greater; and at least that of the record's own interval.
    """
    name, count = "simulated_probability", SURFACES
    if contact_model == "line":
        name, count = "pooled_probability", table.sizes["realisation"]
    first = table.isel(film_formula=0)
    mean = first[name].values
    sides = [abs(first[f"predicted_share{side}"].values - mean) for side in LIMITS[1:]]
    share = first["measured_share"].values
    own = [abs(first[f"measured_share{side}"].values - share) for side in LIMITS[1:]]
    wider = np.sqrt(share * (1.0 - share) / np.maximum(mean * (1.0 - mean), 1e-6))
    factor = np.fmax(wider, 1.0) * quantile(count, comparisons) / quantile(count)
    return np.fmax(np.maximum(*sides) * factor, np.maximum(*own))
