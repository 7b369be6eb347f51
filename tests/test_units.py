"""Numbers with units: read exactly, or refused in one line that says what is needed."""

import math
from functools import partial

import pytest
from hypothesis import given
from hypothesis import strategies as st
from refusals import one_line

from lube.errors import LubeError
from lube.units import (
    convert,
    electrical_quantity,
    parse_electrical,
    parse_number,
    parse_quantity,
    with_unit,
)

finite = st.floats(allow_nan=False, allow_infinity=False, min_value=-1e200, max_value=1e200)
positive = st.floats(min_value=1e-200, max_value=1e200)

# Pairs of units of one dimension, with what one of the first is in the second.
FACTORS = [
    ("mm", "m", 1e-3),
    ("um", "m", 1e-6),
    ("µm", "m", 1e-6),
    ("nm", "m", 1e-9),
    ("pm", "m", 1e-12),
    ("inch", "m", 0.0254),
    ("GPa", "Pa", 1e9),
    ("N/mm^2", "Pa", 1e6),
    ("bar", "Pa", 1e5),
    ("kN", "N", 1e3),
    ("mm^2/s", "m^2/s", 1e-6),
    ("cSt", "m^2/s", 1e-6),
    ("mPa*s", "Pa*s", 1e-3),
    ("cP", "Pa*s", 1e-3),
    ("g/cm^3", "kg/m^3", 1e3),
    ("uohm*m", "ohm*m", 1e-6),
    ("1/GPa", "1/Pa", 1e-9),
    ("turn/s", "rpm", 60.0),
    ("rad/s", "rpm", 30.0 / math.pi),
]

refusal = partial(one_line, LubeError)


@given(finite)
def test_a_number_survives_its_way_through_text(number):
    assert parse_number(repr(number)) == number
    assert parse_number(number) == number


@given(finite)
def test_a_quantity_in_its_own_unit_survives_exactly(number):
    assert parse_quantity(f"{number!r} m", "m") == number


@pytest.mark.parametrize(("units", "target", "factor"), FACTORS)
@given(number=positive)
def test_a_quantity_is_converted_and_back(number, units, target, factor):
    converted = parse_quantity(f"{number!r} {units}", target)
    assert converted == pytest.approx(number * factor, rel=1e-12)
    assert convert(converted, target, units) == pytest.approx(number, rel=1e-12)


@given(st.integers(-1000, 1000), st.integers(1, 1000))
def test_a_fraction_is_the_nearest_float(numerator, denominator):
    assert parse_number(f"{numerator}/{denominator}") == numerator / denominator
    assert parse_quantity(f"{numerator}/{denominator} rpm", "rpm") == numerator / denominator


def test_a_fraction_may_stand_before_another_unit():
    assert parse_quantity("1/3 km", "m") == pytest.approx(1000.0 / 3.0, rel=1e-15)


@pytest.mark.parametrize(
    ("text", "celsius"),
    [("40 degC", 40.0), ("313.15 K", 40.0), ("104 degF", 40.0), ("-40 degF", -40.0)],
)
def test_temperatures_are_points_on_a_scale_not_differences(text, celsius):
    assert parse_quantity(text, "degC") == pytest.approx(celsius, abs=1e-9)


A_MINUTE = ["1/min", "min^-1", "min-1", "min**-1", "min⁻¹", "/min", "/ min", "U/min", "r/min"]
A_MINUTE += ["rev/min", "rpm", "U min^-1", "rev min-1", "turn/min", "revolution/minute"]


@pytest.mark.parametrize("units", A_MINUTE)
def test_so_many_a_minute_are_turns_where_a_rotation_is_asked(units):
    assert parse_quantity(f"100 {units}", "rpm") == pytest.approx(100.0, rel=1e-15)
    assert convert(100.0, units, "rpm") == pytest.approx(100.0, rel=1e-15)


