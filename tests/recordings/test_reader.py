"""The same samples from every kind of file, in the usual ways of writing it."""

import netCDF4
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from nptdms import ChannelObject, TdmsWriter
from written_recordings import (
    COUNTS,
    INTERVAL,
    SAMPLES,
    SCALE,
    STEP,
    TIMES,
    VOLTS,
    read,
    refusal,
    write_csv,
    write_logger,
    write_netcdf,
    write_tdms,
)

from lube.recordings import csv_signals
from lube.recordings.reader import open_recording

# The same recording


@pytest.mark.parametrize("kind", ["csv", "netcdf", "netcdf scaled", "tdms", "tdms scaled"])
def test_all_kinds_of_files_give_the_same_recording(tmp_path, kind):
    timed = {"wf_increment": INTERVAL, "unit_string": "V"}
    match kind:
        case "csv":
            path = write_csv(tmp_path / "r.csv", [TIMES, VOLTS], "time [s],voltage [V]")
        case "netcdf":
            path = write_netcdf(tmp_path / "r.nc", VOLTS)
        case "netcdf scaled":
            path = write_netcdf(tmp_path / "r.nc", COUNTS, scale_factor=STEP)
        case "tdms":
            path = write_tdms(tmp_path / "r.tdms", VOLTS, **timed)
        case "tdms scaled":
            path = write_tdms(tmp_path / "r.tdms", COUNTS, **timed, **SCALE)
    recording = open_recording(path)
    assert (recording.path, recording.quantity) == (path, "voltage")
    assert recording.sampling_interval == pytest.approx(INTERVAL)
    for _ in range(2):  # it may be read again
        pieces = list(recording.pieces())
        assert all(piece.dtype == np.float64 and piece.ndim == 1 for piece in pieces)
        np.testing.assert_allclose(np.concatenate(pieces), VOLTS, rtol=1e-12, atol=1e-15)


@pytest.mark.parametrize(
    "format", ["NETCDF3_CLASSIC", "NETCDF3_64BIT_OFFSET", "NETCDF4_CLASSIC", "NETCDF4"]
)
def test_every_netcdf_format_of_a_logger_is_read(tmp_path, format):
    for growing in (False, True):
        path = write_netcdf(tmp_path / f"{growing}.nc", VOLTS, format=format, growing=growing)
        with netCDF4.Dataset(path, "a") as file:
            file.createDimension("bit", 5)
            file.createVariable("note", "S1", ("bit",))[:] = np.array(list("notes"), "S1")
            file.createVariable("flag", "i1", ("time",))[:] = np.ones(SAMPLES)
        np.testing.assert_array_equal(read(path), VOLTS)


HEADERS = [
    ("time [s],voltage [V]", 1.0, 1.0, "voltage"),
    ("Time (ms),Voltage [mV]", 1e3, 1e3, "voltage"),
    ("t/s,U (V)", 1.0, 1.0, "voltage"),
    ("TIME / us,Spannung/mV", 1e6, 1e3, "voltage"),
    ("Zeit [s],Kontaktspannung [µV]", 1.0, 1e6, "voltage"),
    ("Time [seconds],contact_voltage [Volts]", 1.0, 1.0, "voltage"),
    ("time [s],resistance (kOhm)", 1.0, 1e-3, "resistance"),
    ("Zeit [s],Widerstand [Ohm]", 1.0, 1.0, "resistance"),
    ("Time [s],R [Ω]", 1.0, 1.0, "resistance"),
    ("Time [s],R_c [k\u2126]", 1.0, 1e-3, "resistance"),
    ("Time [s],Channel 1 [mV]", 1.0, 1e3, "voltage"),
]


@pytest.mark.parametrize(("delimiter", "decimal"), [(",", "."), (";", ","), ("\t", ",")])
def test_columns_may_have_many_names(tmp_path, delimiter, decimal):
    for header, time_factor, factor, quantity in HEADERS:
        columns = [TIMES[:99] * time_factor, VOLTS[:99] * factor]
        header = header.replace(",", delimiter)
        path = write_csv(tmp_path / "r.csv", columns, header, delimiter, decimal)
        recording = open_recording(path)
        assert recording.quantity == quantity
        assert recording.sampling_interval == pytest.approx(INTERVAL)
        np.testing.assert_allclose(read(path), VOLTS[:99], rtol=1e-8)


