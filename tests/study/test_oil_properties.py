"""The lubricant stage, and the properties of CoolProp's liquids."""

import math

import numpy as np
import pytest

from lube.errors import RangeError, RecordError
from lube.physics.coolprop_fluids import (
    initial_pressure_viscosity,
    liquid_property,
    liquid_range,
    secant_pressure_viscosity,
)
from lube.physics.pressure_viscosity import roelands_coefficient
from lube.physics.viscosity_index import viscosity_index
from lube.physics.viscosity_laws import VISCOSITY_LAWS
from lube.schema import check
from lube.study.lubricant_record import load_record
from lube.study.oil_properties import lubricant_table

STUDY = [40.0, 50.0, 60.0, 70.0, 80.0]
AT_40 = np.array([313.15])
ENDS = ["slope-at-atmospheric", "reciprocal-asymptotic"]

RANGE = "temperature_range: {source: x, lowest: 0 degC, highest: 100 degC}"

CSV_OIL = """\
name: measured
title: Measured oil
viscosity:
  source: rheometer
  csv: data.csv
viscosity_law: {law}
density: {{source: x, at_15_degC: 900 kg/m^3, thermal_coefficient: 7e-4 1/K}}
pressure_viscosity:
  source: high-pressure viscometer
  value: 21 1/GPa
  definition: reciprocal-asymptotic
thermal_conductivity: {{source: "assumed: typical", value: 0.14 W/m/K}}
"""


@pytest.fixture
def xmp():
    return load_record("mobilgear-shc-xmp-320")


@pytest.fixture
def dodecane():
    return load_record("n-dodecane")


@pytest.fixture
def fluid(tmp_path):
    """Record of a CoolProp fluid, with further lines as given."""

    def load(name, more="", definition="slope-at-atmospheric"):
        path = tmp_path / "fluid.yaml"
        path.write_text(
            "name: a-fluid\ntitle: A fluid\n"
            f"viscosity: {{source: CoolProp, coolprop_fluid: '{name}'}}\n"
            f"pressure_viscosity: {{source: CoolProp, definition: {definition}}}\n{more}"
        )
        return load_record(path)

    return load


@pytest.fixture
def measured(tmp_path):
    """Record of an oil with a CSV file of exact Andrade viscosities, 0.1 exp(2500 K/T)."""

    def load(law="andrade", kind="kinematic_viscosity [mm^2/s]", factor=lambda celsius: 1.0):
        lines = [f"temperature [degC],{kind}"]
        for celsius in (20.0, 35.0, 50.0, 70.0, 90.0):
            value = 0.1 * math.exp(2500.0 / (celsius + 273.15)) * factor(celsius)
            lines.append(f"{celsius},{value!r}")
        (tmp_path / "data.csv").write_text("\n".join(lines))
        path = tmp_path / "measured.yaml"
        path.write_text(CSV_OIL.format(law=law))
        return load_record(path)

    return load


def test_xmp_320_gives_the_figures_of_physics_section_2(xmp):
    table = lubricant_table([xmp], STUDY).sel(lubricant="mobilgear-shc-xmp-320")
    np.testing.assert_allclose(
        table.kinematic_viscosity * 1e6, [335, 210.665, 139.1001950405, 95.806, 68.451], rtol=1e-5
    )
    np.testing.assert_allclose(
        table.pressure_viscosity_coefficient * 1e9, [16.0, 15.1, 14.3, 13.6, 13.0], atol=0.05
    )
    assert float(table.viscosity_index) == pytest.approx(164.4, abs=0.05)
    assert table.density.sel(temperature=40.0) == pytest.approx(860.0 * (1 - 6.4e-4 * 25.0))
    assert str(table.viscosity_law_used.values) == "astm-d341"
    assert "Gold" in str(table.pressure_viscosity_definition.values)


def test_table_is_labelled_and_keeps_the_order_of_lubricants_and_temperatures(xmp, dodecane):
    table = lubricant_table([dodecane, xmp], [60.0, 40.0])
    assert check(table, "lubricant") is table
    assert list(table.lubricant.values) == ["n-dodecane", "mobilgear-shc-xmp-320"]
    assert list(table.temperature.values) == [60.0, 40.0]
    dynamic = table.kinematic_viscosity * table.density
    np.testing.assert_allclose(table.dynamic_viscosity, dynamic, rtol=1e-14)
    alone = lubricant_table([xmp], [40.0]).dynamic_viscosity.item()
    here = table.dynamic_viscosity.sel(lubricant="mobilgear-shc-xmp-320", temperature=40.0)
    assert here.item() == alone


