"""The record_bands stage: which of the model's bands explains the contact share of each record."""

import numpy as np
import scipy.special
import xarray as xr

from lube.digits import six_digits
from lube.ehl.line_contact import one_blas_thread
from lube.grid.levels import rolling
from lube.grid.operating_points import by_contact_model
from lube.inference.record_curves import realised_shares
from lube.schema import LIMITS, POINT_DIMS, label
from lube.sensitivity.conditions import Deviating
from lube.sensitivity.predictor import Predictor
from lube.statistics.confidence import CONFIDENCE
from lube.study.study import Study
from lube.types import Datasets

ENDS = (1.0 - CONFIDENCE) / 2.0, (1.0 + CONFIDENCE) / 2.0
"""Quantiles at the ends of the band of the assumptions."""
NEAR = 0.01
"""Difference of slide-to-roll ratios that films hardly show."""
_CONDITIONS = (*POINT_DIMS, "slide_to_roll_ratio", "origin")
_BANDS = {
    "mean": "simulated_probability",
    "pair": "predicted_share",
    "assumptions": "assumed_share",
}
"""Bands from the narrowest to the widest, with the variables that hold them."""


def make(study: Study, inputs: Datasets, threads: int = 1) -> xr.Dataset:
    """Make ``record_bands.nc``; see `lube.stages`.

    A band explains a record whose contact share lies in it. All bands hold 95 %: that of the mean
    over pairs is its confidence interval, widened by the error with which the share was measured;
    that of a pair is the prediction interval of one pair's record; that of the assumptions holds
    shares of one pair each, drawn about means that the study's assumptions give. It is known
    nearest to pure rolling, for contact models that the study, or its section ``uncertainty``,
    chooses. All are by the first film formula.

    The interval of a record within itself is not used: it is that of the mean over pairs, and so
    has the scatter of one pair in it already.
    """
    comparison = inputs["comparison"].isel(film_formula=0, drop=True)
    names = [f"measured_share{end}" for end in LIMITS]
    for end in LIMITS[1:]:
        names += [f"simulated_probability{end}", f"predicted_share{end}"]
    kept = comparison.reset_coords()[["record", *names, *_CONDITIONS]].drop_attrs()
    table = kept.set_coords(_CONDITIONS)
    upper = table["predicted_share_upper"]
    assumed = list(_assumed(study, inputs, comparison))
    for end, values in zip(LIMITS[1:], np.stack(assumed, axis=1), strict=True):
        table[f"assumed_share{end}"] = upper.copy(data=six_digits(values).reshape(upper.shape))
    table["band_needed"] = upper.dims, _needed(table, comparison["share_error"].values)
    return label(table, "record_bands")


def _assumed(study, inputs, comparison):
    """Find the ends of the band of the assumptions at all records, for each contact model."""
    points = xr.Dataset({name: ("point", comparison[name].values) for name in POINT_DIMS})
    with one_blas_thread():  # the number of threads would change the last digits
        deviating = Deviating.of(study, temperatures=comparison["temperature"].values)
        runs, responses = inputs["sensitivity_runs"], inputs.get("sensitivity_responses")
        means, places = Predictor.of(deviating, runs, responses).draws(points)
    slip = abs(comparison["slide_to_roll_ratio"].values - rolling(study.slips))
    means[:, slip > NEAR] = np.nan
    trials = _trials(comparison, inputs.get("surface_records"))
    for model in by_contact_model(comparison)["contact_model"].values:
        is_known = model in deviating.choices("contact_model", study.contact_model[0])
        shares = _shares(means if is_known else np.nan * means, trials[model], places)
        yield np.quantile(shares, ENDS, axis=0)


def _shares(mean, trials, place):
    """Draw shares of pairs about their means, as normal as `prediction_limits` takes them."""
    # A record is worth one trial at least.
    deviation = np.sqrt(mean * (1.0 - mean) / np.maximum(trials, 1.0))
    return np.clip(mean + scipy.special.ndtri(place) * deviation, 0.0, 1.0)


def _trials(comparison, surfaces):
    """Count the independent trials that one pair's record is worth, by contact model."""
    _, size = realised_shares(comparison)
    found = {"line": size / comparison["scatter_ratio"].values}
    if surfaces is not None:
        first = surfaces.isel(film_formula=0)
        found["surface"] = (first["sample_size"] / first["scatter_ratio"]).values
    return found


def _needed(table, error):
    """Name the narrowest band that explains each record; empty where that is not known.

    The prediction interval of one pair includes the error of the measured share.
    """
    share, inside, is_known = table["measured_share"].values, [], True
    for name, variable in _BANDS.items():
        lower, upper = (table[f"{variable}{end}"].values for end in LIMITS[1:])
        more = 0.0 if name == "pair" else scipy.special.ndtri(ENDS[1]) * error
        inside.append((share >= lower - more) & (share <= upper + more))
        is_known = is_known & np.isfinite(share + lower + upper)
    return np.select(inside, list(_BANDS), np.where(is_known, "none", ""))
