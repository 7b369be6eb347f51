"""The film stage: labels and alignment, then the figures of the paper's grid."""

import functools

import numpy as np
import pytest
import xarray as xr
from paper_grid import FORCE, SPEED, TEMPERATURE
from studies import PAPER

from lube import schema
from lube.ehl import film_formulas
from lube.errors import DataError, LubeError
from lube.grid.films import FilmGroups, film_at
from lube.inference.at_records import film_at_records
from lube.physics.inlet_heating import INLET_HEATING
from lube.stages.film import film_table
from lube.stages.film_profile import film_profile_table
from lube.study.oil_properties import lubricant_table
from lube.study.study import load_study

PAPERS = load_study(PAPER)
ROLLERS = PAPERS.rollers


@functools.cache
def oil():
    """The paper's oil at the paper's temperatures."""
    return lubricant_table(PAPERS.lubricants, TEMPERATURE)


def paper_table(names=tuple(film_formulas.FORMULAS)):
    return film_table(oil(), ROLLERS, FORCE, SPEED, list(names))


@pytest.fixture(scope="module")
def table():
    return paper_table()


def test_table_fits_the_schema(table):
    schema.check(table, "film")
    assert table["film_thickness"].dims == schema.OPERATING_DIMS
    assert table["film_thickness"].shape == (1, len(film_formulas.FORMULAS), 5, 5, 5)
    assert table["regime"].dtype == table["regime"].attrs["flag_values"].dtype
    floats = [v for v in table.variables.values() if v.dtype.kind == "f"]
    assert all(v.dtype == np.float64 and v.notnull().all() for v in floats)
    for name, row in film_formulas.FORMULAS.items():
        assert table["formula_place"].sel(film_formula=name) == row.thickness
        assert table["formula_source"].sel(film_formula=name) == row.source


def test_any_subset_of_formulas_is_the_dimension_in_the_order_asked_for(table):
    for names in (["moes"], ["grubin", "paper"], ["paper", "moes", "grubin"]):
        xr.testing.assert_identical(paper_table(names), table.sel(film_formula=names))


def test_unknown_formulas_and_lubricants_without_temperatures_are_refused():
    with pytest.raises(LubeError, match="unknown film formula 'hamrock'"):
        film_table(oil(), ROLLERS, FORCE, SPEED, ["paper", "hamrock"])
    with pytest.raises(DataError, match="temperature"):
        film_table(oil().drop_vars("temperature"), ROLLERS, FORCE, SPEED, ["paper"])


def test_every_point_agrees_with_the_plain_formula(table):
    """One point at a time, plain floats: nothing is transposed on the way."""
    modulus, radius = 2.0 * ROLLERS.reduced_modulus, ROLLERS.reduced_radius
    one = oil().isel(lubricant=0)
    for name, row in film_formulas.FORMULAS.items():
        for force, speed, temperature in [(100, 200, 40), (800, 100, 60), (1600, 600 / 7, 80)]:
            at = {"force": force, "speed": speed, "temperature": temperature}
            viscosity, alpha = (
                float(one[variable].sel(temperature=temperature))
                for variable in ("dynamic_viscosity", "pressure_viscosity_coefficient")
            )
            load = force / 0.01 / (modulus * radius)
            speed_number = viscosity * (2.0 * np.pi * 0.05 * speed / 60.0) / (modulus * radius)
            groups = FilmGroups(load, speed_number, alpha * modulus, viscosity, modulus, None)
            expected = radius * groups.film(row)
            found = table["film_thickness"].isel(lubricant=0).sel(film_formula=name, **at)
            assert float(found) == pytest.approx(expected, rel=1e-12)


