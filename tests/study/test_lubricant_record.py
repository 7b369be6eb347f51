"""Lubricant records: read whole, or each mistake refused in one line."""

import json
import subprocess
import sys

import pytest
from refusals import one_line

from lube.errors import LubeError, RangeError, RecordError
from lube.physics.viscosity_index import viscosity_index
from lube.study.lubricant_record import load_record, shipped_records
from lube.study.viscosity_points import read_viscosity_csv

OIL = """\
name: my-oil
title: My oil
viscosity:
  source: measured in our laboratory
  points:
    - {temperature: 40 degC, kinematic_viscosity: 100 mm^2/s}
    - {temperature: 100 degC, kinematic_viscosity: 11 mm^2/s}
density:
  source: data sheet
  at_15_degC: 880 kg/m^3
  thermal_coefficient: 6.5e-4 1/K
pressure_viscosity:
  source: "assumed: Gold"
  gold_base: mineral
thermal_conductivity:
  source: "assumed: typical"
  value: 0.14 W/m/K
"""
POINTS = OIL[OIL.index("  points:") : OIL.index("density:")]
GOLD = "  gold_base: mineral\n"

FLUID = """\
name: my-fluid
title: My fluid
viscosity:
  source: CoolProp
  coolprop_fluid: n-Decane
pressure_viscosity:
  source: CoolProp
  definition: slope-at-atmospheric
temperature_range:
  source: "assumed: liquid"
  lowest: 0 degC
  highest: 100 degC
"""


@pytest.fixture
def write(tmp_path):
    def write_file(text, name="my-oil.yaml"):
        path = tmp_path / name
        path.write_text(text, encoding="utf-8")
        return path

    return write_file


def refusal(path):
    message = one_line(RecordError, load_record, path)
    assert str(path.parent) in message
    return message


def test_the_shipped_records_are_plain_json_and_every_section_has_a_source():
    assert {"mobilgear-shc-xmp-320", "n-dodecane"} <= set(shipped_records())
    for name in shipped_records():
        record = load_record(name)
        assert record.name == name
        content = json.loads(json.dumps(record.model_dump(mode="json")))
        sections = [value for value in content.values() if isinstance(value, dict)]
        assert len(sections) >= 3
        assert all(section["source"] for section in sections)


def test_xmp_320_has_the_values_of_physics_section_2_in_si():
    record = load_record("mobilgear-shc-xmp-320")
    assert [point.temperature for point in record.viscosity.points] == [40.0, 100.0]
    viscosities = [point.kinematic_viscosity for point in record.viscosity.points]
    assert viscosities == pytest.approx([335e-6, 38.3e-6], rel=1e-12)
    assert record.density.at_15_degC == 860.0
    assert record.pressure_viscosity.gold_base == "polyalphaolefin"
    assert record.law_used == "astm-d341"
    assert record.valid_temperatures == (40.0, 100.0)


@pytest.mark.parametrize("name", ["PAO", "Polyalphaolefin"])
def test_a_base_oil_may_be_abbreviated_in_any_case(write, name):
    record = load_record(write(OIL.replace("gold_base: mineral", f"gold_base: {name}")))
    assert record.pressure_viscosity.gold_base == "polyalphaolefin"


def test_gear_oils_of_four_bases_are_shipped_in_all_grades():
    grades = [32, 46, 68, 100, 150, 220, 320, 460, 680]
    for base in ("mineral", "pao", "ester", "polyglycol"):
        for grade in grades:
            record = load_record(f"{base}-iso-vg-{grade}")
            at_40, at_100 = record.viscosity.points
            # ISO 3448 names a grade by its mid-point at 40 degC.
            assert at_40.kinematic_viscosity == pytest.approx(grade * 1e-6)
            index = viscosity_index(grade, at_100.kinematic_viscosity * 1e6)
            assert index == pytest.approx(record.viscosity.viscosity_index, abs=0.1)
            assert str(grade) in record.title and record.valid_temperatures == (40.0, 100.0)
            assert all("assumed" in one.source for one in (record.viscosity, record.density))
    assert sum("-iso-vg-" in name for name in shipped_records()) == 4 * len(grades)


