"""One pair's scatter: exact limits, then simulations of blocks, series and shares."""

import numpy as np
import pytest
import scipy.stats
from hypothesis import given
from hypothesis import strategies as st

from lube.statistics.one_pair import (
    distinct_alignments,
    drift_factor,
    persistent_share,
    prediction_limits,
    quantile,
    repeat_factor,
    scatter_ratio,
    standard_error,
)
from lube.statistics.sample_size import effective_sample_size

ROLLING = (1.0, 1.0)
POINTS = (1_000_000, 1_000_000)
REACH = 4000.0

# Turns of one line


@given(st.floats(1e-4, 0.9999))
def test_a_record_below_one_turn_varies_as_its_length_and_whole_turns_alike(turns):
    assert repeat_factor(turns) == pytest.approx(1.0 / turns)
    for whole in (1, 2, 7, 1000):
        assert repeat_factor(float(whole)) == 1.0
    assert repeat_factor(1e6 + 0.37) == pytest.approx(1.0, abs=1e-6)


def test_the_factor_is_the_variance_of_a_line_of_independent_blocks():
    blocks = 20
    lines = np.random.default_rng(1).normal(size=(20_000, blocks))
    for turns in (0.3, 1.25, 1.5, 2.75, 6.4):
        seen = np.tile(lines, 7)[:, : round(turns * blocks)].mean(axis=1)
        expected = seen.var() / lines.mean(axis=1).var()
        assert repeat_factor(turns) == pytest.approx(expected, rel=0.04)


# Alignments


def test_alignments_that_share_no_roughness_are_counted():
    for turns, slower, points, count in (
        (1e4, 1.0, POINTS, 1),  # equal rollers in rolling
        (100, 1.0, (1_000_000, 800_000), 4),  # they meet again after four turns of the first
        (100, 0.9, POINTS, 10),  # a slip of a tenth of the perimeter
        (3.5, 0.9, POINTS, 3.5),  # fewer turns than alignments
        (1, 0.9, POINTS, 1),
        (3, 0.9991, POINTS, 1),  # still within the reach of the start
        (101, 0.90001, POINTS, 10),  # a return nearly to the start is the start
        (1e5, 0.618034, POINTS, 250),  # never the same again: as many as reaches in the line
    ):
        assert distinct_alignments(turns, (1.0, slower), points, REACH) == count
    assert distinct_alignments(100, (0.9, 1.0), POINTS, REACH) == 10


# Drift


def test_without_drift_turns_repeat_and_with_all_new_roughness_they_are_independent():
    for turns in (1, 2, 17, 400):
        assert drift_factor(turns, 0.0) == pytest.approx(1.0)
        assert drift_factor(turns, 1.0) == pytest.approx(1.0 / turns)


def test_drift_makes_the_turns_a_first_order_series():
    for turns in (2, 5, 60):
        apart = np.abs(np.subtract.outer(np.arange(turns), np.arange(turns)))
        for drift in (0.01, 0.3):
            expected = np.mean(np.sqrt(1.0 - drift) ** apart)
            assert drift_factor(turns, drift) == pytest.approx(expected)


# One record over one revolution in rolling


def test_equal_rollers_in_rolling_repeat_whatever_persists():
    for persistent in ((0.0, 0.0), (0.1, 0.3), (1.0, 1.0)):
        for turns in (0.2, 1.0, 1.5, 3.75, 12.0, 1e6):
            found = scatter_ratio(turns, ROLLING, POINTS, REACH, persistent, 0.0)
            assert found == pytest.approx(repeat_factor(turns))


CASES = [
    (ROLLING, POINTS),
    (ROLLING, (1_000_000, 800_000)),
    ((1.0, 0.9), POINTS),
    ((0.5, 1.0), POINTS),
    ((1.0, 0.0), POINTS),
]


def test_the_ratio_of_one_revolution_is_one():
    for case in CASES:
        for persistent in ((0.0, 0.0), (0.1, 0.3), (1.0, 1.0)):
            for drift in (0.0, 0.2):
                assert scatter_ratio(1.0, *case, REACH, persistent, drift) == pytest.approx(1.0)


def test_new_alignments_average_out_all_but_what_persists():
    """s^2 (M) = s_inf^2 + (s_1^2 - s_inf^2) / M; either line alone is not quite at whole turns."""
    for case, alignments in zip(CASES[1:3], (4, 10), strict=True):
        for turns in (20, 200):
            found = scatter_ratio(turns, *case, REACH, (0.1, 0.1), 0.0)
            assert found == pytest.approx(0.2 + 0.8 / alignments, rel=0.03)


