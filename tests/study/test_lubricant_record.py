"""Lubricant records: what is read, and each mistake refused in one line."""

import json
import subprocess
import sys
import textwrap

import pytest

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
    def write_record(text, name="my-oil.yaml"):
        path = tmp_path / name
        path.write_text(textwrap.dedent(text), encoding="utf-8")
        return path

    return write_record


def refusal(path):
    with pytest.raises(RecordError) as caught:
        load_record(path)
    message = str(caught.value)
    assert "\n" not in message
    assert str(path.parent) in message
    return message


def test_both_shipped_records_load_under_their_own_names():
    assert shipped_records() == ("mobilgear-shc-xmp-320", "n-dodecane")
    for name in shipped_records():
        assert load_record(name).name == name


def test_xmp_320_holds_the_values_of_physics_section_2_in_si():
    record = load_record("mobilgear-shc-xmp-320")
    assert [point.temperature for point in record.viscosity.points] == [40.0, 100.0]
    assert [point.kinematic_viscosity for point in record.viscosity.points] == pytest.approx(
        [335e-6, 38.3e-6], rel=1e-12
    )
    assert record.density.at_15_degC == 860.0
    assert record.pressure_viscosity.gold_base == "polyalphaolefin"
    assert record.law_used == "astm-d341"
    assert record.valid_temperatures == (40.0, 100.0)


@pytest.mark.parametrize("name", shipped_records())
def test_shipped_records_are_plain_json_and_every_section_has_a_source(name):
    content = json.loads(json.dumps(load_record(name).model_dump(mode="json")))
    sections = [value for value in content.values() if isinstance(value, dict)]
    assert len(sections) >= 3
    assert all(section["source"] for section in sections)


def test_relative_paths_start_from_the_given_folder_and_files_are_told(write, tmp_path):
    path = write(OIL)
    record = load_record("my-oil.yaml", folder=tmp_path)
    assert record.name == "my-oil"
    assert record.files == (path,)


def test_records_are_frozen(write):
    with pytest.raises(ValueError, match="frozen"):
        load_record(write(OIL)).name = "another"


def test_unknown_shipped_name_is_refused_with_the_names_there_are():
    with pytest.raises(RecordError, match=r"got 'mobil-1', need one of mobilgear.*n-dodecane"):
        load_record("mobil-1")


def test_missing_file_is_refused(tmp_path):
    with pytest.raises(RecordError, match=r"none\.yaml: cannot be read: No such file"):
        load_record("none.yaml", folder=tmp_path)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("title: My oil\n", "", "title: missing"),
        ("name: my-oil", "name: My Oil", "name: got 'My Oil'"),
        ("title: My oil", "title: My oil\ncolour: red", "colour: unknown key"),
        ("gold_base: mineral", "gold_base: mineral\n  s: 9.9", "pressure_viscosity.s: unknown"),
        ("gold_base: mineral", "gold_base: olive", "pressure_viscosity.gold_base: got 'olive'"),
        ("  source: data sheet\n", "", "density.source: missing"),
        ("  source: measured in our laboratory\n", "", "viscosity.source: missing"),
        ("source: data sheet", "source: ''", "density.source: got ''"),
        ('source: "assumed: Gold"', "source: '  '", "pressure_viscosity.source: got '  '"),
        ("100 mm^2/s}", "100}", "points.0.kinematic_viscosity: got 100, need a number with its"),
        ("100 mm^2/s}", "100 mPa*s}", "points.0.kinematic_viscosity: wrong dimension"),
        ("100 mm^2/s}", "-1 mm^2/s}", "need a value above 0"),
        ("40 degC", "-300 degC", "points.0.temperature: got -300, need a value above -273.15"),
        ("880 kg/m^3", "880", "density.at_15_degC: got 880, need a number with its unit"),
        ("880 kg/m^3", "0.88", "density.at_15_degC: got 0.88, need a number with its unit"),
        ("0.14 W/m/K", "0.14 W/m", "thermal_conductivity.value: wrong dimension"),
        (OIL[OIL.index("density:") : OIL.index("pressure_v")], "", "density: missing"),
        (OIL[OIL.index("thermal_conductivity") :], "", "thermal_conductivity: missing"),
        (POINTS, "", "viscosity: got none, need one of points, csv, coolprop_fluid"),
        (POINTS, POINTS + "  csv: a.csv\n", "viscosity: got points and csv, need one of"),
        (POINTS, "  points: []\n", "viscosity: need values at two temperatures or more"),
        ("100 degC", "40 degC", "viscosity: need values at two temperatures or more"),
        ("11 mm^2/s", "110 mm^2/s", "got no less at 100 degC than at 40 degC"),
        (
            "100 mm^2/s}",
            "100 mm^2/s, dynamic_viscosity: 9 mPa*s}",
            "viscosity.points.0: need either kinematic_viscosity or dynamic_viscosity",
        ),
        ("title: My oil", "title: My oil\nviscosity_law: walther", "viscosity_law: got 'walther'"),
        (GOLD, "", "pressure_viscosity: need either gold_base, or definition"),
        (GOLD, GOLD + "  value: 20 1/GPa\n", "need either gold_base or value, got both"),
        (GOLD, "  definition: secant\n", "pressure: need it with definition 'secant'"),
        (GOLD, GOLD + "  pressure: 200 MPa\n", "pressure: need it with definition 'secant', and"),
        (GOLD, "  definition: reciprocal-asymptotic\n", "gold_base or value: missing"),
        (GOLD, "  definition: slope\n", "pressure_viscosity.definition: got 'slope'"),
        (
            "title: My oil",
            "title: x\ntemperature_range: {lowest: 40 degC, highest: 90 degC}",
            "temperature_range.source: missing",
        ),
        (
            "title: My oil",
            "title: x\ntemperature_range: {source: x, lowest: 40 degC, highest: 30 degC}",
            "highest: got 30 degC, need more than lowest, 40 degC",
        ),
        ("name: my-oil", "name: my-oil\nname: my-oil", "key 'name' is repeated"),
    ],
)
def test_each_mistake_in_a_record_is_refused_by_key_and_value(write, old, new, message):
    assert OIL.count(old) == 1
    assert message in refusal(write(OIL.replace(old, new)))


