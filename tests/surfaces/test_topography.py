"""Preparing measured topographies: exact theory, then a naive filter, then refusals."""

import numpy as np
import pytest
from threadpoolctl import threadpool_limits

from lube.errors import DataError
from lube.surfaces.topography import (
    MOST_HOLES,
    Preparation,
    Topography,
    fill_holes,
    gaussian_filter,
    power_transfer,
    prepare,
    remove_form,
)

ISOTROPIC = Preparation("isotropic")


@pytest.fixture(scope="module")
def rough():
    return np.random.default_rng(7).normal(size=(80, 70))


@pytest.mark.parametrize(("form", "terms"), [("none", 1), ("tilt", 3), ("curvature", 6)])
def test_form_is_the_best_polynomial_over_the_measured_points(rough, form, terms):
    heights = rough.copy()
    heights[10:14, 20:25] = np.nan
    x, y = np.meshgrid(np.linspace(0, 1, 80), np.linspace(0, 1, 70), indexing="ij")
    basis = np.stack([x**0, x, y, x**2, x * y, y**2], axis=-1)[..., :terms]
    measured = np.isfinite(heights)
    fit = np.linalg.lstsq(basis[measured], heights[measured], rcond=None)[0]
    np.testing.assert_allclose(remove_form(heights, form), heights - basis @ fit, atol=1e-12)
    again = remove_form(heights + basis @ np.arange(1.0, terms + 1.0), form)
    np.testing.assert_allclose(again, remove_form(heights, form), atol=1e-11)


def test_form_of_a_profile_is_that_of_polyfit():
    x, z = np.arange(500.0), np.random.default_rng(1).normal(size=500)
    for order, form in enumerate(("none", "tilt", "curvature")):
        expected = z - np.polyval(np.polyfit(x, z, order), x)
        np.testing.assert_allclose(remove_form(z, form), expected, atol=1e-10)


@pytest.mark.parametrize("form", ["tilt", "curvature"])
def test_form_has_the_same_bits_with_any_number_of_threads(form):
    heights = np.random.default_rng(2).normal(size=(700, 600))
    with threadpool_limits(1):
        alone = remove_form(heights, form)
    with threadpool_limits(2):
        np.testing.assert_array_equal(remove_form(heights, form), alone)


@pytest.mark.parametrize("cutoff", [50.0, 100.0])
def test_gaussian_filter_halves_the_amplitude_at_the_cutoff(cutoff):
    x = np.arange(4000.0)
    middle = slice(1500, 2500)
    for wavelength in (cutoff / 2, cutoff, 4 * cutoff):
        wave = np.sin(2 * np.pi * x / wavelength)
        share = 2.0 ** -((cutoff / wavelength) ** 2)
        for filtered, passed in (
            (gaussian_filter(wave, (1.0,), None, cutoff), share),
            (gaussian_filter(wave, (1.0,), cutoff, None), 1.0 - share),
        ):
            np.testing.assert_allclose(filtered[middle], passed * wave[middle], atol=2e-6)
        transfer = power_transfer(np.array([2 * np.pi / wavelength]), cutoff, None)
        assert transfer[0] == pytest.approx((1.0 - share) ** 2, rel=1e-12)


def test_a_filter_of_a_map_is_isotropic_and_halves_oblique_waves():
    x, y = np.meshgrid(np.arange(600.0), np.arange(400.0) * 1.5, indexing="ij")
    for angle in (0.0, 0.6, np.pi / 2):
        wave = np.cos(2 * np.pi / 60.0 * (np.cos(angle) * x + np.sin(angle) * y))
        rough = gaussian_filter(wave, (1.0, 1.5), 60.0, None)
        middle = np.s_[200:400, 150:250]
        np.testing.assert_allclose(rough[middle], 0.5 * wave[middle], atol=2e-6)


def test_gaussian_filter_is_the_weighted_mean_up_to_the_edges():
    z, cutoff = np.random.default_rng(3).normal(size=150), 20.0
    x = np.arange(150.0)
    alpha = np.sqrt(np.log(2.0) / np.pi)
    weights = np.exp(-np.pi * ((x[:, None] - x) / (alpha * cutoff)) ** 2)
    expected = weights @ z / weights.sum(axis=1)
    np.testing.assert_allclose(gaussian_filter(z, (1.0,), None, cutoff), expected, atol=1e-5)


