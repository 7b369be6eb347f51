"""Rough surfaces: the moments that their line's spectrum prescribes, with a lay and without."""

import numpy as np
import pytest

from lube.contact.strip_film import surface_moments
from lube.errors import DataError
from lube.surfaces.rough_surface import field, rough_surface
from lube.surfaces.synthetic import wave_amplitudes


@pytest.fixture(scope="module")
def spec(make_spec):
    return make_spec(50_000, second_roughness=0.31e-6)


@pytest.fixture(scope="module")
def surface(spec):
    return rough_surface(spec)


@pytest.fixture(scope="module")
def drawn(surface):
    return [surface.draw(np.random.default_rng(seed))[:2] for seed in range(60)]


def test_heights_slopes_and_curvatures_are_those_that_the_line_prescribes(spec, surface, drawn):
    """Slopes in one direction have half the line's mean square, mean curvatures a quarter."""
    squares = []
    for heights, curvatures in drawn:
        heights = heights.astype(float) * spec.height_step
        # By the exact derivative of the waves, as the grid is coarse.
        waves = np.fft.fft2(heights)
        wavenumber = 2.0 * np.pi * np.fft.fftfreq(surface.points[1], surface.spacing[1])
        slope = np.fft.ifft2(1j * wavenumber * waves).real
        curvature = curvatures.astype(float) * spec.height_step
        squares.append([np.mean(one**2) for one in (heights, slope, curvature)])
    found = np.mean(squares, axis=0)
    error = np.std(squares, axis=0, ddof=1) / np.sqrt(len(drawn))
    expected = np.zeros(3)
    for roller in range(2):
        first, amplitudes = wave_amplitudes(spec, roller)
        waves = np.arange(first, first + amplitudes.size)
        wavenumber = 2.0 * np.pi * waves / (spec.points[roller] * spec.spacing)
        powers = np.array([wavenumber**0, wavenumber**2 / 2.0, wavenumber**4 / 4.0])
        expected += powers @ amplitudes**2 / 2.0
    # Rounded to whole waves around the square, the longest waves are a little shorter.
    assert np.all(np.abs(found - expected) < 4.0 * error + 0.02 * expected)
    assert np.all(error < 0.05 * expected)


@pytest.mark.parametrize("angles", [(90.0, 90.0), (0.0, 0.0), (25.0, -60.0)])
def test_a_lay_makes_slopes_differ_as_expected(make_spec, angles):
    second = {"lay_ratio": 4.0, "lay_angle": f"{angles[1]} deg"}
    spec = make_spec(50_000, lay_ratio=2.5, lay_angle=angles[0], second_own=second)
    surface, found = rough_surface(spec), []
    for seed in range(60):
        heights, curvatures, _ = surface.draw(np.random.default_rng(seed))
        heights = heights.astype(float) * spec.height_step
        waves = np.fft.fft2(heights)
        down, along = (
            2j * np.pi * np.fft.fftfreq(*one)
            for one in zip(surface.points, surface.spacing, strict=True)
        )
        down, along = (np.fft.ifft2(one * waves).real for one in (down[:, None], along))
        squares = heights**2, along**2, down**2, along * down
        curvature = 2.0 * curvatures.astype(float) * spec.height_step
        found.append([*map(np.mean, squares), np.mean(curvature**2)])
    error = np.std(found, axis=0, ddof=1) / len(found) ** 0.5
    expected = np.array(surface_moments(spec))
    allowed = 4.0 * error + 0.01 * np.abs(expected)
    assert np.all(np.abs(np.mean(found, axis=0) - expected) < allowed)
    assert np.all(error[[0, 1, 2, 4]] < 0.05 * expected[[0, 1, 2, 4]])
    assert surface.is_mirrored == (angles[0] % 90.0 == 0.0)
    assert np.all(np.array(surface.sides) > 3.9 * 2.0 * np.pi / spec.lines[0].q_min)


