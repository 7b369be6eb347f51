"""The narrowest band that explains a record."""

import numpy as np
import pytest
import xarray as xr
from studies import CONFIG

from lube.schema import POINT_DIMS
from lube.stages import record_bands
from lube.stages.record_bands import _needed, _shares
from lube.statistics.one_pair import prediction_limits
from lube.study.study import load_study


def test_the_narrowest_band_counts_and_an_unknown_film_has_none():
    nan = np.nan
    columns = {
        "measured_share": [0.10, 0.14, 0.30, 0.90, 0.10, nan, 0.30, 0.14],
        "simulated_probability_lower": [0.09, 0.09, 0.09, 0.09, nan, 0.09, 0.09, 0.09],
        "simulated_probability_upper": [0.11, 0.11, 0.11, 0.11, nan, 0.11, 0.11, 0.11],
        "predicted_share_lower": [0.05, 0.05, 0.05, 0.05, nan, 0.05, 0.05, 0.05],
        "predicted_share_upper": [0.15, 0.15, 0.15, 0.15, nan, 0.15, 0.15, 0.15],
        "assumed_share_lower": [0.01, 0.01, 0.01, 0.01, nan, 0.01, nan, nan],
        "assumed_share_upper": [0.50, 0.50, 0.50, 0.50, nan, 0.50, nan, nan],
    }
    table = xr.Dataset({name: ("record", values) for name, values in columns.items()})
    exact = ["mean", "pair", "assumptions", "none", "", "", "", "pair"]
    assert _needed(table, np.zeros(8)).tolist() == exact
    assert _needed(table, np.full(8, 0.02))[1] == "mean"


def test_without_assumptions_the_band_is_that_of_one_pair():
    places = (np.arange(4000) + 0.5)[:, None] / 4000
    for mean in (0.001, 0.3, 0.99):
        expected = prediction_limits(np.array([mean]), 100.0, 1.0, 10**6)
        found = np.quantile(_shares(np.full((4000, 1), mean), 100.0, places), (0.025, 0.975))
        assert found == pytest.approx(np.ravel(expected), abs=1e-3)


def test_each_contact_model_has_a_band_and_slip_has_no_assumptions(monkeypatch):
    """Two records, the second with slip; the study's assumptions are about lines alone."""
    study = load_study(CONFIG / "smoke.yaml").model_copy(
        update={"contact_model": ("line", "surface")}
    )

    class Sampled:
        of = staticmethod(lambda *_, **__: Sampled())
        choices = staticmethod(lambda name, own: (own,))
        draws = staticmethod(
            lambda _: (np.full((64, 2), 0.3), np.linspace(0.01, 0.99, 64)[:, None])
        )

    monkeypatch.setattr(record_bands, "Deviating", Sampled)
    monkeypatch.setattr(record_bands, "Predictor", Sampled)
    conditions = {"lubricant": "oil", "temperature": 60.0, "speed": 100.0, "force": 800.0}
    own = "film_formula", "record"
    values = {
        **{name: ("record", [value] * 2) for name, value in conditions.items()},
        "slide_to_roll_ratio": ("record", [0.0, 0.5]),
        "origin": "measured",
        **{f"measured_share{end}": ("record", [0.28, 0.28]) for end in ("", "_lower", "_upper")},
        "share_error": ("record", [0.0, 0.0]),
        "scatter_ratio": (own, [[1.0, 1.0]]),
        "contact_half_width": ("record", [1e-4, 1e-4]),
        "breakthrough_probability": (("realisation", *own), [[[0.15, 0.15]], [[0.25, 0.25]]]),
    }
    ends = {"lower": [[[0.19, 0.19]], [[0.95, 0.95]]], "upper": [[[0.21, 0.21]], [[0.99, 0.99]]]}
    for end, each in ends.items():
        for name in ("simulated_probability", "predicted_share"):
            values[f"{name}_{end}"] = ("contact_model", *own), each
    levels = {"contact_model": ["line", "surface"], "record": ["one", "two"]}
    comparison = xr.Dataset(values, levels, {"travel": 0.3, "longest_wavelength": 4e-4})
    surfaces = xr.Dataset(
        {"sample_size": (own, [[50.0, 50.0]]), "scatter_ratio": ("record", [1.0, 1.0])}
    )
    inputs = {"comparison": comparison, "surface_records": surfaces, "sensitivity_runs": None}
    found = record_bands.make(study, inputs)
    assert found["band_needed"].dims == ("contact_model", "record")
    assert found["band_needed"].values.tolist() == [["assumptions", ""], ["", ""]]
    line = found.sel(contact_model="line").isel(record=0)
    assert line["assumed_share_lower"] < 0.28 < line["assumed_share_upper"]
    assert set(POINT_DIMS) <= set(found.coords)
