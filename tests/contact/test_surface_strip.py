"""Contact of surfaces in a strip: limits, then whole surfaces drawn and searched."""

from dataclasses import replace
from functools import partial

import numpy as np
import pytest
import scipy
from whole_surfaces import (
    Filtered,
    Unchanged,
    answered_strip,
    contacts_in,
    curved_more,
    drawn_waves,
)

from lube.contact import strip_sampling, surface_strip
from lube.contact.rough_pair import RoughPair
from lube.contact.strip_film import StripFilm, surface_moments
from lube.contact.strip_sampling import first_contacts, sampled_strips
from lube.contact.surface_answers import COARSEST
from lube.contact.surface_strip import surface_contact
from lube.errors import StudyError
from lube.grid.gap import Gap
from lube.schema import LIMITS
from lube.stages import film_table
from lube.stages.tail import pair_probabilities
from lube.statistics.confidence import jackknife_interval
from lube.study.oil_properties import lubricant_table
from lube.surfaces.rough_surface import field, rough_surface

SEED = 2
SURFACES, FEWER_SURFACES = 180, 80
ROWS = 40
LAYS = {
    "without a lay": {},
    "across": {"lay_ratio": 4.0, "lay_angle": 90.0},
    "along": {"lay_ratio": 4.0, "lay_angle": 0.0},
    "at an angle": {"lay_ratio": 2.0, "lay_angle": 60.0},
    "on the second roller": {"second_own": {"lay_ratio": 2.0, "lay_angle": "-45 deg"}},
}


@pytest.fixture(scope="module")
def spec(make_spec):
    return make_spec(50_000)


# --- Limits --------------------------------------------------------------------------------


def test_independent_rows_touch_as_by_the_binomial_distribution():
    for share in (1e-12, 0.02, 0.4):
        first = share * (1.0 - share) ** np.arange(30)
        for rows in (1, 7, 30, 1000):
            expected = -rows * np.log1p(-share)
            assert first_contacts(first, rows) == pytest.approx(expected, rel=1e-9)


def test_limits_hold_the_probability_where_contact_is_nearly_certain():
    """Rows that touch independently, and that surfaces show more or less often than they do."""
    share, rows, held = 0.01, 1000, 0
    certain = -np.expm1(rows * np.log1p(-share))
    first = share * (1.0 - share) ** np.arange(30)
    seen = np.random.default_rng(1).gamma(4.0, 0.25, (300, 24))
    for of_surfaces in seen:
        of_surfaces = of_surfaces[:, None] * first
        limits = jackknife_interval(of_surfaces, partial(first_contacts, rows=rows))
        _, lower, upper = -np.expm1(-np.array(limits))
        held += lower < certain < upper
    assert 0.92 < held / len(seen) < 0.98


def test_a_surface_that_tells_most_leaves_a_lower_limit():
    """Where contact is certain, some strips weigh far more than others."""
    first = 0.01 * 0.99 ** np.arange(30)
    of_surfaces = np.append(np.full(23, 0.3), 17.0)[:, None] * first
    mean, lower, upper = jackknife_interval(of_surfaces, partial(first_contacts, rows=1000))
    assert 9.0 < mean < 11.0
    assert 1.0 < lower < 3.0 and 30.0 < upper < 100.0


def test_numbers_beyond_certainty_do_not_scatter():
    """Without one of the surfaces every row seems to touch."""
    both = np.zeros((24, 31))
    both[1:, 0] = both[:, -1] = 1.0
    function = partial(strip_sampling._groups, rows=1000)
    _, lower, upper = -np.expm1(-np.array(jackknife_interval(both, function)))
    assert lower == upper == 1.0


def test_a_strip_touches_no_more_often_than_contacts_lie_in_it():
    """One surface shows contact in a hundred times as many first rows as the others."""
    first = 2e-4 * (1.0 - 2e-4) ** np.arange(30)
    of_surfaces = np.append(np.ones(23), 100.0)[:, None] * first
    both = np.append(of_surfaces, np.full((24, 1), 2e-4), axis=1)
    groups = partial(strip_sampling._groups, rows=1000)
    probability, lower, upper = -np.expm1(-np.array(jackknife_interval(both, groups)))
    assert probability < 1000 * 2e-4 + of_surfaces[:, 0].mean() + 1e-12
    assert lower < 0.2 < upper < 0.3
    both[:, -1] = 0.0  # none was counted
    assert groups(both.mean(axis=0)) == first_contacts(of_surfaces.mean(axis=0), 1000)


def test_a_formula_that_flattens_the_roughness_is_refused(spec, film, study):
    few = film.isel(film_formula=0, temperature=0, speed=0, force=[0])
    gap = Gap("computed", "venner-1997")
    with pytest.raises(StudyError, match=r"^roughness_deformation: got venner-1997, need none or"):
        surface_contact(RoughPair(spec, 0.01, study.boundary_layer, SEED, gap), few)


