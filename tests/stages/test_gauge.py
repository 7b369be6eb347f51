"""From contact shares back to what explains them: exact inverses first, then coverage."""

import numpy as np
import pytest
import xarray as xr
from experiments import (
    LAYER_BREAKS,
    LAYER_STRENGTHS,
    experiment_at,
    experiment_of,
    made_up_surfaces,
    surface_probability,
)
from made import made

from lube.contact.rough_pair import drawn
from lube.contact.windows import ContactWindows
from lube.inference.fits import fit_alpha, fit_layer_strength
from lube.inference.record_curves import curve_at, map_curves, own_curves
from lube.schema import LIMITS, check, label
from lube.stages import contact_map, contact_statistics, film_table, gather_map
from lube.stages.gauge import gauge_coverage, gauge_film, gauge_records, make
from lube.study.oil_properties import lubricant_table

FORMULA = {"film_formula": "paper"}
THICKNESS = ("film_thickness", "lambda_ratio")


def film_by_map(busy, comparison):
    return gauge_film(map_curves(busy.master, comparison), comparison)


def coverage_by_map(busy, comparison):
    return gauge_coverage(map_curves(busy.master, comparison), comparison)


def gauge_by_map(busy, comparison):
    return gauge_records(map_curves(busy.master, comparison), busy.study, comparison)


def alpha_by_map(busy, comparison):
    return fit_alpha(map_curves(busy.master, comparison), busy.study, comparison)


def strength_by_map(busy, comparison):
    return fit_layer_strength(map_curves(busy.master, comparison), busy.study, comparison)


@pytest.fixture(scope="module")
def own(at_grid, mean):
    """Records that are the ensemble's own mean."""
    return at_grid(mean)


# A film from a share


def test_a_share_of_the_maps_own_curve_is_gauged_back_to_its_film(busy, compared):
    """At a force off the grid's, whose contact width the map has between two of its own."""
    ratios = np.array([0.8, 1.1, 1.5, 2.0])
    for force in (100.0, 700.0):
        width = 2.0 * busy.study.rollers.contact_half_width(force)
        logits = curve_at(busy.master, width).logit_at(np.log(ratios))
        shares = 1.0 / (1.0 + np.exp(-logits))
        gauged = film_by_map(busy, compared(experiment_of(shares, force, 100.0, 60.0)))
        np.testing.assert_allclose(gauged["gauged_lambda_ratio"], ratios, rtol=1e-9)
        thickness = ratios * busy.film["composite_rms_roughness"].item()
        np.testing.assert_allclose(gauged["gauged_film_thickness"], thickness, rtol=1e-9)
        for limit in LIMITS:
            assert (gauged[f"gauged_lambda_ratio{limit}"].diff("record") > 0.0).all()
        assert (gauged["gauged_lambda_ratio_lower"] < ratios).all()
        assert (gauged["gauged_lambda_ratio_upper"] > ratios).all()


def test_a_film_thinner_than_all_of_the_study_is_gauged_as_well(busy):
    """In a study whose thinnest film is still so thick that contact changes much with it."""
    one = busy.film.isel(film_formula=[0], speed=[0], temperature=[-1], force=[-1])
    layer, least = busy.study.boundary_layer, one["lambda_ratio"].item()
    width = 2.0 * one["contact_half_width"].item()

    def with_ratio(ratio):
        return one.assign({name: ratio / least * one[name] for name in THICKNESS})

    master = gather_map([contact_map(busy.lines, with_ratio(2.0), layer)])
    for ratio in (1.7, 1.3):
        contact = contact_statistics(busy.lines, with_ratio(ratio), layer)
        share = contact["breakthrough_probability"].mean().item()
        assert np.exp(curve_at(master, width).film_at(share)) == pytest.approx(ratio, rel=0.02)


def test_a_film_is_known_worse_from_short_and_noisy_records_but_not_better_from_long(
    busy, at_point
):
    comparison = at_point(
        [0.1] * 4, turns=[1.0, 100.0, 0.25, 1.0], share_error=[0.0, 0.0, 0.0, 0.05]
    )
    gauged = film_by_map(busy, comparison)
    width = (gauged["gauged_lambda_ratio_upper"] - gauged["gauged_lambda_ratio_lower"]).values
    assert width[1] == pytest.approx(width[0])
    assert (width[2:] > 1.2 * width[0]).all()


@pytest.fixture(scope="module")
def extremes(busy, at_grid):
    """Contact never at 100 N, always at 1600 N, no record at 400 N."""
    shares = np.tile([0.0, np.nan, 1.0], 4)
    return gauge_by_map(busy, at_grid(shares))


