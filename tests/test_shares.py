"""Shares of a rig brought to the study's levels, or refused in one line."""

import logging

import numpy as np
import pytest
import xarray as xr

from lube.errors import DataError
from lube.levels import levels_told
from lube.schema import EXPERIMENT_DIMS, FILES
from lube.shares import (
    at_comparison_threshold,
    in_pure_rolling,
    limited,
    lines_of,
    log_lines,
    on_study_levels,
)


@pytest.fixture(scope="module")
def share(film):
    """A share of its own at every operating point, in pure rolling."""
    points = film["film_thickness"].isel(film_formula=0, drop=True)
    share = points.copy(data=np.linspace(0.0, 0.9, points.size).reshape(points.shape))
    return share.expand_dims(slide_to_roll_ratio=[0.0]).transpose(*EXPERIMENT_DIMS)


@pytest.fixture(scope="module")
def experiment(make_experiment, share):
    return make_experiment(share, 0.9 * share, 1.1 * share)


def refusal(call, *arguments):
    with pytest.raises(DataError) as caught:
        call(*arguments)
    assert "\n" not in str(caught.value)
    return str(caught.value)


def test_levels_that_differ_by_rounding_become_the_studys(experiment, film, share):
    rounded = experiment.assign_coords(
        speed=experiment["speed"] * (1.0 + 3e-10), force=experiment["force"] * (1.0 - 3e-10)
    )
    found = on_study_levels(rounded, film)
    for name in ("speed", "force", "temperature", "lubricant"):
        np.testing.assert_array_equal(found[name], film[name])
    np.testing.assert_array_equal(found["contact_share"].sel(threshold=100.0), share)


def test_levels_in_another_order_keep_their_shares(experiment, film, share):
    turned = experiment.isel(force=slice(None, None, -1), temperature=[2, 0, 3, 1])
    found = on_study_levels(turned, film)["contact_share"].sel(threshold=100.0)
    np.testing.assert_array_equal(found, share)


def test_levels_without_a_record_are_there_as_gaps(experiment, film):
    found = on_study_levels(experiment.isel(force=[0, 3]), film)["contact_share"]
    assert found.sizes["force"] == film.sizes["force"]
    gaps = found.isnull().all([name for name in found.dims if name != "force"])
    np.testing.assert_array_equal(gaps, [False, True, True, False, True])


def test_the_origin_is_carried_along(experiment, film):
    shares = at_comparison_threshold(on_study_levels(experiment, film), experiment)
    assert shares["origin"].item() == "simulated"
    assert shares["contact_share"].isel(force=0)["origin"].item() == "simulated"


@pytest.mark.parametrize(
    ("name", "level"), [("force", 123.0), ("speed", 100.001), ("lubricant", "butter")]
)
def test_levels_that_are_not_the_studys_are_refused(experiment, film, name, level):
    levels = experiment[name].values.astype("U30" if name == "lubricant" else float)
    levels[-1] = level
    message = refusal(on_study_levels, experiment.assign_coords({name: levels}), film)
    assert message.startswith(f"experiment: {name} {level} is not a level of the study")
    assert levels_told(film[name].values[:1].tolist()) in message


def test_the_threshold_to_compare_is_picked(experiment, film):
    shares = on_study_levels(experiment, film)
    other = experiment.assign(comparison_threshold=10.0)
    for which, threshold in ((experiment, 100.0), (other, 10.0)):
        found = at_comparison_threshold(shares, which)["contact_share"]
        np.testing.assert_array_equal(found, shares["contact_share"].sel(threshold=threshold))


def test_a_threshold_that_was_not_evaluated_is_refused(experiment, film):
    shares = on_study_levels(experiment, film)
    message = refusal(at_comparison_threshold, shares, experiment.assign(comparison_threshold=50.0))
    assert "threshold 50 ohm is not among those evaluated, 10, 100, 1000" in message


def test_pure_rolling_is_picked_or_missed(experiment):
    rolling = in_pure_rolling(experiment)
    assert "slide_to_roll_ratio" not in rolling.coords
    assert rolling.contact_share.notnull().any()
    slipping = in_pure_rolling(experiment.assign_coords(slide_to_roll_ratio=[0.1]))
    assert slipping.contact_share.sizes == rolling.contact_share.sizes
    assert slipping.contact_share.isnull().all()


def test_a_value_and_its_limits_are_named_as_in_the_schema():
    named = limited("contact_share", [0.5, 0.4, 0.6])
    assert named == {
        "contact_share": 0.5,
        "contact_share_lower": 0.4,
        "contact_share_upper": 0.6,
    }
    assert set(named) <= set(FILES["experiment"])


# Lists of points


def test_points_are_told_in_the_rigs_terms():
    absent = xr.DataArray(
        [[False, True], [False, False]],
        coords={"speed": [600.0 / 7.0, 100.0], "force": [100.0, 800.0]},
        dims=("speed", "force"),
    ).expand_dims(temperature=[40.0], lubricant=["oil"], slide_to_roll_ratio=[0.0])
    assert lines_of(absent, "no record") == ["800 N, 85.7143 rpm, 40 degC: no record"]
    several = xr.concat([absent, absent], xr.Variable("slide_to_roll_ratio", [0.0, 0.1]))
    assert lines_of(several, "no record")[1].endswith("40 degC, slide-to-roll ratio 0.1: no record")


def test_nothing_missing_is_no_line():
    absent = xr.DataArray([False], coords={"force": [1.0]}, dims="force")
    assert lines_of(absent.expand_dims(speed=[1.0], temperature=[1.0]), "no record") == []


@pytest.mark.parametrize(("count", "told"), [(0, 0), (10, 10), (11, 11), (125, 11)])
def test_long_lists_are_cut_in_the_log(caplog, count, told):
    with caplog.at_level(logging.WARNING):
        log_lines(logging.getLogger("lube.shares"), [f"line {i}" for i in range(count)])
    assert len(caplog.messages) == told
    if count > 10:
        assert caplog.messages[-1] == f"... and {count - 10} more"