def test_short_data_are_padded_and_curves_end_with_each_temperature_range(xmp, dodecane):
    table = lubricant_table([xmp, dodecane], STUDY)
    oil = table.sel(lubricant="mobilgear-shc-xmp-320")
    assert int(oil.data_temperature.notnull().sum()) == 2
    assert int(oil.fit_residual.notnull().sum()) == 2 * len(VISCOSITY_LAWS)
    drawn = oil.fitted_kinematic_viscosity.sel(viscosity_law="vogel").dropna("fit_temperature")
    assert list(drawn.fit_temperature.values) == list(range(40, 101))
    assert table.fit_temperature.values[[0, -1]].tolist() == [0.0, 200.0]
    other = table.sel(lubricant="n-dodecane")
    assert int(other.data_temperature.isnull().sum()) == 0


def test_parameters_carry_names_and_units_and_are_nan_where_a_law_has_none(xmp):
    parameters = lubricant_table([xmp], STUDY).isel(lubricant=0).set_coords("parameter_units")
    vogel = parameters.fit_parameter.sel(viscosity_law="vogel").dropna("parameter")
    assert list(vogel.parameter.values) == ["a", "b", "c"]
    assert list(vogel.parameter_units.values) == ["mm2 s-1", "K", "K"]
    assert float(vogel.sel(parameter="c")) == pytest.approx(178.15)


def test_andrade_oil_has_the_exact_temperature_viscosity_coefficient(measured):
    table = lubricant_table([measured()], [20.0, 55.0, 90.0]).isel(lubricant=0)
    kelvin = table.temperature.values + 273.15
    density_fall = 7e-4 / (1.0 - 7e-4 * (kelvin - 288.15))
    np.testing.assert_allclose(
        table.temperature_viscosity_coefficient, 2500.0 / kelvin**2 + density_fall, rtol=1e-6
    )


def test_the_law_of_the_lubricant_record_is_used(measured):
    exact = 0.1e-6 * np.exp(2500.0 / 333.15)
    by_law = {
        law: float(lubricant_table([measured(law)], [60.0]).kinematic_viscosity.item())
        for law in VISCOSITY_LAWS
    }
    assert by_law["andrade"] == pytest.approx(exact, rel=1e-9)
    assert by_law["astm-d341"] != pytest.approx(exact, rel=1e-5)
    table = lubricant_table([measured("astm-d341")], [60.0]).isel(lubricant=0)
    residual = table.fit_residual.sel(viscosity_law="astm-d341")
    assert 1e-5 < float(abs(residual).max()) < 0.05


def test_dynamic_viscosities_are_divided_by_the_density(measured):
    def density(celsius):
        return 900.0 * (1.0 - 7e-4 * (celsius - 15.0))

    kinematic = lubricant_table([measured()], STUDY)
    dynamic = lubricant_table(
        [measured(kind="dynamic_viscosity [mPa*s]", factor=lambda c: density(c) * 1e-3)], STUDY
    )
    np.testing.assert_allclose(dynamic.kinematic_viscosity, kinematic.kinematic_viscosity)


def test_measured_coefficient_is_kept_and_converted_for_the_film_formulas(measured):
    table = lubricant_table([measured()], STUDY).isel(lubricant=0)
    np.testing.assert_allclose(table.stated_pressure_viscosity_coefficient, 21e-9, rtol=1e-12)
    slopes = table.pressure_viscosity_coefficient.values
    for slope, viscosity in zip(slopes, table.dynamic_viscosity.values, strict=True):
        assert roelands_coefficient(slope, viscosity, "reciprocal-asymptotic") == pytest.approx(
            21e-9, rel=1e-9
        )
    assert "Roelands' law from the reciprocal" in str(table.pressure_viscosity_definition.values)
    # The data end at 90 degC: no viscosity at 100 degC, no viscosity index.
    assert np.isnan(table.viscosity_index)