def test_stachowiaks_oils_hold_the_figures_of_the_table():
    # G. W. Stachowiak and A. W. Batchelor, Engineering Tribology, Table 2.3, at 30, 60, 100 degC.
    for name, viscosities, coefficients in [
        ("light-machine-oil", (38, 12.1, 5.3), (18.4, 13.4)),
        ("heavy-machine-oil-1", (153, 34, 9.1), (23.7, 20.5, 15.8)),
        ("heavy-machine-oil-2", (250, 50.5, 12.6), (25.0, 21.3, 17.6)),
        ("cylinder-oil", (810, 135, 26.8), (34, 28, 22)),
    ]:
        record = load_record(f"stachowiak-{name}")
        points, alphas = record.viscosity.points, record.pressure_viscosity.points
        assert [point.temperature for point in points] == [30.0, 60.0, 100.0]
        assert [1e3 * point.dynamic_viscosity for point in points] == pytest.approx(viscosities)
        assert [point.value for point in alphas] == pytest.approx(coefficients)
        # Without a coefficient at 30 degC the light oil is known from 60 degC only.
        assert record.valid_temperatures == (alphas[0].temperature, 100.0)


def test_an_unknown_name_and_a_missing_file_are_refused(tmp_path):
    with pytest.raises(RecordError, match=r"got 'mobil-1', need one of base-oil.*mobilgear"):
        load_record("mobil-1")
    with pytest.raises(RecordError, match=r"none\.yaml: cannot be read: No such file"):
        load_record(tmp_path / "none.yaml")


SLOPE = "slope-at-atmospheric"
ALPHA = f"""\
  points:
    - {{temperature: 40 degC, value: 18 1/GPa}}
    - {{temperature: 60 degC, value: 16 1/GPa}}
  definition: {SLOPE}
"""

MISTAKES = [
    ("name: my-oil", "name: My Oil", "name: got 'My Oil'"),
    ("gold_base:", "gold_bass:", "pressure_viscosity.gold_bass: unknown key, did you mean 'gold_b"),
    ("gold_base: mineral", "gold_base: olive", "pressure_viscosity.gold_base: got 'olive'"),
    ("  source: data sheet\n", "", "density.source: missing"),
    ('source: "assumed: Gold"', "source: '  '", "pressure_viscosity.source: got '  '"),
    ("100 mm^2/s}", "100}", "points.0.kinematic_viscosity: got 100, need a number with its"),
    (OIL[OIL.index("density:") : OIL.index("pressure_v")], "", "density: missing"),
    (POINTS, "", "viscosity: got none, need one of points, csv, iso_vg, coolprop_fl"),
    (POINTS, POINTS + "  csv: a.csv\n", "viscosity: got points and csv, need one of"),
    (POINTS, "  points: []\n", "viscosity: got fewer than two temperatures"),
    ("11 mm^2/s", "110 mm^2/s", "viscosity: got 110 mm2/s at 100 degC, need less than at 40 degC"),
    (
        "100 mm^2/s}",
        "100 mm^2/s, dynamic_viscosity: 80 mPa*s}",
        "viscosity: got 92.41 mm2/s (80 mPa s over 865.7 kg/m3) and 100 mm2/s at 40 degC, need one "
        "value, or several within 2 %",
    ),
    (", kinematic_viscosity: 100 mm^2/s", "", "points.0: got no viscosity, need kinematic_visc"),
    (
        "    - {temperature: 100",
        "    - {temperature: 313.15 K, kinematic_viscosity: 97 mm^2/s}\n    - {temperature: 100",
        "viscosity: got 97 mm2/s and 100 mm2/s at 40 degC, need one value, or several within 2 %",
    ),
    ("100 mm^2/s}", "100 mm^2/s, pressure: 9 MPa}", "got kinematic_viscosity at 9 MPa, need dynam"),
    (POINTS, "  iso_vg: 220\n", "viscosity.viscosity_index: need one if iso_vg is given"),
    (POINTS, POINTS + "  viscosity_index: 95\n", "viscosity_index: need one if iso_vg is given"),
    (
        POINTS,
        "  iso_vg: 200\n  viscosity_index: 95\n",
        "viscosity.iso_vg: got 200, need 10, 15, 22",
    ),
    (
        POINTS,
        f"  iso_vg: {22 * 10**40}\n  viscosity_index: 95\n",
        f"viscosity.iso_vg: got {22 * 10**40}, need a smaller number",
    ),
    ("title: My oil", "title: My oil\nviscosity_law: walther", "viscosity_law: got 'walther'"),
    (GOLD, "", "pressure_viscosity: need either gold_base alone, or a"),
    (GOLD, GOLD + "  value: 20 1/GPa\n", "need either gold_base alone, or a"),
    (GOLD, "  definition: secant\n", "pressure: need one if definition is"),
    (GOLD, GOLD + "  pressure: 200 MPa\n", "pressure: need one if definition is"),
    (
        GOLD,
        f"  definition: {SLOPE}\n",
        "pressure_viscosity: got none, need one of gold_base, value",
    ),
    (
        GOLD,
        ALPHA.replace("18 1/GPa", "18 1/Pa"),
        ".value: got 18 1/Pa, need a value at least 1 and at",
    ),
    (
        GOLD,
        ALPHA.replace("18 1/GPa", "1.8e-8 1/GPa"),
        "value: got 1.8e-8 1/GPa, need a value at",
    ),
    (GOLD, ALPHA + "  value: 18 1/GPa\n", "pressure_viscosity: got value and points, need one of"),
    (GOLD, ALPHA.replace("60 degC", "40 degC"), "points: got two values at 40 degC, need one"),
    (
        GOLD,
        ALPHA.replace("40", "120").replace("60", "130"),
        "got no temperature with both viscosity",
    ),
    (
        "title: My oil",
        "title: x\ntemperature_range: {source: x, lowest: 40 degC, highest: 30 degC}",
        "temperature_range: got 40 to 30 degC, need the lowest first",
    ),
]

