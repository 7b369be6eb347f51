"""One pair of surfaces: limits of the theory, then surfaces drawn and paired crosswise."""

from functools import partial

import numpy as np
import pytest
import scipy.fft
import scipy.ndimage
from scipy.stats import multivariate_normal, norm

from lube.contact.pair_scatter import (
    RecurringContacts,
    drifting_shares,
    pair_deviation,
    persistent_part,
    slip_ratio,
)
from lube.contact.strip_film import StripFilm, surface_moments
from lube.grid.discretise import speed_ratios
from lube.statistics.one_pair import drift_factor, repeat_factor
from lube.surfaces.rough_surface import field, rough_surface

WIDTH, LENGTH = 3e-4, 5e-4
LINES = {"longest_wavelength": 4e-4, "shortest_wavelength": "3.2 points"}
RATIOS = 2.3, 2.7, 3.1
PAIRED = 60


def test_contacts_of_one_surface_alone_all_recur(make_spec):
    """The other is smooth, so that every alignment is the same."""
    spec = make_spec(50_000, second_roughness=1e-9, **LINES)
    first, second = RecurringContacts(spec).at(3.0)
    assert first == pytest.approx(1.0, abs=0.01)
    assert second == pytest.approx(0.0, abs=1e-4)


def test_the_higher_the_film_the_fewer_contacts_recur(make_spec):
    found = [RecurringContacts(make_spec(50_000, **LINES)).at(film) for film in (1.0, 2.0, 4.0)]
    np.testing.assert_allclose(*np.transpose(found), rtol=1e-9)  # equal surfaces
    assert np.all(np.diff(found, axis=0) < 0.0) and 0.0 < found[-1][0] < found[0][0] < 0.5


def test_the_fewer_layers_break_the_fewer_break_again_in_a_new_alignment(make_spec):
    recurring = RecurringContacts(make_spec(50_000, **LINES))
    found = [recurring.at(3.0, part)[0] for part in (1.0, 0.9, 0.5, 0.1, 0.0)]
    assert found[0] == pytest.approx(recurring.at(3.0)[0]) and found[-1] < 1e-6
    assert np.all(np.diff(found) < 0.0)
    # Curvatures of both alignments have the correlation 1/4.
    levels = -norm.ppf(0.9) * np.ones(2)
    again = multivariate_normal.cdf(levels, cov=[[1.0, 0.25], [0.25, 1.0]]) / 0.1
    assert found[3] == pytest.approx(again * found[0], rel=1e-3)


def test_layers_of_one_surface_alone_all_break_again(make_spec):
    recurring = RecurringContacts(make_spec(50_000, second_roughness=1e-9, **LINES))
    assert recurring.at(3.0, 0.1)[0] == pytest.approx(1.0, abs=0.02)


def test_above_all_summits_no_contact_recurs(make_spec):
    assert RecurringContacts(make_spec(50_000, **LINES)).at(50.0).tolist() == [0.0, 0.0]


def test_recurring_contacts_are_those_of_the_integral(make_spec):
    """By the sum over the grid of the bivariate normal distribution."""
    spec, film = make_spec(20_000, **LINES | {"shortest_wavelength": "8 points"}), 2.0
    surface = rough_surface(spec)
    correlation = field(surface.variances, surface.points)
    correlation = (correlation / surface.rms**2)[::7, ::7].ravel()
    chance = multivariate_normal.cdf([-film, -film], cov=np.eye(2))

    def excess(values):
        levels = np.linspace(-0.6, 0.999999, 300)
        known = [
            multivariate_normal.cdf([-film, -film], cov=[[1.0, one], [one, 1.0]]) - chance
            for one in levels
        ]
        return np.interp(values, levels, known).sum()

    expected = excess(0.5 * correlation) / excess(correlation)
    assert RecurringContacts(spec).at(film)[0] == pytest.approx(expected, rel=0.05)


