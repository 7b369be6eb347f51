"""Manifests: good rows are read, bad ones are told one by one and hide nothing."""

import math

import numpy as np
import pytest
import yaml

from lube.errors import DataError
from lube.recordings.manifest import read_manifest
from lube.recordings.reader import open_recording

HEADER = "file,probability,lower,upper,force [kN],speed [rpm],temperature [degC],origin"


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "a.csv").write_text("t [s],U [V]\n0,1\n1,2\n")
    return tmp_path


def manifest(folder, *lines, name="manifest.csv"):
    (folder / name).write_text("\n".join([*lines, ""]), encoding="utf-8")
    return read_manifest(folder / name)


def test_a_table_of_records_and_shares(folder):
    found = manifest(
        folder,
        "# rig 2",
        "file,probability,lower,upper,force [kN],speed [1/s turn],temperature [K],lubricant,"
        "slide_to_roll_ratio,sampling_interval [us]".replace("1/s turn", "turn/s"),
        "a.csv,,,,0.8,2,313.15,oil,0.1,10",
        "",
        ",0.25,0.2,0.3,0.8,2,323.15,,,",
    )
    assert (found.origin, found.refused) == ("measured", ())
    record, share = found.entries
    assert (record.where, share.where) == ("manifest.csv: line 3", "manifest.csv: line 5")
    assert record.file == folder / "a.csv"
    point = (record.force, record.speed, record.temperature)
    assert point == pytest.approx((800.0, 120.0, 40.0))
    assert (record.lubricant, record.slide_to_roll_ratio) == ("oil", 0.1)
    assert record.sampling_interval == pytest.approx(1e-5)
    assert (record.probability, record.lower, record.upper) == (None, None, None)
    assert (share.probability, share.lower, share.upper) == (0.25, 0.2, 0.3)
    assert (share.file, share.lubricant, share.slide_to_roll_ratio) == (None, None, None)
    assert share.sampling_interval is None


@pytest.mark.parametrize("delimiter", [";", "\t"])
def test_decimal_commas_in_a_table(folder, delimiter):
    header = HEADER.replace(",", delimiter)
    row = delimiter.join(["", "0,25", "0,2", "0,3", "0,8", "100", "40,5", "simulated"])
    found = manifest(folder, header, row)
    (entry,) = found.entries
    assert (entry.probability, entry.lower, entry.upper) == (0.25, 0.2, 0.3)
    assert (entry.force, entry.temperature) == (800.0, 40.5)
    assert found.origin == "simulated"


def test_a_file_name_keeps_its_comma(folder):
    (folder / "1,5 kN.csv").write_text("t [s]")
    found = manifest(folder, HEADER, '"1,5 kN.csv",,,,1.5,100,40,')
    assert found.entries[0].file.name == "1,5 kN.csv"


def test_a_yaml_list(folder):
    found = manifest(
        folder,
        "- {file: a.csv, force: 800 N, speed: 100 rpm, temperature: 40 degC,",
        "   sampling_interval: 10 us, lubricant: oil, slide_to_roll_ratio: 0.1}",
        '- {probability: "0,25", upper: 1/3, force: "0,8 kN", speed: 100 rpm,',
        "   temperature: 313.15 K, lubricant: another}",
        name="manifest.yaml",
    )
    assert found.refused == ()
    record, share = found.entries
    assert (record.where, record.file) == ("manifest.yaml: entry 1", folder / "a.csv")
    assert record.sampling_interval == pytest.approx(1e-5)
    assert (share.probability, share.upper, share.lower) == (0.25, 1 / 3, None)
    assert (share.force, share.temperature) == pytest.approx((800.0, 40.0))


def test_files_above_the_folder_and_absolute_ones_are_read_if_they_are_there(folder):
    (folder / "below").mkdir()
    rows = ["../a.csv,,,,0.8,100,40,", f"{folder}/a.csv,,,,0.8,100,50,", "../b.csv,,,,0.8,100,60,"]
    found = manifest(folder / "below", HEADER, *rows)
    assert [entry.file.resolve() for entry in found.entries] == [folder / "a.csv"] * 2
    assert found.refused == ("manifest.csv: line 4: file: got '../b.csv', no such file",)


