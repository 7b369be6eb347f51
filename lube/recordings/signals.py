"""Find the time and the voltage or resistance among a file's channels, with their units.

A channel is a column of a CSV file, a variable of a NetCDF file or a channel of a TDMS file. Its
quantity follows from its name or its unit. The unit must be stated; it is never guessed.
"""

import re
from collections.abc import Sequence
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from lube.errors import DataError, located, shown
from lube.types import File
from lube.units import ELECTRICAL, convert, converts, electrical_quantity, usual_spelling

UNITS = {"time": "s"} | ELECTRICAL
"""Quantities of a recording, each with the unit to which it is converted."""

_ENDINGS = {
    "time": ("time", "zeit"),
    "voltage": ("voltage", "spannung"),
    "resistance": ("resistance", "widerstand"),
}
_SYMBOLS = {"t": "time", "U": "voltage", "u": "voltage", "R": "resistance", "r": "resistance"}
_HEADER = re.compile(r"(.*?)\s*(?:\[([^\]]*)\]|\(([^)]*)\)|/\s*([^/\s]+))")
_MOST_NAMES = 5  # channels that a message lists


@dataclass(frozen=True)
class Channel:
    """A column, variable or channel, as its file describes it.

    Attributes
    ----------
    name : str
        Its name, without a unit.
    units : str or None
        Its unit, if the file states one.
    full_name : str
        A second name by which it can be selected: ``group/channel``, or the whole column header.
    group : str
        Name shared by channels logged together: a TDMS group or a NetCDF dimension.
    size : int
        Number of samples; 0 for the columns of a table, which are equally long.
    values : array_like
        Its values, read when sliced; None for the columns of a table.
    interval : object
        Sampling interval with its unit, as the file states it; None if it does not.
    """

    name: str
    units: str | None
    full_name: str
    group: str = ""
    size: int = 0
    values: Any = None
    interval: Any = None


@dataclass(frozen=True)
class Signal:
    """A channel that is read, and the conversion of its values to SI.

    Attributes
    ----------
    index : int
        Position of the channel among the channels of the file.
    quantity : str
        ``time``, ``voltage`` or ``resistance``.
    factor : float
        Factor by which the file's values are multiplied.
    shift : float
        Number added to the product, s, V or ohm.
    """

    index: int
    quantity: str
    factor: float
    shift: float = 0.0

    def converted(self, values: np.ndarray) -> np.ndarray:
        """Values of the file in s, V or ohm."""
        if self.factor != 1.0:
            values = values * self.factor
        return values + self.shift if self.shift else values


def header_cell(cell: str) -> tuple[str, str | None]:
    """Split a column header into name and unit.

    Parameters
    ----------
    cell : str
        Such as ``U [mV]``, ``U (mV)`` or ``U/mV``.

    Returns
    -------
    name : str
        The name.
    units : str or None
        The unit, None if there is none.

    Examples
    --------
    >>> header_cell("Dev1/ai0 [mV]"), header_cell("t/s"), header_cell("voltage")
    (('Dev1/ai0', 'mV'), ('t', 's'), ('voltage', None))
    """
    match = _HEADER.fullmatch(cell.strip())
    if match is None:
        return cell.strip(), None
    name, *units = match.groups()
    return name, next((unit.strip() for unit in units if unit), None)


def find_signals(
    channels: Sequence[Channel], where: File, selected: str | None = None, unit: str | None = None
) -> list[Signal]:
    """Find the time and the measured quantity among the channels of a file.

    A channel's quantity follows from its name; if no name gives one, from the units. The first
    voltage or resistance is taken unless a channel is selected. The time has as many samples as
    that channel; one of the same group is preferred.

    Parameters
    ----------
    channels : sequence of Channel
        All numeric columns, variables or channels.
    where : str or Path
        The file, for error messages.
    selected : str, optional
        Name, or full name, of the channel to read.
    unit : str, optional
        Its unit; overrides the one in the file.

    Returns
    -------
    list of Signal
        The time, if the file has one, and the voltage or resistance.

    Raises
    ------
    DataError
        If there is no voltage or resistance; if no channel, or more than one, has the selected
        name; if a unit is missing, unknown, or contradicts the channel's name.

    Examples
    --------
    >>> columns = [Channel("t", "ms", "t [ms]"), Channel("U", "mV", "U [mV]")]
    >>> time, measured = find_signals(columns, "run.csv")
    >>> time.factor, measured.quantity
    (0.001, 'voltage')
    """
    indices = range(len(channels))
    if selected is None:
        index = _first_of(ELECTRICAL, channels, indices)
    else:
        index = _selected(channels, selected, where)
    if index is None:
        raise DataError(
            f"{where}: got {_listed(channels) or 'nothing'}, need a voltage or a resistance with "
            "its unit, such as 'voltage [V]', or 'channel' given beside the file"
        )
    channel = channels[index] if unit is None else replace(channels[index], units=unit)
    named = _quantity_of_name(channel)
    measured = _signal(index, channel, named if named in ELECTRICAL else None, where)
    others = [i for i in indices if i != index and channels[i].size == channel.size]
    own_group = [i for i in others if channels[i].group == channel.group]
    for candidates in (own_group, others):
        time = _first_of(["time"], channels, candidates)
        if time is not None:
            return [_signal(time, channels[time], "time", where), measured]
    return [measured]


def _first_of(quantities, channels, indices):
    """Index of the first channel of one of the quantities, by name or else by unit; or None."""
    for quantity_of in (_quantity_of_name, _quantity_of_unit):
        for index in indices:
            if quantity_of(channels[index]) in quantities:
                return index
    return None


def _selected(channels, name, where):
    """Index of the only channel of a name or full name."""
    found = [i for i, one in enumerate(channels) if name in (one.name, one.full_name)]
    if len(found) == 1:
        return found[0]
    reason = f"no channel {shown(name)}, need one of"
    if found:
        reason = f"channel {shown(name)} is ambiguous, need the full name of one"
    listed = _listed([channels[index] for index in found] or channels)
    raise DataError(f"{where}: {reason}: {listed or 'the file has no numeric channel'}")


def _listed(channels):
    names = ", ".join(shown(channel.full_name) for channel in channels[:_MOST_NAMES])
    more = len(channels) - _MOST_NAMES
    return f"{names} and {more} more" if more > 0 else names


def _quantity_of_name(channel):
    # Words match in any case, compounds too; symbols only in their case, since T is a temperature.
    words = re.split(r"[\W_\d]+", channel.name)
    for quantity, endings in _ENDINGS.items():
        if any(word.casefold().endswith(endings) for word in words):
            return quantity
    return next((_SYMBOLS[word] for word in words if word in _SYMBOLS), None)


def _quantity_of_unit(channel):
    units = usual_spelling(channel.units or "")
    return next((quantity for quantity, one in UNITS.items() if converts(units, one)), None)


def _signal(index, channel, quantity, where):
    """Signal of a channel; if its quantity is None, the unit decides between the measured ones."""
    here = f"{where}: {shown(channel.name)}"
    if not channel.units:
        example = f"'{channel.name} [{UNITS[quantity or 'voltage']}]'"
        other = "" if quantity == "time" else ", or 'unit' given beside the file"
        raise DataError(f"{here} has no unit, need one such as {example}{other}")
    with located(here, DataError):
        quantity = quantity or electrical_quantity(channel.units)
        factor = convert(1.0, usual_spelling(channel.units), UNITS[quantity])
    return Signal(index, quantity, factor)
