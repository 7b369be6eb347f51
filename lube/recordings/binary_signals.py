"""Recordings in NetCDF and TDMS files, read in slices.

In a NetCDF file they are variables with ``units``, in a TDMS file channels with the property
``unit_string`` or ``NI_UnitDescription``. Scaled integers are converted to physical values.
"""

import warnings
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from dataclasses import dataclass
from pathlib import Path

import netCDF4
import numpy as np
from nptdms import TdmsFile
from scipy.io import netcdf_file

from lube.errors import DataError, LubeError, located, shown
from lube.recordings.signals import Channel, Signal, find_signals
from lube.units import parse_quantity

SLICE = 2**20
"""Number of samples read at a time."""


@dataclass(frozen=True)
class BinarySignal:
    """A voltage or resistance in a binary file, and its time if the file has it.

    Attributes
    ----------
    path : Path
        The file.
    kind : str
        ``NetCDF`` or ``TDMS``.
    signals : list of Signal
        The time, if the file has it, and the voltage or resistance.
    sampling_interval : float or None
        Sampling interval stated in the file's attributes, s.
    """

    path: Path
    kind: str
    signals: list[Signal]
    sampling_interval: float | None

    def parts(self) -> Iterator[list[np.ndarray]]:
        """Read the recording.

        Yields
        ------
        list of numpy.ndarray
            Values of each of the signals, s, V or ohm, at the next samples, about a million.

        Raises
        ------
        DataError
            If the file is truncated or damaged.
        """
        with _channels(self.path, self.kind) as channels:
            for first in range(0, len(channels[self.signals[-1].index].values), SLICE):
                part = slice(first, first + SLICE)
                yield [_read(channels, part, signal) for signal in self.signals]

    def where(self, sample: int) -> str:
        """Position of a sample, counted from 0, in the file."""
        return f"sample {sample + 1}"


def _read(channels, part, signal):
    """Values of a signal in a slice; NaN where they are missing."""
    found = channels[signal.index].values[part].astype(float, copy=False)
    return signal.converted(np.ma.filled(found, np.nan))


@contextmanager
def _channels(path, kind):
    """Open a file and list its numeric channels; an error of a library becomes one line."""
    try:
        with (_netcdf_channels if kind == "NetCDF" else _tdms_channels)(path) as channels:
            yield channels
    except LubeError:
        raise
    except Exception as error:  # the libraries raise many kinds for a damaged file
        reason = f"{type(error).__name__}: {error}"
        raise DataError(
            f"{path}: not a complete {kind} file, truncated, damaged or of another kind ({reason})"
        ) from error


@contextmanager
def _netcdf_channels(path):
    if _is_cut_short(path):
        raise DataError(
            f"{path}: not a complete NetCDF file, truncated or damaged, or of the 64-bit data "
            "format (CDF-5)"
        )
    with netCDF4.Dataset(path) as file:
        file.set_always_mask(False)
        yield [
            _netcdf_channel(variable, file.__dict__ | variable.__dict__)
            for variable in file.variables.values()
            if variable.ndim == 1 and getattr(variable.dtype, "kind", "O") in "fiu"
        ]


def _is_cut_short(path):
    """Whether SciPy refuses a classic file, which the NetCDF library would fill up with zeros.

    Zeros mean contact.
    """
    with open(path, "rb") as file:
        if file.read(3) != b"CDF":
            return False
    # SciPy raises many kinds, and warns of the memory map that it cannot close after a failure.
    with warnings.catch_warnings(action="ignore", category=RuntimeWarning), suppress(Exception):
        netcdf_file(path).close()
        return False
    return True


def _netcdf_channel(variable, attributes):
    # Only steps of time are used, so that the reference date does not matter.
    units = str(attributes.get("units", "")).split(" since ")[0]
    name, group = variable.name, variable.dimensions[0]
    interval = attributes.get("sampling_interval")
    return Channel(name, units, name, group, variable.size, variable, interval)


@contextmanager
def _tdms_channels(path):
    with TdmsFile.open(path) as file:
        if file.file_status.incomplete_final_segment:
            raise DataError(f"{path}: not a complete TDMS file, truncated within its last segment")
        yield [
            _tdms_channel(group.name, channel)
            for group in file.groups()
            for channel in group.channels()
            if channel.dtype.kind in "fiu"
        ]


def _tdms_channel(group, array):
    known = array.properties
    units = str(known.get("unit_string") or known.get("NI_UnitDescription") or "")
    interval = known.get("wf_increment")
    if interval is not None:
        interval = f"{interval} {known.get('wf_xunit_string') or 's'}"
    return Channel(array.name, units, f"{group}/{array.name}", group, len(array), array, interval)


def open_binary(
    path: Path, kind: str, selected: str | None = None, unit: str | None = None
) -> BinarySignal:
    """Find the recording in a NetCDF or TDMS file.

    In a NetCDF file the time is a variable as long as the recording, or an attribute
    ``sampling_interval``, such as ``10 us``, of the variable or of the file. In a TDMS file it is
    a channel as long as the recording, or the property ``wf_increment``.

    Parameters
    ----------
    path : Path
        The file.
    kind : str
        ``NetCDF`` or ``TDMS``.
    selected : str, optional
        Name of the variable or channel to read, in a TDMS file also ``group/channel``; by default
        the first voltage or resistance.
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
    with _channels(path, kind) as channels:
        signals = find_signals(channels, path, selected, unit)
        first, measured = (channels[signals[each].index] for each in (0, -1))
        interval = measured.interval
        if interval is not None:
            with located(f"{path}: sampling interval of {shown(measured.name)}", DataError):
                interval = parse_quantity(interval, "s")
            if first.group != measured.group:
                # A channel's own interval takes precedence over another group's time.
                signals = signals[-1:]
        return BinarySignal(path, kind, signals, interval)