SPARSE = """\
name: sparse
title: Sparse data
viscosity:
  source: test
  points:
    - {temperature: 40 degC, kinematic_viscosity: 320 mm^2/s}
    - {temperature: 100 degC, kinematic_viscosity: 38 mm^2/s}
density: {source: test, at_15_degC: 880 kg/m^3, thermal_coefficient: 6.5e-4 1/K}
pressure_viscosity:
  source: test
  definition: slope-at-atmospheric
  points:
    - {temperature: 60 degC, value: 20 1/GPa}
    - {temperature: 80 degC, value: 18 1/GPa}
"""


def test_the_index_needs_viscosity_alone_at_40_and_100_degrees(tmp_path):
    path = tmp_path / "sparse.yaml"
    path.write_text(SPARSE)
    record = load_record(path)
    assert record.valid_temperatures == (60.0, 80.0)
    found = lubricant_table([record], [70.0]).viscosity_index.item()
    assert found == pytest.approx(viscosity_index(320.0, 38.0))


def test_golds_coefficient_and_a_measured_slope_are_taken_as_they_are(xmp):
    for record in (xmp, load_record("base-oil-n100")):
        table = lubricant_table([record], STUDY)
        stated = table.stated_pressure_viscosity_coefficient
        assert (table.pressure_viscosity_coefficient.values == stated.values).all()
        assert np.isnan(table.pressure_fit_residual).all()


def test_measured_coefficients_are_interpolated_in_their_logarithm():
    oil = load_record("stachowiak-heavy-machine-oil-1")
    alpha = lubricant_table([oil], [30, 45, 60, 80, 100]).pressure_viscosity_coefficient.values[0]
    between = [math.sqrt(23.7 * 20.5), math.sqrt(20.5 * 15.8)]
    expected = np.array([23.7, between[0], 20.5, between[1], 15.8])
    np.testing.assert_allclose(1e9 * alpha, expected, rtol=1e-12)
    with pytest.raises(RangeError, match="light-machine-oil: got 50 degC, need 60 to 100 degC"):
        lubricant_table([load_record("stachowiak-light-machine-oil")], [50.0])


PRESSURES = np.array([0.1, 25.0, 50.0, 100.0, 200.0, 400.0])


@pytest.fixture
def pressed(tmp_path):
    """Record of an oil with viscosities under pressure, by a law of pressure and temperature."""

    def load(law, definition):
        lines = ["temperature [degC];pressure [MPa];dynamic_viscosity [mPa*s]"]
        for celsius in (40.0, 60.0, 80.0):
            for pressure in PRESSURES:
                value = 0.07 * math.exp(2200.0 / (celsius + 273.15))
                value *= math.exp(law(1e6 * pressure - 101325.0, celsius))
                lines.append(f"{celsius};{pressure};{value!r}")
        (tmp_path / "data.csv").write_text("\n".join(lines))
        path = tmp_path / "pressed.yaml"
        text = CSV_OIL.format(law="andrade").replace("  value: 21 1/GPa\n", "")
        path.write_text(text.replace("definition: reciprocal-asymptotic", definition))
        return lubricant_table([load_record(path)], [40.0, 60.0, 80.0]).isel(lubricant=0)

    return load


@pytest.mark.parametrize(
    "definition", ["definition: secant\n  pressure: 200 MPa", *(f"definition: {d}" for d in ENDS)]
)
def test_viscosities_of_barus_under_pressure_give_his_coefficient(pressed, definition):
    def law(p, celsius):
        return (20e-9 - 0.1e-9 * (celsius - 40.0)) * p

    table = pressed(law, definition)
    stated = table.stated_pressure_viscosity_coefficient
    np.testing.assert_allclose(1e9 * stated, [20.0, 18.0, 16.0], rtol=1e-4)
    assert table.pressure_fit_residual < 1e-4


def test_viscosities_of_mcewen_under_pressure_give_each_definition(pressed):
    def law(p, celsius):
        return 12.0 * math.log1p(18e-9 * p / 12.0)

    for definition, expected in zip(ENDS, (18e-9, 18e-9 * 11.0 / 12.0), strict=True):
        table = pressed(law, f"definition: {definition}")
        np.testing.assert_allclose(table.stated_pressure_viscosity_coefficient, expected, rtol=1e-4)


def test_the_residual_of_a_fit_under_pressure_is_stated(pressed):
    def law(p, celsius):  # 3 % too high at 100 MPa alone
        return 20e-9 * p + 0.03 * (90e6 < p < 110e6)

    residual = pressed(law, "definition: slope-at-atmospheric").pressure_fit_residual
    assert 0.015 < residual < 0.03