# What CoolProp gives may not be written too.
RANGE = "temperature_range:"
DENSITY = OIL[OIL.index("density:") : OIL.index("pressure_v")]
COOLPROP_MISTAKES = [
    (RANGE, f"viscosity_law: vogel\n{RANGE}", "viscosity_law: not allowed"),
    (RANGE, DENSITY + RANGE, "density: not allowed, CoolProp gives it for n-Decane"),
    (SLOPE, "reciprocal-asymptotic", "'reciprocal-asymptotic' not allowed"),
    (SLOPE, f"{SLOPE}\n  value: 12 1/GPa", "viscosity.value: not allowed, CoolProp gives it for"),
    (f"  definition: {SLOPE}", "  gold_base: ester", "pressure_viscosity.gold_base: not allowed"),
    (SLOPE, "secant\n  pressure: 0.1 MPa", "pressure: got 0.1 MPa, need a value above 101325"),
]


def test_each_mistake_in_a_record_is_refused_by_key_and_value(write):
    for text, mistakes in ((OIL, MISTAKES), (FLUID, COOLPROP_MISTAKES)):
        for old, new, message in mistakes:
            assert text.count(old) == 1
            assert message in refusal(write(text.replace(old, new)))


# Viscosities in a CSV file

CSV_OIL = OIL.replace(POINTS, "  csv: data.csv\n")
HEADER = "temperature [degC],kinematic_viscosity [mm^2/s]\n"


def test_csv_variants_give_the_same_points(write, tmp_path):
    for text in (
        "temperature [degC],kinematic_viscosity [mm^2/s]\n40,100.5\n100,11.25\n",
        "temperature [degC];kinematic_viscosity [mm^2/s]\n40;100,5\n100;11,25\n",
        "temperature [degC];kinematic_viscosity [mm^2/s]\n40;1.005e2\n100;11.25\n",
        '"temperature [degC]","kinematic_viscosity [cSt]"\n40,100.5\n100,11.25\n',
        "kinematic_viscosity [ mm^2/s ] , temperature [K]\n100.5, 313.15\n11.25, 373.15\n",
        "\ufeff# our rheometer\n\ntemperature[degC],kinematic_viscosity[mm^2/s]\r\n"
        "40,100.5\r\n100,11.25\r\n",
    ):
        write(text, "data.csv")
        record = load_record(write(CSV_OIL))
        points = record.viscosity.points
        assert [point.temperature for point in points] == pytest.approx([40, 100], abs=1e-9)
        viscosities = [point.kinematic_viscosity for point in points]
        assert viscosities == pytest.approx([100.5e-6, 11.25e-6])
        assert record.files == (tmp_path / "my-oil.yaml", tmp_path / "data.csv")
        assert len(record.model_dump(mode="json")["viscosity"]["points"]) == 2


