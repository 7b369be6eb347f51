"""Windows judged by whole runs: limits, then a plain count."""

import numpy as np
import pytest

from lube.kernels.layer import layer_breaks
from lube.kernels.strips import strip_statistics
from lube.kernels.whole_runs import whole_run_steps


def rough(seed, size=400, waves=12):
    rng = np.random.default_rng(seed)
    number = np.arange(1, waves + 1)[:, None]
    phase = rng.uniform(0.0, 2.0 * np.pi, (waves, 1))
    line = np.sum(np.cos(2.0 * np.pi * number * np.arange(size) / size + phase), axis=0)
    return np.rint(20 * line).astype(np.int32)


def plain(line, film, half_window, factor):
    """Every window looks at all points in it, and at the run of each to its ends."""
    size, found = line.size, 0
    touching = line > film
    for centre in range(size):
        broken = False
        for point in range(centre - half_window, centre + half_window + 1):
            if not touching[point % size]:
                continue
            left = right = point
            while touching[(left - 1) % size] and right - left < size - 1:
                left -= 1
            while touching[(right + 1) % size] and right - left < size - 1:
                right += 1
            overlap = sum(int(line[i % size]) - film for i in range(left, right + 1))
            broken |= layer_breaks(right - left + 1, overlap, factor)
        found += broken
    return found


@pytest.mark.parametrize("seed", range(6))
@pytest.mark.parametrize("factor", [0.5, 3.0, 30.0])
def test_counts_are_those_of_a_plain_search(seed, factor):
    line = rough(seed)
    films, half_windows = np.array([60, 20, 90, -10, 130]), np.array([0, 7, 40, 3, 199])
    expected = [plain(line, *each, factor) for each in zip(films, half_windows, strict=True)]
    assert whole_run_steps(line, films, half_windows, factor).tolist() == expected


def test_without_a_cut_run_both_judgements_are_the_same():
    """Runs of one point, which no edge can cut."""
    line = np.zeros(300, np.int32)
    line[::17] = 50
    point = np.array([10]), np.array([6])
    cut = strip_statistics((line, np.zeros_like(line)), (1.0, 1.0), 300, *point, 1.0)
    assert whole_run_steps(line, *point, 1.0) == cut[0, 1] > 0


def test_a_line_that_touches_everywhere_is_one_run():
    line = np.full(50, 9, np.int32)
    for factor, count in ((1.0, 0), (1e6, 50)):
        assert whole_run_steps(line, np.array([1]), np.array([3]), factor).tolist() == [count]
