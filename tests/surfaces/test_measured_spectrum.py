"""Spectra of measured surfaces: exact theory, known surfaces, drawn lines, refusals."""

from dataclasses import replace

import numpy as np
import pytest
import scipy.fft
from example_surface import rolled_off_surface
from ridges import stretched_map

from lube.errors import DataError
from lube.surfaces.measured_spectrum import (
    line_spectrum,
)
from lube.surfaces.spectra import power_spectrum
from lube.surfaces.spectrum_table import band_table, power_law_integral
from lube.surfaces.topography import Preparation, Topography, prepare
from profiles import line_over_profile, profile_of_line, rms_height

ISOTROPIC, ALONG, LAY = map(Preparation, ("isotropic", "along rolling", "lay"))
LENGTH, ROLL_OFF, RMS = 1e-3, 1e-4, 0.2e-6


def true_line(q, hurst, points=1024, roll_off=ROLL_OFF):
    """Density of the isotropic line, of the rms height that the map's waves have."""
    waves = (
        2
        * np.pi
        / LENGTH
        * np.hypot(*np.meshgrid(scipy.fft.fftfreq(points, 1 / points), np.arange(points // 2 + 1)))
    )

    def shape(vector):
        return np.maximum(vector * roll_off / (2 * np.pi), 1.0) ** (-2 * hurst - 2)

    weights = np.full(points // 2 + 1, 2.0)
    weights[[0, -1]] = 1.0
    whole = np.sum(weights[:, None] * shape(waves)) - 1.0
    surface = RMS**2 / whole * shape(q) / (2 * np.pi / LENGTH) ** 2
    return 2 * np.pi * q * surface


def drawn_map(hurst, seed, points=1024):
    heights = rolled_off_surface(points, LENGTH, hurst, ROLL_OFF, RMS, np.random.default_rng(seed))
    return Topography("map.x3p", heights, (LENGTH / points,) * 2)


def cut(surface, points):
    return replace(surface, heights=surface.heights[:points, :points])


def spectrum_of(surface, settings=ISOTROPIC):
    return line_spectrum(prepare(surface, settings), settings)


def drawn_line(table, length, generator):
    """A periodic line with the table's density, fixed amplitudes and random phases."""
    q, density = table
    waves = 2 * np.pi / length * np.arange(1, int(q[-1] * length / np.pi))
    powers = np.exp(np.interp(np.log(waves), np.log(q), np.log(density))) * waves[0]
    powers[(waves < q[0]) | (waves > q[-1])] = 0.0
    phases = np.exp(2j * np.pi * generator.random(waves.size))
    points = 2 * waves.size + 2
    spectrum = np.concatenate([[0.0], np.sqrt(0.5 * powers) * phases, [0.0]])
    return scipy.fft.irfft(spectrum, points, norm="forward")


# --- Exact theory ------------------------------------------------------------------------


def test_integral_without_a_window_is_the_mean_square():
    heights = np.random.default_rng(1).normal(size=1001)
    heights -= heights.mean()
    wave_vector, density = power_spectrum(heights, 1e-6)
    found = np.sum(density) * wave_vector[0]
    assert found == pytest.approx(np.mean(heights**2), rel=1e-12)


# --- Known surfaces ----------------------------------------------------------------------


@pytest.mark.parametrize("hurst", [0.5, 0.8])
def test_a_map_gives_the_line_of_its_surface(hurst):
    found = [spectrum_of(cut(drawn_map(hurst, seed), 800)) for seed in range(4)]
    true = true_line(found[0].wave_vector, hurst)
    ratios = np.array([each.density / true for each in found])
    error = 1.0 / np.sqrt(len(found) * found[0].estimates)
    away = np.abs(2 * np.pi / found[0].wave_vector / ROLL_OFF - 1.0) > 0.3  # from the kink
    assert np.all(np.abs(ratios.mean(axis=0) - 1.0)[away] < 4.0 * error[away] + 0.03)
    deviations = (ratios / ratios.mean(axis=0) - 1.0) * np.sqrt(found[0].estimates)
    assert 0.5 < np.std(deviations[:, 5:]) < 1.5


def test_profiles_cut_from_it_are_1_75_times_lower():
    """physics-beyond.md, section 12, far above the roll-off of H = 0.7."""
    surface = drawn_map(0.7, 3)
    line = spectrum_of(cut(surface, 900))
    along = spectrum_of(cut(surface, 900), ALONG)
    np.testing.assert_allclose(along.wave_vector[-15:], line.wave_vector[-15:], rtol=0.02)
    q = along.wave_vector
    wide = np.geomspace(1e3, 2 * np.pi * 1024 / LENGTH, 4000)
    expected = np.interp(q, wide, profile_of_line(wide, true_line(wide, 0.7)))
    inside = (q > 3e5) & (q < 1e6)
    np.testing.assert_allclose(along.density[inside], expected[inside], rtol=0.25)
    ratio = np.exp(np.interp(np.log(q), np.log(line.wave_vector), np.log(line.density)))
    assert np.mean(ratio[inside] / along.density[inside]) == pytest.approx(
        line_over_profile(0.7), rel=0.03
    )


@pytest.mark.parametrize(
    "hurst", [0.7, *(pytest.param(hurst, marks=pytest.mark.slow) for hurst in (0.5, 0.9))]
)
def test_profiles_go_back_to_the_line_of_their_surface(hurst):
    """Means over profiles drawn from the exact spectrum; the bench has the whole table."""
    points, spacing = 8000, 0.5e-6
    wide = np.geomspace(1e2, 1e8, 3000)
    line = wide * np.maximum(wide * 1e-4 / (2 * np.pi), 1.0) ** (-2 * hurst - 2)
    line *= RMS**2 / power_law_integral(wide, line)
    waves = 2 * np.pi / (8 * points * spacing) * np.arange(1, 4 * points)
    powers = np.interp(waves, wide, profile_of_line(wide, line)) * waves[0]
    found = []
    for seed in range(20):
        normal = np.random.default_rng(seed).standard_normal((waves.size, 2)) @ [1.0, 1.0j]
        spectrum = np.append(0.0, np.sqrt(powers / 4) * normal)
        heights = scipy.fft.irfft(spectrum, 8 * points, norm="forward")[:points]
        found.append(spectrum_of(Topography("profile.csv", heights, (spacing,))))
    q = found[0].wave_vector
    ratio = np.mean([each.density for each in found], axis=0) / np.interp(q, wide, line)
    short = q > 2 * np.pi / 30e-6
    assert np.mean(ratio[short]) == pytest.approx(1.0, abs=0.04)
    rms = np.mean([rms_height(each) ** 2 for each in found]) ** 0.5
    assert rms == pytest.approx(RMS, rel=0.05)


def test_filters_of_a_profile_become_those_of_the_surface():
    generator = np.random.default_rng(4)
    heights = np.cumsum(generator.normal(size=20000))
    profile = Topography("profile.csv", heights, (1e-6,))
    plain = spectrum_of(profile)
    filtered = spectrum_of(profile, replace(ISOTROPIC, long_cutoff=1e-3, short_cutoff=1e-5))
    assert 2 * np.pi / filtered.wave_vector[-1] > 1e-5
    size = filtered.wave_vector.size
    short = slice(size - 20, size)
    np.testing.assert_allclose(
        filtered.density[short], (plain.density[:size] * filtered.transfer)[short], rtol=0.1
    )


# --- The measured rms height -------------------------------------------------------------


@pytest.mark.parametrize("texture", ["isotropic", "along rolling"])
def test_drawn_lines_have_the_measured_rms_height(texture):
    """To 1 %: of a filtered map, whose waves are all in the band."""
    settings = Preparation(texture, long_cutoff=LENGTH / 8)
    surface = prepare(cut(drawn_map(0.8, 6), 800), settings)
    spectrum = line_spectrum(surface, settings)
    band = spectrum.wave_vector[[0, -1]]
    generator = np.random.default_rng(9)
    drawn = [np.std(drawn_line(band_table(spectrum, *band), 0.1, generator)) for _ in range(3)]
    assert drawn == pytest.approx([rms_height(spectrum)] * 3, rel=1e-3)
    assert drawn[0] == pytest.approx(np.std(surface.heights), rel=0.01)


def test_drawn_lines_have_the_rms_height_of_a_narrower_band():
    spectrum = spectrum_of(cut(drawn_map(0.8, 7), 800))
    band = 2 * np.pi / 2e-4, 2 * np.pi / 1e-5
    line = drawn_line(band_table(spectrum, *band), 0.1, np.random.default_rng(2))
    inside = (spectrum.wave_vector > band[0]) & (spectrum.wave_vector < band[1])
    assert np.std(line) == pytest.approx(rms_height(spectrum, *band), rel=1e-3)
    near = np.trapezoid(spectrum.density[inside], spectrum.wave_vector[inside]) ** 0.5
    assert np.std(line) == pytest.approx(near, rel=0.05)


# --- Surfaces with a lay -------------------------------------------------------------------


@pytest.mark.parametrize("settings", [LAY, replace(LAY, long_cutoff=3e-4)])
def test_the_spectrum_of_ridges_is_that_of_the_surface_that_is_stretched(settings):
    ratios = []
    for seed in range(4):
        surface, density = stretched_map(4.0, 30.0, seed)
        found = spectrum_of(surface, settings)
        q = found.wave_vector
        seen = (q > 2 * np.pi / 3e-4) & (found.transfer > 0.3)
        ratios.append(np.mean(found.density[seen] / found.transfer[seen] / density(q[seen])))
    assert np.mean(ratios) == pytest.approx(1.0, abs=0.08)


# --- Refusals ----------------------------------------------------------------------------


def test_a_ground_surface_is_not_isotropic():
    heights = np.cumsum(np.random.default_rng(1).normal(size=(256, 256)), axis=0)
    ground = Topography("ground.x3p", heights, (1e-6, 1e-6))
    with pytest.raises(DataError, match=r"ground.x3p: got an anisotropy of 0\.\d+, the lay at 0 d"):
        spectrum_of(ground)
    assert np.all(spectrum_of(ground, ALONG).density > 0.0)
    profile = Topography("profile.x3p", heights[0], (1e-6,))
    with pytest.raises(DataError, match=r"profile.x3p: got a profile, need a map for the texture"):
        spectrum_of(profile, LAY)


def test_a_flat_surface_has_no_spectrum():
    for texture, shape in ((ALONG, (500,)), (ALONG, (100, 100)), (LAY, (100, 100))):
        flat = Topography("flat.nc", np.full(shape, 1e-3), (1e-6,) * len(shape))
        with pytest.raises(DataError, match=r"flat.nc: got heights that are all alike"):
            spectrum_of(flat, texture)


def test_resolution_and_short_cutoff_end_the_spectrum():
    surface = cut(drawn_map(0.8, 1, 512), 400)
    for changed, settings, shortest in (
        (surface, ISOTROPIC, 4 * surface.spacing[0]),
        (replace(surface, resolution=2e-5), ISOTROPIC, 2e-5),
        (surface, replace(ISOTROPIC, short_cutoff=3e-5), 3e-5),
    ):
        end = 2 * np.pi / spectrum_of(changed, settings).wave_vector[-1]
        assert shortest <= end < 1.3 * shortest
