"""What a record would tell: limits, and records of rollers that were not in the ensemble."""

import numpy as np
import pytest
import xarray as xr
from made import on_few_surfaces

from lube.contact.rough_pair import RoughPair
from lube.contact.strip_film import StripFilm
from lube.contact.surface_strip import surface_contact
from lube.inference.planning import (
    Slopes,
    half_widths,
    line_ratios,
    on_surfaces,
    reading_of_lines,
    reading_of_surfaces,
    relative_error,
    slopes,
)
from lube.statistics.one_pair import quantile
from lube.study.rollers import BoundaryLayer
from lube.surfaces.synthetic import draw_realisation

RATIOS = np.array([1.5, 2.0, 2.5])


LENGTH = 4e-3


@pytest.fixture(scope="module")
def spec(make_spec):
    return make_spec(200_000)


@pytest.fixture(scope="module")
def layer():
    return BoundaryLayer(critical_thickness="5 nm", shear_strength="1 MPa")


@pytest.fixture(scope="module")
def film(spec):
    rms = np.hypot(*spec.rms_height)
    return xr.Dataset(
        {
            "film_thickness": ("lambda_ratio", RATIOS * rms),
            "contact_half_width": 1.5e-4,
            "reduced_modulus": 1.154e11,
        }
    )


@pytest.fixture(scope="module")
def found(spec, film, layer):
    return slopes(RoughPair(spec, LENGTH, layer, 1), film)


def test_contact_falls_with_the_film_the_steeper_the_thicker_it_is(found):
    assert (np.diff(found.by_film) < 0.0).all() and (found.by_film < 0.0).all()
    assert (found.by_layer < 0.0).all()


def test_contact_all_the_time_has_no_probability_above_one(spec, film, layer):
    rms = np.hypot(*spec.rms_height)
    thin = film.assign(film_thickness=("lambda_ratio", np.array([0.1, 0.2, 0.4]) * rms))
    weak = layer.model_copy(update={"shear_strength": 0.01 * layer.shear_strength})
    certain = slopes(RoughPair(spec, LENGTH, weak, 2), thin)
    assert (certain.probability > 0.99).any() and certain.probability.max() <= 1.0


def test_slopes_are_those_between_distant_films(spec, film, layer, found):
    ends = [film.assign(film_thickness=film.film_thickness * times) for times in (0.95, 1.05)]
    lower, upper = (slopes(RoughPair(spec, LENGTH, layer, 1), end).probability for end in ends)
    expected = np.log(upper / lower) / np.log(1.05 / 0.95)
    np.testing.assert_allclose(found.by_film, expected, rtol=0.05)


def test_a_weaker_layer_is_as_a_stronger_one_backwards(spec, film, layer, found):
    ends = [layer.model_copy(update={"shear_strength": times * 1e6}) for times in (0.9, 1.1)]
    lower, upper = (slopes(RoughPair(spec, LENGTH, end, 1), film).probability for end in ends)
    expected = np.log(upper / lower) / np.log(1.1 / 0.9)
    np.testing.assert_allclose(found.by_layer, expected, rtol=0.15, atol=0.01)


def test_a_shorter_record_and_a_worse_reading_tell_less():
    share, size = np.array([0.2]), np.array([400.0])
    whole, short = (relative_error(share, size, ratio) for ratio in (1.0, 10.0))
    assert short == pytest.approx(np.sqrt(10.0) * whole)
    assert relative_error(share, size, 1.0, 0.1) == pytest.approx(np.hypot(whole, 0.1))
    assert relative_error(np.array([1e-6]), size, 1.0) == np.inf


def test_intervals_scale_with_the_error_and_without_a_slope_there_is_none():
    some = Slopes(*np.array([[0.1, 0.1], [-4.0, 0.0], [-0.5, -0.5], [0.1, 0.1], [0.1, 0.1]]))
    widths = half_widths(some, np.array([0.5, 0.5]), np.array([[0.1, 0.1]]), 64)[:, 0]
    assert widths[0, 0] == pytest.approx(quantile(64) * 0.1 / 4.0)
    assert widths[1, 0] == pytest.approx(2.0 * widths[0, 0])
    assert np.isnan(widths[:2, 1]).all()
    assert widths[2] == pytest.approx(quantile(64) * 0.1 / 0.5)


def test_where_a_slope_may_be_noise_there_is_no_interval():
    errors = [[0.2, 0.2], [0.1, 0.2]]
    some = Slopes(*np.array([[0.1, 0.1], [-4.0, -0.5], [-0.5, -0.5], *errors]))
    widths = half_widths(some, np.array([0.5, 0.5]), np.array([[0.1, 0.1]]), 64)[:, 0]
    np.testing.assert_array_equal(np.isnan(widths), [[False, True], [False, True], [False, True]])


