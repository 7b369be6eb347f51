"""Simulation beside records: figures, prediction intervals, missing and contradicting records."""

import logging

import numpy as np
import pytest
import scipy.stats
from experiments import (
    SURFACE_WINDOWS,
    experiment_at,
    experiment_of,
    made_up_surfaces,
    model_of_records,
    surface_probability,
)
from hypothesis import given
from hypothesis import strategies as st

from lube.inference.surface_scatter import pair_shares
from lube.schema import check
from lube.stages.comparison import FIGURES, GROUPS, agreement, compare
from lube.statistics.one_pair import quantile

FORMULA = {"film_formula": "paper"}
POINT = {"force": 400.0, "speed": 100.0, "temperature": 60.0}


@pytest.fixture(scope="module")
def perfect(at_grid, mean):
    """A rig that measures exactly what one film formula predicts."""
    return at_grid(mean)


# Both sides


def test_both_sides_stand_beside_each_other_at_every_record(perfect, busy, mean):
    assert check(perfect, "comparison") is perfect
    assert perfect["origin"].item() == "simulated"
    for limit, suffix in (("mean", ""), ("lower", "_lower"), ("upper", "_upper")):
        source = busy.contact[f"breakthrough_probability_{limit}"].squeeze()
        source = source.transpose("film_formula", "temperature", "speed", "force")
        beside = perfect[f"simulated_probability{suffix}"]
        np.testing.assert_allclose(beside, source.values.reshape(2, 12), rtol=1e-12)
    np.testing.assert_array_equal(perfect["measured_share"], mean)


def test_the_share_is_that_at_the_threshold_to_compare(compared, busy, mean):
    experiment = experiment_at(busy.study.operating_grid.model_dump(), mean)
    for threshold, factor in ((10.0, 0.5), (100.0, 1.0)):
        found = compared(experiment.assign(comparison_threshold=threshold))
        np.testing.assert_array_equal(found["measured_share"], factor * mean)


def test_a_perfect_rig_agrees_perfectly(perfect, mean):
    figures = perfect.sel(**FORMULA, threshold=100.0)
    for name in ("bias", "rms_difference", "logit_rms_difference"):
        assert figures[name] == pytest.approx(0.0, abs=1e-12)
    assert figures["rank_correlation"] == pytest.approx(1.0)
    assert figures["overlap_share"] == 1.0
    assert perfect["within_prediction"].sel(FORMULA).all()
    bias = perfect["bias"].sel(FORMULA)  # half as much below 10 ohm, the same below 1000
    np.testing.assert_allclose(bias, [0.5 * mean.mean(), 0.0, 0.0], atol=1e-12)
    assert perfect.missing == perfect.remarks == ""


def test_level_means_are_over_the_records_near_a_level(at_grid, members, mean):
    shares = members[3].copy()
    shares[[0, 7]] = np.nan
    found = at_grid(shares)
    for level in GROUPS:
        for value in found[f"{level}_group"].values:
            here = (found[f"{level}_level"].values == value) & np.isfinite(shares)
            means = found.sel({f"{level}_group": value} | FORMULA)
            assert means[f"measured_mean_by_{level}"] == pytest.approx(shares[here].mean())
            assert means[f"simulated_mean_by_{level}"] == pytest.approx(mean[here].mean())


# The prediction of one pair's record


def test_the_prediction_is_that_of_one_pair_of_rollers(perfect, members, mean):
    half = quantile(32) * members.std(axis=0, ddof=1) * np.sqrt(1.0 + 1.0 / 32.0)
    for side, limit in (("lower", np.maximum(mean - half, 0.0)), ("upper", mean + half)):
        found = perfect[f"predicted_share_{side}"].sel(FORMULA)
        np.testing.assert_allclose(found, limit, rtol=1e-9, atol=1e-12)


def test_the_prediction_is_wider_for_short_and_noisy_records_but_not_narrower_for_long(at_point):
    """Equal rollers in rolling repeat themselves."""
    found = at_point([0.2] * 4, turns=[0.25, 1.0, 100.0, 1.0], share_error=[0.0, 0.0, 0.0, 0.1])
    found = found.sel(FORMULA)
    half = (found["predicted_share_upper"] - found["simulated_probability"]).values
    width = (found["predicted_share_upper"] - found["predicted_share_lower"]).values
    assert width[0] > 1.3 * width[1]
    assert width[2] == pytest.approx(width[1])
    error = half / quantile(32)
    assert error[3] ** 2 == pytest.approx(error[1] ** 2 + 0.1**2)


