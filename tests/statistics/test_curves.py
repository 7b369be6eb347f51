"""Curves read in either direction, films with their intervals, and a factor fitted."""

import numpy as np
import pytest
import scipy.optimize
from hypothesis import given
from hypothesis import strategies as st
from scipy.special import expit

from lube.statistics.curves import (
    Curve,
    falling_curve,
    film_interval,
    fit_factor,
    peaked_curve,
    realisation_correlation,
)
from lube.statistics.one_pair import prediction_limits, quantile, standard_error

FILMS = np.log(np.geomspace(0.3, 10.0, 30))
SHARES = st.floats(1e-3, 0.89)
REALISATIONS = 64


def steep(films):
    """A probability that falls from 0.9 to nothing."""
    return 0.9 * expit(-3.0 * films**3 - 2.0 * films)


SIZES = np.geomspace(30.0, 300.0, FILMS.size)
CURVE = falling_curve(FILMS, steep(FILMS), SIZES, 1e-5)


@given(SHARES)
def test_a_film_read_off_the_curve_has_the_share_it_was_read_at(share):
    film = CURVE.film_at(share)
    assert expit(CURVE.logit_at(film)) == pytest.approx(share, rel=1e-9)


def test_beyond_its_ends_the_curve_goes_straight_on_but_knows_no_film():
    films, logits = CURVE.films, CURVE.logits
    slope = (logits[-1] - logits[-2]) / (films[-1] - films[-2])
    assert CURVE.logit_at(films[-1] + 2.0) == pytest.approx(logits[-1] + 2.0 * slope)
    assert CURVE.film_at(0.0) == CURVE.film_at(1e-9) == np.inf
    assert CURVE.film_at(1.0) == CURVE.film_at(0.95) == -np.inf


def test_a_curve_without_resolved_levels_is_empty_and_gives_no_film():
    for probability in (0.0, 1.0):
        empty = falling_curve(FILMS, np.full(FILMS.size, probability), SIZES, 1e-5)
        assert empty.films.size == 0
        assert np.isnan(empty.film_at(0.3)) and np.isnan(empty.logit_at(0.3))
        assert np.isnan(film_interval(empty, 0.3, 1.0, REALISATIONS)).all()
    single = Curve(*np.ones((3, 1)))
    for share, curve in ((np.nan, CURVE), (0.3, single)):
        assert np.isnan(film_interval(curve, share, 1.0, REALISATIONS)).all()


@given(st.lists(st.floats(0.0, 1.0), min_size=2, max_size=30))
def test_a_curve_falls_with_any_scatter(probabilities):
    films = np.arange(len(probabilities), dtype=float)
    curve = falling_curve(films, np.array(probabilities), np.ones(films.size), 1e-6)
    assert (np.diff(curve.films) > 0.0).all() and (np.diff(curve.logits) < 0.0).all()


def test_levels_out_of_order_get_their_common_mean():
    sizes = np.array([10.0, 20.0, 40.0, 80.0])
    curve = falling_curve(np.arange(4.0), np.array([0.8, 0.3, 0.5, 0.1]), sizes, 1e-6)
    np.testing.assert_allclose(curve.films, [0.0, 1.5, 3.0])
    np.testing.assert_allclose(expit(curve.logits), [0.8, 0.4, 0.1])
    np.testing.assert_allclose(curve.sample_size, [10.0, 30.0, 80.0])


# A film and its interval


@given(SHARES, st.floats(0.05, 5.0), st.sampled_from([0.0, 0.01]))
def test_the_limits_are_where_the_prediction_touches_the_share(share, ratio, noise):
    _, lower, upper = film_interval(CURVE, share, ratio, REALISATIONS, noise)
    for film, side in ((lower, 0), (upper, 1)):
        if CURVE.films[0] < film < CURVE.films[-1]:
            model = expit(CURVE.logit_at(film))
            sizes = np.interp(film, CURVE.films, CURVE.sample_size)
            touched = prediction_limits(model, sizes, ratio, REALISATIONS, noise)[side]
            assert touched == pytest.approx(share, abs=2e-3)


def test_the_limits_are_the_roots_of_the_misfit():
    share, ratio = 0.2, 0.7

    def distance(film, side):
        model, sizes = expit(CURVE.logit_at(film)), np.interp(film, CURVE.films, CURVE.sample_size)
        error = standard_error(model, sizes, ratio, REALISATIONS)
        return (share - model) / error - side * quantile(REALISATIONS)

    film, *limits = film_interval(CURVE, share, ratio, REALISATIONS)
    assert expit(CURVE.logit_at(film)) == pytest.approx(share)
    for side, limit in zip((-1.0, 1.0), limits, strict=True):
        root = scipy.optimize.brentq(distance, CURVE.films[0], CURVE.films[-1], (side,))
        assert limit == pytest.approx(root, abs=1e-3)


@given(SHARES, SHARES)
def test_the_larger_share_has_the_thinner_film(one, other):
    few, many = sorted((one, other))
    films = [film_interval(CURVE, share, 1.0, REALISATIONS) for share in (few, many)]
    for thick, thin in zip(*films, strict=True):
        assert thick >= thin