def test_slopes_scatter_between_seeds_as_their_errors_say(spec, film, layer):
    some = [slopes(RoughPair(spec, LENGTH, layer, seed), film) for seed in range(12)]
    for values, errors in (("by_film", "film_error"), ("by_layer", "layer_error")):
        scatter = np.std([getattr(one, values) for one in some], axis=0, ddof=1)
        expected = np.sqrt(np.mean([getattr(one, errors) ** 2 for one in some], axis=0))
        # Three standard errors of a scatter from twelve.
        np.testing.assert_allclose(scatter, expected, rtol=3.0 / np.sqrt(2.0 * 11))


def test_films_read_from_single_pairs_scatter_as_expected(spec, film, layer, found):
    """Films that shares of 60 other pairs stand for, by the slope at the true film."""
    from lube.contact.windows import ContactWindows
    from lube.statistics.sample_size import effective_sample_size

    windows = ContactWindows(spec, film, layer)
    shares = np.array([windows.count(draw_realisation(spec, 1, n))[:, 1] for n in range(60)])
    others = np.array([windows.count(draw_realisation(spec, 2, n))[:, 1] for n in range(60)])
    error = relative_error(found.probability, effective_sample_size(shares, 100.0), 1.0)
    expected = half_widths(found, np.ones(3), error[None], 60)[0, 0]
    read = np.log(others / found.probability) / found.by_film
    seen = quantile(60) * read.std(axis=0, ddof=1)
    np.testing.assert_allclose(expected, seen, rtol=3.0 * quantile(60) / np.sqrt(2.0 * 60))


def test_lines_that_meet_anew_tell_more_the_longer_they_run(make_spec, film, layer):
    """Twenty turns with slip of 40 other pairs, and one turn."""
    from lube.contact.windows import ContactWindows

    spec = make_spec(20_000)
    windows = ContactWindows(spec, film, layer)
    pairs = [draw_realisation(spec, 2, number) for number in range(40)]
    once, often = (
        np.var([windows.count(pair, 0.1, turns)[:, 1] for pair in pairs], axis=0)
        for turns in (1.0, 20.0)
    )
    pair = RoughPair(spec, LENGTH, layer, 1)
    one, ratio = line_ratios(pair, film, 0.1, [1.0, 20.0])
    assert (one == 1.0).all() and (ratio < 0.2).all()
    np.testing.assert_allclose(np.mean(ratio), np.mean(often / once), rtol=0.5)
    rolling = line_ratios(pair, film, 0.0, [0.5, 20.0])
    np.testing.assert_array_equal(rolling, [[2.0] * 3, [1.0] * 3])


# --- Surfaces ------------------------------------------------------------------------------

TURNS = 0.25, 1.0, 20.0


@pytest.fixture(scope="module")
def weak(layer):
    """A layer that every contact of the coarse surface breaks."""
    return layer.model_copy(update={"shear_strength": 1.0})


@pytest.fixture(scope="module")
def thick(make_spec):
    """A coarse surface, and films under which it touches often to seldom."""
    spec = make_spec(50_000)
    films = np.array([3.0, 3.6, 4.2]) * np.hypot(*spec.rms_height)
    values = {"film_thickness": ("film", films), "contact_half_width": 1.5e-4}
    return spec, xr.Dataset(values | {"reduced_modulus": 1.154e11})


@pytest.fixture(scope="module")
def contact(thick, weak):
    spec, films = thick
    return surface_contact(RoughPair(spec, LENGTH, weak, 1), films)


def of_surfaces(thick, layer, contact, slip=0.0, turns=TURNS, drift=0.0):
    spec, films = thick
    pair = RoughPair(spec, LENGTH, layer, 1)
    return on_surfaces(pair, films, contact, slip, turns, drift)


@pytest.fixture(scope="module")
def planned(thick, weak, contact):
    return of_surfaces(thick, weak, contact)


def test_rare_contact_of_surfaces_falls_as_the_contacts_that_theory_expects(thick, planned):
    """Contacts are independent, so -ln(1 - P) is in proportion to their number."""
    spec, films = thick
    logs = []
    for times in (1.03, 0.97):
        strips = [StripFilm.flat(times * film, 1.5e-4) for film in films.film_thickness.values]
        logs.append(np.log([strip.contacts(spec, LENGTH).number for strip in strips]))
    of_number = (logs[0] - logs[1]) / np.log(1.03 / 0.97)
    found, *_ = planned
    share = found.probability
    expected = -np.log1p(-share) * (1.0 - share) / share * of_number
    # Theory counts contacts that merge to one; few do under the thickest film.
    np.testing.assert_allclose(found.by_film, expected, rtol=0.06)


def test_where_no_record_tells_anything_nothing_is_sampled(thick, weak):
    spec, films = thick
    unlikely = films.assign(film_thickness=films.film_thickness * [0.5, 1.0, 2.0])
    with on_few_surfaces():
        contact = surface_contact(RoughPair(spec, LENGTH, weak, 1), unlikely)
        found, *_ = of_surfaces((spec, unlikely), weak, contact)
    np.testing.assert_array_equal(np.isnan(found.by_film), [True, False, True])


