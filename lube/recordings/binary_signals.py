"""Records as NetCDF and TDMS files, read in slices.

A NetCDF file holds them as variables with ``units``, a TDMS file as channels with the property
``unit_string`` or ``NI_UnitDescription``. Whole numbers with a scale are read as what they mean.
"""

import contextlib
import os
import struct
from collections.abc import Callable
from dataclasses import dataclass
from functools import partial
from pathlib import Path

import netCDF4
import numpy as np
from nptdms import TdmsFile

from lube.errors import DataError, LubeError, shown
from lube.recordings.classic_netcdf import needed_length
from lube.recordings.signals import FIRST_STEPS, Channel, Part, Signal, find_signals
from lube.units import convert, parse_number, parse_quantity

SLICE = 2**20
"""Samples read at a time, about."""


@dataclass(frozen=True)
class BinarySignal:
    """A voltage or resistance in a binary file, and its time if the file has it.

    Attributes
    ----------
    path : Path
        The file.
    arrays : callable
        From the path to a context manager that gives the file's arrays, to be sliced.
    time : Signal or None
        Array of the time.
    measured : Signal
        Array of the voltage or resistance.
    told_interval : float or None
        Sampling interval that the file tells in its attributes, s.
    """

    path: Path
    arrays: Callable
    time: Signal | None
    measured: Signal
    told_interval: float | None

    def head(self):
        """First samples of the record, a `Part`; None if there are none."""
        return next(self._parts_of(FIRST_STEPS + 1), None)

    def parts(self):
        """Read the record.

        Yields
        ------
        Part
            About a million samples, but never less than a chunk of the file.

        Raises
        ------
        DataError
            If the file is truncated or damaged.
        """
        yield from self._parts_of(None)

    def _parts_of(self, most):
        """Yield the parts of so many samples at most, or of all."""
        with self.arrays(self.path) as arrays:
            values = arrays[self.measured.place].values
            end, step = min(most or len(values), len(values)), _slice_length(values)
            for first in range(0, end, step):
                wanted = slice(first, min(first + step, end))
                times = None
                if self.time is not None:
                    times = _read(arrays[self.time.place].values, wanted, self.time)
                yield Part(_read(values, wanted, self.measured), times, partial(_place, first))


def _place(first, index):
    return f"sample {first + index + 1}"