def test_members_of_the_ensemble_lie_within_the_prediction_and_agree_as_expected(at_grid, members):
    found = [at_grid(member).sel(FORMULA) for member in members[:16]]
    assert 0.85 <= np.mean([one["within_prediction"] for one in found]) <= 1.0
    held = [
        one["bias_expected_lower"] <= one["bias"].sel(threshold=100.0) <= one["bias_expected_upper"]
        for one in found
    ]
    assert sum(map(bool, held)) >= 13
    rough = at_grid(np.minimum(2.0 * members[0], 1.0)).sel(FORMULA)
    assert rough["bias"].sel(threshold=100.0) < rough["bias_expected_lower"]


def test_records_outside_the_prediction_are_marked(at_grid, mean, members):
    shares = mean.copy()
    shares[[2, 9]] = np.minimum(mean + 6.0 * members.std(axis=0), 1.0)[[2, 9]]
    found = at_grid(shares).sel(FORMULA)
    np.testing.assert_array_equal(np.flatnonzero(~found["within_prediction"]), [2, 9])
    assert found["overlap_share"].sel(threshold=100.0) == pytest.approx(10.0 / 12.0)


# The range of the figures for a correct model


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


def test_with_slip_records_scatter_less_but_the_error_of_the_mean_stays(
    compared, busy, mean, members
):
    levels = busy.study.operating_grid.model_dump()
    slip = experiment_at(levels, mean, slide_to_roll_ratio=0.25, turns=20.0)
    found = compared(slip).sel(FORMULA)
    ratio, others = found["scatter_ratio"].values, (members.sum(axis=0) - members) / 31.0
    assert ratio.max() < 0.3
    biases = np.mean(np.sqrt((31.0 * ratio + 1.0) / 32.0) * (others - members), axis=1)
    for side, level in (("lower", 0.025), ("upper", 0.975)):
        assert found[f"bias_expected_{side}"] == pytest.approx(np.quantile(biases, level))


def test_records_of_several_pairs_are_expected_to_agree_as_several_realisations(
    compared, busy, mean, members
):
    pairs = np.arange(12) % 3
    levels = busy.study.operating_grid.model_dump()
    names = np.array(["new", "worn", "old"])[pairs]
    found = compared(experiment_at(levels, mean, pair=names)).sel(FORMULA)
    biases = []
    for number in range(len(members)):
        own = members[(number + pairs) % len(members), np.arange(12)]
        biases.append(np.mean((members.sum(axis=0) - own) / (len(members) - 1) - own))
    for side, level in (("lower", 0.025), ("upper", 0.975)):
        assert found[f"bias_expected_{side}"] == pytest.approx(np.quantile(biases, level))


def test_two_realisations_give_no_range(busy):
    experiment = experiment_of([0.2], **POINT)
    contact = busy.contact.isel(realisation=slice(2))
    study = busy.study.model_copy(update={"realisations": 2})
    found = compare(model_of_records(experiment, busy.film, contact, study), experiment, contact)
    assert found["bias_expected_lower"].isnull().all()
    assert found["predicted_share_lower"].notnull().all()


# Missing records and contradictions


def test_points_without_a_record_are_named(compared, busy, mean, caplog):
    experiment = experiment_at(busy.study.operating_grid.model_dump(), mean).isel(record=[0, 1, 11])
    with caplog.at_level(logging.WARNING):
        found = compared(experiment)
    lines = found.missing.splitlines()
    assert len(lines) == 9
    assert "1600 N, 60 r/min, 60 °C: no record" in lines
    assert "100 N, 60 r/min, 60 °C: no record" not in lines
    assert caplog.messages == lines
    assert (found["compared_records"] == 3).all()


def test_a_record_near_no_level_or_without_a_share_does_not_count_for_a_point(at_grid, mean):
    shares = mean.copy()
    shares[4] = np.nan
    levels = np.where(np.arange(12) == 7, np.nan, np.tile([100.0, 400.0, 1600.0], 4))
    found = at_grid(shares, force_level=levels)
    assert found.missing.splitlines() == [
        "400 N, 60 r/min, 80 °C: no record",
        "400 N, 100 r/min, 60 °C: no record",
    ]
    assert (found["compared_records"] == 11).all()
    assert found["simulated_probability"].notnull().all()
    assert not found["within_prediction"].isel(record=4).any()


def test_an_experiment_without_any_share_has_no_figures(at_grid):
    found = at_grid(np.full(12, np.nan))
    assert (found["compared_records"] == 0).all()
    for name in FIGURES:
        assert found[name].isnull().all() and found[f"{name}_expected_upper"].isnull().all()


def test_records_of_one_point_that_contradict_each_other_are_named(at_point, caplog):
    with caplog.at_level(logging.WARNING):
        found = at_point([0.05, 0.9, 0.06], pair=["1", "2", "3"])
    words = "are of one operating point, but contradict each other: shares"
    lines = found.remarks.splitlines()
    assert lines == [
        f"record 0 and record 1 {words} 0.05 and 0.9",
        f"record 1 and record 2 {words} 0.9 and 0.06",
    ]
    assert set(lines) <= set(caplog.messages)


