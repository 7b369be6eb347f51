"""Records that cannot be trusted: each told in one line, with the place of its fault."""

import struct

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

from lube.errors import DataError
from lube.recordings import csv_signals
from lube.recordings.classic_netcdf import needed_length
from lube.recordings.reader import open_recording


def test_a_missing_or_unknown_kind_of_file(tmp_path):
    assert refusal(tmp_path / "none.csv") == "no such file, need a record of the rig"
    (tmp_path / "r.xls").write_text("t")
    assert refusal(tmp_path / "r.xls").startswith("got the suffix '.xls', need one of .csv")


@pytest.mark.parametrize("suffix", [".csv", ".nc", ".tdms"])
def test_an_empty_file(tmp_path, suffix):
    (tmp_path / f"r{suffix}").write_bytes(b"")
    assert refusal(tmp_path / f"r{suffix}") == "empty record, the file has no bytes"


def test_a_record_without_samples(tmp_path):
    for text in ("t [s],U [V]\n", "t [s],U [V]\n\n\n"):
        (tmp_path / "r.csv").write_text(text)
        assert refusal(tmp_path / "r.csv") == "empty record, need samples"
    (tmp_path / "c.csv").write_text("# only\n\n# comments")
    assert refusal(tmp_path / "c.csv").startswith("empty record, need a line of column names")
    netcdf = write_netcdf(tmp_path / "r.nc", np.array([]), times=np.array([]))
    assert refusal(netcdf) == "empty record, need samples"
    tdms = write_tdms(tmp_path / "r.tdms", np.array([]), segments=1, unit_string="V")
    assert "empty record" in refusal(tdms) or "need a voltage" in refusal(tdms)


@pytest.mark.parametrize(
    ("name", "content", "found"),
    [
        ("r.tdms", b"time [s],voltage [V]\n0,1\n", "text"),
        ("r.nc", b"time [s],voltage [V]\n0,1\n", "text"),
        ("r.csv", b"TDSm\x0e\0\0\0", "TDMS"),
        ("r.csv", b"\x89HDF\r\n\x1a\n", "NetCDF"),
        ("r.tdms", b"\x89HDF\r\n\x1a\n", "NetCDF"),
        ("r.csv", "t [s]".encode("utf-16"), "unknown binary data"),
    ],
)
def test_a_file_that_is_not_what_its_name_says(tmp_path, name, content, found):
    (tmp_path / name).write_bytes(content)
    assert f"but begins as {found}" in refusal(tmp_path / name)


@pytest.mark.parametrize(
    ("header", "told"),
    [
        ("time [s],voltage", "line 1: 'voltage' has no unit, need one such as 'voltage [V]'"),
        ("time,voltage [V]", "line 1: 'time' has no unit, need one such as 'time [s]'"),
        ("time [s],voltage [parsec]", "'voltage': wrong dimension or unit 'parsec'"),
        ("time [s],voltage [wumpus]", "'voltage': unknown unit 'wumpus'"),
        ("time [s],resistance [mV]", "'resistance': wrong dimension or unit 'mV'"),
        ("time [rpm],U [V]", "'time': wrong dimension or unit 'rpm'"),
        ("time [s],force [N]", "line 1: got 'time', 'force', need a voltage or a resistance"),
        ("0.1,0.2", "line 1: got '0.1', '0.2', need a voltage or a resistance"),
    ],
)
def test_units_and_quantities_are_never_guessed(tmp_path, header, told):
    path = write_csv(tmp_path / "r.csv", [TIMES, TIMES], header)
    assert told in refusal(path)


def test_units_of_binary_records_are_not_guessed_either(tmp_path):
    missing = "'voltage' has no unit, need one such as 'voltage [V]'"
    missing += ", or 'unit' given beside the file"
    assert refusal(write_netcdf(tmp_path / "r.nc", VOLTS, units=None)) == missing
    assert "unknown unit 'wumpus'" in refusal(write_netcdf(tmp_path / "r.nc", VOLTS, "wumpus"))
    assert "'time' has no unit" in refusal(write_netcdf(tmp_path / "r.nc", VOLTS, time_units=None))
    told = refusal(write_netcdf(tmp_path / "r.nc", VOLTS, times=None, sampling_interval=1e-5))
    assert told.startswith("sampling interval of 'voltage': got")
    assert "'Voltage' has no unit" in refusal(
        write_tdms(tmp_path / "r.tdms", VOLTS, wf_increment=INTERVAL)
    )


