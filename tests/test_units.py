"""Numbers with units: read exactly, or refused in one line that says what is needed."""

import math
import shutil
from functools import partial

import numpy as np
import platformdirs
import pytest
from hypothesis import given
from hypothesis import strategies as st
from refusals import one_line

import lube.units
from lube.errors import LubeError
from lube.units import (
    convert,
    electrical_quantity,
    parse_electrical,
    parse_number,
    parse_quantity,
    with_unit,
)

positive = st.floats(min_value=1e-200, max_value=1e200)

# Pairs of units of one dimension, with the value of one of the first in the second.
FACTORS = [
    *(("mm", "m", 1e-3), ("µm", "m", 1e-6), ("inch", "m", 0.0254), ("N/mm^2", "Pa", 1e6)),
    *(("mm²/s", "m^2/s", 1e-6), ("cSt", "m^2/s", 1e-6), ("cP", "Pa*s", 1e-3)),
    *(("g/cm^3", "kg/m^3", 1e3), ("uohm*m", "ohm*m", 1e-6), ("1/GPa", "1/Pa", 1e-9)),
    # As data sheets and NetCDF files write them.
    *(("mm2/s", "m^2/s", 1e-6), ("mm2 s-1", "m^2/s", 1e-6), ("kg/m3", "kg/m^3", 1.0)),
    ("mPas", "Pa*s", 1e-3),
    *(("N/mm2", "Pa", 1e6), ("GPa-1", "1/Pa", 1e-9), ("inH2O", "Pa", 249.08891)),
    *(("turn/s", "rpm", 60.0), ("rad/s", "rpm", 30.0 / math.pi)),
    *(("kHz", "Hz", 1e3), ("1/s", "Hz", 1.0)),  # a frequency that is no rotation stays one
]

refusal = partial(one_line, LubeError)


@given(positive, st.sampled_from(FACTORS))
def test_a_quantity_is_converted_and_back(number, pair):
    units, target, factor = pair
    assert parse_number(repr(number)) == parse_number(number) == number
    converted = parse_quantity(f"{number!r} {units}", target)
    assert converted == pytest.approx(number * factor, rel=1e-12)
    assert convert(converted, target, units) == pytest.approx(number, rel=1e-12)
    array = convert(np.array([1.0, number]), units, target)
    np.testing.assert_allclose(array, [factor, converted], rtol=1e-12)


@given(st.integers(-1000, 1000), st.integers(1, 1000))
def test_a_fraction_is_the_nearest_float(numerator, denominator):
    assert parse_number(f"{numerator}/{denominator}") == numerator / denominator
    assert parse_quantity(f"{numerator}/{denominator} rpm", "rpm") == numerator / denominator
    assert parse_quantity("1/3 km", "m") == pytest.approx(1000.0 / 3.0, rel=1e-15)


def test_temperatures_are_points_on_a_scale_in_degrees_and_differences_in_kelvin():
    for text, celsius in [("40 degC", 40), ("313.15 K", 40), ("104 degF", 40), ("-40 degF", -40)]:
        assert parse_quantity(text, "degC") == pytest.approx(celsius, abs=1e-9)
    for text, kelvin in [("1 degC", 1), ("1 K", 1), ("1 delta_degC", 1), ("9 degF", 5)]:
        assert parse_quantity(text, "K") == pytest.approx(kelvin, rel=1e-12)
    assert "'delta_degC', need a unit" in refusal(parse_quantity, "1 delta_degC", "degC")


A_MINUTE = ["1/min", "min^-1", "min-1", "min**-1", "min⁻¹", "/min", "/ min", "U/min", "r/min"]
A_MINUTE += ["rev/min", "rpm", "U min^-1", "rev min-1", "turn/min", "revolution/minute"]
A_SECOND = ["1/s", "1 / s", "/s", "s^-1", "s-1", "Hz", "hertz", "U/s", "turn/s"]
ANGLES = {"rps": 1, "circle/s": 1, "deg/s": 360, "°/s": 360, "gon/s": 400}
RADIANS = ["rad/s", "rad s^-1", "rad s-1", "rad*Hz"]


def test_an_inverse_time_counts_turns_where_a_speed_of_rotation_is_needed():
    for units in A_MINUTE:
        assert parse_quantity(f"100 {units}", "rpm") == pytest.approx(100.0, rel=1e-15)
    for units in A_SECOND:
        assert parse_quantity(f"2 {units}", "rpm") == pytest.approx(120.0, rel=1e-15)
    for units, in_a_turn in ANGLES.items():
        assert parse_quantity(f"{2 * in_a_turn} {units}", "rpm") == pytest.approx(120.0, rel=1e-15)
        assert parse_quantity(f"{2 * in_a_turn} {units}", "Hz") == pytest.approx(2.0, rel=1e-15)
    for units in RADIANS:
        assert parse_quantity(f"{math.pi} {units}", "rpm") == pytest.approx(30.0, rel=1e-15)
        assert parse_quantity(f"{math.pi} {units}", "Hz") == pytest.approx(0.5, rel=1e-15)
    for units in ["1/mm", "min", "U", "m/s", "1/min^2", "min-11", "Umin", "/"]:
        assert repr(units) in refusal(parse_quantity, f"2 {units}", "rpm")


