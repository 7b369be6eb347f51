"""Surfaces at the records: values of the grid, direct sampling, and the inverse of a curve."""

from dataclasses import replace

import numpy as np
import pytest
import xarray as xr
from experiments import experiment_of
from made import made, on_few_surfaces
from scipy.special import expit, stdtrit

from lube.contact.rough_pair import RoughPair
from lube.contact.surface_strip import mean_breaking_curvature, strip_films, surface_contact
from lube.grid.film_responses import with_surface_responses
from lube.inference import surface_records
from lube.inference.at_records import study_films_at_records
from lube.inference.surface_records import (
    CURVE_CONTACTS,
    LAYER_FILMS,
    STEEPEST,
    _anchored,
    _by_formula,
    reading_errors,
    surface_curves,
    surfaces_at_records,
)
from lube.schema import LIMITS, values_with_limits
from lube.stages import film_table
from lube.statistics.confidence import jackknife_error
from lube.study.oil_properties import lubricant_table

CURVE = "curve_probability"
FORCES = [1600.0, 900.0, 400.0, 900.0]
GRID = {"force": (400.0, 1600.0), "speed": (100.0,), "temperature": (40.0,)}
NUMBERS = [f"breakthrough_probability{limit}" for limit in LIMITS]


def of_surfaces(busy_study, **changes):
    """The busy study on few operating points, with surfaces."""
    grid = busy_study.operating_grid.model_copy(update=GRID)
    own = {"contact_model": ("line", "surface"), "film_formulas": ("paper", "computed")}
    return busy_study.model_copy(update={"operating_grid": grid} | own | changes)


def at_records(study, inputs, force, temperature=40.0):
    """Surfaces at records of some forces."""
    experiment = experiment_of(np.full(len(force), 0.5), np.array(force), 100.0, temperature)
    films = study_films_at_records(study, experiment)
    found = surfaces_at_records(study, films, inputs | {"experiment": experiment}, 2)
    return films.isel(film_formula=0), found.isel(film_formula=0)


def test_a_curve_is_corrected_by_numbers_that_are_known_within_a_factor_of_two():
    ratios = np.geomspace(1.5, 6.0, 8)
    curve = -np.expm1(-5.0 * np.exp(-0.5 * (ratios**2 - ratios[0] ** 2)))
    curves = np.stack([curve, curve, curve, np.full(8, 100.0)])[..., None].repeat(2, axis=2)
    # At the thinnest film half as many groups as by the curve: in one case known, in one not.
    own = -np.expm1(-np.array([[2.5, 2.5], [2.1, 1.0], [3.0, 6.0]]))
    # On some surfaces more contacts touch, but hardly under the thickest films.
    more, slope = np.array([-0.2, -0.1, 0.0, 0.1, 0.2])[:, None], 1.0 - 0.13 * np.arange(8)
    rest = 0.05 * np.array([1.0, -2.0, 2.0, -2.0, 1.0])[:, None] * np.arange(8)
    without = -np.log1p(-curve) * np.exp(slope * more + rest)
    logs = np.log(ratios), np.log(ratios[[0, 0]])
    found = _anchored(curves, without[..., None].repeat(2, axis=2), own, *logs)
    known, unknown = found[0].T
    np.testing.assert_allclose(np.log1p(-known), 0.5**slope * np.log1p(-curve), rtol=1e-6)
    np.testing.assert_array_equal(unknown, curve)
    lower, upper = np.log(np.log1p(-found[1:, :, 0]) / np.log1p(-known))
    np.testing.assert_allclose(lower, -upper, rtol=1e-9)
    assert upper[0] == pytest.approx(0.5 * np.log(3.0 / 2.1))  # as of the record
    further = stdtrit(3, 0.975) * np.sqrt(4.0 / 3.0) * jackknife_error(rest)
    np.testing.assert_allclose(upper, np.hypot(slope * upper[0], further), rtol=1e-9)


RATIOS, MOSTLY_HOLD = (
    np.geomspace(1.5, 6.0, 8),
    np.array([0.08, 0.2, 0.6, 0.7, 0.3, 0.1, 0.01, 0.001]),
)
"""Films, and numbers of groups of contacts of which most hold their layer."""


def test_a_curve_that_falls_towards_thin_films_is_corrected_by_what_it_shows():
    """Merged contacts break fewer layers, and few surfaces scatter."""
    curves = np.stack([*[-np.expm1(-MOSTLY_HOLD)] * 3, np.full(8, 100.0)])[..., None]
    more = np.array([-0.2, -0.1, 0.0, 0.1, 0.2])[:, None]
    without = (MOSTLY_HOLD * np.exp(np.array([19.0, *[1.0] * 7]) * more))[..., None]
    own = -np.expm1(-MOSTLY_HOLD[2] * np.array([[1.2], [1.0], [1.4]]))
    found = _anchored(curves, without, own, np.log(RATIOS), np.log(RATIOS[[2]]))[0, :, 0]
    np.testing.assert_allclose(-np.log1p(-found[1:]), 1.2 * MOSTLY_HOLD[1:], rtol=1e-6)
    assert -np.log1p(-found[0]) == pytest.approx(1.2**STEEPEST * MOSTLY_HOLD[0], rel=1e-6)


