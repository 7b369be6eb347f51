"""Recordings in NetCDF and TDMS files, read in slices.

In a NetCDF file they are variables with ``units``, in a TDMS file channels with the property
``unit_string`` or ``NI_UnitDescription``. Scaled integers are converted to physical values.
"""

import contextlib
import warnings
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import Any, NamedTuple

import netCDF4
import numpy as np
from nptdms import TdmsFile
from scipy.io import netcdf_file

from lube.errors import DataError, LubeError, shown
from lube.recordings.signals import Channel, Signal, find_signals
from lube.units import convert, parse_number, parse_quantity

SLICE = 2**20
"""Approximate number of samples read at a time."""


class _Array(NamedTuple):
    """One array of a file: its description, its values (read when sliced), and its attributes."""

    channel: Channel
    values: Any
    attributes: dict


@dataclass(frozen=True)
class BinarySignal:
    """A voltage or resistance in a binary file, and its time if the file has it.

    Attributes
    ----------
    path : Path
        The file.
    open_arrays : callable
        From the path to a context manager that gives the file's arrays.
    time : Signal or None
        The time, if the file has it.
    measured : Signal
        The voltage or resistance.
    sampling_interval : float or None
        Sampling interval stated in the file's attributes, s.
    """

    path: Path
    open_arrays: Callable
    time: Signal | None
    measured: Signal
    sampling_interval: float | None

    def head(self) -> tuple[np.ndarray, np.ndarray | None] | None:
        """Read the first samples and times, as from `parts`; None if there are none."""
        return next(self.parts(), None)

    def parts(self) -> Iterator[tuple[np.ndarray, np.ndarray | None]]:
        """Read the recording.

        Yields
        ------
        values, times : numpy.ndarray
            The next samples, V or ohm, and their times, s, None if the file has none. About a
            million, but never less than a chunk of the file.

        Raises
        ------
        DataError
            If the file is truncated or damaged.
        """
        with self.open_arrays(self.path) as arrays:
            values = arrays[self.measured.index].values
            times = None if self.time is None else arrays[self.time.index].values
            step = _slice_length(values)
            for first in range(0, len(values), step):
                part = slice(first, first + step)
                yield (
                    _read(values, part, self.measured),
                    None if times is None else _read(times, part, self.time),
                )

    def where(self, sample: int) -> str:
        """Position of a sample, counted from 0, in the file."""
        return f"sample {sample + 1}"


def _slice_length(values):
    """Length of a slice: whole chunks of a NetCDF variable, so that none is unpacked twice."""
    chunks = values.chunking() if isinstance(values, netCDF4.Variable) else None
    if chunks in (None, "contiguous"):
        return SLICE
    return max(SLICE // chunks[0], 1) * chunks[0]


def _read(values, part, signal):
    found = values[part]
    if np.ma.isMaskedArray(found):
        found = found.astype(float).filled(np.nan)
    return signal.converted(found)


@contextlib.contextmanager
def _refused_in_one_line(path, kind):
    """Turn any error of a library that cannot read a file into a DataError."""
    try:
        yield
    except LubeError:
        raise
    except Exception as error:  # the libraries raise many kinds for a damaged file
        reason = str(error).splitlines()[0] if str(error) else type(error).__name__
        raise DataError(
            f"{path}: not a whole {kind} file, truncated, damaged or of another kind ({reason})"
        ) from error


@contextlib.contextmanager
def _netcdf_arrays(path):
    with _refused_in_one_line(path, "NetCDF"):
        _check_classic(path)
        with netCDF4.Dataset(path) as file:
            file.set_always_mask(False)
            shared = {name: file.getncattr(name) for name in file.ncattrs()}
            yield [
                _netcdf_array(variable, shared)
                for variable in file.variables.values()
                if variable.ndim == 1 and getattr(variable.dtype, "kind", "O") in "fiu"
            ]


def _check_classic(path):
    """Refuse a truncated classic file: the NetCDF library would read zeros, which mean contact."""
    with open(path, "rb") as file:
        mark = file.read(4)
    if mark == b"CDF\x05":
        raise DataError(
            f"{path}: got the 64-bit data format (CDF-5), need NetCDF-4, as from 'nccopy -k nc4'"
        )
    if mark.startswith(b"CDF") and not _is_whole(path):
        raise DataError(f"{path}: not a whole NetCDF file, truncated or damaged")


def _is_whole(path):
    """Whether a classic file has all the bytes that its header says, by SciPy's reader."""
    # SciPy warns of the memory map that it cannot close after a failure.
    with warnings.catch_warnings(action="ignore", category=RuntimeWarning):
        try:
            netcdf_file(path).close()
        except Exception:  # it raises many kinds for a damaged file
            return False
    return True


def _netcdf_array(variable, shared):
    attributes = shared | {name: variable.getncattr(name) for name in variable.ncattrs()}
    units = attributes.get("units")
    # Only steps of time are used, so that the reference date does not matter.
    units = units.split(" since ")[0] if isinstance(units, str) else None
    channel = Channel(variable.name, units, variable.name, variable.dimensions[0], variable.size)
    return _Array(channel, variable, attributes)


@contextlib.contextmanager
def _tdms_arrays(path):
    with _refused_in_one_line(path, "TDMS"), TdmsFile.open(path) as file:
        if file.file_status.incomplete_final_segment:
            raise DataError(f"{path}: not a whole TDMS file, truncated within its last segment")
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


def open_netcdf(path: Path, channel: str | None = None, unit: str | None = None) -> BinarySignal:
    """Find the recording in a NetCDF file.

    The time is a variable as long as the recording, or an attribute ``sampling_interval``, such
    as ``10 us``, of the variable or of the file.

    Parameters
    ----------
    path : Path
        The file.
    channel : str, optional
        Name of the variable to read; by default the first voltage or resistance.
    unit : str, optional
        Its unit; overrides the one in the file.

    Returns
    -------
    BinarySignal
        The recording, not read yet.

    Raises
    ------
    DataError
        If the file is truncated, damaged or of another kind, or
        `lube.recordings.signals.find_signals` refuses its variables.
    """
    return _opened(path, _netcdf_arrays, _netcdf_interval, channel, unit)


def open_tdms(path: Path, channel: str | None = None, unit: str | None = None) -> BinarySignal:
    """Find the recording in a TDMS file.

    The time is a channel as long as the recording, or the property ``wf_increment``. The channel
    to read may also be given as ``group/channel``. Otherwise as `open_netcdf`.
    """
    return _opened(path, _tdms_arrays, _tdms_interval, channel, unit)


def _opened(path, open_arrays, interval_of, selected, unit):
    with open_arrays(path) as arrays:
        channels = [array.channel for array in arrays]
        time, measured = find_signals(channels, path, selected, unit)
        channel = channels[measured.index]
        try:
            interval = interval_of(arrays[measured.index].attributes)
        except LubeError as error:
            name = shown(channel.name)
            raise DataError(f"{path}: sampling interval of {name}: {error}") from None
        if time and interval is not None and channels[time.index].group != channel.group:
            time = None  # a channel's own interval takes precedence over another group's time
        return BinarySignal(path, open_arrays, time, measured, interval)


def _netcdf_interval(attributes):
    stated = attributes.get("sampling_interval")
    return None if stated is None else parse_quantity(stated, "s")


def _tdms_interval(properties):
    stated = properties.get("wf_increment")
    if stated is None:
        return None
    return convert(parse_number(stated), str(properties.get("wf_xunit_string") or "s"), "s")