def test_records_of_surfaces_that_scatter_more_than_lines_do_not_contradict(on_surfaces):
    point = {"force": 400.0, "speed": 60.0, "temperature": 60.0, "pair": ["1", "2"]}
    near, far = (experiment_of([0.4, share], **point) for share in (0.468, 0.55))
    assert "contradict each other: shares 0.4 and 0.468" in on_surfaces(near, ["line"]).remarks
    assert on_surfaces(near).remarks == ""
    assert "contradict each other: shares 0.4 and 0.55" in on_surfaces(far).remarks


def test_records_that_agree_do_not_contradict_each_other_where_the_model_is_off(on_surfaces):
    """Pairs scatter more at greater shares, and a record knows its share to its own interval."""
    point = {"force": 100.0, "speed": 2000.0, "temperature": 60.0, "pair": ["1", "2"]}
    close, apart = (experiment_of([0.10, share], **point) for share in (0.11, 0.9))
    assert on_surfaces(close, ["line"]).remarks == ""
    assert "contradict each other: shares 0.1 and 0.9" in on_surfaces(apart, ["line"]).remarks


def test_records_that_may_differ_do_not_contradict_each_other(at_point, members, compared):
    for apart in (
        {"slide_to_roll_ratio": [0.0, 0.1]},
        {"force": [400.0, 1600.0]},
        {"force": 555.0, "force_level": np.nan},
        {"share_error": 0.5},
    ):
        assert at_point([0.05, 0.9], **apart).remarks == ""
    # Pairs that scatter as the realisations do.
    assert at_point(members[:, 4], pair=[str(number) for number in range(32)]).remarks == ""
    # Contact that no realisation shows at so thick a film.
    found = compared(experiment_of([0.0, 1e-6], force=100.0, speed=2000.0, temperature=60.0))
    assert (found["simulated_probability"] == 0.0).all()
    assert found["within_prediction"].all() and found.remarks == ""


# Figures of agreement


def figures(pairs, width=0.01):
    """Figures of simulated and measured values, with predictions of some half-width."""
    simulated, measured = np.array(pairs, float).reshape(-1, 2).T
    return agreement(simulated, simulated - width, simulated + width, measured)


@given(st.lists(st.tuples(*[st.floats(0.01, 0.99)] * 2), min_size=3, max_size=20, unique=True))
def test_symmetries_of_the_figures(pairs):
    """Swapping the sides changes the sign of the bias; no contact is the mirror of contact."""
    there, back = figures(pairs), figures(np.array(pairs)[:, ::-1])
    mirrored = figures(1.0 - np.array(pairs))
    assert there["bias"] == pytest.approx(-back["bias"])
    assert there["bias"] == pytest.approx(-mirrored["bias"])
    assert abs(there["bias"]) <= there["rms_difference"] + 1e-12
    for name in ("rms_difference", "logit_rms_difference"):
        assert there[name] == pytest.approx(back[name])
        assert there[name] == pytest.approx(mirrored[name])
    assert there["rank_correlation"] == pytest.approx(back["rank_correlation"], nan_ok=True)


def test_the_logit_scale_weighs_odds():
    """Odds of 1 to 9 against 1 to 99 are a factor of 11, and likewise near 1."""
    found = figures([(0.1, 0.01), (0.9, 0.99), (0.0, 0.2), (1.0, 0.3)])
    assert found["logit_rms_difference"] == pytest.approx(np.log(11.0))
    assert (found["logit_records"], found["compared_records"]) == (2, 4)


def test_a_share_on_the_limit_is_within():
    simulated = np.full(4, 0.25)
    measured = np.array([0.125, 0.5, 0.1, 0.6])
    found = agreement(simulated, simulated - 0.125, simulated + 0.25, measured)
    assert found["overlap_share"] == 0.5


def test_the_rank_correlation_is_spearmans_and_needs_different_values():
    for seed in range(3):
        pairs = np.random.default_rng(seed).integers(1, 9, (40, 2)) / 10.0  # with many ties
        expected = scipy.stats.spearmanr(*pairs.T).statistic
        assert figures(pairs)["rank_correlation"] == pytest.approx(expected, rel=1e-12)
    for pairs in ([], [(0.1, 0.2)], [(0.1, 0.2), (0.1, 0.3)]):
        found = figures(pairs)
        assert np.isnan(found["rank_correlation"])
        assert np.isnan(found["bias"]) == (len(pairs) == 0)


# By surfaces


