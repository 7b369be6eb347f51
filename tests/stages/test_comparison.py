"""Simulation beside records: exact figures, prediction intervals, gaps and contradictions told."""

import logging

import numpy as np
import pytest
import scipy.stats
from experiments import experiment_at, experiment_of, model_of_records
from hypothesis import given
from hypothesis import strategies as st

from lube.errors import DataError
from lube.rig.study_shares import over_grid
from lube.schema import EXPERIMENT_DIMS, check
from lube.stages.comparison import FIGURES, GROUPS, agreement, compare
from lube.statistics.one_pair import prediction_limits, quantile
from lube.statistics.sample_size import effective_sample_size

FORMULA = {"film_formula": "paper"}
POINT = {"force": 400.0, "speed": 100.0, "temperature": 60.0}


@pytest.fixture(scope="module")
def members(busy):
    """Probability of each realisation at the 12 points of the grid by one formula, (R, 12)."""
    found = busy.contact["breakthrough_probability"].sel(FORMULA).squeeze()
    return found.transpose("realisation", "temperature", "speed", "force").values.reshape(32, 12)


@pytest.fixture(scope="module")
def mean(members):
    return members.mean(axis=0)


@pytest.fixture(scope="module")
def compared(busy):
    """Compare an experiment with the busy study."""

    def run(experiment):
        model = model_of_records(experiment, busy.film, busy.contact, busy.study)
        return compare(model, experiment, busy.contact)

    return run


@pytest.fixture(scope="module")
def at_grid(compared, busy):
    """Compare shares at the 12 points of the grid."""
    grid = busy.study.operating_grid.model_dump()
    return lambda shares, **values: compared(experiment_at(grid, shares, **values))


@pytest.fixture(scope="module")
def at_point(compared):
    """Compare several records of one point."""
    return lambda shares, **values: compared(experiment_of(shares, **(POINT | values)))


@pytest.fixture(scope="module")
def perfect(at_grid, mean):
    """A rig that measures what is simulated by one film formula."""
    return at_grid(mean)


# Both sides


def test_the_comparison_fits_its_schema_and_names_its_origin(perfect):
    assert check(perfect, "comparison") is perfect
    assert perfect["origin"].item() == "simulated"
    for name in ("measured_share", "bias", "simulated_mean_by_force", "within_prediction"):
        assert perfect[name].isel({perfect[name].dims[0]: 0})["origin"] == "simulated"


def test_both_sides_stand_beside_each_other_at_every_record(perfect, busy, mean):
    for limit, suffix in (("mean", ""), ("lower", "_lower"), ("upper", "_upper")):
        source = busy.contact[f"breakthrough_probability_{limit}"].squeeze()
        source = source.transpose("film_formula", "temperature", "speed", "force")
        beside = perfect[f"simulated_probability{suffix}"]
        np.testing.assert_allclose(beside, source.values.reshape(2, 12), rtol=1e-12)
    np.testing.assert_array_equal(perfect["measured_share"], mean)


def test_a_perfect_rig_agrees_perfectly(perfect):
    figures = perfect.sel(**FORMULA, threshold=100.0)
    for name in ("bias", "rms_difference", "logit_rms_difference"):
        assert figures[name] == pytest.approx(0.0, abs=1e-12)
    assert figures["rank_correlation"] == pytest.approx(1.0)
    assert figures["overlap_share"] == 1.0
    assert perfect["within_prediction"].sel(FORMULA).all()
    for level in GROUPS:
        sides = [
            perfect.sel(FORMULA)[f"{side}_mean_by_{level}"] for side in ("simulated", "measured")
        ]
        np.testing.assert_allclose(*sides)


def test_every_threshold_has_its_figures(perfect, mean):
    bias = perfect["bias"].sel(FORMULA)
    assert bias.sel(threshold=10.0) == pytest.approx(0.5 * mean.mean())
    np.testing.assert_allclose(bias.sel(threshold=1000.0), 0.0, atol=1e-12)