def test_n_dodecane_under_pressure_as_measured_and_by_coolprop(pressed, fluid):
    """The fit of viscosities to 200 MPa has the secant to 200 MPa within its residual."""
    kelvin = np.array([313.15])

    def law(p, celsius):
        at = min(max(p, 0.0) + 101325.0, 200e6)
        return (
            math.log(
                (
                    liquid_property("n-Dodecane", "viscosity", kelvin, at)
                    / liquid_property("n-Dodecane", "viscosity", kelvin)
                ).item()
            )
            + max(p + 101325.0 - 200e6, 0.0) * 7e-9
        )

    table = pressed(law, "definition: secant\n  pressure: 200 MPa")
    direct = secant_pressure_viscosity("n-Dodecane", kelvin, 200e6).item()
    residual = table.pressure_fit_residual.item()
    assert table.stated_pressure_viscosity_coefficient.values == pytest.approx(
        direct, abs=residual / 200e6
    )


def test_n_dodecane_at_40_degc_has_the_figures_of_physics_section_2():
    assert liquid_property("n-Dodecane", "viscosity", AT_40) == pytest.approx(1.061e-3, abs=5e-7)
    assert initial_pressure_viscosity("n-Dodecane", AT_40) == pytest.approx(12.6e-9, rel=0.01)


def test_secants_shrink_towards_the_initial_slope():
    initial = initial_pressure_viscosity("n-Dodecane", AT_40)
    gaps = [
        abs(secant_pressure_viscosity("n-Dodecane", AT_40, pressure) - initial).item()
        for pressure in (10e6, 1e6, 0.2e6)
    ]
    assert gaps[0] > 5.0 * gaps[1] > 20.0 * gaps[2] > 0.0


def test_n_dodecane_table_comes_from_coolprop_and_the_laws_only_fit_it(dodecane):
    table = lubricant_table([dodecane], STUDY).isel(lubricant=0)
    assert str(table.viscosity_law_used.values) == "coolprop"
    direct = liquid_property("n-Dodecane", "viscosity", np.array(STUDY) + 273.15)
    np.testing.assert_allclose(table.dynamic_viscosity, direct, rtol=1e-14)
    worst = abs(table.fit_residual).max("data_point")
    assert (worst < 0.1).all()
    assert float(worst.sel(viscosity_law="vogel")) < float(worst.sel(viscosity_law="andrade"))
    # Below 2 mm2/s at 100 degC the viscosity index is not defined.
    assert np.isnan(table.viscosity_index)
    # CRC Handbook of Chemistry and Physics, n-dodecane at 20 degC: 0.7495 g/cm3.
    at_20 = lubricant_table([dodecane], [20.0])
    assert at_20.density.item() == pytest.approx(749.5, abs=1.0)


def test_temperature_viscosity_coefficient_of_n_dodecane(dodecane, fluid):
    """It agrees with a wide difference, and is continuous up to the ends of the liquid range."""
    table = lubricant_table([dodecane], [58.0, 60.0, 62.0]).isel(lubricant=0)
    log_viscosity = np.log(table.dynamic_viscosity.values)
    wide = (log_viscosity[0] - log_viscosity[2]) / 4.0
    assert float(table.temperature_viscosity_coefficient[1]) == pytest.approx(wide, rel=1e-3)
    record = fluid("n-Dodecane")
    lowest, highest = record.valid_temperatures
    table = lubricant_table([record], [lowest, lowest + 1.0, highest - 1.0, highest])
    fall = table.temperature_viscosity_coefficient.values[0]
    np.testing.assert_allclose(fall[[0, 3]], fall[[1, 2]], rtol=0.02)


def test_secant_definition_is_computed_and_stated(fluid):
    table = lubricant_table([fluid("n-Dodecane", definition="secant, pressure: 200 MPa")], [40.0])
    stated = table.stated_pressure_viscosity_coefficient.item()
    assert stated == pytest.approx(8.7e-9, abs=0.05e-9)
    slope, viscosity = table.pressure_viscosity_coefficient.item(), table.dynamic_viscosity.item()
    assert stated < slope
    assert roelands_coefficient(slope, viscosity, "secant", 199898675.0) == pytest.approx(stated)
    assert "to 200 MPa" in table.pressure_viscosity_definition.item()


