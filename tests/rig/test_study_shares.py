"""Shares of a rig's records: the compared threshold, views over the grid, and lines about them."""

import logging
import warnings

import numpy as np
import pytest
from experiments import experiment_at, experiment_of

from lube.errors import DataError
from lube.rig.study_shares import (
    at_comparison_threshold,
    levels_named,
    limited,
    log_lines,
    over_grid,
)
from lube.schema import EXPERIMENT_DIMS, FILES

SHARES = np.linspace(0.0, 0.5, 12)


@pytest.fixture(scope="module")
def experiment(busy_study):
    """A record at each of the 12 points of the grid."""
    return experiment_at(busy_study.operating_grid.model_dump(), SHARES)


# The threshold


@pytest.mark.parametrize(("threshold", "factor"), [(10.0, 0.5), (100.0, 1.0)])
def test_the_threshold_to_compare_is_picked(experiment, threshold, factor):
    shares = at_comparison_threshold(experiment.assign(comparison_threshold=threshold))
    np.testing.assert_array_equal(shares["contact_share"], factor * SHARES)
    assert shares["contact_share"].dims == ("record",)
    assert shares["contact_share"]["origin"].item() == "simulated"


def test_a_threshold_that_was_not_evaluated_is_refused(experiment):
    with pytest.raises(DataError, match=r"threshold 50 ohm is not among .* 10, 100, 1000$"):
        at_comparison_threshold(experiment.assign(comparison_threshold=50.0))


# Over the grid


def test_one_record_a_point_becomes_a_table_of_the_grid(experiment):
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        table = over_grid(experiment)
    assert set(table["contact_share"].dims) == {*EXPERIMENT_DIMS, "repeat", "threshold"}
    assert table.sizes["repeat"] == 1 and table["contact_share"].notnull().all()
    for record in range(12):
        here = experiment.isel(record=record)
        levels = {name: here[name].item() for name in EXPERIMENT_DIMS}
        there = table.sel(levels).isel(repeat=0)
        np.testing.assert_array_equal(there["contact_share"], here["contact_share"])


def test_all_records_of_a_point_are_there_once_and_come_back(experiment):
    """Round trip: every record, however many a point has, and NaN elsewhere."""
    chosen = experiment.isel(record=[3, 0, 3, 7, 3, 0])
    chosen = chosen.assign(share_error=("record", np.arange(1.0, 7.0)))
    table = over_grid(chosen)
    assert table.sizes["repeat"] == 3
    stacked = table["share_error"].stack(record=[*EXPERIMENT_DIMS, "repeat"]).dropna("record")
    assert sorted(stacked.values) == [1.0, 2.0, 3.0, 4.0, 5.0, 6.0]
    for level, expected in ((3, [1.0, 3.0, 5.0]), (0, [2.0, 6.0, np.nan])):
        here = experiment.isel(record=level)
        levels = {name: here[name].item() for name in EXPERIMENT_DIMS}
        np.testing.assert_array_equal(table["share_error"].sel(levels), expected)


def test_a_record_stands_under_the_level_it_is_near_and_without_one_is_left_out():
    experiment = experiment_of(
        [0.1, 0.2, 0.3],
        force=[803.0, 800.0, 555.0],
        speed=100.0,
        temperature=[40.4, 80.0, 40.0],
        force_level=[800.0, 800.0, np.nan],
        temperature_level=[40.0, 80.0, 40.0],
    )
    table = over_grid(experiment)
    assert table["force"].values.tolist() == [800.0]
    shares = table["contact_share"].sel(threshold=100.0).squeeze()
    assert shares.sel(temperature=40.0) == 0.1 and shares.sel(temperature=80.0) == 0.2


def test_slips_and_lubricants_are_kept_apart():
    experiment = experiment_of(
        [0.1, 0.2, 0.3],
        force=800.0,
        speed=100.0,
        temperature=40.0,
        slide_to_roll_ratio=[0.0, 0.1, 0.1],
        lubricant=["thin", "thin", "thick"],
    )
    shares = over_grid(experiment)["contact_share"].sel(threshold=100.0).squeeze()
    assert shares.sel(slide_to_roll_ratio=0.1, lubricant="thick") == 0.3
    assert shares.sel(slide_to_roll_ratio=0.0, lubricant="thick").isnull()


def test_records_near_no_level_leave_an_empty_table():
    experiment = experiment_of([0.1], [555.0], [100.0], [40.0], force_level=np.nan)
    assert over_grid(experiment)["contact_share"].size == 0


# Words


def test_a_value_and_its_limits_are_named_as_in_the_schema():
    named = limited("contact_share", [0.5, 0.4, 0.6])
    assert named == {
        "contact_share": 0.5,
        "contact_share_lower": 0.4,
        "contact_share_upper": 0.6,
    }
    assert set(named) <= set(FILES["experiment"])


def test_a_point_is_named_in_the_rigs_terms():
    point = {"force": 800.0, "speed": 600.0 / 7.0, "temperature": 40.0}
    assert levels_named(point) == "800 N, 85.7143 rpm, 40 degC"


@pytest.mark.parametrize(("count", "told"), [(0, 0), (10, 10), (11, 11), (125, 11)])
def test_long_lists_are_cut_in_the_log(caplog, count, told):
    with caplog.at_level(logging.WARNING):
        log_lines(logging.getLogger("lube.rig.study_shares"), [f"line {i}" for i in range(count)])
    assert len(caplog.messages) == told
    if count > 10:
        assert caplog.messages[-1] == f"... and {count - 10} more"