def test_records_at_their_own_conditions_have_the_film_of_the_grid_there(table):
    """Force, speed and oil along one dimension, in place of three: to the last bit."""
    rows = [(800.0, 100.0, 40.0), (100.0, 200.0, 80.0), (800.0, 100.0, 60.0)]
    force, speed, temperature = (xr.DataArray(each, dims="record") for each in np.transpose(rows))
    one = oil().isel(lubricant=0).sel(temperature=temperature).reset_coords(drop=True)
    found = film_at(one, ROLLERS, force, speed, ["paper", "moes"])
    for number, (here, turning, warm) in enumerate(rows):
        at = table.isel(lubricant=0).sel(force=here, speed=turning, temperature=warm)
        at = at.sel(film_formula=["paper", "moes"])
        for name in ("film_thickness", "lambda_ratio", "moes_load", "contact_half_width"):
            record = found[name].isel(record=number)
            np.testing.assert_array_equal(record.values, at[name].values)


def test_each_lubricant_has_its_own_film():
    thin = oil().assign(dynamic_viscosity=0.5 * oil()["dynamic_viscosity"])
    thin["dynamic_viscosity"].attrs["units"] = "Pa s"
    oils = xr.concat([thin.assign_coords(lubricant=["thin"]), oil()], "lubricant", data_vars="all")
    both = film_table(oils, ROLLERS, FORCE, SPEED, ["paper"])
    thin, thick = both["film_thickness"]
    np.testing.assert_allclose(thin.values / thick.values, 0.5**0.692, rtol=1e-5)


def test_entrainment_speed_is_the_surface_speed_of_the_first_roller():
    for radius, expected in ((0.05, np.pi / 6.0), (0.025, np.pi / 12.0)):
        first = ROLLERS.first.model_copy(update={"radius": radius})
        rollers = ROLLERS.model_copy(update={"first": first})
        table = film_table(oil(), rollers, FORCE, [100.0], ["paper"])
        assert float(table["entrainment_speed"][0]) == pytest.approx(expected)


def test_without_a_thermal_conductivity_the_film_has_no_heating_factor():
    record = PAPERS.lubricants[0].model_copy(update={"thermal_conductivity": None})
    lubricant = lubricant_table([record], TEMPERATURE)
    table = film_table(lubricant, ROLLERS, FORCE, SPEED, ["paper"])
    schema.check(lubricant, "lubricant")
    schema.check(table, "film")
    assert np.isnan(table["inlet_shear_heating_factor"]).all()
    assert np.isfinite(table["film_thickness"]).all()


def test_figures_of_the_paper_over_the_grid(table):
    """Lambda 0.9..8.4, inlet heating up to 6 % (not included): physics.md, sections 1 and 3."""
    expected = table["film_thickness"] / (0.2e-6 * np.sqrt(2.0))
    np.testing.assert_allclose(table["lambda_ratio"], expected)
    ratio = table["lambda_ratio"].sel(film_formula="pan-hamrock")
    np.testing.assert_allclose([ratio.min(), ratio.max()], [0.9, 8.4], atol=0.05)
    factor = table["inlet_shear_heating_factor"]
    assert factor.min() == pytest.approx(0.94, abs=0.005) and factor.max() < 1.0
    outside = ~table["in_validity_range"].isel(lubricant=0).sel(film_formula="paper")
    assert outside.sum(["temperature", "speed"]).values.tolist() == [25, 25, 15, 1, 0]
    assert outside.sel(force=100, speed=200, temperature=40)
    assert not outside.sel(force=800, speed=100, temperature=40)


# --- Corrections -------------------------------------------------------------------------

SLIPS = [-1.0, 0.0, 2.0]
AXES = {"force": [400.0, 1600.0], "speed": [100.0, 200.0]}
NAMES = ["paper", "dowson-higginson-minimum"]


def corrected(**corrections):
    return film_table(
        oil(), ROLLERS, *AXES.values(), NAMES, slide_to_roll_ratio=SLIPS, **corrections
    )


def test_inlet_shear_heating_thins_the_film_by_its_factor_at_each_slip():
    cold, hot = corrected(), corrected(inlet_shear_heating="zhu-cheng-1988")
    schema.check(hot, "film")
    assert hot["film_thickness"].dims == schema.CONTACT_DIMS
    factor = hot["inlet_shear_heating_factor"]
    np.testing.assert_array_equal(factor, cold["inlet_shear_heating_factor"])
    for name in ("film_thickness", "lambda_ratio"):
        expected = (cold[name] * factor).transpose(*schema.CONTACT_DIMS)
        np.testing.assert_allclose(hot[name], expected, rtol=1e-14)
    left, rolling, right = hot["film_thickness"]
    assert (right < left).all() and (left < rolling).all()
    at = {"force": 1600, "speed": 200, "temperature": 40, "slide_to_roll_ratio": 2}
    assert factor.isel(lubricant=0).sel(at) == pytest.approx(0.80, abs=0.005)
    assert "starvation_factor" not in hot


