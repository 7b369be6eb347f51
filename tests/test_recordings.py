"""Records in: the same samples from every kind of file, and each bad one told in one line."""

import struct

import netCDF4
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from nptdms import ChannelObject, TdmsWriter

from lube import text_signals
from lube.classic_netcdf import needed_length
from lube.errors import DataError
from lube.evaluation import ContactShare
from lube.recordings import open_recording
from lube.signals import find_signals, header_cell

INTERVAL = 2e-5
SAMPLES = 3000
STEP = 0.0005
"""Volts of one step of the converter."""


@pytest.fixture(scope="module")
def counts():
    """What the converter read, int16."""
    return np.random.default_rng(1).integers(-200, 20_000, SAMPLES).astype(np.int16)


@pytest.fixture(scope="module")
def volts(counts):
    return counts * STEP


TIMES = np.arange(SAMPLES) * INTERVAL


def write_csv(path, columns, header, delimiter=",", decimal=".", end="\n", before=""):
    rows = (
        delimiter.join(f"{value:.9g}".replace(".", decimal) for value in row)
        for row in zip(*columns, strict=True)
    )
    path.write_bytes((before + end.join([header, *rows]) + end).encode())
    return path


def write_netcdf(path, values, units="V", times=TIMES, name="voltage", time_units="s", **more):
    with netCDF4.Dataset(path, "w") as file:
        file.createDimension("time", len(values))
        if times is not None:
            file.createVariable("time", "f8", ("time",))[:] = times
            if time_units is not None:
                file["time"].units = time_units
        chunks = (min(700, len(values)),) if len(values) else None
        variable = file.createVariable(name, values.dtype, ("time",), chunksizes=chunks)
        variable.setncatts(({} if units is None else {"units": units}) | more)
        variable.set_auto_maskandscale(False)
        variable[:] = values
    return path


SCALE = {
    "NI_Scaling_Status": "unscaled",
    "NI_Number_Of_Scales": 1,
    "NI_Scale[0]_Scale_Type": "Linear",
    "NI_Scale[0]_Linear_Slope": STEP,
    "NI_Scale[0]_Linear_Y_Intercept": 0.0,
    "NI_Scale[0]_Linear_Input_Source": 0xFFFFFFFF,
}


def write_tdms(path, values, name="Voltage", segments=4, others=(), **properties):
    with TdmsWriter(path) as file:
        for part in np.array_split(values, segments):
            channel = ChannelObject("rig", name, part, properties=properties)
            file.write_segment([*others, channel])
            others = ()
    return path


def read(path, *interval):
    return np.concatenate([np.array([]), *open_recording(path, *interval).pieces()])


def refusal(path, *interval):
    """The one line that a bad record is told in, its path left out."""
    with pytest.raises(DataError) as caught:
        read(path, *interval)
    message = str(caught.value)
    assert message.startswith(f"{path}: ")
    assert "\n" not in message
    return message.removeprefix(f"{path}: ")


# The same record


@pytest.mark.parametrize("kind", ["csv", "netcdf", "netcdf scaled", "tdms", "tdms scaled"])
def test_all_kinds_of_files_give_the_same_record(tmp_path, counts, volts, kind):
    match kind:
        case "csv":
            path = write_csv(tmp_path / "r.csv", [TIMES, volts], "time [s],voltage [V]")
        case "netcdf":
            path = write_netcdf(tmp_path / "r.nc", volts)
        case "netcdf scaled":
            path = write_netcdf(tmp_path / "r.nc", counts, scale_factor=STEP)
        case "tdms":
            path = write_tdms(tmp_path / "r.tdms", volts, wf_increment=INTERVAL, unit_string="V")
        case "tdms scaled":
            path = write_tdms(
                tmp_path / "r.tdms", counts, wf_increment=INTERVAL, unit_string="V", **SCALE
            )
    recording = open_recording(path)
    assert (recording.path, recording.quantity) == (path, "voltage")
    assert recording.sampling_interval == pytest.approx(INTERVAL)
    pieces = list(recording.pieces())
    assert all(piece.dtype == np.float64 and piece.ndim == 1 for piece in pieces)
    np.testing.assert_allclose(np.concatenate(pieces), volts, rtol=1e-12, atol=1e-15)
    np.testing.assert_allclose(np.concatenate(list(recording.pieces())), volts, atol=1e-12)


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
    tmp_path, volts, header, time_factor, factor, quantity, delimiter, decimal
):
    header = header.replace(",", delimiter)
    columns = [TIMES * time_factor, volts * factor]
    path = write_csv(tmp_path / "r.csv", columns, header, delimiter, decimal)
    recording = open_recording(path)
    assert recording.quantity == quantity
    assert recording.sampling_interval == pytest.approx(INTERVAL)
    np.testing.assert_allclose(read(path), volts, rtol=1e-8)


