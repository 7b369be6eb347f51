"""Limits of a probability: exact cases, and the effect of sample size, degrees and windows."""

import functools
import operator

import numpy as np
import pytest
import scipy.stats
from hypothesis import given
from hypothesis import strategies as st

from lube.statistics.confidence import (
    breakthrough_limit,
    mean_over_first,
    probability_limits,
    ratio_interval,
    score_interval,
)

NORMAL = scipy.stats.norm.ppf(0.975)
# Whole numbers of a million samples, as real shares of time are.
probabilities = st.integers(0, 10**6).map(lambda samples: samples / 1e6)
counts = st.floats(1.0, 1e6)


@given(st.lists(st.lists(probabilities, min_size=3, max_size=3), min_size=1, max_size=30))
def test_a_mean_adds_its_terms_one_after_the_other(rows):
    for values in (np.array(rows), np.asfortranarray(rows)):
        found = mean_over_first(values).tolist()
        assert found == [
            functools.reduce(operator.add, each) / len(rows) for each in zip(*rows, strict=True)
        ]


@given(probabilities, counts, st.floats(0.5, 20.0))
def test_score_limits_are_where_the_mean_is_so_many_errors_off(mean, sample_size, quantile):
    lower, upper = score_interval(np.array(mean), sample_size, quantile)
    assert 0.0 <= lower <= mean + 1e-12
    assert mean - 1e-12 <= upper <= 1.0
    for limit in (lower, upper):
        error = np.sqrt(limit * (1.0 - limit) / sample_size)
        # The root of a limit of 0, rounded to 1e-16, is 1e-8.
        assert abs(limit - mean) == pytest.approx(quantile * error, rel=1e-6, abs=1e-6)


@given(probabilities, counts, st.integers(1, 100), counts)
def test_limits_enclose_the_mean_and_mirror_each_other(mean, sample_size, degrees, windows):
    lower, upper = probability_limits(np.array(mean), sample_size, degrees, windows)
    assert 0.0 <= lower <= mean + 1e-12
    assert mean - 1e-12 <= upper <= 1.0
    mirrored = probability_limits(np.array(1.0 - mean), sample_size, degrees, windows)
    np.testing.assert_allclose([1.0 - upper, 1.0 - lower], mirrored, atol=1e-9)


def test_many_degrees_and_windows_leave_wilsons_interval():
    mean = np.array([0.2, 0.5])
    found = probability_limits(mean, 100.0, 10**9, 1e9)
    np.testing.assert_allclose(found, score_interval(mean, 100.0, NORMAL), rtol=1e-6)


def test_few_degrees_widen_as_student_says():
    lower, upper = probability_limits(np.array(0.5), 1e6, 3, 1e9)
    half = scipy.stats.t.ppf(0.975, 3) * 0.5 / 1e3
    assert (0.5 - lower, upper - 0.5) == pytest.approx((half, half), rel=1e-3)


def test_without_a_sample_size_the_windows_take_its_place():
    mean = np.array([0.3, 0.3])
    lower, upper = probability_limits(mean, np.array([np.nan, 50.0]), 10**9, 50.0)
    assert lower[0] == pytest.approx(lower[1])
    assert upper[0] == pytest.approx(upper[1])
    means = np.array([[0.0, 0.2], [1.0, 0.4]])
    together = probability_limits(means, np.full((2, 2), np.nan), 1, np.array([10.0, 300.0]))
    for row, column in np.ndindex(2, 2):
        alone = probability_limits(means[row, column], np.nan, 1, [10.0, 300.0][column])
        np.testing.assert_allclose(np.array(together)[:, row, column], alone)


def test_never_seen_and_always_seen_have_the_exact_one_sided_limits():
    for windows in (1.0, 7.5, 1e5):
        lower, upper = probability_limits(np.array([0.0, 1.0]), np.nan, 1, windows)
        assert (1.0 - upper[0]) ** windows == pytest.approx(0.05)
        assert (lower[0], upper[1]) == (0.0, 1.0)
        assert lower[1] == pytest.approx(1.0 - upper[0])


def test_no_limit_is_tighter_than_that_of_contact_never_seen():
    rare = np.array([1e-9, 1.0 - 1e-9])
    never = 1.0 - 0.05 ** (1.0 / 100.0)
    lower, upper = probability_limits(rare, np.array([1e12, 1e12]), 10, 100.0)
    assert upper[0] == pytest.approx(never)
    assert lower[1] == pytest.approx(1.0 - never)


@pytest.mark.parametrize("share", [1e-5, 6.05e-4])
def test_the_limit_of_breakthroughs_never_sampled_holds_in_95_of_100_cases(share):
    sampled, contact = 5_000, 0.3
    seen = np.random.default_rng(1).binomial(sampled, share, 20_000)
    limit = breakthrough_limit(contact * seen / sampled, contact, sampled)
    is_below = (seen == 0) & (limit < contact * share)
    assert is_below.mean() < 0.055
    assert is_below.any() == (share > 6e-4)  # the limit is hardly above what it needs to be
    none = breakthrough_limit(0.0, contact, sampled)
    assert np.all(limit == np.maximum(contact * seen / sampled, none))


def test_a_breakthrough_of_little_weight_says_no_more_than_none():
    none, light = breakthrough_limit(np.array([0.0, 1e-6]), 0.5, 100)
    assert none == light > 0.01


def test_the_ratio_to_nothing_is_not_known():
    with np.errstate(divide="raise", invalid="raise"):
        found = ratio_interval(np.ones((3, 1)), np.zeros((3, 1)))
    assert np.isnan(found).all()


def test_interval_of_a_ratio_follows_from_the_error_of_its_logarithm():
    values, reference = np.array([[0.5], [0.1], [0.0]]), np.array([[0.0], [0.1], [0.5]])
    error = scipy.stats.sem(values / 0.2 - reference / 0.2)[0]
    half = scipy.stats.t.ppf(0.975, 2) * error
    assert half > 1.0
    _, lower, upper = ratio_interval(values, reference)
    assert np.log([lower, upper]).ravel() == pytest.approx([-half, half])


def test_interval_of_a_ratio_knows_that_both_see_the_same_lines():
    random = np.random.default_rng(1)
    lines = random.lognormal(size=(400, 40, 1))
    reference = 0.3 * lines
    values = 0.6 * lines * (1.0 + 0.1 * random.standard_normal((400, 40, 1)))
    limits = np.array([ratio_interval(*pair) for pair in zip(values, reference, strict=True)])
    ratio, lower, upper = limits[..., 0].T
    assert 0.92 < np.mean((lower < 2.0) & (upper > 2.0)) < 0.98
    # Without that the interval would be some ten times as wide.
    assert np.mean(upper / lower) < 1.15
    assert np.all((lower < ratio) & (ratio < upper))
    with_one = ratio_interval(np.zeros((3, 1)), np.ones((3, 1)))
    assert with_one[0] == 0.0 and np.isnan(with_one[1:]).all()