NOT_THERE = "got the channel 'CH4', need one that is there: "


@pytest.mark.parametrize("kind", ["csv", "nc", "tdms"])
def test_a_channel_that_is_not_there(tmp_path, kind):
    names = {
        "csv": "'time [s]', 'CH1 [V]', 'CH2 [mV]', 'CH3'",
        "nc": "'time', 'CH1', 'CH2', 'CH3'",
        "tdms": "'rig/Time', 'rig/CH1', 'rig/CH2', 'rig/CH3'",
    }[kind]
    told = refusal(write_logger(tmp_path, kind), channel="CH4")
    assert told.removeprefix("line 1: ") == NOT_THERE + names


def test_of_many_channels_the_first_are_named(tmp_path):
    heads = ",".join(f"CH{number} [V]" for number in range(10, 100))
    path = write_csv(tmp_path / "r.csv", [TIMES] * 90, heads)
    names = ", ".join(f"'CH{number} [V]'" for number in range(10, 15))
    assert refusal(path, 1.0, channel="CH4") == f"line 1: {NOT_THERE}{names} and 85 more"


def test_a_channel_of_text_or_of_several_dimensions_is_not_there(tmp_path):
    with netCDF4.Dataset(tmp_path / "r.nc", "w") as file:
        file.createDimension("time", 3)
        file.createVariable("CH4", "f8", ("time", "time"))
    assert refusal(tmp_path / "r.nc", channel="CH4") == NOT_THERE + "there is none"


def test_a_name_that_several_channels_have(tmp_path):
    (tmp_path / "r.csv").write_text("t [s],U [V],U [mV]\n0,1,2\n")
    told = "got the channel 'U', which may be 'U [V]', 'U [mV]', need a name that one alone has"
    assert refusal(tmp_path / "r.csv", channel="U") == f"line 1: {told}"
    with TdmsWriter(tmp_path / "r.tdms") as file:
        for group in "AB":
            file.write_segment([ChannelObject(group, "U", VOLTS)])
    told = "got the channel 'U', which may be 'A/U', 'B/U', need a name that one alone has"
    assert refusal(tmp_path / "r.tdms", channel="U") == told


@pytest.mark.parametrize("kind", ["csv", "nc", "tdms"])
@pytest.mark.parametrize(
    ("channel", "unit", "told"),
    [
        ("CH3", None, "'CH3' has no unit, need one such as 'CH3 [V]', or 'unit' given beside"),
        ("CH1", "wumpus", "'CH1': got the unit 'wumpus', need one of voltage or resistance"),
        ("CH1", "N", "'CH1': got the unit 'N', need one of voltage or resistance"),
        ("CH1", "s", "'CH1': got the unit 's', need one of voltage or resistance"),
    ],
)
def test_a_unit_that_is_none_of_a_record(tmp_path, kind, channel, unit, told):
    path = write_logger(tmp_path, kind)
    assert refusal(path, channel=channel, unit=unit).removeprefix("line 1: ").startswith(told)


def test_a_time_is_no_record(tmp_path):
    path = write_netcdf(tmp_path / "r.nc", VOLTS)
    assert refusal(path, channel="time").startswith("'time': got the unit 's', need one of volt")


def test_a_unit_against_the_name_of_the_channel(tmp_path):
    told = "'voltage': wrong dimension or unit 'ohm', need a unit of the kind 'V'"
    assert refusal(write_netcdf(tmp_path / "r.nc", VOLTS), unit="ohm") == told


@pytest.mark.parametrize(
    ("gain", "told"),
    [
        (0.0, "got 0, need a value other than 0"),
        (0, "got 0, need a value other than 0"),
        (np.inf, "got inf, need a finite number"),
        (np.nan, "got nan, need a finite number"),
        ("ten", "got 'ten', need a number"),
        (None, "got None, need a number"),
    ],
)
def test_a_gain_that_is_none(tmp_path, gain, told):
    assert refusal(write_netcdf(tmp_path / "r.nc", VOLTS), gain=gain) == f"gain: {told}"


