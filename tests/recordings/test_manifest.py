"""Manifests: good rows are read; bad rows are refused one by one and hide no other."""

import numpy as np
import pytest
import yaml
from refusals import one_line

from lube.errors import DataError
from lube.recordings.manifest import Row, read_manifest
from lube.recordings.reader import open_recording

HEADER = "file,probability,lower,upper,force [kN],speed [rpm],temperature [degC],origin"
GOOD = "- {probability: 0.5, force: 800 N, speed: 1 rpm, temperature: 40 degC}"


@pytest.fixture
def folder(tmp_path):
    (tmp_path / "a.csv").write_text("t [s],U [V]\n0,1\n1,2\n")
    return tmp_path


def manifest(folder, *lines, name="manifest.csv"):
    (folder / name).write_text("\n".join([*lines, ""]), encoding="utf-8")
    return read_manifest(folder / name)


def test_a_table_of_recordings_and_shares(folder):
    found = manifest(
        folder,
        "# test rig 2",
        "file,probability,lower,upper,force [kN],speed [turn/s],temperature [K],lubricant,"
        "slide_to_roll_ratio,sampling_interval [us]",
        "a.csv,,,,0.8,2,313.15,oil,0.1,10",
        "",
        ",0.25,0.2,0.3,0.8,2,323.15,,,",
    )
    assert (found.origin, found.refused) == ("measured", ())
    recording, share = found.entries
    assert (recording.where, share.where) == ("manifest.csv: line 3", "manifest.csv: line 5")
    assert recording.file == folder / "a.csv"
    point = (recording.force, recording.speed, recording.temperature)
    assert point == pytest.approx((800.0, 120.0, 40.0))
    assert (recording.lubricant, recording.slide_to_roll_ratio) == ("oil", 0.1)
    assert recording.sampling_interval == pytest.approx(1e-5)
    assert (recording.probability, recording.lower, recording.upper) == (None, None, None)
    assert (share.probability, share.lower, share.upper) == (0.25, 0.2, 0.3)
    unset = ("file", "lubricant", "slide_to_roll_ratio", "sampling_interval", "pair")
    assert {getattr(share, name) for name in unset} == {None}


@pytest.mark.parametrize("delimiter", [";", "\t"])
def test_decimal_commas_in_a_table(folder, delimiter):
    row = delimiter.join(["", "0,25", "0,2", "0,3", "0,8", "100", "40,5", "simulated"])
    found = manifest(folder, HEADER.replace(",", delimiter), row)
    (entry,) = found.entries
    assert (entry.probability, entry.lower, entry.upper) == (0.25, 0.2, 0.3)
    assert (entry.force, entry.temperature, found.origin) == (800.0, 40.5, "simulated")


def test_a_yaml_list(folder):
    found = manifest(
        folder,
        "- {file: a.csv, force: 800 N, speed: 100 U/min, temperature: 40 degC, gain: -1/10,",
        "   offset: '1,5 Ohm', channel: '1,5', unit: kOhm, pair: '1,5', lubricant: oil,",
        "   sampling_interval: 10 us, slide_to_roll_ratio: 0.1, temperature_tolerance: 0.5 K}",
        '- {probability: "0,25", upper: 1/3, force: "0,8 kN", speed: 100 rpm,',
        "   temperature: 313.15 K, lubricant: another}",
        name="manifest.yaml",
    )
    assert found.refused == ()
    recording, share = found.entries
    assert (recording.where, recording.file) == ("manifest.yaml: entry 1", folder / "a.csv")
    assert (recording.channel, recording.unit, recording.pair) == ("1,5", "kOhm", "1,5")
    assert (recording.gain, recording.offset) == (-0.1, "1.5 Ohm")
    assert recording.sampling_interval == pytest.approx(1e-5)
    assert recording.temperature_tolerance == 0.5
    assert (share.probability, share.upper, share.lower) == (0.25, 1 / 3, None)
    assert (share.force, share.temperature) == pytest.approx((800.0, 40.0))