def test_more_scatter_leaves_more_films_possible():
    usual = {"ratio": 1.0, "realisations": REALISATIONS, "noise": 0.0}
    film, lower, upper = film_interval(CURVE, 0.3, **usual)
    for change in ({"ratio": 4.0}, {"noise": 0.05}, {"realisations": 4}):
        same, lower_here, upper_here = film_interval(CURVE, 0.3, **(usual | change))
        assert lower_here < lower < film == same < upper < upper_here


def test_an_exact_record_of_an_exact_curve_leaves_no_interval():
    exact = Curve(CURVE.films, CURVE.logits, np.full(CURVE.films.size, 1e12))
    film, lower, upper = film_interval(exact, 0.3, 1.0, REALISATIONS)
    assert lower == pytest.approx(film, abs=1e-3) and upper == pytest.approx(film, abs=1e-3)


def test_shares_beyond_the_curve_have_one_limit_only():
    film, lower, upper = film_interval(CURVE, 0.0, 1.0, REALISATIONS)
    assert film == upper == np.inf
    assert CURVE.films[0] < lower < CURVE.films[-1]
    for share in (0.9, 0.95):
        film, lower, upper = film_interval(CURVE, share, 1.0, REALISATIONS)
        assert film == lower == -np.inf
        assert CURVE.films[0] < upper < CURVE.films[-1]
    exact = Curve(CURVE.films[5:-5], CURVE.logits[5:-5], np.full(CURVE.films.size - 10, 1e9))
    assert film_interval(exact, 0.99, 1.0, 64) == (-np.inf, -np.inf, exact.films[0])
    assert film_interval(exact, 0.0, 1.0, 64) == (np.inf, exact.films[-1], np.inf)


# Correlation


def test_correlation_is_pearsons_without_scatter_0_and_of_one_realisation_1():
    shares = np.random.default_rng(3).random((20, 4)) @ np.random.default_rng(4).random((4, 5))
    found = realisation_correlation(shares)
    np.testing.assert_allclose(found, np.corrcoef(shares.T), atol=1e-12)
    shares = np.array([[0.1, 0.0], [0.3, 0.0], [0.2, 0.0]])
    np.testing.assert_array_equal(realisation_correlation(shares), np.eye(2))
    np.testing.assert_array_equal(realisation_correlation(shares[:1]), np.ones((2, 2)))


# A factor common to all records


LOG_FACTORS = np.log(np.geomspace(0.25, 4.0, 161))
OFFSETS = np.linspace(-3.0, 2.0, 12)
SLOPES = np.linspace(1.0, 8.0, 12)
LOGITS = OFFSETS - SLOPES * LOG_FACTORS[:, None]


def fitted(shares, sizes, correlation, noise=0.0, realisations=10_000):
    sizes, noise = np.full(OFFSETS.size, sizes), np.full(OFFSETS.size, noise)
    return fit_factor(LOG_FACTORS, LOGITS, shares, sizes, correlation, realisations, noise)


def test_the_factor_behind_exact_shares_is_found():
    for factor in (0.4, 1.0, 2.3):
        shares = expit(OFFSETS - SLOPES * np.log(factor))
        found, lower, upper = fitted(shares, 400.0, np.eye(OFFSETS.size))
        assert found == pytest.approx(factor, rel=1e-3)
        assert lower < found < upper


def test_correlated_errors_noise_and_few_realisations_widen_the_interval():
    alone, together = np.eye(OFFSETS.size), np.ones((OFFSETS.size,) * 2)
    cases = [(together, 0.0, 10_000), (alone, 0.05, 10_000), (alone, 0.0, 3)]
    _, lower, upper = fitted(expit(OFFSETS), 400.0, alone)
    for correlation, noise, realisations in cases:
        found = fitted(expit(OFFSETS), 400.0, correlation, noise, realisations)
        assert found[1] < lower < 1.0 < upper < found[2]


def test_the_limits_are_where_the_misfit_reaches_its_quantile():
    """One record: the interval is where its share lies within the prediction."""
    logits, sizes = LOGITS[:, :1], 400.0
    found = fit_factor(
        LOG_FACTORS, logits, expit(OFFSETS[:1]), np.array([sizes]), np.eye(1), 64, np.zeros(1)
    )
    for limit, side in zip(found[1:], (1.0, -1.0), strict=True):
        model = expit(OFFSETS[0] - SLOPES[0] * np.log(limit))
        error = np.sqrt(model * (1.0 - model) / sizes)
        distance = (model - expit(OFFSETS[0])) / error
        assert distance == pytest.approx(side * quantile(64), rel=1e-2)


