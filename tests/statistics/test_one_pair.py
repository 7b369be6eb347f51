"""One pair's scatter: exact limits, then plain simulations of blocks, series and shares."""

import numpy as np
import pytest
import scipy.stats
import xarray as xr
from hypothesis import given
from hypothesis import strategies as st

from lube.statistics.one_pair import (
    MOST_TURNS,
    distinct_alignments,
    drift_factor,
    independent_windows,
    persistent_share,
    prediction_limits,
    quantile,
    repeat_factor,
    sample_size,
    scatter_ratio,
    standard_error,
)

ROLLING = (1.0, 1.0)
POINTS = (1_000_000, 1_000_000)
REACH = 4000.0

# Turns of one line


@pytest.mark.parametrize("turns", [1, 2, 7, 1000])
def test_whole_turns_see_the_line_evenly_and_tell_no_more_than_one(turns):
    assert repeat_factor(float(turns)) == 1.0


@given(st.floats(1e-4, 0.9999))
def test_below_one_turn_the_variance_grows_as_the_record_shortens(turns):
    assert repeat_factor(turns) == pytest.approx(1.0 / turns)


def test_a_very_long_record_tells_as_much_as_one_turn():
    assert repeat_factor(1e6 + 0.37) == pytest.approx(1.0, abs=1e-6)


@pytest.mark.parametrize("turns", [0.3, 1.25, 1.5, 2.75, 6.4])
def test_the_factor_is_the_variance_of_a_line_of_independent_blocks(turns):
    blocks = 20
    lines = np.random.default_rng(1).normal(size=(20_000, blocks))
    seen = np.tile(lines, 7)[:, : round(turns * blocks)].mean(axis=1)
    assert repeat_factor(turns) == pytest.approx(seen.var() / lines.mean(axis=1).var(), rel=0.04)


# Alignments


@pytest.mark.parametrize(
    ("turns", "shift", "perimeter", "count"),
    [
        (1e4, 1_000_000, 1_000_000, 1),  # equal rollers in rolling
        (100, 1_000_000, 800_000, 4),  # they meet again after four turns of the first
        (100, 900_000, 1_000_000, 10),  # a slip of a tenth of the perimeter
        (3.5, 900_000, 1_000_000, 4),  # fewer turns than alignments
        (1, 900_000, 1_000_000, 1),
        (3, 1_000_000 - 900, 1_000_000, 1),  # still within the reach of the start
        (101, 900_010, 1_000_000, 10),  # a return nearly to the start is the start
    ],
)
def test_alignments_that_share_no_roughness_are_counted(turns, shift, perimeter, count):
    assert distinct_alignments(turns, shift, perimeter, REACH) == count


def test_a_line_has_no_more_alignments_than_reaches():
    shift = 618_034  # of a million: never the same place twice
    assert distinct_alignments(1e5, shift, 1_000_000, REACH) == 250


# Drift


@pytest.mark.parametrize("turns", [1, 2, 17, 400])
def test_without_drift_turns_repeat_and_with_all_new_roughness_they_are_independent(turns):
    assert drift_factor(turns, 0.0) == pytest.approx(1.0)
    assert drift_factor(turns, 1.0) == pytest.approx(1.0 / turns)


def test_even_the_longest_record_of_rollers_that_stay_as_they_are_is_one_turn():
    assert drift_factor(20.0 * MOST_TURNS, 0.0) == pytest.approx(1.0)


@pytest.mark.parametrize("turns", [2, 5, 60])
@pytest.mark.parametrize("drift", [0.01, 0.3])
def test_drift_makes_the_turns_a_first_order_series(turns, drift):
    apart = np.abs(np.subtract.outer(np.arange(turns), np.arange(turns)))
    assert drift_factor(turns, drift) == pytest.approx(np.mean(np.sqrt(1.0 - drift) ** apart))


# One record over one revolution in rolling


@pytest.mark.parametrize("persistent", [0.0, 0.3, 1.0])
@pytest.mark.parametrize("turns", [0.2, 1.0, 1.5, 3.75, 12.0, 1e6])
def test_equal_rollers_in_rolling_repeat_themselves_whatever_persists(turns, persistent):
    found = scatter_ratio(turns, ROLLING, POINTS, REACH, persistent)
    assert found == pytest.approx(repeat_factor(turns))


CASES = [
    (ROLLING, POINTS),
    (ROLLING, (1_000_000, 800_000)),
    ((1.0, 0.9), POINTS),
    ((0.5, 1.0), POINTS),
    ((1.0, 0.0), POINTS),
]


@pytest.mark.parametrize(("ratios", "points"), CASES)
@pytest.mark.parametrize("drift", [0.0, 0.2])
@pytest.mark.parametrize("persistent", [0.0, 0.2, 1.0])
def test_one_revolution_is_the_measure(ratios, points, drift, persistent):
    assert scatter_ratio(1.0, ratios, points, REACH, persistent, drift) == pytest.approx(1.0)


@pytest.mark.parametrize(("ratios", "points"), CASES[1:3])
@pytest.mark.parametrize(("turns", "alignments"), [(20, (4, 10)), (200, (4, 10))])
def test_new_alignments_average_out_all_but_what_persists(ratios, points, turns, alignments):
    """s^2 (M) = s_inf^2 + (s_1^2 - s_inf^2) / M; either line alone is not quite at whole turns."""
    count = alignments[0 if points[1] < points[0] else 1]
    found = scatter_ratio(turns, ratios, points, REACH, persistent=0.2)
    assert found == pytest.approx(0.2 + 0.8 / count, rel=0.03)


