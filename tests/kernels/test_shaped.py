"""Films with a shape: equal to the literal scan, at every time step and at some of them."""

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from literal import scan_trace

from lube.kernels.shaped import BLOCK, highest_ahead, shaped_statistics, shaped_trace

seeds = st.integers(0, 2**32 - 1)
ratios = st.sampled_from([(1.0, 1.0), (1.0, 0.0), (0.0, 1.0), (1.0, 0.37), (0.9, 1.0)])
sizes = st.integers(1, 4 * BLOCK)


def contact(seed, size_1, size_2, width):
    """Lines that are high here and there, and a film with a constriction."""
    random = np.random.default_rng(seed)
    lines = [
        (random.integers(-9, 9, size) * (random.random(size) < 0.3)).astype(np.int32)
        for size in (size_1, size_2)
    ]
    return tuple(lines), random.integers(2, 16, width)


@given(sizes, seeds)
def test_highest_ahead_is_the_maximum_of_a_block(size, seed):
    line = np.random.default_rng(seed).integers(-99, 99, size).astype(np.int32)
    expected = [np.roll(np.tile(line, BLOCK), -i)[:BLOCK].max() for i in range(size)]
    assert highest_ahead(line).tolist() == expected


@given(seeds, sizes, sizes, sizes, ratios, st.integers(0, 50), st.floats(0.0, 9.0))
def test_trace_equals_the_literal_scan(seed, size_1, size_2, width, ratios, before, factor):
    lines, film = contact(seed, size_1, size_2, width)
    trace = shaped_trace(lines, ratios, 29, 29, film, before, factor)
    np.testing.assert_array_equal(trace, scan_trace(lines, ratios, 29, film, before, factor))


@given(seeds, sizes, sizes, sizes, ratios, st.integers(0, 50), st.floats(0.0, 9.0))
def test_statistics_are_means_over_evenly_spread_windows(
    seed, size_1, size_2, width, ratios, before, factor
):
    lines, film = contact(seed, size_1, size_2, width)
    other = film[::2] + 1
    films = np.concatenate([film, other]), np.cumsum([0, film.size, other.size])
    windows, centres = np.array([7, 29]), np.array([before, 1])
    found = shaped_statistics(lines, ratios, 29, windows, (*films, centres), factor)
    for row, each, count, centre in zip(found, (film, other), windows, centres, strict=True):
        steps = np.arange(count) * 29 // count
        trace = scan_trace(lines, ratios, 29, each, centre, factor)[steps]
        points, broken, overlap = trace.T
        expected = (points > 0).mean(), (broken > 0).mean(), broken.mean(), overlap.mean()
        np.testing.assert_allclose(row, expected, rtol=1e-14)