def test_a_unit_of_voltage_or_resistance_is_known_in_any_usual_spelling():
    for units in ("mV", "Volts"):
        assert electrical_quantity(units) == "voltage"
    for units in ("kOhm", "M\u2126", "MΩ"):
        assert electrical_quantity(units) == "resistance"
    for units in ("N", "wumpus", "dBm", "", "V/A/A", 7, None):
        needed = f"got the unit {units!r}, need one of voltage or resistance"
        assert refusal(electrical_quantity, units) == needed


def test_a_voltage_or_resistance_says_which_it_is():
    assert parse_electrical("3 mV") == (pytest.approx(3e-3, rel=1e-15), "voltage")
    assert parse_electrical("-1.5 kOhm") == (-1500.0, "resistance")
    assert parse_electrical(" 0V") == (0.0, "voltage")
    for value in ["3", 3, None, "V", "3 mm", "1e400 V", ["3 V"], ""]:
        assert "need" in refusal(parse_electrical, value)


def test_what_is_no_number_with_a_unit_is_refused_with_the_unit_that_is_needed():
    for value in [50, 50.0, True, None, [1], {"a": 1}, "", "50", "mm", "fifty mm"]:
        needed = f"got {value!r}, need a number with its unit, such as '1 m'"
        assert refusal(parse_quantity, value, "m") == needed
    comma = "got '50,5 mm', need a number with its unit, such as '1 m', with a decimal point: "
    assert refusal(parse_quantity, "50,5 mm", "m") == comma + "'50.5 mm'"
    comma = "got '0,3', need a finite number, with a decimal point: '0.3'"
    assert refusal(parse_number, "0,3") == comma
    assert refusal(parse_quantity, "1e999 mm", "m") == "got '1e999', need a finite number"


def test_a_unit_of_another_dimension_or_none_is_refused_by_name():
    for units in ["kg", "m^2", "s", "1/m", "degC", "N", "dBm", "2 mm"]:
        message = refusal(parse_quantity, f"50 {units}", "m")
        assert message == f"wrong dimension or unit {units!r}, need a unit of the kind 'm'"
    for units in ["furlongs_", "xyz"]:
        message = refusal(parse_quantity, f"50 {units}", "m")
        assert message == f"unknown unit {units!r}, need a unit of the kind 'm'"
    for units in ["mm; import os", "(m", "m/", "m**", "50 m,"]:
        assert "need a unit of the kind 'm'" in refusal(parse_quantity, f"50 {units}", "m")


def test_what_is_no_finite_number_is_refused():
    for value in [True, None, [1], b"1", "one", "1/0", "1/", "1 m", "", "nan", math.inf, "1e999"]:
        assert refusal(parse_number, value) == f"got {value!r}, need a finite number"


def test_a_number_is_printed_with_a_unit_that_is_easily_read():
    for value, unit, printed in [
        *((0.05, "m", "50 mm"), (2e-7, "m", "0.2 µm"), (5e-9, "m", "5 nm"), (1e-12, "m", "1 pm")),
        *((4.2e-4, "m", "420 µm"), (2.1e11, "Pa", "210 GPa"), (100.0, "ohm", "100 Ω")),
        *((1e3, "ohm", "1 kΩ"), (1.9999999999999998e-05, "V", "20 µV"), (-0.05, "V", "-50 mV")),
        *((0.0, "s", "0 s"), (1600.0, "N", "1600 N"), (600 / 7, "rpm", "85.7143 r/min")),
        *((40.0, "degC", "40 °C"), (3.35e-4, "m^2/s", "335 mm²/s"), (0.16, "W/m/K", "0.16 W/m/K")),
        *((1.6e-8, "1/Pa", "16 1/GPa"), (0.7, "", "0.7")),
    ]:
        assert with_unit(value, unit) == printed


@given(st.floats(min_value=1e-12, max_value=1e12))
def test_what_is_printed_is_read_again(value):
    assert parse_quantity(with_unit(value, "Pa"), "Pa") == pytest.approx(value, rel=1e-5)


def test_what_pint_reads_is_kept_and_where_that_is_impossible_read_again(tmp_path, monkeypatch):
    def grade():
        return lube.units._registry.__wrapped__().Quantity(320.0, "mm^2/s").to("m^2/s").magnitude

    expected = convert(320.0, "mm^2/s", "m^2/s")
    cache = tmp_path / "pint"
    monkeypatch.setattr(platformdirs, "user_cache_path", lambda **_: cache)
    assert grade() == expected
    files = {path: path.stat().st_mtime_ns for path in cache.iterdir()}
    assert files and grade() == expected
    assert {path: path.stat().st_mtime_ns for path in cache.iterdir()} == files
    for path in files:
        path.write_bytes(path.read_bytes()[:10])  # as another job has begun to write it
    assert grade() == expected
    shutil.rmtree(cache)
    cache.touch()  # a file where a folder is needed
    assert grade() == expected
