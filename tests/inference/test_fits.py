"""Fits to all records: the films that are tried are those of the records, changed by a factor."""

import numpy as np
import pytest
import xarray as xr
from experiments import experiment_of

from lube.inference.at_records import film_at_records
from lube.inference.fits import _lambda_ratios
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
