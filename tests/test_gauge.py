"""From contact shares back to what explains them: exact inverses first, then coverage."""

import logging

import numpy as np
import pytest
import xarray as xr

from lube import (
    contact_map,
    contact_statistics,
    film_table,
    fit_alpha,
    fit_layer_strength,
    gather,
    gather_map,
    gauge_film,
    gauge_records,
)
from lube.ensemble import effective_looks, probability_interval
from lube.intervals import score_interval
from lube.lubricant import lubricant_table
from lube.roughness import roughness_batch
from lube.schema import EXPERIMENT_DIMS, LIMITS, POINT_DIMS, check

POINTS = 50_000
SEED = 5
MAPS, REALISATIONS = 6, 16  # independent ensembles, and realisations in each
RIGS = 240  # realisations that no map has seen
HELD_OUT = 1_000_000


@pytest.fixture(scope="module")
def spec(make_spec):
    return make_spec(POINTS)


@pytest.fixture(scope="module")
def layer(study):
    """So weak that on the coarse grid as many segments break as on the paper's."""
    return study.boundary_layer.model_copy(update={"shear_strength": 2e5})


@pytest.fixture(scope="module")
def ensembles(spec, film, layer):
    """Master map and contact results of several independent ensembles."""
    made = []
    for number in range(MAPS):
        first = number * REALISATIONS
        lines = roughness_batch(spec, SEED, range(first, first + REALISATIONS))
        parts = contact_map(lines, film, layer), contact_statistics(lines, film, layer)
        mapped, run = (part.assign_coords(realisation=np.arange(REALISATIONS)) for part in parts)
        made.append((gather_map([mapped]), gather([run], film)))
    return made


@pytest.fixture(scope="module")
def rigs(spec, film, layer):
    """Contact shares of single revolutions of rigs, over (realisation, operating point)."""
    lines = roughness_batch(spec, SEED, range(HELD_OUT, HELD_OUT + RIGS))
    run = contact_statistics(lines, film.sel(film_formula=["paper"]), layer)
    shares = run["breakthrough_probability"].sel(film_formula="paper", drop=True)
    return shares.transpose("realisation", *EXPERIMENT_DIMS)


def experiment_of(make_experiment, template, values):
    """An experiment of shares and limits that are plain arrays."""
    return make_experiment(*(template.copy(data=each) for each in values))


@pytest.fixture(scope="module")
def own_curve(ensembles, film, make_experiment):
    """The map's levels as a film table, and records that are the map's own mean."""
    master, _ = ensembles[0]
    levels = master["lambda_ratio"].sel(lambda_ratio=slice(0.8, 3.5)).values
    one = film.isel(lubricant=[0], temperature=[0])
    table = one[["contact_half_width", "composite_rms_roughness", "lubricant", "temperature"]]
    table = table.assign_coords(speed=levels)
    force = one["force"]
    share = master["breakthrough_probability_mean"].sel(lambda_ratio=levels)
    share = share.interp(contact_width=2.0 * one["contact_half_width"])
    share = share.drop_vars("contact_width").rename(lambda_ratio="speed")
    widths = master["contact_width"].values
    at_level = [np.isclose(widths, 2 * a, rtol=1e-9).any() for a in one["contact_half_width"]]
    share = share.expand_dims(lubricant=one.lubricant, temperature=one.temperature)
    share = share.expand_dims(slide_to_roll_ratio=[0.0]).transpose(*EXPERIMENT_DIMS)
    experiment = make_experiment(share, 0.97 * share, np.minimum(1.03 * share, 1.0))
    return master, table, experiment, force.values[at_level]


# A film from a share