def test_files_are_found_from_the_folder_of_the_manifest(folder):
    (folder / "below").mkdir()
    (folder / "1,5 kN.csv").write_text("t [s]")
    names = ["../a.csv", folder / "a.csv", '"../1,5 kN.csv"', "../b.csv"]
    found = manifest(folder / "below", HEADER, *(f"{name},,,,1.5,100,40," for name in names))
    files = [entry.file.resolve().name for entry in found.entries]
    assert files == ["a.csv", "a.csv", "1,5 kN.csv"]
    assert found.refused == ("manifest.csv: line 5: file: got '../b.csv', no such file",)


def test_several_rows_may_have_one_operating_point(folder):
    header = "probability,force [N],speed [rpm],temperature [degC],lubricant,pair"
    found = manifest(folder, header, *["0.5,800,100,40,oil,A"] * 2, "0.5,800,100,40,oil,B")
    assert found.refused == ()
    assert [entry.pair for entry in found.entries] == ["A", "A", "B"]


def test_a_row_that_repeats_another_is_refused(folder):
    header = "file,channel,force [N],speed [rpm],temperature [degC]"
    rows = ["a.csv,,800,100,40", "a.csv,,800,100,50", "a.csv,U,800,100,40", "a.csv,,800,100,40"]
    found = manifest(folder, header, *rows)
    assert len(found.entries) == 3
    repeated = "manifest.csv: line 5: repeats manifest.csv: line 2, need each record once"
    assert found.refused == (repeated,)


def test_the_first_usable_row_decides_the_origin(folder):
    rows = [",7,,,0.8,100,40,simulated", ",0.5,,,0.8,100,50,measured", ",0.5,,,0.8,100,60,"]
    found = manifest(folder, HEADER, *rows)
    assert (found.origin, len(found.entries)) == ("measured", 2)


def test_a_channel_behind_an_amplifier(folder):
    text = "time [s],Dev1/ai0 [V],Dev1/ai1 [mV]\n0,1,13\n0.1,2,23\n0.2,3,33\n"
    (folder / "run.csv").write_text(text)
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
    tolerances = [amplified.force_tolerance, amplified.speed_tolerance]
    assert [*tolerances, amplified.temperature_tolerance] == pytest.approx([20.0, 1.5, 1.0])
    assert (plain.channel, plain.unit, plain.gain, plain.offset) == (None, "mV", 1.0, 0.0)
    for entry in found.entries:
        options = (entry.sampling_interval, entry.channel, entry.unit, entry.gain, entry.offset)
        pieces = open_recording(entry.file, *options).pieces()
        np.testing.assert_allclose(np.concatenate(list(pieces)), [1e-3, 2e-3, 3e-3])


def test_a_tolerance_of_a_degree_is_a_kelvin(folder):
    for units in ("K", "degC", "delta_degC", "°C"):
        header = (
            f"probability,force [N],speed [rpm],temperature [K],temperature_tolerance [{units}]"
        )
        (entry,) = manifest(folder, header, "0.5,800,100,313.15,1").entries
        assert entry.temperature_tolerance == pytest.approx(1.0)
        assert entry.temperature == pytest.approx(40.0)


def test_the_schema_describes_every_column():
    columns = Row.model_json_schema()["properties"]
    assert all(column["description"] for column in columns.values())
    assert "where" not in columns


# Rows that cannot be used

ROWS = {
    ".,,,,0.8,100,50,": "file: got '.', no such file",
    ",1.25,,,0.8,100,50,": "probability: got 1.25, need a value at least 0 and at most 1",
    ",0.5,0.6,0.7,0.8,100,50,": "probability: got [0.6, 0.5, 0.7], need lower <= probability",
    ",0.5,0.4,1.7,0.8,100,50,": "upper: got 1.7, need a value at least 0 and at most 1",
    ",,,,0.8,100,50,": "need either file or probability",
    "a.csv,0.5,,,0.8,100,50,": "need either file or probability",
    "a.csv,,0.4,,0.8,100,50,": "lower: not allowed with file",
    ",0.5,,,,100,50,": "force: missing",
    ",0.5,,,abc,100,50,": "force: got 'abc kN', need a number with its unit",
    ",0.5,,,0.8,100,50": "got 7 values, need 8",
    ",0.5,,,0.8,100,50,guessed": "origin: got 'guessed', need 'measured' or 'simulated'",
    ",0.5,,,0.8,100,50,simulated": "origin: got 'simulated' after 'measured'",
}