def of_force(gauged, force):
    return gauged.isel(record=gauged["force"].values == force)


def test_shares_beyond_the_map_leave_one_limit_open(extremes, busy):
    never, always = of_force(extremes, 100.0), of_force(extremes, 1600.0)
    assert never["gauged_lambda_ratio"].isnull().all()
    assert (never["gauged_film_thickness_upper"] == np.inf).all()
    assert (never["gauged_lambda_ratio_lower"] > 1.0).all()
    assert always["gauged_lambda_ratio"].isnull().all()
    assert (always["gauged_film_thickness_lower"] == 0.0).all()
    # The map includes films thinner than the study's, so there is an upper limit.
    upper = always["gauged_lambda_ratio_upper"]
    assert (upper > 0.0).all() and (upper < busy.film["lambda_ratio"].min()).all()


def test_records_without_a_share_stay_empty_and_are_not_fitted(extremes, own):
    missing = of_force(extremes, 400.0)
    for limit in LIMITS:
        assert missing[f"gauged_film_thickness{limit}"].isnull().all()
    assert extremes["fitted_records"].item() == 8
    assert check(extremes, "gauge") is extremes
    for name in ("film_thickness", "lambda_ratio", "contact_half_width", "record"):
        np.testing.assert_array_equal(extremes[name], own[name])


def test_records_with_slip_are_gauged_too_and_better(busy, at_point):
    """In expectation slip does not change the probability, but it makes one record scatter less."""
    comparison = at_point([0.1, 0.1], slide_to_roll_ratio=[0.0, 0.1], turns=50.0)
    gauged = film_by_map(busy, comparison)
    rolling, slipping = (
        gauged["gauged_lambda_ratio_upper"] / gauged["gauged_lambda_ratio_lower"]
    ).values
    ratio = gauged["gauged_lambda_ratio"]
    assert ratio[0] == ratio[1]
    assert slipping < rolling


# Curves of the records' own films, where no map has them


def test_a_record_of_the_pooled_probability_has_the_film_itself(busy, at_point):
    """Its realisations touch less often than all pairs of their lines."""
    one = at_point([0.1])
    pooled = 1.2 * one["simulated_probability"]
    share = pooled.isel(film_formula=0).drop_attrs()
    one = one.assign(pooled_probability=pooled, measured_share=share)
    found = film_by_map(busy, one)["gauged_film_thickness"].item()
    assert found == pytest.approx(one["film_thickness"].isel(film_formula=0).item(), rel=0.01)


def test_curves_of_the_records_own_films_say_what_the_map_says(busy, own):
    gauged = gauge_by_map(busy, own)
    found = gauge_records(own_curves(busy.study, own), busy.study, own)
    for limit in LIMITS:
        one, other = (each[f"gauged_lambda_ratio{limit}"].values for each in (found, gauged))
        # Where contact is most frequent, hardly anything tells films apart.
        steep = (other > 0.6) & np.isfinite(other)
        assert steep.sum() > 10
        np.testing.assert_allclose(one[steep], other[steep], rtol=0.05)
    for name in ("alpha_factor", "fitted_layer_strength"):
        for limit in LIMITS:
            np.testing.assert_allclose(found[name + limit], gauged[name + limit], rtol=0.05)
    assert found["interval_coverage"].mean() >= 0.9


CHOICES = {"film_shape": "computed", "roughness_deformation": "venner-1997"}


@pytest.mark.parametrize("chosen", [["film_shape"], ["roughness_deformation"], list(CHOICES)])
def test_another_film_of_any_shape_is_gauged_from_what_is_counted_under_it(busy, chosen):
    grid = busy.study.operating_grid
    changes = {name: CHOICES[name] for name in chosen} | {
        "film_formulas": ("paper", "dowson-higginson-minimum"),
        "operating_grid": grid.model_copy(update={"force": (400.0,), "speed": (60.0,)}),
    }
    study = busy.study.model_copy(update=changes)
    kinds = ("lubricant", "film", "contact", "experiment", "comparison")
    comparison = made(study, kinds)["comparison"]
    curves = own_curves(study, comparison)
    for factor in (0.8, 1.15):
        first = comparison.isel(film_formula=0)
        thinner = first.assign(film_thickness=factor * first["film_thickness"])
        windows = ContactWindows(study.line_spec, thinner, study.boundary_layer, study.gap)
        counted = [windows.count(drawn(study, number))[:, 1] for number in range(32)]
        shares = first["measured_share"].copy(data=np.mean(counted, axis=0))
        gauged = gauge_film(curves, comparison.assign(measured_share=shares))
        ratio = gauged["gauged_film_thickness"].values / first["film_thickness"].values
        np.testing.assert_allclose(ratio, factor, rtol=0.02)


