"""Simulation beside records: exact figures, gaps listed, the origin never lost."""

import logging

import numpy as np
import pytest
import scipy.stats
import xarray as xr
from hypothesis import given
from hypothesis import strategies as st

from lube import compare, contact_statistics, gather
from lube.comparison import agreement
from lube.errors import DataError
from lube.schema import COMPARISON_DIMS, EXPERIMENT_DIMS, check

FORMULA = {"film_formula": "paper"}


@pytest.fixture(scope="module")
def contact(lines, film, study):
    return gather([contact_statistics(lines, film, study.boundary_layer, [0.0, 0.1])], film)


@pytest.fixture(scope="module")
def simulated(contact):
    """Probability and limits by one film formula, over the experiment's dimensions."""
    return [
        contact[f"breakthrough_probability_{limit}"].sel(FORMULA, drop=True)
        for limit in ("mean", "lower", "upper")
    ]


@pytest.fixture(scope="module")
def perfect(simulated, make_experiment):
    """A rig that measures what is simulated by one film formula."""
    return make_experiment(*simulated)


@pytest.fixture(scope="module")
def comparison(contact, perfect):
    return compare(contact, perfect)


def test_the_comparison_fits_its_schema_and_names_its_origin(comparison):
    assert check(comparison, "comparison") is comparison
    assert comparison["origin"].item() == "simulated"
    for name in ("measured_share", "bias", "simulated_mean_by_force", "intervals_overlap"):
        assert comparison[name].isel({comparison[name].dims[0]: 0})["origin"] == "simulated"
        assert (comparison[name] * 2)["origin"] == "simulated"


def test_both_sides_stand_under_their_own_levels(comparison, contact, simulated):
    for limit, suffix in (("mean", ""), ("lower", "_lower"), ("upper", "_upper")):
        beside = comparison[f"simulated_probability{suffix}"]
        source = contact[f"breakthrough_probability_{limit}"].transpose(*COMPARISON_DIMS)
        np.testing.assert_array_equal(beside, source)
    np.testing.assert_array_equal(
        comparison["measured_share"], simulated[0].transpose(*EXPERIMENT_DIMS)
    )


def test_a_perfect_rig_agrees_perfectly(comparison):
    figures = comparison.sel(**FORMULA, threshold=100.0)
    for name in ("bias", "rms_difference", "logit_rms_difference"):
        assert figures[name] == pytest.approx(0.0, abs=1e-12)
    assert figures["rank_correlation"] == pytest.approx(1.0)
    assert figures["overlap_share"] == 1.0
    assert comparison["intervals_overlap"].sel(FORMULA).all()
    for level in ("force", "speed", "temperature"):
        means = [
            comparison.sel(FORMULA)[f"{side}_mean_by_{level}"] for side in ("simulated", "measured")
        ]
        np.testing.assert_allclose(*means)


def test_every_threshold_has_its_figures(comparison, simulated):
    figures = comparison.sel(FORMULA)
    assert figures["bias"].sel(threshold=10.0) == pytest.approx(0.5 * simulated[0].mean().item())
    np.testing.assert_allclose(figures["bias"].sel(threshold=1000.0), 0.0, atol=1e-12)


def test_calibration_is_the_mean_of_the_compared_points(contact, simulated, make_experiment):
    share, lower, upper = (
        side.where((side.force > 100.0) | (side.speed > 60.0)) for side in simulated
    )
    found = compare(contact, make_experiment(share, lower, upper)).sel(FORMULA)
    for level in ("force", "speed", "temperature"):
        for value in contact[level].values:
            expected = np.nanmean(share.sel({level: value}))
            for side in ("simulated", "measured"):
                mean = found[f"{side}_mean_by_{level}"].sel({level: value})
                assert mean == pytest.approx(expected)


def test_points_without_a_record_are_listed_and_left_out(
    contact, simulated, make_experiment, caplog
):
    gap = (simulated[0].force == 800.0) & (simulated[0].slide_to_roll_ratio == 0.0)
    experiment = make_experiment(*(side.where(~gap) for side in simulated))
    with caplog.at_level(logging.WARNING):
        found = compare(contact, experiment)
    assert len(found.missing.splitlines()) == 12
    assert (
        found.missing.splitlines()[0] == "800 N, 60 rpm, 40 degC, slide-to-roll ratio 0: no record"
    )
    assert caplog.messages == [*found.missing.splitlines()[:10], "... and 2 more"]
    assert (found["compared_points"] == 120 - 12).all()
    assert not found["intervals_overlap"].sel(force=800.0, slide_to_roll_ratio=0.0).any()
    part = compare(contact, experiment.sel(slide_to_roll_ratio=[0.1]))
    assert len(part.missing.splitlines()) == 60


