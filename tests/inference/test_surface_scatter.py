"""Scatter of records between pairs of surfaces: one alignment, several, and short records."""

import numpy as np
import pytest
import xarray as xr
from experiments import experiment_of
from whole_surfaces import answered_strip

from lube.contact.pair_scatter import pair_deviation
from lube.contact.rough_pair import RoughPair
from lube.contact.surface_strip import strip_films, surface_contact
from lube.grid.gap import PLAIN, Gap
from lube.inference.at_records import study_films_at_records
from lube.inference.surface_scatter import (
    pair_correlation,
    pair_shares,
    revolution_limits,
    surface_prediction,
    surface_scatter,
)
from lube.statistics.one_pair import drift_factor

SHARES, ANSWERED = np.array([0.05, 0.4, 0.4]), Gap("flat", "computed")


@pytest.fixture
def layer(study):
    return study.boundary_layer


def scatter(study, **records):
    """Scatter ratios of three records of the busy study."""
    experiment = experiment_of(SHARES, np.array([400.0, 1600.0, 1600.0]), 100.0, 60.0, **records)
    films = study_films_at_records(study, experiment).isel(film_formula=0)
    return of_records(study, experiment, films, SHARES)


def of_records(study, experiment, films, shares):
    motion = (experiment[name].values for name in ("slide_to_roll_ratio", "turns"))
    return surface_scatter(RoughPair.of(study), films, shares, *motion, study.rig.drift)


def with_rollers(study, **second):
    rollers = study.rollers.second.model_copy(update=second)
    return study.model_copy(
        update={"rollers": study.rollers.model_copy(update={"second": rollers})}
    )


def records_of(share, size, ratio):
    """A ``surface_records`` dataset, as far as pairs are drawn from it."""
    values = {"breakthrough_probability": share, "sample_size": size}
    records = {name: (("film_formula", "record"), [each]) for name, each in values.items()}
    return xr.Dataset(records | {"scatter_ratio": ("record", ratio)})


def test_records_of_drawn_pairs_scatter_and_are_correlated_as_contacts_under_one_another():
    certain = 1.0 - 1e-16 * np.array([1.0, 2.0, 4.0])
    share, size = np.array([0.3, 0.02, 0.3, 0.0, *certain, np.nan]), np.full(8, 400.0)
    ratio = np.where(np.arange(8) == 2, 0.5, 1.0)
    pair = xr.DataArray(list("aabababa"), dims="record")
    records = records_of(share, size, ratio)
    drawn = np.concatenate([pair_shares(records, pair, seed)[:, 0] for seed in range(20)])
    some, deviation = slice(3), np.sqrt(share * (1.0 - share) * ratio / size)[:3]
    np.testing.assert_allclose(drawn[:, some].mean(axis=0), share[some], rtol=0.02)
    np.testing.assert_allclose(drawn[:, some].std(axis=0), deviation, rtol=0.05)
    np.testing.assert_array_equal(drawn[0, 3:], share[3:])
    known = np.eye(3)
    known[:2, :2] = pair_correlation(share[:2])
    assert known[0, 1] == pytest.approx(np.sqrt(np.log(0.98) / np.log(0.7)))
    np.testing.assert_allclose(np.corrcoef(drawn[:, some].T), known, atol=0.05)


@pytest.mark.parametrize("limits", [(0.95, 0.81, 0.987), (0.05, 0.0, 0.17)])
def test_one_pair_is_not_better_known_than_a_mean_whose_limit_is_cut(limits):
    lower, upper = surface_prediction(np.array(limits), 1000.0)
    assert lower <= limits[1] and upper >= limits[2]


def test_a_probability_that_is_rounded_to_one_is_predicted_as_one_just_below():
    for share in (1.0 - 1e-13, 1.0):
        limits = np.array([share, 1.0 - 1e-12, 1.0])
        lower, upper = surface_prediction(limits, 1000.0)
        assert 1.0 - 1e-6 < lower <= limits[1] and upper == 1.0


def test_equal_rollers_in_pure_rolling_repeat_themselves(busy_study):
    np.testing.assert_array_equal(scatter(busy_study, turns=1.0), 1.0)
    np.testing.assert_array_equal(scatter(busy_study, turns=20.0), 1.0)


def test_short_records_scatter_in_inverse_proportion_to_their_length(busy_study):
    np.testing.assert_allclose(scatter(busy_study, turns=0.25), 4.0)


def test_slip_shortens_contacts_and_brings_new_alignments(busy_study):
    one = scatter(busy_study, turns=1.0, slide_to_roll_ratio=0.37)
    many = scatter(busy_study, turns=100.0, slide_to_roll_ratio=0.37)
    assert np.all(one < 1.0 + 0.5 * 0.37) and np.all(many < 0.8 * one) and np.all(many > 0.01)
    assert many[1] == many[2]  # the same film
    # The effect of either surface alone stays in any number of turns.
    later = scatter(busy_study, turns=10_000.0, slide_to_roll_ratio=0.37)
    np.testing.assert_allclose(later, many, rtol=0.3)


def test_the_scatter_with_slip_is_less_where_most_layers_hold(busy_study):
    layer = busy_study.boundary_layer
    weak, strong = (layer.model_copy(update={"shear_strength": own}) for own in (1.0, 1e6))
    for turns in (1.0, 100.0):
        found = [
            scatter(
                busy_study.model_copy(update={"boundary_layer": own}),
                turns=turns,
                slide_to_roll_ratio=0.37,
            )
            for own in (weak, strong)
        ]
        assert np.all(found[1] < 0.8 * found[0])


