"""Summits of a Gaussian line or surface: limits, then numerical integration and drawn points."""

import numpy as np
import pytest
import scipy.integrate
import scipy.stats

from lube.physics.excursions import SurfaceMoments
from lube.physics.summits import (
    SummitMotion,
    breaking_curvature,
    sharp_summit_share,
    sharp_surface_summit_share,
    sharpening_summits,
)

MOMENTS = 2.0, 3.0, 40.0
SURFACE = SurfaceMoments(2.0, along=1.5, across=1.5, mixed=0.0, curvature=40.0)


def test_all_summits_are_sharper_than_flat_and_none_than_a_needle():
    levels = np.array([0.5, 2.0, 9.0])
    np.testing.assert_allclose(sharp_summit_share(levels, MOMENTS, 0.0), 1.0)
    assert np.all(sharp_summit_share(levels, MOMENTS, 1e3) < 1e-100)


@pytest.mark.parametrize("level", [1e-9, 0.1, 1.0, 4.0, 8.0])
def test_sharp_summits_by_numerical_integration(level):
    m0, m2, m4 = MOMENTS
    density = scipy.stats.multivariate_normal([0.0, 0.0], [[m0, m2], [m2, m4]])

    def summits(least):
        top, sharpest = level + 10.0, least + 60.0
        grid = np.linspace(level, top, 801)[:, None], np.linspace(least, sharpest, 801)
        values = grid[1] * density.pdf(np.stack(np.broadcast_arrays(*grid), axis=-1))
        inner = scipy.integrate.simpson(values, grid[1], axis=1)
        return scipy.integrate.simpson(inner, grid[0][:, 0])

    expected = summits(9.0) / summits(0.0)
    # Of levels as low as a fraction of the rms height not much is asked.
    error = 0.03 if level < 0.3 else 1e-4
    assert sharp_summit_share(np.array([level]), MOMENTS, 9.0) == pytest.approx(expected, rel=error)


def test_the_layer_breaks_at_the_curvature_where_the_remaining_thickness_is_critical():
    """Eqs. 5 and 6 are worked out by hand for parabolas of two heights."""
    modulus, critical, strength = 1.154e11, 5e-9, 1e6
    curvature = breaking_curvature(modulus, critical, strength)
    for height in (1e-9, 3e-8):
        length = np.sqrt(8.0 * height / curvature)
        force = modulus * 2.0 / 3.0 * length * height
        thickness = np.pi * strength / 12.0 * length**3 / force
        assert thickness == pytest.approx(critical)


def test_all_summits_of_a_surface_are_sharper_than_flat_and_none_than_a_needle():
    levels = np.array([0.5, 2.0, 9.0])
    np.testing.assert_allclose(sharp_surface_summit_share(levels, SURFACE, 0.0), 1.0)
    assert np.all(sharp_surface_summit_share(levels, SURFACE, 1e3) < 1e-100)


def test_where_what_is_high_is_hollow_there_are_no_summits():
    """So it is where the response of the film turns the phase of the waves."""
    hollow = SurfaceMoments(2.0, along=-6.0, across=0.0, mixed=0.0, curvature=40.0)
    curvatures = 10.0 * np.diag([1.0, 0.5, 0.5])
    assert sharp_surface_summit_share(np.array([12.0]), hollow, 1.0, curvatures) == 0.0
    motion = SummitMotion(np.ones(1), *np.ones((2, 2, 2, 1)))
    assert sharpening_summits(np.array([12.0]), hollow, 1.0, curvatures, motion) == 0.0


def test_sharp_summits_of_a_surface_are_those_of_drawn_critical_points():
    m2, cross = SURFACE.along, SURFACE.curvature / 8.0
    hessian = np.array([[3.0 * cross, cross, 0.0], [cross, 3.0 * cross, 0.0], [0.0, 0.0, cross]])
    expected = of_drawn_points(SURFACE.height, [m2, m2, 0.0], hessian, 4.0)
    found = sharp_surface_summit_share(np.array([2.0]), SURFACE, 4.0)
    assert found == pytest.approx(expected, abs=0.01)
    assert 0.1 < expected < 0.9


