"""Fits to all records: the films that are tried are those of the records, changed by a factor."""

import numpy as np
import pytest
import xarray as xr
from experiments import experiment_of
from scipy.special import expit, logit

from lube.inference.at_records import film_at_records
from lube.inference.fits import _lambda_ratios, fit_records
from lube.physics.starvation import starvation_factor
from lube.study.oil_properties import lubricant_table

CORRECTED = {"inlet_shear_heating": "zhu-cheng-1988", "inlet_meniscus": 0.4e-3}
FORMULAS = ["paper", "moes", "computed"]


@pytest.mark.parametrize("corrections", [{}, CORRECTED])
def test_with_the_studys_coefficient_the_films_are_those_of_the_records(study, corrections):
    conditions = [400.0, 1600.0], [100.0, 200.0], [60.0, 80.0]
    experiment = experiment_of([0.1, 0.2], *conditions, slide_to_roll_ratio=[0.0, 1.5])
    oil = lubricant_table(study.lubricants, [60.0, 80.0])
    found = film_at_records(experiment, oil, study.rollers, FORMULAS, **corrections)
    factor = xr.DataArray([0.5, 1.0], dims="factor")
    half, whole = _lambda_ratios(found, factor).transpose("factor", "film_formula", "record")
    np.testing.assert_allclose(whole, found["lambda_ratio"], rtol=1e-5)
    # Heating is as before; a thinner film starves less.
    flooded = film_at_records(experiment, oil, study.rollers, ["paper"])["lambda_ratio"][0]
    expected = flooded * 0.5**0.470 * found.get("inlet_shear_heating_factor", 1.0)
    if corrections:
        width = found["contact_half_width"]
        scale = found["reduced_radius"] * found["composite_rms_roughness"] / width**2
        starved = starvation_factor(flooded * 0.5**0.470 * scale, 0.4e-3 / width)
        expected = expected * starved
    np.testing.assert_allclose(half.sel(film_formula="paper"), expected, rtol=1e-9)


def test_the_load_that_asperities_carry_stays_that_of_the_studys_coefficient(study, make_spec):
    experiment = experiment_of([0.1, 0.2], [800.0, 1600.0], [100.0, 100.0], [60.0, 80.0])
    oil = lubricant_table(study.lubricants, [60.0, 80.0])
    known = experiment, oil, study.rollers, FORMULAS
    sharing = {"rough_surfaces": make_spec(20_000), "load_sharing": "iterated"}
    shared, alone = film_at_records(*known, **sharing), film_at_records(*known)
    factor = xr.DataArray([1.0], dims="factor")
    found = _lambda_ratios(shared, factor).isel(factor=0)
    np.testing.assert_allclose(found, shared["lambda_ratio"], rtol=1e-4)
    assert (shared["lambda_ratio"] / alone["lambda_ratio"]).max() > 1.015


def test_no_film_is_tried_where_asperities_and_oil_have_no_balance(study):
    experiment = experiment_of([0.1, 0.2], [800.0, 1600.0], [100.0, 100.0], [60.0, 80.0])
    oil = lubricant_table(study.lubricants, [60.0, 80.0])
    table = film_at_records(experiment, oil, study.rollers, FORMULAS, inlet_meniscus=1e-3)
    factor, share = xr.DataArray([1.0], dims="factor"), 0.0 * table["lambda_ratio"]
    share[:, 0] = 3.0
    found = _lambda_ratios(table.assign(surface_load_share=share), factor).isel(factor=0)
    assert np.isnan(found[:, 0]).all()
    np.testing.assert_allclose(found[:, 1], table["lambda_ratio"][:, 1], rtol=1e-5)


def test_limits_from_four_realisations_hold_the_true_factor():
    """Windows and records are independent, so that shares are binomial."""
    generator, windows, trials = np.random.default_rng(0), 500, 300
    truth, log_factors = np.linspace(-4.0, 1.0, 30), np.linspace(-1.0, 1.0, 201)
    ones, lengths = np.ones(truth.size), {"travel": windows * 2e-4, "longest_wavelength": 1e-4}
    records = {"scatter_ratio": ones, "pooled_error": ones, "share_error": 0.0 * ones}
    records |= {"pair": 0.0 * ones, "contact_half_width": 0.5e-4 * ones}
    held = 0
    for _ in range(trials):
        of_pairs = generator.binomial(windows, expit(truth), (5, truth.size)) / windows
        own, drawn = of_pairs[0], of_pairs[1:]
        mean = drawn.mean(axis=0)
        shares = {"measured_share": own, "pooled_probability": mean, "simulated_probability": mean}
        table = xr.Dataset({name: ("record", row) for name, row in (records | shares).items()})
        for name, rows in ("breakthrough_probability", drawn), ("record_deviation", drawn - mean):
            table[name] = ("realisation", "record"), rows
        # The model's curve goes through the mean over the realisations.
        logits = logit(mean) - 4.0 * log_factors[:, None]
        _, lower, upper = fit_records(log_factors, logits, table.assign_attrs(lengths))
        held += lower <= 1.0 <= upper
    assert 0.93 <= held / trials <= 0.97
