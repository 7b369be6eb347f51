"""One pair of rough surfaces over a revolution: closed forms, and rollers drawn whole."""

import numpy as np
import pytest
import xarray as xr
from scipy import ndimage
from whole_surfaces import Filtered, Unchanged, answered_strip, begun, drawn_waves, in_motion

from lube.contact import strip_sampling
from lube.contact.pair_scatter import pair_deviation
from lube.contact.rough_pair import RoughPair
from lube.contact.strip_film import StripFilm, curvature_moments, surface_moments
from lube.contact.surface_answers import COARSEST
from lube.contact.surface_strip import SURFACES as SAMPLED
from lube.contact.surface_strip import surface_contact
from lube.inference.planning import half_widths, on_surfaces, relative_error
from lube.inference.surface_scatter import pair_correlation
from lube.statistics.curves import contact_curve, film_interval
from lube.statistics.one_pair import quantile
from lube.surfaces.rough_surface import field, rough_surface

WIDTH, LENGTH = 3e-4, 5e-4
SURFACES, PAIRS = 8, 10
"""Surfaces drawn, and pairs of rollers from each: their circumference is the side."""
FEW = {"longest_wavelength": 4e-4, "shortest_wavelength": "16 points"}
STEPS = 160
"""Waves of surfaces in motion, and steps of their way."""
GAUGED = (2.6, 3.0, 3.4, 3.8)
"""Lambda ratios that are read from the pairs' shares."""


@pytest.fixture(scope="module")
def spec(make_spec):
    return make_spec(50_000, longest_wavelength=4e-4, shortest_wavelength="3.2 points")


@pytest.fixture(scope="module")
def surface(spec):
    return rough_surface(spec, waves=24)


@pytest.fixture(scope="module")
def rollers(spec, surface):
    """Heights of pairs of rollers, metres, shape (pairs, along the rollers, around them)."""
    rows, apart = int(LENGTH / surface.spacing[0]), surface.points[0] // PAIRS
    assert (apart - rows) * surface.spacing[0] > spec.longest_wavelength
    found = []
    for number in range(SURFACES):
        heights = surface.draw(np.random.default_rng(number))[0]
        found += [heights[pair * apart : pair * apart + rows] for pair in range(PAIRS)]
    return spec.height_step * np.stack(found)


def films_of(spec):
    rms = np.sqrt(surface_moments(spec).height)
    across = np.linspace(-2 * WIDTH, 2 * WIDTH, 401)
    bent = 1.0 + 0.6 * (across / WIDTH) ** 2 + 0.1 * (across / WIDTH) ** 3
    for ratio in (2.7, 3.1, 3.5):
        yield StripFilm.flat(ratio * rms, 0.5 * WIDTH)
        yield StripFilm.shaped(across, ratio * rms * bent, rms)


def shares(rollers, film):
    """Share of a revolution in which each pair touches."""
    tops = rollers.max(axis=1)
    touching = np.zeros(tops.shape, bool)
    for column, height in enumerate(film):
        touching |= np.roll(tops, -column, axis=1) > height
    return touching.mean(axis=1)


def test_the_share_of_a_revolution_scatters_between_pairs_as_expected(spec, surface, rollers):
    side, ratios = surface.sides[1], []
    for film in films_of(spec):
        found = shares(rollers, film.films(surface.spacing[1]))
        expected = pair_deviation(found.mean(), *film.common(spec, LENGTH), side)
        ratios.append(found.std(ddof=1) / expected)
    # Of 80 pairs a standard deviation is known to 8 %.
    assert np.all(np.abs(np.log(ratios)) < 0.2)
    assert abs(np.mean(np.log(ratios))) < 0.1


def test_records_of_a_pair_are_correlated_as_pairs_drawn_whole(spec, surface, rollers):
    found = []
    for ratio in (2.7, 3.1, 3.5):
        film = StripFilm.flat(ratio * np.sqrt(surface_moments(spec).height), 0.5 * WIDTH)
        found.append(shares(rollers, film.films(surface.spacing[1])))
    expected = pair_correlation(np.mean(found, axis=1))
    # Of 80 pairs correlations are known to 0.1.
    np.testing.assert_allclose(np.corrcoef(found), expected, atol=0.25)