def test_sharp_summits_of_a_surface_with_a_lay_are_those_of_drawn_critical_points():
    """Waves of some directions and lengths, more of them along rolling than across it."""
    along, across = np.array([[1.0, 1.6, 1.5, 0.4, 0.7], [0.1, -0.4, 0.8, 0.5, 1.2]])
    power = np.array([1.0, 0.4, 0.3, 0.3, 0.2])
    slopes = np.stack([along**2, across**2, along * across])
    hessian = np.einsum("iw,jw,w->ij", slopes, slopes, power)
    turned = np.array([[0.5, 0.5, 0.0], [0.5, -0.5, 0.0], [0.0, 0.0, 1.0]])
    curvatures = np.einsum("ai,bj,ij->ab", turned, turned, hessian)
    squares = np.sum(slopes * power, axis=1)
    expected = of_drawn_points(power.sum(), squares, hessian, 2.4)
    moments = SurfaceMoments(power.sum(), *squares, 4.0 * curvatures[0, 0])
    found = sharp_surface_summit_share(np.array([2.0]), moments, 2.4, curvatures)
    assert found == pytest.approx(expected, abs=0.01)
    assert 0.1 < expected < 0.9


def test_summits_become_sharper_as_those_of_drawn_critical_points_do():
    """Their change of curvature is drawn, too: at a fixed place, and as they move."""
    m2, cross, limit = SURFACE.along, SURFACE.curvature / 8.0, 3.0
    hessian = np.array([[3.0 * cross, cross, 0.0], [cross, 3.0 * cross, 0.0], [0.0, 0.0, cross]])
    z, xx, yy, xy = drawn_points(SURFACE.height, [m2, m2, 0.0], hessian)
    determinant, curvature = xx * yy - xy**2, -(xx + yy) / 2.0
    changes = np.array([[0.9, 0.3], [0.3, 0.5]]), np.array([[8.0, 1.0], [1.0, 5.0]])
    motion = SummitMotion(np.full(1, 7.0), *(each[..., None] for each in changes))
    summit = (determinant > 0.0) & (xx < 0.0) & (z > 2.0)
    near = summit & (abs(curvature - limit) < 0.1)
    # The velocity of a summit: minus the inverse of the second derivatives, times the changes.
    rng = np.random.default_rng(5)
    slopes, gradients = (
        rng.multivariate_normal([0.0, 0.0], each, near.sum()).T for each in changes
    )
    xx, yy, xy = (each[near] for each in (xx, yy, xy))
    velocity = np.array([xy * slopes[1] - yy * slopes[0], xy * slopes[0] - xx * slopes[1]])
    change = determinant[near] * np.sqrt(motion.change) * rng.standard_normal(near.sum())
    change += np.sum(velocity * gradients, axis=0)
    expected = np.sum(np.maximum(change, 0.0)) / 0.2 / determinant[summit].sum()
    found = sharpening_summits(np.array([2.0]), SURFACE, limit, None, motion)
    assert found == pytest.approx(expected, rel=0.06)


def of_drawn_points(height, slopes, hessian, curvature):
    """Points without slope, weighed by |det H| (Rice)."""
    z, xx, yy, xy = drawn_points(height, slopes, hessian)
    weight = xx * yy - xy**2
    maximum = (weight > 0.0) & (xx < 0.0) & (z > 2.0)
    sharp = maximum & (-(xx + yy) / 2.0 > curvature)
    return weight[sharp].sum() / weight[maximum].sum()


def drawn_points(height, slopes, hessian):
    """Heights and second derivatives drawn at points without slope."""
    covariance = np.empty((4, 4))
    covariance[0, 0], covariance[1:, 1:] = height, hessian
    covariance[0, 1:] = covariance[1:, 0] = -np.asarray(slopes)
    rng = np.random.default_rng(4)
    return rng.multivariate_normal(np.zeros(4), covariance, 2_000_000).T


@pytest.mark.parametrize("curvature", [20.0, 100.0, 1e4])
def test_two_ways_to_sum_over_the_summits_of_an_isotropic_surface_agree(curvature):
    """Nayak's closed form, and the mean over difference and twist."""
    moments = SurfaceMoments(1.0, 2.0, 2.0, 0.0, curvature)
    curvatures, limits = 0.25 * curvature * np.diag([1.0, 0.5, 0.5]), np.linspace(0.05, 4.0, 40)
    for level in (1.5, 4.0, 8.0):
        known = np.full(limits.size, level), moments, 0.5 * np.sqrt(curvature) * limits
        found = sharp_surface_summit_share(*known, curvatures)
        np.testing.assert_allclose(found, sharp_surface_summit_share(*known), atol=0.002)
        assert found.max() <= 1.0