def test_the_part_is_none_where_no_contact_recurs_and_all_where_all_do():
    lags, common = np.linspace(0.0, 1.0, 50), np.linspace(1.0, 0.0, 50)
    for share in (1e-9, 0.3, 0.95):
        assert not persistent_part(share, lags, common, np.zeros(2)).any()
        whole = persistent_part(share, lags, common, np.array([1.0, 0.0]))
        assert whole == pytest.approx([1.0, 0.0])
    rare = persistent_part(1e-9, lags, common, np.array([0.1, 0.2]))
    assert rare == pytest.approx([0.1, 0.2])


def test_new_alignments_leave_the_scatter_that_theory_says(make_spec):
    """Analysis of variance of surfaces paired crosswise, for a revolution each.

    The effect of either surface alone, over all of the variance.
    """
    spec = make_spec(50_000, **LINES)
    surface, moments = rough_surface(spec, waves=24), surface_moments(spec)
    firsts, seconds = drawn_rollers(spec, surface)
    recurring, ratios = RecurringContacts(spec), []
    films = [StripFilm.flat(ratio * np.sqrt(moments.height), 0.5 * WIDTH) for ratio in RATIOS]
    columns = films[0].films(surface.spacing[1]).size
    shares = np.empty((len(films), PAIRED, PAIRED))
    for number, first in enumerate(firsts):
        tops = np.max(first + seconds, axis=1)
        highest = scipy.ndimage.maximum_filter1d(tops, columns, axis=1, mode="wrap")
        for film, found in zip(films, shares, strict=True):
            found[number] = np.mean(highest > film.thickness(0.0), axis=1)
    for film, ratio, found in zip(films, RATIOS, shares, strict=True):
        by_first, by_second = found.mean(axis=1), found.mean(axis=0)
        rest = found - by_first[:, None] - by_second + found.mean()
        together = np.sum(rest**2) / (PAIRED - 1) ** 2
        alone = by_first.var(ddof=1) + by_second.var(ddof=1) - 2.0 * together / PAIRED
        contacts = found.mean(), *film.common(spec, LENGTH)
        expected = persistent_part(*contacts, recurring.at(ratio)).sum()
        ratios.append(alone / (alone + together) / expected)
    # By 360 surfaces 0.87, 0.94 and 1.01, each +- 0.05.
    assert np.all((np.array(ratios) > 0.65) & (np.array(ratios) < 1.3))


@pytest.mark.parametrize(
    "slip", [-1.5, *(pytest.param(slip, marks=pytest.mark.slow) for slip in (0.3, 2.0))]
)
def test_turns_with_slip_scatter_as_theory_says(make_spec, slip):
    """On whole rollers that are moved step by step; also in shorter records."""
    spec = make_spec(50_000, **LINES)
    surface = rough_surface(spec, waves=24)
    around, side = surface.points[1], surface.sides[1]
    speeds, found = speed_ratios(slip), []
    rms = np.sqrt(surface_moments(spec).height)
    films = [StripFilm.flat(ratio * rms, 0.5 * WIDTH) for ratio in RATIOS]
    columns = films[0].films(surface.spacing[1]).size
    for pair in zip(*drawn_rollers(spec, surface), strict=True):
        twice = [np.hstack([heights, heights[:, :columns]]) for heights in pair]
        tops = np.empty(around)
        for step in range(around):
            places = [round(-step * speed) % around for speed in speeds]
            both = zip(twice, places, strict=True)
            tops[step] = sum(each[:, place : place + columns] for each, place in both).max()
        found.append(tops)
    found, ratios, recurring = np.array(found), [], RecurringContacts(spec)
    for turns in (0.2, 1.0):
        tops = found[:, : int(turns * around)]
        for ratio, film in zip(RATIOS, films, strict=True):
            shares, contacts = (tops > film.thickness(0.0)).mean(axis=1), film.common(spec, LENGTH)
            passages = [film.passage_width(spec, LENGTH, each) for each in (slip, 0.0)]
            known = shares.mean(), *contacts, recurring.at(ratio), passages, slip, (side, side)
            expected = slip_ratio(*known, turns) ** 0.5 * pair_deviation(known[0], *contacts, side)
            ratios.append(shares.std(ddof=1) / expected)
    # Of 60 pairs the scatter is known to 9 %.
    assert np.all(np.abs(np.log(ratios)) < 0.3)
    assert abs(np.mean(np.log(ratios))) < 0.15