def test_lines_are_compared_as_without_surfaces_and_each_model_can_be_alone(
    on_surfaces, at_grid, busy, mean
):
    experiment = experiment_at(busy.study.operating_grid.model_dump(), mean)
    both, lines = on_surfaces(experiment), at_grid(mean)
    assert check(both, "comparison") is both
    for name in lines.variables:
        found = both[name]
        if "contact_model" in found.dims:
            found = found.sel(contact_model="line", drop=True)
        assert found.identical(lines[name].drop_vars("contact_model", errors="ignore")), name
    for models in (("surface",), ("surface", "line")):
        other = on_surfaces(experiment, models)
        assert other["contact_model"].values.tolist() == list(models)
        same = both.sel(contact_model=list(models))
        assert other.drop_attrs().equals(same.drop_attrs())


def test_surfaces_that_are_right_agree_and_hold_the_records_of_their_pairs(on_surfaces, busy):
    """Shares of pairs scatter as binomial shares of the windows in a revolution."""
    rng, held = np.random.default_rng(3), []
    ratios = busy.film["lambda_ratio"].isel(film_formula=0).squeeze()
    exact = ratios.transpose("temperature", "speed", "force").values.ravel()
    exact = surface_probability(exact)
    for _ in range(20):
        shares = rng.binomial(SURFACE_WINDOWS, exact) / SURFACE_WINDOWS
        experiment = experiment_at(busy.study.operating_grid.model_dump(), shares)
        found = on_surfaces(experiment).sel(contact_model="surface").isel(film_formula=0)
        held.append(found["within_prediction"].values)
        np.testing.assert_allclose(found["simulated_probability"], exact, rtol=1e-12)
    assert 0.93 < np.mean(held) < 0.99
    assert abs(found["bias"].sel(threshold=100.0).item()) < 0.01


def test_an_error_of_the_surfaces_widens_the_prediction(on_surfaces, busy, mean):
    experiment = experiment_at(busy.study.operating_grid.model_dump(), mean)
    widths = []
    for error in (0.0, 0.05):
        found = on_surfaces(experiment, error=error).sel(contact_model="surface")
        width = found["predicted_share_upper"] - found["predicted_share_lower"]
        widths.append(width.isel(film_formula=0))
    assert (widths[1] > 1.1 * widths[0]).any() and (widths[1] >= widths[0]).all()


def test_surfaces_are_compared_by_every_film_formula(on_surfaces, busy, mean):
    experiment = experiment_at(busy.study.operating_grid.model_dump(), mean)
    found = on_surfaces(experiment).sel(contact_model="surface")
    exact = surface_probability(found["lambda_ratio"].values)
    np.testing.assert_allclose(found["simulated_probability"], exact, rtol=1e-12)
    assert (found["compared_records"] == experiment.sizes["record"]).all()


def test_records_of_surfaces_deviate_as_expected_under_the_right_film_alone(
    on_surfaces, busy, mean
):
    grid = busy.study.operating_grid.model_dump()
    found = on_surfaces(experiment_at(grid, mean)).sel(contact_model="surface")
    exact = found["simulated_probability"].isel(film_formula=0).values
    drawn = pair_shares(made_up_surfaces(found["lambda_ratio"]), found["pair"], 5)[:, 0]
    inside = []
    for shares in (*drawn[:20], 0.8 * exact):
        again = on_surfaces(experiment_at(grid, shares)).sel(contact_model="surface")
        again = again.isel(film_formula=0).sel(threshold=100.0)
        inside.append(
            [
                (again[f"{name}_expected_lower"] <= again[name]).item()
                and (again[name] <= again[f"{name}_expected_upper"]).item()
                for name in FIGURES
            ]
        )
    assert np.mean(inside[:-1]) > 0.9
    assert not any(inside[-1])


def test_without_lines_surfaces_are_compared_as_with_them(without_lines, on_surfaces, busy, mean):
    """In pure rolling of equal rollers, whose records repeat themselves in each revolution."""
    experiment = experiment_at(busy.study.operating_grid.model_dump(), mean, turns=3.0)
    found, both = without_lines(experiment), on_surfaces(experiment)
    assert check(found, "comparison") is found
    assert found["contact_model"].values.tolist() == ["surface"]
    assert "realisation" not in found.dims and found.attrs["missing"] == both.attrs["missing"]
    known = both.sel(contact_model=["surface"])
    for name in found.data_vars:
        np.testing.assert_allclose(found[name], known[name], rtol=1e-6, err_msg=name)


def test_without_lines_records_that_contradict_each_other_are_named(without_lines):
    point = {"force": 400.0, "speed": 100.0, "temperature": 60.0}
    found = without_lines(experiment_of([0.05, 0.95], **point))
    assert "record 0 and record 1 are of one operating point" in found.attrs["remarks"]
    assert without_lines(experiment_of([0.05, 0.05], **point)).attrs["remarks"] == ""
