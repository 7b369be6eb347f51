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
    realisation_correlation,
)
from lube.statistics.one_pair import prediction_limits, quantile, standard_error

FILMS = np.log(np.geomspace(0.3, 10.0, 30))
SHARES = st.floats(1e-3, 0.89)
REALISATIONS = 64


def steep(films):
    """A probability that falls from 0.9 to nothing."""
    return 0.9 * expit(-3.0 * films**3 - 2.0 * films)


LOOKS = np.geomspace(30.0, 300.0, FILMS.size)
CURVE = falling_curve(FILMS, steep(FILMS), LOOKS, 1e-5)


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
def test_a_curve_that_resolves_nothing_is_empty_and_tells_no_film(probability):
    empty = falling_curve(FILMS, np.full(FILMS.size, probability), LOOKS, 1e-5)
    assert empty.films.size == 0
    assert np.isnan(empty.film_at(0.3)) and np.isnan(empty.logit_at(0.3))
    assert np.isnan(film_interval(empty, 0.3, 1.0, REALISATIONS)).all()


@given(st.lists(st.floats(0.0, 1.0), min_size=2, max_size=30))
def test_whatever_the_scatter_a_curve_falls(probabilities):
    films = np.arange(len(probabilities), dtype=float)
    curve = falling_curve(films, np.array(probabilities), np.ones(films.size), 1e-6)
    assert (np.diff(curve.films) > 0.0).all() and (np.diff(curve.logits) < 0.0).all()


def test_levels_out_of_order_get_their_common_mean():
    looks = np.array([10.0, 20.0, 40.0, 80.0])
    curve = falling_curve(np.arange(4.0), np.array([0.8, 0.3, 0.5, 0.1]), looks, 1e-6)
    np.testing.assert_allclose(curve.films, [0.0, 1.5, 3.0])
    np.testing.assert_allclose(expit(curve.logits), [0.8, 0.4, 0.1])
    np.testing.assert_allclose(curve.looks, [10.0, 30.0, 80.0])


# A film and its interval


@given(SHARES, st.floats(0.05, 5.0), st.sampled_from([0.0, 0.01]))
def test_the_limits_are_where_the_prediction_touches_the_share(share, ratio, noise):
    _, lower, upper = film_interval(CURVE, share, ratio, REALISATIONS, noise)
    for film, side in ((lower, 0), (upper, 1)):
        if CURVE.films[0] < film < CURVE.films[-1]:
            model = expit(CURVE.logit_at(film))
            looks = np.interp(film, CURVE.films, CURVE.looks)
            touched = prediction_limits(model, looks, ratio, REALISATIONS, noise)[side]
            assert touched == pytest.approx(share, abs=2e-3)


def test_the_limits_are_the_roots_of_the_misfit():
    share, ratio = 0.2, 0.7

    def distance(film, side):
        model, looks = expit(CURVE.logit_at(film)), np.interp(film, CURVE.films, CURVE.looks)
        error = standard_error(model, looks, ratio, REALISATIONS)
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


@pytest.mark.parametrize("change", [{"ratio": 4.0}, {"noise": 0.05}, {"realisations": 4}])
def test_what_scatters_more_leaves_more_films_possible(change):
    usual = {"ratio": 1.0, "realisations": REALISATIONS, "noise": 0.0}
    film, lower, upper = film_interval(CURVE, 0.3, **usual)
    same, lower_here, upper_here = film_interval(CURVE, 0.3, **(usual | change))
    assert lower_here < lower < film == same < upper < upper_here


def test_an_exact_record_of_a_sure_curve_leaves_no_interval():
    sure = Curve(CURVE.films, CURVE.logits, np.full(CURVE.films.size, 1e12))
    film, lower, upper = film_interval(sure, 0.3, 1.0, REALISATIONS)
    assert lower == pytest.approx(film, abs=1e-3) and upper == pytest.approx(film, abs=1e-3)


def test_no_contact_gives_a_lower_limit_only():
    film, lower, upper = film_interval(CURVE, 0.0, 1.0, REALISATIONS)
    assert film == upper == np.inf
    assert CURVE.films[0] < lower < CURVE.films[-1]


@pytest.mark.parametrize("share", [0.9, 0.95])
def test_contact_above_the_whole_curve_gives_an_upper_limit_only(share):
    film, lower, upper = film_interval(CURVE, share, 1.0, REALISATIONS)
    assert film == lower == -np.inf
    assert CURVE.films[0] < upper < CURVE.films[-1]


def test_a_share_that_contradicts_the_whole_curve_lies_beyond_its_end():
    sure = Curve(CURVE.films[5:-5], CURVE.logits[5:-5], np.full(CURVE.films.size - 10, 1e9))
    assert film_interval(sure, 0.99, 1.0, 64) == (-np.inf, -np.inf, sure.films[0])
    assert film_interval(sure, 0.0, 1.0, 64) == (np.inf, sure.films[-1], np.inf)