@pytest.mark.parametrize("slip", [0.5, pytest.param(-1.5, marks=pytest.mark.slow)])
def test_turns_with_slip_scatter_less_where_most_layers_hold(make_spec, slip):
    """On whole rollers that are moved step by step, whose contacts often break and hold."""
    spec = make_spec(50_000, **LINES | {"shortest_wavelength": "12 points"})
    surface = rough_surface(spec, contact=(4e-5, 4e-5), waves=24)
    moments, around, side = surface_moments(spec), surface.points[1], surface.sides[1]
    film = StripFilm.flat(2.2 * np.sqrt(moments.height), 0.5 * WIDTH)
    sharp, columns = 1.5 * np.sqrt(moments.curvature), film.films(surface.spacing[1]).size
    part = film.breaking_part(spec, LENGTH, sharp)
    assert 0.05 < part < 0.25
    drawn = [drawn_rollers(spec, surface, filters) for filters in (1.0, surface.curvatures)]
    steps = range(0, around, 3)
    found = np.zeros((PAIRED, len(steps)), bool)
    twice = [[np.concatenate([each, each[..., :columns]], -1) for each in one] for one in drawn]
    for number, step in np.ndindex(found.shape):
        first, second = (round(-steps[step] * speed) % around for speed in speed_ratios(slip))
        heights, curved = (
            one[number, :, first : first + columns] + other[number, :, second : second + columns]
            for one, other in twice
        )
        tops = heights == scipy.ndimage.maximum_filter(heights, 3)
        found[number, step] = np.any(tops & (heights > film.thickness(0.0)) & (curved > sharp))
    known = found.mean(), *film.common(spec, LENGTH), RecurringContacts(spec).at(2.2, part)
    ways = [film.passage_width(spec, LENGTH, each) for each in (slip, 0.0)]
    broken = part, film.breakthrough_width(spec, LENGTH, sharp, slip)
    ratio = slip_ratio(*known, ways, slip, (side, side), broken=broken)
    scatter = found.mean(axis=1).std(ddof=1) / pair_deviation(*known[:3], side)
    # Of 60 pairs the scatter is known to 9 %.
    assert abs(np.log(scatter / ratio**0.5)) < 0.25
    ratio = slip_ratio(*known[:3], RecurringContacts(spec).at(2.2), ways, slip, (side, side))
    assert scatter < 0.7 * ratio**0.5


def test_turns_share_all_contacts_without_a_drift_and_none_if_it_renews_everything(make_spec):
    recurring = RecurringContacts(make_spec(50_000, **LINES))
    first = recurring.at(3.0)[0]
    # The other surface has as much of the roughness, and is new.
    assert recurring.drifted(3.0, np.array([1.0, 0.5, 0.0])) == pytest.approx(
        [1.0, first, 0.0], abs=1e-4
    )
    lags, common = np.linspace(0.0, 1.0, 50), np.linspace(1.0, 0.0, 50)
    for share in (1e-9, 0.3, 0.95):
        known = share, lags, common, lambda correlation: recurring.drifted(3.0, correlation)
        alike = drifting_shares(*known)(np.array([1.0, 0.99, 0.5, 0.0]))
        assert np.all(np.diff(alike) < 0.0) and alike[1] < 0.96
        assert alike[[0, -1]] == pytest.approx([1.0, 0.0])