def test_the_error_of_a_share_is_that_at_its_film_beyond_the_peak():
    each = -np.expm1(-MOSTLY_HOLD[:, None] * np.array([1.0, 0.9, 1.1]))
    each[0, 1:] = 0.0, 1.0  # next to nothing is known under the thinnest film
    names = values_with_limits(CURVE, each.T) | {"curve_sample_size": np.full(8, 900.0)}
    dims = "curve_lambda_ratio", "record"
    surfaces = xr.Dataset({name: (dims, one[:, None]) for name, one in names.items()})
    surfaces = surfaces.assign_coords(curve_lambda_ratio=RATIOS)
    (error,) = reading_errors(surfaces, each[4, :1])
    assert error == pytest.approx(0.25 * (each[4, 2] - each[4, 1]), rel=0.05)


@pytest.fixture(scope="module")
def plain(busy_study, few_surfaces):
    study = of_surfaces(busy_study)
    return study, made(study, ("lubricant", "film", "areal"))


@pytest.fixture(scope="module")
def found(plain):
    """Records on the grid, beside it, and twice the same."""
    return at_records(*plain, FORCES)


def test_records_on_the_grid_have_the_values_of_areal_nc_and_are_not_sampled_again(plain, found):
    study, inputs = plain
    halved = inputs["areal"].copy(deep=True)
    for limit in LIMITS:
        halved[f"breakthrough_probability{limit}"] /= 2.0
    _, other = at_records(study, inputs | {"areal": halved}, FORCES)
    stored = inputs["areal"].isel(film_formula=0).squeeze()
    for name, limit in zip(NUMBERS, LIMITS, strict=True):
        here = stored[f"breakthrough_probability{limit}"].values
        np.testing.assert_array_equal(found[1][name].values[[2, 0]], here)
        np.testing.assert_array_equal(other[name].values[[2, 0]], here / 2.0)
        np.testing.assert_array_equal(other[name].values[[1, 3]], found[1][name].values[[1, 3]])
    share, size = (found[1][name].values[2] for name in ("breakthrough_probability", "sample_size"))
    scatter = stored["pair_deviation"].values[0]
    assert np.sqrt(share * (1.0 - share) / size) == pytest.approx(scatter, rel=1e-9)


def test_records_beside_the_grid_are_sampled_at_their_film(plain, found):
    study, _ = plain
    oil = lubricant_table(study.lubricants, [40.0])
    film = film_table(oil, study.rough_rollers, [900.0], [100.0], ["paper"], **study.film_model)
    direct = surface_contact(RoughPair.of(study), film)
    for name, limit in zip(NUMBERS, LIMITS, strict=True):
        expected = direct[f"breakthrough_probability{limit}"].item()
        np.testing.assert_array_equal(found[1][name].values[[1, 3]], expected)


def test_curves_are_those_of_other_films_at_the_same_width(plain, found):
    study, _ = plain
    first, surfaces = found
    first = first.isel(record=[0])
    ratios = surfaces["curve_lambda_ratio"].values[2:5]
    film = first.assign(film_thickness=("film", ratios * first["composite_rms_roughness"].item()))
    direct = surface_contact(replace(RoughPair.of(study), seed=7), film)
    for row, share in enumerate(direct["breakthrough_probability"].values.ravel(), 2):
        here = surfaces.isel(record=0, curve_lambda_ratio=row)
        errors = [
            0.5 * (each[f"{name}_upper"] - each[name]).values.ravel()
            for each, name in ((here, CURVE), (direct, "breakthrough_probability"))
        ]
        error = np.hypot(errors[0], errors[1][row - 2])
        assert 0.0 < error < 0.3
        assert abs(here[CURVE].item() - share) < 3.0 * error
    assert (np.diff(surfaces[CURVE], axis=0) < 1e-3).all()
    np.testing.assert_array_equal(surfaces[CURVE][:, 1], surfaces[CURVE][:, 3])


