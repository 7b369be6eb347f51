"""Fits and moments of measured surfaces: exact cases, and how often intervals hold the truth."""

import numpy as np
import pytest
import scipy.fft
import scipy.stats
from example_surface import rolled_off_surface

from lube.surfaces.measured_spectrum import line_spectrum
from lube.surfaces.spectrum_table import LineSpectrum
from lube.surfaces.surface_statistics import (
    Waves,
    height_distribution,
    hurst_exponent,
    roll_off,
    spikes,
    waves_of_surface,
)
from lube.surfaces.topography import Preparation, Topography, power_transfer, prepare

Q = np.geomspace(1e4, 1e6, 40)
WAVES = Waves(2 * np.pi / Q[0], 2 * np.pi / Q[-1])


def spectrum(density, estimates=1e6, transfer=1.0, isotropic=True):
    filled = (np.full(Q.size, estimates), np.full(Q.size, transfer))
    return LineSpectrum("a", Q, density, *filled, isotropic)


@pytest.mark.parametrize("hurst", [0.3, 0.7, 0.95])
def test_hurst_exponent_of_a_power_law_is_exact(hurst):
    found = hurst_exponent(spectrum(Q ** (-2 * hurst - 1)), WAVES)
    assert found.value == pytest.approx(hurst, abs=1e-5)
    assert found.lower < hurst + 1e-5 and found.upper > hurst - 1e-5


def test_filters_do_not_change_the_fits():
    passed = power_transfer(Q, 3e-4, 1e-5)
    filtered = LineSpectrum("a", Q, Q**-2.4 * passed, np.full(40, 1e6), passed, True)
    assert hurst_exponent(filtered, WAVES).value == pytest.approx(0.7, abs=1e-4)
    assert roll_off(filtered, WAVES) is None


def test_intervals_of_scattered_spectra_hold_the_exponent_in_95_of_100_cases():
    generator = np.random.default_rng(1)
    estimates = np.linspace(2.0, 60.0, Q.size)
    inside, values = 0, []
    for _ in range(300):
        noisy = Q**-2.4 * generator.gamma(estimates, 1 / estimates)
        each = LineSpectrum("a", Q, noisy, estimates, np.ones(Q.size), False)
        found = hurst_exponent(each, WAVES)
        inside += found.lower <= 0.7 <= found.upper
        values.append(found.value)
    assert 0.91 < inside / 300 <= 1.0
    assert np.mean(values) == pytest.approx(0.7, abs=4 * np.std(values) / np.sqrt(300))


@pytest.mark.parametrize("isotropic", [True, False])
def test_roll_off_is_found_and_none_without_one(isotropic):
    power = 1.0 if isotropic else 0.0
    density = Q**power * np.maximum(Q / 1e5, 1.0) ** (-2.4 - power)
    found = roll_off(spectrum(density, isotropic=isotropic), WAVES)
    assert 2 * np.pi / found.value == pytest.approx(1e5, rel=0.02)
    assert found.lower <= found.value <= found.upper
    assert roll_off(spectrum(Q**-2.4, isotropic=isotropic), WAVES) is None


def test_a_drawn_map_has_its_hurst_exponent_and_roll_off():
    settings = Preparation("isotropic")
    fits = []
    for seed in range(6):
        heights = rolled_off_surface(512, 4e-4, 0.8, 5e-5, 2e-7, np.random.default_rng(seed))
        surface = Topography("map", heights[:400, :400], (4e-4 / 512,) * 2)
        found = line_spectrum(prepare(surface, settings), settings)
        fits.append((hurst_exponent(found, Waves(4e-5, 4e-6)), roll_off(found, Waves(1, 0))))
    hurst, wavelength = zip(*fits, strict=True)
    assert np.mean([each.value for each in hurst]) == pytest.approx(0.8, abs=0.03)
    assert np.mean([each.value for each in wavelength]) == pytest.approx(5e-5, rel=0.1)
    assert sum(each.lower <= 0.8 <= each.upper for each in hurst) >= 5


