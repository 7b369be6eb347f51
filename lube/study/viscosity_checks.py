"""Refusal of viscosities that contradict one another, or that no law can fit."""

from __future__ import annotations

from collections.abc import Iterable
from itertools import pairwise
from typing import TYPE_CHECKING

from lube.errors import RecordError, located
from lube.physics import ZERO_CELSIUS
from lube.physics.coolprop_fluids import ATMOSPHERIC_PRESSURE
from lube.types import File

if TYPE_CHECKING:  # a record checks its points
    from lube.study.lubricant_record import LubricantRecord

ROUNDING = 1e-6
"""Temperatures converted from K or degF to degC may miss a limit by this much, degC."""

AGREEMENT = 0.02
"""Relative difference up to which two viscosities in the same state count as one, repeated."""

LEAST_PRESSURES = 3
"""Pressures above atmospheric that a fit needs at each temperature; the law has two parameters."""

LEAST_RISE = 5.0
"""Factor by which the viscosity must rise for a reciprocal asymptotic isoviscous pressure.

Its integral runs on beyond the measured pressures; with this factor about a fifth lies there.
"""


def check_points(record: LubricantRecord, where: File) -> None:
    """Refuse viscosities that contradict one another, or that no law can fit.

    Parameters
    ----------
    record : LubricantRecord
        The lubricant, with its points.
    where : str or Path
        Where they come from, for the message.

    Raises
    ------
    RecordError
        If two viscosities in the same state, dynamic or kinematic, differ by more than
        `AGREEMENT`; if all are at one temperature; if they rise with temperature or fall with
        pressure; if they leave the pressure-viscosity coefficient open, or give a second one.
    """
    with located(f"{where}"):
        _check_ambient(record)
        _check_isotherms(record)
    lowest, highest = record.valid_temperatures
    if lowest > highest:
        raise RecordError(
            f"{where}: got no temperature with both viscosity and pressure-viscosity coefficient, "
            "need a common range of temperatures, or temperature_range"
        )


def _check_ambient(record):
    states = sorted(state for point in record._ambient for state in _states(record, point))
    if len({temperature for temperature, *_ in states}) < 2:
        raise RecordError("viscosity: got fewer than two temperatures, need two or more")
    for (cold, thick, words), (hot, thin, others) in pairwise(states):
        if hot - cold <= ROUNDING:
            _check_agreement(thick, thin, f"{words} and {others} at {hot:g} degC")
        elif thick <= thin:
            raise RecordError(
                f"viscosity: got {others} at {hot:g} degC, need less than at {cold:g} degC, {words}"
            )


def _states(record, point) -> Iterable[tuple[float, float, str]]:
    """Temperature, kinematic viscosity and words for each viscosity of a point."""
    if point.kinematic_viscosity is not None:
        value = point.kinematic_viscosity
        yield point.temperature, value, f"{1e6 * value:.4g} mm2/s"
    if point.dynamic_viscosity is not None:
        density = record.density_at(point.temperature + ZERO_CELSIUS)
        value = point.dynamic_viscosity / density
        words = f"{1e3 * point.dynamic_viscosity:.4g} mPa s over {density:.4g} kg/m3"
        yield point.temperature, value, f"{1e6 * value:.4g} mm2/s ({words})"


def _check_agreement(one, other, words):
    if max(one, other) > (1.0 + AGREEMENT) * min(one, other):
        needed = f"need one value, or several within {100 * AGREEMENT:g} %"
        raise RecordError(f"viscosity: got {words}, {needed}")


def _check_isotherms(record):
    given, alpha = record.pressure_viscosity.given, record.pressure_viscosity
    if bool(given) == bool(record.isotherms):
        came = f"{given[0]} and viscosities under pressure" if given else "none"
        needed = "need one of gold_base, value, points, or viscosities under pressure"
        raise RecordError(f"pressure_viscosity: got {came}, {needed}")
    for temperature, pairs in record.isotherms.items():
        at = f"at {temperature:g} degC"
        for (low, thin), (high, thick) in pairwise([(0.0, 1.0), *pairs]):
            if low == high:
                words = f"{thin:.4g} and {thick:.4g} times that at atmospheric pressure {at}"
                _check_agreement(thin, thick, f"{words} and {_absolute(high)}")
            elif thick <= thin:
                came = f"got no rise {at} from {_absolute(low)} to {_absolute(high)}"
                raise RecordError(f"viscosity: {came}, need a rise with pressure")
        count, (most, rise) = len({pressure for pressure, _ in pairs}), pairs[-1]
        if count < LEAST_PRESSURES:
            came = f"got {count} pressures above atmospheric {at}"
            raise RecordError(f"viscosity: {came}, need {LEAST_PRESSURES} or more")
        if alpha.definition == "reciprocal-asymptotic" and rise < LEAST_RISE:
            raise RecordError(
                f"viscosity: got a rise to {rise:.3g} times that at atmospheric pressure {at}, "
                f"definition 'reciprocal-asymptotic' needs {LEAST_RISE:g} times or more"
            )
        if alpha.span is not None and alpha.span > (1.0 + ROUNDING) * most:
            came = f"pressure_viscosity.pressure: got {alpha.pressure / 1e6:g} MPa"
            needed = f"need at most {_absolute(most)}, where the viscosities {at} end"
            raise RecordError(f"{came}, {needed}")


def _absolute(pressure):
    """Pressure above atmospheric as it was written."""
    return f"{(pressure + ATMOSPHERIC_PRESSURE) / 1e6:g} MPa"