def test_calibration_is_the_mean_of_the_records_near_a_level(at_grid, members, mean):
    shares = members[3].copy()
    shares[[0, 7]] = np.nan
    found = at_grid(shares)
    for level in GROUPS:
        for value in found[f"{level}_group"].values:
            here = (found[f"{level}_level"].values == value) & np.isfinite(shares)
            means = found.sel({f"{level}_group": value} | FORMULA)
            assert means[f"measured_mean_by_{level}"] == pytest.approx(shares[here].mean())
            assert means[f"simulated_mean_by_{level}"] == pytest.approx(mean[here].mean())


def test_the_order_of_the_records_changes_nothing(at_grid, compared, members, busy):
    experiment = experiment_at(busy.study.operating_grid.model_dump(), members[5])
    order = np.random.default_rng(1).permutation(12)
    there, back = compared(experiment.isel(record=order)), compared(experiment)
    for name in ("predicted_share_lower", "within_prediction", "simulated_probability"):
        np.testing.assert_array_equal(there[name], back[name].isel(record=order))
    for name in FIGURES:
        np.testing.assert_allclose(there[name], back[name], rtol=1e-12)


def test_a_threshold_that_was_not_evaluated_is_refused(compared):
    experiment = experiment_of([0.2], **POINT).assign(comparison_threshold=55.0)
    with pytest.raises(DataError, match="threshold 55 ohm"):
        compared(experiment)


# The prediction of one pair's record


def test_the_prediction_is_that_of_one_pair_of_rollers(perfect, members, mean):
    looks = effective_sample_size(members, 1.0)
    limits = prediction_limits(mean, looks, np.ones(12), 32)
    for side, expected in zip(("lower", "upper"), limits, strict=True):
        np.testing.assert_allclose(perfect[f"predicted_share_{side}"].sel(FORMULA), expected)
    half = limits[1] - mean
    assert half == pytest.approx(
        quantile(32) * members.std(axis=0, ddof=1) * np.sqrt(1.0 + 1.0 / 32.0)
    )


def test_a_longer_record_of_rollers_in_rolling_is_predicted_no_better(at_point):
    found = at_point([0.2, 0.2, 0.2], turns=[0.25, 1.0, 100.0])
    width = (found["predicted_share_upper"] - found["predicted_share_lower"]).sel(FORMULA).values
    assert width[0] > 1.3 * width[1]
    assert width[2] == pytest.approx(width[1])


def test_the_records_own_error_widens_its_prediction(at_point, members):
    found = at_point([0.2, 0.2], share_error=[0.0, 0.1]).sel(FORMULA)
    upper = found["predicted_share_upper"] - found["simulated_probability"]
    error = upper.values / quantile(32)
    assert error[1] ** 2 == pytest.approx(error[0] ** 2 + 0.1**2)


def test_members_of_the_ensemble_lie_within_the_prediction_as_often_as_it_says(at_grid, members):
    inside = [at_grid(member)["within_prediction"].sel(FORMULA) for member in members]
    assert 0.9 <= np.mean(inside) <= 1.0


def test_what_lies_outside_is_told(at_grid, mean, members):
    shares = mean.copy()
    shares[[2, 9]] = np.minimum(mean + 6.0 * members.std(axis=0), 1.0)[[2, 9]]
    found = at_grid(shares).sel(FORMULA)
    np.testing.assert_array_equal(np.flatnonzero(~found["within_prediction"]), [2, 9])
    assert found["overlap_share"].sel(threshold=100.0) == pytest.approx(10.0 / 12.0)


# What a perfect model would show