INSTRUMENTS = {  # transmission of the amplitudes, and where three quarters of the power are lost
    "perfect": (lambda wavelength: np.ones_like(wavelength), None),
    "optical": (lambda wavelength: np.exp(-((7e-6 / wavelength) ** 2)), 7e-6 * np.log(2) ** -0.5),
    "sharp": (lambda wavelength: wavelength > 6e-6, 6e-6),
}


@pytest.mark.parametrize("instrument", INSTRUMENTS)
def test_the_fits_are_of_the_surface_and_not_of_the_instruments_resolution(instrument):
    passed, resolution = INSTRUMENTS[instrument]
    settings, points, length, held = Preparation("isotropic"), 1024, 8e-4, 0
    along, across = (scipy.fft.fftfreq(points), scipy.fft.rfftfreq(points))
    wavelength = length / points / np.maximum(np.hypot(along[:, None], across), 1e-9)
    for seed in range(6):
        heights = rolled_off_surface(points, length, 0.8, 6e-5, 2e-7, np.random.default_rng(seed))
        heights = scipy.fft.irfft2(scipy.fft.rfft2(heights) * passed(wavelength))
        surface = Topography("map", heights, (length / points,) * 2)
        found = line_spectrum(prepare(surface, settings), settings)
        waves = waves_of_surface(found, 1e-3, 1e-7)
        bend = roll_off(found, waves)
        assert bend.value == pytest.approx(6e-5, rel=0.15)
        hurst = hurst_exponent(found, waves._replace(longest=bend.value))
        assert hurst.value == pytest.approx(0.8, abs=0.1)
        held += hurst.lower <= 0.8 <= hurst.upper
        wanted = pytest.approx(resolution, rel=0.1) if resolution else np.isnan(waves.resolution)
        assert (waves.resolution if resolution else True) == wanted
        assert waves.blurred == (instrument == "optical")
    assert held >= 4


def test_moments_are_those_of_the_heights():
    heights = np.random.default_rng(2).gamma(3.0, size=(130, 101))
    found = height_distribution(heights)
    z = heights - heights.mean()
    assert {name: each.value for name, each in found.items()} == pytest.approx(
        {
            "rms_height": np.std(z),
            "mean_deviation": np.mean(np.abs(z)),
            "skewness": scipy.stats.skew(z, axis=None),
            "kurtosis": scipy.stats.kurtosis(z, axis=None, fisher=False),
        },
        rel=1e-9,
    )
    assert all(each.lower < each.value < each.upper for each in found.values())


def test_intervals_of_moments_hold_the_truth_in_95_of_100_cases():
    generator = np.random.default_rng(3)
    truth = {"rms_height": 1.0, "mean_deviation": np.sqrt(2 / np.pi), "skewness": 0, "kurtosis": 3}
    inside = dict.fromkeys(truth, 0)
    kernel = np.full(20, 20**-0.5)  # waves of some 20 points, blocks of 250
    for _ in range(300):
        heights = np.convolve(generator.normal(size=4019), kernel, "valid")
        for name, each in height_distribution(heights).items():
            inside[name] += each.lower <= truth[name] <= each.upper
    assert all(0.9 < count / 300 <= 0.99 for count in inside.values()), inside


def test_too_narrow_a_range_has_no_hurst_exponent():
    assert hurst_exponent(spectrum(Q**-2.4), Waves(2e-9, 1e-9)) is None


def test_narrow_grooves_are_no_spikes():
    heights = 1e-8 * np.random.default_rng(2).normal(size=(256, 256))
    heights[40:42] -= 2e-7
    heights[:, 100] -= 2e-7
    assert spikes(heights).size == 0
    heights[[10, 11, 200], [20, 20, 31]] += 3e-7
    assert spikes(heights).size == 3
