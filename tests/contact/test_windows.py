"""Lines that meet a film: theory of one wave, then every combination against plain ways."""

import itertools

import numpy as np
import pytest
from literal_scan import scan_statistics

from lube import roughness_lines
from lube.contact.windows import WINDOWS_PER_WIDTH, ContactRuns, Waves
from lube.grid.discretise import layer_factor_of, line_pair, whole_numbers
from lube.physics.flattening import amplitude_ratio

RATIOS = (1.0, 1.0)


@pytest.fixture(scope="module")
def coarse(make_spec):
    return roughness_lines(make_spec(30_000), 11, [0])


@pytest.fixture(scope="module")
def weak(study):
    return study.boundary_layer.model_copy(update={"shear_strength": 2e5})


@pytest.fixture(scope="module", params=itertools.product((False, True), (False, True)))
def case(request, shaped_film, coarse, weak):
    """Flat and shaped films, lines as drawn and flattened."""
    with_shape, flattened = request.param
    film = shaped_film if with_shape else shaped_film.drop_vars("film_profile")
    return film, flattened, ContactRuns(coarse, film, weak, flattened)


# One wave


@pytest.mark.parametrize("number", [1, 40, 400])
def test_a_wave_keeps_the_share_of_its_height_that_the_formula_gives(coarse, number):
    spacing, points = coarse.attrs["spacing"], 30_000
    wave = np.rint(1e6 * np.cos(2.0 * np.pi * number * np.arange(points) / points))
    found = Waves(wave.astype(np.int32), coarse).flattened(100e-6, 30.0, 8.0)
    kept = amplitude_ratio(points * spacing / number / 100e-6, 30.0, 8.0)
    assert 0.0 < kept < 1.0
    np.testing.assert_allclose(found, kept * wave, atol=2.0)


def test_waves_beyond_the_band_are_left_out(coarse):
    points = 30_000
    number = int(1.5 * np.max(coarse.attrs["q_max"]) * points * coarse.attrs["spacing"] / 2 / np.pi)
    wave = np.rint(1e6 * np.cos(2.0 * np.pi * number * np.arange(points) / points))
    assert np.abs(Waves(wave.astype(np.int32), coarse).flattened(100e-6, 30.0, 8.0)).max() <= 1


# All combinations


def test_some_operating_points_are_rows_of_all(case, coarse):
    _, _, runs = case
    pair, some = line_pair(coarse, 0), np.array([6, 1, 1, 3])
    every = runs.statistics(pair, RATIOS, 30_000)
    np.testing.assert_array_equal(runs.statistics(pair, RATIOS, 30_000, some), every[some])
    assert 0.0 < every[:, 1].max() < 1.0


def test_statistics_are_means_of_the_traces(case, coarse):
    """To the bit under flat films and lines as drawn; flattened ones are rounded otherwise, and
    under a shape one window in some is looked at."""
    film, flattened, runs = case
    pair = line_pair(coarse, 0)
    found, trace = runs.statistics(pair, RATIOS, 30_000), runs.trace(pair, RATIOS, 30_000)
    exact = not flattened and "film_profile" not in film
    np.testing.assert_allclose(
        found[:, 1], np.mean(trace > 0, axis=1), rtol=1e-12 if exact else 0.1, atol=2e-4
    )


def test_a_film_with_a_shape_is_looked_at_in_evenly_spread_windows(shaped_film, coarse, weak):
    runs, pair = ContactRuns(coarse, shaped_film, weak), line_pair(coarse, 0)
    _, half_windows = whole_numbers(1.0, shaped_film["contact_half_width"].values, coarse)
    found, trace = runs.statistics(pair, RATIOS, 30_000), runs.trace(pair, RATIOS, 30_000)
    for point, half_window in enumerate(np.tile(half_windows, 4)):
        windows = -(-30_000 // max(1, (2 * half_window + 1) // WINDOWS_PER_WIDTH))
        seen = trace[point, np.arange(windows) * 30_000 // windows]
        assert found[point, 1] == np.mean(seen > 0)
        assert found[point, 2] == np.mean(seen)


@pytest.mark.parametrize("second_radius", [None, 0.04])
def test_flattened_lines_under_flat_films_by_a_plain_filter_and_the_literal_scan(
    shaped_film, make_spec, weak, second_radius
):
    """Each line by a plain transform; unequal lines, which are not added before, are the same to
    the bit."""
    lines = roughness_lines(make_spec(12_000, second_radius), 11, [0])
    pair, film = line_pair(lines, 0), shaped_film.drop_vars("film_profile").isel(film_formula=[0])
    found = ContactRuns(lines, film, weak, flattened=True).statistics(pair, RATIOS, 12_000)
    factor = layer_factor_of(lines, film["reduced_modulus"].item(), weak)
    for number, index in enumerate(np.ndindex(film["film_thickness"].shape)):
        here = film.isel(dict(zip(film["film_thickness"].dims, index, strict=True)))
        flattened = []
        for line in pair:
            waves = np.fft.rfft(line)
            wavelength = line.size * lines.attrs["spacing"] / np.arange(1, waves.size)
            kept = amplitude_ratio(
                wavelength / here["contact_half_width"].item(),
                here["moes_load"].item(),
                here["moes_material"].item(),
            )
            kept[wavelength < 2.0 * np.pi / np.max(lines.attrs["q_max"]) * (1.0 - 1e-9)] = 0.0
            plain = np.fft.irfft(waves * np.concatenate([[0.0], kept]), line.size)
            flattened.append(np.rint(plain).astype(np.int32))
        point = whole_numbers(
            [here["film_thickness"].item()], [here["contact_half_width"].item()], lines
        )
        (expected,) = scan_statistics(tuple(flattened), RATIOS, 12_000, *point, factor) / 12_000
        np.testing.assert_allclose(
            found[number, :3], expected[:3], atol=0 if second_radius else 1e-3
        )


def test_flattened_lines_touch_less_and_a_shape_that_is_thinner_more(shaped_film, coarse, weak):
    pair = line_pair(coarse, 0)
    share = {
        (with_shape, flattened): ContactRuns(
            coarse,
            shaped_film if with_shape else shaped_film.drop_vars("film_profile"),
            weak,
            flattened,
        ).statistics(pair, RATIOS, 30_000)[:, 0]
        for with_shape, flattened in itertools.product((False, True), (False, True))
    }
    for with_shape in (False, True):
        assert np.all(share[with_shape, True] < share[with_shape, False])


def test_where_a_shape_is_not_known_contact_is_not_either(shaped_film, coarse, weak):
    holed = shaped_film.copy(deep=True)
    holed["film_profile"][0, 1, 0, 0] = np.nan
    runs, pair = ContactRuns(coarse, holed, weak), line_pair(coarse, 0)
    whole = ContactRuns(coarse, shaped_film, weak).statistics(pair, RATIOS, 30_000)
    found = runs.statistics(pair, RATIOS, 30_000).reshape(2, 2, 2, 4)
    assert np.isnan(found[:, 1, 0]).all()  # of both film formulas
    assert runs.unknown.reshape(2, 2, 2)[:, 1, 0].all() and runs.unknown.sum() == 2
    np.testing.assert_array_equal(found[:, 0], whole.reshape(2, 2, 2, 4)[:, 0])
