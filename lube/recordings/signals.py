"""What the columns, variables and channels of a record mean, and whether their samples are sound.

A record is one quantity, a voltage or a resistance, sampled uniformly. Its files name that
quantity in many ways; the unit must be written, it is never guessed.
"""

import re
from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from lube.errors import DataError, LubeError, shown
from lube.kernels.uniform import first_uneven, first_unsound
from lube.units import ELECTRICAL, convert, electrical_quantity, usual_spelling

UNITS = {"time": "s"} | ELECTRICAL

FIRST_STEPS = 1000
"""The median of so many first steps of time is the sampling interval."""

_ENDINGS = {
    "time": ("time", "zeit"),
    "voltage": ("voltage", "spannung"),
    "resistance": ("resistance", "widerstand"),
}
_SYMBOLS = {"t": "time", "U": "voltage", "u": "voltage", "R": "resistance", "r": "resistance"}
_HEADER = re.compile(r"(.*?)\s*(?:\[([^\]]*)\]|\(([^)]*)\)|/\s*([^/\s]+))")
_LONGEST_HEADER = 200


@dataclass(frozen=True)
class Channel:
    """A column, variable or channel, as its file tells of it.

    Attributes
    ----------
    name : str
        Its name, without a unit.
    units : str or None
        Its unit, if the file states one.
    full_name : str
        By which it may be asked for as well: ``group/channel``, or the whole head of a column.
    group : str
        What is logged together has the same: a group of channels, or a dimension.
    size : int
        Number of its samples, as far as it matters; 0 in a table.
    """

    name: str
    units: str | None
    full_name: str
    group: str = ""
    size: int = 0


@dataclass(frozen=True)
class Signal:
    """What is read of a record: a channel, and how its values are converted.

    Attributes
    ----------
    place : int
        The channel's number among those of the file.
    quantity : str
        ``time``, ``voltage`` or ``resistance``.
    factor : float
        From the unit of the file to s, V or ohm, of a voltage or resistance at the rig.
    shift : float
        Added after that, s, V or ohm.
    """

    place: int
    quantity: str
    factor: float
    shift: float = 0.0

    def before_amplifier(self, gain, offset):
        """Signal of the rig, of which ``gain`` times so much and ``offset`` were recorded."""
        return replace(self, factor=self.factor / gain, shift=(self.shift - offset) / gain)

    def converted(self, values):
        """Values of the file in s, V or ohm, float64."""
        values = np.asarray(values, float)
        if self.factor != 1.0:
            values = values * self.factor
        return values + self.shift if self.shift else values


@dataclass(frozen=True)
class Part:
    """Some successive samples of a record.

    Attributes
    ----------
    values : numpy.ndarray
        Shape (N,), float64, V or ohm.
    times : numpy.ndarray or None
        Shape (N,), float64, s, if the file tells them.
    place : callable
        From the index of a sample to where it stands in the file, such as ``line 17``.
    """

    values: np.ndarray
    times: np.ndarray | None
    place: Callable


def header_cell(cell):
    """Part the head of a column into name and unit: ``U [mV]``, ``U (mV)`` or ``U/mV``.

    Parameters
    ----------
    cell : str
        Head of the column.

    Returns
    -------
    name : str
        The name.
    units : str or None
        The unit, None if there is none.
    """
    cell = cell.strip()
    # A longer one is none, and would keep the pattern busy for hours.
    match = _HEADER.fullmatch(cell) if len(cell) <= _LONGEST_HEADER else None
    if match is None:
        return cell, None
    name, *units = match.groups()
    return name, next(filter(None, units), None)


def find_signals(channels, where, asked=None, unit=None):
    """Find the time and the measured quantity among the channels of a file.

    Names decide, and where none of them tells, units. Where a file holds several voltages or
    resistances, the first counts, unless one is asked for. The time is as long as the record; one
    of the same group comes first.

    Parameters
    ----------
    channels : list of Channel
        All columns, variables or channels of numbers.
    where : str or Path
        The file, for the message.
    asked : str, optional
        Name, or full name, of the channel that is the record.
    unit : str, optional
        Its unit, in place of what the file states.

    Returns
    -------
    time : Signal or None
        The time, if the file has any.
    measured : Signal
        The voltage or resistance.

    Raises
    ------
    DataError
        If there is no voltage or resistance, or not the channel that is asked for, or several of
        its name; if a unit is missing or unknown, or not of what the channel's name says.
    """
    everywhere = range(len(channels))
    if asked is None:
        place = _place_of(ELECTRICAL, channels, everywhere)
    else:
        place = _asked_place(channels, asked, where)
    if place is None:
        names = ", ".join(shown(channel.name) for channel in channels[:5]) or "nothing"
        raise DataError(
            f"{where}: got {names}, need a voltage or a resistance with its unit, such as "
            "'voltage [V]', or 'channel' given beside the file"
        )
    record = channels[place] if unit is None else replace(channels[place], units=unit)
    named = _named_quantity(record)
    measured = _signal(place, record, named if named in ELECTRICAL else None, where)
    taken = None if asked is None else place  # what is asked for is no time, whatever its name
    beside = [at for at in everywhere if at != taken and channels[at].size == record.size]
    return _time(channels, beside, record.group, where), measured


