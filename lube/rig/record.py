"""Evaluation of one record of the twin-disc rig: contact shares, repetition, trace.

A record is a voltage or resistance over time with its operating conditions, measured or simulated.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from lube.grid.discretise import speed_ratios
from lube.grid.levels import level_near
from lube.grid.operating_points import surface_speeds
from lube.physics.electrical import resistance_from_voltage
from lube.rig.contact_share import folded_counts, record_counter, share_interval
from lube.rig.simulator import Revolution, repeats
from lube.schema import values_with_limits
from lube.statistics.folding import CLEAR, SPAN, fold
from lube.statistics.one_pair import distinct_alignments
from lube.study.study import Study

LEVELS = ("force", "speed", "temperature")
"""Operating variables that are measured, and for which a study has levels."""

TRACE_SAMPLES = 4096
"""Number of values kept of the first revolution of a record. If it has more samples, these are the
minimum and the maximum of equal parts."""


@dataclass(frozen=True)
class Conditions:
    """Operating conditions of a record.

    Attributes
    ----------
    force, speed, temperature : float
        Force (N), speed (rpm) and temperature (degC).
    lubricant : str
        Name of the lubricant.
    slide_to_roll_ratio : float
        (v1 - v2) / v, with the surface speeds and their mean v.
    pair : str
        Label of the pair of rollers.
    tolerances : mapping of str to float
        Largest distances of force, speed and temperature from a level, N, rpm and K.
    """

    force: float
    speed: float
    temperature: float
    lubricant: str
    slide_to_roll_ratio: float
    pair: str
    tolerances: Mapping[str, float]

    def labelled(self, study: Study) -> dict[str, Any]:
        """Conditions by name, and the study's level near each of `LEVELS`, NaN if none is."""
        row = {name: value for name, value in vars(self).items() if name != "tolerances"}
        for name in LEVELS:
            levels = getattr(study.operating_grid, name)
            found = level_near(levels, row[name], self.tolerances[name])
            row[f"{name}_level"] = np.nan if found is None else found
        return row