def test_a_filter_goes_on_across_the_join_of_a_closed_profile():
    z = np.random.default_rng(4).normal(size=300)
    settings = Preparation("along rolling", closed=True, form="none", long_cutoff=40.0)
    once, thrice = (
        prepare(Topography("a", each, (1.0,)), settings).heights for each in (z, np.tile(z, 3))
    )
    np.testing.assert_allclose(once, thrice[300:600], atol=1e-12)
    turned = prepare(Topography("a", np.roll(z, 37), (1.0,)), settings).heights
    np.testing.assert_allclose(turned, np.roll(once, 37), atol=1e-12)


def test_only_a_profile_is_closed_and_it_has_no_curvature(rough):
    with pytest.raises(DataError, match="form: got 'curvature', need none or tilt for a closed"):
        Preparation("isotropic", closed=True, form="curvature")
    with pytest.raises(DataError, match="a: got a map, need a profile if it is closed"):
        prepare(Topography("a", rough, (1.0, 1.0)), Preparation("isotropic", closed=True))


def test_a_constant_passes_or_vanishes_up_to_the_edges():
    level = np.full((90, 70), 3.0)
    np.testing.assert_allclose(gaussian_filter(level, (1.0, 2.0), None, 20.0), level, rtol=1e-12)
    np.testing.assert_allclose(gaussian_filter(level, (1.0, 2.0), 20.0, None), 0.0, atol=1e-12)


def test_holes_are_filled_by_a_harmonic_surface():
    x, y = np.meshgrid(np.arange(40.0), np.arange(30.0), indexing="ij")
    harmonic = x**2 - y**2 + 3.0 * x * y
    holes = harmonic.copy()
    holes[10:15, 8:20] = np.nan
    np.testing.assert_allclose(fill_holes(holes), harmonic, atol=1e-9)


def test_rolling_along_y_turns_the_map(rough):
    surface = Topography("a", rough, (1.0, 2.0))
    turned = prepare(surface, Preparation("along rolling", rolling="y"))
    assert turned.heights.shape == (70, 80) and turned.spacing == (2.0, 1.0)
    before = prepare(surface, ISOTROPIC).heights
    np.testing.assert_allclose(turned.heights, before[::-1].T, atol=1e-12)


def test_a_roller_turned_on_the_instrument_shows_the_same_surface(rough):
    along_x = Topography("a", rough, (1.0, 2.0))
    along_y = Topography("a", rough.T[::-1], (2.0, 1.0))  # x is now against the roller's axis
    found = prepare(along_y, Preparation("isotropic", rolling="y"))
    np.testing.assert_allclose(found.heights, prepare(along_x, ISOTROPIC).heights, atol=1e-12)
    assert found.spacing == (1.0, 2.0)


@pytest.mark.parametrize(
    ("change", "settings", "message"),
    [
        ("hole", {}, "got holes, 0.02% of the points, need no holes or `holes: interpolate`"),
        ("many", {"holes": "interpolate"}, f"need at most {MOST_HOLES:.0%}"),
        ("small", {}, r"got \(40, 70\) points, need 64"),
        (None, {"long_cutoff": 90.0}, "got a cutoff of long waves of 90 m, need 4 to 70 m"),
        (None, {"long_cutoff": 3.0}, "got a cutoff of long waves of 3 m, need 4 to 70 m"),
        (None, {"short_cutoff": 1.0}, "got a cutoff of short waves of 1 m, need 2 m"),
        (None, {"long_cutoff": 20.0, "short_cutoff": 20.0}, "less than 20 m"),
    ],
)
def test_what_does_not_suit_is_refused_in_one_line(rough, change, settings, message):
    heights = rough.copy()
    if change == "hole":
        heights[5, 5] = np.nan
    if change == "many":
        heights[:10] = np.nan
    if change == "small":
        heights = heights[:40]
    with pytest.raises(DataError, match=message) as error:
        prepare(Topography("map.x3p", heights, (1.0, 1.0)), Preparation("isotropic", **settings))
    assert str(error.value).startswith("map.x3p: ") and "\n" not in str(error.value)
