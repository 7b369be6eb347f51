"""One pair of rough surfaces over a revolution: closed forms, and rollers drawn whole."""

import numpy as np
import pytest
import xarray as xr
from scipy import ndimage

from lube.contact import surface_strip
from lube.contact.pair_scatter import pair_deviation
from lube.contact.strip_film import StripFilm, surface_moments, surface_motion
from lube.contact.surface_strip import SURFACES as SAMPLED
from lube.contact.surface_strip import surface_contact
from lube.grid.gap import PLAIN
from lube.grid.operating_points import surface_speeds
from lube.inference.planning import half_widths, on_surfaces, relative_error
from lube.statistics.curves import contact_curve, film_interval
from lube.statistics.one_pair import quantile
from lube.surfaces.rough_surface import rough_surface

WIDTH, LENGTH = 3e-4, 5e-4
SURFACES, PAIRS = 8, 10
"""Surfaces drawn, and pairs of rollers from each: their circumference is the side."""
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
    bent = 1.0 + 0.6 * (across / WIDTH) ** 2 + 0.3 * (across / WIDTH) ** 3
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
        _, *common = film.passage(surface_moments(spec), LENGTH)
        ratios.append(found.std(ddof=1) / pair_deviation(found.mean(), *common, side))
    # Of 80 pairs a standard deviation is known to 8 %.
    assert np.all(np.abs(np.log(ratios)) < 0.2)
    assert abs(np.mean(np.log(ratios))) < 0.1


def test_contacts_are_in_the_strip_as_long_as_expected(spec, surface, rollers):
    moments, side = surface_moments(spec), surface.sides[1]
    for film in films_of(spec):
        width, *_ = film.passage(moments, LENGTH)
        films = film.films(surface.spacing[1])
        extents, numbers = 0.0, 0
        for heights in rollers[::4]:
            contacts, count = ndimage.label(heights > films.min())
            numbers += count
            if film.has_edges:
                sides = ndimage.find_objects(contacts)
                extents += sum(each[1].stop - each[1].start for each in sides) * surface.spacing[1]
        per_turn = numbers / len(rollers[::4])
        contacts, _ = film.expected(moments, LENGTH, 0.0)
        assert contacts * side / width == pytest.approx(per_turn, rel=0.1)
        if film.has_edges:
            assert width == pytest.approx(WIDTH + extents / numbers, rel=0.03)