def test_a_truncated_record_is_refused_wherever_it_is_cut(tmp_path):
    path = tmp_path / "oil.yaml"
    for length in range(0, len(OIL) - len("W/m/K\n"), 5):
        path.write_text(OIL[:length])
        with pytest.raises(RecordError) as caught:
            load_record(path)
        assert str(caught.value).startswith(f"{path}: ")
        assert "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("temperature_range:", "viscosity_law: vogel\ntemperature_range:", "viscosity_law: not"),
        (
            "temperature_range:",
            "density: {source: x, at_15_degC: 730 kg/m^3, thermal_coefficient: 1e-3 1/K}\n"
            "temperature_range:",
            "density: not allowed, CoolProp gives it for n-Decane",
        ),
        ("slope-at-atmospheric", "reciprocal-asymptotic", "got 'reciprocal-asymptotic'"),
        (
            "slope-at-atmospheric",
            "slope-at-atmospheric\n  value: 12 1/GPa",
            "gold_base or value: not allowed, CoolProp gives it for n-Decane",
        ),
        ("  definition: slope-at-atmospheric", "  gold_base: ester", "or value: not allowed"),
        (
            "slope-at-atmospheric",
            "secant\n  pressure: 0.1 MPa",
            "pressure_viscosity.pressure: got 100000, need a value above 101325",
        ),
    ],
)
def test_what_coolprop_gives_may_not_be_written_too(write, old, new, message):
    assert FLUID.count(old) == 1
    assert message in refusal(write(FLUID.replace(old, new)))


CSV_OIL = OIL.replace(POINTS, "  csv: data.csv\n")


@pytest.mark.parametrize(
    "text",
    [
        "temperature [degC],kinematic_viscosity [mm^2/s]\n40,100.5\n100,11.25\n",
        "temperature [degC];kinematic_viscosity [mm^2/s]\n40;100,5\n100;11,25\n",
        '"temperature [degC]","kinematic_viscosity [cSt]"\n40,100.5\n100,11.25\n',
        "kinematic_viscosity [ mm^2/s ] , temperature [K]\n100.5, 313.15\n11.25, 373.15\n",
        "\ufeff# our rheometer\n\ntemperature[degC],kinematic_viscosity[mm^2/s]\r\n40,100.5\r\n"
        "100,11.25\r\n",
    ],
    ids=["comma", "semicolon and decimal comma", "quoted", "kelvin, swapped", "BOM, comment, CRLF"],
)
def test_csv_variants_give_the_same_points(write, tmp_path, text):
    write(text, "data.csv")
    record = load_record(write(CSV_OIL))
    points = record.viscosity.points
    assert [point.temperature for point in points] == pytest.approx([40.0, 100.0], abs=1e-9)
    assert [point.kinematic_viscosity for point in points] == pytest.approx([100.5e-6, 11.25e-6])
    assert record.files == (tmp_path / "my-oil.yaml", tmp_path / "data.csv")
    assert len(record.model_dump(mode="json")["viscosity"]["points"]) == 2


def test_csv_may_hold_dynamic_viscosity(write):
    points = read_viscosity_csv(
        write("temperature [degC],dynamic_viscosity [mPa*s]\n40,85\n100,9\n", "data.csv")
    )
    assert [point.dynamic_viscosity for point in points] == pytest.approx([0.085, 0.009])
    assert points[0].kinematic_viscosity is None