@pytest.mark.parametrize(("share", "curve"), [(np.nan, CURVE), (0.3, Curve(*np.ones((3, 1))))])
def test_without_a_share_or_a_curve_nothing_is_told(share, curve):
    assert np.isnan(film_interval(curve, share, 1.0, REALISATIONS)).all()


# Correlation


def test_correlation_is_pearsons():
    shares = np.random.default_rng(3).random((20, 4)) @ np.random.default_rng(4).random((4, 5))
    found = realisation_correlation(shares)
    np.testing.assert_allclose(found, np.corrcoef(shares.T), atol=1e-12)


def test_points_without_scatter_stand_alone_and_one_realisation_ties_all():
    shares = np.array([[0.1, 0.0], [0.3, 0.0], [0.2, 0.0]])
    np.testing.assert_array_equal(realisation_correlation(shares), np.eye(2))
    np.testing.assert_array_equal(realisation_correlation(shares[:1]), np.ones((2, 2)))


# A factor common to all records


LOG_FACTORS = np.log(np.geomspace(0.25, 4.0, 161))
PLACES = np.linspace(-3.0, 2.0, 12)
SLOPES = np.linspace(1.0, 8.0, 12)
LOGITS = PLACES - SLOPES * LOG_FACTORS[:, None]


def fitted(shares, looks, correlation, noise=0.0, realisations=10_000):
    looks, noise = np.full(PLACES.size, looks), np.full(PLACES.size, noise)
    return fit_factor(LOG_FACTORS, LOGITS, shares, looks, correlation, realisations, noise)


@pytest.mark.parametrize("factor", [0.4, 1.0, 2.3])
def test_the_factor_behind_exact_shares_is_found(factor):
    shares = expit(PLACES - SLOPES * np.log(factor))
    found, lower, upper = fitted(shares, 400.0, np.eye(PLACES.size))
    assert found == pytest.approx(factor, rel=1e-3)
    assert lower < found < upper


def test_records_that_err_together_tell_less_and_so_do_noise_and_few_realisations():
    alone, together = np.eye(PLACES.size), np.ones((PLACES.size,) * 2)
    cases = [(together, 0.0, 10_000), (alone, 0.05, 10_000), (alone, 0.0, 3)]
    _, lower, upper = fitted(expit(PLACES), 400.0, alone)
    for correlation, noise, realisations in cases:
        found = fitted(expit(PLACES), 400.0, correlation, noise, realisations)
        assert found[1] < lower < 1.0 < upper < found[2]


def test_the_misfit_is_contradicted_where_its_quantile_is():
    """One record: the interval is where its share lies within the prediction."""
    logits, looks = LOGITS[:, :1], 400.0
    found = fit_factor(
        LOG_FACTORS, logits, expit(PLACES[:1]), np.array([looks]), np.eye(1), 64, np.zeros(1)
    )
    for limit, side in zip(found[1:], (1.0, -1.0), strict=True):
        model = expit(PLACES[0] - SLOPES[0] * np.log(limit))
        error = np.sqrt(model * (1.0 - model) / looks)
        distance = (model - expit(PLACES[0])) / error
        assert distance == pytest.approx(side * quantile(64), rel=1e-2)


def test_a_factor_beyond_the_levels_is_not_guessed():
    found, lower, upper = fitted(np.zeros(PLACES.size), 1e6, np.eye(PLACES.size))
    assert np.isnan(found) and lower == pytest.approx(4.0) and upper == np.inf
    found, lower, upper = fitted(np.ones(PLACES.size), 1e6, np.eye(PLACES.size))
    assert np.isnan(found) and lower == 0.0 and upper == pytest.approx(0.25)
    found, lower, upper = fitted(np.zeros(PLACES.size), 0.1, np.eye(PLACES.size))
    assert np.isnan(found) and 0.0 <= lower < upper == np.inf


def test_no_record_no_factor():
    nothing = fit_factor(
        LOG_FACTORS, LOGITS[:, :0], *[np.empty(0)] * 2, np.empty((0, 0)), 8, np.empty(0)
    )
    assert np.isnan(nothing[0]) and nothing[1:] == (0.0, np.inf)


@pytest.mark.parametrize("tie", [0.0, 0.9])
def test_the_interval_of_the_factor_covers_it(tie):
    """Records of many looks, independent or nearly all alike."""
    rng = np.random.default_rng(8)
    records = PLACES.size
    correlation = tie * np.ones((records, records)) + (1.0 - tie) * np.eye(records)
    truth = expit(PLACES)
    scale = np.sqrt(truth * (1.0 - truth) / 200.0)
    errors = rng.multivariate_normal(np.zeros(records), correlation, 600) * scale
    covered = 0
    for shares in np.clip(truth + errors, 0.0, 1.0):
        _, lower, upper = fitted(shares, 200.0, correlation)
        covered += lower <= 1.0 <= upper
    assert 0.92 <= covered / 600 <= 0.98