def test_byte_mark_comments_and_carriage_returns_are_skipped(tmp_path):
    before = "\ufeff# rig 2\r\n\r\n# 3 V, 1 kOhm\r\n"
    header = "sample;t [s];temperature T [degC];U [V]"
    columns = [np.arange(SAMPLES), TIMES, np.full(SAMPLES, 40.0), VOLTS]
    path = write_csv(tmp_path / "r.csv", columns, header, ";", ",", "\r\n", before)
    np.testing.assert_allclose(read(path), VOLTS, rtol=1e-8)
    path.write_bytes(path.read_bytes() + b"\r\n\r\n")
    np.testing.assert_allclose(read(path), VOLTS, rtol=1e-8)


BEFORE = """Gerät;Prüfstand 3
Datum;03.02.2026
Abtastrate [Hz];20000
U max [V];3

"""


@pytest.mark.parametrize("encoding", ["utf-8", "cp1252", "latin-1"])
def test_lines_before_the_column_names_and_their_encoding_are_found(tmp_path, encoding):
    header = "Zeit [s];Temperatur [°C];Übergangsspannung [µV]"
    columns = [TIMES[:99], np.full(99, 40.0), VOLTS[:99] * 1e6]
    path = write_csv(tmp_path / "r.csv", columns, header, ";", ",", "\r\n", BEFORE)
    path.write_bytes(path.read_text("utf-8").encode(encoding))
    recording = open_recording(path)
    assert recording.sampling_interval == pytest.approx(INTERVAL)
    np.testing.assert_allclose(read(path), VOLTS[:99], rtol=1e-8)
    (tmp_path / "r.csv").write_bytes(path.read_bytes() + "x;1;é".encode(encoding))
    assert refusal(path).startswith("line 106: got 'x;1;")


def test_column_names_after_what_looks_like_some_are_found_by_the_number_of_lines(tmp_path):
    before = "t [s];U [V]\n0;7\n"
    path = write_csv(tmp_path / "r.csv", [TIMES, VOLTS], "t [s];U [V]", ";", before=before)
    assert "need" in refusal(path)
    np.testing.assert_allclose(read(path, skip=2), VOLTS, rtol=1e-8)


@pytest.mark.parametrize("rate", [32_768.0, 44_100.0, 51_200.0])
def test_the_sampling_interval_is_exact_where_times_are_rounded(tmp_path, rate):
    times = np.round(np.arange(3_000) / rate, 6)
    path = write_csv(tmp_path / "r.csv", [times, np.zeros(times.size)], "time [s],voltage [V]")
    for given_interval in (None, 1.0 / rate):
        recording = open_recording(path, given_interval)
        assert recording.sampling_interval == pytest.approx(1.0 / rate, rel=1e-4)
        assert sum(piece.size for piece in recording.pieces()) == times.size


def test_a_single_column_needs_the_sampling_interval(tmp_path):
    path = write_csv(tmp_path / "r.csv", [VOLTS], "voltage [V]", decimal=",")
    assert open_recording(path, INTERVAL).sampling_interval == INTERVAL
    np.testing.assert_allclose(read(path, INTERVAL), VOLTS, rtol=1e-8)
    assert refusal(path) == "no time, need a time column or a sampling interval"


