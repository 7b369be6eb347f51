"""Records in: the same samples from every kind of file, whoever wrote it."""

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
from lube.recordings.signals import Channel, find_signals, header_cell
from lube.rig.contact_share import ContactShare

# The same record


@pytest.mark.parametrize("kind", ["csv", "netcdf", "netcdf scaled", "tdms", "tdms scaled"])
def test_all_kinds_of_files_give_the_same_record(tmp_path, kind):
    match kind:
        case "csv":
            path = write_csv(tmp_path / "r.csv", [TIMES, VOLTS], "time [s],voltage [V]")
        case "netcdf":
            path = write_netcdf(tmp_path / "r.nc", VOLTS)
        case "netcdf scaled":
            path = write_netcdf(tmp_path / "r.nc", COUNTS, scale_factor=STEP)
        case "tdms":
            path = write_tdms(tmp_path / "r.tdms", VOLTS, wf_increment=INTERVAL, unit_string="V")
        case "tdms scaled":
            path = write_tdms(
                tmp_path / "r.tdms", COUNTS, wf_increment=INTERVAL, unit_string="V", **SCALE
            )
    recording = open_recording(path)
    assert (recording.path, recording.quantity) == (path, "voltage")
    assert recording.sampling_interval == pytest.approx(INTERVAL)
    pieces = list(recording.pieces())
    assert all(piece.dtype == np.float64 and piece.ndim == 1 for piece in pieces)
    np.testing.assert_allclose(np.concatenate(pieces), VOLTS, rtol=1e-12, atol=1e-15)
    np.testing.assert_allclose(np.concatenate(list(recording.pieces())), VOLTS, atol=1e-12)


@pytest.mark.parametrize(
    ("header", "time_factor", "factor", "quantity"),
    [
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
    ],
)
@pytest.mark.parametrize(("delimiter", "decimal"), [(",", "."), (";", ","), ("\t", ",")])
def test_columns_may_be_called_in_many_ways(
    tmp_path, header, time_factor, factor, quantity, delimiter, decimal
):
    header = header.replace(",", delimiter)
    columns = [TIMES * time_factor, VOLTS * factor]
    path = write_csv(tmp_path / "r.csv", columns, header, delimiter, decimal)
    recording = open_recording(path)
    assert recording.quantity == quantity
    assert recording.sampling_interval == pytest.approx(INTERVAL)
    np.testing.assert_allclose(read(path), VOLTS, rtol=1e-8)


def test_byte_mark_comments_and_carriage_returns_are_passed_over(tmp_path):
    before = "\ufeff# rig 2\r\n\r\n# 3 V, 1 kOhm\r\n"
    header = "sample;t [s];temperature T [degC];U [V];"
    columns = [np.arange(SAMPLES), TIMES, np.full(SAMPLES, 40.0), VOLTS]
    path = write_csv(tmp_path / "r.csv", columns, header[:-1], ";", ",", "\r\n", before)
    np.testing.assert_allclose(read(path), VOLTS, rtol=1e-8)
    path.write_bytes(path.read_bytes() + b"\r\n\r\n")
    np.testing.assert_allclose(read(path), VOLTS, rtol=1e-8)


@pytest.mark.parametrize("decimal", [".", ","])
def test_a_lone_column_needs_the_sampling_interval(tmp_path, decimal):
    path = write_csv(tmp_path / "r.csv", [VOLTS], "voltage [V]", decimal=decimal)
    assert open_recording(path, INTERVAL).sampling_interval == INTERVAL
    np.testing.assert_allclose(read(path, INTERVAL), VOLTS, rtol=1e-8)
    assert refusal(path) == "no time, need a time column or a sampling interval"


def test_quoted_numbers_are_numbers(tmp_path):
    (tmp_path / "r.csv").write_text('"t [s]","U [V]"\n"0","1.5"\n"1","2.5"\n')
    np.testing.assert_array_equal(read(tmp_path / "r.csv"), [1.5, 2.5])


def test_of_several_voltages_the_first_counts_and_a_name_before_a_unit(tmp_path):
    (tmp_path / "r.csv").write_text("t [s],bias [V],U1 [V],R [ohm]\n0,5,1,3\n1,5,2,4\n")
    np.testing.assert_array_equal(read(tmp_path / "r.csv"), [1.0, 2.0])


