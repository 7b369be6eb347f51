"""Lines that meet a film: theory of one wave, then every combination against plain ways."""

import itertools

import numpy as np
import pytest
from literal_scan import scan_statistics

from lube.contact.windows import WINDOWS_PER_WIDTH, ContactWindows, Waves
from lube.grid.discretise import LineGrid, layer_factor_of, line_pair, whole_numbers
from lube.grid.gap import Gap
from lube.physics.flattening import amplitude_ratio
from lube.stages import film_table, lubricant_table, roughness_lines
from lube.surfaces.synthetic import draw_realisation

RATIOS = (1.0, 1.0)


@pytest.fixture(scope="module")
def coarse(make_spec):
    return roughness_lines(make_spec(30_000), 11, [0])


@pytest.fixture(scope="module")
def weak(study):
    return study.boundary_layer.model_copy(update={"shear_strength": 2e5})


GAPS = [
    Gap(*each)
    for each in itertools.product(("flat", "computed"), ("none", "venner-1997", "computed"))
]


@pytest.fixture(scope="module", params=GAPS)
def case(request, shaped_film, coarse, weak):
    """Flat and shaped films; lines as drawn, flattened and answered."""
    return request.param, ContactWindows(LineGrid.of(coarse), shaped_film, weak, request.param)


# One wave


@pytest.mark.parametrize("number", [1, 40, 400])
def test_a_wave_keeps_the_share_of_its_height_that_the_formula_gives(coarse, number):
    spacing, points = coarse.attrs["spacing"], 30_000
    wave = np.rint(1e6 * np.cos(2.0 * np.pi * number * np.arange(points) / points))
    found = Waves(wave.astype(np.int32), LineGrid.of(coarse)).flattened(100e-6, 30.0, 8.0)
    kept = amplitude_ratio(points * spacing / number / 100e-6, 30.0, 8.0)
    assert 0.0 < kept < 1.0
    np.testing.assert_allclose(found, kept * wave, atol=2.0)


def test_waves_beyond_the_band_are_left_out(coarse):
    points = 30_000
    number = int(1.5 * np.max(coarse.attrs["q_max"]) * points * coarse.attrs["spacing"] / 2 / np.pi)
    wave = np.rint(1e6 * np.cos(2.0 * np.pi * number * np.arange(points) / points))
    assert (
        np.abs(Waves(wave.astype(np.int32), LineGrid.of(coarse)).flattened(100e-6, 30.0, 8.0)).max()
        <= 1
    )


# All combinations


def test_some_operating_points_are_rows_of_all(case, coarse):
    _, windows = case
    pair, some = line_pair(coarse, 0), np.array([6, 1, 1, 3])
    every = windows.count(pair)
    np.testing.assert_array_equal(windows[some].count(pair), every[some])
    first, inverse = windows[some].distinct()
    assert (first.tolist(), inverse.tolist()) == ([0, 1, 3], [0, 1, 1, 2])
    np.testing.assert_array_equal(windows[some][first].count(pair)[inverse], every[some])
    assert 0.0 < every[:, 1].max() < 1.0


def test_statistics_are_means_of_the_traces(case, coarse):
    """To the bit under flat films and lines as drawn; flattened ones are rounded otherwise, and
    in uneven windows, one in some is looked at."""
    gap, windows = case
    pair = line_pair(coarse, 0)
    found, trace = windows.count(pair), windows.trace(pair)
    exact = gap.is_plain
    np.testing.assert_allclose(
        found[:, 1], np.mean(trace > 0, axis=1), rtol=1e-12 if exact else 0.1, atol=2e-4
    )