@pytest.mark.parametrize(
    ("row", "told"),
    [
        ("b.csv,,,,0.8,100,50,", "file: got 'b.csv', no such file"),
        (".,,,,0.8,100,50,", "file: got '.', no such file"),
        (",1.25,,,0.8,100,50,", "probability: got 1.25, need a value at least 0 and at most 1"),
        (",-0.1,,,0.8,100,50,", "probability: got -0.1, need a value at least 0 and at most 1"),
        (",nan,,,0.8,100,50,", "probability: got 'nan', need a finite number"),
        (",0.5,0.6,0.7,0.8,100,50,", "probability: got [0.6, 0.5, 0.7], need lower, probability"),
        (",0.5,0.4,1.7,0.8,100,50,", "upper: got 1.7, need a value at least 0 and at most 1"),
        (",,,,0.8,100,50,", "need either file or probability"),
        ("a.csv,0.5,,,0.8,100,50,", "need either file or probability"),
        ("a.csv,,0.4,,0.8,100,50,", "lower: not allowed with file"),
        (",0.5,,,,100,50,", "force: missing, and it has no default"),
        (",0.5,,,abc,100,50,", "force: got 'abc kN', need a number with its unit"),
        (",0.5,,,-0.8,100,50,", "force: got -800, need a value above 0 N"),
        (",0.5,,,0.8,100,50", "got 7 values, need 8"),
        (",0.5,,,0.8,100,50,guessed", "origin: got 'guessed', need 'measured' or 'simulated'"),
        (",0.5,,,0.8,100,50,simulated", "origin: got 'simulated' among rows that are measured"),
    ],
)
def test_a_row_that_cannot_be_used_is_told_and_hides_no_other(folder, row, told):
    found = manifest(folder, HEADER, "a.csv,,,,0.8,100,40,", row, ",0.9,,,0.8,100,60,measured")
    assert [entry.temperature for entry in found.entries] == [40.0, 60.0]
    (line,) = found.refused
    assert line.startswith(f"manifest.csv: line 3: {told}")
    assert "\n" not in line


@pytest.mark.parametrize("name", ["x" * 300, "x/" * 3000, "a\0b", "."])
def test_a_name_that_no_record_has_is_told(folder, name):
    (line,) = manifest(folder, HEADER, f"{name},,,,0.8,100,50,").refused
    assert line.startswith("manifest.csv: line 2: file: got ")
    assert line.endswith("no such file")
    assert len(line) < 200
    assert line.isprintable()


@pytest.mark.parametrize(
    ("row", "told"),
    [
        ("hello", "need a mapping of keys to values, got str"),
        ("{force: 800 N}", "speed: missing"),
        ("{probability: 0.5, force: 800, speed: 1 rpm, temperature: 1 K}", "force: got 800, need"),
        ("{probability: 0.5, force: 8 m, speed: 1 rpm, temperature: 1 K}", "force: wrong dim"),
        ("{probability: 0.5, force: 8 mew, speed: 1 rpm, temperature: 1 K}", "force: unknown unit"),
        ("{probability: 0.5, forse: 8 N, force: 8 N, speed: 1 rpm, temperature: 1 K}", "forse: un"),
        ("{file: 7, force: 8 N, speed: 1 rpm, temperature: 1 K}", "file: got 7, need text"),
        (
            "{probability: 1, sampling_interval: 1 s, force: 8 N, speed: 1 rpm, temperature: 1 K}",
            "sampling_interval: not allowed with probability",
        ),
    ],
)
def test_an_entry_that_cannot_be_used_is_told(folder, row, told):
    good = "- {probability: 0.5, force: 800 N, speed: 1 rpm, temperature: 40 degC}"
    found = manifest(folder, good, f"- {row}", name="manifest.yml")
    assert len(found.entries) == 1
    (line,) = found.refused
    assert line.startswith(f"manifest.yml: entry 2: {told}")
    assert "\n" not in line


def test_the_first_usable_row_tells_the_origin(folder):
    rows = [",7,,,0.8,100,40,simulated", ",0.5,,,0.8,100,50,measured", ",0.5,,,0.8,100,60,"]
    found = manifest(folder, HEADER, *rows)
    assert (found.origin, len(found.entries)) == ("measured", 2)


def test_several_records_may_be_of_one_operating_point(folder):
    header = "probability,force [N],speed [rpm],temperature [degC],lubricant,pair"
    found = manifest(folder, header, *["0.5,800,100,40,oil,A"] * 2, "0.5,800,100,40,oil,B")
    assert found.refused == ()
    assert [entry.pair for entry in found.entries] == ["A", "A", "B"]