def answered_shares(spec, surface, strip, generator):
    """Share of a revolution in which each pair touches that the oil answers; see `rollers`."""
    answer, waves = strip.answers[0], surface.draw(generator)[2]
    films = (strip.films(surface.spacing[1]) / spec.height_step).astype(np.float32)
    position = strip.columns(surface.spacing[1])
    spacing = np.divide(surface.sides, surface.coarse)
    down, along = np.meshgrid(
        2.0 * np.pi * np.fft.fftfreq(surface.coarse[0], spacing[0]),
        2.0 * np.pi * np.fft.rfftfreq(surface.coarse[1], spacing[1]),
        indexing="ij",
    )
    functions = np.ones((films.size, 1)), answer.at(position / answer.half_width)
    filters = answer.filters_at(np.maximum(along, 1.0).ravel(), down.ravel())
    fields = []
    for own in (1.0, *filters.T.reshape(-1, *along.shape)):
        rough = field(waves * own, surface.points).astype(np.float32)
        fields.append(np.hstack([rough, rough[:, : films.size]]))
    functions = np.hstack(functions).astype(np.float32)
    rows, apart = int(LENGTH / surface.spacing[0]), surface.points[0] // PAIRS
    touching = []
    for step in range(0, surface.points[1], 2):
        here = slice(step, step + films.size)
        gap = sum(each[:, here] * own for each, own in zip(fields, functions.T, strict=True))
        tops = (gap > films).any(axis=1)
        touching.append([tops[row : row + rows].any() for row in range(0, PAIRS * apart, apart)])
    return np.mean(touching, axis=0)


@pytest.mark.slow
@pytest.mark.parametrize("film_shape", ["flat", "computed"])
def test_shares_scatter_between_pairs_that_the_oil_answers_as_expected(
    study, spec, surface, film_shape
):
    strip, _ = answered_strip(study, spec, film_shape, 0.0, 2.4)
    seeds = map(np.random.default_rng, range(SURFACES))
    found = np.ravel([answered_shares(spec, surface, strip, seed) for seed in seeds])
    expected = pair_deviation(found.mean(), *strip.common(spec, LENGTH), surface.sides[1])
    assert 0.2 < found.mean() < 0.7
    assert abs(np.log(found.std(ddof=1) / expected)) < 0.2


def test_contacts_are_in_the_strip_as_long_as_expected(spec, surface, rollers):
    side = surface.sides[1]
    for film in films_of(spec):
        width = film.passage_width(spec, LENGTH)
        films = film.films(surface.spacing[1])
        extents, numbers = 0.0, 0
        for heights in rollers[::2]:
            contacts, count = ndimage.label(heights > films.min())
            numbers += count
            if film.has_edges:
                sides = ndimage.find_objects(contacts)
                extents += sum(each[1].stop - each[1].start for each in sides) * surface.spacing[1]
        per_turn = numbers / len(rollers[::2])
        contacts, _ = film.expected(spec, LENGTH, 0.0)
        assert contacts * side / width == pytest.approx(per_turn, rel=0.1)
        if film.has_edges:
            assert width == pytest.approx(WIDTH + extents / numbers, rel=0.03)


def contacts_in_motion(spec, surface, heights, film, slip):
    """Mean number of contacts, and new ones, as surfaces move step by step; over surfaces.

    `heights` makes the heights in the gap from the waves of both surfaces.
    """
    columns = film.films(surface.spacing[1]) / spec.height_step
    found = []
    for seed in range(16):
        waves = in_motion(surface, np.random.default_rng(seed), slip, STEPS)
        touching = np.array([heights(now)(0, columns.size) > columns for now in waves])
        number = np.mean([ndimage.label(step)[1] for step in touching[::8]])
        found.append([number, begun(touching)])
    return np.transpose(found)


def compare_in_motion(spec, surface, heights, film, slip):
    """Compare the contacts that theory expects with those counted."""
    way, side = (STEPS - 1) * surface.spacing[1], surface.sides[0]
    _, number, appearing = film.contacts(spec, side, slip)
    counted = contacts_in_motion(spec, surface, heights, film, slip)
    for expected, found in zip((number, appearing * way), counted, strict=True):
        error = np.std(found, ddof=1) / len(found) ** 0.5
        # Theory does not count contacts that merge, and pixels merge more.
        assert abs(np.mean(found) - expected) < 3.0 * error + 0.08 * np.mean(found)
        assert error < 0.2 * np.mean(found)


