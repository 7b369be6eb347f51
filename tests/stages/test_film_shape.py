"""Flat films and the computed one: limits, the sampler's other door, then counting."""

import numpy as np
import pytest

from lube import contact_statistics, film_table, gather, roughness_lines
from lube.physics.hertz import hertz_gap
from lube.stages.film_profile import film_profile_table
from lube.stages.film_shape import FILM_MODELS, PAIRS, film_shape_probabilities, window_models
from lube.stages.tail import tail_probabilities
from lube.study.oil_properties import lubricant_table

SEED = 1
GRID = [200.0, 1600.0], [100.0]


@pytest.fixture(scope="module")
def oil(study):
    return lubricant_table(study.lubricants, [40.0, 80.0])


@pytest.fixture(scope="module")
def film(oil, study):
    return film_table(oil, study.rollers, *GRID, ["computed"])


@pytest.fixture(scope="module")
def profile(oil, study):
    return film_profile_table(oil, study.rollers, *GRID)


@pytest.fixture(scope="module")
def spec(make_spec):
    return make_spec(100_000)


@pytest.fixture(scope="module")
def weak(study):
    """A layer that breaks on lines so coarse."""
    return study.boundary_layer.model_copy(update={"shear_strength": 2e5})


@pytest.fixture(scope="module")
def shapes(spec, film, profile, weak):
    return film_shape_probabilities(spec, film, profile, weak, SEED)


# --- Limits ------------------------------------------------------------------------------


def test_hertz_gap_is_the_parabola_far_away_and_the_integral_of_its_slope():
    distance = np.linspace(1.0, 3.0, 20001)
    slope = np.sqrt(distance**2 - 1.0)  # of a half-plane beside Hertz' pressure
    steps = 0.5 * (slope[1:] + slope[:-1]) * np.diff(distance)
    assert hertz_gap(distance)[-1] == pytest.approx(steps.sum(), rel=1e-5)
    assert hertz_gap(np.array([-1e4]))[0] == pytest.approx(0.5e8, rel=1e-6)
    assert np.all(hertz_gap(np.linspace(-1.0, 1.0, 11)) == 0.0)


def test_models_agree_where_they_mean_the_same(spec, film, profile):
    one = profile.isel(lubricant=0, temperature=0, speed=0, force=1)
    thickness = film["film_thickness"].isel(force=1, temperature=0).item()
    half_width, radius = one["contact_half_width"].item(), film["reduced_radius"].item()
    values = one["film_position"].values, one["film"].values
    formula, flat, opened, computed = window_models(spec, *values, thickness, half_width, radius)
    assert formula.size == flat.size == 2 * int(half_width / spec.spacing) + 1
    np.testing.assert_allclose(formula, flat, rtol=1e-5)  # the formula is the computed film
    middle = opened.size // 2
    assert opened[middle] == pytest.approx(flat[0]) and computed[middle] == pytest.approx(flat[0])
    inside = np.abs(np.arange(opened.size) - middle) * spec.spacing < half_width
    np.testing.assert_allclose(opened[inside], flat[0])
    assert computed.min() < 0.9 * flat[0] < opened.min()  # the constriction at the outlet


def test_a_study_of_the_computed_film_alone_has_ratio_one_in_both_flat_models(shapes):
    both = shapes.sel(film_model=["formula", "flat"])
    np.testing.assert_allclose(both["probability_ratio"], 1.0, rtol=1e-4)
    assert np.all(shapes["probability_ratio_lower"] <= shapes["probability_ratio"])
    assert np.all(shapes["probability_ratio"] <= shapes["probability_ratio_upper"])
    assert shapes["film_model"].values.tolist() == list(FILM_MODELS)
    assert shapes["film_formula"].item() == "computed"


def test_pieces_in_the_window_are_those_of_the_contact_model(spec, film, weak, shapes):
    """And whole runs break less often, the more so the narrower the contact."""
    lines = roughness_lines(spec, SEED, range(PAIRS))
    pieces = gather([contact_statistics(lines, film, weak)], film).squeeze()
    found = (shapes["edge_ratio"] * shapes["whole_run_probability"]).squeeze()
    expected = pieces["breakthrough_probability_mean"].transpose(*found.dims)
    np.testing.assert_allclose(found.fillna(0.0), expected, rtol=1e-12)
    ratio = shapes["edge_ratio"].squeeze().isel(temperature=1)
    assert np.all((ratio > 1.0) & (ratio < 2.0)) and np.all(ratio.diff("force") < 0.0)


def test_a_film_that_did_not_converge_is_unknown_and_the_others_are_not(
    spec, film, profile, weak, shapes
):
    holed = profile.copy(deep=True)
    holed["film"][0, 0, 0, 1] = holed["central_film"][0, 0, 0, 1] = np.nan
    found = film_shape_probabilities(spec, film, holed, weak, SEED)["breakthrough_probability"]
    expected = shapes["breakthrough_probability"].copy()
    expected[1:, 0, 0, 0, 1] = np.nan
    np.testing.assert_array_equal(found, expected)


# --- A second way ------------------------------------------------------------------------


def test_tail_samples_the_same_under_the_same_films(spec, oil, study, weak, shapes):
    """Its films are whole height steps, and its flat windows are chosen from in another way."""
    films = film_table(oil, study.rollers, *GRID, ["computed"], with_shape=True)
    shaped = tail_probabilities(spec, films, weak, SEED).squeeze()
    flat = tail_probabilities(spec, films.drop_vars("film_profile"), weak, SEED).squeeze()
    for name, tail in (("computed", shaped), ("flat", flat)):
        found = shapes["breakthrough_probability"].sel(film_model=name).squeeze()
        np.testing.assert_allclose(tail["breakthrough_probability"], found, rtol=0.02)
    assert np.isnan(shaped["breakthrough_rate"]).all()
    # The theory for high films, where contact is rare.
    rare = shaped.isel(temperature=0)
    ratio = rare["geometric_contact_probability"] / rare["geometric_contact_asymptote"]
    assert np.all((ratio > 0.4) & (ratio < 1.0))


# --- Counting ----------------------------------------------------------------------------


def test_an_ensemble_counts_as_much_contact(spec, oil, study, weak, shapes):
    films = film_table(oil, study.rollers, *GRID, ["computed"], with_shape=True)
    lines = roughness_lines(spec, SEED, range(24))
    counted = gather([contact_statistics(lines, films, weak)], films).squeeze()
    counted = counted.isel(temperature=1)
    sampled = shapes.sel(film_model="computed").squeeze().isel(temperature=1)
    for name in ("breakthrough_probability", "geometric_contact_probability"):
        error = counted[name].std("realisation", ddof=1) / np.sqrt(24)
        own = (sampled[f"{name}_upper"] - sampled[f"{name}_lower"]) / 4.0
        difference = counted[f"{name}_mean"] - sampled[name]
        assert np.all(np.abs(difference) < 4.0 * np.hypot(error, own))
