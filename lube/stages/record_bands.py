"""The record_bands stage: which of the model's bands explains the contact share of each record."""

import numpy as np
import xarray as xr

from lube.ehl.line_contact import one_blas_thread
from lube.grid.film_profiles import six_digits
from lube.schema import LIMITS, POINT_DIMS, label
from lube.sensitivity.conditions import Deviating
from lube.sensitivity.predictor import Predictor
from lube.study.study import Study
from lube.types import Datasets

_CONDITIONS = (*POINT_DIMS, "slide_to_roll_ratio", "origin")
_BANDS = {
    "mean": "simulated_probability",
    "pair": "predicted_share",
    "assumptions": "assumed_share",
}
"""Bands from the narrowest to the widest, with the variables that hold them."""


def make(study: Study, inputs: Datasets, threads: int = 1) -> xr.Dataset:
    """Make ``record_bands.nc``; see `lube.stages`.

    A band explains a record whose contact share lies in it. The band of the mean is its 95 %
    interval, that of a pair the 95 % prediction interval of one pair's record. The band of the
    assumptions holds 90 % of the means over pairs at the conditions of the record, in pure rolling;
    it is widened by as much as one pair differs from the mean. All are by the first film formula.
    """
    comparison = inputs["comparison"].isel(film_formula=0, drop=True)
    comparison = comparison.isel(contact_model=0, drop=True, missing_dims="ignore")
    names = [f"measured_share{end}" for end in LIMITS]
    for end in LIMITS[1:]:
        names += [f"simulated_probability{end}", f"predicted_share{end}"]
    kept = comparison.reset_coords()[["record", *names, *_CONDITIONS]].drop_attrs()
    table = kept.set_coords(_CONDITIONS)
    points = xr.Dataset({name: ("point", table[name].values) for name in POINT_DIMS})
    with one_blas_thread():  # the number of threads would change the last digits
        predictor = Predictor.of(Deviating.of(study), inputs["sensitivity_runs"])
        band = predictor.band(points)
    mean = comparison["simulated_probability"].values
    for end, assumed in zip(LIMITS[1:], band, strict=True):
        with np.errstate(divide="ignore", invalid="ignore"):
            wider = table[f"predicted_share{end}"].values / mean
        wider = np.where(np.isfinite(wider), wider, 1.0)
        table[f"assumed_share{end}"] = "record", six_digits(np.clip(assumed * wider, 0.0, 1.0))
    table["band_needed"] = "record", _needed(table)
    return label(table, "record_bands")


def _needed(table):
    """Name the narrowest band that explains each record."""
    share = table["measured_share"].values
    limits = {
        name: [table[f"{variable}{end}"].values for end in LIMITS[1:]]
        for name, variable in _BANDS.items()
    }
    known = np.isfinite([share, *(each for pair in limits.values() for each in pair)]).all(axis=0)
    inside = [(share >= lower) & (share <= upper) for lower, upper in limits.values()]
    return np.where(known, np.select(inside, list(limits), "none"), "")