@pytest.mark.parametrize("units", ["1/s", "/s", "s^-1", "s-1", "Hz", "hertz", "U/s", "turn/s"])
def test_so_many_a_second_are_turns_where_a_rotation_is_asked(units):
    assert parse_quantity(f"2 {units}", "rpm") == pytest.approx(120.0, rel=1e-15)


@pytest.mark.parametrize("units", ["rad/s", "rad s^-1", "rad s-1", "rad*Hz"])
def test_radians_a_second_are_no_turns(units):
    assert parse_quantity(f"{math.pi} {units}", "rpm") == pytest.approx(30.0, rel=1e-15)


@pytest.mark.parametrize("units", ["Bq", "count/s", "arcmin/s"])
def test_what_counts_no_turns_is_no_speed_of_rotation(units):
    assert "need a unit such as 'rpm', '1/s'" in refusal(parse_quantity, f"2 {units}", "rpm")


@pytest.mark.parametrize("units", ["1/mm", "min", "U", "m/s", "1/min^2", "min-11", "Umin", "/"])
def test_what_is_no_frequency_is_no_speed_of_rotation_and_told_as_written(units):
    assert repr(units) in refusal(parse_quantity, f"2 {units}", "rpm")


@pytest.mark.parametrize(("units", "hertz"), [("kHz", 1e3), ("Hz", 1.0), ("1/s", 1.0)])
def test_a_frequency_that_is_no_rotation_stays_one(units, hertz):
    assert parse_quantity(f"50 {units}", "Hz") == 50.0 * hertz


@pytest.mark.parametrize(
    ("text", "kelvin"),
    [("1 degC", 1.0), ("1 K", 1.0), ("1 delta_degC", 1.0), ("1 °C", 1.0), ("9 degF", 5.0)],
)
def test_kelvins_are_differences_of_temperature(text, kelvin):
    assert parse_quantity(text, "K") == pytest.approx(kelvin, rel=1e-12)


def test_a_difference_of_temperature_is_no_temperature():
    assert "'delta_degC', need a unit" in refusal(parse_quantity, "1 delta_degC", "degC")


@pytest.mark.parametrize(
    ("units", "quantity"),
    [("mV", "voltage"), ("Volts", "voltage"), ("kOhm", "resistance"), ("M\u2126", "resistance")],
)
def test_a_unit_of_voltage_or_resistance_is_known_in_any_usual_spelling(units, quantity):
    assert electrical_quantity(units) == quantity


@pytest.mark.parametrize("units", ["N", "wumpus", "dBm", "", "V/A/A", "m**9**9**9", 7, None])
def test_any_other_unit_is_neither_voltage_nor_resistance(units):
    told = f"got the unit {units!r}, need one of voltage or resistance, such as 'mV' or 'kohm'"
    assert refusal(electrical_quantity, units) == told


@pytest.mark.parametrize(
    ("text", "number", "quantity"),
    [("3 mV", 3e-3, "voltage"), ("-1.5 kOhm", -1500.0, "resistance"), (" 0V", 0.0, "voltage")],
)
def test_a_voltage_or_resistance_tells_which_it_is(text, number, quantity):
    assert parse_electrical(text) == (pytest.approx(number, rel=1e-15), quantity)


@pytest.mark.parametrize("value", ["3", 3, None, "V", "3 mm", "1e400 V", ["3 V"], ""])
def test_what_is_neither_voltage_nor_resistance_is_refused(value):
    assert "need" in refusal(parse_electrical, value)


def test_an_array_is_converted_like_each_of_its_numbers():
    import numpy as np

    converted = convert(np.array([1.0, 40.0]), "mm", "m")
    np.testing.assert_allclose(converted, [1e-3, 40e-3], rtol=1e-15)


@pytest.mark.parametrize("value", [50, 50.0, True, None, [1], {"a": 1}, "", "mm", "fifty mm"])
def test_what_is_no_number_with_a_unit_is_refused(value):
    assert refusal(parse_quantity, value, "m").startswith(f"got {value!r}, need a number with its")


