"""Contact shares of records: views over the grid, and their names."""

import logging
import warnings

import numpy as np
import pytest
from experiments import experiment_at, experiment_of

from lube.inference.study_shares import (
    levels_named,
    log_lines,
    over_grid,
    refused_in_one_line,
)
from lube.schema import EXPERIMENT_DIMS

SHARES = np.linspace(0.0, 0.5, 12)


@pytest.fixture(scope="module")
def experiment(busy_study):
    """A record at each of the 12 points of the grid."""
    return experiment_at(busy_study.operating_grid.model_dump(), SHARES)


def test_every_record_stands_at_its_levels(experiment):
    """However many a point has; NaN where there is none."""
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        one_each = over_grid(experiment)
    assert set(one_each["contact_share"].dims) == {*EXPERIMENT_DIMS, "repeat", "threshold"}
    assert one_each.sizes["repeat"] == 1 and one_each["contact_share"].notnull().all()
    for record in range(12):
        here = experiment.isel(record=record)
        there = one_each.sel({name: here[name].item() for name in EXPERIMENT_DIMS})
        np.testing.assert_array_equal(there["contact_share"].squeeze("repeat"), here.contact_share)

    chosen = experiment.isel(record=[3, 0, 3, 7, 3, 0])
    several = over_grid(chosen.assign(share_error=("record", np.arange(1.0, 7.0))))["share_error"]
    assert sorted(several.values[several.notnull()]) == [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]
    for record, expected in ((3, [1.0, 3.0, 5.0]), (0, [2.0, 6.0, np.nan])):
        here = experiment.isel(record=record)
        there = several.sel({name: here[name].item() for name in EXPERIMENT_DIMS})
        np.testing.assert_array_equal(there, expected)


def test_a_record_near_no_level_is_left_out():
    conditions = {"force": [803.0, 800.0, 555.0], "temperature": [40.4, 80.0, 40.0]}
    levels = {"force_level": [800.0, 800.0, np.nan], "temperature_level": [40.0, 80.0, 40.0]}
    experiment = experiment_of([0.1, 0.2, 0.3], speed=100.0, **conditions, **levels)
    table = over_grid(experiment)
    assert table["force"].values.tolist() == [800.0]
    shares = table["contact_share"].sel(threshold=100.0).squeeze()
    assert shares.sel(temperature=40.0) == 0.1 and shares.sel(temperature=80.0) == 0.2
    assert over_grid(experiment.isel(record=[2]))["contact_share"].size == 0


def test_slips_and_lubricants_are_kept_apart():
    point = {"force": 800.0, "speed": 100.0, "temperature": 40.0}
    own = {"slide_to_roll_ratio": [0.0, 0.1, 0.1], "lubricant": ["thin", "thin", "thick"]}
    experiment = experiment_of([0.1, 0.2, 0.3], **point, **own)
    shares = over_grid(experiment)["contact_share"].sel(threshold=100.0).squeeze()
    assert shares.sel(slide_to_roll_ratio=0.1, lubricant="thick") == 0.3
    assert shares.sel(slide_to_roll_ratio=0.0, lubricant="thick").isnull()


def test_names(experiment):
    point = {"force": 800.0, "speed": 600.0 / 7.0, "temperature": 40.0}
    assert levels_named(point) == "800 N, 85.7143 r/min, 40 °C"
    assert refused_in_one_line(experiment) == ""
    refused = experiment.assign_attrs(refused="a.csv: bad\nb.csv: worse")
    assert refused_in_one_line(refused) == "Refused: 2 of 14 records. a.csv: bad; b.csv: worse"


def test_long_lists_are_cut_in_the_log(caplog):
    for count in (0, 10, 125):
        caplog.clear()
        log_lines(logging.getLogger("lube.rig"), [f"line {i}" for i in range(count)])
        assert len(caplog.messages) == min(count, 11)
    assert caplog.messages[-1] == "... and 115 more"