def test_a_film_with_a_shape_is_looked_at_in_evenly_spread_windows(shaped_film, coarse, weak):
    grid, pair = LineGrid.of(coarse), line_pair(coarse, 0)
    windows = ContactWindows(grid, shaped_film, weak, Gap("computed"))
    found, trace = windows.count(pair), windows.trace(pair)
    for point, half_window in enumerate(windows.half_windows):
        count = -(-30_000 // max(1, (2 * half_window + 1) // WINDOWS_PER_WIDTH))
        seen = trace[point, np.arange(count) * 30_000 // count]
        assert found[point, 1] == np.mean(seen > 0)
        assert found[point, 2] == np.mean(seen)


@pytest.mark.parametrize("second_radius", [None, 0.04])
def test_flattened_lines_under_flat_films_by_a_plain_filter_and_the_literal_scan(
    shaped_film, make_spec, weak, second_radius
):
    """Each line by a plain transform; unequal lines, which are not added before, are the same to
    the bit."""
    lines = roughness_lines(make_spec(12_000, second_radius), 11, [0])
    pair, film = line_pair(lines, 0), shaped_film.isel(film_formula=[0])
    grid = LineGrid.of(lines)
    found = ContactWindows(grid, film, weak, Gap("flat", "venner-1997")).count(pair)
    factor = layer_factor_of(grid, film["reduced_modulus"].item(), weak)
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
            [here["film_thickness"].item()], [here["contact_half_width"].item()], grid
        )
        (expected,) = scan_statistics(tuple(flattened), RATIOS, 12_000, *point, factor) / 12_000
        np.testing.assert_allclose(
            found[number, :3], expected[:3], atol=0 if second_radius else 1e-3
        )


def test_flattened_lines_touch_less_and_a_shape_that_is_thinner_more(shaped_film, coarse, weak):
    pair = line_pair(coarse, 0)
    share = {
        gap: ContactWindows(LineGrid.of(coarse), shaped_film, weak, gap).count(pair)[:, 0]
        for gap in GAPS
    }
    for shape in ("flat", "computed"):
        assert np.all(share[Gap(shape, "venner-1997")] < share[Gap(shape)])


def test_where_a_shape_is_not_known_contact_is_not_either(shaped_film, coarse, weak):
    holed = shaped_film.copy(deep=True)
    holed["film_profile"][0, 1, 0, 0] = np.nan
    grid, pair = LineGrid.of(coarse), line_pair(coarse, 0)
    windows = ContactWindows(grid, holed, weak, Gap("computed"))
    whole = ContactWindows(grid, shaped_film, weak, Gap("computed")).count(pair)
    found = windows.count(pair).reshape(2, 2, 2, 4)
    assert np.isnan(found[:, 1, 0]).all()  # of both film formulas
    assert windows.unknown.reshape(2, 2, 2)[:, 1, 0].all() and windows.unknown.sum() == 2
    np.testing.assert_array_equal(found[:, 0], whole.reshape(2, 2, 2, 4)[:, 0])


@pytest.mark.parametrize("shape", [pytest.param("flat", marks=pytest.mark.slow), "computed"])
def test_where_the_oil_answers_sampled_contact_is_as_often_as_counted(
    shape, shaped_film, make_spec, weak
):
    spec, pairs = make_spec(20_000), 40
    windows = ContactWindows(spec, shaped_film, weak, Gap(shape, "computed"))
    counted = [
        windows.count(draw_realisation(spec, 11, number))[:, :2].T for number in range(pairs)
    ]
    sampled = [windows.sample(spec, 11, number)[0] for number in range(pairs)]
    means = np.mean([counted, sampled], axis=1)
    errors = np.std([counted, sampled], axis=1, ddof=1) / pairs**0.5
    often = means[0] > 3e-3
    deviations = (means[1] - means[0]) / np.hypot(*errors)
    assert often.sum() >= 12 and np.abs(deviations[often]).max() < 4.0
    assert np.median(errors[1] / means[1]) < 0.02


def test_a_response_that_is_not_known_leaves_contact_unknown(shaped_film, coarse, weak):
    holed = shaped_film.copy(deep=True)
    holed["response_real"][:, 0, 1, 0, 0] = np.nan
    windows = ContactWindows(LineGrid.of(coarse), holed, weak, Gap("flat", "computed"))
    unknown = windows.unknown.reshape(2, 2, 2)
    assert unknown[:, 1, 0].all() and unknown.sum() == 2
    found = windows.count(line_pair(coarse, 0))
    np.testing.assert_array_equal(np.isnan(found).all(axis=1), windows.unknown)


def test_points_that_differ_in_slip_alone_are_told_apart_where_the_oil_answers(
    shaped_film, make_spec, weak, study
):
    spec = make_spec(20_000)
    oil = lubricant_table(study.lubricants, [60.0])
    levels = [400.0], [100.0], ["paper"]
    slips = {"slide_to_roll_ratio": [0.0, 1.0]}
    sliding = film_table(oil, study.rollers, *levels, **slips, answered_lines=spec)
    sliding = sliding.isel(slide_to_roll_ratio=[0, 1, 0])
    answered = ContactWindows(spec, sliding, weak, Gap("flat", "computed"))
    assert answered.distinct()[1].tolist() == [0, 1, 0]
    # The same conditions have the same key in any table: so a record finds what is stored.
    again = film_table(oil, study.rollers, *levels, answered_lines=spec)
    (key,) = ContactWindows(spec, again, weak, Gap("flat", "computed")).keys
    assert key == answered.keys[0] != answered.keys[1]


def test_lines_that_the_oil_lifts_far_under_a_thin_film_are_counted_as_often_as_sampled(
    make_spec, weak, study
):
    """The greatest conceivable height is beyond the profile's ends, no height that occurs is."""
    spec = make_spec(20_000)
    oil = lubricant_table(study.lubricants, [80.0])
    shape = {"with_shape": True, "slide_to_roll_ratio": [1.0], "answered_lines": spec}
    film = film_table(oil, study.rollers, [20.0], [0.5], ["computed"], **shape)
    windows = ContactWindows(spec, film, weak, Gap("computed", "computed"))
    counted = [windows.count(draw_realisation(spec, 11, n), 1.0)[0, 0] for n in range(4)]
    sampled = [windows.sample(spec, 11, n)[0][0, 0] for n in range(40)]
    assert np.mean(counted) == pytest.approx(np.mean(sampled), rel=0.05)
