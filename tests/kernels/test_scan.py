"""The literal scan against a second, naive implementation (physics.md, section 5)."""

import math
from fractions import Fraction
from itertools import groupby

import numpy as np
from hypothesis import given
from hypothesis import strategies as st
from literal import scan_trace
from literal_scan import scan_statistics

from lube.kernels.motion import surface_position

small_lines = st.lists(st.integers(-3, 3), min_size=1, max_size=12)
eighths = st.integers(0, 40).map(lambda number: Fraction(number, 8))  # exact as floats
sixteenths = st.integers(0, 16).map(lambda number: Fraction(number, 16))


def naive_trace(z1, z2, v1, v2, steps, h0, half_window, factor):
    """Contact points, broken points and overlap in the window at each time step.

    In units where dx = E* = h_c = 1 and pi tau0 / 12 = 1 / factor.
    """
    trace = []
    for t in range(steps):
        s1, s2 = (math.floor(t * v / max(v1, v2) + Fraction(1, 2)) for v in (v1, v2))
        window = range(-half_window, half_window + 1)
        overlaps = [z1[(s1 + j) % len(z1)] + z2[(s2 + j) % len(z2)] - h0 for j in window]
        segments = [list(run) for touches, run in groupby(overlaps, lambda z: z > 0) if touches]
        # h_l = (1 / factor) D^3 / F < 1 = h_c
        broken = [len(each) for each in segments if len(each) ** 3 < factor * sum(each)]
        trace.append([sum(map(len, segments)), sum(broken), sum(map(sum, segments))])
    return trace


def flat(film, half_window):
    return np.full(2 * half_window + 1, film)


def int32(line):
    return np.array(line, np.int32)


@given(
    small_lines,
    small_lines,
    sixteenths,
    st.booleans(),
    st.integers(0, 30),
    st.integers(-7, 7),
    st.integers(0, 15),
    eighths,
)
def test_scan_equals_the_naive_model_at_any_two_speeds(
    z1, z2, slower, first_is_slower, steps, film, half_window, factor
):
    speeds = (slower, Fraction(1)) if first_is_slower else (Fraction(1), slower)
    ratios = (float(speeds[0]), float(speeds[1]))
    films = flat(film, half_window)
    lines = int32(z1), int32(z2)
    trace = scan_trace(lines, ratios, steps, films, half_window, float(factor))
    expected = naive_trace(z1, z2, *speeds, steps, film, half_window, factor)
    assert trace.tolist() == expected


@given(
    small_lines,
    small_lines,
    sixteenths,
    st.lists(st.tuples(st.integers(-7, 7), st.integers(0, 15)), max_size=4),
    eighths,
)
def test_scan_statistics_sum_up_the_naive_trace(z1, z2, slower, points, factor):
    steps = 17
    films, half_windows = np.array(points, np.int64).reshape(-1, 2).T
    statistics = scan_statistics(
        (int32(z1), int32(z2)), (1.0, float(slower)), steps, films, half_windows, float(factor)
    )
    for row, (film, half_window) in zip(statistics.tolist(), points, strict=True):
        trace = naive_trace(z1, z2, Fraction(1), slower, steps, film, half_window, factor)
        contact, broken, overlap = zip(*trace, strict=True)
        assert row == [
            sum(points > 0 for points in contact),
            sum(points > 0 for points in broken),
            sum(broken),
            sum(overlap),
        ]


@given(st.integers(0, 10**6), st.integers(1, 10**6), st.integers(1, 10**6))
def test_surface_position_is_the_nearest_point(step, slower, excess):
    speed_ratio = Fraction(slower, slower + excess)
    exact = step * speed_ratio
    nearest = math.floor(exact + Fraction(1, 2))
    if abs(exact - nearest) < Fraction(1, 2) - Fraction(1, 10**8):  # not half-way between two
        assert surface_position(step, float(speed_ratio)) == nearest


def test_a_surface_at_rest_shows_the_window_the_same_points():
    rough, smooth = int32([0, 0, 5, 0, 0, 0, 0]), int32([0] * 7)
    for pair, ratios in (((smooth, rough), (1.0, 0.0)), ((rough, smooth), (0.0, 1.0))):
        assert scan_trace(pair, ratios, 7, flat(3, 2), 2, 1.0).tolist() == [[1, 1, 2]] * 7


def test_window_cuts_segments_at_its_edges():
    line = int32([2, 2, 2, 0, 0, 0, 0, 0])
    lines = line, np.zeros_like(line)
    trace = scan_trace(lines, (1.0, 1.0), 8, flat(0, 1), 1, 0.0)
    assert trace[:, 0].tolist() == [2, 3, 2, 1, 0, 0, 0, 1]