def test_the_covariance_is_that_of_drawn_surfaces(surface, drawn):
    known = list(surface.covariances(8, 8, 6))
    for which, covariance in enumerate(known):
        for rows, columns in ((0, 0), (3, 0), (0, -4), (-7, 5)):
            products = [
                np.mean(fields[0] * np.roll(fields[which], (-rows, -columns), (0, 1)), dtype=float)
                for fields in drawn
            ]
            found = np.mean(products) / surface.rms**2
            error = np.std(products, ddof=1) / len(drawn) ** 0.5 / surface.rms**2
            assert abs(found - covariance[8 + rows, 5 + columns]) < 4.0 * error
    np.testing.assert_allclose(known[0], known[0][:, ::-1], atol=1e-6)
    assert known[0][8, 5] == pytest.approx(1.0)


def test_the_surface_is_isotropic(surface):
    heights = next(iter(surface.covariances(0, 40, 41)))[:, 40:]
    np.testing.assert_allclose(heights, heights.T, atol=1e-6)
    for rows, columns in ((3, 4), (6, 8), (24, 32)):  # as far as 5, 10 and 40 along a row
        distance = int(np.hypot(rows, columns))
        assert heights[rows, columns] == pytest.approx(heights[0, distance], abs=0.05)


def test_a_field_is_the_sum_of_its_waves(surface):
    heights, _, waves = surface.draw(np.random.default_rng(7))
    row, column = 77, 31
    down = np.fft.fftfreq(surface.coarse[0], 1.0 / surface.coarse[0])[:, None]
    along = np.arange(waves.shape[1])
    phase = 2.0 * np.pi * (row * down / surface.points[0] + column * along / surface.points[1])
    sums = np.where(along, 2.0, 1.0) * waves.astype(complex) * np.exp(1j * phase)
    assert heights[row, column] == pytest.approx(np.sum(sums).real, abs=1e-3 * surface.rms)


@pytest.mark.parametrize("angle", [0.0, 35.0, 90.0])
def test_the_coarser_grid_has_all_waves(make_spec, angle):
    surface = rough_surface(make_spec(50_000, lay_ratio=3.0, lay_angle=angle))
    has_waves = surface.variances > 0.0
    down = np.abs(np.fft.fftfreq(surface.coarse[0], 1.0 / surface.coarse[0]))
    assert 2.0 * down[has_waves.any(axis=1)].max() < surface.coarse[0] - 1
    assert 2.0 * np.flatnonzero(has_waves.any(axis=0)).max() < surface.coarse[1] - 1


def test_drawn_waves_are_divided_among_the_rollers_by_their_spectra(make_spec):
    surface = rough_surface(make_spec(50_000, second_own={"hurst_exponent": 0.3}))
    squares = []
    for seed in range(40):
        generator = np.random.default_rng(seed)
        waves = surface.draw(generator)[2]
        both = surface.of_each(waves, generator)
        np.testing.assert_allclose(both[0] + both[1], waves, atol=1e-5 * np.abs(waves).max())
        first, second = (field(each, surface.points) for each in both)
        squares.append([np.mean(first**2), np.mean(second**2), np.mean(first * second)])
    part = surface.first_part
    power = np.where(np.arange(part.shape[1]), 2.0, 1.0) * surface.variances
    expected = [np.sum(power * part), np.sum(power * (1.0 - part)), 0.0]
    error = np.std(squares, axis=0, ddof=1) / 40**0.5
    assert np.all(np.abs(np.mean(squares, axis=0) - expected) < 4.0 * error)
    assert error.max() < 0.1 * min(expected[:2])


def test_a_band_too_wide_for_a_grid_is_refused(make_spec):
    wide = make_spec(1_000_000, shortest_wavelength=1e-6)
    with pytest.raises(DataError, match=r"roughness: got a shortest wavelength of 1 µm"):
        rough_surface(wide.model_copy(update={"q_min": wide.q_min / 10.0}))