def test_csv_may_contain_dynamic_viscosity_and_a_temperature_twice(write):
    text = "temperature [degC],dynamic_viscosity [mPa*s]\n40,85\n100,9\n100,9.1\n"
    points = read_viscosity_csv(write(text, "data.csv"))
    assert [point.dynamic_viscosity for point in points] == pytest.approx([0.085, 0.009, 0.0091])
    assert load_record(write(CSV_OIL)).viscosity.points == points


def test_each_mistake_in_a_csv_file_is_refused_by_line_and_column(write):
    for text, message in [
        ("", "data.csv: empty, need a line of column names"),
        ("temperature,viscosity\n", "line 1: got the columns 'temperature, viscosity', need"),
        ("temperature [degC],nu [mm^2/s]\n", "line 1: got the columns 'temperature [degC], nu"),
        ("temperature [degC],pressure [MPa]\n", "line 1: got the columns 'temperature [degC], pr"),
        ("temperature [s],kinematic_viscosity [mm^2/s]\n40,100\n", "line 2: temperature: wrong"),
        (HEADER + "40,100\n# pause\n100,eleven\n", "line 4: kinematic_viscosity: got 'eleven mm"),
        (HEADER + "40,100\n100,0\n", "line 3: kinematic_viscosity: got 0 mm^2/s, need a"),
        (HEADER + "40,\n100,10\n", "line 2: got no viscosity, need kinematic_viscosity or dynamic"),
        (HEADER + ",30\n100,10\n", "line 2: temperature: missing, and it has no default"),
        (HEADER + "40,0,100,5\n", "line 2: got 4 values, need one for each of 2 columns"),
        (HEADER + "40,100\n", "data.csv: viscosity: got fewer than two temperatures"),
        (HEADER + "40,10\n100,100\n", "at 100 degC, need less than at 40 degC"),
        (HEADER.replace(",", ";") + "20;1.100\n40;46,2\n", "line 2: got '1.100' in a file with d"),
    ]:
        write(text, "data.csv")
        assert message in refusal(write(CSV_OIL))


def test_a_csv_file_must_exist_in_the_records_folder(write):
    assert "data.csv: cannot be read: No such file" in refusal(write(CSV_OIL))
    for name in ("../data.csv", "/etc/passwd", "a/../../data.csv"):
        message = refusal(write(CSV_OIL.replace("data.csv", name)))
        assert f"viscosity.csv: got {name!r}, need a file in the record's folder" in message


def test_a_csv_file_may_have_the_one_viscosity_in_some_rows_and_the_other_in_others(write):
    text = HEADER.strip() + ",dynamic_viscosity [mPa*s]\n40,100,\n100,,9.1\n"
    first, second = read_viscosity_csv(write(text, "data.csv"))
    assert first.kinematic_viscosity == pytest.approx(1e-4) and first.dynamic_viscosity is None
    assert second.dynamic_viscosity == pytest.approx(9.1e-3)


def test_csv_may_contain_both_viscosities_if_they_agree(write):
    text = HEADER.strip() + ",dynamic_viscosity [mPa*s]\n40,100,86.57\n100,11,{}\n"
    write(text.format(9.1), "data.csv")
    record = load_record(write(CSV_OIL))
    assert record.data[0] == pytest.approx((40.0, 100e-6))
    assert record.viscosity.points[0].dynamic_viscosity == pytest.approx(0.08657)
    write(text.format(11), "data.csv")
    assert "got 11 mm2/s and 13.23 mm2/s (11 mPa s over 831.4 kg/m3)" in refusal(write(CSV_OIL))


# Viscosities under pressure

PRESSURES = """\
temperature [degC]; pressure [MPa]; dynamic_viscosity [mPa*s]
40; 0.1; 80
40; 50; 200
40; 100; 420
40; 200; 1600
80; 0.1; 20
80; 50; 40
80; 100; 70
80; 200; 200
"""
PRESSED = CSV_OIL.replace(GOLD, "  definition: reciprocal-asymptotic\n")


def test_viscosities_under_pressure_are_read_by_temperature(write):
    write(PRESSURES.replace(".", ","), "data.csv")
    record = load_record(write(PRESSED))
    assert [temperature for temperature, _ in record.data] == [40.0, 80.0]
    assert list(record.isotherms) == [40.0, 80.0]
    pressures, ratios = zip(*record.isotherms[40.0], strict=True)
    assert pressures == pytest.approx((49.9e6, 99.9e6, 199.9e6), rel=1e-3)
    assert ratios == pytest.approx((2.5, 5.25, 20.0))
    assert record.valid_temperatures == (40.0, 80.0)


