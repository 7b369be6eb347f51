"""Runs of points above a film, and the blocks that are skipped in the search for them."""

import numpy as np
from hypothesis import example, given
from hypothesis import strategies as st

from lube.kernels.runs import (
    BLOCK,
    add_lines,
    fill_high_stretches,
    find_runs,
    highest_ahead,
)

rough_lines = st.lists(st.integers(-3, 3), min_size=1, max_size=40).map(
    lambda heights: np.array(heights, np.int32)
)


@given(rough_lines, st.integers(0, 5 * BLOCK))
def test_highest_ahead_is_the_maximum_of_a_block(line, reach):
    indices = np.arange(line.size + reach)[:, None] + np.arange(BLOCK)
    expected = line[indices % line.size].max(axis=-1)
    np.testing.assert_array_equal(highest_ahead(line, reach), expected)


def sparse_line(random, size):
    """Zeros, with a peak here and there."""
    line = np.zeros(size, np.int32)
    for _ in range(size // 20):
        line[random.randrange(size)] = random.randrange(12)
    return line


@given(
    st.integers(1, 5 * BLOCK),
    st.integers(1, 5 * BLOCK),
    st.integers(1, 9 * BLOCK),
    st.integers(0, 20),
    st.booleans(),
    st.randoms(use_true_random=False),
)
def test_points_that_are_skipped_lie_below_the_film(points_1, points_2, size, film, slips, random):
    line_1, line_2 = sparse_line(random, points_1), sparse_line(random, points_2)
    first_1, first_2 = random.randrange(points_1), random.randrange(points_2)
    indices = np.arange(size)
    whole = line_1[(first_1 + indices) % points_1] + line_2[(first_2 + indices) % points_2]
    nothing = np.empty(0, np.int32)
    ahead = [highest_ahead(line, size) if slips else nothing for line in (line_1, line_2)]
    line = np.full(size, 99, np.int32)
    starts, stops = np.empty((2, size // 2 + 1), np.int64)
    pair, stretches = (line_1, line_2), (starts, stops)
    count = fill_high_stretches(pair, tuple(ahead), first_1, first_2, film, line, stretches)
    searched = np.zeros(size, bool)
    for start, stop in zip(starts[:count], stops[:count], strict=True):
        assert 0 <= start < stop <= size
        assert not searched[max(start - 1, 0) : stop].any()  # neighbours are one stretch
        searched[start:stop] = True
        np.testing.assert_array_equal(line[start:stop], whole[start:stop])
    assert not (whole > film)[~searched].any()
    if slips and film >= line_1.max() + line_2.max():
        assert count == 0


@given(rough_lines, rough_lines, st.integers(1, 150), st.integers(-100, 100), st.integers(-9, 9))
@example(np.array([1], np.int32), np.array([2, 3], np.int32), 1, 0, 0)
def test_lines_are_added_as_the_windows_meet_them(line_1, line_2, size, first, ahead):
    indices = np.arange(first, first + size)
    expected = line_1[indices % line_1.size] + line_2[(indices + ahead) % line_2.size]
    line = np.empty(size, np.int32)
    add_lines((line_1, line_2), first, first + ahead, line)
    np.testing.assert_array_equal(line, expected)


def runs_above(line, film, starts, stops):
    size = line.size // 2 + 1
    runs = np.empty(size, np.int64), np.empty(size, np.int64)
    count = find_runs(line, film, (starts, stops), starts.size, runs)
    return runs[0][:count], runs[1][:count]


@given(rough_lines, st.integers(-4, 4), st.integers(0, 4))
def test_runs_of_a_thicker_film_are_found_within_a_thinner_films(line, film, thicker):
    whole = np.array([0]), np.array([line.size])
    within = runs_above(line, film + thicker, *runs_above(line, film, *whole))
    inside = np.concatenate([[False], line > film + thicker, [False]])
    edges = np.flatnonzero(inside[1:] != inside[:-1])
    np.testing.assert_array_equal(within, edges.reshape(-1, 2).T)