@pytest.mark.parametrize(
    ("slip", "own"),
    [(0.0, {}), (0.5, {}), (2.0, {}), (0.5, {"lay_ratio": 2.0, "lay_angle": "40 deg"})],
)
def test_contacts_appear_with_slip_as_often_as_on_surfaces_in_motion(make_spec, slip, own):
    """Both surfaces are moved step by step, and contacts followed in time."""
    spec = make_spec(50_000, second_own=own, **FEW)
    surface = rough_surface(spec, contact=(6e-5, 6e-5), waves=6)
    film = StripFilm.flat(2.5 * np.sqrt(surface_moments(spec).height), 1e-4)
    compare_in_motion(spec, surface, Unchanged(surface).heights, film, slip)


@pytest.mark.parametrize("own", [{}, {"lay_ratio": 2.0, "lay_angle": "40 deg"}])
def test_layers_are_broken_with_slip_as_long_as_on_surfaces_in_motion(make_spec, own):
    """Summits become sharper and blunter where the layer of most contacts holds."""
    slip, spec = 0.5, make_spec(50_000, second_own=own, **FEW)
    surface = rough_surface(spec, contact=(4e-5, 4e-5), waves=6)
    moments = surface_moments(spec)
    film, sharp = 2.5 * np.sqrt(moments.height), 1.5 * np.sqrt(moments.curvature)
    columns = 2e-4 / surface.spacing[1]
    strip = StripFilm.flat(film, 0.5 * round(columns) * surface.spacing[1])
    found = []
    for seed in range(12):
        broken, number = [], 0
        for both in in_motion(surface, np.random.default_rng(seed), slip, STEPS):
            waves = sum(both)
            curved = field(waves * surface.curvatures, surface.points)[:, : round(columns)]
            heights = field(waves, surface.points)[:, : round(columns)]
            labels, count = ndimage.label(heights * spec.height_step > film)
            tops = ndimage.maximum_position(heights, labels, np.arange(1, count + 1))
            breaks = [spec.height_step * curved[top] > sharp for top in tops]
            broken.append(np.array([False, *breaks])[labels])
            number += sum(breaks)
        found.append([number / STEPS, begun(broken)])
    number, appeared = np.mean(found, axis=0)
    way = (STEPS - 1) * surface.spacing[1]
    expected = strip.breakthrough_width(spec, surface.sides[0], sharp, slip)
    assert number * way / appeared == pytest.approx(expected, rel=0.2)
    assert expected < 0.65 * strip.passage_width(spec, surface.sides[0], slip)


@pytest.mark.parametrize(
    ("film_shape", "slip", "lay"),
    [
        ("flat", 0.0, {}),
        pytest.param("computed", 0.5, {}, marks=pytest.mark.slow),
        pytest.param("flat", 0.5, {"lay_ratio": 2.0, "lay_angle": 60.0}, marks=pytest.mark.slow),
    ],
)
def test_contacts_that_the_oil_answers_appear_as_often_as_on_surfaces_in_motion(
    study, make_spec, film_shape, slip, lay
):
    """Waves that the oil lowers on their way touch for a shorter time than surfaces as drawn."""
    spec = make_spec(50_000, **FEW, **lay)
    surface = rough_surface(spec, contact=(6e-5, 6e-5), waves=6, multiple=2**COARSEST)
    strip, film = answered_strip(study, spec, film_shape, slip, 2.0)
    compare_in_motion(spec, surface, Filtered(surface, strip, film).heights, strip, slip)


def test_few_pairs_ever_touch_under_thick_films(spec, surface, rollers):
    """Groups of contacts come independently of one another."""
    rms, side = np.sqrt(surface_moments(spec).height), surface.sides[1]
    for ratio in (4.0, 4.4):
        film = StripFilm.flat(ratio * rms, 0.5 * WIDTH)
        found = shares(rollers, film.films(surface.spacing[1]))
        width = film.passage_width(spec, LENGTH)
        expected = -np.expm1(np.log1p(-found.mean()) * side / width)
        assert np.mean(found > 0.0) == pytest.approx(expected, abs=0.08)


