"""Surfaces with a lay: limits, then waves drawn one by one."""

import numpy as np
import pytest

from lube.surfaces.lay import extents, unstretched, waves_along_rolling, waves_of_line

FIRST = 400
VARIANCES = np.arange(FIRST, 4000) ** -2.4


def test_a_surface_without_a_lay_keeps_its_waves():
    first, variances = waves_of_line(FIRST, VARIANCES, 1.0)
    np.testing.assert_allclose(variances[FIRST - first :], VARIANCES)
    assert variances.sum() == pytest.approx(VARIANCES.sum())
    assert unstretched(3.0, 4.0, 1.0, 30.0) == 5.0
    assert waves_along_rolling(1.0, 20.0) == 0.0


@pytest.mark.parametrize("ratio", [1.5, 6.0, 1e5])
def test_height_gradient_and_curvature_keep_their_mean_squares(ratio):
    """Stretching divides the component of each wave vector along the lay by the ratio."""
    first, variances = waves_of_line(FIRST, VARIANCES, ratio)
    angle = np.linspace(0.0, 2.0 * np.pi, 1000, endpoint=False)
    square = np.cos(angle) ** 2 + np.sin(angle) ** 2 / ratio**2
    before, after = FIRST + np.arange(VARIANCES.size), first + np.arange(variances.size)
    for order in (0, 1, 2):
        expected = np.sum(VARIANCES * before ** (2.0 * order)) * np.mean(square**order)
        assert np.sum(variances * after ** (2.0 * order)) == pytest.approx(expected, rel=1e-3)


@pytest.mark.parametrize(("ratio", "angle"), [(3.0, 90.0), (3.0, 0.0), (2.0, 35.0)])
def test_the_line_has_the_waves_that_are_drawn_on_the_surface(ratio, angle):
    """Waves of a surface, stretched in space one by one."""
    rng = np.random.default_rng(3)
    number = rng.choice(FIRST + np.arange(VARIANCES.size), 400_000, p=VARIANCES / VARIANCES.sum())
    direction = rng.uniform(0.0, 2.0 * np.pi, number.size)
    across, ridges = number * np.cos(direction), number * np.sin(direction) / ratio
    turn = np.radians(angle)
    along_rolling = ridges * np.cos(turn) - across * np.sin(turn)
    along_rollers = ridges * np.sin(turn) + across * np.cos(turn)
    np.testing.assert_allclose(unstretched(along_rolling, along_rollers, ratio, angle), number)
    double_angle = np.cos(2.0 * np.arctan2(along_rollers, along_rolling))
    assert waves_along_rolling(ratio, angle) == pytest.approx(np.mean(double_angle), abs=0.005)
    length = np.hypot(along_rolling, along_rollers)
    first, variances = waves_of_line(FIRST, VARIANCES, ratio)
    edges = np.geomspace(first - 0.5, FIRST + VARIANCES.size - 0.5, 9)
    share = np.histogram(length, edges)[0] / number.size
    bins = np.digitize(first + np.arange(variances.size), edges) - 1
    np.testing.assert_allclose(np.bincount(bins, variances) / VARIANCES.sum(), share, atol=0.005)


def test_long_ridges_across_rolling_leave_the_profile():
    """Its waves are those of the surface, times the cosine of their direction."""
    first, variances = waves_of_line(FIRST, VARIANCES, 1e6)
    angle = (np.arange(5000) + 0.5) / 5000 * np.pi / 2.0
    known = FIRST - 0.5 + np.arange(VARIANCES.size + 1)
    power = np.concatenate([[0.0], np.cumsum(VARIANCES)])
    below = np.cumsum(variances)
    for number in (30, 300, 1000, 3000):
        expected = np.mean(np.interp((number + 0.5) / np.cos(angle), known, power))
        assert below[number - first] == pytest.approx(expected, rel=0.02)


def test_a_stretched_circle_reaches_as_far_as_its_points():
    for ratio, angle in ((3.0, 20.0), (5.0, -70.0)):
        turn, around = np.radians(angle), np.linspace(0.0, 2.0 * np.pi, 10_001)
        ridges, across = ratio * np.cos(around), np.sin(around)
        along = np.max(ridges * np.cos(turn) - across * np.sin(turn))
        rollers = np.max(ridges * np.sin(turn) + across * np.cos(turn))
        assert extents(ratio, angle) == pytest.approx((along, rollers), rel=1e-6)