@given(st.integers(20, 400), st.sampled_from(["\n", "\r\n", "\n\n"]), st.booleans())
@settings(max_examples=30)
def test_a_csv_record_does_not_depend_on_where_its_blocks_end(tmp_path_factory, size, end, last):
    path = tmp_path_factory.mktemp("blocks") / "r.csv"
    write_csv(path, [TIMES[:50], np.arange(50.0)], "t [s],U [V]", end=end)
    if not last:
        path.write_bytes(path.read_bytes().rstrip())
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr(csv_signals, "BLOCK_BYTES", size)
        np.testing.assert_array_equal(read(path), np.arange(50.0))


def test_an_open_circuit_is_an_infinite_resistance(tmp_path):
    (tmp_path / "r.csv").write_text("t [s],R [kOhm]\n0,inf\n1,2\n2,Inf\n")
    np.testing.assert_array_equal(read(tmp_path / "r.csv"), [np.inf, 2000.0, np.inf])
    path = write_netcdf(tmp_path / "r.nc", np.array([np.inf, 2.0]), "ohm", TIMES[:2], "resistance")
    np.testing.assert_array_equal(read(path), [np.inf, 2.0])


@pytest.mark.parametrize("place", ["variable", "file"])
def test_netcdf_may_tell_the_interval_instead_of_times(tmp_path, place):
    told = {"sampling_interval": "20 us"}
    path = write_netcdf(tmp_path / "r.nc", VOLTS, times=None, **told if place == "variable" else {})
    if place == "file":
        with netCDF4.Dataset(path, "a") as file:
            file.setncatts(told)
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
    for path, piece in ((netcdf, 700), (tdms, 999)):
        pieces = list(open_recording(path).pieces())
        assert {part.size for part in pieces[:-1]} == {piece}
        np.testing.assert_allclose(np.concatenate(pieces), VOLTS, atol=1e-12)


def test_a_record_is_evaluated_as_it_comes(tmp_path):
    path = write_csv(tmp_path / "r.csv", [TIMES * 1e3, VOLTS * 1e3], "time [ms],U [mV]")
    share = ContactShare([0.5, 2.0])
    for piece in open_recording(path).pieces():
        share.add(piece)
    # No value is at a limit, so that rounding in the file cannot move it across.
    between = VOLTS + STEP / 2
    expected = [np.count_nonzero(between < limit) for limit in (0.5, 2.0)]
    assert share.below.sum(axis=1) == pytest.approx(expected, abs=1)


# Channels, units and amplifiers

KINDS = ["csv", "nc", "tdms"]


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize(
    ("told", "factor"),
    [
        ({}, -1.0),
        ({"channel": "CH1"}, -1.0),
        ({"channel": "CH2"}, 1.0),
        ({"channel": "CH2", "unit": "V"}, 1e3),
        ({"channel": "CH3", "unit": "kV"}, 1e3),
        ({"channel": "CH3", "unit": "MOhm"}, 1e6),
        ({"unit": "mV"}, -1e-3),
    ],
)
def test_a_channel_is_read_in_the_unit_that_is_told(tmp_path, kind, told, factor):
    path = write_logger(tmp_path, kind)
    recording = open_recording(path, **told)
    assert recording.quantity == ("resistance" if told.get("unit") == "MOhm" else "voltage")
    assert recording.sampling_interval == pytest.approx(INTERVAL)
    np.testing.assert_allclose(read(path, **told), factor * VOLTS, rtol=1e-8, atol=1e-12)


@pytest.mark.parametrize("kind", KINDS)
@pytest.mark.parametrize("gain", [10.0, -4.0, 0.5, 1.0])
@pytest.mark.parametrize(("offset", "volts"), [("3 mV", 3e-3), (0.25, 0.25), ("-1 V", -1.0)])
def test_an_amplifier_is_undone(tmp_path, kind, gain, offset, volts):
    """What is recorded is the true value times the gain, and the offset."""
    recorded = VOLTS * gain + volts
    match kind:
        case "csv":
            path = write_csv(tmp_path / "r.csv", [TIMES, 1e3 * recorded], "t [s],U [mV]")
        case "nc":
            path = write_netcdf(tmp_path / "r.nc", 1e3 * recorded, "mV")
        case "tdms":
            told = {"wf_increment": INTERVAL, "unit_string": "mV"}
            path = write_tdms(tmp_path / "r.tdms", 1e3 * recorded, **told)
    found = read(path, gain=gain, offset=offset)
    np.testing.assert_allclose(found, VOLTS, rtol=1e-7, atol=1e-7)