def test_byte_mark_comments_and_carriage_returns_are_passed_over(tmp_path, volts):
    before = "\ufeff# rig 2\r\n\r\n# 3 V, 1 kOhm\r\n"
    header = "sample;t [s];temperature T [degC];U [V];"
    columns = [np.arange(SAMPLES), TIMES, np.full(SAMPLES, 40.0), volts]
    path = write_csv(tmp_path / "r.csv", columns, header[:-1], ";", ",", "\r\n", before)
    np.testing.assert_allclose(read(path), volts, rtol=1e-8)
    path.write_bytes(path.read_bytes() + b"\r\n\r\n")
    np.testing.assert_allclose(read(path), volts, rtol=1e-8)


@pytest.mark.parametrize("decimal", [".", ","])
def test_a_lone_column_needs_the_sampling_interval(tmp_path, volts, decimal):
    path = write_csv(tmp_path / "r.csv", [volts], "voltage [V]", decimal=decimal)
    assert open_recording(path, INTERVAL).sampling_interval == INTERVAL
    np.testing.assert_allclose(read(path, INTERVAL), volts, rtol=1e-8)
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


@given(row=st.integers(0, 49), size=st.integers(20, 400))
@settings(max_examples=30)
def test_the_line_of_a_fault_is_told_wherever_blocks_end(tmp_path_factory, row, size):
    path = tmp_path_factory.mktemp("faults") / "r.csv"
    for written, told in (("nan", "got nan as voltage"), ("1.2.3", "got '1.2.3' as voltage")):
        rows = [f"{i},{written if i == row else i}" for i in range(50)]
        path.write_text("\n".join(["# rig", "t [s],U [V]", *rows, ""]))
        with pytest.MonkeyPatch.context() as patch:
            patch.setattr(text_signals, "BLOCK_BYTES", size)
            assert refusal(path) == f"line {row + 3}: {told}, need a number"


def test_an_open_circuit_is_an_infinite_resistance(tmp_path):
    (tmp_path / "r.csv").write_text("t [s],R [kOhm]\n0,inf\n1,2\n2,Inf\n")
    np.testing.assert_array_equal(read(tmp_path / "r.csv"), [np.inf, 2000.0, np.inf])
    path = write_netcdf(tmp_path / "r.nc", np.array([np.inf, 2.0]), "ohm", TIMES[:2], "resistance")
    np.testing.assert_array_equal(read(path), [np.inf, 2.0])


@pytest.mark.parametrize("place", ["variable", "file"])
def test_netcdf_may_tell_the_interval_instead_of_times(tmp_path, volts, place):
    told = {"sampling_interval": "20 us"}
    path = write_netcdf(tmp_path / "r.nc", volts, times=None, **told if place == "variable" else {})
    if place == "file":
        with netCDF4.Dataset(path, "a") as file:
            file.setncatts(told)
    assert open_recording(path).sampling_interval == pytest.approx(2e-5)
    np.testing.assert_array_equal(read(path), volts)


