"""The Abel pair between an isotropic surface and a profile cut from it."""

import numpy as np
import pytest
import scipy.integrate
import scipy.special

from lube.surfaces.abel import line_of_profile, monotone
from profiles import line_over_profile, profile_of_line


@pytest.mark.parametrize("hurst", [0.5, 0.7, 0.9])
def test_self_affine_spectra_have_the_exact_ratio(hurst):
    q = np.geomspace(1e4, 1e6, 50)
    exponent = -2.0 * hurst - 1.0
    ratio, _ = scipy.integrate.quad(lambda u: 2 / np.pi * np.cosh(u) ** exponent, 0, 50)
    assert line_over_profile(hurst) == pytest.approx(1.0 / ratio, rel=1e-9)
    found = line_of_profile(q, ratio * q**exponent, q) / q**exponent
    np.testing.assert_allclose(found, 1.0, rtol=1e-6)


def test_ratio_of_the_paper_is_1_75():
    assert line_over_profile(0.7) == pytest.approx(1.75, abs=0.005)  # physics-beyond.md, section 12


def test_exact_pair_of_a_gaussian_surface():
    # C2D ~ exp(-q^2 s^2 / 2): the profile's density is Gaussian too.
    s, q = 1e-5, np.geomspace(2e3, 6e5, 400)
    line = s**2 * q * np.exp(-0.5 * (q * s) ** 2)
    profile = np.sqrt(2 / np.pi) * s * np.exp(-0.5 * (q * s) ** 2)
    found = line_of_profile(q, profile, q)
    inside = q < 4 / s
    np.testing.assert_allclose(found[inside], line[inside], rtol=2e-3)
    np.testing.assert_allclose(profile_of_line(q, line)[inside], profile[inside], rtol=5e-3)


@pytest.mark.parametrize("hurst", [0.5, 0.7, 0.9])
def test_inversion_returns_a_spectrum_with_a_roll_off(hurst):
    q = np.geomspace(1e3, 1e8, 4000)
    line = q * np.maximum(q / 5e4, 1.0) ** (-2 * hurst - 2)
    wanted = q[(q > 1e4) & (q < 2e6)]
    profile = profile_of_line(q, line)
    knots = q[200:3200:20]
    found = line_of_profile(knots, np.interp(knots, q, profile), wanted)
    true = np.interp(wanted, q, line)
    away = np.abs(np.log(wanted / 5e4)) > 0.1  # the kink itself is rounded
    np.testing.assert_allclose(found[away], true[away], rtol=0.03)


def test_any_spectrum_becomes_a_line_without_negative_density():
    generator = np.random.default_rng(5)
    q = np.geomspace(1e3, 1e6, 60)
    for _ in range(20):
        estimates = generator.uniform(1, 5, q.size)
        noisy = q**-2.4 * generator.gamma(estimates, 1 / estimates)
        assert np.all(line_of_profile(q, monotone(noisy, estimates), q) >= 0.0)


def test_monotone_fit_keeps_the_weighted_mean_and_leaves_falling_spectra():
    generator = np.random.default_rng(6)
    density, estimates = generator.exponential(size=50), generator.uniform(1, 9, 50)
    fit = monotone(density, estimates)
    assert np.all(np.diff(fit) <= 0.0)
    assert np.average(fit, weights=estimates) == pytest.approx(
        np.average(density, weights=estimates)
    )
    falling = np.geomspace(1, 1e-3, 50)
    np.testing.assert_array_equal(monotone(falling, estimates), falling)