def test_a_row_that_cannot_be_used_is_refused_and_hides_no_other(folder):
    for row, reason in ROWS.items():
        found = manifest(folder, HEADER, "a.csv,,,,0.8,100,40,", row, ",0.9,,,0.8,100,60,measured")
        assert [entry.temperature for entry in found.entries] == [40.0, 60.0], row
        (line,) = found.refused
        assert line.startswith(f"manifest.csv: line 3: {reason}")
        assert "\n" not in line


OPERATING_POINT = {"force": "8 N", "speed": "1 rpm", "temperature": "40 degC"}
RECORDING, SHARE = (OPERATING_POINT | value for value in ({"file": "a.csv"}, {"probability": 0.5}))
NEEDS_OFFSET = "need a voltage or a resistance with its unit, such as '3 mV'"
ENTRIES = [
    ("hello", "got str, need a mapping of keys to values"),
    ({"force": "800 N"}, "speed: missing"),
    (SHARE | {"forse": "8 N"}, "forse: unknown key, did you mean 'force'?"),
    (OPERATING_POINT | {"file": 7}, "file: got 7, need text"),
    (RECORDING | {"gain": "0/3"}, "gain: got 0/3, need a value other than 0"),
    (RECORDING | {"offset": "3"}, f"offset: got '3', {NEEDS_OFFSET}"),
    (RECORDING | {"unit": "N"}, "unit: got the unit 'N', need one of voltage or resistance"),
    (RECORDING | {"channel": ""}, "channel: got '', need some text"),
    (RECORDING | {"force_tolerance": "0 N"}, "force_tolerance: got 0 N, need a value above 0 N"),
    (SHARE | {"channel": "U"}, "channel: not allowed with probability"),
]


def test_an_entry_that_cannot_be_used_is_refused(folder):
    for entry, reason in ENTRIES:
        found = manifest(folder, GOOD, yaml.safe_dump([entry]), name="manifest.yml")
        assert len(found.entries) == 1
        (line,) = found.refused
        assert line.startswith(f"manifest.yml: entry 2: {reason}")
        assert "\n" not in line


# Files that cannot be used

HEADERS = {
    "": "empty, need a line of column names",
    "probability,force,speed [rpm],temperature [degC]": "force: got no unit, need 'force",
    "probability,force [m],speed [rpm],temperature [degC]": "force: wrong dimension",
    "probability [%],force [N],speed [rpm],temperature [degC]": "without a unit",
    "probability,force [N],speed [rpm]": "missing column 'temperature [degC]'",
    "file,force [N],speed [rpm],temperature [K],offset": "need 'offset [mV]'",
    "file,force [N],speed [rpm],temperature [K],offset [N]": "offset: got the unit 'N'",
    "file,forse [N],speed [rpm]": "unknown column 'forse [N]', did you mean 'force'?",
    "file,humidity,speed [rpm]": "unknown column 'humidity', need one of file, channel, unit",
    "force [N],force [N],speed [rpm]": "column 'force' is repeated",
}
FILES = [
    ("m.yaml", b"a: 1", "need a list of mappings, got dict"),
    ("m.yaml", b"- {a: 1, a: 2}", "duplicate key"),
    ("m.yaml", b"- {a: 1", "not valid YAML"),
    ("m.csv", "probability,Öl".encode("latin-1"), "it is not UTF-8 text"),
    ("m.xls", b"", "empty, need a line of column names"),
]


def test_a_file_that_is_not_a_manifest_is_refused(folder):
    for header, reason in HEADERS.items():
        message = one_line(DataError, manifest, folder, header)
        assert message.startswith(f"{folder / 'manifest.csv'}: ") and reason in message
    for name, content, reason in FILES:
        (folder / name).write_bytes(content)
        assert reason in one_line(DataError, read_manifest, folder / name)
    for name in ("none.csv", "none.yaml"):
        message = one_line(DataError, read_manifest, folder / name)
        assert "cannot be read: No such file" in message