def _place_of(quantities, channels, places):
    """First of some places where a channel is one of some quantities; None if there is none."""
    for told_by in (_named_quantity, _quantity_of_unit):
        for place in places:
            if told_by(channels[place]) in quantities:
                return place
    return None


def _asked_place(channels, asked, where):
    places = [
        place
        for place, channel in enumerate(channels)
        if asked in (channel.name, channel.full_name)
    ]
    if len(places) == 1:
        return places[0]
    fitting = [channels[place] for place in places] or channels
    names = ", ".join(shown(channel.full_name) for channel in fitting[:5])
    more = f" and {len(fitting) - 5} more" if len(fitting) > 5 else ""
    if places:
        raise DataError(
            f"{where}: got the channel {shown(asked)}, which may be {names}{more}, need a name "
            "that one alone has"
        )
    raise DataError(
        f"{where}: got the channel {shown(asked)}, need one that is there: "
        f"{names or 'there is none'}{more}"
    )


def _time(channels, places, group, where):
    own = [place for place in places if channels[place].group == group]
    for candidates in (own, places):
        place = _place_of(("time",), channels, candidates)
        if place is not None:
            return _signal(place, channels[place], "time", where)
    return None


def _named_quantity(channel):
    # Symbols as they are, since T is a temperature; words in any case, compound ones too.
    words = re.split(r"[\W_\d]+", channel.name)
    for quantity, endings in _ENDINGS.items():
        if any(word.casefold().endswith(endings) for word in words):
            return quantity
    return next((_SYMBOLS[word] for word in words if word in _SYMBOLS), None)


def _quantity_of_unit(channel):
    for quantity, target in UNITS.items():
        try:
            convert(1.0, usual_spelling(channel.units or ""), target)
        except LubeError:
            continue
        return quantity
    return None


def _signal(place, channel, quantity, where):
    """Signal of a channel; where its quantity is None, the unit must tell a measured one."""
    if not channel.units:
        example = f"'{channel.name} [{UNITS[quantity or 'voltage']}]'"
        given = "" if quantity == "time" else ", or 'unit' given beside the file"
        raise DataError(
            f"{where}: {shown(channel.name)} has no unit, need one such as {example}{given}"
        )
    try:
        quantity = quantity or electrical_quantity(channel.units)
        factor = convert(1.0, usual_spelling(channel.units), UNITS[quantity])
    except LubeError as error:
        raise DataError(f"{where}: {shown(channel.name)}: {error}") from None
    return Signal(place, quantity, factor)


def first_interval(times):
    """Tell the sampling interval from the first times of a record.

    Parameters
    ----------
    times : numpy.ndarray
        Shape (N,), s.

    Returns
    -------
    float or None
        Median of the first steps that rise, s; None if none does.
    """
    steps = np.diff(times[: FIRST_STEPS + 1])
    rising = steps[(steps > 0.0) & np.isfinite(steps)]
    return float(np.median(rising)) if rising.size else None


class Clock:
    """Watch over the times of a record, which must be uniform, part after part.

    Parameters
    ----------
    interval : float
        Sampling interval, s.
    """

    def __init__(self, interval):
        self._interval = interval
        self._last = None

    def fault(self, times):
        """Find the first departure from uniform sampling.

        Parameters
        ----------
        times : numpy.ndarray
            Shape (N,) and N > 0, the next times, s.

        Returns
        -------
        tuple or None
            Index of the sample and what is wrong, None if all is well.
        """
        before = times[0] - self._interval if self._last is None else self._last
        index = first_uneven(times, before, self._interval)
        self._last = times[-1]
        if index < 0:
            return None
        return index, self._reason(times[index - 1] if index else before, times[index])

    def _reason(self, before, now):
        if not np.isfinite(now):
            return f"got {now} as time, need a number"
        if now == before:
            return f"time {now:.9g} s is repeated, need rising times"
        if now < before:
            return f"time falls from {before:.9g} s to {now:.9g} s, need rising times"
        return (
            f"time steps by {now - before:.6g} s, need steps of about {self._interval:.6g} s "
            "(gaps are not filled)"
        )


def value_fault(values, quantity):
    """Find the first value that a record may not hold.

    Parameters
    ----------
    values : numpy.ndarray
        Shape (N,), V or ohm.
    quantity : str
        ``voltage``, or ``resistance``, which may be infinite: an open circuit.

    Returns
    -------
    tuple or None
        Index of the sample and what is wrong, None if all is well.
    """
    index = first_unsound(values, np.inf if quantity == "resistance" else np.finfo(float).max)
    return None if index < 0 else (index, f"got {values[index]} as {quantity}, need a number")