def test_a_film_that_is_not_known_has_no_contact_that_is(spec, film, study):
    few = film.isel(film_formula=0, temperature=0, speed=0, force=[0, 4])
    few["film_thickness"] = few["film_thickness"].where(few["force"] > 1000.0)
    found = surface_contact(RoughPair(spec, 0.01, study.boundary_layer, SEED), few)
    for values in found.values():
        assert values.notnull().values.ravel().tolist() == [False, True]


def test_ridges_as_long_as_the_rollers_touch_as_often_as_their_line(make_spec, film, study):
    few = film.isel(film_formula=0, temperature=0, speed=0, force=[2, 4])
    spec = make_spec(50_000, lay_ratio=700.0, lay_angle=90.0)
    # Whole grid points, or the lines' windows would be narrower.
    points = np.rint(few["contact_half_width"] / spec.spacing)
    few["contact_half_width"] = (1.0 + 1e-9) * spec.spacing * points
    pair = RoughPair(spec, 1e-3, study.boundary_layer, SEED)
    found, of_lines = surface_contact(pair, few), pair_probabilities(pair, few, 0.0)
    name = "geometric_contact_probability"
    line = of_lines[name].mean("pair")
    half = 0.5 * (found[f"{name}_upper"] - found[f"{name}_lower"])
    error = np.hypot(0.5 * half, of_lines[name].std("pair", ddof=1) / of_lines.pair.size**0.5)
    assert np.all(np.abs(found[name] - line) < 3.0 * error)
    assert np.all(error < 0.1 * line)


@pytest.mark.parametrize("ratio", [1.0, 10.0, 100.0])
def test_ridges_longer_than_the_contact_is_wide_touch_as_often_as_expected(
    make_spec, film, study, ratio
):
    """The grid resolves the strip too; of its area the part touches where heights are above."""
    few = film.isel(film_formula=0, temperature=0, speed=0, force=[2, 4])
    waves = {"longest_wavelength": 4e-4, "shortest_wavelength": "16 points"}
    spec = make_spec(50_000, **waves, lay_ratio=ratio, lay_angle=0.0)
    few["film_thickness"] = 3.0 * np.sqrt(surface_moments(spec).height) + 0.0 * few["force"]
    pair = RoughPair(spec, 2e-3, study.boundary_layer, SEED)
    found = surface_contact(pair, few, fewer=2, weaker=1e6)
    for name, expected in (
        ("contacts", found["expected_contacts"]),
        ("breakdown_ratio", scipy.special.ndtr(-3.0)),
    ):
        half = found[f"{name}_upper"] - found[name]
        assert (np.abs(found[name] - expected) < half + 0.02 * expected).all()
        assert (half < 0.08 * expected).all()


@pytest.mark.parametrize(("angle", "longer"), [(90.0, (1.0, 3.0)), (0.0, (3.0, 1.0))])
def test_a_stretched_surface_has_the_contacts_of_the_isotropic_one(
    make_spec, film, study, angle, longer
):
    """The strip is stretched too, and the random numbers are the same. Only summits are blunter."""
    few = film.isel(film_formula=0, temperature=0, speed=0, force=[0])
    stretched = few.assign(contact_half_width=longer[0] * few["contact_half_width"])
    layer, names = study.boundary_layer, ["geometric_contact_probability", "contacts"]
    choices = {"fewer": 4, "weaker": 2.0}
    one = surface_contact(RoughPair(make_spec(50_000), 0.01, layer, SEED), few, **choices)
    spec = make_spec(50_000, lay_ratio=3.0, lay_angle=angle)
    other = surface_contact(RoughPair(spec, longer[1] * 0.01, layer, SEED), stretched, **choices)
    for name in names:
        np.testing.assert_allclose(one[name], other[name], rtol=0.03)
    assert np.all(other["breakthrough_probability"] < 0.9 * one["breakthrough_probability"])


# --- Counting ------------------------------------------------------------------------------


def shape(rms, spacing):
    """Film that is thinnest off its middle and rises at both ends, at positions in m."""
    position = spacing * np.linspace(-30.0, 30.0, 121)
    film = 2.3 * rms * (1.0 + (position / spacing / 9.0) ** 4 - 0.15 * np.sin(position / spacing))
    return position, film


def strip_of(spec, film_shape):
    """Surface of these lines, and film of a strip on it."""
    surface = rough_surface(spec)
    rms = surface.rms * spec.height_step
    if film_shape == "flat":
        return surface, StripFilm.flat(2.6 * rms, 6.01 * surface.spacing[1])
    return surface, StripFilm.shaped(*shape(rms, surface.spacing[1]), rms)