LOGGER = "time [s],Dev1/ai0 [V],Dev1/ai1 [mV]\n0,1,13\n0.1,2,23\n0.2,3,33\n"


def test_a_channel_behind_an_amplifier(folder):
    (folder / "run.csv").write_text(LOGGER)
    found = manifest(
        folder,
        "file,channel,unit,gain,offset [mV],force [N],force_tolerance [kN],speed [1/min],"
        "speed_tolerance [rpm],temperature [degC],temperature_tolerance [degC],pair",
        "run.csv,Dev1/ai1,,10,3,800,0.02,100,1.5,40,1,7",
        "run.csv,,mV,,,800,,6,,40,,",
    )
    assert found.refused == ()
    amplified, plain = found.entries
    assert (amplified.channel, amplified.unit, amplified.pair) == ("Dev1/ai1", None, "7")
    assert (amplified.gain, amplified.offset) == (10.0, "3 mV")
    assert (amplified.force, amplified.speed, amplified.temperature) == (800.0, 100.0, 40.0)
    tolerances = [amplified.force_tolerance, amplified.speed_tolerance]
    assert tolerances == pytest.approx([20.0, 1.5])
    assert amplified.temperature_tolerance == pytest.approx(1.0)
    assert (plain.channel, plain.unit, plain.gain, plain.offset) == (None, "mV", 1.0, 0.0)
    assert plain.force_tolerance is plain.speed_tolerance is plain.temperature_tolerance is None
    assert plain.pair is None
    for entry, volts in ((amplified, [1e-3, 2e-3, 3e-3]), (plain, [1e-3, 2e-3, 3e-3])):
        told = (entry.channel, entry.unit, entry.gain, entry.offset)
        recording = open_recording(entry.file, entry.sampling_interval, *told)
        np.testing.assert_allclose(np.concatenate(list(recording.pieces())), volts)


def test_a_channel_behind_an_amplifier_in_yaml(folder):
    found = manifest(
        folder,
        "- {file: a.csv, channel: '1,5', unit: kOhm, gain: -1/10, offset: '1,5 Ohm', pair: '1,5',",
        "   force: 800 N, speed: 100 U/min, temperature: 40 degC, temperature_tolerance: 0.5 K}",
        name="manifest.yaml",
    )
    (entry,) = found.entries
    assert (entry.channel, entry.unit, entry.pair) == ("1,5", "kOhm", "1,5")
    assert (entry.gain, entry.offset, entry.temperature_tolerance) == (-0.1, "1.5 Ohm", 0.5)
    assert entry.speed == pytest.approx(100.0)


@pytest.mark.parametrize("units", ["K", "degC", "delta_degC", "°C"])
def test_a_tolerance_of_a_degree_is_a_kelvin(folder, units):
    header = f"probability,force [N],speed [rpm],temperature [K],temperature_tolerance [{units}]"
    found = manifest(folder, header, "0.5,800,100,313.15,1")
    (entry,) = found.entries
    assert entry.temperature_tolerance == pytest.approx(1.0)
    assert entry.temperature == pytest.approx(40.0)


NEEDS_OFFSET = "need a voltage or a resistance with its unit, such as '3 mV'"