def test_curves_of_other_layers_are_those_of_studies_with_them(plain, found, monkeypatch):
    monkeypatch.setattr(surface_records, "BREAKTHROUGHS", 0.0)  # the same films as without it
    study, inputs = plain
    _, surfaces = found
    strengths = surfaces["layer_strength"].values
    own, stronger = study.boundary_layer, surfaces.isel(layer_strength=2)
    assert strengths[0] == pytest.approx(own.strength)
    ratio = stronger["layer_strength"].item() / own.strength
    layer = own.model_copy(update={"shear_strength": ratio * own.shear_strength})
    other = study.model_copy(update={"boundary_layer": layer})
    changed = made(other, ("lubricant", "film", "areal"))
    _, direct = at_records(other, inputs | {"areal": changed["areal"]}, FORCES)
    # The contact sampled at the record's own film corrects both curves at all films.
    groups = [stronger["layer_curve_probability"].values, direct[CURVE].values[LAYER_FILMS]]
    ratios = np.divide(*map(np.log1p, np.negative(groups)))
    np.testing.assert_allclose(ratios, 1.0, atol=0.1)
    # With the own layer the curve is as without others, and stronger ones break more rarely.
    by_layer = surfaces["layer_curve_probability"].values
    np.testing.assert_allclose(by_layer[0], surfaces[CURVE][LAYER_FILMS], rtol=1e-12)
    assert (np.diff(by_layer, axis=0) <= 0.0).all() and (by_layer[-1] < 0.6 * by_layer[0]).all()


def test_where_most_layers_hold_a_curve_goes_on_to_films_under_which_some_break(plain, found):
    study, inputs = plain
    layer, ratio = study.boundary_layer, found[1]["layer_strength"].values[-2]
    ratio = ratio / layer.strength
    layer = layer.model_copy(update={"shear_strength": ratio * layer.shear_strength})
    strong = study.model_copy(update={"boundary_layer": layer})
    inputs = inputs | {"areal": made(strong, ("lubricant", "film", "areal"))["areal"]}
    first, surfaces = at_records(strong, inputs, FORCES)
    thinnest = [each["curve_lambda_ratio"].values[0] for each in (surfaces, found[1])]
    assert thinnest[0] < 0.9 * thinnest[1]
    pair = RoughPair.of(strong)
    each = zip(strip_films(pair, first), first["lambda_ratio"].values, strict=True)
    sharp = mean_breaking_curvature(pair, first)
    for strip, own in each:
        numbers = [
            strip.thicker(times * thinnest[0] / own).expected(pair.spec, pair.length, sharp)[1]
            for times in (0.6, 0.8, 1.0, 1.1)
        ]
        assert numbers[2] > min(0.9 * max(numbers), 3.0)
    assert (surfaces[CURVE][0] > 0.5).any()


def test_at_the_film_of_a_record_its_curve_has_the_probability_of_the_record(found):
    first, surfaces = found
    curves = surface_curves(surfaces, first.expand_dims("film_formula"), False)
    for curve, record in zip(curves.of_records, range(first.sizes["record"]), strict=True):
        read = expit(curve.logit_at(np.log(first["lambda_ratio"].values[record])))
        own = surfaces["breakthrough_probability"].values.reshape(-1, first.sizes["record"])[0]
        assert read == pytest.approx(own[record], rel=1e-4)


def test_a_share_of_a_curve_is_read_back_to_its_film(found):
    first, surfaces = found
    row = 3
    shares = surfaces[CURVE].values[row]
    assert ((shares > 0.01) & (shares < 0.99)).all()
    curves = surface_curves(surfaces, first.expand_dims("film_formula"), False)
    films = [curve.film_at(share) for curve, share in zip(curves.of_records, shares, strict=True)]
    ratio = surfaces["curve_lambda_ratio"].values[row]
    np.testing.assert_allclose(np.exp(films), ratio, rtol=1e-9)
    spread = 0.25 * (surfaces[f"{CURVE}_upper"] - surfaces[f"{CURVE}_lower"])
    np.testing.assert_allclose(reading_errors(surfaces, shares), spread.values[row], rtol=0.05)


def test_between_its_films_a_curve_is_that_of_independent_contacts():
    """Contacts of a Gaussian surface: their number is a known function of the film."""

    def probability(ratio):
        return -np.expm1(-200.0 * ratio**1.6 * np.exp(-0.5 * ratio**2))

    ratios = np.geomspace(3.0, 6.0, 8)
    share = probability(ratios)
    names = values_with_limits(CURVE, [share] * 3) | {"curve_sample_size": np.full(8, 900.0)}
    dims = "curve_lambda_ratio", "record"
    surfaces = xr.Dataset({name: (dims, each[:, None]) for name, each in names.items()})
    surfaces = surfaces.assign_coords(curve_lambda_ratio=ratios, layer_lambda_ratio=ratios)
    of_layers = ("layer_strength", "layer_lambda_ratio", "record"), share[None, :, None]
    surfaces = surfaces.assign(layer_curve_probability=of_layers, layer_strength=[1e14])
    records = xr.Dataset({"film_thickness": (("film_formula", "record"), [[1e-6]])})
    (curve,) = surface_curves(surfaces, records, False).of_records
    for ratio in (3.2, 3.7, 4.4, 5.3):
        assert np.exp(curve.film_at(probability(ratio))) == pytest.approx(ratio, rel=2e-3)