def searched(surfaces, surface, films, sharp, generator):
    """Shares of strips that touch and that break, and their numbers in a strip, on a surface."""
    waves, points = drawn_waves(surface, generator), surface.points
    across, curvatures = surfaces.heights(waves), field(sum(waves) * surface.curvatures, points)
    drawn, diagonal = Unchanged(surface).heights(waves), surface.diagonal
    shares, numbers = [], []
    for column in range(0, points[1] - films.size, 40):
        heights = across(column, films.size)
        curved = curved_more(heights - drawn(column, films.size), surface.spacing)
        overlap = heights - films
        sharper = curvatures[:, column : column + films.size] + curved > sharp
        for row in range(0, points[0] - ROWS, 2 * ROWS):
            part = slice(row, row + ROWS)
            found = contacts_in(overlap[part], sharper[part], diagonal)[1:]
            shares.append([len(found) > 0, any(found)])
        # A contact is in the strip in which it begins.
        labels, *found = contacts_in(overlap, sharper, diagonal)
        begun = np.delete(found, np.unique(labels[0])[1:] - 1)
        numbers.append(np.array([begun.size, np.sum(begun)]) * ROWS / (points[0] - 1))
    return np.stack([np.mean(shares, axis=0), np.mean(numbers, axis=0)])


def compare(spec, surfaces, surface, film, count):
    """Compare sampled contact with that counted on whole surfaces, of which a part breaks.

    Returns the breaking curvature, 1/m, and this part.
    """
    curvature = 2.0 * np.std(surface.draw(np.random.default_rng(1))[1]) * spec.height_step
    films = film.films(surface.spacing[1]) / spec.height_step
    sharp = film.breaking_curvatures(film.columns(surface.spacing[1]), curvature) / spec.height_step
    rng = np.random.default_rng(8)
    counted = np.array([searched(surfaces, surface, films, sharp, rng) for _ in range(count)])
    pair = RoughPair(spec, (ROWS + 0.5) * surface.spacing[0], layer=None, seed=SEED)
    strips = [film], np.array([strip_sampling.STRIPS]), np.array([False])
    seeds = surface_strip.surface_seeds(SEED, surface_strip.SURFACES)
    found = sampled_strips(pair, surface, *strips, [curvature], seeds, threads=1)
    names = ["geometric_contact_probability", "breakthrough_probability"]
    names += ["contacts", "breakthroughs"]
    for name, values in zip(names, counted.reshape(count, 4).T, strict=True):
        half = (found[f"{name}_upper"] - found[name]).item()
        error = np.hypot(np.std(values, ddof=1) / count**0.5, half / 2.0)
        assert abs(found[name].item() - np.mean(values)) < 3.0 * error
        assert error < 0.15 * np.mean(values)
    contacts, breakthroughs = np.mean(counted[:, 1], axis=0)
    assert breakthroughs < 0.95 * contacts  # some do not break
    return curvature, breakthroughs / contacts


@pytest.mark.parametrize("lay", LAYS)
@pytest.mark.parametrize("film_shape", ["flat", "shaped"])
def test_strips_touch_and_break_as_often_as_on_whole_surfaces(make_spec, film_shape, lay):
    spec = make_spec(50_000, **LAYS[lay])
    surface, film = strip_of(spec, film_shape)
    compare(spec, Unchanged(surface), surface, film, SURFACES)


def test_a_layer_that_often_holds_is_judged_on_all_strips_where_contact_is_certain(
    study, make_spec, monkeypatch
):
    oil = lubricant_table(study.lubricants, [80.0])
    film = film_table(oil, study.rollers, [1600.0], [100.0], ["paper"])
    layer = study.boundary_layer.model_copy(update={"shear_strength": 2e5})

    def found():
        return surface_contact(RoughPair(make_spec(30_000), 10e-3, layer, SEED), film)

    few = found()
    monkeypatch.setattr(surface_strip, "MANY", np.inf)  # so that contact is nowhere certain
    assert few["geometric_contact_probability"] > 0.99
    assert 0.0 < few["breakthrough_probability"] < 0.9
    assert few.identical(found())


def test_a_layer_that_no_sampled_contact_breaks_has_an_upper_limit(study, make_spec):
    oil = lubricant_table(study.lubricants, [40.0])
    film = film_table(oil, study.rollers, [800.0], [100.0], ["paper"])
    layer = study.boundary_layer.model_copy(update={"shear_strength": 1e12})
    found = surface_contact(RoughPair(make_spec(30_000), 10e-3, layer, SEED), film)
    for name in ("breakthrough_probability", "breakthroughs", "breakdown_ratio"):
        assert found[name] == found[f"{name}_lower"] == 0.0
        assert 0.0 < found[f"{name}_upper"] < 1e-3 * found["contacts"]