def test_a_factor_beyond_the_levels_or_without_records_is_nan():
    found, lower, upper = fitted(np.zeros(OFFSETS.size), 1e6, np.eye(OFFSETS.size))
    assert np.isnan(found) and lower == pytest.approx(4.0) and upper == np.inf
    found, lower, upper = fitted(np.ones(OFFSETS.size), 1e6, np.eye(OFFSETS.size))
    assert np.isnan(found) and lower == 0.0 and upper == pytest.approx(0.25)
    found, lower, upper = fitted(np.zeros(OFFSETS.size), 0.1, np.eye(OFFSETS.size))
    assert np.isnan(found) and 0.0 <= lower < upper == np.inf
    logits, two = np.array([40.0, 45.0]) - LOG_FACTORS[:, None], np.full(2, 1e3)
    for noise in (0.0, 0.01):  # contact is certain with any factor
        known = two, np.eye(2), 64, np.full(2, noise)
        found, lower, upper = fit_factor(LOG_FACTORS, logits, np.ones(2), *known)
        assert np.isnan(found) and (lower, upper) == (0.0, np.inf)
    none = np.empty(0)
    nothing = fit_factor(LOG_FACTORS, LOGITS[:, :0], none, none, np.empty((0, 0)), 8, none)
    assert np.isnan(nothing[0]) and nothing[1:] == (0.0, np.inf)


@pytest.mark.parametrize("tie", [0.0, 0.9])
def test_the_interval_of_the_factor_covers_it(tie):
    """Records of a large sample size, independent or nearly all alike."""
    rng = np.random.default_rng(8)
    records = OFFSETS.size
    correlation = tie * np.ones((records, records)) + (1.0 - tie) * np.eye(records)
    truth = expit(OFFSETS)
    scale = np.sqrt(truth * (1.0 - truth) / 200.0)
    errors = rng.multivariate_normal(np.zeros(records), correlation, 600) * scale
    covered = 0
    for shares in np.clip(truth + errors, 0.0, 1.0):
        _, lower, upper = fitted(shares, 200.0, correlation)
        covered += lower <= 1.0 <= upper
    assert 0.92 <= covered / 600 <= 0.98


# --- Contact so frequent that it falls as the film thins ---------------------------------

PEAKED = peaked_curve(
    np.linspace(-1.0, 1.0, 9),
    np.array([0.80, 0.82, 0.84, 0.85, 0.7, 0.5, 0.3, 0.1, 0.01]),
    np.full(9, 1e3),
    1e-6,
)


@given(st.floats(0.801, 0.849))
def test_a_share_near_the_largest_belongs_to_two_films(share):
    thick, thin = PEAKED.film_at(share), PEAKED.thinner_film_at(share)
    assert thin < PEAKED.films[PEAKED.peak] < thick
    np.testing.assert_allclose(expit(PEAKED.logit_at([thick, thin])), share)


def test_other_shares_belong_to_one_film():
    assert np.isnan(PEAKED.thinner_film_at(0.3)) and np.isnan(PEAKED.thinner_film_at(0.9))
    assert PEAKED.film_at(0.9) == -np.inf
    assert np.isnan(CURVE.thinner_film_at(0.5))


def test_a_falling_curve_has_no_peak():
    films, probabilities = CURVE.films, expit(CURVE.logits)
    peaked, falling = (
        fit(films, probabilities, CURVE.sample_size, 1e-6) for fit in (peaked_curve, falling_curve)
    )
    assert peaked.peak == 0
    for name in ("films", "logits", "sample_size"):
        np.testing.assert_array_equal(getattr(peaked, name), getattr(falling, name))


@pytest.mark.parametrize(("share", "size"), [(0.83, 1e3), (0.83, 1e7), (0.849, 1e5), (0.3, 1e3)])
def test_the_interval_holds_the_films_around_the_thicker_one_that_agree(share, size):
    curve = Curve(PEAKED.films, PEAKED.logits, np.full(9, size), PEAKED.peak)
    film, lower, upper = film_interval(curve, share, 1.0, REALISATIONS)
    assert film == curve.film_at(share)
    tried = np.linspace(-1.0, 1.0, 200_001)
    model = expit(curve.logit_at(tried))
    error = standard_error(model, np.full(tried.size, size), 1.0, REALISATIONS)
    agrees = np.abs(share - model) <= quantile(REALISATIONS) * error
    known = int(np.searchsorted(tried, film))
    others = np.flatnonzero(~agrees)
    first, last = others[others < known].max(initial=-1), others[others > known].min()
    expected = tried[first + 1] if first >= 0 else -np.inf
    assert lower == pytest.approx(expected, abs=2e-3)
    assert upper == pytest.approx(tried[last], abs=2e-3)


def test_a_factor_is_found_beyond_the_peak():
    """At a small factor the probabilities fall with the film; a plain search would end there."""
    log_factors = np.linspace(-2.0, 2.0, 401)
    logits = np.stack([1.5 - 0.8 * (log_factors + c) ** 2 for c in (0.6, 0.8, 1.0)], axis=1)
    shares, sizes = expit(logits[200]), np.full(3, 1e3)
    found = fit_factor(log_factors, logits, shares, sizes, np.eye(3), 10_000, np.zeros(3))
    assert found[0] == pytest.approx(1.0, rel=1e-6) and found[1] < 1.0 < found[2]