def test_the_expected_range_is_that_of_the_members_left_out_in_turn(perfect, members):
    rows = []
    for number, member in enumerate(members):
        others = np.delete(members, number, axis=0)
        middle, scatter = others.mean(axis=0), others.std(axis=0, ddof=1)
        half = quantile(31) * scatter * np.sqrt(1.0 + 1.0 / 31.0)
        logits = np.log(middle / (1.0 - middle) * (1.0 - member) / member)
        rows.append(
            {
                "bias": np.mean(middle - member),
                "rms_difference": np.sqrt(np.mean((middle - member) ** 2)),
                "logit_rms_difference": np.sqrt(np.mean(logits**2)),
                "overlap_share": np.mean(np.abs(member - middle) <= half),
            }
        )
    for name in FIGURES:
        values = [row[name] for row in rows]
        for side, level in (("lower", 0.025), ("upper", 0.975)):
            found = perfect[f"{name}_expected_{side}"].sel(FORMULA).item()
            assert found == pytest.approx(np.quantile(values, level))


def test_a_member_agrees_as_well_as_expected_and_another_roughness_does_not(at_grid, members):
    held = []
    for member in members[:8]:
        found = at_grid(member).sel(FORMULA)
        bias = found["bias"].sel(threshold=100.0)
        held.append(found["bias_expected_lower"] <= bias <= found["bias_expected_upper"])
    assert sum(map(bool, held)) >= 6
    rough = at_grid(np.minimum(2.0 * members[0], 1.0)).sel(FORMULA)
    assert rough["bias"].sel(threshold=100.0) < rough["bias_expected_lower"]


def test_two_realisations_tell_no_range(busy):
    experiment = experiment_of([0.2], **POINT)
    contact = busy.contact.isel(realisation=slice(2))
    study = busy.study.model_copy(update={"realisations": 2})
    found = compare(model_of_records(experiment, busy.film, contact, study), experiment, contact)
    assert found["bias_expected_lower"].isnull().all()
    assert found["predicted_share_lower"].notnull().all()


# Gaps and contradictions


def test_points_without_a_record_are_told(compared, busy, mean, caplog):
    experiment = experiment_at(busy.study.operating_grid.model_dump(), mean).isel(record=[0, 1, 11])
    with caplog.at_level(logging.WARNING):
        found = compared(experiment)
    lines = found.missing.splitlines()
    assert len(lines) == 9
    assert "1600 N, 60 rpm, 60 degC: no record" in lines
    assert "100 N, 60 rpm, 60 degC: no record" not in lines
    assert caplog.messages == lines
    assert (found["compared_records"] == 3).all()


def test_a_record_near_no_level_or_without_a_share_fills_no_gap(at_grid, mean):
    shares = mean.copy()
    shares[4] = np.nan
    nowhere = np.where(np.arange(12) == 7, np.nan, np.tile([100.0, 400.0, 1600.0], 4))
    found = at_grid(shares, force_level=nowhere)
    assert found.missing.splitlines() == [
        "400 N, 60 rpm, 80 degC: no record",
        "400 N, 100 rpm, 60 degC: no record",
    ]
    assert (found["compared_records"] == 11).all()
    assert found["simulated_probability"].notnull().all()
    assert not found["within_prediction"].isel(record=4).any()


def test_all_there_is_no_line(perfect):
    assert perfect.missing == perfect.remarks == ""


def test_an_experiment_without_any_share_has_no_figures(at_grid):
    found = at_grid(np.full(12, np.nan))
    assert (found["compared_records"] == 0).all()
    for name in FIGURES:
        assert found[name].isnull().all() and found[f"{name}_expected_upper"].isnull().all()


def test_records_of_one_point_that_contradict_each_other_are_told(at_point, caplog):
    with caplog.at_level(logging.WARNING):
        found = at_point([0.05, 0.9, 0.06], pair=["1", "2", "3"])
    assert found.remarks.splitlines() == [
        "record 0 and record 1 are of one operating point, but contradict each other: shares "
        "0.05 and 0.9",
        "record 1 and record 2 are of one operating point, but contradict each other: shares "
        "0.9 and 0.06",
    ]
    assert set(found.remarks.splitlines()) <= set(caplog.messages)


@pytest.mark.parametrize(
    "apart",
    [
        {"slide_to_roll_ratio": [0.0, 0.1]},
        {"force": [400.0, 1600.0]},
        {"force": 555.0, "force_level": np.nan},
        {"share_error": 0.5},
    ],
)
def test_records_of_different_or_unknown_points_or_of_large_errors_do_not(at_point, apart):
    assert at_point([0.05, 0.9], **apart).remarks == ""


