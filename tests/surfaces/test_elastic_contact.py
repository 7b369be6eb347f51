"""Elastic contact of surfaces and lines: exact solutions, limits, then a naive solver."""

import importlib.util
import sys

import numpy as np
import pytest
import scipy.fft
import scipy.stats

from lube.errors import LubeError
from lube.surfaces.elastic_contact import press_line, press_surface

MODULUS, SIDE = 1e11, 1e-4

needs_tamaas = pytest.mark.skipif(
    importlib.util.find_spec("tamaas") is None, reason="tamaas is not installed"
)


def rough(points, rng, shortest=8):
    """Waves of a self-affine band, of rms 1 um."""
    waves = np.hypot(*np.meshgrid(*2 * [np.fft.fftfreq(points, 1.0 / points)]))
    band = (waves >= 1.0) & (waves <= points / shortest)
    spectrum = np.where(band, np.maximum(waves, 1.0) ** -1.8, 0.0)
    noise = scipy.fft.fft2(rng.standard_normal((points, points)))
    heights = scipy.fft.ifft2(noise * spectrum).real
    return 1e-6 * heights / np.std(heights)


def rms_gradient(heights):
    points = len(heights)
    waves = 2.0 * np.pi * np.fft.fftfreq(points, SIDE / points)
    squares = waves[:, None] ** 2 + waves**2
    power = np.abs(scipy.fft.fft2(heights) / points**2) ** 2
    return np.sqrt(np.sum(squares * power))


# --- Exact solutions and limits, surface ------------------------------------------------------


@needs_tamaas
@pytest.mark.parametrize("part", [0.1, 0.5, 0.9])
def test_one_wave_touches_as_westergaard_says(part):
    """H. M. Westergaard, Bearing pressures and cracks, J. Appl. Mech. 6 (1939) A49-A53."""
    amplitude, points = 1e-7, 256
    wave = np.cos(2.0 * np.pi * np.arange(points) / points)
    heights = amplitude * np.repeat(wave[:, None], points, axis=1)
    full = np.pi * MODULUS * amplitude / SIDE
    (found,) = press_surface(heights, SIDE, MODULUS, [part * full])
    # Along the wave a grid cannot see parts of a point.
    expected = 2.0 / np.pi * np.arcsin(np.sqrt(part))
    assert found.area_share == pytest.approx(expected, abs=1.5 / points)
    assert found.contacts == 1


@needs_tamaas
def test_a_wave_is_flat_above_the_pressure_that_flattens_it():
    points, amplitude = 64, 1e-7
    wave = np.cos(2.0 * np.pi * np.arange(points) / points)
    heights = amplitude * np.repeat(wave[:, None], points, axis=1)
    full = np.pi * MODULUS * amplitude / SIDE
    (found,) = press_surface(heights, SIDE, MODULUS, [1.3 * full])
    assert found.area_share == 1.0
    assert found.gap == pytest.approx(0.0, abs=1e-4 * amplitude)