def test_turns_of_drifting_surfaces_scatter_as_theory_says(make_spec):
    """Drawn surfaces, of which each turn renews a part."""
    spec, turns, drift = make_spec(50_000, **LINES), 8, 0.1
    surface, recurring = rough_surface(spec, waves=24), RecurringContacts(spec)
    rms, side = np.sqrt(surface_moments(spec).height), surface.sides[1]
    films = [StripFilm.flat(ratio * rms, 0.5 * WIDTH) for ratio in RATIOS]
    columns = films[0].films(surface.spacing[1]).size
    rows, apart = int(LENGTH / surface.spacing[0]), surface.points[0] // 10
    shares = np.empty((len(films), turns, PAIRED))
    for seed in range(PAIRED // 10):
        generator, waves = np.random.default_rng(seed), 0.0
        for turn in range(turns):
            kept, new = (0.0, 1.0) if turn == 0 else (np.sqrt(1.0 - drift), np.sqrt(drift))
            waves = kept * waves + new * surface.draw(generator)[2]
            heights = spec.height_step * field(waves, surface.points)
            tops = np.array([heights[n * apart : n * apart + rows].max(axis=0) for n in range(10)])
            highest = scipy.ndimage.maximum_filter1d(tops, columns, axis=1, mode="wrap")
            for film, found in zip(films, shares, strict=True):
                found[turn, 10 * seed : 10 * seed + 10] = (highest > film.thickness(0.0)).mean(
                    axis=1
                )
    ratios = []
    for ratio, film, found in zip(RATIOS, films, shares, strict=True):
        contacts = found.mean(), *film.common(spec, LENGTH)
        alike = drifting_shares(*contacts, partial(recurring.drifted, ratio))
        factors = drift_factor(turns, drift, alike), drift_factor(turns, drift)
        of_turn, of_record = pair_deviation(*contacts, side), found.mean(axis=0).std(ddof=1)
        ratios.append(of_record / of_turn / np.sqrt(factors))
    expected, limit = np.transpose(ratios)
    # Of 60 strips the scatter is known to 9 %.
    assert np.all(np.abs(np.log(expected)) < 0.3)
    assert abs(np.mean(np.log(expected))) < 0.15
    assert np.mean(np.log(limit)) < -0.2


def test_slip_that_hardly_is_one_changes_nothing(make_spec):
    spec = make_spec(50_000, **LINES)
    film = StripFilm.flat(3.0 * np.sqrt(surface_moments(spec).height), 0.5 * WIDTH)
    contacts = 0.3, *film.common(spec, LENGTH), RecurringContacts(spec).at(3.0)
    passage = film.passage_width(spec, LENGTH)
    for slip in (-1e-9, 1e-9):
        one = slip_ratio(*contacts, (passage, passage), slip, (0.3, 0.3))
        assert one == pytest.approx(1.0, abs=0.005)
    assert slip_ratio(*contacts, (passage, passage), 0.0, (0.3, 0.3), 0.25) == 4.0


@pytest.mark.parametrize("slip", [0.0, 0.5])
def test_a_small_roller_shows_its_own_contacts_again_in_each_of_its_turns(make_spec, slip):
    """If only one of the two is rough, the share is that of some turns of this one."""
    spec = make_spec(50_000, **LINES)
    film = StripFilm.flat(3.0 * np.sqrt(surface_moments(spec).height), 0.5 * WIDTH)
    contacts, passage = (0.3, *film.common(spec, LENGTH)), film.passage_width(spec, LENGTH)
    motion = (passage, passage), slip, (0.6, 0.1)
    first, second = (slip_ratio(*contacts, np.eye(2)[roller], *motion) for roller in (0, 1))
    turns = 6.0 * speed_ratios(slip)[1]
    assert first == pytest.approx(1.0, rel=0.02)
    assert second == pytest.approx(6.0 * repeat_factor(turns), rel=0.02)


def drawn_rollers(spec, surface, filters=1.0):
    """Heights of first and of second rollers, m, shape (roller, along the rollers, around).

    If their waves are filtered, what becomes of the heights.
    """
    rows, apart = int(LENGTH / surface.spacing[0]), surface.points[0] // 10
    both = []
    for seed in range(PAIRED // 10):
        generator = np.random.default_rng(seed)
        waves = surface.draw(generator)[2]
        of_each = surface.of_each(waves, generator)
        fields = [spec.height_step * field(own * filters, surface.points) for own in of_each]
        begins = range(0, 10 * apart, apart)
        both += [[own[row : row + rows].astype(np.float32) for own in fields] for row in begins]
    return np.swapaxes(both, 0, 1)