def test_breakthrough_is_no_more_likely_than_contact(study, make_spec, monkeypatch):
    oil = lubricant_table(study.lubricants, [40.0])
    film = film_table(oil, study.rollers, [1600.0], [100.0], ["paper"])
    layer = study.boundary_layer.model_copy(update={"shear_strength": 2e5})
    sample = strip_sampling._on_one_surface

    def exchanged(*arguments):  # errors of sampling, exaggerated
        first, numbers = sample(*arguments)
        return first[:, ::-1], numbers

    monkeypatch.setattr(strip_sampling, "_on_one_surface", exchanged)
    found = surface_contact(RoughPair(make_spec(30_000), 10e-3, layer, SEED), film)
    assert found["breakthrough_probability"] > 0.0
    for end in LIMITS:
        geometric, breakthrough = (found[f"{name}{end}"] for name in strip_sampling.COUNTS)
        assert breakthrough <= geometric


@pytest.mark.parametrize("temperature", [40.0, 80.0])
def test_a_layer_that_always_breaks_is_broken_where_the_surface_is_higher_than_the_film(
    study, make_spec, temperature
):
    oil, spec = lubricant_table(study.lubricants, [temperature]), make_spec(30_000)
    film = film_table(oil, study.rollers, [1600.0], [100.0], ["paper"])
    none = study.boundary_layer.model_copy(update={"shear_strength": 1e-9})
    found = surface_contact(RoughPair(spec, 10e-3, none, SEED), film)
    ratio = film["film_thickness"].item() / surface_moments(spec).height ** 0.5
    expected = scipy.stats.norm.sf(ratio)
    half = 0.5 * (found["breakdown_ratio_upper"] - found["breakdown_ratio_lower"])
    assert abs(found["breakdown_ratio"] - expected) < 1.5 * half < 0.1 * expected


@pytest.mark.parametrize(
    ("film_shape", "slip", "lay"),
    [
        pytest.param("flat", 0.0, "without a lay", marks=pytest.mark.slow),
        ("computed", 0.0, "without a lay"),
        pytest.param("computed", 0.4, "without a lay", marks=pytest.mark.slow),
        ("computed", 0.4, "at an angle"),
    ],
)
def test_strips_that_the_oil_answers_touch_as_often_as_whole_surfaces_so_filtered(
    study, make_spec, film_shape, slip, lay
):
    spec = make_spec(50_000, **LAYS[lay])
    surface = rough_surface(spec, multiple=2**COARSEST)
    strip, film = answered_strip(study, spec, film_shape, slip, 2.0)
    filtered = Filtered(surface, strip, film)
    sharp, part = compare(spec, filtered, surface, strip, FEWER_SURFACES)
    # Theory expects about as many to break, and of the surfaces as drawn fewer.
    expected = strip.breaking_part(spec, 1.0, sharp)
    assert expected == pytest.approx(part, rel=0.15)
    assert replace(strip, answers=None).breaking_part(spec, 1.0, sharp) < 0.9 * expected


@pytest.mark.parametrize(
    ("film_shape", "shortest", "slip"),
    [("flat", "20 points", 0.5), ("computed", "20 points", 0.0), ("computed", "5 points", 0.5)],
)
def test_of_surfaces_that_the_oil_answers_as_many_layers_break_as_expected(
    study, make_spec, film_shape, shortest, slip
):
    """Without short waves the oil flattens the summits, too."""
    spec = make_spec(50_000, longest_wavelength=4e-4, shortest_wavelength=shortest)
    surface = rough_surface(spec, contact=(4e-5, 4e-5), waves=8, multiple=2**COARSEST)
    strip, film = answered_strip(study, spec, film_shape, slip, 2.2)
    filtered, spacing = Filtered(surface, strip, film), surface.spacing[1]
    films = strip.films(spacing) / spec.height_step
    bend = 0.0 - strip.breaking_curvatures(strip.columns(spacing), 0.0)
    rng, found = np.random.default_rng(3), []
    for _ in range(20):
        waves = drawn_waves(surface, rng)
        across, drawn = (each.heights(waves) for each in (filtered, Unchanged(surface)))
        curvatures = field(sum(waves) * surface.curvatures, surface.points)
        for column in range(0, surface.points[1] - films.size, films.size + 20):
            part = column, films.size
            curved = curvatures[:, column : column + films.size]
            curved = curved + curved_more(across(*part) - drawn(*part), surface.spacing)
            overlap = across(*part) - films
            labels, count = scipy.ndimage.label(overlap > 0.0)
            summits = scipy.ndimage.maximum_position(overlap, labels, range(1, count + 1))
            found += [curved[one] * spec.height_step + bend[one[1]] for one in summits]
    for part in (0.8, 0.5, 0.2):
        sharp, error = np.quantile(found, 1.0 - part), (part * (1.0 - part) / len(found)) ** 0.5
        expected = strip.breaking_part(spec, 1.0, sharp)
        assert abs(expected - part) < 3.0 * error + 0.03
        assert error < 0.08
