"""Contact at any rarity: exact probabilities of few points, then counting."""

import numpy as np
import pytest
import scipy.stats

from lube.errors import StudyError
from lube.surfaces.rare_contact import draw_pair, rare_contact, sum_of_lines

SEED = 7
FACTOR = 0.0223
PAIRS = 8


@pytest.fixture(scope="module")
def spec(make_spec):
    return make_spec(100_000)


@pytest.fixture(scope="module")
def unequal(make_spec):
    return make_spec(50_000, second_radius=0.037, second_roughness=0.31e-6)


def estimates(spec, ratios, widths, factor=FACTOR):
    """Mean over pairs of lines, and its standard error, of windows and runs."""
    films = np.asarray(ratios) * sum_of_lines(spec, 2)[0]
    found = [rare_contact(spec, SEED, r, films, np.asarray(widths), factor) for r in range(PAIRS)]
    for each in zip(*found, strict=True):
        yield np.mean(each, axis=0), np.std(each, axis=0, ddof=1) / np.sqrt(PAIRS)


def within(found, expected, errors=4.0):
    mean, error = found
    return np.all(np.abs(mean - expected) <= errors * error)


# --- Exact theory ------------------------------------------------------------------------


def test_lines_have_the_covariance_of_their_spectrum(unequal):
    """Mean products over draws of both lines, and no correlation between them."""
    lags = np.array([0, 3, 20, 100])
    rms, covariances = sum_of_lines(unequal, 200)
    products = []
    for number in range(30):
        lines, _ = draw_pair(unequal, SEED, number)
        each = [[np.mean(line * np.roll(line, lag)) for lag in lags] for line in lines]
        size = min(unequal.points)
        products.append([*each, [np.mean(lines[0][:size] * lines[1][:size])] * 4])
    found = np.mean(products, axis=0) / rms**2
    error = np.std(products, axis=0, ddof=1) / np.sqrt(30) / rms**2
    expected = [covariance[lags] for covariance in covariances] + [np.zeros(4)]
    assert np.all(np.abs(found - expected) < 4.0 * error)
    assert np.max(error) < 0.01


@pytest.mark.parametrize("ratio", [0.5, 3.0, 8.0])
def test_a_window_of_one_point_has_the_gaussian_tail(spec, ratio):
    (mean, _), _ = estimates(spec, [ratio], [1])
    assert mean[0, 0] == pytest.approx(scipy.stats.norm.sf(ratio), rel=1e-6)


@pytest.mark.parametrize("ratio", [0.5, 2.0, 5.0])
def test_a_window_of_two_points_and_the_start_of_a_run_have_the_bivariate_tails(spec, ratio):
    correlation = sum(sum_of_lines(spec, 2)[1])[1]
    both = scipy.stats.multivariate_normal([0.0, 0.0], [[1.0, correlation], [correlation, 1.0]])
    one, together = scipy.stats.norm.sf(ratio), both.cdf([-ratio, -ratio])
    (mean, error), (runs, runs_error) = estimates(spec, [ratio], [2])
    assert within((mean[0], error[0]), 2.0 * one - together)
    assert within((runs[0], runs_error[0]), one - together)
    assert error[0] < 0.01 * mean[0] and runs_error[0] < 0.03 * runs[0]


def test_without_a_boundary_layer_every_contact_is_a_breakthrough(spec):
    (windows, _), (runs, _) = estimates(spec, [2.0, 4.0], [75, 21], factor=1e9)
    np.testing.assert_array_equal(windows[0], windows[1])
    np.testing.assert_array_equal(runs[0], runs[1])


# --- Counting ----------------------------------------------------------------------------


def counted(spec, ratio, width, pairs):
    """Contact and breakthrough of all windows, and runs and broken points, by counting."""
    rows = []
    for number in range(1000, 1000 + pairs):
        lines, _ = draw_pair(spec, SEED, number)
        size = min(spec.points)
        overlap = lines[0][:size] + lines[1][:size] - ratio * sum_of_lines(spec, 2)[0]
        edges = np.flatnonzero(np.diff(overlap > 0.0)) + 1
        runs = [run for run in np.split(np.arange(size), edges) if overlap[run[0]] > 0.0]
        broken = [run for run in runs if run.size**3 < FACTOR * overlap[run].sum()]
        windows = [overlap[start : start + width] for start in range(0, size - width, width // 4)]
        touching = [window for window in windows if np.any(window > 0.0)]
        rows.append(
            [
                len(touching) / len(windows),
                sum(breaks_in(window) for window in touching) / len(windows),
                len(runs) / size,
                len(broken) / size,
                sum(map(len, broken)) / size,
            ]
        )
    return np.mean(rows, axis=0), np.std(rows, axis=0, ddof=1) / np.sqrt(pairs)


def breaks_in(window):
    pieces = np.split(window, np.flatnonzero(np.diff(window > 0.0)) + 1)
    return any(piece[0] > 0.0 and piece.size**3 < FACTOR * piece.sum() for piece in pieces)


@pytest.mark.parametrize(("rollers", "ratio", "width"), [("spec", 2.5, 75), ("unequal", 1.5, 31)])
def test_sampled_contact_is_as_often_as_counted(request, rollers, ratio, width):
    spec = request.getfixturevalue(rollers)
    (windows, windows_error), (runs, runs_error) = estimates(spec, [ratio], [width])
    found = np.concatenate([windows[:, 0], runs[[0, 1, 4], 0]])
    error = np.concatenate([windows_error[:, 0], runs_error[[0, 1, 4], 0]])
    expected, scatter = counted(spec, ratio, width, 24)
    assert np.all(np.abs(found - expected) < 4.0 * np.hypot(error, scatter))
    assert np.all(np.hypot(error, scatter) < 0.1 * expected)


def test_the_error_hardly_grows_with_rarity(spec):
    (mean, error), _ = estimates(spec, [1.0, 4.0, 8.5, 12.0], [75] * 4)
    assert np.all(error / mean < 0.03)
    assert mean[1, 3] < 1e-30


def test_the_same_pair_gives_the_same_estimate_beside_any_other_points(spec):
    films, widths = np.array([3e5, 9e5]), np.array([75, 31])
    whole = rare_contact(spec, SEED, 2, films, widths, FACTOR)
    part = rare_contact(spec, SEED, 2, films[1:], widths[1:], FACTOR)
    for one, other in zip(whole, part, strict=True):
        np.testing.assert_array_equal(one[:, 1:], other)


def test_lines_that_are_not_gaussian_are_refused(make_spec):
    worn = make_spec(50_000, skewness=-1.0, kurtosis=5.0)
    with pytest.raises(StudyError, match="got a skewness of -1 and a kurtosis of 5, need 0 and 3"):
        rare_contact(worn, SEED, 0, np.array([3e5]), np.array([75]), FACTOR)


def test_a_window_of_two_lines_of_their_own_has_the_longer_reach(make_spec):
    own = {"hurst_exponent": 0.5, "longest_wavelength": "0.2 mm", "roll_off_wavelength": "0.1 mm"}
    spec = make_spec(50_000, second_own=own, shortest_wavelength=2e-5)
    (windows, error), (runs, runs_error) = estimates(spec, [2.0], [41])
    expected, scatter = counted(spec, 2.0, 41, 24)
    found = np.concatenate([windows[:, 0], runs[[0, 1, 4], 0]])
    errors = np.concatenate([error[:, 0], runs_error[[0, 1, 4], 0]])
    assert np.all(np.abs(found - expected) < 4.0 * np.hypot(errors, scatter))