def test_each_mistake_in_viscosities_under_pressure_is_refused(write):
    secant = PRESSED.replace("reciprocal-asymptotic", "secant\n  pressure: 250 MPa")
    for record, old, new, message in [
        (
            PRESSED,
            "80; 200; 200\n",
            "",
            "got 2 pressures above atmospheric at 80 degC, need 3 or mo",
        ),
        (PRESSED, "80; 200; 200", "80; 200; 90", "got a rise to 4.5 times that at atmospheric"),
        (
            PRESSED,
            "80; 200; 200",
            "80; 100; 90",
            "and 4.5 times that at atmospheric pressure at 80",
        ),
        (
            PRESSED,
            "40; 100; 420",
            "40; 100; 190",
            "got no rise at 40 degC from 50 MPa to 100 MPa",
        ),
        (PRESSED, "40; 0.1; 80", "20; 0.1; 280", "got values at 40 degC under pressure only"),
        (
            PRESSED,
            "40; 0.1; 80",
            "40; -1; 80",
            "line 2: pressure: got -1 MPa, need a value at least",
        ),
        (
            secant,
            "",
            "",
            "pressure_viscosity.pressure: got 250 MPa, need at most",
        ),
        (CSV_OIL, "", "", "pressure_viscosity: got gold_base and viscosities under pressure"),
    ]:
        write(PRESSURES.replace(old, new) if old else PRESSURES, "data.csv")
        assert message in refusal(write(record))
    write(HEADER + "40,100\n100,11\n", "data.csv")
    assert "pressure_viscosity: got none, need one of gold_base, value" in refusal(write(PRESSED))


# Temperatures


def test_temperatures_outside_the_range_are_refused_by_name_value_and_range(write):
    record = load_record(write(OIL))
    for temperature in (39.9, 100.1, float("nan")):
        needed = rf"my-oil: got {temperature:g} degC, need 40 to 100 degC"
        with pytest.raises(RangeError, match=needed):
            record.check_temperatures([50.0, temperature])
    wider = "title: x\ntemperature_range: {source: x, lowest: 293.15 K, highest: 250 degF}"
    record = load_record(write(OIL.replace("title: My oil", wider)))
    record.check_temperatures([20.0, 121.1])  # the ends, in spite of rounding
    with pytest.raises(RangeError, match=r"got 19\.9 degC, need 20 to 121\.111 degC"):
        record.check_temperatures([19.9])


def test_a_coolprop_record_without_a_range_has_that_of_the_liquid(write):
    record = load_record(write(FLUID[: FLUID.index("temperature_range:")]))
    # n-Decane melts at -29.7 degC and boils at 174.1 degC (CRC Handbook of Chemistry and Physics).
    assert record.valid_temperatures == pytest.approx((-29.7, 174.1), abs=0.3)
    with pytest.raises(RangeError, match="my-fluid: got 180 degC"):
        record.check_temperatures([180.0])


def test_a_coolprop_fluid_that_cannot_serve_is_refused_without_computing_its_table(write):
    secant = FLUID.replace(SLOPE, "secant\n  pressure: {} MPa")
    for text, message in [
        (FLUID.replace("n-Decane", "n-Undecane"), "need a fluid whose viscosity CoolProp knows"),
        (FLUID.replace("n-Decane", "INCOMP::S800"), "need a pure fluid by CoolProp's spelling"),
        (secant.format(900), "n-Decane: got a pressure of 900 MPa, CoolProp's range is"),
    ]:
        record = load_record(write(text))
        line = one_line(LubeError, record.check_fluid, [40.0])
        assert line.startswith("my-fluid: ") and message in line
    load_record(write(secant.format(100))).check_fluid([40.0, 80.0])
    load_record(write(OIL)).check_fluid([40.0])


def test_reading_and_checking_records_does_not_import_heavy_libraries():
    # Snakemake does this at every start.
    code = (
        "import sys; from lube.study.lubricant_record import *; "
        "[load_record(name).check_temperatures([60.0, 80.0]) for name in shipped_records()]; "
        "print([m for m in ('xarray', 'scipy.optimize', 'CoolProp', 'pandas') if m in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