# One unknown for all records


def test_what_the_study_assumes_is_found_in_its_own_results(busy, own):
    gauged = gauge_by_map(busy, own)
    for name in ("alpha_factor", "fitted_layer_strength"):
        assert (gauged[f"{name}_coverage"] >= 0.84).all()  # 27 of 32 at least
        assert (gauged[f"{name}_lower"] < gauged[name]).sel(FORMULA).all()
        assert (gauged[name] < gauged[f"{name}_upper"]).sel(FORMULA).all()
    gauged = gauged.sel(FORMULA)
    strength = gauged["fitted_layer_strength"] / gauged["study_layer_strength"]
    assert gauged["alpha_factor"].item() == pytest.approx(1.0, abs=0.02)
    assert strength.item() == pytest.approx(1.0, abs=0.03)
    assert gauged["fitted_records"].item() == 12


def shares_of(busy, film, layer):
    """Mean shares at the grid of the busy study's own lines, by the formula `paper`."""
    found = contact_statistics(busy.lines, film.sel(film_formula=["paper"]), layer)
    found = found["breakthrough_probability"].mean("realisation").squeeze()
    return found.transpose("temperature", "speed", "force").values.ravel()


def test_a_changed_alpha_is_found(busy, at_grid):
    """The oil of the rig differs from the study's; its films are run by themselves."""
    study, grid = busy.study, busy.study.operating_grid
    for factor in (0.5, 1.4):
        oil = lubricant_table(study.lubricants, grid.temperature)
        oil["pressure_viscosity_coefficient"] = factor * oil["pressure_viscosity_coefficient"]
        other = film_table(oil, study.rollers, grid.force, grid.speed, study.film_formulas)
        comparison = at_grid(shares_of(busy, other, study.boundary_layer))
        found = alpha_by_map(busy, comparison).sel(FORMULA)
        assert found["alpha_factor"].item() == pytest.approx(factor, rel=0.02)


def test_the_right_factor_explains_as_many_records_as_pairs_scatter_and_a_wrong_model_few(
    busy, at_grid, members, mean
):
    """Other pairs as records: 95 % lie in their prediction interval; shuffled shares do not."""
    fits = [alpha_by_map(busy, at_grid(shares)).sel(FORMULA) for shares in members]
    explained = [one["alpha_factor_explained"].item() for one in fits]
    assert 0.85 < np.mean(explained) <= 1.0
    wrong = alpha_by_map(busy, at_grid(np.sort(mean)[::-1].copy())).sel(FORMULA)
    assert np.isfinite(wrong["alpha_factor"]) and wrong["alpha_factor_explained"] < 0.3


def test_a_changed_layer_is_found(busy, at_grid):
    layer = busy.study.boundary_layer
    for factor in (0.3, 4.0):
        changed = layer.model_copy(update={"shear_strength": factor * layer.shear_strength})
        comparison = at_grid(shares_of(busy, busy.film, changed))
        found = strength_by_map(busy, comparison).sel(FORMULA)
        strength = factor * layer.shear_strength / layer.critical_thickness
        assert found["fitted_layer_strength"].item() == pytest.approx(strength, rel=0.06)


def repeated(experiment, pairs):
    """The same records once for each of the given pairs of rollers."""
    count = experiment.sizes["record"]
    labels = np.repeat(pairs, count)
    every = experiment.isel(record=np.arange(labels.size) % count)
    names = [f"record {number}" for number in range(labels.size)]
    every = every.assign_coords(record=names, pair=("record", labels))
    return label(every, "experiment")


def test_a_factor_is_known_better_from_more_pairs_but_not_from_more_records_of_one(
    busy, compared, mean
):
    """The error of the map itself, of 32 realisations, stays however many pairs there are."""
    once = experiment_at(busy.study.operating_grid.model_dump(), mean)

    def width(experiment):
        found = alpha_by_map(busy, compared(experiment)).sel(FORMULA)
        return np.log(found["alpha_factor_upper"] / found["alpha_factor_lower"]).item()

    alone = width(once)
    assert width(repeated(once, ["1"] * 16)) == pytest.approx(alone, rel=1e-6)
    many = width(repeated(once, [str(pair) for pair in range(16)]))
    assert many / alone == pytest.approx(np.sqrt((1 / 16 + 1 / 32) / (1 + 1 / 32)), rel=0.05)


