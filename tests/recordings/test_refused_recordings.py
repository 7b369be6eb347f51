"""Recordings that cannot be trusted: each refused in one line, with the position of its fault."""

import os

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

# Files


def test_a_missing_empty_or_unknown_file(tmp_path):
    assert refusal(tmp_path / "none.csv") == "cannot be read: No such file or directory"
    (tmp_path / "folder.csv").mkdir()
    assert refusal(tmp_path / "folder.csv") == "cannot be read: Is a directory"
    for suffix in (".csv", ".nc", ".tdms"):
        (tmp_path / f"r{suffix}").write_bytes(b"")
        assert refusal(tmp_path / f"r{suffix}") == "empty recording, the file has no bytes"


@pytest.mark.skipif(os.geteuid() == 0, reason="the super-user may read every file")
def test_a_file_without_permission(tmp_path):
    path = write_csv(tmp_path / "r.csv", [TIMES, VOLTS], "time [s],voltage [V]")
    path.chmod(0)
    assert refusal(path) == "cannot be read: Permission denied"


def test_a_recording_without_samples(tmp_path):
    for text in ("t [s],U [V]\n", "t [s],U [V]\n\n\n"):
        (tmp_path / "r.csv").write_text(text)
        assert refusal(tmp_path / "r.csv") == "empty recording, need samples"
    (tmp_path / "c.csv").write_text("# only\n\n# comments")
    assert refusal(tmp_path / "c.csv").startswith("empty, need a line of column names")
    netcdf = write_netcdf(tmp_path / "r.nc", np.array([]), times=np.array([]))
    assert refusal(netcdf) == "empty recording, need samples"
    tdms = write_tdms(tmp_path / "r.tdms", np.array([]), segments=1, unit_string="V")
    assert "empty recording" in refusal(tdms) or "need a voltage" in refusal(tdms)


def test_a_file_is_what_its_content_says(tmp_path):
    for name, content, reason in (
        ("r.tdms", b"time [s],force [N]\n0,1\n", "line 1: got 'time [s]', 'force [N]', need a"),
        ("r.csv", b"TDSm\x0e\0\0\0", "got nothing, need a voltage"),
        ("r.csv", b"\x89HDF\r\n\x1a\n", "not a complete NetCDF file"),
        ("r.csv", "t [s]".encode("utf-16"), "got unknown binary data, need a CSV, NetCDF or TDMS"),
    ):
        (tmp_path / name).write_bytes(content)
        assert refusal(tmp_path / name).startswith(reason)
    (tmp_path / "r.tdms").write_bytes(b"TDSm" + bytes(range(256)) * 20)
    assert "got nothing, need a voltage" in refusal(tmp_path / "r.tdms")