def test_small_tables(tmp_path):
    ai1 = "t [s],Dev1/ai0 [V],Dev1/ai1 [V]\n0,5,1\n1,5,2\n"
    for text, options, values in (
        ('"t [s]","U [V]"\n"0","1.5"\n"1","2.5"\n', {}, [1.5, 2.5]),
        # Of several voltages the first is read; a name precedes a unit.
        ("t [s],bias [V],U1 [V],R [ohm]\n0,5,1,3\n1,5,2,4\n", {}, [1.0, 2.0]),
        # An open circuit is an infinite resistance, behind an amplifier too.
        ("t [s],R [kOhm]\n0,inf\n1,2\n2,Inf\n", {}, [np.inf, 2000.0, np.inf]),
        ("t [s],R [kOhm]\n0,inf\n1,2\n", {"gain": 2, "offset": "1 kOhm"}, [np.inf, 500.0]),
        # A selected channel is not the time, and may be named by its whole header.
        ("t_contact [V],t [s]\n5,0\n6,1\n", {"channel": "t_contact"}, [5.0, 6.0]),
        (ai1, {"channel": "Dev1/ai1"}, [1.0, 2.0]),
        (ai1, {"channel": "Dev1/ai1 [V]"}, [1.0, 2.0]),
        (ai1.replace(" [V]", ""), {"channel": "Dev1/ai1", "unit": "V"}, [1.0, 2.0]),
    ):
        (tmp_path / "r.csv").write_text(text)
        np.testing.assert_array_equal(read(tmp_path / "r.csv", **options), values)


@given(st.integers(20, 400), st.sampled_from(["\n", "\r\n", "\n\n"]), st.booleans())
@settings(max_examples=30)
def test_a_csv_recording_does_not_depend_on_where_its_pieces_end(tmp_path_factory, size, end, last):
    path = tmp_path_factory.mktemp("pieces") / "r.csv"
    write_csv(path, [TIMES[:50], np.arange(50.0)], "t [s],U [V]", end=end)
    if not last:
        path.write_bytes(path.read_bytes().rstrip())
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(csv_signals, "PIECE_BYTES", size)
        np.testing.assert_array_equal(read(path), np.arange(50.0))


def test_netcdf_may_state_the_interval_instead_of_times(tmp_path):
    stated = {"sampling_interval": "20 us"}
    of_variable = write_netcdf(tmp_path / "variable.nc", VOLTS, times=None, **stated)
    of_file = write_netcdf(tmp_path / "file.nc", VOLTS, times=None)
    with netCDF4.Dataset(of_file, "a") as file:
        file.setncatts(stated)
    for path in (of_variable, of_file):
        assert open_recording(path).sampling_interval == pytest.approx(2e-5)
        np.testing.assert_array_equal(read(path), VOLTS)


def test_netcdf_times_since_a_date_are_times(tmp_path):
    path = write_netcdf(tmp_path / "r.nc", VOLTS, time_units="seconds since 2024-05-01")
    assert open_recording(path).sampling_interval == pytest.approx(INTERVAL)


def test_tdms_with_a_time_channel_in_its_own_unit(tmp_path):
    time = ChannelObject("rig", "Zeit", TIMES * 1e3, properties={"unit_string": "ms"})
    note = ChannelObject("rig", "voltage note", ["a", "b"])
    channel = ChannelObject("rig", "ai0", VOLTS * 1e3, properties={"NI_UnitDescription": "mV"})
    with TdmsWriter(tmp_path / "r.tdms") as file:
        file.write_segment([note, time, channel])
    assert open_recording(tmp_path / "r.tdms").sampling_interval == pytest.approx(INTERVAL)
    np.testing.assert_allclose(read(tmp_path / "r.tdms"), VOLTS, rtol=1e-12)


def test_slices_of_binary_files_join_without_a_seam(tmp_path, monkeypatch):
    monkeypatch.setattr("lube.recordings.binary_signals.SLICE", 999)
    netcdf = write_netcdf(tmp_path / "r.nc", COUNTS, scale_factor=STEP)
    tdms = write_tdms(tmp_path / "r.tdms", VOLTS, wf_increment=INTERVAL, unit_string="V")
    for path in (netcdf, tdms):
        pieces = list(open_recording(path).pieces())
        assert {part.size for part in pieces[:-1]} == {999}
        np.testing.assert_allclose(np.concatenate(pieces), VOLTS, atol=1e-12)


# Channels, units and amplifiers

