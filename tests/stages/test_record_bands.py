"""The narrowest band that explains a record."""

import numpy as np
import xarray as xr

from lube.stages.record_bands import _needed


def test_the_narrowest_band_counts_and_an_unknown_film_has_none():
    nan = np.nan
    columns = {
        "measured_share": [0.10, 0.14, 0.30, 0.90, 0.10, nan],
        "simulated_probability_lower": [0.09, 0.09, 0.09, 0.09, nan, 0.09],
        "simulated_probability_upper": [0.11, 0.11, 0.11, 0.11, nan, 0.11],
        "predicted_share_lower": [0.05, 0.05, 0.05, 0.05, nan, 0.05],
        "predicted_share_upper": [0.15, 0.15, 0.15, 0.15, nan, 0.15],
        "assumed_share_lower": [0.01, 0.01, 0.01, 0.01, nan, 0.01],
        "assumed_share_upper": [0.50, 0.50, 0.50, 0.50, nan, 0.50],
    }
    table = xr.Dataset({name: ("record", values) for name, values in columns.items()})
    assert _needed(table).tolist() == ["mean", "pair", "assumptions", "none", "", ""]
