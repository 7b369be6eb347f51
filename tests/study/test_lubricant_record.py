"""Lubricant records: read whole, or each mistake refused in one line."""

import json
import subprocess
import sys

import pytest
from refusals import one_line

from lube.errors import RangeError, RecordError
from lube.study.lubricant_record import (
    check_temperatures,
    load_record,
    read_viscosity_csv,
    shipped_records,
)

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
    assert shipped_records() == ("mobilgear-shc-xmp-320", "n-dodecane")
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


def test_an_unknown_name_and_a_missing_file_are_refused(tmp_path):
    with pytest.raises(RecordError, match=r"got 'mobil-1', need one of mobilgear.*n-dodecane"):
        load_record("mobil-1")
    with pytest.raises(RecordError, match=r"none\.yaml: cannot be read: No such file"):
        load_record("none.yaml", folder=tmp_path)


MISTAKES = [
    ("name: my-oil", "name: My Oil", "name: got 'My Oil'"),
    ("gold_base:", "gold_bass:", "pressure_viscosity.gold_bass: unknown key, did you mean 'gold_b"),
    ("gold_base: mineral", "gold_base: olive", "pressure_viscosity.gold_base: got 'olive'"),
    ("  source: data sheet\n", "", "density.source: missing"),
    ('source: "assumed: Gold"', "source: '  '", "pressure_viscosity.source: got '  '"),
    ("100 mm^2/s}", "100}", "points.0.kinematic_viscosity: got 100, need a number with its"),
    (OIL[OIL.index("density:") : OIL.index("pressure_v")], "", "density: missing"),
    (POINTS, "", "viscosity: got none, need one of points, csv, coolprop_fluid"),
    (POINTS, POINTS + "  csv: a.csv\n", "viscosity: got points and csv, need one of"),
    (POINTS, "  points: []\n", "viscosity: need values at two temperatures or more"),
    ("11 mm^2/s", "110 mm^2/s", "viscosity: need less at 100 degC than at 40 degC"),
    ("100 mm^2/s}", "100 mm^2/s, dynamic_viscosity: 9 mPa*s}", "viscosity.points.0: need either k"),
    ("title: My oil", "title: My oil\nviscosity_law: walther", "viscosity_law: got 'walther'"),
    (GOLD, "", "pressure_viscosity: need either gold_base alone, or definition"),
    (GOLD, GOLD + "  value: 20 1/GPa\n", "need either gold_base alone, or definition"),
    (GOLD, "  definition: secant\n", "pressure: need it with definition 'secant'"),
    (GOLD, GOLD + "  pressure: 200 MPa\n", "pressure: need it with definition 'secant', and"),
    (GOLD, "  definition: reciprocal-asymptotic\n", "gold_base or value: missing"),
    (
        "title: My oil",
        "title: x\ntemperature_range: {source: x, lowest: 40 degC, highest: 30 degC}",
        "temperature_range: got 40 to 30 degC, need the lowest first",
    ),
]

# What CoolProp gives may not be written too.
SLOPE, RANGE = "slope-at-atmospheric", "temperature_range:"
DENSITY = OIL[OIL.index("density:") : OIL.index("pressure_v")]
COOLPROP_MISTAKES = [
    (RANGE, f"viscosity_law: vogel\n{RANGE}", "viscosity_law: not allowed"),
    (RANGE, DENSITY + RANGE, "density: not allowed, CoolProp gives it for n-Decane"),
    (SLOPE, "reciprocal-asymptotic", "'reciprocal-asymptotic' not allowed"),
    (SLOPE, f"{SLOPE}\n  value: 12 1/GPa", "gold_base or value: not allowed, CoolProp gives it"),
    (f"  definition: {SLOPE}", "  gold_base: ester", "or value: not allowed"),
    (SLOPE, "secant\n  pressure: 0.1 MPa", "pressure: got 100000, need a value above 101325"),
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
        (HEADER.strip() + ",dynamic_viscosity [mPa*s]\n", "line 1: got the columns 'temperature"),
        ("temperature [s],kinematic_viscosity [mm^2/s]\n40,100\n", "line 2: temperature: wrong"),
        (HEADER + "40,100\n# pause\n100,eleven\n", "line 4: kinematic_viscosity: got 'eleven mm"),
        (HEADER + "40,100\n100,0\n", "line 3: kinematic_viscosity: got 0, need a value above 0"),
        (HEADER + "40,0,100,5\n", "line 2: got 4 values, need 2"),
        (HEADER + "40,100\n", "data.csv: viscosity: need values at two temperatures or more"),
        (HEADER + "40,10\n100,100\n", "need less at 100 degC than at 40 degC"),
        (HEADER.replace(",", ";") + "20;1.100\n40;46,2\n", "line 2: got '1.100' in a file with d"),
    ]:
        write(text, "data.csv")
        assert message in refusal(write(CSV_OIL))


def test_a_csv_file_must_exist_in_the_records_folder(write):
    assert "data.csv: cannot be read: No such file" in refusal(write(CSV_OIL))
    for name in ("../data.csv", "/etc/passwd", "a/../../data.csv"):
        message = refusal(write(CSV_OIL.replace("data.csv", name)))
        assert f"viscosity.csv: got {name!r}, need a file in the record's folder" in message


# Temperatures


def test_temperatures_outside_the_range_are_refused_by_name_value_and_range(write):
    record = load_record(write(OIL))
    for temperature in (39.9, 100.1, float("nan")):
        needed = rf"my-oil: got {temperature:g} degC, need 40 to 100 degC"
        with pytest.raises(RangeError, match=needed):
            check_temperatures(record, [50.0, temperature])
    wider = "title: x\ntemperature_range: {source: x, lowest: 293.15 K, highest: 250 degF}"
    record = load_record(write(OIL.replace("title: My oil", wider)))
    check_temperatures(record, [20.0, 121.1])  # the ends, in spite of rounding
    with pytest.raises(RangeError, match=r"got 19\.9 degC, need 20 to 121\.111 degC"):
        check_temperatures(record, [19.9])


def test_a_coolprop_record_without_a_range_has_that_of_the_liquid(write):
    record = load_record(write(FLUID[: FLUID.index("temperature_range:")]))
    # n-Decane melts at -29.7 degC and boils at 174.1 degC (CRC Handbook of Chemistry and Physics).
    assert record.valid_temperatures == pytest.approx((-29.7, 174.1), abs=0.3)
    with pytest.raises(RangeError, match="my-fluid: got 180 degC"):
        check_temperatures(record, [180.0])


def test_reading_and_checking_records_does_not_import_heavy_libraries():
    # Snakemake does this at every start.
    code = (
        "import sys; from lube.study.lubricant_record import *; "
        "[check_temperatures(load_record(name), [40.0, 80.0]) for name in shipped_records()]; "
        "print([m for m in ('xarray', 'scipy.optimize', 'CoolProp', 'pandas') if m in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"
