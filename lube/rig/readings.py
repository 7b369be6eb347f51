"""What meters read from the voltage of a record: shares of time, or its mean."""

import numpy as np

from lube.physics.electrical import divider_voltage
from lube.rig.contact_share import record_counter
from lube.study.rig_settings import Experiment, Rig
from lube.types import Array

READINGS = "threshold", "adaptive threshold", "mean voltage"
"""Ways to read a contact share: the time below the study's threshold; the time below half of the
record's highest voltage; and one minus the mean voltage over that of an open circuit, as an *ECR*
meter shows it."""
HIGHEST = 0.99
"""The highest voltage is the one that this part of the record lies below, because of the noise."""
_BINS = 20_000


class Readings:
    """Contact shares as meters read them, from a record that arrives piece by piece.

    Parameters
    ----------
    experiment : Experiment
        The threshold (ohm) and how contact ends.
    rig : Rig
        The circuit.
    """

    def __init__(self, experiment: Experiment, rig: Rig) -> None:
        self._rig, self._open = rig, divider_voltage(rig.leak_resistance, rig).item()
        self._threshold = experiment.thresholds.index(experiment.threshold)
        self._counter = record_counter(experiment, rig, "voltage", 1.0 / rig.sampling_rate)
        self._histogram, self._sum = np.zeros(_BINS, np.int64), 0.0

    def add(self, voltage: Array) -> None:
        """Read the next piece of the record.

        Parameters
        ----------
        voltage : numpy.ndarray
            Shape (N,), V.
        """
        self._counter.add(voltage)
        self._sum += float(np.sum(voltage))
        # From zero to twice the open circuit; noise beyond it is put at the ends.
        bins = voltage * (0.5 * _BINS / self._open)
        bins = np.clip(bins, 0, _BINS - 1).astype(np.int64)
        self._histogram += np.bincount(bins, minlength=_BINS)

    @property
    def by_threshold(self) -> Array:
        """Share of time below each of the study's thresholds."""
        return self._counter.below.sum(axis=1) / self._counter.samples

    @property
    def shares(self) -> list[float]:
        """Contact share by each of `READINGS`."""
        samples = self._counter.samples
        below = np.cumsum(self._histogram)
        highest = np.searchsorted(below, HIGHEST * samples)
        return [
            self.by_threshold[self._threshold],
            below[highest // 2] / samples,
            1.0 - self._sum / samples / self._open,
        ]