def test_netcdf_times_since_a_date_are_times(tmp_path, volts):
    path = write_netcdf(tmp_path / "r.nc", volts, time_units="seconds since 2024-05-01")
    assert open_recording(path).sampling_interval == pytest.approx(INTERVAL)


def test_tdms_with_a_time_channel_in_its_own_unit(tmp_path, volts):
    time = ChannelObject("rig", "Zeit", TIMES * 1e3, properties={"unit_string": "ms"})
    note = ChannelObject("rig", "voltage note", ["a", "b"])
    channel = ChannelObject("rig", "ai0", volts * 1e3, properties={"NI_UnitDescription": "mV"})
    with TdmsWriter(tmp_path / "r.tdms") as file:
        file.write_segment([note, time, channel])
    assert open_recording(tmp_path / "r.tdms").sampling_interval == pytest.approx(INTERVAL)
    np.testing.assert_allclose(read(tmp_path / "r.tdms"), volts, rtol=1e-12)


def test_slices_of_binary_files_join_without_a_seam(tmp_path, counts, volts, monkeypatch):
    monkeypatch.setattr("lube.binary_signals.SLICE", 999)
    netcdf = write_netcdf(tmp_path / "r.nc", counts, scale_factor=STEP)
    tdms = write_tdms(tmp_path / "r.tdms", volts, wf_increment=INTERVAL, unit_string="V")
    for path, piece in ((netcdf, 700), (tdms, 999)):
        pieces = list(open_recording(path).pieces())
        assert {part.size for part in pieces[:-1]} == {piece}
        np.testing.assert_allclose(np.concatenate(pieces), volts, atol=1e-12)


def test_a_record_is_evaluated_as_it_comes(tmp_path, volts):
    path = write_csv(tmp_path / "r.csv", [TIMES * 1e3, volts * 1e3], "time [ms],U [mV]")
    share = ContactShare([0.5, 2.0])
    for piece in open_recording(path).pieces():
        share.add(piece)
    # No value is at a limit, so that rounding in the file cannot move it across.
    expected = [np.count_nonzero(volts + STEP / 2 < limit) for limit in (0.5, 2.0)]
    assert share.below.sum(axis=1) == pytest.approx(expected, abs=1)


# Bad input


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


def test_units_of_binary_records_are_not_guessed_either(tmp_path, volts):
    missing = "'voltage' has no unit, need one such as 'voltage [V]'"
    assert refusal(write_netcdf(tmp_path / "r.nc", volts, units=None)) == missing
    assert "unknown unit 'wumpus'" in refusal(write_netcdf(tmp_path / "r.nc", volts, "wumpus"))
    assert "'time' has no unit" in refusal(write_netcdf(tmp_path / "r.nc", volts, time_units=None))
    told = refusal(write_netcdf(tmp_path / "r.nc", volts, times=None, sampling_interval=1e-5))
    assert told.startswith("sampling interval of 'voltage': got")
    assert "'Voltage' has no unit" in refusal(
        write_tdms(tmp_path / "r.tdms", volts, wf_increment=INTERVAL)
    )


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
    monkeypatch.setattr("lube.binary_signals.SLICE", slices)
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


def test_a_missing_value_of_scaled_integers_is_no_number(tmp_path, counts):
    with_gap = counts.copy()
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
    ],
)
def test_a_line_that_is_no_row_of_numbers(tmp_path, line, told):
    rows = [f"{i},{i}" for i in range(3)]
    path = tmp_path / "r.csv"
    path.write_text("\n".join(["t [s],U [V]", *rows, line, "4,4", ""]))
    assert refusal(path) == f"line 5: {told}"


def test_decimal_points_among_decimal_commas(tmp_path):
    (tmp_path / "r.csv").write_text("t [s];U [V]\n0;0,5\n1;0.5\n")
    told = "line 3: got '0.5' as voltage, need a number with a decimal comma"
    assert refusal(tmp_path / "r.csv") == told