def test_a_number_without_unit_is_refused_with_the_unit_it_needs():
    assert refusal(parse_quantity, "50", "m") == "got '50' without a unit, need one such as '50 m'"


@pytest.mark.parametrize("units", ["kg", "m^2", "s", "1/m", "degC", "N"])
def test_a_wrong_dimension_is_refused_by_name(units):
    message = refusal(parse_quantity, f"50 {units}", "m")
    assert repr(units) in message
    assert "need a unit of the kind 'm'" in message


@pytest.mark.parametrize("units", ["furlongs_", "xyz", "mm; import os", "m**9999", "m\nm"])
def test_an_unknown_unit_is_refused_by_name(units):
    assert "need" in refusal(parse_quantity, f"50 {units}", "m")


@pytest.mark.parametrize("units", ["m**9**9**9**9", "(" * 5000 + "m", "m*" * 5000 + "m"])
def test_arithmetic_that_never_ends_does_not_reach_the_parser(units):
    assert "is no unit" in refusal(parse_quantity, f"50 {units}", "m")


@pytest.mark.parametrize("value", ["nan mm", "inf mm", "-inf mm", "1e999 mm", "1e308 Gm"])
def test_a_quantity_that_is_not_finite_is_refused(value):
    assert "need a" in refusal(parse_quantity, value, "m")


@pytest.mark.parametrize("value", ["nan", "inf", math.nan, math.inf, -math.inf, "1e999", 10**400])
def test_a_number_that_is_not_finite_is_refused(value):
    assert "need a" in refusal(parse_number, value)


@pytest.mark.parametrize("value", [True, None, [1], "one", "1/0", "1/2/3", "1 m", ""])
def test_what_is_no_number_is_refused(value):
    assert refusal(parse_number, value) == f"got {value!r}, need a number"


@pytest.mark.parametrize(
    "text", ["1" * 10**5, "1" * 10**5 + "/3", "0." + "0" * 10**5 + "x", "1e" + "9" * 200]
)
def test_a_number_without_end_is_refused_at_once(text):
    assert "need a number of 100 characters at most" in refusal(parse_number, text)
    assert "need a" in refusal(parse_quantity, f"{text} m", "m")


def test_a_quantity_with_blanks_without_end_is_refused_at_once():
    assert "need" in refusal(parse_quantity, "1 m" + " " * 10**5 + "x", "m")
    assert parse_quantity("1" + " " * 10**5 + "m", "m") == 1.0


def test_a_number_that_python_cannot_write_out_is_refused():
    assert (
        refusal(parse_number, 16**6000) == "got a whole number of some 7225 digits, need a number"
    )


@pytest.mark.parametrize(
    ("value", "unit", "printed"),
    [
        (0.05, "m", "50 mm"),
        (2e-7, "m", "0.2 µm"),
        (5e-9, "m", "5 nm"),
        (1e-12, "m", "1 pm"),
        (2.1e11, "Pa", "210 GPa"),
        (1e6, "Pa", "1 MPa"),
        (100.0, "ohm", "100 Ω"),
        (1e3, "ohm", "1 kΩ"),
        (1.9999999999999998e-05, "V", "20 µV"),
        (-0.05, "V", "-50 mV"),
        (0.0, "s", "0 s"),
        (1600.0, "N", "1600 N"),
        (600 / 7, "rpm", "85.7143 r/min"),
        (40.0, "degC", "40 °C"),
        (4.2e-4, "m", "420 µm"),
        (3.35e-4, "m^2/s", "335 mm²/s"),
        (1.6e-8, "1/Pa", "16 1/GPa"),
        (0.16, "W/m/K", "0.16 W/m/K"),
        (0.7, "", "0.7"),
    ],
)
def test_a_number_is_printed_with_a_unit_that_reads_easily(value, unit, printed):
    assert with_unit(value, unit) == printed


@given(st.floats(min_value=1e-12, max_value=1e12))
def test_what_is_printed_is_read_again(value):
    assert parse_quantity(with_unit(value, "Pa"), "Pa") == pytest.approx(value, rel=1e-5)
