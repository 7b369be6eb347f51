"""Samples below limits, against a plain implementation: a trigger, then a filter of short runs."""

from itertools import groupby

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from lube.kernels.threshold import count_below, follow_contact

# Few levels, so that values often equal a limit or a release.
records = st.lists(st.integers(0, 6), max_size=60).map(lambda levels: np.array(levels, float))


def trigger(values, limit, release):
    """Closed from a value below the limit to one that is not below the release."""
    closed, states = False, []
    for value in values:
        if closed and value >= release:
            closed = False
        elif not closed and value < limit:
            closed = True
        states.append(closed)
    return states


def without_short_runs(states, hold):
    """Runs shorter than `hold` take the state before them; before the record there is none."""
    accepted, before = [], False
    for state, run in groupby(states):
        length = len(list(run))
        before = state if length >= hold else before
        accepted += [before] * length
    return np.array(accepted, bool)


def plain_contact(values, limit, release, hold):
    return without_short_runs(trigger(values, limit, release), hold)


def in_blocks(contact, doublings, blocks):
    size = 1 << doublings
    return [contact[size * block : size * (block + 1)].sum() for block in range(blocks)]


@given(records, st.integers(0, 6), st.integers(0, 3), st.integers(0, 5))
def test_contact_is_a_trigger_whose_short_runs_are_filtered(values, limit, gap, hold):
    counts, states = np.zeros((1, 8), np.int64), np.zeros((1, 3), np.int64)
    limits, releases = np.array([float(limit)]), np.array([float(limit + gap)])
    follow_contact(values, 0, 3, limits, releases, hold, states, counts)
    expected = plain_contact(values, limit, limit + gap, hold)
    assert counts[0].tolist() == in_blocks(expected, 3, 8)


@given(records)
def test_without_hysteresis_and_hold_both_kernels_count_the_same(values):
    limits = np.array([1.0, 2.0, 5.5])
    plain, followed = np.zeros((2, 3, 8), np.int64)
    count_below(values, 0, 3, limits, plain)
    follow_contact(values, 0, 3, limits, limits, 0, np.zeros((3, 3), np.int64), followed)
    np.testing.assert_array_equal(plain, followed)
    assert plain.sum(axis=1).tolist() == [np.count_nonzero(values < limit) for limit in limits]


@pytest.mark.parametrize("dtype", [np.float64, np.float32])
@pytest.mark.parametrize("size", [1, 2041, 4096, 12_293])
def test_counts_are_exact_about_the_edges_of_blocks(size, dtype):
    values = np.random.default_rng(size).random(size).astype(dtype)
    limits, counts = np.array([0.0, 0.3, 2.0]), np.zeros((3, 8), np.int64)
    seen, doublings = 7, 11
    count_below(values, seen, doublings, limits, counts)
    whole = np.concatenate([np.full(seen, 9.0), values])
    for limit, row in zip(limits, counts, strict=True):
        assert row.tolist() == in_blocks(whole < limit, doublings, 8)


def test_a_value_at_the_limit_is_not_below_it():
    counts = np.zeros((1, 1), np.int64)
    count_below(np.array([1.0, np.nextafter(1.0, 0.0), np.inf]), 0, 2, np.array([1.0]), counts)
    assert counts == 1