@pytest.mark.parametrize(
    ("offset", "told"),
    [
        ("3 ohm", "got '3 ohm', need a voltage, as the record is one"),
        ("3 mm", "got the unit 'mm', need one of voltage or resistance"),
        ("3", "got '3', need a voltage or a resistance with its unit, such as '3 mV'"),
        ("1e400 V", "got '1e400', need a finite number"),
        (np.nan, "got nan, need a finite number"),
    ],
)
def test_an_offset_that_is_none_of_the_record(tmp_path, offset, told):
    path = write_netcdf(tmp_path / "r.nc", VOLTS)
    assert refusal(path, offset=offset).startswith(f"offset: {told}")


FAULTY_TIMES = [
    ([0.0, 1.0, 2.0, 2.0, 3.0], 3, "time 2 s is repeated, need rising times"),
    ([0.0, 1.0, 2.0, 1.5, 3.0], 3, "time falls from 2 s to 1.5 s, need rising times"),
    ([0.0, 1.0, 2.0, 4.0, 5.0], 3, "time steps by 2 s, need steps of about 1 s"),
    ([0.0, 1.0, 2.0, 2.4, 3.4], 3, "time steps by 0.4 s, need steps of about 1 s"),
    ([0.0, np.nan, 2.0, 3.0, 4.0], 1, "got nan as time, need a number"),
    ([np.nan, 1.0, 2.0, 3.0, 4.0], 0, "got nan as time, need a number"),
    ([4.0, 3.0, 2.0, 1.0, 0.0], 1, "time does not rise, need rising times"),
    ([7.0, 7.0, 7.0, 7.0, 7.0], 1, "time does not rise, need rising times"),
]


@pytest.mark.parametrize(("times", "index", "told"), FAULTY_TIMES)
def test_times_that_are_not_uniform(tmp_path, times, index, told):
    values = np.arange(5.0)
    text = write_csv(tmp_path / "r.csv", [times, values], "time [s],voltage [V]")
    assert refusal(text).startswith(f"line {index + 2}: {told}")
    binary = write_netcdf(tmp_path / "r.nc", values, times=np.array(times))
    assert refusal(binary).startswith(f"sample {index + 1}: {told}")


@pytest.mark.parametrize("slices", [2, 3, 4])
def test_a_gap_between_two_slices_is_a_gap(tmp_path, monkeypatch, slices):
    monkeypatch.setattr("lube.recordings.binary_signals.SLICE", slices)
    times = np.array([0.0, 1.0, 2.0, 3.0, 8.0, 9.0, 10.0])
    with netCDF4.Dataset(tmp_path / "r.nc", "w") as file:
        file.createDimension("time", 7)
        for name, values, units in (("time", times, "s"), ("voltage", times, "V")):
            file.createVariable(name, "f8", ("time",), contiguous=True)[:] = values
            file[name].units = units
    assert refusal(tmp_path / "r.nc").startswith("sample 5: time steps by 5 s")


@pytest.mark.parametrize(("name", "bad"), [("voltage", np.inf), ("resistance", -np.inf)])
@pytest.mark.parametrize("row", [0, 5000, 9999])
def test_values_that_are_no_numbers(tmp_path, name, bad, row):
    for value in (bad, np.nan):
        values = np.ones(10_000)
        values[row] = value
        units = {"voltage": "V", "resistance": "ohm"}[name]
        told = f"got {value} as {name}, need a number"
        path = write_netcdf(tmp_path / "r.nc", values, units, np.arange(10_000.0), name)
        assert refusal(path) == f"sample {row + 1}: {told}"
        path = write_csv(tmp_path / "r.csv", [values], f"{name} [{units}]")
        assert refusal(path, 1.0) == f"line {row + 2}: {told}"
        path = write_tdms(tmp_path / "r.tdms", values, name, unit_string=units, wf_increment=1.0)
        assert refusal(path) == f"sample {row + 1}: {told}"


def test_a_missing_value_of_scaled_integers_is_no_number(tmp_path):
    with_gap = COUNTS.copy()
    with_gap[1234] = -32768
    path = tmp_path / "r.nc"
    with netCDF4.Dataset(path, "w") as file:
        file.createDimension("time", SAMPLES)
        variable = file.createVariable("voltage", "i2", ("time",), fill_value=-32768)
        variable.setncatts({"units": "V", "scale_factor": STEP, "sampling_interval": "20 us"})
        variable.set_auto_maskandscale(False)
        variable[:] = with_gap
    assert refusal(path) == "sample 1235: got nan as voltage, need a number"