def test_rollers_whose_roughness_drifts_scatter_less_and_the_more_the_longer():
    drifting = [scatter_ratio(t, ROLLING, POINTS, REACH, 0.0, 0.1) for t in (1.0, 4.0, 40.0, 400.0)]
    assert drifting[0] == 1.0
    assert (np.diff(drifting) < 0.0).all()
    assert drifting[-1] == pytest.approx(drift_factor(400.0, 0.1))


# Limits of one pair's share


def predicted(trials, realisations, ratio=1.0, noise=0.0, seed=2, mean=0.4, scatter=0.02):
    """How many shares of pairs that the ensemble has not seen lie within its limits."""
    rng = np.random.default_rng(seed)
    shares = rng.normal(mean, scatter, (realisations, trials))
    record = rng.normal(mean, np.hypot(np.sqrt(ratio) * scatter, noise), trials)
    looks = sample_size(shares, 1.0)
    ratios = np.full(trials, ratio)
    lower, upper = prediction_limits(shares.mean(axis=0), looks, ratios, realisations, noise)
    return np.mean((lower <= record) & (record <= upper))


@pytest.mark.parametrize("realisations", [3, 8, 64])
@pytest.mark.parametrize("ratio", [0.2, 1.0, 3.0])
def test_limits_hold_the_shares_of_new_pairs_95_times_of_100(realisations, ratio):
    assert predicted(40_000, realisations, ratio) == pytest.approx(0.95, abs=0.004)


def test_known_noise_of_the_record_widens_the_limits():
    assert predicted(40_000, 64, noise=0.03) == pytest.approx(0.95, abs=0.01)
    assert standard_error(0.5, 25.0, 1.0, 10**9, 0.0) == pytest.approx(0.1)
    assert standard_error(0.5, 25.0, 1.0, 10**9, 0.075) == pytest.approx(0.125)


@given(st.floats(0.0, 1.0), st.floats(1e-2, 1e6), st.floats(1e-3, 1e3), st.integers(1, 100))
def test_limits_are_probabilities_and_enclose_the_mean(mean, looks, ratio, realisations):
    lower, upper = prediction_limits(np.array(mean), np.array(looks), ratio, realisations)
    assert 0.0 <= lower <= mean <= upper <= 1.0


@pytest.mark.parametrize("looks", [1.0, 7.5, 1e5])
def test_what_no_realisation_saw_may_be_as_likely_as_they_allow(looks):
    never, always = np.array([0.0]), np.array([1.0])
    _, upper = prediction_limits(never, looks, 1.0, 64)
    likely = 1.0 - 0.05 ** (1.0 / (64 * looks))
    assert upper == prediction_limits(np.array([likely]), looks, 1.0, 64)[1]
    lower, _ = prediction_limits(always, looks, 1.0, 64)
    assert lower[0] == pytest.approx(1.0 - upper[0])
    assert prediction_limits(never, looks, 1.0, 64)[0] == 0.0
    assert prediction_limits(always, looks, 1.0, 64)[1] == 1.0
    assert prediction_limits(never, looks, 1.0, 1000)[1] < upper


def test_few_realisations_have_students_quantile_and_one_the_normal():
    assert quantile(8) == pytest.approx(scipy.stats.t.ppf(0.975, 7))
    assert quantile(1) == pytest.approx(1.959964, rel=1e-6)


@pytest.mark.parametrize("among", [10, 1000])
def test_of_many_values_none_exceeds_its_quantile_95_times_of_100(among):
    """Independent ones: the bound is nearly met."""
    chance = 2.0 * scipy.stats.t.sf(quantile(8, among), 7)
    assert (1.0 - chance) ** among == pytest.approx(0.95, abs=0.002)


# What the ensemble tells


@pytest.mark.parametrize("share", [0.0, 0.2, 0.7])
def test_the_persistent_share_is_that_of_the_variance_between_pairs(share):
    rng = np.random.default_rng(3)
    pairs, alignments = 3000, 8
    of_pair = np.sqrt(share) * rng.normal(size=(pairs, 1, 2))
    of_alignment = np.sqrt(1.0 - share) * rng.normal(size=(pairs, alignments, 2))
    assert persistent_share(of_pair + of_alignment) == pytest.approx(share, abs=0.02)


def test_where_nothing_scatters_nothing_is_known_to_persist():
    shares = np.zeros((5, 4, 2))
    shares[:, :, 1] = np.arange(5.0)[:, None]  # pairs differ, alignments do not
    found = persistent_share(shares)
    assert np.isnan(found[0]) and found[1] == 1.0


def test_the_sample_size_is_the_binomial_one_or_that_of_the_windows():
    shares = np.random.default_rng(4).binomial(50, 0.3, (4000, 1)) / 50
    assert sample_size(shares, 9.0).item() == pytest.approx(50.0, rel=0.05)
    assert sample_size(np.full((7, 2), 0.1), np.array([3.0, 4.0])).tolist() == [3.0, 4.0]
    assert sample_size(np.array([[0.2, 0.9]]), 5.0).tolist() == [5.0, 5.0]


def test_windows_are_a_longest_wavelength_apart():
    dataset = xr.Dataset(attrs={"travel": 0.3, "longest_wavelength": 4e-4})
    np.testing.assert_allclose(independent_windows(dataset, np.array([2e-4, 1.0])), [500.0, 1.0])