HEADER = "temperature [degC],kinematic_viscosity [mm^2/s]\n"


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("", "data.csv: empty, need a line of column names"),
        ("temperature,viscosity\n40,100\n", "line 1: got the column 'temperature', need"),
        ("temperature [degC],nu [mm^2/s]\n40,1\n", "line 1: got the column 'nu [mm^2/s]'"),
        ("temperature [degC]\n40\n", "line 1: got the columns temperature, need"),
        ("temperature [degC],temperature [K]\n", "line 1: got the column 'temperature [K]'"),
        (
            "temperature [degC],kinematic_viscosity [mm^2/s],dynamic_viscosity [mPa*s]\n",
            "line 1: got the columns temperature, kinematic_viscosity, dynamic_viscosity",
        ),
        ("temperature [s],kinematic_viscosity [mm^2/s]\n40,100\n", "line 2: temperature: wrong"),
        (HEADER + "40,100\n# pause\n100,eleven\n", "line 4: kinematic_viscosity: got 'eleven mm"),
        (HEADER + "40,\n", "line 2: kinematic_viscosity: got ' mm^2/s'"),
        (HEADER + "40,100\n100,0\n", "line 3: kinematic_viscosity: got 0, need a value above 0"),
        (HEADER + "40,0,100,5\n", "line 2: got 4 values, need 2"),
        (HEADER + "40,100\n", "data.csv: viscosity: need values at two temperatures or more"),
        (HEADER + "40,10\n100,100\n", "got no less at 100 degC than at 40 degC"),
    ],
)
def test_each_mistake_in_a_csv_file_is_refused_by_line_and_column(write, text, message):
    write(text, "data.csv")
    assert message in refusal(write(CSV_OIL))


def test_a_missing_or_binary_csv_file_is_refused(write, tmp_path):
    assert "data.csv: cannot be read: No such file" in refusal(write(CSV_OIL))
    (tmp_path / "data.csv").write_bytes(b"\xff\xfe\x00")
    assert "data.csv: cannot be read: it is not UTF-8 text" in refusal(write(CSV_OIL))


@pytest.mark.parametrize("name", ["../data.csv", "/etc/passwd", "a/../../data.csv"])
def test_csv_files_outside_the_records_folder_are_refused(write, name):
    message = refusal(write(CSV_OIL.replace("data.csv", name)))
    assert f"viscosity.csv: got {name!r}, need a file in the record's folder" in message


@pytest.mark.parametrize("name", ["ring.csv", '"a\\0b"', "x" * 300])
def test_a_csv_file_that_cannot_be_is_refused(write, tmp_path, name):
    (tmp_path / "ring.csv").symlink_to("ring.csv")
    message = refusal(write(CSV_OIL.replace("data.csv", name)))
    assert "need a file in the record's folder" in message or "File name too long" in message


def test_a_cell_without_end_is_refused(write):
    write(HEADER + "40," + "1" * 200_000 + "\n", "data.csv")
    assert "line 2: got 1 values, need 2" in refusal(write(CSV_OIL))


@pytest.mark.parametrize("temperature", [39.9, 100.1, float("nan")])
def test_temperatures_outside_the_data_are_refused_by_name_value_and_range(write, temperature):
    with pytest.raises(RangeError, match=rf"my-oil: got {temperature:g} degC, need 40 to 100 degC"):
        check_temperatures(load_record(write(OIL)), [50.0, temperature])


def test_temperatures_at_the_ends_of_a_range_written_in_kelvin_are_within(write):
    wider = "title: x\ntemperature_range: {source: x, lowest: 293.15 K, highest: 250 degF}"
    record = load_record(write(OIL.replace("title: My oil", wider)))
    check_temperatures(record, [20.0, 121.1])
    with pytest.raises(RangeError, match=r"got 19\.9 degC, need 20 to 121\.111 degC"):
        check_temperatures(record, [19.9])


def test_a_coolprop_record_without_a_range_takes_the_liquids(write):
    text = FLUID[: FLUID.index("temperature_range:")]
    record = load_record(write(text))
    # n-Decane melts at -29.7 degC and boils at 174.1 degC (CRC Handbook of Chemistry and Physics).
    assert record.valid_temperatures == pytest.approx((-29.7, 174.1), abs=0.3)
    with pytest.raises(RangeError, match="my-fluid: got 180 degC"):
        check_temperatures(record, [180.0])


def test_reading_and_checking_records_stays_light():
    # Snakemake does this at every start.
    code = (
        "import sys; from lube.study.lubricant_record import *; "
        "[check_temperatures(load_record(name), [40.0, 80.0]) for name in shipped_records()]; "
        "print([m for m in ('xarray', 'scipy.optimize', 'CoolProp', 'pandas') if m in sys.modules])"
    )
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, check=True)
    assert done.stdout.strip() == "[]"


def test_viscosity_must_fall_between_all_neighbours(write):
    write(HEADER + "20,460\n40,100\n30,50\n", "data.csv")
    assert "got no less at 40 degC than at 30 degC" in refusal(write(CSV_OIL))


def test_a_temperature_may_be_measured_twice(write):
    write(HEADER + "20,460\n40,100\n40,101\n", "data.csv")
    assert len(load_record(write(CSV_OIL)).viscosity.points) == 3


def test_a_point_among_decimal_commas_is_not_read_as_either(write):
    header = HEADER.replace(",", ";")
    write(header + "20;1.100\n40;46,2\n", "data.csv")
    assert "line 2: got '1.100' in a file with decimal commas" in refusal(write(CSV_OIL))
    write(header + "20;1.1e3\n40;46.2\n", "data.csv")  # semicolons alone say nothing
    viscosity = load_record(write(CSV_OIL)).viscosity.points[0].kinematic_viscosity
    assert viscosity == pytest.approx(1.1e-3)