def test_films_read_from_single_pairs_scatter_as_planned(
    spec, surface, rollers, study, monkeypatch
):
    """By the slope at the true film; each pair of whole rollers is a record a revolution long."""
    monkeypatch.setattr(strip_sampling, "STRIPS", 250)  # the 80 pairs tell less even so
    moments, side = surface_moments(spec), surface.sides[1]
    films = {"film_thickness": ("film", np.array([2.6, 3.0]) * np.sqrt(moments.height))}
    films |= {"contact_half_width": 0.5 * WIDTH, "reduced_modulus": study.rollers.reduced_modulus}
    weak = study.boundary_layer.model_copy(update={"shear_strength": 1.0})
    given = RoughPair(spec, LENGTH, weak, 3), xr.Dataset(films)
    strips = [StripFilm.flat(film, 0.5 * WIDTH) for film in films["film_thickness"][1]]
    contact = surface_contact(*given)
    share = contact["breakthrough_probability"].values
    each = zip(share, strips, strict=True)
    scatter = [pair_deviation(p, *one.common(spec, LENGTH), side) for p, one in each]
    contact = contact.assign(pair_deviation=("film", scatter))
    found, size, ratios, _ = on_surfaces(*given, contact, 0.0, [1.0])
    error = relative_error(share, size, ratios)
    expected = half_widths(found, np.ones(share.size), error, SAMPLED)[0, 0]
    seen = [shares(rollers, strip.films(surface.spacing[1])) for strip in strips]
    read = (np.stack(seen, axis=1) / share - 1.0) / found.by_film
    seen = quantile(SAMPLED) * read.std(axis=0, ddof=1)
    np.testing.assert_allclose(expected, seen, rtol=0.25)