@pytest.mark.parametrize(
    ("told", "refused"),
    [
        ({"gain": 0}, "gain: got 0, need a value other than 0"),
        ({"gain": "0/3"}, "gain: got 0, need a value other than 0"),
        ({"gain": math.inf}, "gain: got inf, need a finite number"),
        ({"gain": "10 V"}, "gain: got '10 V', need a number"),
        ({"offset": 3}, f"offset: got 3, {NEEDS_OFFSET}"),
        ({"offset": "3"}, f"offset: got '3', {NEEDS_OFFSET}"),
        ({"offset": "3 mm"}, "offset: got the unit 'mm', need one of voltage or resistance"),
        ({"unit": "wumpus"}, "unit: got the unit 'wumpus', need one of voltage or resistance"),
        ({"unit": "N"}, "unit: got the unit 'N', need one of voltage or resistance"),
        ({"unit": 7}, "unit: got the unit 7, need one of voltage or resistance"),
        ({"channel": 2}, "channel: got 2, need text"),
        ({"channel": ""}, "channel: got '', need some text"),
        ({"pair": 7}, "pair: got 7, need text"),
        ({"pair": ["A", "B"]}, "pair: got ['A', 'B'], need text"),
        ({"force_tolerance": "0 N"}, "force_tolerance: got 0, need a value above 0 N"),
        ({"speed_tolerance": "-1 rpm"}, "speed_tolerance: got -1, need a value above 0 rpm"),
        ({"speed_tolerance": "1 %"}, "speed_tolerance: "),
        ({"temperature_tolerance": "0 K"}, "temperature_tolerance: got 0, need a value above 0 K"),
        ({"temperature_tolerance": "-1 degC"}, "temperature_tolerance: got -1, need a value above"),
        ({"temperature_tolerance": 1}, "temperature_tolerance: got 1, need a number with its unit"),
    ],
)
def test_what_is_told_of_a_record_and_cannot_be_is_refused(folder, told, refused):
    row = {"file": "a.csv", "force": "8 N", "speed": "1 rpm", "temperature": "40 degC"} | told
    found = manifest(folder, yaml.safe_dump([row]), name="manifest.yaml")
    (line,) = found.refused
    assert line.startswith(f"manifest.yaml: entry 1: {refused}")
    assert "\n" not in line


@pytest.mark.parametrize("told", [{"channel": "U"}, {"unit": "V"}, {"gain": 1}, {"offset": "0 V"}])
def test_a_share_has_no_channel_and_no_amplifier(folder, told):
    row = {"probability": 0.5, "force": "8 N", "speed": "1 rpm", "temperature": "40 degC"} | told
    (line,) = manifest(folder, yaml.safe_dump([row]), name="manifest.yaml").refused
    assert line == f"manifest.yaml: entry 1: {next(iter(told))}: not allowed with probability"


@pytest.mark.parametrize(
    ("lines", "told"),
    [
        ([], "empty, need a line of column names"),
        (["# only"], "empty, need a line of column names"),
        (["probability,force,speed [rpm],temperature [degC]"], "force: got the unit None, need"),
        (["probability,force [m],speed [rpm],temperature [degC]"], "force: wrong dimension"),
        (["probability,force [mew],speed [rpm],temperature [degC]"], "force: unknown unit 'mew'"),
        (["probability [%],force [N],speed [rpm],temperature [degC]"], "without a unit"),
        (["probability,force [N],speed [rpm]"], "no column 'temperature [degC]'"),
        (["file,force [N],speed [rpm],temperature [K],offset"], "need 'offset [mV]'"),
        (["file,force [N],speed [rpm],temperature [K],offset [N]"], "offset: got the unit 'N'"),
        (["file,force [N],speed [rpm],temperature [K],gain [V]"], "need 'gain' without a unit"),
        (["file,force [N],speed [1/mm],temperature [K]"], "speed: wrong dimension or unit '1/mm'"),
        (["share,force [N],speed [rpm],temperature [degC]"], "got the column 'share', need"),
        (["force [N],force [N],speed [rpm]"], "got the column 'force [N]', need each once"),
    ],
)
def test_a_table_without_a_usable_head_is_refused(folder, lines, told):
    with pytest.raises(DataError) as caught:
        manifest(folder, *lines)
    assert told in str(caught.value)
    assert str(caught.value).startswith(f"{folder / 'manifest.csv'}: ")


@pytest.mark.parametrize(
    ("name", "text", "told"),
    [
        ("m.yaml", "a: 1", "need a list of mappings, got dict"),
        ("m.yaml", "- {a: 1, a: 2}", "key 'a' is repeated"),
        ("m.yaml", "- {a: 1", "not valid YAML"),
        ("m.xls", "", "got the suffix '.xls', need .csv, .yaml or .yml"),
    ],
)
def test_a_file_that_is_no_manifest_is_refused(folder, name, text, told):
    with pytest.raises(DataError, match="m") as caught:
        manifest(folder, text, name=name)
    assert told in str(caught.value)


@pytest.mark.parametrize("name", ["none.csv", "none.yaml"])
def test_a_missing_manifest_is_told(folder, name):
    with pytest.raises(DataError, match="cannot be read: No such file"):
        read_manifest(folder / name)


def test_a_manifest_in_another_encoding_is_told(folder):
    (folder / "m.csv").write_bytes("probability,Öl".encode("latin-1"))
    with pytest.raises(DataError, match="it is not UTF-8 text"):
        read_manifest(folder / "m.csv")
