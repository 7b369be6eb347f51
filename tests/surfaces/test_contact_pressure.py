"""Pressure of rough surfaces against their gap: limits, and a numerical solution."""

import numpy as np
import pytest
import scipy.special

from lube.errors import StudyError
from lube.surfaces.contact_pressure import contact_pressure
from lube.surfaces.elastic_contact import press_surface
from lube.surfaces.rough_surface import rough_surface
from lube.surfaces.spectra import pair_moments
from lube.surfaces.synthetic import wave_amplitudes

MODULUS = 115e9


@pytest.fixture
def spec(make_spec):
    return make_spec(points=20_000, longest_wavelength=4e-4, shortest_wavelength=5e-5)


def moments(spec):
    """Rms height, m, and rms gradient of both surfaces together."""
    variances, slopes = pair_moments(spec)[:2]
    return np.sqrt(variances), np.sqrt(slopes)


def test_surfaces_far_apart_press_by_half_of_the_area_above_the_gap(spec):
    rms, gradient = moments(spec)
    gap = np.array([3.5, 5.0, 20.0])
    area = 0.5 * scipy.special.ndtr(-gap)
    expected = MODULUS * gradient / np.sqrt(2.0 * np.pi) * area
    np.testing.assert_allclose(contact_pressure(spec, MODULUS, gap * rms), expected, rtol=0.1)


def test_pressure_rises_without_a_jump_as_the_gap_closes(spec, make_spec):
    gaps = np.linspace(6.0, 0.05, 2000) * np.hypot(*spec.rms_height)
    steps = np.diff(np.log(contact_pressure(spec, MODULUS, gaps)))
    assert np.all((steps > 0.0) & (steps < 0.05))
    finer = make_spec(points=200_000, longest_wavelength=4e-4, shortest_wavelength=5e-6)
    steps = np.diff(np.log(contact_pressure(finer, MODULUS, gaps)))
    assert np.all((steps > 0.0) & (steps < 0.05))
    assert np.isnan(contact_pressure(spec, MODULUS, np.array([np.nan]))[0])


def test_pressure_is_that_of_the_theory_where_surfaces_touch_at_many_places(make_spec):
    """Its integrals over a self-affine spectrum, on grids far finer than the package's."""
    spec = make_spec(points=200_000, longest_wavelength=4e-4, shortest_wavelength=5e-6)
    rms, gradient = moments(spec)
    logarithm = np.linspace(*np.log([spec.q_min, spec.q_max]), 4001)
    q, exponent = np.exp(logarithm), 2.0 - 2.0 * spec.lines[0].hurst_exponent
    variance = rms**2 * (2.0 - exponent) * q ** (exponent - 2.0)  # of all waves, per ln q
    variance /= spec.q_min ** (exponent - 2.0) - spec.q_max ** (exponent - 2.0)
    slopes = scipy.integrate.cumulative_trapezoid(variance * q**2, logarithm, initial=0.0)
    w = np.sqrt(2.0 / np.maximum(slopes, 1e-9 * slopes[1]))[:, None]
    for part in (0.01, 0.003):
        pressure = np.geomspace(part * gradient, 20.0 * gradient, 4000)
        share = 0.36 + 1.92 * scipy.special.erf(w * pressure) ** 2
        above = np.trapezoid(share * np.exp(-((w * pressure) ** 2)), np.log(pressure), axis=1)
        gap = np.trapezoid(variance * q * w[:, 0] * above, logarithm) / (2.0 * np.sqrt(np.pi))
        assert 1.5 * rms < gap < 2.4 * rms
        expected = MODULUS * pressure[0]
        assert contact_pressure(spec, MODULUS, gap) == pytest.approx(expected, rel=0.01)


PRESSURES = np.array([0.003, 0.01, 0.03, 0.1])
"""Pressures of numerical solutions, over E* times the rms gradient."""
SOLVED = {
    8: (2.152, 1.679, 1.192, 0.625),
    16: (2.119, 1.636, 1.137, 0.564),
    32: (2.089, 1.565, 1.052, 0.490),
}
"""Mean gaps over the rms height at these pressures, by the ratio of the longest wave to the
shortest: `solved_gaps` for seeds 0 to 3, known to 0.002 to 0.03."""


def solved_gaps(make_spec, ratio, seeds):
    """Solve for the mean gaps, over the rms height, on squares of six longest waves."""
    points = 2_500 * ratio
    spec = make_spec(points, longest_wavelength=4e-4, shortest_wavelength=4e-4 / ratio)
    pressures, gaps = MODULUS * moments(spec)[1] * PRESSURES, []
    surface = rough_surface(spec, waves=6)
    for seed in seeds:
        heights = surface.draw(np.random.default_rng(seed))[0].astype(float) * spec.height_step
        pressed = press_surface(heights, surface.sides[0], MODULUS, pressures)
        gaps.append([contact.gap / np.std(heights) for contact in pressed])
    return np.mean(gaps, axis=0)


@pytest.mark.parametrize(
    ("ratio", "seeds"), [(8, range(4)), pytest.param(16, range(2), marks=pytest.mark.slow)]
)
def test_the_stored_gaps_are_those_of_numerical_solutions(make_spec, ratio, seeds):
    np.testing.assert_allclose(solved_gaps(make_spec, ratio, seeds), SOLVED[ratio], atol=0.06)


@pytest.mark.parametrize("ratio", SOLVED)
def test_pressure_is_that_of_numerical_solutions(make_spec, ratio):
    spec = make_spec(2_500 * ratio, longest_wavelength=4e-4, shortest_wavelength=4e-4 / ratio)
    rms, gradient = moments(spec)
    found = contact_pressure(spec, MODULUS, rms * np.array(SOLVED[ratio]))
    np.testing.assert_allclose(found / (MODULUS * gradient), PRESSURES, rtol=0.15)


def test_ridges_press_as_somewhat_longer_ones(make_spec):
    """Also at ratios of 70 and 80, where the line's longest wave happens to have no height."""
    lay = {"longest_wavelength": 4e-4, "shortest_wavelength": 5e-5, "lay_angle": 0.0}
    specs = [make_spec(20_000, lay_ratio=ratio, **lay) for ratio in (60.0, 70.0, 80.0, 90.0)]
    assert [wave_amplitudes(spec, 0)[1][0] > 0.0 for spec in specs] == [True, False, False, True]
    gaps = np.array([0.5, 1.0, 2.0, 4.0]) * moments(specs[0])[0]
    first, *others = (contact_pressure(spec, MODULUS, gaps) for spec in specs)
    for other in others:
        np.testing.assert_allclose(other, first, rtol=0.01)


def test_lines_that_do_not_stand_for_a_gaussian_surface_are_refused(make_spec):
    with pytest.raises(StudyError, match="need 0 and 3"):
        contact_pressure(make_spec(20_000, kurtosis=4.0), MODULUS, np.array([1e-6]))
