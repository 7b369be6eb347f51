"""Curves and spectra of heights that are not Gaussian: exact theory, then other implementations."""

import numpy as np
import pytest
import scipy.stats

from lube.surfaces.synthetic import wave_amplitudes
from lube.surfaces.translation import (
    NODES,
    REACH,
    gaussian_power,
    johnson_curve,
    standard_moments,
    translated_power,
)

HEIGHTS = np.linspace(-REACH, REACH, NODES)
RUN_IN = (-1.0, 5.0)
PAIRS = [RUN_IN, (0.0, 4.0), (0.0, 1.5), (0.7, 3.0), (-2.0, 6.5), (3.0, 20.0), (0.001, 3.001)]


def normal_scores(distribution):
    """Standardised heights of a distribution at the nodes of a curve, by its quantiles."""
    lower, upper = HEIGHTS < 0.0, HEIGHTS >= 0.0
    heights = np.empty(NODES)
    heights[lower] = distribution.ppf(scipy.stats.norm.cdf(HEIGHTS[lower]))
    heights[upper] = distribution.isf(scipy.stats.norm.sf(HEIGHTS[upper]))
    return (heights - distribution.mean()) / distribution.std()


# --- Curves ------------------------------------------------------------------------------


@pytest.mark.parametrize(("skewness", "kurtosis"), PAIRS)
def test_curve_has_its_skewness_and_kurtosis_and_never_falls(skewness, kurtosis):
    curve = johnson_curve(skewness, kurtosis)
    assert standard_moments(curve) == pytest.approx((skewness, kurtosis), abs=1e-6)
    assert np.all(np.diff(curve) >= 0.0)
    weights = scipy.stats.norm.pdf(HEIGHTS) * (HEIGHTS[1] - HEIGHTS[0])
    assert weights @ curve == pytest.approx(0.0, abs=1e-9)
    assert weights @ curve**2 == pytest.approx(1.0, abs=1e-9)
    np.testing.assert_allclose(-johnson_curve(-skewness, kurtosis)[::-1], curve, atol=1e-12)


def test_nearly_gaussian_heights_are_hardly_changed():
    middle = np.abs(HEIGHTS) < 4.0
    np.testing.assert_allclose(johnson_curve(0.0, 3.0001)[middle], HEIGHTS[middle], atol=1e-3)


@pytest.mark.parametrize(
    "distribution",
    [
        scipy.stats.johnsonsu(-0.6, 1.9),
        scipy.stats.johnsonsu(0.0, 1.5),
        scipy.stats.johnsonsb(0.8, 0.9),
        scipy.stats.johnsonsb(0.0, 0.7),
        scipy.stats.lognorm(0.25),
    ],
)
def test_curve_is_the_only_one_of_johnsons_system_with_these_moments(distribution):
    """Quantiles of SciPy's distributions, whose moments are known by other means."""
    skewness, excess = map(float, distribution.stats("sk"))
    near = np.abs(HEIGHTS) < 5.0
    curve = johnson_curve(skewness, excess + 3.0)
    np.testing.assert_allclose(curve[near], normal_scores(distribution)[near], atol=2e-3)


# --- Spectra -----------------------------------------------------------------------------


def test_autocorrelation_is_the_mean_product_of_two_translated_heights():
    """A Gaussian line of one wave has the correlation cos at any distance: a double integral."""
    curve, points = johnson_curve(*RUN_IN), 24
    power = translated_power(np.array([1.0]), 1, points, curve)
    waves = np.arange(power.size)
    nodes, weights = np.polynomial.hermite_e.hermegauss(80)
    weights = np.outer(weights, weights) / weights.sum() ** 2
    for lag in (0, 1, 4, 9):
        angle = 2.0 * np.pi * lag / points
        other = np.cos(angle) * nodes[:, None] + np.sin(angle) * nodes
        heights = [np.interp(each, HEIGHTS, curve) for each in (nodes[:, None], other)]
        expected = np.sum(weights * heights[0] * heights[1])
        assert np.sum(power * np.cos(angle * waves)) == pytest.approx(expected, abs=2e-3)


@pytest.mark.parametrize(
    ("skewness", "kurtosis", "outside"),
    # The share of the variance outside the band, stored when this test was written.
    [(-0.5, 3.5, 0.0035), (-1.0, 5.0, 0.0125), (-1.0, 4.0, 0.0173), (-2.0, 10.0, 0.0446)],
)
def test_spectrum_is_kept_within_the_band_and_little_lies_outside(
    make_spec, skewness, kurtosis, outside
):
    spec, curve = make_spec(100_000), johnson_curve(skewness, kurtosis)
    first, amplitudes = wave_amplitudes(spec, 0)
    gaussian = gaussian_power(amplitudes**2, first, spec.points[0], curve)
    assert gaussian.sum() == pytest.approx(1.0) and gaussian.min() > 0.0
    power = translated_power(gaussian, first, spec.points[0], curve)
    assert power[1:].sum() == pytest.approx(1.0, abs=1e-3)
    band = power[first : first + amplitudes.size]
    prescribed = amplitudes**2 / np.sum(amplitudes**2)
    np.testing.assert_allclose(band / band.sum(), prescribed, rtol=2e-3)
    assert 1.0 - band.sum() == pytest.approx(outside, rel=0.2)


def test_a_coarser_grid_and_fewer_corrections_leave_the_spectrum_as_it_is(make_spec):
    """Against eight corrections on the line's own points."""
    spec, curve = make_spec(100_000), johnson_curve(0.5, 4.0)
    first, amplitudes = wave_amplitudes(spec, 0)
    prescribed = amplitudes**2 / np.sum(amplitudes**2)
    expected = prescribed
    for _ in range(8):
        power = translated_power(expected, first, spec.points[0], curve)
        expected = expected * prescribed / power[first : first + amplitudes.size]
        expected /= expected.sum()
    found = gaussian_power(amplitudes**2, first, spec.points[0], curve)
    np.testing.assert_allclose(found, expected, rtol=1e-6)
