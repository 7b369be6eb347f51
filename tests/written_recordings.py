"""Recordings as measuring programs write them, and what is read of them."""

from functools import partial

import netCDF4
import numpy as np
from nptdms import ChannelObject, TdmsWriter
from refusals import one_line

from lube.errors import DataError
from lube.recordings.reader import open_recording

INTERVAL = 2e-5
SAMPLES = 3000
STEP = 0.0005
"""Volts of one step of the converter."""

COUNTS = np.random.default_rng(1).integers(-200, 20_000, SAMPLES).astype(np.int16)
"""Steps that the converter recorded."""

VOLTS = COUNTS * STEP
TIMES = np.arange(SAMPLES) * INTERVAL


def write_csv(path, columns, header, delimiter=",", decimal=".", end="\n", before=""):
    rows = (
        delimiter.join(f"{value:.9g}".replace(".", decimal) for value in row)
        for row in zip(*columns, strict=True)
    )
    path.write_bytes((before + end.join([header, *rows]) + end).encode())
    return path


def write_netcdf(
    path,
    values,
    units="V",
    times=TIMES,
    name="voltage",
    time_units="s",
    format="NETCDF4",
    growing=False,
    **more,
):
    with netCDF4.Dataset(path, "w", format=format) as file:
        file.createDimension("time", None if growing else len(values))
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


def write_logger(folder, kind):
    """Times and three channels; no name says voltage, and the third has no unit."""
    channels = {"CH1": ("V", -VOLTS), "CH2": ("mV", 1e3 * VOLTS), "CH3": (None, VOLTS)}
    path = folder / f"logger.{kind}"
    match kind:
        case "csv":
            heads = [f"{name} [{unit}]" if unit else name for name, (unit, _) in channels.items()]
            columns = [TIMES, *(values for _, values in channels.values())]
            write_csv(path, columns, ",".join(["time [s]", *heads]))
        case "nc":
            write_netcdf(path, TIMES, "s", times=None, name="time")
            with netCDF4.Dataset(path, "a") as file:
                for name, (unit, values) in channels.items():
                    file.createVariable(name, "f8", ("time",))[:] = values
                    file[name].setncatts({"units": unit} if unit else {})
        case "tdms":
            channels = {"Time": ("s", TIMES)} | channels
            with TdmsWriter(path) as file:
                for name, (unit, values) in channels.items():
                    properties = {"unit_string": unit} if unit else {}
                    file.write_segment([ChannelObject("rig", name, values, properties=properties)])
    return path


def read(path, *interval, **options):
    return np.concatenate([np.array([]), *open_recording(path, *interval, **options).pieces()])


def refusal(path, *interval, **options):
    """The one line in which a recording is refused, without its path."""
    message = one_line(DataError, partial(read, **options), path, *interval)
    assert message.startswith(f"{path}: ")
    return message.removeprefix(f"{path}: ")
