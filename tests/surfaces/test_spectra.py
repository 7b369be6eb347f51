"""Spectra and moments of lines: by theory, and as drawn lines have them."""

import numpy as np
import pytest
import scipy.stats

from lube.surfaces.spectra import line_attributes, line_moments, power_spectrum, spectrum_moments
from lube.surfaces.synthetic import draw_realisation

SEED = 20181109


@pytest.fixture(scope="module")
def unequal(make_spec):
    """Rollers of other radius and other roughness."""
    return make_spec(50_000, second_radius=0.037, second_roughness=0.31e-6)


def test_power_spectrum_is_the_papers_and_holds_the_mean_square_height(unequal):
    for line in draw_realisation(unequal, SEED, 0):
        heights = line * unequal.height_step
        wave_vector, density = power_spectrum(heights, unequal.spacing)
        np.testing.assert_allclose(np.diff(wave_vector), wave_vector[0], rtol=1e-9)
        power = np.sum(density) * wave_vector[0]  # Parseval
        assert power == pytest.approx(np.mean(heights**2), rel=1e-9)
        q = 2.0 * np.pi * np.arange(1, wave_vector.size + 1) / (line.size * unequal.spacing)
        np.testing.assert_allclose(wave_vector, q, rtol=1e-9)
        inside = (q >= unequal.q_min) & (q <= unequal.q_max * (1.0 + 1e-9))
        found, q = density[inside], q[inside]
        scale = found[0] * q[0] ** 2.4  # H = 0.7
        np.testing.assert_allclose(found, scale * q**-2.4, rtol=1e-3)


def test_moments_are_those_of_the_heights_and_of_the_spectrum(unequal):
    dx = unequal.spacing
    for roller, line in enumerate(draw_realisation(unequal, SEED, 3)):
        z = line * unequal.height_step
        slope = (np.append(z[1:], z[0]) - z) / dx
        curvature = (np.append(z[1:], z[0]) - 2.0 * z + np.append(z[-1], z[:-1])) / dx**2
        found = line_moments(z, dx)
        assert found == pytest.approx(
            {
                "rms_height": np.std(z),
                "rms_slope": np.std(slope),
                "rms_curvature": np.std(curvature),
                "skewness": scipy.stats.skew(z),
                "kurtosis": scipy.stats.kurtosis(z, fisher=False),
            },
            rel=1e-6,
            abs=1e-6,
        )
        expected = spectrum_moments(unequal, roller)
        assert {name: found[name] for name in expected} == pytest.approx(expected, rel=1e-5)


def test_attributes_are_single_values_where_both_rollers_have_the_same(make_spec):
    own = {"hurst_exponent": 0.4, "longest_wavelength": "0.2 mm", "shortest_wavelength": "20 um"}
    both, same = make_spec(50_000, second_own=own), make_spec(50_000)
    attributes = line_attributes(both)
    assert attributes["hurst"].tolist() == [0.7, 0.4]
    assert line_attributes(same)["hurst"] == 0.7
    assert both.q_min == same.q_min < attributes["q_min"][1]
