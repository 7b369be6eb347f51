"""The strips against the literal scan, at any slip: equal to the last bit."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from literal import scan_trace
from literal_scan import scan_statistics

from lube.kernels.layer import layer_factor
from lube.kernels.motion import surface_position
from lube.kernels.strips import LONGEST_STRIP, strip_end, strip_statistics, strip_trace
from lube.surfaces.synthetic import draw_realisation

ROLLING = (1.0, 1.0)
slower = st.one_of(
    st.sampled_from([0.0, 1e-9, 1 / 3, 0.5, 2 / 3, 0.9, 0.99, 0.999, 1 - 1e-9, 1.0]),
    st.floats(0, 1),
)
speed_ratios = st.one_of(
    slower.map(lambda ratio: (1.0, ratio)), slower.map(lambda ratio: (ratio, 1.0))
)
# Plateaus make long runs, small heights make ties with the film and between segments.
plateaus = st.lists(st.tuples(st.integers(-3, 3), st.integers(1, 9)), min_size=1, max_size=12).map(
    lambda pieces: [height for height, points in pieces for _ in range(points)]
)
noise = st.lists(st.integers(-3, 3), min_size=1, max_size=40)
rough_lines = st.one_of(plateaus, noise).map(lambda heights: np.array(heights, np.int32))
half_windows = st.one_of(st.integers(0, 4), st.integers(0, 60))
operating_points = st.lists(st.tuples(st.integers(-8, 8), half_windows), min_size=1, max_size=6)
# n^3 < factor S: the middle ones let some segments break and make ties, S being whole.
factors = st.sampled_from([0.0, 0.25, 0.5, 1.0, 2.0, 4.0, 8.0, 9.0, 16.0, 27.0, 100.0, 1e9])


def by_strips(line_1, line_2, points, factor, steps=None, ratios=ROLLING, kernel=strip_statistics):
    films, half_windows = np.array(points, np.int64).T
    return kernel((line_1, line_2), ratios, steps or line_1.size, films, half_windows, factor)


def assert_equals_the_scan(*arguments):
    fast = by_strips(*arguments)
    np.testing.assert_array_equal(fast, by_strips(*arguments, kernel=scan_statistics))
    return fast


@settings(max_examples=700)
@given(rough_lines, rough_lines, operating_points, factors, st.integers(1, 150), speed_ratios)
def test_statistics_equal_the_scan(line_1, line_2, points, factor, steps, ratios):
    assert_equals_the_scan(line_1, line_2, points, factor, steps, ratios)


@settings(max_examples=800)
@given(rough_lines, rough_lines, operating_points, factors, st.integers(1, 150), speed_ratios)
def test_trace_equals_the_scan_at_every_step(line_1, line_2, points, factor, steps, ratios):
    expected = [
        scan_trace(
            (line_1, line_2), ratios, steps, np.full(2 * half_window + 1, film), half_window, factor
        )[:, 1]
        for film, half_window in points
    ]
    found = by_strips(line_1, line_2, points, factor, steps, ratios, strip_trace)
    np.testing.assert_array_equal(found, expected)


@pytest.mark.parametrize("ratios", [ROLLING, (1.0, 0.9999), (0.9999, 1.0)])
def test_cutting_long_strips_changes_nothing(ratios):
    points = [(5, 6), (2, 20), (7, 0), (-9, 3)]
    for beyond in (-1, 0, 1, LONGEST_STRIP + 1):
        rng = np.random.default_rng(beyond + 10)
        lines = [rng.integers(-4, 5, size).astype(np.int32) for size in (997, 601)]
        for factor in (1.0, 9.0):
            assert_equals_the_scan(*lines, points, factor, LONGEST_STRIP + beyond, ratios)


@pytest.mark.parametrize(
    ("points", "second_radius", "ratios"),
    [
        (100_000, 0.05, ROLLING),
        (60_000, 0.047, ROLLING),
        (40_000, 0.05, (1.0, 0.99)),
        (30_000, 0.047, (0.8, 1.0)),
        (20_000, 0.05, (1.0, 0.0)),
    ],
)
def test_strips_equal_the_scan_on_the_papers_roughness(make_spec, points, second_radius, ratios):
    spec = make_spec(points, second_radius=second_radius)
    pair = draw_realisation(spec, seed=1, realisation=0)
    factor = layer_factor(1.1538e11, 5e-9, 1e6, spec.spacing, spec.height_step)
    widest = int(np.pi / spec.q_min / spec.spacing)
    at = [(250_000, widest), (250_000, widest // 4), (600_000, widest), (900_000, widest // 2)]
    fast = assert_equals_the_scan(*pair, at, factor, points, ratios)
    assert (fast[:3, :2] > 0).all()  # otherwise there is nothing to compare
    assert (fast[0, :2] < points).all()


@given(speed_ratios, st.integers(1, 400))
def test_strips_follow_on_one_another_and_keep_their_alignment(ratios, steps):
    begin = 0
    while begin < steps:
        end = strip_end(begin, steps, ratios)
        assert begin < end <= steps
        for ratio in ratios:
            first = surface_position(begin, ratio)
            moved = [surface_position(step, ratio) - first for step in range(begin, end)]
            assert moved == list(range(end - begin))
        begin = end


def test_strips_of_small_slip_are_about_one_over_the_slip_long():
    ends = [0]
    while ends[-1] < 10**5:
        ends.append(strip_end(ends[-1], 10**5, (1.0, 0.99)))
    assert np.median(np.diff(ends)) == 100


# Limits and symmetries


@given(st.integers(-2, 2), st.integers(1, 30), st.integers(-2, 2), st.integers(0, 40), factors)
def test_flat_surfaces_touch_everywhere_or_nowhere(height, size, film, half_window, factor):
    line = np.full(size, height, np.int32)
    width, overlap = 2 * half_window + 1, max(height - film, 0)
    breaks = width**3 < factor * width * overlap
    expected = [size * (overlap > 0), size * breaks, size * width * breaks, size * width * overlap]
    found = by_strips(line, np.zeros_like(line), [(film, half_window)], factor)
    assert found.tolist() == [expected]


@given(
    noise,
    operating_points,
    factors,
    st.integers(0, 40),
    st.integers(-(10**6), 10**6),
    st.randoms(use_true_random=False),
)
def test_neither_start_nor_order_nor_height_of_the_lines_matters(
    heights, points, factor, shift, lift, random
):
    line_1 = np.array(heights, np.int32)
    line_2 = np.array(random.choices(heights, k=len(heights)), np.int32)
    expected = by_strips(line_1, line_2, points, factor)
    lifted = [(film + lift, half_window) for film, half_window in points]
    for found in (
        by_strips(line_2, line_1, points, factor),
        by_strips(np.roll(line_1, shift), np.roll(line_2, shift), points, factor),
        by_strips(line_1 + np.int32(lift), line_2, lifted, factor),
    ):
        np.testing.assert_array_equal(found, expected)


@given(rough_lines, rough_lines, operating_points, factors, st.randoms(use_true_random=False))
def test_operating_points_do_not_affect_one_another(line_1, line_2, points, factor, random):
    together = by_strips(line_1, line_2, points, factor)
    order = random.choices(range(len(points)), k=len(points) + 2)  # any order, with repeats
    again = by_strips(line_1, line_2, [points[i] for i in order], factor)
    np.testing.assert_array_equal(again, together[order])


def test_steps_in_contact_are_at_most_those_of_all_runs_apart():
    """The union bound P <= Q + nu+ 2a, for one line and to the step."""
    line = np.random.default_rng(5).integers(-5, 6, 3000).astype(np.int32)
    for film, half_window in [(0, 3), (3, 3), (4, 10)]:
        begins = np.count_nonzero((line > film) & ~(np.roll(line, 1) > film))
        bound = np.count_nonzero(line > film) + begins * 2 * half_window
        assert by_strips(line, np.zeros_like(line), [(film, half_window)], 1.0)[0, 0] <= bound
    lone = np.zeros(100, np.int32)
    lone[[20, 21, 70]] = 1  # further apart than the window: the bound is met
    assert by_strips(lone, np.zeros_like(lone), [(0, 8)], 1.0)[0, 0] == 3 + 2 * 16


def test_every_point_is_in_as_many_windows_as_the_window_has_points():
    line_1, line_2 = np.random.default_rng(6).integers(-1000, 1000, (2, 500)).astype(np.int32)
    points = [(300, 0), (300, 7), (-200, 30), (1500, 249)]
    overlap = by_strips(line_1, line_2, points, 1.0)[:, 3]
    assert overlap.tolist() == [
        (2 * half_window + 1) * np.maximum(line_1 + line_2 - film, 0).sum()
        for film, half_window in points
    ]