@pytest.mark.parametrize(
    ("slip", "own"),
    [(0.0, {}), (0.5, {}), (2.0, {}), (0.5, {"lay_ratio": 2.0, "lay_angle": "40 deg"})],
)
def test_contacts_appear_with_slip_as_often_as_on_surfaces_in_motion(make_spec, slip, own):
    """Both surfaces are moved step by step, and contacts followed in time."""
    few = {"longest_wavelength": 4e-4, "shortest_wavelength": "16 points"}
    spec = make_spec(50_000, second_own=own, **few)
    surface = rough_surface(spec, contact=(6e-5, 6e-5), waves=6)
    moments, (rows, columns) = surface_moments(spec), surface.points
    film = StripFilm.flat(2.5 * np.sqrt(moments.height), 1e-4)
    width, steps, found = int(2e-4 / surface.spacing[1]), 160, []
    phase = 2j * np.pi / columns * np.arange(columns // 2 + 1)
    for seed in range(16):
        generator = np.random.default_rng(seed)
        waves = surface.draw(generator, surface.points)[2]
        both = [
            np.fft.rfft(np.fft.irfft2(each, surface.points), axis=1)
            for each in surface.of_each(waves, surface.points, generator)
        ]
        touching = np.empty((steps, rows, width), bool)
        for step in range(steps):
            moved = zip(both, surface_speeds(1.0, slip), strict=True)
            now = sum(each * np.exp(-step * speed * phase) for each, speed in moved)
            heights = np.fft.irfft(now, columns, axis=1)[:, :width] * spec.height_step
            touching[step] = heights > film.thickness(0.0)
        # A contact may be narrower than its way in a step.
        labels, count = ndimage.label(touching, np.ones((3, 3, 3)))
        found.append(count - np.unique(labels[0])[1:].size)
    way, side = (steps - 1) * surface.spacing[1], surface.sides[0]
    number, _ = film.expected(moments, side, 0.0)
    passage, *_ = film.passage(moments, side)
    appearing = film.appearing(moments, surface_motion(spec, slip), side) / passage
    error = np.std(found, ddof=1) / len(found) ** 0.5
    # Theory does not count contacts that merge, and pixels merge more.
    assert abs(np.mean(found) - number * appearing * way) < 3.0 * error + 0.08 * np.mean(found)
    assert error < 0.12 * np.mean(found)


def test_few_pairs_ever_touch_under_thick_films(spec, surface, rollers):
    """Groups of contacts come independently of one another."""
    rms, side = np.sqrt(surface_moments(spec).height), surface.sides[1]
    for ratio in (4.0, 4.4):
        film = StripFilm.flat(ratio * rms, 0.5 * WIDTH)
        found = shares(rollers, film.films(surface.spacing[1]))
        width, *_ = film.passage(surface_moments(spec), LENGTH)
        expected = -np.expm1(np.log1p(-found.mean()) * side / width)
        assert np.mean(found > 0.0) == pytest.approx(expected, abs=0.08)


def test_films_read_from_single_pairs_scatter_as_planned(
    spec, surface, rollers, study, monkeypatch
):
    """By the slope at the true film; each pair of whole rollers is a record a revolution long."""
    monkeypatch.setattr(surface_strip, "STRIPS", 250)  # the 80 pairs tell less even so
    moments, side = surface_moments(spec), surface.sides[1]
    films = {"film_thickness": ("film", np.array([2.6, 3.0]) * np.sqrt(moments.height))}
    films |= {"contact_half_width": 0.5 * WIDTH, "reduced_modulus": study.rollers.reduced_modulus}
    weak = study.boundary_layer.model_copy(update={"shear_strength": 1.0})
    given = spec, LENGTH, xr.Dataset(films), weak
    strips = [StripFilm.flat(film, 0.5 * WIDTH) for film in films["film_thickness"][1]]
    contact = surface_contact(*given, 3)
    share = contact["breakthrough_probability"].values
    each = zip(share, strips, strict=True)
    scatter = [pair_deviation(p, *one.passage(moments, LENGTH)[1:], side) for p, one in each]
    contact = contact.assign(pair_deviation=("film", scatter))
    found, size, ratios = on_surfaces(*given, PLAIN, 3, contact, 0.0, [1.0])
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
    monkeypatch.setattr(surface_strip, "STRIPS", 375)  # the 80 pairs tell less even so
    moments, side = surface_moments(spec), surface.sides[1]
    rms, ratios = np.sqrt(moments.height), np.geomspace(2.0, 5.0, 9)
    films = {"film_thickness": ("film", ratios * rms), "contact_half_width": 0.5 * WIDTH}
    films = xr.Dataset(films | {"reduced_modulus": study.rollers.reduced_modulus})
    found = surface_contact(spec, LENGTH, films, study.boundary_layer, 3, fewer=2)
    share, scatter = found["geometric_contact_probability"].values, []
    flat = {ratio: StripFilm.flat(ratio * rms, 0.5 * WIDTH) for ratio in (*ratios, *GAUGED)}
    for ratio, one in zip(ratios, share, strict=True):
        scatter.append(pair_deviation(one, *flat[ratio].passage(moments, LENGTH)[1:], side))
    sizes = share * (1.0 - share) / np.square(scatter)
    curve, held = contact_curve(np.log(ratios), share, sizes), []
    for ratio in GAUGED:
        for one in shares(rollers, flat[ratio].films(surface.spacing[1])):
            _, lower, upper = film_interval(curve, one, 1.0, SAMPLED // 2)
            held.append(lower <= np.log(ratio) <= upper)
    assert 0.92 < np.mean(held) < 0.99


def test_a_thicker_film_is_on_the_same_strip(spec):
    for strip in films_of(spec):
        thicker = strip.thicker(1.1)
        assert (thicker.begin, thicker.width) == (strip.begin, strip.width)
        np.testing.assert_allclose(thicker.films(1e-6), 1.1 * strip.films(1e-6), rtol=1e-12)
        rise = 0.0 - strip.breaking_curvatures(1e-6, 0.0)
        np.testing.assert_allclose(0.0 - thicker.breaking_curvatures(1e-6, 0.0), 1.1 * rise)
        np.testing.assert_array_equal(strip.thicker(1.0).films(1e-6), strip.films(1e-6))


def test_where_a_film_is_too_thick_for_any_contact_it_would_pass_as_under_a_thinner_one(spec):
    moments, motion = surface_moments(spec), surface_motion(spec, -0.5)
    rms, across = np.sqrt(moments.height), np.linspace(-2 * WIDTH, 2 * WIDTH, 401)
    for bend in (None, 0.1 * rms * (across / WIDTH) ** 2):
        found = []
        for ratio in (36.0, 60.0):
            film = StripFilm.flat(ratio * rms, 0.5 * WIDTH)
            if bend is not None:
                film = StripFilm.shaped(across, ratio * rms + bend, rms)
            width, *common = film.passage(moments, LENGTH)
            found.append([width, film.appearing(moments, motion, LENGTH)])
            assert pair_deviation(0.0, *common, 1.0) == 0.0
        np.testing.assert_allclose(*found, rtol=0.5)
