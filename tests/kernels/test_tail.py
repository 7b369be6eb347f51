"""Windows and runs with a known touching point: a naive implementation, and its exact mean."""

import numpy as np
import pytest

from lube.kernels.tail import touching_runs, touching_windows

FACTOR = 15.0


def smooth_line(points, rng):
    """A line with wide and narrow waves, so that runs have many lengths."""
    noise = rng.standard_normal(points)
    return (3.0 * np.convolve(noise, np.ones(5) / 5.0, "same")).astype(np.float32)


def correlation_of(lags, width):
    return np.exp(-0.5 * (np.arange(1 - lags, lags) / width) ** 2).astype(np.float32)


def runs_above(overlap):
    """First index and length of each run of positive overlaps."""
    runs, start = [], None
    for i, value in enumerate([*overlap, -1.0]):
        if value > 0.0 and start is None:
            start = i
        elif value <= 0.0 and start is not None:
            runs.append(range(start, i))
            start = None
    return runs


def breaks(overlap, run):
    return float(len(run)) ** 3 < FACTOR * sum(float(overlap[i]) for i in run)


@pytest.fixture(params=["flat", "valley"])
def film(request):
    shape = np.linspace(-1.0, 1.0, 41) ** 2 if request.param == "valley" else 0.0
    return (np.full(41, 3.0) + shape).astype(np.float32)


def test_windows_are_weighed_as_by_a_naive_implementation(film):
    rng = np.random.default_rng(3)
    line, width = smooth_line(3000, rng), film.size
    correlation = correlation_of(width, 6.0)
    starts = np.arange(60) * 47
    origins = rng.integers(0, width, 60)
    heights = (film[origins] + rng.exponential(0.8, 60)).astype(np.float32)
    expected = np.zeros(2)
    for start, origin, height in zip(starts, origins, heights, strict=True):
        window = line[start : start + width]
        rise = height - window[origin]
        lags = width - 1 + np.arange(width) - origin
        overlap = window + correlation[lags] * rise - film
        runs = runs_above(overlap)
        weight = 1.0 / sum(map(len, runs))
        expected += weight, weight * any(breaks(overlap, run) for run in runs)
    found = touching_windows(line, starts, correlation, (origins, heights), film, FACTOR)
    np.testing.assert_allclose(found, expected / 60, rtol=1e-6)
    assert 0.0 < found[1] < found[0]


def test_runs_are_weighed_as_by_a_naive_implementation():
    rng = np.random.default_rng(3)
    lines = smooth_line(6000, rng), smooth_line(6000, rng)
    reach, film = 60, np.float32(3.5)
    width = 9
    covariances = tuple(correlation_of(reach + 1, width) / 2.0 for width in (4.0, 7.0))
    places = reach + 10 + np.arange(120) * 40
    heights = (film + rng.exponential(0.8, 120)).astype(np.float32)
    expected = np.zeros(10)
    for place, height in zip(places, heights, strict=True):
        around = slice(place - reach, place + reach + 1)
        rise = height - lines[0][place] - lines[1][place]
        first, second = (
            line[around] + share * rise for line, share in zip(lines, covariances, strict=True)
        )
        overlap = first + second - film
        runs = runs_above(overlap)
        (mine,) = (run for run in runs if reach in run)
        weight = 1.0 / len(mine)
        expected[0] += weight
        if not breaks(overlap, mine):
            continue
        expected[[1, 4]] += weight, 1.0
        behind = [run for run in runs if run.start > mine.start and breaks(overlap, run)]
        if behind:
            gap = max(behind[0].start - mine.stop - (width - 1), 0)
            between = behind[0].start - mine.stop
            expected[7:] += weight * np.array([between, gap, sum(range(1, gap + 1))])
        else:
            expected[[2, 6]] += weight * np.array([1.0, overlap.size - mine.stop])
        before = first[:-1] + second[1:] - film
        # Its point i was above the first line's point i, and the second line's i + 1.
        old = range(mine.start - 1, mine.stop)
        forerunners = (run for run in runs_above(before) if set(run) & set(old))
        new = not any(breaks(before, run) for run in forerunners)
        expected[[3, 5]] += weight * new, new
    found = touching_runs(lines, places, covariances, heights, film, width, FACTOR)
    np.testing.assert_allclose(found, expected, rtol=1e-6)
    assert np.all(np.diff(found[[3, 1, 0]]) > 0.0) and 0.0 < found[2] < found[1]
    assert np.all(found[6:] > 0.0)


def test_a_point_that_rounding_puts_on_the_film_counts_as_a_run_of_one():
    lines = np.zeros(9, np.float32), np.zeros(9, np.float32)
    covariances = (correlation_of(3, 0.1) / 2.0,) * 2
    film = np.float32(2.0)
    found = touching_runs(lines, np.array([4]), covariances, np.array([film]), film, 3, FACTOR)
    assert found.tolist() == [1.0, *[0.0] * 9]