@pytest.mark.parametrize(
    ("line", "told"),
    [
        ("3,oops", "got 'oops' as voltage, need a number"),
        ("oops,3", "got 'oops' as time, need a number"),
        ("3,", "got '' as voltage, need a number"),
        ("3", "got 1 values, need 2"),
        ("3,4,5", "got 3 values, need 2"),
        ("# a comment", "got 1 values, need 2"),
        ("3,1_000", "got '1_000' as voltage, need a number"),
        ("3,-0.5\x85", r"got '-0.5\x85' as voltage, need a number"),  # blank for Python alone
        ("3,٣", "got '٣' as voltage, need a number"),
    ],
)
def test_a_line_that_is_no_row_of_numbers(tmp_path, line, told):
    rows = [f"{i},{i}" for i in range(3)]
    path = tmp_path / "r.csv"
    path.write_text("\n".join(["t [s],U [V]", *rows, line, "4,4", ""]))
    assert refusal(path) == f"line 5: {told}"


@given(row=st.integers(0, 49), size=st.integers(20, 400))
@settings(max_examples=30)
def test_the_line_of_a_fault_is_told_wherever_blocks_end(tmp_path_factory, row, size):
    path = tmp_path_factory.mktemp("faults") / "r.csv"
    for written, told in (("nan", "got nan as voltage"), ("1.2.3", "got '1.2.3' as voltage")):
        rows = [f"{i},{written if i == row else i}" for i in range(50)]
        path.write_text("\n".join(["# rig", "t [s],U [V]", *rows, ""]))
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(csv_signals, "BLOCK_BYTES", size)
            assert refusal(path) == f"line {row + 3}: {told}, need a number"


def test_decimal_points_among_decimal_commas(tmp_path):
    (tmp_path / "r.csv").write_text("t [s];U [V]\n0;0,5\n1;0.5\n")
    told = "line 3: got '0.5' as voltage, need a number with a decimal comma"
    assert refusal(tmp_path / "r.csv") == told


def test_text_that_is_not_utf_8(tmp_path):
    (tmp_path / "r.csv").write_bytes("t [s],U [µV]\n0,1\n".encode("latin-1"))
    assert refusal(tmp_path / "r.csv") == "line 1: need UTF-8 text"


@pytest.mark.parametrize("share", [0.3, 0.9, 0.999])
def test_truncated_binary_files(tmp_path, share):
    whole = write_netcdf(tmp_path / "r.nc", VOLTS)
    tdms = write_tdms(tmp_path / "r.tdms", VOLTS, wf_increment=INTERVAL, unit_string="V")
    for path, kind in ((whole, "NetCDF"), (tdms, "TDMS")):
        content = path.read_bytes()
        path.write_bytes(content[: int(share * len(content))])
        assert "truncated" in refusal(path)
        assert kind in refusal(path)