@needs_tamaas
def test_a_small_contact_of_a_summit_is_that_of_hertz():
    points, radius = 256, 5e-4
    place = (np.arange(points) - points // 2) * SIDE / points
    heights = -(place[:, None] ** 2 + place**2) / (2.0 * radius)
    force = 4.0 / 3.0 * MODULUS * (0.08 * SIDE) ** 3 / radius
    (found,) = press_surface(heights, SIDE, MODULUS, [force / SIDE**2])
    assert found.area_share == pytest.approx(np.pi * 0.08**2, rel=0.03)
    assert found.contacts == 1


@needs_tamaas
def test_area_grows_in_proportion_to_small_pressures_and_less_later():
    """Between Persson's theory, (8 / pi)^0.5, and that of Bush, Gibson and Thomas, (2 pi)^0.5."""
    rng = np.random.default_rng(3)
    factors = []
    for _ in range(2):
        heights = rough(256, rng)
        scale = MODULUS * rms_gradient(heights)
        parts = np.array([0.005, 0.01, 0.1])
        found = press_surface(heights, SIDE, MODULUS, parts * scale)
        factors.append([one.area_share / part for one, part in zip(found, parts, strict=True)])
    small, twice, large = np.mean(factors, axis=0)
    assert np.sqrt(8.0 / np.pi) < twice < small < np.sqrt(2.0 * np.pi)
    assert twice == pytest.approx(small, rel=0.1)
    assert large < 0.95 * twice


@needs_tamaas
def test_lengths_and_pressures_have_no_scale_of_their_own():
    heights = rough(64, np.random.default_rng(1))
    pressure = 0.02 * MODULUS * rms_gradient(heights)
    (found,) = press_surface(heights, SIDE, MODULUS, [pressure])
    (other,) = press_surface(1e3 * heights, 1e3 * SIDE, 2.0 * MODULUS, [2.0 * pressure])
    assert other.gap == pytest.approx(1e3 * found.gap, rel=1e-9)
    assert other[2:] == pytest.approx(found[2:], rel=1e-12)


# --- A naive solver -----------------------------------------------------------------------------


def naive_solution(heights, pressure):
    """Pressures, by solving for the touching points until none pulls and none overlaps."""
    points = len(heights)
    waves = np.hypot(*np.meshgrid(*2 * [2.0 * np.pi * np.fft.fftfreq(points, SIDE / points)]))
    response = np.zeros_like(waves)
    response[waves > 0.0] = 2.0 / (MODULUS * waves[waves > 0.0])
    kernel = scipy.fft.ifft2(response).real
    index = np.arange(points)
    shift = (index[:, None] - index) % points
    influence = kernel[shift[:, None, :, None], shift[None, :, None, :]].reshape(points**2, -1)
    z, touching = heights.ravel(), np.ones(points**2, bool)
    for _ in range(200):
        count = touching.sum()
        system = np.ones((count + 1, count + 1))
        system[:-1, :-1], system[-1, -1] = influence[np.ix_(touching, touching)] * MODULUS, 0.0
        known = np.append(z[touching], pressure / MODULUS * points**2)
        solved = np.linalg.solve(system, known)
        pressures = np.zeros(points**2)
        pressures[touching] = solved[:-1] * MODULUS
        # The flat lies where the touching points are.
        gaps = influence @ pressures + solved[-1] - z
        wrong = (pressures < 0.0) | (gaps < -1e-15)
        if not wrong.any():
            return pressures.reshape(points, -1), gaps.reshape(points, -1)
        touching = (touching & (pressures >= 0.0)) | (gaps < -1e-15)
    raise AssertionError("no solution")


@needs_tamaas
def test_gap_and_area_are_those_of_a_naive_solver():
    heights = rough(24, np.random.default_rng(6), shortest=6)
    for part in (0.02, 0.1, 0.3):
        pressure = part * MODULUS * rms_gradient(heights)
        (found,) = press_surface(heights, SIDE, MODULUS, [pressure])
        pressures, gaps = naive_solution(heights, pressure)
        touching = pressures > 0.0
        sides = sum(np.sum(touching ^ np.roll(touching, 1, axis)) for axis in (0, 1))
        area = touching.sum() - (np.pi - 1.0 + np.log(2.0)) / 24.0 * sides
        assert found.gap == pytest.approx(np.mean(gaps), rel=2e-3)
        assert found.area_share == pytest.approx(area / touching.size, abs=1.5 / touching.size)


# --- Line ---------------------------------------------------------------------------------------


def test_a_parabola_of_the_line_carries_the_force_of_hertz():
    """The method of dimensionality reduction halves the radius of a summit."""
    points, radius, depth = 20_000, 5e-3, 1e-8
    place = (np.arange(points) - points // 2) * SIDE / points
    heights = -(place**2) / radius
    touch = np.sqrt(radius * depth)
    gap = np.mean(np.maximum(-depth - heights, 0.0))
    found = press_line(heights, SIDE / points, SIDE, MODULUS, gap)
    force = 4.0 / 3.0 * MODULUS * np.sqrt(radius) * depth**1.5
    assert found.pressure * SIDE**2 == pytest.approx(force, rel=1e-3)
    assert found.area_share * SIDE**2 == pytest.approx(np.pi * touch**2, rel=1e-2)
    assert found.contacts == 1


def test_a_gaussian_line_is_pressed_as_its_distribution_says():
    rng = np.random.default_rng(2)
    count, reach, height = 2**20, 20, 1e-6
    noise = scipy.fft.rfft(rng.standard_normal(count))
    smooth = np.exp(-0.5 * (2.0 * np.pi * np.fft.rfftfreq(count) * reach) ** 2)
    line = scipy.fft.irfft(noise * smooth, count)
    line *= height / np.std(line)
    spacing, level = 1e-7, 1.3
    normal = scipy.stats.norm
    overlap = normal.pdf(level) - level * normal.sf(level)
    found = press_line(line, spacing, SIDE, MODULUS, height * (level + overlap))
    assert found.pressure == pytest.approx(MODULUS * height * overlap / SIDE, rel=0.03)
    # Rice's rate of crossings, for the slope of this spectrum.
    slope = height / (np.sqrt(2.0) * reach * spacing)
    rate = slope / height / (2.0 * np.pi) * np.exp(-0.5 * level**2)
    assert found.contacts == pytest.approx(rate * SIDE, rel=0.03)


def test_a_longer_line_stands_for_more_squares():
    line = rough(64, np.random.default_rng(4)).ravel()
    once = press_line(line, 1e-7, SIDE, MODULUS, 1.5e-6)
    twice = press_line(np.tile(line, 2), 1e-7, SIDE, MODULUS, 1.5e-6)
    assert twice == pytest.approx(once, rel=1e-9)


# --- Without tamaas -------------------------------------------------------------------------------


def test_without_tamaas_one_line_names_the_command(monkeypatch):
    monkeypatch.setitem(sys.modules, "tamaas", None)
    with pytest.raises(
        LubeError, match=r"tamaas is not installed, .*pip install 'lube\[contact\]'"
    ):
        next(press_surface(np.zeros((8, 8)), SIDE, MODULUS, [1e6]))