@pytest.mark.parametrize("heating", INLET_HEATING[1:])
def test_every_heating_has_a_factor_at_every_point(heating):
    hot = corrected(inlet_shear_heating=heating)
    schema.check(hot, "film")
    factor = hot["inlet_shear_heating_factor"]
    assert (factor < 1.0).all()
    expected = (corrected()["film_thickness"] * factor).transpose(*schema.CONTACT_DIMS)
    np.testing.assert_allclose(hot["film_thickness"], expected, rtol=1e-14)


def test_a_meniscus_thins_the_film_by_its_factor_before_heating_does():
    flooded, starved = corrected(), corrected(inlet_meniscus=0.4e-3)
    schema.check(starved, "film")
    factor = starved["starvation_factor"]
    assert (factor < 0.98).all() and (factor.diff("force") < 0.0).all()
    np.testing.assert_allclose(starved["film_thickness"], flooded["film_thickness"] * factor, 1e-14)
    both = corrected(inlet_shear_heating="zhu-cheng-1988", inlet_meniscus=0.4e-3)
    np.testing.assert_array_equal(both["starvation_factor"], factor)
    expected = starved["film_thickness"] * both["inlet_shear_heating_factor"]
    np.testing.assert_allclose(both["film_thickness"], expected.transpose(*schema.CONTACT_DIMS))
    xr.testing.assert_identical(corrected(inlet_meniscus=100.0)["regime"], flooded["regime"])
    far = corrected(inlet_meniscus=100.0)["film_thickness"]
    np.testing.assert_allclose(far, flooded["film_thickness"], rtol=1e-8)


def test_a_starved_computed_film_is_that_of_the_profile():
    point = [800.0], [100.0]
    one = oil().sel(temperature=[40.0])
    film = film_table(one, ROLLERS, *point, ["computed"], inlet_meniscus=0.4e-3)
    profile = film_profile_table(one, ROLLERS, *point, inlet_meniscus=0.4e-3)
    assert film["film_thickness"].item() == pytest.approx(profile["central_film"].item(), rel=1e-5)
    assert 0.8 < film["starvation_factor"].item() < 0.95


def test_beyond_the_range_of_the_heating_formula_the_film_is_not_known(caplog):
    fast = [100.0, 1e6]
    table = film_table(
        oil(), ROLLERS, [1600.0], fast, ["paper"], inlet_shear_heating="zhu-cheng-1988"
    )
    slow, unknown = (table["film_thickness"].sel(speed=speed) for speed in fast)
    assert slow.notnull().all() and unknown.isnull().all()
    assert "the film is not known at 5 of 10 conditions" in caplog.text


def test_each_record_is_heated_by_its_own_slip():
    rows = {"force": [400.0, 1600.0], "speed": [200.0, 100.0], "slide_to_roll_ratio": [2.0, -1.0]}
    rows |= {"temperature": [40.0, 40.0], "lubricant": [oil()["lubricant"].values[0]] * 2}
    experiment = xr.Dataset({name: ("record", values) for name, values in rows.items()})
    corrections = {"inlet_shear_heating": "zhu-cheng-1988", "inlet_meniscus": 0.4e-3}
    found = film_at_records(experiment, oil(), ROLLERS, NAMES, **corrections)
    table = corrected(**corrections).isel(lubricant=0).sel(temperature=40.0)
    assert found["inlet_meniscus"] == 0.4e-3
    for record in range(2):
        at = {name: rows[name][record] for name in ("force", "speed", "slide_to_roll_ratio")}
        for name in ("film_thickness", "lambda_ratio", "inlet_shear_heating_factor"):
            np.testing.assert_allclose(found[name].isel(record=record), table[name].sel(at), 1e-14)