def test_a_share_of_the_maps_own_curve_is_gauged_back_to_its_film(own_curve, film):
    master, table, experiment, forces = own_curve
    gauged = gauge_film(master, table, experiment).isel(lubricant=0, temperature=0)
    assert {100.0, 1600.0} <= set(forces)
    for force in forces:
        here = gauged.sel(force=force)
        falling = np.diff(experiment["contact_share"].sel(force=force, threshold=100.0)) < 0.0
        assert falling.all()  # no two levels share a film
        np.testing.assert_allclose(here["gauged_lambda_ratio"], here["speed"], rtol=1e-9)
        thickness = here["speed"] * film["composite_rms_roughness"].item()
        np.testing.assert_allclose(here["gauged_film_thickness"], thickness, rtol=1e-9)


def test_the_larger_share_has_the_thinner_film_and_limits_enclose_it(own_curve):
    master, table, experiment, _ = own_curve
    gauged = gauge_film(master, table, experiment)
    for limit in LIMITS:
        assert (gauged[f"gauged_lambda_ratio{limit}"].diff("speed") > 0.0).all()
    assert (gauged["gauged_lambda_ratio_lower"] < gauged["gauged_lambda_ratio"]).all()
    assert (gauged["gauged_lambda_ratio_upper"] > gauged["gauged_lambda_ratio"]).all()
    # Between the levels of the contact width the curve is an interpolation, and a good one.
    ratio = gauged["gauged_lambda_ratio"] / gauged["speed"]
    np.testing.assert_allclose(ratio, 1.0, atol=0.03)


@pytest.fixture(scope="module")
def extremes(rigs, film, ensembles, make_experiment):
    """Contact never at 100 N, always at 1600 N, no record at 800 N."""
    values = [np.full(rigs[0].shape, value) for value in (0.3, 0.2, 0.4)]
    for column, ends in ((0, (0.0, 0.0, 0.01)), (3, (np.nan,) * 3), (4, (1.0, 0.97, 1.0))):
        for value, end in zip(values, ends, strict=True):
            value[..., column] = end
    return gauge_records(
        ensembles[0][0], film, ensembles[0][1], experiment_of(make_experiment, rigs[0], values)
    )


def test_no_contact_leaves_the_film_open_above(extremes):
    never = extremes.sel(force=100.0)
    assert never["gauged_lambda_ratio"].isnull().all()
    assert (never["gauged_film_thickness_upper"] == np.inf).all()
    assert (never["gauged_lambda_ratio_lower"] > 1.0).all()


def test_nothing_but_contact_leaves_the_film_open_below(extremes, film):
    always = extremes.sel(force=1600.0)
    assert always["gauged_lambda_ratio"].isnull().all()
    assert (always["gauged_film_thickness_lower"] == 0.0).all()
    # The map goes below the films of the study, so even this says something.
    assert (always["gauged_lambda_ratio_upper"] < film["lambda_ratio"].min()).all()


def test_points_without_a_record_stay_empty_and_are_listed(extremes, film):
    missing = extremes.sel(force=800.0)
    for limit in LIMITS:
        assert missing[f"gauged_film_thickness{limit}"].isnull().all()
    assert len(extremes.missing.splitlines()) == film.sizes["temperature"] * film.sizes["speed"]
    assert extremes.missing.splitlines()[0] == "800 N, 60 rpm, 40 degC: no record in pure rolling"
    assert (extremes["fitted_points"] == 48).all()


def test_the_gauge_fits_its_schema_and_names_its_origin(extremes):
    assert check(extremes, "gauge") is extremes
    assert extremes["gauged_film_thickness"].sel(force=100.0)["origin"] == "simulated"
    assert extremes["alpha_factor"].isel(lubricant=0)["origin"] == "simulated"


def test_the_table_stands_beside_what_was_gauged(extremes, film):
    for name in ("film_thickness", "lambda_ratio"):
        xr.testing.assert_equal(extremes[name].drop_vars("origin"), film[name])
    assert extremes["study_layer_strength"] == pytest.approx(2e5 / 5e-9)