SELECTIONS = [
    ({}, -1.0),
    ({"channel": "CH1"}, -1.0),
    ({"channel": "CH2"}, 1.0),
    ({"channel": "CH2", "unit": "V"}, 1e3),
    ({"channel": "CH3", "unit": "kV"}, 1e3),
    ({"channel": "CH3", "unit": "MOhm"}, 1e6),
    ({"unit": "mV"}, -1e-3),
]


@pytest.mark.parametrize("kind", ["csv", "nc", "tdms"])
def test_a_channel_is_read_in_the_unit_that_is_given(tmp_path, kind):
    path = write_logger(tmp_path, kind)
    for options, factor in SELECTIONS:
        recording = open_recording(path, **options)
        quantity = "resistance" if options.get("unit") == "MOhm" else "voltage"
        assert recording.quantity == quantity
        assert recording.sampling_interval == pytest.approx(INTERVAL)
        np.testing.assert_allclose(read(path, **options), factor * VOLTS, rtol=1e-8, atol=1e-12)


def test_an_amplifier_is_undone(tmp_path):
    """What is recorded is the true value times the gain, plus the offset."""
    for gain, offset, volts in ((10.0, "3 mV", 3e-3), (-4.0, 0.25, 0.25), (0.5, "-1 V", -1.0)):
        path = write_netcdf(tmp_path / "r.nc", 1e3 * (VOLTS * gain + volts), "mV")
        found = read(path, gain=gain, offset=offset)
        np.testing.assert_allclose(found, VOLTS, rtol=1e-7, atol=1e-7)
    path = write_netcdf(tmp_path / "r.nc", VOLTS)
    np.testing.assert_array_equal(read(path, gain=1, offset="0 V"), VOLTS)


S, V = {"unit_string": "s"}, {"unit_string": "V"}


def write_groups(path, groups):
    """TDMS file of groups, each a dict of values and properties."""
    with TdmsWriter(path) as file:
        for group, channels in groups.items():
            for name, (values, properties) in channels.items():
                file.write_segment([ChannelObject(group, name, values, properties=properties)])
    return path


def test_a_channel_of_a_group_has_the_times_of_its_group(tmp_path):
    slow, fast = np.arange(5.0), np.arange(5.0) / 10.0
    first = {"Time": (slow, S), "U": (slow, V)}
    second = {"U": (fast, V), "Time": (fast, S), "Dev1/ai0": (-fast, V)}
    path = write_groups(tmp_path / "r.tdms", {"A": first, "B": second})
    for selected, sign in (("B/U", 1.0), ("Dev1/ai0", -1.0), ("B/Dev1/ai0", -1.0)):
        assert open_recording(path, channel=selected).sampling_interval == pytest.approx(0.1)
        np.testing.assert_array_equal(read(path, channel=selected), sign * fast)
    assert open_recording(path, channel="A/U").sampling_interval == pytest.approx(1.0)


def test_the_increment_of_a_channel_precedes_the_times_of_another_group(tmp_path):
    values = np.arange(5.0)
    for increment, expected in (({"wf_increment": 1e-5}, 1e-5), ({}, 1.0)):
        groups = {"A": {"Time": (values, S)}, "B": {"U": (values, V | increment)}}
        path = write_groups(tmp_path / "r.tdms", groups)
        assert open_recording(path).sampling_interval == pytest.approx(expected)


def test_a_netcdf_variable_has_the_times_of_its_dimension(tmp_path):
    with netCDF4.Dataset(tmp_path / "r.nc", "w") as file:
        for name, step in (("slow", 1.0), ("fast", 0.1), ("long", 0.01)):
            size = 7 if name == "long" else 5
            file.createDimension(name, size)
            for kind, units in (("time", "s"), ("U", "V")):
                variable = file.createVariable(f"{kind}_{name}", "f8", (name,))
                variable[:] = step * np.arange(size)
                variable.units = units
    for name, step in (("slow", 1.0), ("fast", 0.1), ("long", 0.01)):
        recording = open_recording(tmp_path / "r.nc", channel=f"U_{name}")
        assert recording.sampling_interval == pytest.approx(step)