def test_films_read_from_single_pairs_have_intervals_that_hold_the_true_film(
    spec, surface, rollers, study, monkeypatch
):
    """Each pair of whole rollers is the record of a rig, a revolution long."""
    monkeypatch.setattr(strip_sampling, "STRIPS", 375)  # the 80 pairs tell less even so
    moments, side = surface_moments(spec), surface.sides[1]
    rms, ratios = np.sqrt(moments.height), np.geomspace(2.0, 5.0, 9)
    films = {"film_thickness": ("film", ratios * rms), "contact_half_width": 0.5 * WIDTH}
    films = xr.Dataset(films | {"reduced_modulus": study.rollers.reduced_modulus})
    pair = RoughPair(spec, LENGTH, study.boundary_layer, 3)
    found = surface_contact(pair, films, fewer=2)
    share, scatter = found["geometric_contact_probability"].values, []
    flat = {ratio: StripFilm.flat(ratio * rms, 0.5 * WIDTH) for ratio in (*ratios, *GAUGED)}
    for ratio, one in zip(ratios, share, strict=True):
        scatter.append(pair_deviation(one, *flat[ratio].common(spec, LENGTH), side))
    sizes = share * (1.0 - share) / np.square(scatter)
    curve, held = contact_curve(np.log(ratios), share, sizes), []
    for ratio in GAUGED:
        for one in shares(rollers, flat[ratio].films(surface.spacing[1])):
            _, lower, upper = film_interval(curve, one, 1.0, SAMPLED // 2)
            held.append(lower <= np.log(ratio) <= upper)
    assert 0.92 < np.mean(held) < 0.99


def test_where_a_film_is_too_thick_for_any_contact_it_would_pass_as_under_a_thinner_one(spec):
    rms, across = np.sqrt(surface_moments(spec).height), np.linspace(-2 * WIDTH, 2 * WIDTH, 401)
    for bend in (None, 0.1 * rms * (across / WIDTH) ** 2):
        found = []
        for ratio in (36.0, 60.0):
            film = StripFilm.flat(ratio * rms, 0.5 * WIDTH)
            if bend is not None:
                film = StripFilm.shaped(across, ratio * rms + bend, rms)
            found.append([film.passage_width(spec, LENGTH, slip) for slip in (0.0, -0.5)])
            assert pair_deviation(0.0, *film.common(spec, LENGTH), 1.0) == 0.0
        np.testing.assert_allclose(*found, rtol=0.5)


def test_a_thicker_film_is_on_the_same_strip(spec):
    for strip in films_of(spec):
        thicker = strip.thicker(1.1)
        assert (thicker.begin, thicker.width) == (strip.begin, strip.width)
        np.testing.assert_allclose(thicker.films(1e-6), 1.1 * strip.films(1e-6), rtol=1e-12)
        position = strip.columns(1e-6)
        rise = 0.0 - strip.breaking_curvatures(position, 0.0)
        np.testing.assert_allclose(0.0 - thicker.breaking_curvatures(position, 0.0), 1.1 * rise)
        np.testing.assert_array_equal(strip.thicker(1.0).films(1e-6), strip.films(1e-6))


def test_the_gap_is_that_of_surfaces_as_drawn(spec):
    rms = np.sqrt(surface_moments(spec).height)
    for strip in films_of(spec):
        film, found = strip.gap(spec, 0.5 * WIDTH)
        expected = strip.thickness(0.5 * np.linspace(-WIDTH, WIDTH, 200))
        np.testing.assert_allclose(film, expected, rtol=1e-12)
        np.testing.assert_allclose(found, rms, rtol=1e-12)


@pytest.mark.parametrize("film_shape", ["flat", "computed"])
def test_the_roughness_in_the_gap_is_that_of_drawn_surfaces_as_the_oil_answers_them(
    study, make_spec, film_shape
):
    spec = make_spec(50_000, longest_wavelength=4e-4, shortest_wavelength="16 points")
    strip, film = answered_strip(study, spec, film_shape, 0.4, ratio=3.0)
    surface, half_width = rough_surface(spec), film["contact_half_width"].item()
    generator, columns = np.random.default_rng(1), strip.films(surface.spacing[1]).size
    kinds, square = (Filtered(surface, strip, film), Unchanged(surface)), np.zeros((2, columns))
    for _ in range(8):
        waves = drawn_waves(surface, generator)
        for number, surfaces in enumerate(kinds):
            heights = surfaces.heights(waves)
            for column in range(0, surface.points[1] - columns, surface.points[1] // 8):
                square[number] += np.mean(heights(column, columns) ** 2, axis=0)
    position = strip.columns(surface.spacing[1])
    inside = np.abs(position) < half_width
    mean, rms = strip.gap(spec, half_width)
    across = np.linspace(-half_width, half_width, rms.size)
    expected = np.interp(position[inside], across, rms) / spec.height_step / surface.rms
    np.testing.assert_allclose(np.sqrt(square[0] / square[1])[inside], expected, rtol=0.03)
    assert expected.min() < 0.9
    np.testing.assert_allclose(mean, strip.thickness(across), rtol=1e-12)


@pytest.mark.parametrize("lay", [{}, {"lay_ratio": 3.0, "lay_angle": 60.0}])
def test_moments_of_the_surface_do_not_depend_on_the_grid_of_the_lines(make_spec, lay):
    coarse, fine = (
        make_spec(points, longest_wavelength=4e-4, shortest_wavelength=f"{each} points", **lay)
        for points, each in ((50_000, 4), (200_000, 16))
    )
    np.testing.assert_allclose(surface_moments(coarse), surface_moments(fine), rtol=1e-3)
    if lay:
        np.testing.assert_allclose(curvature_moments(coarse), curvature_moments(fine), rtol=1e-3)


def test_curvatures_with_a_lay_are_those_of_the_surface(make_spec):
    """By the waves of the surface; the second roller's ridges are at an angle."""
    lay = {"lay_ratio": 3.0, "lay_angle": "30 deg"}
    spec = make_spec(
        50_000, longest_wavelength=4e-4, shortest_wavelength="16 points", second_own=lay
    )
    surface = rough_surface(spec, waves=12)
    units = 2.0 * np.pi / np.array(surface.sides)
    down = units[0] * np.fft.fftfreq(surface.coarse[0], 1.0 / surface.coarse[0])[:, None]
    along = units[1] * np.arange(surface.coarse[1] // 2 + 1)
    power = surface.variances * np.where(along, 2.0, 1.0) * spec.height_step**2
    curved = 0.5 * (along**2 + down**2), 0.5 * (along**2 - down**2), along * down
    expected = [[np.sum(power * one * other) for one in curved] for other in curved]
    found = curvature_moments(spec)
    np.testing.assert_allclose(found, expected, rtol=0.05, atol=0.01 * found[0, 0])
    assert curvature_moments(make_spec(50_000)) is None
