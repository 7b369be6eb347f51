"""What a record would tell: limits, and records of rollers that were not in the ensemble."""

import numpy as np
import pytest
import xarray as xr

from lube.grid.gap import PLAIN
from lube.inference.planning import Slopes, half_widths, relative_error, slopes
from lube.statistics.one_pair import quantile
from lube.study.rollers import BoundaryLayer
from lube.surfaces.synthetic import draw_realisation

RATIOS = np.array([1.5, 2.0, 2.5])


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
    return slopes(spec, film, layer, PLAIN, seed=1)


def test_contact_falls_with_the_film_the_steeper_the_thicker_it_is(found):
    assert (np.diff(found.by_film) < 0.0).all() and (found.by_film < 0.0).all()
    assert (found.by_layer < 0.0).all()


def test_slopes_are_those_between_distant_films(spec, film, layer, found):
    ends = [film.assign(film_thickness=film.film_thickness * times) for times in (0.95, 1.05)]
    lower, upper = (slopes(spec, end, layer, PLAIN, seed=1).probability for end in ends)
    expected = np.log(upper / lower) / np.log(1.05 / 0.95)
    np.testing.assert_allclose(found.by_film, expected, rtol=0.05)


def test_a_weaker_layer_is_as_a_stronger_one_backwards(spec, film, layer, found):
    ends = [layer.model_copy(update={"shear_strength": times * 1e6}) for times in (0.9, 1.1)]
    lower, upper = (slopes(spec, film, end, PLAIN, seed=1).probability for end in ends)
    expected = np.log(upper / lower) / np.log(1.1 / 0.9)
    np.testing.assert_allclose(found.by_layer, expected, rtol=0.15, atol=0.01)


def test_a_shorter_record_and_a_worse_reading_tell_less():
    share, size = np.array([0.2]), np.array([400.0])
    whole, short = (relative_error(share, size, ratio) for ratio in (1.0, 10.0))
    assert short == pytest.approx(np.sqrt(10.0) * whole)
    assert relative_error(share, size, 1.0, 0.1) == pytest.approx(np.hypot(whole, 0.1))
    assert relative_error(np.array([1e-6]), size, 1.0) == np.inf


def test_intervals_scale_with_the_error_and_without_a_slope_there_is_none():
    some = Slopes(np.array([0.1, 0.1]), np.array([-4.0, 0.0]), np.array([-0.5, -0.5]))
    widths = half_widths(some, np.array([0.5, 0.5]), np.array([[0.1, 0.1]]), 64)[:, 0]
    assert widths[0, 0] == pytest.approx(quantile(64) * 0.1 / 4.0)
    assert widths[1, 0] == pytest.approx(2.0 * widths[0, 0])
    assert np.isnan(widths[:2, 1]).all()
    assert widths[2] == pytest.approx(quantile(64) * 0.1 / 0.5)


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