@pytest.mark.parametrize("growing", [False, True])
@pytest.mark.parametrize("kind", ["NETCDF3_CLASSIC", "NETCDF3_64BIT_OFFSET", "NETCDF3_64BIT_DATA"])
def test_truncated_classic_files_are_not_read_as_zeros(tmp_path, kind, growing):
    path = tmp_path / "r.nc"
    with netCDF4.Dataset(path, "w", format=kind) as file:
        file.title = "odd"
        file.createDimension("time", None if growing else SAMPLES)
        file.createVariable("gain", "i2", ())[...] = 3
        for name, values, units in (("time", TIMES, "s"), ("voltage", VOLTS, "V")):
            file.createVariable(name, "f8", ("time",))[:] = values
            file[name].units = units
    np.testing.assert_array_equal(read(path), VOLTS)
    content = path.read_bytes()
    for length in (4, 30, 200, len(content) // 2, len(content) - 9, len(content) - 1):
        path.write_bytes(content[:length])
        assert refusal(path).startswith("not a whole NetCDF file, truncated")


@pytest.mark.parametrize("growing", [0, 1, 2])
@pytest.mark.parametrize("records", [0, 1, 3])
def test_the_length_of_a_classic_file_is_known_from_its_header(tmp_path, growing, records):
    """A part of a record is padded to four bytes, unless it is the only one."""
    path = tmp_path / "r.nc"
    with netCDF4.Dataset(path, "w", format="NETCDF3_CLASSIC") as file:
        file.createDimension("time", None)
        file.createDimension("bit", 5)
        file.createVariable("note", "S1", ("bit",))[:] = np.array(list("notes"), "S1")
        for number in range(growing):
            variable = file.createVariable(f"v{number}", "i1", ("time", "bit"))
            if records:
                variable[:records] = 1
    assert 0 <= path.stat().st_size - needed_length(path) < 4


@pytest.mark.parametrize("share", [0.1, 0.5, 0.9, 0.999])
def test_a_truncated_csv_record_is_right_but_for_its_last_line(tmp_path, share):
    """Where it ends within a line, the workflow warns of it."""
    path = write_csv(tmp_path / "r.csv", [TIMES, VOLTS], "time [s],voltage [V]")
    content, whole = path.read_bytes(), read(path)
    path.write_bytes(content[: int(share * len(content))])
    try:
        values = read(path)
    except DataError as error:
        assert str(error).startswith(f"{path}: line ")
    else:
        np.testing.assert_array_equal(values[:-1], whole[: values.size - 1])


def test_foreign_content_behind_the_right_mark(tmp_path):
    (tmp_path / "r.tdms").write_bytes(b"TDSm" + bytes(range(256)) * 20)
    assert "TDMS" in refusal(tmp_path / "r.tdms")
    (tmp_path / "r.nc").write_bytes(b"\x89HDF\r\n\x1a\n" + bytes(range(256)) * 20)
    assert "not a whole NetCDF file" in refusal(tmp_path / "r.nc")


def test_a_tdms_file_damaged_within_is_refused(tmp_path):
    path = write_tdms(tmp_path / "r.tdms", VOLTS, wf_increment=INTERVAL, unit_string="V")
    content = bytearray(path.read_bytes())
    content[12:20] = struct.pack("<Q", 1000)  # the first segment is said to be shorter
    path.write_bytes(content)
    assert "no TDMS segment at byte 1028" in refusal(path)


@pytest.mark.parametrize("told", ["soon", True, np.datetime64("2018-11-09")])
def test_a_tdms_property_that_is_no_number_is_no_interval(tmp_path, told):
    path = write_tdms(tmp_path / "r.tdms", VOLTS, unit_string="V", wf_increment=told)
    assert "sampling interval of 'Voltage': got" in refusal(path)


def test_a_tdms_unit_that_is_no_text_is_told(tmp_path):
    path = write_tdms(tmp_path / "r.tdms", VOLTS, unit_string=5, wf_increment=INTERVAL)
    assert "'Voltage': '5' is no unit" in refusal(path)


def test_a_name_that_no_file_has(tmp_path):
    for name in ("x" * 300, "a\0b", "\ud800"):
        with pytest.raises(DataError, match="no such file") as caught:
            open_recording(tmp_path / f"{name}.csv")
        assert str(caught.value).isprintable()


def test_a_carriage_return_within_a_line_is_told(tmp_path):
    (tmp_path / "r.csv").write_bytes(b"t [s],U [V]\n0,1\n1,2\r3,oops\n")
    assert refusal(tmp_path / "r.csv").startswith("line 3: got 1 values, need 2")
    (tmp_path / "r.csv").write_bytes(b"t [s],U\r [V]\n0,1\n")
    assert "need a unit" in refusal(tmp_path / "r.csv")


def test_a_head_without_end_is_told_at_once(tmp_path):
    (tmp_path / "r.csv").write_bytes(b"a" + b" " * 10**5 + b"b,c\n0,1\n")
    assert "need a voltage" in refusal(tmp_path / "r.csv")


@pytest.mark.parametrize("interval", [0.0, -1e-5, np.nan, np.inf])
def test_a_sampling_interval_that_is_none(tmp_path, interval):
    path = write_csv(tmp_path / "r.csv", [VOLTS], "U [V]")
    assert "sampling interval of" in refusal(path, interval)
    if np.isfinite(interval):
        tdms = write_tdms(tmp_path / "r.tdms", VOLTS, unit_string="V", wf_increment=interval)
        assert "need one above 0" in refusal(tdms)


def test_two_different_sampling_intervals(tmp_path):
    path = write_netcdf(tmp_path / "r.nc", VOLTS)
    assert read(path, 1.001 * INTERVAL).size == SAMPLES
    told = "its time steps by 2e-05 s, but the sampling interval was given as 3e-05 s"
    assert told in refusal(path, 3e-5)


def test_a_single_sample_tells_no_interval(tmp_path):
    (tmp_path / "r.csv").write_text("t [s],U [V]\n0,1\n")
    assert refusal(tmp_path / "r.csv").startswith("got a single sample, need two")