def test_states_outside_coolprops_range_are_refused():
    for temperature, pressure, message in [
        (313.15, 500e6, r"n-Dodecane: got a pressure of 500 MPa, .* 0\.101325 to 200 MPa"),
        (313.15, 1e4, r"got a pressure of 0\.01 MPa"),
        (260.0, 101325.0, r"got -13\.15 degC, CoolProp's liquid .* -9\.45 to 216\.\d+ degC"),
        (500.0, 101325.0, r"got 226\.85 degC"),  # boiled off
        (720.0, 101325.0, r"got 446\.85 degC"),  # beyond Tmax
    ]:
        with pytest.raises(RangeError, match=message):
            liquid_property("n-Dodecane", "viscosity", np.array([313.15, temperature]), pressure)


@pytest.mark.parametrize("answer", [-0.036, 0.0, np.inf, np.nan])
def test_impossible_answers_of_coolprop_are_refused(monkeypatch, answer):
    liquid_range("n-Dodecane")
    from CoolProp import CoolProp

    genuine = CoolProp.PropsSI

    def broken(*arguments):
        return np.array([answer]) if len(arguments) == 6 else genuine(*arguments)

    monkeypatch.setattr(CoolProp, "PropsSI", broken)
    with pytest.raises(RangeError, match=r"CoolProp gives a viscosity of .* at 40 degC"):
        liquid_property("n-Dodecane", "viscosity", AT_40)


def test_cold_water_which_pressure_thins_is_refused(fluid):
    water = fluid("Water", "temperature_range: {source: x, lowest: 10 degC, highest: 60 degC}")
    message = r"a-fluid: got a pressure-viscosity coefficient of -0\.3\d* 1/GPa at 20 degC"
    with pytest.raises(RangeError, match=message):
        lubricant_table([water], [50.0, 20.0])


def test_fluids_that_coolprop_cannot_serve_are_refused(fluid):
    for name, message in [
        ("Unobtainium", "got 'Unobtainium', need a pure fluid by CoolProp's spelling"),
        ("INCOMP::S800", "got 'INCOMP::S800', need a pure fluid"),
        ("n-Decane&n-Dodecane", "need a pure fluid"),
        ("CarbonDioxide", "need a fluid that is liquid at atmospheric pressure"),
        ("n-Undecane", "got 'n-Undecane', need a fluid whose viscosity CoolProp knows"),
    ]:
        with pytest.raises(RecordError) as caught:
            lubricant_table([fluid(name, RANGE)], [40.0])
        assert str(caught.value).startswith("a-fluid: coolprop_fluid: ")
        assert message in str(caught.value) and "\n" not in str(caught.value)


def test_temperatures_outside_a_range_are_refused(xmp, dodecane, fluid):
    record = fluid("n-Dodecane", RANGE.replace("100 degC", "300 degC"))
    with pytest.raises(RangeError, match="a-fluid: n-Dodecane: got 300 degC"):
        lubricant_table([record], [40.0])
    with pytest.raises(RangeError, match="mobilgear-shc-xmp-320: got 30 degC, need 40 to 100"):
        lubricant_table([dodecane, xmp], [30.0, 40.0])


def test_a_law_without_a_viscosity_at_a_temperature_is_refused(tmp_path):
    text = CSV_OIL.format(law="vogel").replace(
        "  csv: data.csv",
        "  points:\n    - {temperature: 40 degC, kinematic_viscosity: 100 mm^2/s}\n"
        "    - {temperature: 100 degC, kinematic_viscosity: 11 mm^2/s}",
    )
    path = tmp_path / "frozen.yaml"
    path.write_text(text + "temperature_range: {source: x, lowest: -120 degC, highest: 100 degC}\n")
    with pytest.raises(RangeError, match="measured: the viscosity law gives inf m2/s at -100 degC"):
        lubricant_table([load_record(path)], [-100.0])


def test_a_law_that_allows_no_fit_leaves_nan_and_the_others_are_fitted(fluid):
    # Liquid nitrogen is too thin for ASTM D341: below 0.21 mm2/s near boiling.
    table = lubricant_table([fluid("Nitrogen")], [-200.0]).isel(lubricant=0)
    refused = table.sel(viscosity_law="astm-d341")
    assert refused.fit_residual.isnull().all()
    assert refused.fit_parameter.isnull().all()
    assert refused.fitted_kinematic_viscosity.isnull().all()
    assert abs(table.sel(viscosity_law="vogel").fit_residual).max() < 0.05