def _slice_length(values):
    """Whole chunks of a NetCDF variable, so that none is unpacked twice."""
    chunks = values.chunking() if isinstance(values, netCDF4.Variable) else "contiguous"
    if chunks == "contiguous" or chunks is None:
        return SLICE
    return max(SLICE // chunks[0], 1) * chunks[0]


def _read(values, wanted, signal):
    part = values[wanted]
    if np.ma.isMaskedArray(part):
        part = part.astype(float).filled(np.nan)
    return signal.converted(part)


@dataclass(frozen=True)
class _Array:
    """One array of a file, with what the file states of it, its values and its attributes."""

    channel: Channel
    values: object
    attributes: dict


@contextlib.contextmanager
def _told(path, kind):
    """Tell in one line what a library says of a file that it cannot read."""
    try:
        yield
    except LubeError:
        raise
    except Exception as error:  # of many kinds, all meaning one thing
        reason = str(error).splitlines()[0] if str(error) else type(error).__name__
        raise DataError(
            f"{path}: not a whole {kind} file, truncated, damaged or foreign ({reason})"
        ) from error


@contextlib.contextmanager
def _netcdf_arrays(path):
    with _told(path, "NetCDF"):
        _check_length(path)
        with netCDF4.Dataset(path) as file:
            file.set_always_mask(False)
            shared = {name: file.getncattr(name) for name in file.ncattrs()}
            yield [
                _netcdf_array(variable, shared)
                for variable in file.variables.values()
                if variable.ndim == 1 and getattr(variable.dtype, "kind", "O") in "fiu"
            ]


def _check_length(path):
    """Refuse a classic NetCDF file that is cut short: the library reads zeros, in silence."""
    needed, size = needed_length(path), os.path.getsize(path)
    if needed is not None and size < needed:
        raise DataError(
            f"{path}: not a whole NetCDF file, truncated: ends at byte {size}, need {needed}"
        )


def _netcdf_array(variable, shared):
    attributes = shared | {name: variable.getncattr(name) for name in variable.ncattrs()}
    units = attributes.get("units")
    # A time may be told from a date on, which matters nothing here.
    units = units.split(" since ")[0] if isinstance(units, str) else None
    channel = Channel(variable.name, units, variable.name, variable.dimensions[0], variable.size)
    return _Array(channel, variable, attributes)


@contextlib.contextmanager
def _tdms_arrays(path):
    with _told(path, "TDMS"):
        _check_segments(path)
        with TdmsFile.open(path) as file:
            yield [
                _tdms_array(group.name, channel)
                for group in file.groups()
                for channel in group.channels()
                if channel.dtype.kind in "fiu"
            ]


def _tdms_array(group, array):
    units = array.properties.get("unit_string") or array.properties.get("NI_UnitDescription")
    units = units and str(units)  # a property may be of any type
    channel = Channel(array.name, units, f"{group}/{array.name}", group, len(array))
    return _Array(channel, array, array.properties)


# National Instruments, The NI TDMS file format (2023): tag, table of contents (whose bit 6 says
# that big-endian numbers follow), version, and the lengths of the segment and of its metadata.
_LEAD_IN, _BIG_ENDIAN = 28, 1 << 6


def _check_segments(path):
    """Refuse a TDMS file that ends within a segment: npTDMS reads what there is, in silence."""
    size, begin = os.path.getsize(path), 0
    with open(path, "rb") as file:
        while begin < size:
            file.seek(begin)
            lead_in = file.read(_LEAD_IN)
            if len(lead_in) < _LEAD_IN or not lead_in.startswith(b"TDSm"):
                raise DataError(f"{path}: no TDMS segment at byte {begin}, truncated or damaged")
            big = lead_in[4] & _BIG_ENDIAN
            begin += _LEAD_IN + struct.unpack(">Q" if big else "<Q", lead_in[12:20])[0]
    if begin != size:
        raise DataError(f"{path}: ends at byte {size} within a TDMS segment, truncated")


def open_netcdf(path, channel=None, unit=None):
    """Find the record in a NetCDF file.

    The variable ``voltage`` or ``resistance`` has its time in a variable as long as itself, or
    else in an attribute ``sampling_interval``, such as ``10 us``, its own or the file's.

    Parameters
    ----------
    path : Path
        The file.
    channel : str, optional
        Name of the record's variable.
    unit : str, optional
        Its unit, in place of what the file states.

    Returns
    -------
    BinarySignal
        The record, not read yet.

    Raises
    ------
    DataError
        If the file is truncated, damaged or foreign, or `find_signals` refuses its variables.
    """
    return _opened(path, _netcdf_arrays, _netcdf_interval, channel, unit)


def open_tdms(path, channel=None, unit=None):
    """Find the record in a TDMS file.

    Its time is a channel as long as itself, or else its property ``wf_increment``. A channel
    may be asked for as ``group/channel`` too. What goes in, what comes out and what is refused
    is as in `open_netcdf`.
    """
    return _opened(path, _tdms_arrays, _tdms_interval, channel, unit)


def _opened(path, opener, interval_of, asked, unit):
    with opener(path) as arrays:
        channels = [array.channel for array in arrays]
        time, measured = find_signals(channels, path, asked, unit)
        record = channels[measured.place]
        try:
            interval = interval_of(arrays[measured.place].attributes)
        except LubeError as error:
            raise DataError(f"{path}: sampling interval of {shown(record.name)}: {error}") from None
        if time and interval is not None and channels[time.place].group != record.group:
            time = None  # what a channel says of itself is nearer than another group's times
        return BinarySignal(path, opener, time, measured, interval)


def _netcdf_interval(attributes):
    told = attributes.get("sampling_interval")
    return None if told is None else parse_quantity(told, "s")


def _tdms_interval(properties):
    told = properties.get("wf_increment")
    if told is None:
        return None
    return convert(parse_number(told), str(properties.get("wf_xunit_string") or "s"), "s")
