"""Measured recordings: CSV, NetCDF and TDMS files, streamed and checked as they are read.

A recording is a voltage or a resistance, sampled uniformly, so that its share of samples in
contact is a share of time. A gap, a repeated time or a missing value ends the reading with an
error that names its position in the file; nothing is repaired silently.
"""

from collections.abc import Iterator
from dataclasses import dataclass, field, replace
from pathlib import Path

import numpy as np

from lube.errors import DataError, LubeError, located, shown
from lube.recordings.binary_signals import BinarySignal, open_binary
from lube.recordings.csv_signals import TextSignal, open_text
from lube.study.field_types import read_number
from lube.units import parse_electrical, parse_number

_KIND_OF_MARK = {b"\x89HDF": "NetCDF", b"CDF": "NetCDF", b"TDSm": "TDMS"}

_FIRST_STEPS = 1000  # time steps whose mean is the sampling interval
_AGREEMENT = 0.01  # relative; the given interval may differ from the file's by rounding


@dataclass(frozen=True)
class Recording:
    """A voltage or resistance in a file. Make it with `open_recording`.

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

    def pieces(self) -> Iterator[np.ndarray]:
        """Read the recording in bounded memory, checking each sample.

        Yields
        ------
        numpy.ndarray
            One-dimensional, float64, the next samples in V or ohm.

        Raises
        ------
        DataError
            At the first sample that is missing or not a number, or whose time is not one sampling
            interval after the one before; or if the file is damaged. It names the line or sample.
        """
        samples, before = 0, None
        for *times, values in self._signal.parts():
            faults = [_value_fault(values, self.quantity)]
            for time in times:
                before = time[0] - self.sampling_interval if before is None else before
                faults.append(_time_fault(time, before, self.sampling_interval))
                before = time[-1]
            for index, reason in sorted(filter(None, faults)):
                raise DataError(f"{self.path}: {self._signal.where(samples + index)}: {reason}")
            samples += values.size
            yield values


def _value_fault(values, quantity):
    """Index of the first value that is not allowed, and the reason; None if there is none."""
    # An infinite resistance is an open circuit. Comparisons with NaN are false.
    most = np.inf if quantity == "resistance" else np.finfo(float).max
    allowed = (values > -np.inf) & (values <= most)
    index = int(np.argmin(allowed))
    return None if allowed[index] else (index, f"got {values[index]} as {quantity}, need a number")


def _time_fault(times, before, interval):
    """Index of the first time that does not follow the one before, and the reason; or None."""
    steps = np.diff(times, prepend=before)
    uniform = (steps > 0.5 * interval) & (steps < 1.5 * interval)
    index = int(np.argmin(uniform))
    if uniform[index]:
        return None
    before, now = times[index - 1] if index else before, times[index]
    needed = f"need uniform steps of about {interval:.6g} s (gaps are not filled)"
    return index, f"time goes from {before:.9g} s to {now:.9g} s, {needed}"


def open_recording(
    path: str | Path,
    sampling_interval: float | None = None,
    channel: str | None = None,
    unit: str | None = None,
    gain: float = 1.0,
    offset: float | str = 0.0,
    skip: int | None = None,
) -> Recording:
    """Open a measured recording, whose samples are read later.

    The samples are corrected for an amplifier between rig and recorder: with recorded = gain * true
    + offset, true = (recorded - offset) / gain.

    Parameters
    ----------
    path : str or Path
        CSV, NetCDF or TDMS file; its content says which.
    sampling_interval : float, optional
        Time between samples, s, for a file that does not state it.
    channel : str, optional
        Name of the column, variable or channel to read, without its unit; in a TDMS file also
        ``group/channel``. By default the first voltage or resistance.
    unit : str, optional
        Unit of that channel, such as ``mV``; overrides the one in the file.
    gain : float, optional
        Gain of the amplifier, not 0; negative if it inverts.
    offset : float or str, optional
        Recorded value when the true value is 0: in V or ohm, or a text with its unit.
    skip : int, optional
        Number of lines of a CSV file before its column names, where they are not found.

    Returns
    -------
    Recording
        The recording.

    Raises
    ------
    DataError
        If the file is missing, of none of these kinds, empty or damaged; if it has no voltage or
        resistance, or not exactly one channel of the given name; if a unit is missing, unknown or
        contradicts the channel's name; if the gain is 0 or the offset is not of the recording's
        quantity; if the sampling interval is unknown, not positive, or not the one in the file.
    """
    path = Path(path)
    kind = _kind(path)
    if kind == "text":
        signal = open_text(path, channel, unit, skip)
    elif skip is None:
        signal = open_binary(path, kind, channel, unit)
    else:
        raise DataError(f"{path}: skip: got {skip} for {kind}, need none: only text has lines")
    *times, measured = signal.signals
    signal = replace(signal, signals=[*times, _before_amplifier(path, measured, gain, offset)])
    head = next(signal.parts(), None)
    if head is None:
        raise DataError(f"{path}: empty recording, need samples")
    stated = _interval_of(path, signal, head[0]) if times else signal.sampling_interval
    interval = _agreed_interval(path, stated, sampling_interval)
    return Recording(path, measured.quantity, interval, signal)


def _kind(path):
    """Kind of a file by its first bytes, whatever its suffix."""
    try:
        with open(path, "rb") as file:
            first = file.read(4096)
    except OSError as error:
        raise DataError(f"{path}: cannot be read: {error.strerror}") from None
    if not first:
        raise DataError(f"{path}: empty recording, the file has no bytes")
    for mark, kind in _KIND_OF_MARK.items():
        if first.startswith(mark):
            return kind
    if b"\0" in first:
        raise DataError(f"{path}: got unknown binary data, need a CSV, NetCDF or TDMS file")
    return "text"


def _before_amplifier(path, measured, gain, offset):
    """Undo the gain and offset of an amplifier."""
    with located(f"{path}: gain", DataError):
        gain = read_number(gain, None, other_than=0.0)
    with located(f"{path}: offset", DataError):
        offset = _offset(offset, measured.quantity)
    return replace(measured, factor=measured.factor / gain, shift=(0.0 - offset) / gain)


def _offset(offset, quantity):
    """Offset in V or ohm, whichever the recording is in."""
    if not isinstance(offset, str):
        return parse_number(offset)
    number, kind = parse_electrical(offset)
    if kind != quantity:
        raise LubeError(f"got {shown(offset)}, need a {quantity}, as the recording is one")
    return number


def _interval_of(path, signal, times):
    """Mean of the first time steps, s, but for gaps; written times may be rounded."""
    if times.size == 1:
        raise DataError(f"{path}: got a single sample, need two or more for a sampling interval")
    steps = np.diff(times[: _FIRST_STEPS + 1])
    rising = steps[(steps > 0.0) & np.isfinite(steps)]
    if not rising.size:
        raise DataError(f"{path}: {signal.where(1)}: time does not rise, need rising times")
    median = np.median(rising)
    return float(rising[np.abs(rising - median) < 0.5 * median].mean())


def _agreed_interval(path, stated, given):
    """Return the interval that the file states or, if it states none, the given one."""
    for interval in (stated, given):
        if interval is not None and not 0.0 < interval < float("inf"):
            raise DataError(f"{path}: got a sampling interval of {interval:g} s, need one above 0")
    if stated is None and given is None:
        raise DataError(f"{path}: no time, need a time column or a sampling interval")
    if stated is not None and given is not None and abs(stated - given) > _AGREEMENT * stated:
        came = f"the sampling interval was given as {given:.6g} s, need them to agree"
        raise DataError(f"{path}: its time steps by {stated:.6g} s, but {came}")
    return given if stated is None else stated