def test_the_part_of_a_line_that_a_turn_shows_scatters_more_and_only_by_its_own_effect():
    """In a turn of the faster line, a seventh of the slower one passes."""
    ratios = 1.0, 1.0 / 7.0
    for persistent, of_joint in (((0.1, 0.0), 0.9), ((0.0, 0.1), 0.3)):
        found = scatter_ratio(70, ratios, POINTS, REACH, persistent, 0.0)
        assert found == pytest.approx(0.1 + of_joint / 7, rel=0.01)


def test_rollers_whose_roughness_drifts_scatter_less_and_the_more_the_longer():
    case = ROLLING, POINTS, REACH, (0.0, 0.0), 0.1
    drifting = [scatter_ratio(turns, *case) for turns in (1.0, 4.0, 40.0, 400.0)]
    assert drifting[0] == 1.0
    assert (np.diff(drifting) < 0.0).all()
    assert drifting[-1] == pytest.approx(drift_factor(400.0, 0.1))


# Limits of one pair's share


def predicted(trials, realisations, ratio=1.0, noise=0.0, seed=2, mean=0.4, scatter=0.02):
    """Fraction of the shares of new pairs that lie within the limits of an ensemble."""
    rng = np.random.default_rng(seed)
    shares = rng.normal(mean, scatter, (realisations, trials))
    record = rng.normal(mean, np.hypot(np.sqrt(ratio) * scatter, noise), trials)
    sample_size = effective_sample_size(shares, 1.0)
    ratios = np.full(trials, ratio)
    lower, upper = prediction_limits(shares.mean(axis=0), sample_size, ratios, realisations, noise)
    return np.mean((lower <= record) & (record <= upper))


def test_limits_contain_the_shares_of_new_pairs_in_95_of_100_cases():
    for realisations in (3, 8, 64):
        for ratio in (0.2, 1.0, 3.0):
            assert predicted(40_000, realisations, ratio) == pytest.approx(0.95, abs=0.004)


def test_known_noise_of_the_record_widens_the_limits():
    assert predicted(40_000, 64, noise=0.03) == pytest.approx(0.95, abs=0.01)
    assert standard_error(0.5, 25.0, 1.0, 10**9, 0.0) == pytest.approx(0.1)
    assert standard_error(0.5, 25.0, 1.0, 10**9, 0.075) == pytest.approx(0.125)
    # The mean of four realisations, a quarter as uncertain as that of independent ones.
    assert standard_error(0.5, 25.0, 0.5, 4, 0.0, 0.25) == pytest.approx(
        0.1 * np.sqrt(0.5 + 1 / 16)
    )


@given(st.floats(0.0, 1.0), st.floats(1e-2, 1e6), st.floats(1e-3, 1e3), st.integers(1, 100))
def test_limits_are_probabilities_and_enclose_the_mean(mean, sample_size, ratio, realisations):
    lower, upper = prediction_limits(np.array(mean), np.array(sample_size), ratio, realisations)
    assert 0.0 <= lower <= mean <= upper <= 1.0


def test_contact_never_or_always_seen_has_the_limit_that_the_realisations_allow():
    never, always = np.array([0.0]), np.array([1.0])
    for sample_size in (1.0, 7.5, 1e5):
        lower, upper = prediction_limits(never, sample_size, 1.0, 64)
        likely = 1.0 - 0.05 ** (1.0 / (64 * sample_size))
        assert upper == prediction_limits(np.array([likely]), sample_size, 1.0, 64)[1]
        assert prediction_limits(never, sample_size, 1.0, 1000)[1] < upper
        mirrored = prediction_limits(always, sample_size, 1.0, 64)
        assert lower == 0.0 and mirrored[1] == 1.0
        assert mirrored[0] == pytest.approx(1.0 - upper)


def test_few_realisations_have_students_quantile_and_one_the_normal():
    assert quantile(8) == pytest.approx(scipy.stats.t.ppf(0.975, 7))
    assert quantile(1) == pytest.approx(1.959964, rel=1e-6)
    for among in (10, 1000):  # independent values, for which the bound is nearly met
        chance = 2.0 * scipy.stats.t.sf(quantile(8, among), 7)
        assert (1.0 - chance) ** among == pytest.approx(0.95, abs=0.002)


def test_the_persistent_share_is_that_of_the_variance_between_pairs():
    rng = np.random.default_rng(3)
    pairs, alignments = 3000, 8
    of_pair, of_alignment = rng.normal(size=(pairs, 1, 2)), rng.normal(size=(pairs, alignments, 2))
    for share in (0.0, 0.2, 0.7):
        shares = np.sqrt(share) * of_pair + np.sqrt(1.0 - share) * of_alignment
        assert persistent_share(shares, shares).sum(axis=0) == pytest.approx(share, abs=0.02)
    shares = np.zeros((5, 4, 2))
    shares[:, :, 1] = np.arange(5.0)[:, None]  # nothing scatters, or first lines alone
    found = persistent_share(shares, shares)
    np.testing.assert_array_equal(found, [[np.nan, 1.0], [np.nan, 0.0]])