def test_each_lubricant_has_its_own_fit(busy, own):
    (oil,) = busy.study.lubricants
    oils = oil, oil.model_copy(update={"name": "unused"})
    study = busy.study.model_copy(update={"lubricants": oils})
    found = fit_alpha(map_curves(busy.master, own), study, own)
    assert np.isfinite(found["alpha_factor"].isel(fitted_lubricant=0)).all()
    assert found["alpha_factor"].isel(fitted_lubricant=1).isnull().all()


def test_without_any_share_nothing_is_fitted(busy, at_grid):
    gauged = gauge_by_map(busy, at_grid(np.full(12, np.nan)))
    for name in ("alpha_factor", "fitted_layer_strength"):
        assert gauged[name].isnull().all() and gauged[f"{name}_coverage"].isnull().all()
        assert gauged[f"{name}_explained"].isnull().all()
        assert (gauged[f"{name}_lower"] == 0.0).all()
        assert (gauged[f"{name}_upper"] == np.inf).all()
    assert gauged["fitted_records"].item() == 0


# Coverage, each realisation left out in turn and taken as the rig


def test_realisations_without_contact_give_no_coverage_of_a_fit(busy, own):
    """All deviate by nothing, so that an interval from their scatter would have no width."""
    rare = own.assign(breakthrough_probability=0.0 * own["breakthrough_probability"])
    for fitted in (alpha_by_map(busy, rare), strength_by_map(busy, rare)):
        (coverage,) = (values for name, values in fitted.items() if name.endswith("_coverage"))
        assert coverage.isnull().all()


def test_intervals_of_films_hold_the_truth_about_95_times_of_100(busy, own):
    found = coverage_by_map(busy, own)
    assert 0.91 <= found["interval_coverage"].mean() <= 0.99
    both = found["closed_share"] * found["closed_coverage"].fillna(0.0)
    one = (1.0 - found["closed_share"]) * found["one_sided_coverage"].fillna(0.0)
    np.testing.assert_allclose(both + one, found["interval_coverage"])


def test_the_coverage_is_that_of_gauging_every_realisation(busy, own, compared):
    """Literally: gauge each member's share, by the map with it among the realisations."""
    members = own["breakthrough_probability"].sel(FORMULA).values
    held, closed = [], []
    for member in members:
        comparison = own.assign(measured_share=own["measured_share"].copy(data=member))
        gauged = film_by_map(busy, comparison)
        truth = own["lambda_ratio"].sel(FORMULA)
        lower, upper = (gauged[f"gauged_lambda_ratio{limit}"] for limit in LIMITS[1:])
        held.append(((lower <= truth) & (truth <= upper)).values)
        closed.append(((lower > 0.0) & (upper < np.inf)).values)
    found = coverage_by_map(busy, own)
    # With the member among them the others' limits are a little wider.
    for name, literal in (("interval_coverage", held), ("closed_share", closed)):
        np.testing.assert_allclose(found[name], np.mean(literal, axis=0), atol=2.5 / 32)
    assert found["closed_share"].min() < 1.0 == found["closed_share"].max()


def test_two_realisations_give_no_coverage(busy, own):
    few = own.isel(realisation=slice(2))
    master = busy.master.isel(realisation=slice(2))
    assert gauge_coverage(map_curves(master, few), few)["interval_coverage"].isnull().all()


# By surfaces


def gauge_on_surfaces(busy, comparison, error=0.0):
    """Gauge records by the stage, of a study that compares them with surfaces."""
    experiment = busy.study.experiment.model_copy(update={"manifest": "records.csv"})
    changes = {"experiment": experiment, "contact_model": ("line", "surface")}
    study = busy.study.model_copy(update=changes)
    surfaces = made_up_surfaces(comparison["lambda_ratio"], error)
    inputs = {"master": busy.master, "contact": busy.contact, "comparison": comparison}
    if "realisation" not in comparison.dims:
        inputs = {"film": busy.film, "comparison": comparison}
    return make(study, inputs | {"surface_records": surfaces})


def surface_experiment(busy, thinner=1.0):
    """Records whose shares are those of the surfaces, under films thinner by a factor."""
    grid = busy.study.operating_grid.model_dump()
    ratios = busy.film["lambda_ratio"].isel(film_formula=0).squeeze()
    ratios = ratios.transpose("temperature", "speed", "force").values.ravel()
    return ratios, experiment_at(grid, surface_probability(ratios / thinner))