def test_an_unknown_film_has_no_contact_and_no_curve_its_neighbours_have(plain):
    study, inputs = plain
    experiment = experiment_of([0.5, 0.5], np.array([900.0, 1600.0]), 100.0, 40.0)
    films = study_films_at_records(study, experiment)
    films["film_thickness"][:, 0] = films["lambda_ratio"][:, 0] = np.nan
    found = surfaces_at_records(study, films, inputs | {"experiment": experiment}, 2)
    share = found["breakthrough_probability"]
    assert share[:, 0].isnull().all() and (share[:, 1] > 0.0).all()


@pytest.mark.parametrize("film_shape", ["flat", "computed"])
def test_other_film_formulas_are_read_from_the_curves(busy_study, few_surfaces, film_shape):
    """They are right to the errors of the curve and of areal.nc, which has every formula."""
    study = of_surfaces(busy_study, film_shape=film_shape)
    inputs = made(study, ("lubricant", "film", "areal"))
    experiment = experiment_of([0.5, 0.5], np.array([400.0, 1600.0]), 100.0, 40.0)
    films = study_films_at_records(study, experiment)
    found = surfaces_at_records(study, films, inputs | {"experiment": experiment}, 2)
    known = inputs["areal"].squeeze().transpose("film_formula", "force")
    name = "breakthrough_probability"
    errors = [0.5 * (each[f"{name}_upper"] - each[name]).values for each in (found, known)]
    apart = found[name].values - known[name].values
    assert (apart[0] == 0.0).all()
    assert (abs(apart[1]) > 0.0).all() and (abs(apart[1]) < 3.0 * np.hypot(*errors)[1]).all()
    assert (found["sample_size"] > 1.0).all()


def test_limits_of_other_film_formulas_enclose_their_values_however_rare_contact_is():
    """Limits of a rare probability may be 0; those of a frequent one are beyond the curve."""
    ratios = np.geomspace(2.0, 6.0, 8)
    mean = -np.expm1(-2000.0 * np.exp(-0.5 * ratios**2))
    rare = mean < 1e-3
    curve = [mean, np.where(rare, 0.0, 0.9 * mean), np.minimum(1.6 * mean, 1.0), 1000.0 * mean]
    films = xr.DataArray(np.geomspace(1.8, 6.5, 40), dims="film_formula").expand_dims("record")
    films = xr.Dataset({"lambda_ratio": films, "film_thickness": films})
    films = films.transpose("film_formula", "record")
    own = np.array([0.5, 0.4, 0.6, 100.0])[:, None]
    found = _by_formula(own, np.log(ratios), np.array(curve)[..., None], films, False)
    share, lower, upper, size = found[..., 0]
    assert (lower <= share).all() and (share <= upper).all() and (upper <= 1.0).all()
    assert (share[1:] > 0.0).all() and (lower[-3:] == 0.0).all()
    assert found[:, 0, 0].tolist() == own[:, 0].tolist() and (size > 0.0).all()


def test_surfaces_that_the_oil_answers_have_the_response_at_their_record(busy_study):
    """A record on the grid, and the same record where the grid lacks its force."""
    choices = {"film_shape": "computed", "roughness_deformation": "computed"}
    study = of_surfaces(busy_study, **choices, film_formulas=("paper",))
    kinds = "film", "surface_response", "areal"
    with on_few_surfaces(4):
        inputs = made(study, ("lubricant", *kinds))
        without = {kind: inputs[kind].isel(force=[1]) for kind in kinds}
        (_, on_grid), (_, beside) = (at_records(study, each, [400.0]) for each in (inputs, without))
    for name in ("breakthrough_probability", CURVE):
        errors = [0.5 * (each[f"{name}_upper"] - each[name]) for each in (on_grid, beside)]
        assert (abs(on_grid[name] - beside[name]) < 3.0 * np.hypot(*errors) + 1e-3).all()
    film = with_surface_responses(inputs).isel(film_formula=0, force=[0])
    for row, expected in ((0, CURVE_CONTACTS[0]), (-1, CURVE_CONTACTS[1])):
        ratio = on_grid["curve_lambda_ratio"].values[row]
        thickness = ratio * film["composite_rms_roughness"] * xr.ones_like(film["film_thickness"])
        (strip,) = strip_films(RoughPair.of(study), film.assign(film_thickness=thickness))
        number = strip.contacts(study.line_spec, study.rollers.length).number
        assert number == pytest.approx(expected, rel=0.1)
