"""Waves of measured heights: exact theory, then surfaces of known direction."""

import numpy as np
import pytest
import scipy.fft
from example_surface import rolled_off_surface

from lube.surfaces.measured_spectrum import MOST_ANISOTROPY
from lube.surfaces.measured_waves import anisotropy, hann, map_power, profile_density

LENGTH = 1e-3

# --- Exact theory ------------------------------------------------------------------------


def test_a_sine_has_its_mean_square_at_its_wave_vector():
    x = 1e-6 * np.arange(4000)
    sine = 0.3e-6 * np.sin(2 * np.pi * x / 5e-5 + 1.0)
    wave_vector, density = profile_density(sine, 1e-6)
    assert np.sum(density) * wave_vector[0] == pytest.approx(0.045e-12, rel=0.01)
    near = np.abs(wave_vector - 2 * np.pi / 5e-5) < 2.5 * wave_vector[0]
    assert np.sum(density[near]) * wave_vector[0] == pytest.approx(0.045e-12, rel=1e-6)


@pytest.mark.parametrize("shape", [(128, 96), (101, 128), (64, 65)])
def test_the_power_of_a_map_is_its_windowed_mean_square(shape):
    heights = np.random.default_rng(2).normal(size=shape)
    windowed = heights * np.outer(hann(shape[0]), hann(shape[1]))
    expected = np.mean(windowed**2) - np.mean(windowed) ** 2
    assert map_power(heights).sum() == pytest.approx(expected, rel=1e-12)


# --- Known surfaces ----------------------------------------------------------------------


@pytest.mark.parametrize("stretch", [1.0, 1.4, 2.0, 5.0])
def test_anisotropy_is_that_of_a_stretched_surface(stretch):
    """C2D ~ (q_x^2 + s^2 q_y^2)^-(H + 1) on every ring: waves along x are stronger."""
    points, hurst = 512, 0.8
    x, y = np.meshgrid(
        scipy.fft.fftfreq(points, 1 / points), np.arange(points // 2 + 1), indexing="ij"
    )
    waves = np.maximum(np.hypot(x, stretch * y), 1.0)
    noise = scipy.fft.rfft2(np.random.default_rng(8).normal(size=(points, points)))
    heights = scipy.fft.irfft2(noise * waves ** (-hurst - 1.0), (points, points))
    angle = np.linspace(0, np.pi, 20_001)
    density = (np.cos(angle) ** 2 + (stretch * np.sin(angle)) ** 2) ** (-hurst - 1.0)
    expected = np.mean(density * np.cos(2 * angle)) / np.mean(density)
    measure, direction = anisotropy(map_power(heights), (LENGTH, LENGTH), 8e5)
    assert measure == pytest.approx(expected, abs=0.06)
    assert (measure > MOST_ANISOTROPY) == (stretch > 1.5)
    assert stretch == 1.0 or abs(direction) < 0.1


def test_anisotropy_finds_the_direction():
    surface = rolled_off_surface(512, LENGTH, 0.8, 1e-4, 0.2e-6, np.random.default_rng(5))
    lengths = (LENGTH, LENGTH)
    assert anisotropy(map_power(surface), lengths, 8e5)[0] < 0.06
    # Scratches along the first axis: a row's heights hardly change along it.
    ground = np.cumsum(np.random.default_rng(1).normal(size=(512, 512)), axis=0)
    measure, direction = anisotropy(map_power(ground), lengths, 8e5)
    assert measure > 2 * MOST_ANISOTROPY
    assert abs(direction) == pytest.approx(np.pi / 2, abs=0.05)
    turned, direction = anisotropy(map_power(ground.T.copy()), lengths, 8e5)
    assert turned == pytest.approx(measure, rel=0.05) and abs(direction) < 0.05
