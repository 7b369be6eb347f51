"""Roughness lines: spectrum by theory, then independence, then stored numbers."""

import numpy as np
import pytest
import scipy.special
import scipy.stats

from lube.kernels.runs import find_runs
from lube.surfaces.spectra import line_moments, spectrum_moments
from lube.surfaces.synthetic import draw_line, draw_realisation, wave_amplitudes
from lube.surfaces.translation import NODES, REACH, gaussian_power, johnson_curve

SEED = 20181109
REALISATIONS = 40


@pytest.fixture(scope="module")
def spec(make_spec):
    return make_spec(100_000)


@pytest.fixture(scope="module")
def unequal(make_spec):
    """Rollers of other radius and other roughness."""
    return make_spec(50_000, second_radius=0.037, second_roughness=0.31e-6)


@pytest.fixture(scope="module")
def pairs(spec):
    """Many realisations, in height steps, shape (realisation, roller, N)."""
    return np.array([draw_realisation(spec, SEED, r) for r in range(REALISATIONS)])


def measured_amplitudes(line, height_step):
    """Amplitude of every whole number of waves around a line, m."""
    return 2.0 / line.size * height_step * np.abs(np.fft.rfft(line))


def band(spec, roller):
    """Whole numbers of waves k around the roller with q_min <= k / R <= q_max, from the paper."""
    radius = spec.points[roller] * spec.spacing / (2.0 * np.pi)
    k = np.arange(spec.points[roller] // 2 + 1)
    slack = 1e-9 * spec.q_max  # q_max itself is a whole number of waves
    return k[(k / radius >= spec.q_min) & (k / radius <= spec.q_max + slack)], radius


def four_standard_errors(values):
    return 4.0 * np.std(values, ddof=1) / np.sqrt(len(values))


# --- Spectrum ----------------------------------------------------------------------------


def test_rms_height_is_exactly_the_rollers_and_the_mean_is_zero_up_to_rounding(spec, unequal):
    for each in (spec, unequal):
        for realisation in range(5):
            for line, rms in zip(
                draw_realisation(each, SEED, realisation), each.rms_height, strict=True
            ):
                found = np.sqrt(np.mean(line.astype(float) ** 2)) * each.height_step
                assert found == pytest.approx(rms, rel=1e-6)
                # Rounding errors of 1/12 step^2, independent from point to point.
                assert abs(line.mean()) < 5.0 * np.sqrt(1.0 / 12.0 / line.size)


def test_waves_within_the_band_have_their_amplitudes_and_all_others_are_zero(spec, unequal):
    for each, roller in ((spec, 0), (unequal, 0), (unequal, 1)):
        inside, radius = band(each, roller)
        power_law = (inside / radius) ** (-2.0 * each.lines[roller].hurst_exponent - 1.0)  # C1D
        variance = each.rms_height[roller] ** 2 * power_law / power_law.sum()
        expected = np.zeros(each.points[roller] // 2 + 1)
        expected[inside] = np.sqrt(2.0 * variance)
        line = draw_realisation(each, SEED, 2)[roller]
        # Rounding is white noise of 1/12 step^2, shared out among N/2 waves.
        noise = each.height_step * np.sqrt(2.0 / 12.0 * 2.0 / line.size)
        found = measured_amplitudes(line, each.height_step)
        np.testing.assert_allclose(found, expected, rtol=2e-6, atol=6.0 * noise)
        assert expected[inside].min() > 100.0 * noise  # so the band stands out


def test_spectrum_falls_with_the_power_2h_plus_1(make_spec):
    for hurst_exponent in (0.3, 0.7, 1.0 - 1e-9):
        spec = make_spec(100_000, hurst_exponent=hurst_exponent)
        inside, radius = band(spec, 0)
        line = draw_realisation(spec, SEED, 0)[0]
        power = measured_amplitudes(line, spec.height_step)[inside] ** 2
        slope, _ = np.polyfit(np.log(inside / radius), np.log(power), 1)
        assert slope == pytest.approx(-2.0 * hurst_exponent - 1.0, abs=1e-3)


def test_band_is_the_papers_and_includes_its_limits(make_spec, spec, study):
    first, amplitudes = wave_amplitudes(spec, 0)
    perimeter = 2.0 * np.pi * study.rollers.first.radius
    width = 2.0 * study.rollers.contact_half_width(1600.0)
    assert perimeter / first <= width < perimeter / (first - 1)
    assert first + amplitudes.size - 1 == 100_000 // 10
    for waves in range(700, 800):
        whole = make_spec(50_000, longest_wavelength=perimeter / waves)
        first, amplitudes = wave_amplitudes(whole, 0)
        assert (first, first + amplitudes.size - 1) == (waves, 5000)


def test_finest_wave_has_more_than_two_points(make_spec):
    """The height of a wave of two points would depend on its phase, and the rms with it."""
    spec = make_spec(4096, shortest_wavelength="2.0 points")
    first, amplitudes = wave_amplitudes(spec, 0)
    assert first + amplitudes.size - 1 == 2047
    rms = [np.sqrt(np.mean(draw_realisation(spec, SEED, r)[0] ** 2.0)) for r in range(5)]
    np.testing.assert_allclose(np.array(rms) * spec.height_step, spec.rms_height[0], rtol=1e-6)


def test_density_of_the_surface_is_constant_below_the_roll_off(make_spec):
    spec = make_spec(100_000, roll_off_wavelength=1e-4)
    rms, gaussian = 2e-7, make_spec(100_000)
    first, amplitudes = wave_amplitudes(spec, 0)
    q = np.arange(first, first + amplitudes.size) / 0.05  # radius of 50 mm
    surface = amplitudes**2 / q  # C2D = C1D / (pi q)
    below = q < 2.0 * np.pi / 1e-4
    np.testing.assert_allclose(surface[below] / surface[below][0], 1.0, rtol=1e-9)
    expected = (q[~below] * 1e-4 / (2.0 * np.pi)) ** -3.4  # 2 H + 2
    np.testing.assert_allclose(surface[~below] / surface[0], expected, rtol=1e-9)
    assert np.sqrt(0.5 * np.sum(amplitudes**2)) == pytest.approx(rms, rel=1e-12)
    longest = 2.0 * np.pi / spec.q_min
    same = make_spec(100_000, roll_off_wavelength=longest)
    np.testing.assert_array_equal(wave_amplitudes(same, 0)[1], wave_amplitudes(gaussian, 0)[1])


def test_each_roller_has_a_spectrum_of_its_own(make_spec):
    own = {"hurst_exponent": 0.4, "longest_wavelength": "0.2 mm", "shortest_wavelength": "20 um"}
    both, same = make_spec(50_000, second_own=own), make_spec(50_000)
    first, amplitudes = wave_amplitudes(both, 1)
    assert (first, first + amplitudes.size - 1) == (1571, 15707)
    slope, _ = np.polyfit(np.log(first + np.arange(amplitudes.size)), np.log(amplitudes), 1)
    assert slope == pytest.approx(-0.9)
    lines, others = draw_realisation(both, SEED, 1), draw_realisation(same, SEED, 1)
    np.testing.assert_array_equal(lines[0], others[0])
    assert np.std(lines[1]) == pytest.approx(np.std(others[1]), rel=1e-6)


# --- Distribution and independence -------------------------------------------------------


def test_heights_are_as_gaussian_as_the_number_of_waves_allows(spec, pairs):
    # The fourth cumulant of a cos(phase) is -3/8 a^4, and cumulants of independent waves add.
    _, amplitudes = wave_amplitudes(spec, 0)
    expected = 3.0 - 0.375 * np.sum(amplitudes**4) / spec.rms_height[0] ** 4
    z = pairs.reshape(-1, pairs.shape[-1]) * spec.height_step / spec.rms_height[0]
    kurtosis, skewness = np.mean(z**4, axis=-1), np.mean(z**3, axis=-1)
    assert np.mean(kurtosis) == pytest.approx(expected, abs=four_standard_errors(kurtosis))
    assert np.mean(skewness) == pytest.approx(0.0, abs=four_standard_errors(skewness))


def test_rollers_and_realisations_are_independent(spec, pairs):
    # Of two lines with phases apart by p_k: sum a_k^2 cos(p_k) / sum a_k^2.
    _, amplitudes = wave_amplitudes(spec, 0)
    scatter = np.sqrt(0.5 * np.sum(amplitudes**4)) / np.sum(amplitudes**2)
    lines = pairs.astype(float)
    for first, second in (
        (lines[:, 0], lines[:, 1]),
        (lines[:-1, 0], lines[1:, 0]),
        (lines[:-1, 0], lines[1:, 1]),
        (lines[:-1, 1], lines[1:, 0]),
    ):
        squares = np.sum(first**2, axis=-1) * np.sum(second**2, axis=-1)
        found = np.sum(first * second, axis=-1) / np.sqrt(squares)
        assert abs(found.mean()) < 4.0 * scatter / np.sqrt(found.size)
        assert found.std() == pytest.approx(scatter, rel=4.0 / np.sqrt(2.0 * found.size))


def test_realisation_depends_on_study_seed_and_its_number_only(make_spec):
    spec = make_spec(5000, shortest_wavelength="3.0 points")
    children = np.random.SeedSequence((SEED, 5)).spawn(2)
    for roller, line in enumerate(draw_realisation(spec, SEED, 5)):
        np.testing.assert_array_equal(line, draw_line(spec, roller, children[roller]))
    drawn = [draw_realisation(spec, *pair)[0] for pair in [(0, 1), (1, 0), (1, 1), (0, 0)]]
    assert len({line.tobytes() for line in drawn}) == 4


@pytest.fixture(scope="module")
def run_in(make_spec):
    """Lines of the skewness and kurtosis of worn surfaces, and many realisations of them."""
    spec = make_spec(100_000, skewness=-1.0, kurtosis=5.0)
    return spec, np.array([draw_realisation(spec, SEED, r) for r in range(REALISATIONS)])


def test_worn_lines_have_their_rms_exactly_and_their_moments_on_average(run_in):
    spec, pairs = run_in
    lines = pairs.reshape(-1, pairs.shape[-1])
    moments = [line_moments(line * spec.height_step, spec.spacing) for line in lines]
    rms = [one["rms_height"] for one in moments]
    np.testing.assert_allclose(rms, spec.rms_height[0], rtol=1e-6)
    assert np.abs(lines.mean(axis=1)).max() < 0.01
    for name, prescribed, tolerance in (("skewness", -1.0, 0.02), ("kurtosis", 5.0, 0.1)):
        found = np.array([one[name] for one in moments])
        error = four_standard_errors(found)
        assert found.mean() == pytest.approx(prescribed, abs=error + 0.25 * tolerance)
        assert error < 8.0 * tolerance


def test_worn_lines_keep_the_spectrum_on_average(run_in):
    spec, pairs = run_in
    first, amplitudes = wave_amplitudes(spec, 0)
    lines = pairs.reshape(-1, pairs.shape[-1])
    power = np.mean([measured_amplitudes(line, spec.height_step) ** 2 for line in lines], axis=0)
    band = power[first : first + amplitudes.size] / amplitudes**2
    assert power[1:first].sum() / power[1:].sum() == pytest.approx(0.0125, abs=0.001)
    parts = [part.mean() for part in np.array_split(band, 20)]
    np.testing.assert_allclose(parts, 1.0 - 0.0125, rtol=0.02)


def test_worn_lines_rise_above_a_height_as_often_as_theory_says(run_in):
    """A translation crosses a height where its Gaussian line crosses the height before."""
    spec, pairs = run_in
    curve = johnson_curve(-1.0, 5.0)
    first, amplitudes = wave_amplitudes(spec, 0)
    weights = gaussian_power(amplitudes**2, first, spec.points[0], curve)
    waves = np.arange(first, first + weights.size)
    lag_one = np.sum(weights * np.cos(2.0 * np.pi * waves / spec.points[0]))
    slope = np.sqrt((1.0 - lag_one) / (1.0 + lag_one))
    lines = pairs.reshape(-1, pairs.shape[-1])
    for height in (-2.0, 0.0, 1.0, 1.5):
        before = np.interp(height, curve, np.linspace(-REACH, REACH, NODES))
        expected = 2.0 * scipy.special.owens_t(before, slope) * spec.points[0]
        above = lines > height * spec.rms_height[0] / spec.height_step
        found = np.sum(above & ~np.roll(above, 1, axis=1), axis=1)
        assert found.mean() == pytest.approx(expected, abs=four_standard_errors(found))
        share = scipy.stats.norm.sf(before)
        assert above.mean() == pytest.approx(share, abs=four_standard_errors(above.mean(axis=1)))


def test_worn_lines_are_the_same_in_any_order_and_for_equal_rollers(run_in, make_spec):
    spec, pairs = run_in
    for number in (3, 0, 3):
        np.testing.assert_array_equal(draw_realisation(spec, SEED, number), pairs[number])
    own = {"skewness": -1.0, "kurtosis": 5.0}
    mixed = make_spec(100_000, second_own=own)
    first, second = draw_realisation(mixed, SEED, 3)
    np.testing.assert_array_equal(first, draw_realisation(make_spec(100_000), SEED, 3)[0])
    np.testing.assert_array_equal(second, pairs[3, 1])


def test_stored_worn_line(run_in):
    # Drawn when this test was written: if it changes, so do the results of such studies.
    np.testing.assert_allclose(run_in[1][0, 0, :4], [-28850, -12207, 7666, 29910], rtol=0, atol=2)


def test_lines_close_around_the_roller_without_a_step(pairs, spec):
    limit = 6.0 * spectrum_moments(spec, 0)["rms_slope"] * spec.spacing / spec.height_step
    assert np.abs(pairs[..., 0] - pairs[..., -1]).max() < limit


def test_stored_realisation(make_spec):
    # Drawn when this test was written: if it changes, so do the results of every study.
    first, second = draw_realisation(make_spec(20_000), SEED, 0)
    np.testing.assert_allclose(first[:4], [-113239, -60932, -200, 50661], rtol=0, atol=2)
    np.testing.assert_allclose(second[:4], [-205523, -128052, -17898, 106735], rtol=0, atol=2)


# --- Segments of the sum of two lines: exact theory for Gaussian lines -------------------


@pytest.fixture(scope="module")
def composites(make_spec):
    """Sums of both lines as fine as the paper's, and their spectrum."""
    spec = make_spec(1_000_000)
    drawn = (draw_realisation(spec, SEED, r) for r in range(12))
    return spec, [first + second for first, second in drawn]


def upcrossings_per_step(spec, film):
    """Exact for a Gaussian line on a grid: P(z_i <= h < z_i+1) = 2 T(h, sqrt((1-r)/(1+r)))."""
    first, amplitudes = wave_amplitudes(spec, 0)
    waves = np.arange(first, first + amplitudes.size)
    weights = amplitudes**2 / np.sum(amplitudes**2)
    lag_one = np.sum(weights * np.cos(2.0 * np.pi * waves / spec.points[0]))
    sigma = np.hypot(*spec.rms_height)
    return 2.0 * scipy.special.owens_t(film / sigma, np.sqrt((1.0 - lag_one) / (1.0 + lag_one)))


def rice_rate(spec, film):
    """Rice's up-crossings of a Gaussian line per length, nu+ (physics.md, section 6)."""
    heights, slopes = (
        np.hypot(*(spectrum_moments(spec, roller)[name] for roller in (0, 1)))
        for name in ("rms_height", "rms_slope")
    )
    return slopes / heights / (2.0 * np.pi) * np.exp(-0.5 * (film / heights) ** 2)


def count_runs(line, film):
    starts, stops = np.zeros(1, np.int64), np.full(1, line.size)
    capacity = line.size // 2 + 1
    return find_runs(line, film, (starts, stops), 1, tuple(np.empty((2, capacity), np.int64)))


def test_number_of_segments_and_their_mean_length_agree_with_theory(composites):
    spec, lines = composites
    perimeter = spec.points[0] * spec.spacing
    for film in (0.0, 0.3e-6, 0.6e-6, 0.8e-6):
        film_steps = round(film / spec.height_step)
        segments = np.array([count_runs(line, film_steps) for line in lines])
        expected = spec.points[0] * upcrossings_per_step(spec, film)
        assert segments.mean() == pytest.approx(expected, abs=four_standard_errors(segments))
        assert expected == pytest.approx(rice_rate(spec, film) * perimeter, 0.02)
        share = np.array([np.mean(line > film_steps) for line in lines])  # of a window's points
        above = scipy.stats.norm.sf(film / np.hypot(*spec.rms_height))
        assert share.mean() == pytest.approx(above, abs=four_standard_errors(share) + 1e-12)
        excess = share * spec.points[0] - above * spec.points[0] / expected * segments
        assert excess.mean() == pytest.approx(0.0, abs=four_standard_errors(excess))  # mean length


def test_number_of_segments_agrees_with_another_implementation(composites):
    # physics.md, section 6: 40 seeds of another implementation, and Rice's formula.
    spec, lines = composites
    for film, measured, predicted in ((3e5, 2741, 2753), (6e5, 506, 509), (8e5, 87, 88)):
        segments = np.array([count_runs(line, int(film)) for line in lines])
        # The other implementation's standard error is at most about this one's.
        error = np.sqrt(2.0) * four_standard_errors(segments)
        assert segments.mean() == pytest.approx(measured, abs=error)
        expected = rice_rate(spec, film * spec.height_step) * spec.points[0] * spec.spacing
        assert expected == pytest.approx(predicted, abs=0.006 * predicted)