def test_pairs_that_scatter_as_the_ensemble_does_do_not_contradict(at_point, members):
    found = at_point(members[:, 4], pair=[str(number) for number in range(32)])
    assert found.remarks == ""


def test_contact_too_rare_for_the_ensemble_is_no_contradiction(compared, busy):
    """No realisation touches at so thick a film: there next to nothing is no sharp nothing."""
    experiment = experiment_of([0.0, 1e-6], force=100.0, speed=2000.0, temperature=60.0)
    found = compared(experiment)
    assert (found["simulated_probability"] == 0.0).all()
    assert found["within_prediction"].all()
    assert found.remarks == ""


def test_records_are_seen_over_the_grid_with_all_repeats(at_point):
    found = at_point([0.1, 0.2, 0.15], pair=["1", "2", "3"])
    table = over_grid(found)
    here = table["measured_share"].sel({name: POINT[name] for name in POINT}).squeeze()
    np.testing.assert_array_equal(here, [0.1, 0.2, 0.15])
    assert set(table["predicted_share_lower"].dims) == {*EXPERIMENT_DIMS, "film_formula", "repeat"}


# Figures of agreement


PROBABILITIES = st.lists(
    st.tuples(st.floats(0.01, 0.99), st.floats(0.01, 0.99)), min_size=3, max_size=20, unique=True
)


def figures(pairs, width=0.01):
    """Figures of simulated and measured values, within some width of each other or not."""
    simulated, measured = np.array(pairs, float).reshape(-1, 2).T
    return agreement(simulated, simulated - width, simulated + width, measured)


@given(PROBABILITIES)
def test_swapping_the_sides_turns_the_bias_and_nothing_else(pairs):
    there, back = figures(pairs), figures(np.array(pairs)[:, ::-1])
    assert there["bias"] == pytest.approx(-back["bias"])
    for name in ("rms_difference", "logit_rms_difference", "rank_correlation"):
        assert there[name] == pytest.approx(back[name], nan_ok=True)
    assert abs(there["bias"]) <= there["rms_difference"] + 1e-12


@given(PROBABILITIES)
def test_contact_and_no_contact_mirror_each_other(pairs):
    there, mirrored = figures(pairs), figures(1.0 - np.array(pairs))
    assert mirrored["bias"] == pytest.approx(-there["bias"])
    for name in ("rms_difference", "logit_rms_difference"):
        assert mirrored[name] == pytest.approx(there[name])


def test_the_logit_scale_knows_odds():
    """Odds of 1 to 9 against 1 to 99 are a factor of 11, wherever on the scale."""
    found = figures([(0.1, 0.01), (0.9, 0.99), (0.0, 0.2), (1.0, 0.3)])
    assert found["logit_rms_difference"] == pytest.approx(np.log(11.0))
    assert (found["logit_records"], found["compared_records"]) == (2, 4)


def test_a_share_on_the_limit_is_within():
    simulated = np.full(4, 0.25)
    found = agreement(
        simulated, simulated - 0.125, simulated + 0.25, np.array([0.125, 0.5, 0.1, 0.6])
    )
    assert found["overlap_share"] == 0.5


@pytest.mark.parametrize("seed", range(3))
def test_the_rank_correlation_is_spearmans(seed):
    pairs = np.random.default_rng(seed).integers(1, 9, (40, 2)) / 10.0  # with many ties
    expected = scipy.stats.spearmanr(*pairs.T).statistic
    assert figures(pairs)["rank_correlation"] == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize("pairs", [[], [(0.1, 0.2)], [(0.1, 0.2), (0.1, 0.3)]])
def test_too_few_records_or_equal_ones_have_no_ranks(pairs):
    found = figures(pairs)
    assert np.isnan(found["rank_correlation"])
    assert np.isnan(found["bias"]) == (len(pairs) == 0)