def test_text_that_is_not_utf_8(tmp_path):
    (tmp_path / "r.csv").write_bytes("t [s],U [µV]\n0,1\n".encode("latin-1"))
    assert refusal(tmp_path / "r.csv") == "line 1: need UTF-8 text"


@pytest.mark.parametrize("share", [0.3, 0.9, 0.999])
def test_truncated_binary_files(tmp_path, counts, volts, share):
    whole = write_netcdf(tmp_path / "r.nc", volts)
    tdms = write_tdms(tmp_path / "r.tdms", volts, wf_increment=INTERVAL, unit_string="V")
    for path, kind in ((whole, "NetCDF"), (tdms, "TDMS")):
        content = path.read_bytes()
        path.write_bytes(content[: int(share * len(content))])
        assert "truncated" in refusal(path)
        assert kind in refusal(path)


@pytest.mark.parametrize("growing", [False, True])
@pytest.mark.parametrize("kind", ["NETCDF3_CLASSIC", "NETCDF3_64BIT_OFFSET", "NETCDF3_64BIT_DATA"])
def test_truncated_classic_files_are_not_read_as_zeros(tmp_path, volts, kind, growing):
    path = tmp_path / "r.nc"
    with netCDF4.Dataset(path, "w", format=kind) as file:
        file.title = "odd"
        file.createDimension("time", None if growing else SAMPLES)
        file.createVariable("gain", "i2", ())[...] = 3
        for name, values, units in (("time", TIMES, "s"), ("voltage", volts, "V")):
            file.createVariable(name, "f8", ("time",))[:] = values
            file[name].units = units
    np.testing.assert_array_equal(read(path), volts)
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
def test_a_truncated_csv_record_is_right_but_for_its_last_line(tmp_path, volts, share):
    """Where it ends within a line, the workflow warns of it."""
    path = write_csv(tmp_path / "r.csv", [TIMES, volts], "time [s],voltage [V]")
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


def test_a_tdms_file_damaged_within_is_refused(tmp_path, volts):
    path = write_tdms(tmp_path / "r.tdms", volts, wf_increment=INTERVAL, unit_string="V")
    content = bytearray(path.read_bytes())
    content[12:20] = struct.pack("<Q", 1000)  # the first segment is said to be shorter
    path.write_bytes(content)
    assert "no TDMS segment at byte 1028" in refusal(path)


@pytest.mark.parametrize("told", ["soon", True, np.datetime64("2018-11-09")])
def test_a_tdms_property_that_is_no_number_is_no_interval(tmp_path, volts, told):
    path = write_tdms(tmp_path / "r.tdms", volts, unit_string="V", wf_increment=told)
    assert "sampling interval of 'Voltage': got" in refusal(path)


def test_a_tdms_unit_that_is_no_text_is_told(tmp_path, volts):
    path = write_tdms(tmp_path / "r.tdms", volts, unit_string=5, wf_increment=INTERVAL)
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
def test_a_sampling_interval_that_is_none(tmp_path, volts, interval):
    path = write_csv(tmp_path / "r.csv", [volts], "U [V]")
    assert "sampling interval of" in refusal(path, interval)
    if np.isfinite(interval):
        tdms = write_tdms(tmp_path / "r.tdms", volts, unit_string="V", wf_increment=interval)
        assert "need one above 0" in refusal(tdms)


def test_two_different_sampling_intervals(tmp_path, volts):
    path = write_netcdf(tmp_path / "r.nc", volts)
    assert read(path, 1.001 * INTERVAL).size == SAMPLES
    told = "its time steps by 2e-05 s, but the sampling interval was given as 3e-05 s"
    assert told in refusal(path, 3e-5)


def test_a_single_sample_tells_no_interval(tmp_path):
    (tmp_path / "r.csv").write_text("t [s],U [V]\n0,1\n")
    assert refusal(tmp_path / "r.csv").startswith("got a single sample, need two")


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