def test_slopes_of_surfaces_are_those_between_independent_samples(thick, weak, planned):
    spec, films = thick
    ends = []
    for number, times in enumerate((0.9, 1.1)):
        end = films.assign(film_thickness=films.film_thickness * times)
        found = surface_contact(RoughPair(spec, LENGTH, weak, 20 + number), end)
        ends.append(found["breakthrough_probability"].values)
    expected = np.log(ends[1] / ends[0]) / np.log(1.1 / 0.9)
    # Of eight seeds the slopes scatter by 1 to 3 %, and such chords by 2 %.
    np.testing.assert_allclose(planned[0].by_film, expected, rtol=0.1)


def test_a_layer_that_every_contact_breaks_does_not_matter(contact, planned):
    np.testing.assert_array_equal(planned[0].probability, contact["breakthrough_probability"])
    np.testing.assert_array_equal(planned[0].by_layer, 0.0)


@pytest.mark.slow
def test_slopes_by_a_layer_that_some_contacts_hold_are_those_between_independent_samples(
    thick, layer, contact
):
    spec, films = thick
    ends = []
    for number, times in enumerate((0.9, 1.0, 1.1)):
        strength = layer.model_copy(update={"shear_strength": times * 3e5})
        ends.append(surface_contact(RoughPair(spec, LENGTH, strength, 20 + number), films))
    lower, _, upper = (end["breakthrough_probability"].values for end in ends)
    strength = layer.model_copy(update={"shear_strength": 3e5})
    found = of_surfaces(thick, strength, ends[1])[0]
    expected = np.log(upper / lower) / np.log(1.1 / 0.9)
    np.testing.assert_allclose(found.by_layer, expected, rtol=0.2)
    assert np.all(found.by_layer < -0.05)


def test_the_scatter_of_surfaces_is_that_of_one_pair(thick, weak, contact, planned):
    _, size, ratios, _ = planned
    share = contact["breakthrough_probability"].values
    np.testing.assert_allclose(share * (1 - share) / size, contact["pair_deviation"] ** 2)
    np.testing.assert_allclose(ratios, np.outer([4.0, 1.0, 1.0], np.ones(3)))
    with on_few_surfaces(2):  # on which the ratios do not depend
        new = of_surfaces(thick, weak, contact, drift=1.0)[2]  # each revolution is another pair
        sliding = of_surfaces(thick, weak, contact, slip=0.37, turns=[100.0])[2]
    np.testing.assert_allclose(new, np.outer([4.0, 1.0, 0.05], np.ones(3)))
    assert np.all(sliding < 0.8)


def test_a_film_that_is_not_known_tells_nothing(thick, weak, contact):
    spec, films = thick
    gone = [True, False, True]
    unknown = films.where(xr.DataArray(gone, dims="film")).assign(reduced_modulus=1.154e11)
    unknown = unknown.assign(contact_half_width=1.5e-4)
    here = contact.where(xr.DataArray(gone, dims="film"))
    found, size, ratios, _ = of_surfaces((spec, unknown), weak, here)
    error = relative_error(found.probability, size, ratios)
    widths = half_widths(found, np.ones(3), error, 16)
    assert np.isnan(widths[:, :, 1]).all() and np.isfinite(widths[0, :, [0, 2]]).any()


def test_the_error_in_reading_lines_follows_from_that_of_surfaces():
    shares, lines = np.array([1e-4, 0.3, 0.8, 0.95]), np.array([0.1, 0.2, 0.3, 0.4])
    found = reading_of_lines(reading_of_surfaces(lines, shares), shares)
    np.testing.assert_allclose(found, [0.1, 0.2, 0.3, 0.2])
    assert reading_of_lines(np.array([0.1]), np.array([0.99])) == 0.0


def test_a_rig_that_misses_contacts_reads_surfaces_as_it_would_fewer_of_them():
    missed, groups = 1e-6, np.array([1e-4, 0.5, 3.0])
    share, read = -np.expm1(-groups), -np.expm1(-groups * (1.0 - missed))
    found = reading_of_surfaces(missed * np.ones(3), share)
    np.testing.assert_allclose(found, 1.0 - read / share, rtol=1e-3)
    assert reading_of_surfaces(np.array([0.1]), np.array([1.0])) < 1e-9
    assert reading_of_surfaces(np.array([0.1]), np.array([0.0])) == pytest.approx(0.1)


def test_contact_all_the_time_tells_as_little_as_none():
    shares = np.array([0.03, 0.05, 0.95, 0.97])
    found = np.isfinite(relative_error(shares, np.full(4, 100.0), 1.0))
    assert found.tolist() == [False, True, True, False]
