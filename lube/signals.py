"""What the columns, variables and channels of a record mean, and whether their samples are sound.

A record is one quantity, a voltage or a resistance, sampled uniformly. Its files name that
quantity in many ways; the unit must be written, it is never guessed.
"""

import re
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np

from lube.errors import DataError, LubeError, shown
from lube.kernels.uniform import first_uneven, first_unsound
from lube.units import ELECTRICAL, convert, usual_spelling

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
class Signal:
    """A column, variable or channel of a record.

    Attributes
    ----------
    place : int
        Its number among those of the file.
    quantity : str
        ``time``, ``voltage`` or ``resistance``.
    factor : float
        From its own unit to s, V or ohm.
    """

    place: int
    quantity: str
    factor: float

    def converted(self, values):
        """Values of the file in s, V or ohm, float64."""
        values = np.asarray(values, float)
        return values if self.factor == 1.0 else values * self.factor


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


def find_signals(columns, where):
    """Find the time and the measured quantity among the columns of a file.

    Names decide, and where none of them tells, units. Where a file holds several voltages or
    resistances, the first counts.

    Parameters
    ----------
    columns : list of tuple of str
        Name and unit (or None) of each column, variable or channel.
    where : str or Path
        The file, for the message.

    Returns
    -------
    time : Signal or None
        The time, if the file has any.
    measured : Signal
        The voltage or resistance.

    Raises
    ------
    DataError
        If there is no voltage or resistance, or a unit is missing or unknown.
    """
    measured = _find(columns, ELECTRICAL, where)
    if measured is None:
        names = ", ".join(shown(name) for name, _ in columns[:5]) or "nothing"
        raise DataError(
            f"{where}: got {names}, need a voltage or a resistance with its unit, such as "
            "'voltage [V]'"
        )
    return _find(columns, ("time",), where), measured


def _find(columns, quantities, where):
    for told_by in (_named_quantity, _quantity_of_unit):
        for place, (name, units) in enumerate(columns):
            quantity = told_by(name, units)
            if quantity in quantities:
                return Signal(place, quantity, _factor(name, units, quantity, where))
    return None


def _named_quantity(name, _):
    # Symbols as they are, since T is a temperature; words in any case, compound ones too.
    words = re.split(r"[\W_\d]+", name)
    for quantity, endings in _ENDINGS.items():
        if any(word.casefold().endswith(endings) for word in words):
            return quantity
    return next((_SYMBOLS[word] for word in words if word in _SYMBOLS), None)


def _quantity_of_unit(_, units):
    for quantity, target in UNITS.items():
        try:
            convert(1.0, usual_spelling(units or ""), target)
        except LubeError:
            continue
        return quantity
    return None


def _factor(name, units, quantity, where):
    if not units:
        raise DataError(
            f"{where}: {shown(name)} has no unit, need one such as '{name} [{UNITS[quantity]}]'"
        )
    try:
        return convert(1.0, usual_spelling(units), UNITS[quantity])
    except LubeError as error:
        raise DataError(f"{where}: {shown(name)}: {error}") from None


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