def test_a_drift_of_the_roughness_averages_contacts_out_sooner_than_heights(busy_study):
    drifting = busy_study.model_copy(
        update={"rig": busy_study.rig.model_copy(update={"drift": 0.05})}
    )
    for slip in (0.0, 0.37):
        steady, found = (
            scatter(one, turns=20.0, slide_to_roll_ratio=slip) for one in (busy_study, drifting)
        )
        assert np.all(found < steady)
        assert np.all(found > 0.04)
    found = scatter(drifting, turns=20.0)
    assert np.all(found < 0.85 * drift_factor(20.0, 0.05))
    np.testing.assert_array_equal(scatter(drifting, turns=1.0), 1.0)


def test_rollers_of_different_size_meet_in_new_alignments(busy_study):
    unequal = with_rollers(busy_study, radius=0.0437)
    found = [scatter(unequal, turns=turns) for turns in (1.0, 50.0)]
    assert np.all(found[1] < 0.5 * found[0])
    smooth = with_rollers(unequal, rms_roughness=1e-9)  # then one surface has all the roughness
    assert np.all(scatter(smooth, turns=50.0) > 0.8)


def test_a_small_rough_roller_scatters_as_its_own_turns_do(busy_study):
    """The other is nearly smooth, so that every turn of the small one is alike."""
    small = with_rollers(busy_study, radius=0.0117, rms_roughness=2e-6)
    for turns in (1.0, 50.0):
        np.testing.assert_allclose(scatter(small, turns=turns), 1.0, rtol=0.1)
    film = {"film_thickness": ("film", [7e-6]), "contact_half_width": 2e-4}
    film = xr.Dataset(film | {"reduced_modulus": 1e11})
    pair = RoughPair(small.line_spec, 1e-3, busy_study.boundary_layer, 1)
    found = surface_contact(pair, film)
    share, (strip,) = (
        found["breakthrough_probability"].item(),
        strip_films(pair, film),
    )
    own = small.line_spec.points[1] * small.line_spec.spacing
    expected = pair_deviation(share, *strip.common(small.line_spec, 1e-3), own)
    np.testing.assert_allclose(found["pair_deviation"], expected, rtol=0.05)


def test_a_film_that_is_not_known_has_no_scatter(busy_study):
    experiment = experiment_of(SHARES, np.array([400.0, 1600.0, 1600.0]), 100.0, 60.0)
    films = study_films_at_records(busy_study, experiment).isel(film_formula=0)
    films["film_thickness"][1] = np.nan
    shares = np.where([True, False, True], SHARES, np.nan)
    found = of_records(busy_study, experiment, films, shares)
    assert np.isnan(found).tolist() == [False, True, False]


def test_ridges_across_rolling_need_no_longer_way_to_a_new_alignment(make_spec, layer):
    """Stretched along the rollers, as the strip is, they touch as the surface without ridges."""
    film = {"film_thickness": ("record", [7e-7]), "contact_half_width": 1.5e-4}
    film = xr.Dataset(film | {"reduced_modulus": 1e11})
    layer = layer.model_copy(update={"shear_strength": 1.0})  # it breaks at any contact
    # In each turn the slower surface stays behind by one and a half longest wavelengths.
    motion = np.array([0.4]), np.array([0.002]), np.array([[1.0], [20.0]]), 0.0
    found = []
    for ratio in (1.0, 4.0):
        spec = make_spec(50_000, longest_wavelength=4e-4, lay_ratio=ratio, lay_angle=90.0)
        pair = RoughPair(spec, ratio * 1e-3, layer, 1)
        found.append(surface_scatter(pair, film, *motion))
    np.testing.assert_allclose(*found, rtol=0.03)
    assert found[0][1] < 0.5


@pytest.mark.parametrize("film_shape", ["flat", "computed"])
def test_films_with_a_shape_have_a_scatter_too(busy_study, film_shape):
    study = busy_study.model_copy(update={"film_shape": film_shape})
    assert np.all(scatter(study, turns=100.0, slide_to_roll_ratio=0.37) < 0.6)


def test_contacts_that_the_oil_ends_are_hardly_shorter_with_slip(study, make_spec, layer):
    spec = make_spec(50_000, longest_wavelength=4e-4, shortest_wavelength="16 points")
    _, film = answered_strip(study, spec, "flat", 0.5, 2.2)
    record = film.expand_dims("record"), np.array([0.3]), np.array([0.5]), np.array([1.0])
    weak = layer.model_copy(update={"shear_strength": 1.0})  # it breaks at all contacts
    pairs = [RoughPair(spec, 0.01, weak, 1, gap) for gap in (PLAIN, ANSWERED)]
    drawn, answered = (surface_scatter(pair, *record, 0.0) for pair in pairs)
    # A turn of the faster surface is shorter than one of pure rolling.
    assert 1.25 * drawn < answered < 1.25


def test_the_share_of_a_pair_lies_in_its_limits_in_pure_rolling_alone():
    share, slips = np.array([0.3, 1.0, np.nan]), [0.0, 0.5]
    tail = xr.Dataset(coords={"slide_to_roll_ratio": slips})
    for end, by in (("", 1.0), ("_lower", 0.999), ("_upper", 1.001)):
        values = np.tile(np.minimum(by * share, 1.0), (2, 1))
        tail[f"breakthrough_probability{end}"] = ("slide_to_roll_ratio", "force"), values
    tail["surface_pair_deviation"] = "force", [0.05, 0.0, np.nan]
    lower, upper = (each.values for each in revolution_limits(tail))
    np.testing.assert_allclose([lower[0, 0], upper[0, 0]], [0.2, 0.4], atol=0.02)
    assert lower[0, 1] == pytest.approx(1.0, abs=0.01) and upper[0, 1] == 1.0
    assert np.isnan([lower[1], upper[1]]).all() and np.isnan([lower[0, 2], upper[0, 2]]).all()