def test_order_of_the_levels_does_not_matter(ensembles, film, rigs, make_experiment):
    master, contact = ensembles[0]
    experiment = experiment_of(make_experiment, rigs[0], _with_limits(rigs[:8].values))
    straight = gauge_records(master, film, contact, experiment)
    turned = experiment.isel(force=slice(None, None, -1), speed=[1, 2, 0])
    xr.testing.assert_allclose(gauge_records(master, film, contact, turned), straight)


def test_records_with_slip_are_not_gauged(ensembles, film, rigs, make_experiment):
    slipping = rigs[0].assign_coords(slide_to_roll_ratio=[0.1])
    experiment = make_experiment(slipping, slipping, slipping)
    gauged = gauge_records(ensembles[0][0], film, ensembles[0][1], experiment)
    assert gauged.gauged_film_thickness.isnull().all()
    assert (gauged.fitted_points == 0).all()
    assert len(gauged.missing.splitlines()) == gauged.gauged_film_thickness.size


def test_without_any_record_nothing_is_fitted(ensembles, film, rigs, make_experiment, caplog):
    nothing = rigs[0] * np.nan
    with caplog.at_level(logging.WARNING):
        gauged = gauge_records(
            *ensembles[0][:1], film, ensembles[0][1], make_experiment(*[nothing] * 3)
        )
    assert caplog.messages[-1] == "... and 50 more"
    for name in ("alpha_factor", "fitted_layer_strength"):
        assert gauged[name].isnull().all()
        assert (gauged[f"{name}_lower"] == 0.0).all()
        assert (gauged[f"{name}_upper"] == np.inf).all()


# One unknown for all records


@pytest.fixture(scope="module")
def sure(ensembles, rigs, make_experiment):
    """A rig without chance: its shares are the ensemble's own, by the formula `paper`."""

    def make(contact):
        share = contact["breakthrough_probability_mean"].sel(film_formula="paper", drop=True)
        share = share.transpose(*EXPERIMENT_DIMS)
        return make_experiment(share, share * (1.0 - 1e-4), share * (1.0 + 1e-4) + 1e-9)

    return make


def test_what_the_study_assumes_is_found_in_its_own_results(ensembles, film, sure):
    master, contact = ensembles[0]
    gauged = gauge_records(master, film, contact, sure(contact)).sel(film_formula="paper")
    strength = gauged["fitted_layer_strength"] / gauged["study_layer_strength"]
    assert gauged["alpha_factor"].item() == pytest.approx(1.0, abs=0.01)
    assert strength.item() == pytest.approx(1.0, abs=0.03)
    for name in ("alpha_factor", "fitted_layer_strength"):
        assert gauged[f"{name}_lower"] < gauged[name] < gauged[f"{name}_upper"]


@pytest.mark.parametrize("factor", [0.5, 1.4])
def test_a_changed_alpha_is_found_by_every_formula(
    ensembles, spec, film, layer, study, sure, factor
):
    """The oil of the rig is another one than the study's; its films are run by themselves."""
    oil = lubricant_table(study.lubricants, film["temperature"].values)
    oil["pressure_viscosity_coefficient"] = factor * oil["pressure_viscosity_coefficient"]
    grid = film["force"].values, film["speed"].values
    other = film_table(oil, study.rollers, *grid, film["film_formula"].values)
    lines = roughness_batch(spec, SEED, range(REALISATIONS))
    truth = gather([contact_statistics(lines, other, layer)], other)
    master, contact = ensembles[0]
    for name in film["film_formula"].values:
        renamed = truth.sel(film_formula=[name]).assign_coords(film_formula=["paper"])
        found = fit_alpha(master, film, contact, sure(renamed)).sel(film_formula=name)
        assert found["alpha_factor"].item() == pytest.approx(factor, rel=0.02)


