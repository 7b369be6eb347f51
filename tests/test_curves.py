"""Curves read in either direction, intervals turned into looks, and a factor fitted."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from scipy.special import expit

from lube.curves import (
    falling_curve,
    film_interval,
    fit_factor,
    independent_looks,
    realisation_correlation,
)
from lube.intervals import score_interval

FILMS = np.log(np.geomspace(0.3, 10.0, 30))
SHARES = st.floats(1e-3, 0.89)


def steep(films, offset=0.0):
    """A probability that falls from 0.9 to nothing."""
    return 0.9 * expit(-3.0 * (films - offset) ** 3 - 2.0 * (films - offset))


CURVE = falling_curve(FILMS, steep(FILMS), 1e-5)
CURVES = tuple(falling_curve(FILMS, steep(FILMS, shift), 1e-5) for shift in (0.0, -0.05, 0.1))
EXACT = (CURVE,) * 3


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


@pytest.mark.parametrize("probability", [0.0, 1.0])
def test_a_curve_that_resolves_nothing_is_empty(probability):
    empty = falling_curve(FILMS, np.full(FILMS.size, probability), 1e-5)
    assert empty.films.size == 0
    assert np.isnan(empty.film_at(0.3)) and np.isnan(empty.logit_at(0.3))
    assert film_interval((empty,) * 3, (0.3, 0.2, 0.4))[1:] == (-np.inf, np.inf)


@given(st.lists(st.floats(0.0, 1.0), min_size=2, max_size=30))
def test_whatever_the_scatter_a_curve_falls(probabilities):
    films = np.arange(len(probabilities), dtype=float)
    curve = falling_curve(films, np.array(probabilities), 1e-6)
    assert (np.diff(curve.films) > 0.0).all() and (np.diff(curve.logits) < 0.0).all()


def test_levels_out_of_order_get_their_common_mean():
    curve = falling_curve(np.arange(4.0), np.array([0.8, 0.3, 0.5, 0.1]), 1e-6)
    np.testing.assert_allclose(curve.films, [0.0, 1.5, 3.0])
    np.testing.assert_allclose(expit(curve.logits), [0.8, 0.4, 0.1])


# A film and its interval


@given(SHARES, st.floats(0.5, 0.99), st.floats(1.01, 1.1))
def test_limits_enclose_the_film(share, low, high):
    film, lower, upper = film_interval(CURVES, (share, low * share, high * share))
    assert lower < film < upper


@given(SHARES, SHARES)
def test_the_larger_share_has_the_thinner_film(one, other):
    few, many = sorted((one, other))
    films = [film_interval(CURVES, (share, share, share)) for share in (few, many)]
    for thick, thin in zip(*films, strict=True):
        assert thick >= thin


@given(SHARES)
def test_an_exact_record_and_an_exact_curve_leave_no_interval(share):
    film, lower, upper = film_interval(EXACT, (share, share, share))
    assert lower == pytest.approx(film, abs=1e-9) and upper == pytest.approx(film, abs=1e-9)


def test_the_errors_of_record_and_curve_add_in_quadrature():
    record = (0.2, 0.15, 0.27)
    film, *both = film_interval(CURVES, record)
    of_record = film_interval(EXACT, record)[1:]
    of_curve = film_interval(CURVES, (0.2, 0.2, 0.2))[1:]
    for limit, one, other in zip(both, of_record, of_curve, strict=True):
        assert (limit - film) ** 2 == pytest.approx((one - film) ** 2 + (other - film) ** 2)


def test_no_contact_gives_a_lower_limit_only():
    film, lower, upper = film_interval(CURVES, (0.0, 0.0, 0.01))
    assert np.isnan(film) and upper == np.inf
    assert lower == pytest.approx(CURVES[1].film_at(0.01))


@pytest.mark.parametrize("share", [0.9, 1.0])
def test_contact_above_the_whole_curve_gives_an_upper_limit_only(share):
    film, lower, upper = film_interval(CURVES, (share, 0.8, 1.0))
    assert np.isnan(film) and lower == -np.inf
    assert upper == pytest.approx(CURVES[2].film_at(0.8))
    assert film_interval(CURVES, (share, 0.95, 1.0))[2] == CURVES[2].films[0]


def test_an_interval_that_reaches_beyond_the_curve_is_open_there():
    assert film_interval(CURVES, (0.01, 0.0, 0.03))[2] == np.inf
    assert film_interval(CURVES, (0.8, 0.5, 0.99))[1] == -np.inf


def test_what_is_unknown_stays_unknown():
    assert np.isnan(film_interval(CURVES, (np.nan,) * 3)[0])
    film, lower, upper = film_interval(CURVES, (0.3, np.nan, np.nan))
    assert film == CURVE.film_at(0.3) and np.isnan([lower, upper]).all()


# Looks and correlation


@given(st.one_of(st.just(0.0), st.just(1.0), st.floats(1e-6, 1.0 - 1e-6)), st.floats(1.0, 1e6))
def test_wilsons_interval_tells_its_number_of_looks(share, looks):
    share, limits = np.array(share), score_interval(np.array(share), looks, 1.959963984540054)
    assert independent_looks(share, *limits) == pytest.approx(looks, rel=1e-3)


def test_no_width_is_no_doubt_and_all_width_next_to_no_look():
    assert independent_looks(np.array(0.3), np.array(0.3), np.array(0.3)) == np.inf
    assert 0.0 < independent_looks(np.array(0.5), np.array(0.0), np.array(1.0)) < 0.1


def test_correlation_is_pearsons():
    shares = np.random.default_rng(3).random((20, 4)) @ np.random.default_rng(4).random((4, 5))
    found = realisation_correlation(shares)
    np.testing.assert_allclose(found, np.corrcoef(shares.T), atol=1e-12)


def test_points_without_scatter_stand_alone_and_one_realisation_ties_all():
    shares = np.array([[0.1, 0.0], [0.3, 0.0], [0.2, 0.0]])
    np.testing.assert_array_equal(realisation_correlation(shares), np.eye(2))
    np.testing.assert_array_equal(realisation_correlation(shares[:1]), np.ones((2, 2)))


# A factor common to all points


LOG_FACTORS = np.log(np.geomspace(0.25, 4.0, 161))
PLACES = np.linspace(-3.0, 2.0, 12)
SLOPES = np.linspace(1.0, 8.0, 12)
LOGITS = PLACES - SLOPES * LOG_FACTORS[:, None]


def fitted(shares, looks, correlation):
    looks = np.full(PLACES.size, looks)
    return fit_factor(LOG_FACTORS, LOGITS, shares, looks, looks, correlation, 10_000)


@pytest.mark.parametrize("factor", [0.4, 1.0, 2.3])
def test_the_factor_behind_exact_shares_is_found(factor):
    shares = expit(PLACES - SLOPES * np.log(factor))
    found, lower, upper = fitted(shares, 400.0, np.eye(PLACES.size))
    assert found == pytest.approx(factor, rel=1e-3)
    assert lower < found < upper


def test_points_that_err_together_tell_less():
    shares = expit(PLACES)
    alone, together = (
        fitted(shares, 400.0, matrix)
        for matrix in (np.eye(PLACES.size), np.ones((PLACES.size,) * 2))
    )
    assert together[1] < alone[1] < 1.0 < alone[2] < together[2]


def test_a_factor_beyond_the_levels_is_not_guessed():
    found, lower, upper = fitted(np.zeros(PLACES.size), 1e6, np.eye(PLACES.size))
    assert np.isnan(found) and lower == np.inf == upper
    found, lower, upper = fitted(np.zeros(PLACES.size), 0.1, np.eye(PLACES.size))
    assert np.isnan(found) and 0.0 <= lower < upper == np.inf


def test_no_point_no_factor():
    nothing = fit_factor(LOG_FACTORS, LOGITS[:, :0], *[np.empty(0)] * 3, np.empty((0, 0)), 8)
    assert np.isnan(nothing[0]) and nothing[1:] == (0.0, np.inf)


@pytest.mark.parametrize("tie", [0.0, 0.9])
def test_the_interval_of_the_factor_covers_it(tie):
    """Binomial points, independent or nearly all alike, each with many looks or few."""
    rng = np.random.default_rng(8)
    points = PLACES.size
    correlation = tie * np.ones((points, points)) + (1.0 - tie) * np.eye(points)
    truth = expit(PLACES)
    scale = np.sqrt(truth * (1.0 - truth) / 200.0)
    errors = rng.multivariate_normal(np.zeros(points), correlation, 600) * scale
    covered = 0
    for shares in np.clip(truth + errors, 0.0, 1.0):
        _, lower, upper = fitted(shares, 200.0, correlation)
        covered += lower <= 1.0 <= upper
    assert 0.92 <= covered / 600 <= 0.98
