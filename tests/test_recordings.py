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
    write_netcdf,
    write_tdms,
)

from lube import text_signals
from lube.evaluation import ContactShare
from lube.recordings import open_recording
from lube.signals import find_signals, header_cell

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
        patch.setattr(text_signals, "BLOCK_BYTES", size)
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
    monkeypatch.setattr("lube.binary_signals.SLICE", 999)
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
    time, measured = find_signals(columns, "here")
    assert (time.place, time.factor) == (2, pytest.approx(1e-3))
    assert (measured.place, measured.quantity) == (3, "resistance")