@pytest.mark.parametrize("factor", [0.3, 1.0, 4.0])
def test_a_changed_layer_is_found(ensembles, spec, film, layer, sure, factor):
    changed = layer.model_copy(update={"shear_strength": factor * layer.shear_strength})
    lines = roughness_batch(spec, SEED, range(REALISATIONS))
    truth = gather([contact_statistics(lines, film, changed)], film)
    master, contact = ensembles[0]
    found = fit_layer_strength(master, film, contact, sure(truth)).sel(film_formula="paper")
    strength = factor * layer.shear_strength / layer.critical_thickness
    assert found["fitted_layer_strength"].item() == pytest.approx(strength, rel=0.06)


# Coverage, of rigs that no map has seen


def _with_limits(shares):
    """Share of a rig of some revolutions, and its interval from their own scatter."""
    return probability_interval(shares, 100.0)


def covered(lower, upper, truth):
    return ((lower <= truth) & (truth <= upper)).values


@pytest.mark.parametrize("revolutions", [4, 8])
def test_intervals_cover_the_true_film(ensembles, film, rigs, make_experiment, revolutions):
    truth = film["lambda_ratio"].sel(film_formula="paper").transpose(*POINT_DIMS)
    all_points, closed = [], []
    for first in range(0, RIGS, revolutions):
        values = _with_limits(rigs.values[first : first + revolutions])
        experiment = experiment_of(make_experiment, rigs[0], values)
        master, _ = ensembles[first // revolutions % MAPS]
        gauged = gauge_film(master, film, experiment)
        lower, upper = (gauged[f"gauged_lambda_ratio{limit}"] for limit in LIMITS[1:])
        found = covered(lower, upper, truth)
        all_points.append(found)
        closed.append(found[np.isfinite(upper.values) & (lower.values > 0.0)])
    assert 0.88 <= np.mean(all_points) <= 0.995
    assert 0.88 <= np.mean(np.concatenate(closed)) <= 0.995


@pytest.mark.parametrize("fit", [fit_alpha, fit_layer_strength])
def test_intervals_cover_what_is_common_to_all_points(
    ensembles, film, layer, rigs, make_experiment, fit
):
    """Rigs of one revolution, their intervals of the right width: all points err together."""
    looks = effective_looks(rigs.values) / RIGS
    paper = {"film_formula": ["paper"]}
    table = film.sel(paper)
    found = []
    for first in range(0, RIGS, 2):
        share = rigs.values[first]
        limits = score_interval(share, np.where(np.isfinite(looks), looks, 100.0), 1.96)
        experiment = experiment_of(make_experiment, rigs[0], (share, *limits))
        master, contact = ensembles[first // 2 % MAPS]
        fitted = fit(master, table, contact.sel(paper), experiment)
        name = "alpha_factor" if fit is fit_alpha else "fitted_layer_strength"
        truth = 1.0 if fit is fit_alpha else layer.shear_strength / layer.critical_thickness
        found.append(covered(fitted[f"{name}_lower"], fitted[f"{name}_upper"], truth))
    assert 0.88 <= np.mean(found) <= 0.995


def test_coverage_counts_the_revolutions_whose_interval_holds_the_film(
    ensembles, film, rigs, make_experiment
):
    master, contact = ensembles[0]
    experiment = make_experiment(rigs[0], rigs[0] * 0.0, rigs[0] * 0.0 + 1.0)
    held = gauge_records(master, film, contact, experiment).interval_coverage
    known = rigs[0].isel(slide_to_roll_ratio=0, drop=True).notnull()
    # Limits 0 and 1 leave every film possible.
    assert (held.where(known, 1.0) == 1.0).all()
    wrong = make_experiment(*(rigs[0] * 0.0 + share for share in (0.99, 0.98, 0.995)))
    assert (gauge_records(master, film, contact, wrong).interval_coverage < 1.0).any()
    unknown = experiment.assign(
        {name: experiment[name] * np.nan for name in experiment if name.startswith("revolution")}
    )
    unknown = unknown.assign(
        {name: unknown[name].assign_attrs(experiment[name].attrs) for name in unknown.data_vars}
    )
    assert gauge_records(master, film, contact, unknown).interval_coverage.isnull().all()