def test_a_share_of_surfaces_is_gauged_back_to_its_film(busy, on_surfaces, compared):
    ratios, experiment = surface_experiment(busy, thinner=1.2)
    gauged = gauge_on_surfaces(busy, on_surfaces(experiment))
    assert check(gauged, "gauge") is gauged
    found = gauged.sel(contact_model="surface")
    share = experiment["true_contact_share"].values
    known = (share > 1e-3) & (share < 0.999)
    assert known.sum() > 5
    film, lower, upper = (found[f"gauged_lambda_ratio{limit}"].values[known] for limit in LIMITS)
    np.testing.assert_allclose(film, ratios[known] / 1.2, rtol=2e-3)
    assert ((lower < film) & (film < upper)).all()
    alone = gauge_by_map(busy, compared(experiment))
    lines = gauged.sel(contact_model="line", drop=True)
    assert lines.drop_attrs().equals(alone.drop_attrs())


def test_the_coefficient_is_fitted_by_surfaces(busy, on_surfaces):
    """Eq. 3 as printed has the film in proportion to the coefficient to the power 0.53."""
    _, experiment = surface_experiment(busy, thinner=1.1)
    found = gauge_on_surfaces(busy, on_surfaces(experiment)).sel(contact_model="surface")
    first = found.isel(film_formula=0, fitted_lubricant=0)
    value, lower, upper = (first[f"alpha_factor{limit}"].item() for limit in LIMITS)
    by_formula = film_table_with_alpha(busy, value)
    assert by_formula == pytest.approx(1.0 / 1.1, rel=2e-3)
    assert lower < value < upper < 1.0
    assert (found["alpha_factor_lower"] < found["alpha_factor"]).all()
    assert (found["alpha_factor"] < found["alpha_factor_upper"]).all()
    for name in ("interval", "alpha_factor", "fitted_layer_strength"):
        assert 0.9 < found[f"{name}_coverage"].mean() <= 1.0


def test_the_layer_is_fitted_by_surfaces_where_it_changes_contact(busy, on_surfaces):
    ratios, _ = surface_experiment(busy)
    for number, breaks in enumerate(LAYER_BREAKS):
        shares = breaks * surface_probability(ratios)
        experiment = experiment_at(busy.study.operating_grid.model_dump(), shares)
        found = gauge_on_surfaces(busy, on_surfaces(experiment)).sel(contact_model="surface")
        first = found.isel(film_formula=0, fitted_lubricant=0)
        value, lower, upper = (first[f"fitted_layer_strength{limit}"].item() for limit in LIMITS)
        strength = LAYER_STRENGTHS[number]
        if 0 < number < 3:
            assert value == pytest.approx(strength, rel=0.05)
        assert lower <= strength <= upper
        assert (lower == 0.0) == (number == 0) and (upper == np.inf) == (number == 3)


def test_without_lines_films_are_gauged_and_alpha_fitted_as_with_them(
    busy, on_surfaces, without_lines
):
    _, experiment = surface_experiment(busy, thinner=1.1)
    comparisons = on_surfaces(experiment), without_lines(experiment)
    both, alone = (gauge_on_surfaces(busy, one) for one in comparisons)
    assert check(alone, "gauge") is alone
    both, alone = (one.sel(contact_model="surface") for one in (both, alone))
    xr.testing.assert_identical(alone[list(both)].drop_attrs(), both.drop_attrs())
    assert alone["fitted_records"] == 12


def film_table_with_alpha(busy, factor):
    """Film with another pressure-viscosity coefficient, over the study's."""
    grid = busy.study.operating_grid
    oil = lubricant_table(busy.study.lubricants, grid.temperature[:1])
    choices = busy.study.rollers, grid.force[:1], grid.speed[:1], ["paper"]
    name = "pressure_viscosity_coefficient"
    films = [film_table(each, *choices) for each in (oil.assign({name: factor * oil[name]}), oil)]
    return (films[0]["film_thickness"] / films[1]["film_thickness"]).item()


def test_the_error_of_the_surfaces_curve_widens_the_films(busy, on_surfaces):
    _, experiment = surface_experiment(busy)
    widths = []
    for error in (0.0, 0.1):
        found = gauge_on_surfaces(busy, on_surfaces(experiment, error=error), error)
        found = found.sel(contact_model="surface")
        upper, lower = (found[f"gauged_lambda_ratio{side}"].values for side in ("_upper", "_lower"))
        widths.append(upper - lower)
    both = np.isfinite(widths[0]) & np.isfinite(widths[1])
    assert both.any() and (widths[1][both] > 1.2 * widths[0][both]).any()