class Record:
    """A record that is evaluated while its samples arrive.

    Parameters
    ----------
    conditions : Conditions
        Its operating conditions.
    study : Study
        Its rollers, the circuit of its rig and its evaluation of records.
    quantity : str, optional
        ``voltage`` (V) or ``resistance`` (ohm).
    sampling_interval : float, optional
        Time between samples, s; by default that of the study's simulated rig.
    """

    def __init__(
        self,
        conditions: Conditions,
        study: Study,
        quantity: str = "voltage",
        sampling_interval: float | None = None,
    ) -> None:
        self.conditions, self._study, self._quantity = conditions, study, quantity
        self._interval = sampling_interval or 1.0 / study.rig.sampling_rate
        self._counter = record_counter(study.experiment, study.rig, quantity, self._interval)
        self._beginning, self._steps_in_contact, self._steps = [], 0, 0
        points = study.line_spec.points
        self._ratios = speed_ratios(conditions.slide_to_roll_ratio)
        self._faster = 0 if self._ratios[0] == 1.0 else 1
        # Time steps in a revolution of each roller that turns: in one step the faster surface
        # moves by one grid point. The period is that of the first of them.
        both = zip(points, self._ratios, strict=True)
        self._revolutions = [size / ratio for size, ratio in both if ratio > 0.0]
        faster_speed = max(surface_speeds(conditions.speed, conditions.slide_to_roll_ratio))
        self._period = 60.0 / faster_speed * (self._revolutions[0] / points[0])

    def add(self, values: np.ndarray) -> None:
        """Count the next samples.

        Parameters
        ----------
        values : numpy.ndarray
            Shape (N,), V or ohm.
        """
        # For the trace, a little more than one revolution is kept.
        wanted = round((1.0 + SPAN) * max(round(self._period / self._interval), 1))
        missing = wanted - sum(part.size for part in self._beginning)
        if missing > 0:
            self._beginning.append(np.array(values[:missing], float))
        self._counter.add(values)

    def add_revolution(self, revolution: Revolution) -> None:
        """Count a revolution of the simulated rig, and its true time in contact."""
        self.add(revolution.voltage(self._study.rig))
        self._steps_in_contact += np.count_nonzero(revolution.contact)
        self._steps += revolution.contact.size

    def evaluate(self, correct_speed: bool = False) -> dict[str, Any]:
        """Evaluate the samples.

        Parameters
        ----------
        correct_speed : bool, optional
            Whether to use the speed at which the record repeats itself, if it differs from the
            stated speed by more than the tolerance.

        Returns
        -------
        dict
            Values of the record by the variables' names in the ``experiment`` file.
        """
        below, sizes = self._counter.below, self._counter.sizes
        block = float(sizes[0]) * self._interval
        at = self._study.experiment.thresholds.index(self._study.experiment.threshold)
        folded = fold(below[at] / sizes, block, self._period)
        period = folded.revolution_period
        speed_ratio = self._period / period if folded.repeatability >= CLEAR else np.nan
        duration = self._counter.samples * self._interval
        # Revolutions are counted of the roller with the faster surface.
        steps_around = self._study.line_spec.points[self._faster]
        revolutions = duration / period * (self._revolutions[0] / steps_around)
        periods = {period * each / self._revolutions[0] for each in self._revolutions}
        periods = sorted(periods) if duration > period else ()
        folds = [folded_counts(below, sizes, block, each) for each in periods]
        shares = share_interval(below, sizes, self._windows(revolutions), folds)
        conditions = self._corrected(speed_ratio) if correct_speed else self.conditions
        return {
            **conditions.labelled(self._study),
            **values_with_limits("contact_share", shares),
            "duration": duration,
            "sampling_interval": self._interval,
            "turns": revolutions,
            "speed_ratio": speed_ratio,
            **vars(folded),
            "share_error": folded.share_error if repeats(self._study, self._ratios) else 0.0,
            **self._trace(period),
            "true_contact_share": self._steps_in_contact / self._steps if self._steps else np.nan,
        }

    def _corrected(self, speed_ratio):
        """Conditions at the speed of the repetition, if it is beyond the tolerance."""
        speed = self.conditions.speed * speed_ratio
        beyond = abs(speed - self.conditions.speed) > self.conditions.tolerances["speed"]
        return replace(self.conditions, speed=speed) if beyond else self.conditions

    def _windows(self, revolutions):
        """Count the windows in the record that have no roughness in common."""
        spec, ratios = self._study.line_spec, self._ratios
        reach = 2.0 * self._study.rollers.contact_half_width(self.conditions.force)
        reach = (reach + spec.longest_wavelength) / spec.spacing
        different = distinct_alignments(revolutions, ratios, spec.points, reach)
        return max(different * spec.points[self._faster] * min(ratios) / reach, 1.0)

    def _trace(self, period):
        """Resistance over the first revolution."""
        values = np.concatenate(self._beginning)[: max(round(period / self._interval), 1)]
        if self._quantity == "voltage":
            values = resistance_from_voltage(values, self._study.rig)
        times, values = _thinned(values, self._interval)
        return {"trace_time": times, "trace_resistance": values}


def _thinned(values, interval):
    """At most `TRACE_SAMPLES` times and values; the minimum and maximum of equal parts."""
    times, kept = np.full((2, TRACE_SAMPLES), np.nan)
    if values.size <= TRACE_SAMPLES:
        times[: values.size], kept[: values.size] = interval * np.arange(values.size), values
        return times, kept
    edges = np.arange(TRACE_SAMPLES // 2 + 1) * values.size // (TRACE_SAMPLES // 2)
    least, greatest = (each.reduceat(values, edges[:-1]) for each in (np.minimum, np.maximum))
    kept[0::2], kept[1::2] = least, greatest
    times[0::2], times[1::2] = interval * edges[:-1], interval * 0.5 * (edges[:-1] + edges[1:])
    return times, kept