def test_an_amplifier_of_a_resistance_leaves_an_open_circuit_open(tmp_path):
    (tmp_path / "r.csv").write_text("t [s],R [kOhm]\n0,inf\n1,2\n")
    found = read(tmp_path / "r.csv", gain=2, offset="1 kOhm")
    np.testing.assert_allclose(found, [np.inf, 500.0])


def test_without_an_amplifier_no_bit_changes(tmp_path):
    path = write_netcdf(tmp_path / "r.nc", VOLTS)
    np.testing.assert_array_equal(read(path, gain=1.0, offset=0.0), VOLTS)
    np.testing.assert_array_equal(read(path, gain=1, offset="0 V"), VOLTS)


def test_a_channel_that_is_asked_for_is_no_time_whatever_its_name(tmp_path):
    (tmp_path / "r.csv").write_text("t_contact [mV],t [s]\n5,0\n6,1\n")
    np.testing.assert_allclose(read(tmp_path / "r.csv", channel="t_contact"), [5e-3, 6e-3])


@pytest.mark.parametrize("asked", ["Dev1/ai1", "Dev1/ai1 [V]"])
def test_a_column_may_be_asked_for_by_its_whole_head(tmp_path, asked):
    unit = asked[9:] and " [V]"
    (tmp_path / "r.csv").write_text(f"t [s],Dev1/ai0{unit},Dev1/ai1{unit}\n0,5,1\n1,5,2\n")
    found = read(tmp_path / "r.csv", channel=asked, unit="V")
    np.testing.assert_array_equal(found, [1.0, 2.0])


def write_groups(path, groups):
    """TDMS file of groups, each a dict of unit and values, or of unit, values and increment."""
    with TdmsWriter(path) as file:
        for group, channels in groups.items():
            for name, (unit, values, *increment) in channels.items():
                told = {"unit_string": unit} | ({"wf_increment": increment[0]} if increment else {})
                file.write_segment([ChannelObject(group, name, values, properties=told)])
    return path


def test_a_channel_of_a_group_has_the_times_of_its_group(tmp_path):
    slow, fast = np.arange(5.0), np.arange(5.0) / 10.0
    path = write_groups(
        tmp_path / "r.tdms",
        {
            "A": {"Time": ("s", slow), "U": ("V", slow)},
            "B": {"U": ("V", fast), "Time": ("s", fast), "Dev1/ai0": ("V", -fast)},
        },
    )
    for asked, sign in (("B/U", 1.0), ("Dev1/ai0", -1.0), ("B/Dev1/ai0", -1.0)):
        assert open_recording(path, channel=asked).sampling_interval == pytest.approx(0.1)
        np.testing.assert_array_equal(read(path, channel=asked), sign * fast)
    assert open_recording(path, channel="A/U").sampling_interval == pytest.approx(1.0)


def test_an_increment_of_a_channel_counts_before_the_times_of_another_group(tmp_path):
    values = np.arange(5.0)
    groups = {"A": {"Time": ("s", values)}, "B": {"U": ("V", values, 1e-5)}}
    path = write_groups(tmp_path / "r.tdms", groups)
    assert open_recording(path).sampling_interval == pytest.approx(1e-5)
    groups["B"]["U"] = ("V", values)
    path = write_groups(tmp_path / "s.tdms", groups)
    assert open_recording(path).sampling_interval == pytest.approx(1.0)


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


# Names


@pytest.mark.parametrize(
    ("cell", "parts"),
    [
        ("voltage [mV]", ("voltage", "mV")),
        (" U (V) ", ("U", "V")),
        ("t/s", ("t", "s")),
        ("Dev1/ai0 [V]", ("Dev1/ai0", "V")),
        ("voltage", ("voltage", None)),
        ("voltage []", ("voltage", None)),
    ],
)
def test_heads_of_columns(cell, parts):
    assert header_cell(cell) == parts


def test_names_decide_before_units_and_order_after_both():
    columns = [("T", "degC"), ("bias", "V"), ("Messzeit", "ms"), ("R", "ohm"), ("U", "V")]
    time, measured = find_signals([Channel(*column, column[0]) for column in columns], "here")
    assert (time.place, time.factor) == (2, pytest.approx(1e-3))
    assert (measured.place, measured.quantity) == (3, "resistance")