@pytest.mark.parametrize("format", ["NETCDF4", "NETCDF3_CLASSIC", "NETCDF3_64BIT_OFFSET"])
def test_truncated_netcdf_files_are_not_read_as_zeros(tmp_path, format):
    for growing in (False, True):
        path = write_netcdf(tmp_path / "r.nc", VOLTS, format=format, growing=growing)
        content = path.read_bytes()
        for length in (30, 200, len(content) // 2, len(content) - 9, len(content) - 1):
            path.write_bytes(content[:length])
            assert refusal(path).startswith("not a complete NetCDF file, truncated")


def test_truncated_tdms_files_are_refused(tmp_path):
    path = write_tdms(tmp_path / "r.tdms", VOLTS, wf_increment=INTERVAL, unit_string="V")
    content = path.read_bytes()
    for share in (0.3, 0.9, 0.999):
        path.write_bytes(content[: int(share * len(content))])
        assert refusal(path).startswith("not a complete TDMS file, truncated")


def test_the_64_bit_data_format_is_refused(tmp_path):
    """SciPy does not read it, and the NetCDF library reads zeros where it is cut short."""
    path = write_netcdf(tmp_path / "r.nc", VOLTS, format="NETCDF3_64BIT_DATA")
    assert refusal(path).endswith("or of the 64-bit data format (CDF-5)")


@pytest.mark.parametrize("share", [0.1, 0.5, 0.9, 0.999])
def test_a_truncated_csv_file_is_right_but_for_its_last_line(tmp_path, share):
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


# Units and channels


def test_units_and_quantities_are_never_guessed(tmp_path):
    for header, reason in {
        "time [s],voltage": "line 1: 'voltage' has no unit, need one such as 'voltage [V]'",
        "time,voltage [V]": "line 1: 'time' has no unit, need one such as 'time [s]'",
        "time [s],voltage [parsec]": "'voltage': wrong dimension or unit 'parsec'",
        "time [s],voltage [wumpus]": "'voltage': unknown unit 'wumpus'",
        "time [s],resistance [mV]": "'resistance': wrong dimension or unit 'mV'",
        "time [rpm],U [V]": "'time': wrong dimension or unit 'rpm'",
        "time [s],force [N]": "line 1: got 'time [s]', 'force [N]', need a voltage or a resistance",
        "0.1,0.2": "line 1: got '0.1', '0.2', need a voltage or a resistance",
    }.items():
        assert reason in refusal(write_csv(tmp_path / "r.csv", [TIMES, TIMES], header))


def test_units_of_binary_recordings_are_not_guessed_either(tmp_path):
    path = tmp_path / "r.nc"
    missing = "'voltage' has no unit, need one such as 'voltage [V]'"
    missing += ", or 'unit' given beside the file"
    assert refusal(write_netcdf(path, VOLTS, units=None)) == missing
    assert "unknown unit 'wumpus'" in refusal(write_netcdf(path, VOLTS, "wumpus"))
    contradiction = "'voltage': wrong dimension or unit 'ohm', need a unit of the kind 'V'"
    assert refusal(write_netcdf(path, VOLTS), unit="ohm") == contradiction
    assert "'time' has no unit" in refusal(write_netcdf(path, VOLTS, time_units=None))
    stated = write_netcdf(path, VOLTS, times=None, sampling_interval=1e-5)
    assert refusal(stated).startswith("sampling interval of 'voltage': got")
    tdms = tmp_path / "r.tdms"
    assert "'Voltage' has no unit" in refusal(write_tdms(tdms, VOLTS, wf_increment=INTERVAL))
    numeric = write_tdms(tdms, VOLTS, unit_string=5, wf_increment=INTERVAL)
    assert refusal(numeric).startswith("'Voltage': ")
    for increment in ("soon", True, np.datetime64("2018-11-09")):
        path = write_tdms(tdms, VOLTS, unit_string="V", wf_increment=increment)
        assert refusal(path).startswith("sampling interval of 'Voltage': ")


@pytest.mark.parametrize("kind", ["csv", "nc", "tdms"])
def test_a_channel_or_unit_that_cannot_be_used(tmp_path, kind):
    names = {
        "csv": "'time [s]', 'CH1 [V]', 'CH2 [mV]', 'CH3'",
        "nc": "'time', 'CH1', 'CH2', 'CH3'",
        "tdms": "'rig/Time', 'rig/CH1', 'rig/CH2', 'rig/CH3'",
    }[kind]
    path = write_logger(tmp_path, kind)
    for channel, unit, reason in (
        ("CH4", None, f"no channel 'CH4', need one of: {names}"),
        ("CH3", None, "'CH3' has no unit, need one such as 'CH3 [V]', or 'unit' given beside"),
        ("CH1", "wumpus", "'CH1': got the unit 'wumpus', need one of voltage or resistance"),
        ("CH1", "s", "'CH1': got the unit 's', need one of voltage or resistance"),
    ):
        assert refusal(path, channel=channel, unit=unit).removeprefix("line 1: ").startswith(reason)


def test_of_many_channels_the_first_are_named(tmp_path):
    heads = ",".join(f"CH{number} [V]" for number in range(10, 100))
    path = write_csv(tmp_path / "r.csv", [TIMES[:5]] * 90, heads)
    names = ", ".join(f"'CH{number} [V]'" for number in range(10, 15))
    message = f"line 1: no channel 'CH4', need one of: {names} and 85 more"
    assert refusal(path, 1.0, channel="CH4") == message


def test_a_name_of_several_channels(tmp_path):
    (tmp_path / "r.csv").write_text("t [s],U [V],U [mV]\n0,1,2\n")
    with TdmsWriter(tmp_path / "r.tdms") as file:
        for group in "AB":
            file.write_segment([ChannelObject(group, "U", VOLTS)])
    for path, names in (("r.csv", "'U [V]', 'U [mV]'"), ("r.tdms", "'A/U', 'B/U'")):
        message = f"channel 'U' is ambiguous, need the full name of one: {names}"
        assert refusal(tmp_path / path, channel="U").removeprefix("line 1: ") == message


def test_gains_and_offsets(tmp_path):
    path = write_netcdf(tmp_path / "r.nc", VOLTS)
    for options, reason in (
        ({"gain": 0}, "gain: got 0, need a value other than 0"),
        ({"gain": np.nan}, "gain: got nan, need a finite number"),
        ({"gain": "ten"}, "gain: got 'ten', need a finite number"),
        ({"offset": "3 ohm"}, "offset: got '3 ohm', need a voltage, as the recording is one"),
        ({"offset": "3 mm"}, "offset: got the unit 'mm', need one of voltage or resistance"),
        ({"offset": "3"}, "offset: got '3', need a voltage or a resistance with its unit"),
    ):
        assert refusal(path, **options).startswith(reason)


# Times

NEEDED = "need uniform steps of about 1 s (gaps are not filled)"
FAULTY_TIMES = [
    ([0.0, 1.0, 2.0, 2.0, 3.0], 3, f"time goes from 2 s to 2 s, {NEEDED}"),
    ([0.0, 1.0, 2.0, 1.5, 3.0], 3, f"time goes from 2 s to 1.5 s, {NEEDED}"),
    ([0.0, 1.0, 2.0, 4.0, 5.0], 3, f"time goes from 2 s to 4 s, {NEEDED}"),
    ([0.0, 1.0, 2.0, 2.4, 3.4], 3, f"time goes from 2 s to 2.4 s, {NEEDED}"),
    ([0.0, np.nan, 2.0, 3.0, 4.0], 1, f"time goes from 0 s to nan s, {NEEDED}"),
    ([np.nan, 1.0, 2.0, 3.0, 4.0], 0, "time goes from nan s to nan s, need uniform steps"),
    ([4.0, 3.0, 2.0, 1.0, 0.0], 1, "time does not rise, need rising times"),
    ([7.0, 7.0, 7.0, 7.0, 7.0], 1, "time does not rise, need rising times"),
]


def test_times_that_are_not_uniform(tmp_path, monkeypatch):
    for times, index, reason in FAULTY_TIMES:
        values = np.arange(5.0)
        text = write_csv(tmp_path / "r.csv", [times, values], "time [s],voltage [V]")
        assert refusal(text).startswith(f"line {index + 2}: {reason}")
        binary = write_netcdf(tmp_path / "r.nc", values, times=np.array(times))
        for size in (3, 100) if index == 3 else (100,):  # also between two slices
            monkeypatch.setattr("lube.recordings.binary_signals.SLICE", size)
            assert refusal(binary).startswith(f"sample {index + 1}: {reason}")


def test_sampling_intervals_that_cannot_be_used(tmp_path):
    path = write_csv(tmp_path / "r.csv", [VOLTS], "U [V]")
    for interval in (0.0, -1e-5, np.nan, np.inf):
        assert "need one above 0" in refusal(path, interval)
    tdms = write_tdms(tmp_path / "r.tdms", VOLTS, unit_string="V", wf_increment=0.0)
    assert "need one above 0" in refusal(tdms)
    (tmp_path / "r.csv").write_text("t [s],U [V]\n0,1\n")
    assert refusal(path).startswith("got a single sample, need two")


def test_two_different_sampling_intervals(tmp_path):
    path = write_netcdf(tmp_path / "r.nc", VOLTS)
    assert read(path, 1.001 * INTERVAL).size == SAMPLES
    message = "its time steps by 2e-05 s, but the sampling interval was given as 3e-05 s"
    assert message in refusal(path, 3e-5)


# Values


@pytest.mark.parametrize(("name", "bad"), [("voltage", np.inf), ("resistance", -np.inf)])
def test_values_that_are_not_numbers(tmp_path, name, bad):
    units = {"voltage": "V", "resistance": "ohm"}[name]
    for row, value in ((0, bad), (5000, np.nan), (9999, bad)):
        values = np.ones(10_000)
        values[row] = value
        reason = f"got {value} as {name}, need a number"
        path = write_netcdf(tmp_path / "r.nc", values, units, np.arange(10_000.0), name)
        assert refusal(path) == f"sample {row + 1}: {reason}"
        path = write_csv(tmp_path / "r.csv", [values], f"{name} [{units}]")
        assert refusal(path, 1.0) == f"line {row + 2}: {reason}"
        path = write_tdms(tmp_path / "r.tdms", values, name, unit_string=units, wf_increment=1.0)
        assert refusal(path) == f"sample {row + 1}: {reason}"


def test_a_missing_value_of_scaled_integers_is_not_a_number(tmp_path):
    with_gap = COUNTS.copy()
    with_gap[1234] = -32768
    scaled = {"scale_factor": STEP, "missing_value": np.int16(-32768)}
    path = write_netcdf(tmp_path / "r.nc", with_gap, **scaled)
    assert refusal(path) == "sample 1235: got nan as voltage, need a number"


def test_a_line_that_is_not_a_row_of_numbers(tmp_path):
    path = tmp_path / "r.csv"
    needed = "need 2 values, numbers for time and voltage"
    for line in ("3,oops", "oops,3", "3,", "3", "3,4,5", "# a comment", "3,1_000", "3,٣"):
        path.write_text("\n".join(["t [s],U [V]", "0,0", "1,1", "", "2,2", line, "4,4", ""]))
        assert refusal(path) == f"line 6: got {line!r}, {needed}"
    path.write_text("t [s];U [V]\n0;0,5\n1;0.5\n")
    needed = "need 2 values, numbers with decimal commas for time and voltage"
    assert refusal(path) == f"line 3: got '1;0.5', {needed}"


@given(row=st.integers(0, 49), size=st.integers(20, 400))
@settings(max_examples=30)
def test_the_line_of_a_fault_is_named_wherever_pieces_end(tmp_path_factory, row, size):
    path = tmp_path_factory.mktemp("faults") / "r.csv"
    for written, reason in (("nan", "got nan as voltage"), ("1.2.3", f"got '{row},1.2.3'")):
        rows = [f"{i},{written if i == row else i}" for i in range(50)]
        path.write_text("\n".join(["# rig", "t [s],U [V]", *rows, ""]))
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(csv_signals, "PIECE_BYTES", size)
            assert refusal(path).startswith(f"line {row + 3}: {reason}, need ")


def test_lines_are_skipped_in_text_alone(tmp_path):
    path = write_tdms(tmp_path / "r.tdms", VOLTS)
    assert refusal(path, skip=2) == "skip: got 2 for TDMS, need none: only text has lines"
