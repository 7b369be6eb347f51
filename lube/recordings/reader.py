"""Measured records of the rig: CSV, NetCDF and TDMS files, streamed and checked as they are read.

A record is a voltage or a resistance, sampled uniformly: its share of samples in contact is a
share of time. What breaks that, a gap or a repeated time or a missing value, ends the reading
with its place in the file; nothing is mended in silence.
"""

import os
from dataclasses import dataclass, field, replace
from pathlib import Path

from lube.errors import DataError, LubeError, shown
from lube.recordings.binary_signals import BinarySignal, open_netcdf, open_tdms
from lube.recordings.csv_signals import TextSignal, open_text
from lube.recordings.signals import Clock, first_interval, value_fault
from lube.study.field_types import bounded
from lube.units import parse_electrical, parse_number

_KIND_OF_SUFFIX = {
    ".csv": "text",
    ".tsv": "text",
    ".txt": "text",
    ".nc": "NetCDF",
    ".nc4": "NetCDF",
    ".tdms": "TDMS",
}
_KIND_OF_MARK = {b"\x89HDF": "NetCDF", b"CDF": "NetCDF", b"TDSm": "TDMS"}
_OPENERS = {"text": open_text, "NetCDF": open_netcdf, "TDMS": open_tdms}

# Two tellings of one sampling interval may differ by rounding.
_AGREEMENT = 0.01


@dataclass(frozen=True)
class Recording:
    """A record of the rig in a file. Make it with `open_recording`.

    Attributes
    ----------
    path : Path
        The file.
    quantity : str
        ``voltage`` (V) or ``resistance`` (ohm).
    sampling_interval : float
        Time between samples, s.
    """

    path: Path
    quantity: str
    sampling_interval: float
    _signal: TextSignal | BinarySignal = field(repr=False)

    def pieces(self):
        """Read the record in bounded memory, checking each sample.

        Yields
        ------
        numpy.ndarray
            One-dimensional, float64, the next samples in V or ohm.

        Raises
        ------
        DataError
            At the first sample that is missing or no number, or whose time does not follow on
            the one before; and if the file turns out to be damaged, or empty. Which line or
            sample, and why.
        """
        clock = Clock(self.sampling_interval)
        for part in self._signal.parts():
            faults = [value_fault(part.values, self.quantity)]
            if part.times is not None:
                faults.append(clock.fault(part.times))
            for index, reason in sorted(filter(None, faults)):
                raise DataError(f"{self.path}: {part.place(index)}: {reason}")
            yield part.values


def open_recording(path, sampling_interval=None, channel=None, unit=None, gain=1.0, offset=0.0):
    """Open a record of the rig, whose samples are read later.

    Between rig and recorder there may be an amplifier: recorded = gain * true + offset. What is
    read is true = (recorded - offset) / gain.

    Parameters
    ----------
    path : str or Path
        CSV file (.csv, .tsv, .txt), NetCDF file (.nc, .nc4) or TDMS file (.tdms).
    sampling_interval : float, optional
        Time between samples, s, for a file that does not tell it.
    channel : str, optional
        Name of the column, variable or channel that is the record, without its unit; of a TDMS
        file ``group/channel`` too. By default the first voltage or resistance.
    unit : str, optional
        Unit of that channel, such as ``mV``. It is believed even where the file states another.
    gain : float, optional
        Factor of the amplifier, not 0; below 0 if it inverts.
    offset : float or str, optional
        What is recorded when the true value is 0: in V or ohm, or a text with its unit.

    Returns
    -------
    Recording
        The record.

    Raises
    ------
    DataError
        If the file is missing, not what its name says, empty or damaged; if it holds no
        voltage or resistance, or not the channel, or several of its name, or a unit is missing,
        unknown or not of what the channel's name says; if the gain is 0 or the offset is not of
        the record's quantity; if the sampling interval is not known, not positive, or told
        twice and differently.
    """
    path = Path(path)
    signal = _OPENERS[_kind(path)](path, channel, unit)
    signal = replace(signal, measured=_before_amplifier(path, signal.measured, gain, offset))
    head = signal.head()
    if head is None:
        raise DataError(f"{path}: empty record, need samples")
    interval = _agreed_interval(path, _told_interval(path, signal, head), sampling_interval)
    return Recording(path, signal.measured.quantity, interval, signal)


def _kind(path):
    """Kind of a file, by its suffix, if its first bytes do not belie it."""
    if not os.path.isfile(path):  # whatever its name holds
        raise DataError(f"{path}: no such file, need a record of the rig")
    claimed = _KIND_OF_SUFFIX.get(path.suffix.lower())
    if claimed is None:
        raise DataError(
            f"{path}: got the suffix {path.suffix!r}, need one of {', '.join(_KIND_OF_SUFFIX)}"
        )
    try:
        with open(path, "rb") as file:
            first = file.read(4096)
    except OSError as error:
        raise DataError(f"{path}: cannot be read: {error.strerror}") from None
    if not first:
        raise DataError(f"{path}: empty record, the file has no bytes")
    kinds = (kind for mark, kind in _KIND_OF_MARK.items() if first.startswith(mark))
    found = next(kinds, "unknown binary data" if b"\0" in first else "text")
    if found != claimed:
        raise DataError(f"{path}: named as {claimed} but begins as {found}, need one of the two")
    return claimed


def _before_amplifier(path, measured, gain, offset):
    try:
        gain = bounded(parse_number(gain), None, other_than=0.0)
    except LubeError as error:
        raise DataError(f"{path}: gain: {error}") from None
    try:
        volts_or_ohms = _offset(offset, measured.quantity)
    except LubeError as error:
        raise DataError(f"{path}: offset: {error}") from None
    return measured.before_amplifier(gain, volts_or_ohms)


def _offset(offset, quantity):
    """Offset in V or ohm, as the record's quantity is."""
    if not isinstance(offset, str):
        return parse_number(offset)
    number, kind = parse_electrical(offset)
    if kind != quantity:
        raise LubeError(f"got {shown(offset)}, need a {quantity}, as the record is one")
    return number


def _told_interval(path, signal, head):
    """Return what the record's times, or else the file's attributes, tell of the interval, s."""
    if head.times is None:
        return signal.told_interval
    if head.times.size == 1:
        raise DataError(f"{path}: got a single sample, need two or more to tell the time between")
    interval = first_interval(head.times)
    if interval is None:
        raise DataError(f"{path}: {head.place(1)}: time does not rise, need rising times")
    return interval


def _agreed_interval(path, told, given):
    """Return the sampling interval that the file tells or, if it tells none, the given one."""
    for interval in (told, given):
        if interval is not None and not 0.0 < interval < float("inf"):
            raise DataError(f"{path}: got a sampling interval of {interval:g} s, need one above 0")
    if told is None and given is None:
        raise DataError(f"{path}: no time, need a time column or a sampling interval")
    if told is not None and given is not None and abs(told - given) > _AGREEMENT * told:
        raise DataError(
            f"{path}: its time steps by {told:.6g} s, but the sampling interval was given as "
            f"{given:.6g} s, need one of them"
        )
    return given if told is None else told