def test_points_without_a_simulation_are_listed_too(contact, perfect):
    partial = contact.copy(deep=True)
    partial["breakthrough_probability_mean"][{"force": 0, "speed": 1, "temperature": 2}] = np.nan
    found = compare(partial, perfect)
    assert [line.split(": ")[1] for line in found.missing.splitlines()] == ["no simulation"] * 2
    assert (found["compared_points"] == 118).all()
    for level in ("force", "speed", "temperature"):
        means = [
            found.sel(FORMULA)[f"{side}_mean_by_{level}"] for side in ("simulated", "measured")
        ]
        np.testing.assert_allclose(*means)


def test_levels_that_are_not_the_studys_are_refused(contact, perfect):
    with pytest.raises(DataError, match=r"temperature 41.0 is not a level of the study"):
        compare(contact, perfect.assign_coords(temperature=[41.0, 55.0, 70.0, 80.0]))


def test_an_experiment_without_any_record_has_no_figures(contact, simulated, make_experiment):
    found = compare(contact, make_experiment(*(side * np.nan for side in simulated)))
    assert (found["compared_points"] == 0).all()
    assert xr.concat([found["bias"], found["overlap_share"]], "figure").isnull().all()


# Figures of agreement


PROBABILITIES = st.lists(
    st.tuples(st.floats(0.01, 0.99), st.floats(0.01, 0.99)), min_size=3, max_size=20, unique=True
)


def sides(pairs, width=0.01):
    columns = np.array(pairs, float).reshape(-1, 2).T
    return [(side, side - width, side + width) for side in columns]


@given(PROBABILITIES)
def test_swapping_the_sides_turns_the_bias_and_nothing_else(pairs):
    there, back = agreement(*sides(pairs)), agreement(*sides(pairs)[::-1])
    assert there["bias"] == pytest.approx(-back["bias"])
    for name in set(there) - {"bias"}:
        assert there[name] == pytest.approx(back[name], nan_ok=True)
    assert abs(there["bias"]) <= there["rms_difference"] + 1e-12


@given(PROBABILITIES)
def test_contact_and_no_contact_mirror_each_other(pairs):
    there = agreement(*sides(pairs))
    mirrored = agreement(*sides(1.0 - np.array(pairs)))
    assert mirrored["bias"] == pytest.approx(-there["bias"])
    for name in ("rms_difference", "logit_rms_difference"):
        assert mirrored[name] == pytest.approx(there[name])


def test_the_logit_scale_knows_odds():
    """Odds of 1 to 9 against 1 to 99 are a factor of 11, wherever on the scale."""
    found = agreement(*sides([(0.1, 0.01), (0.9, 0.99), (0.0, 0.2), (1.0, 0.3)]))
    assert found["logit_rms_difference"] == pytest.approx(np.log(11.0))
    assert (found["logit_points"], found["compared_points"]) == (2, 4)


def test_touching_intervals_overlap_and_unknown_ones_do_not_count():
    simulated = np.array([0.2, 0.2, 0.2]), np.array([0.1] * 3), np.array([0.25] * 3)
    measured = np.array([0.3, 0.4, 0.2]), np.array([0.25, 0.35, np.nan]), np.array([0.4, 0.5, 0.3])
    assert agreement(simulated, measured)["overlap_share"] == 0.5


@pytest.mark.parametrize("seed", range(5))
def test_the_rank_correlation_is_spearmans(seed):
    rng = np.random.default_rng(seed)
    p, m = rng.integers(1, 9, (2, 40)) / 10.0  # with many ties
    found = agreement((p, p, p), (m, m, m))["rank_correlation"]
    assert found == pytest.approx(scipy.stats.spearmanr(p, m).statistic, rel=1e-12)


@pytest.mark.parametrize("pairs", [[], [(0.1, 0.2)], [(0.1, 0.2), (0.1, 0.3)]])
def test_too_few_points_or_equal_ones_have_no_ranks(pairs):
    found = agreement(*sides(pairs))
    assert np.isnan(found["rank_correlation"])
    assert np.isnan(found["bias"]) == (len(pairs) == 0)
