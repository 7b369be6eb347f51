"""What meters read from the voltage of a record: shares of time, or its mean."""

from collections.abc import Sequence
from functools import partial

import numpy as np
import xarray as xr

from lube.physics import electrical
from lube.rig.contact_share import record_counter
from lube.rig.simulator import Revolution
from lube.study.rig_settings import Experiment, Rig
from lube.types import Array, Pair

READINGS = "threshold", "adaptive threshold", "mean voltage"
"""Ways to read a contact share: the time below the study's threshold; the time below half of the
record's highest voltage; and one minus the mean voltage over that of an open circuit, as an *ECR*
meter shows it."""
HIGHEST = 0.99
"""The highest voltage is the one that this part of the record lies below, because of the noise."""
_BINS = 20_000
_BEGINNINGS = 8
"""Most instants at which sampling of one revolution begins, for `mean_shares`."""


def mean_shares(
    revolution: Revolution, experiment: Experiment, rig: Rig
) -> tuple[list[float], Array]:
    """Read contact shares from one revolution, on average over when sampling begins.

    A record of rare contact has few samples in contact: it may read a tenth more or less by chance.
    What remains on average is the rig's own error.

    Parameters
    ----------
    revolution : Revolution
        Of the simulated rig.
    experiment, rig
        As for `read_shares`.

    Returns
    -------
    shares, by_threshold
        As from `read_shares`.
    """
    steps_per_sample = 1.0 / (rig.sampling_rate * revolution.time_step)
    beginnings = int(np.clip(steps_per_sample, 1, _BEGINNINGS))
    faster = rig.model_copy(update={"sampling_rate": beginnings * rig.sampling_rate})
    voltage = revolution.voltage(faster)
    records = [voltage[first::beginnings] for first in range(min(beginnings, voltage.size))]
    read = zip(*(read_shares(record, experiment, rig) for record in records), strict=True)
    shares, by_threshold = (np.mean(each, axis=0) for each in read)
    return shares.tolist(), by_threshold


def charged_capacitance(
    film: xr.Dataset, gaps: Sequence[Pair], layer: float, length: float, oil: float
) -> xr.DataArray:
    """Capacitance that a circuit charges while the contact is open: of the gap, and beside it.

    Parameters
    ----------
    film : xarray.Dataset
        Films and contacts at operating points.
    gaps : sequence of tuple
        Mean gap and rms height at each operating point, m, over positions across the contact.
    layer, length, oil : float
        As for `lube.physics.electrical.mean_inverse_open_gap` and `surrounding_capacitance`.

    Returns
    -------
    xarray.DataArray
        F, over the dimensions of the film thickness.
    """
    names = "film_thickness", "contact_half_width", "reduced_radius"
    thickness, *dry = xr.broadcast(*(film[name] for name in names))
    half_width, radius = (each.transpose(*thickness.dims) for each in dry)
    inverse = [electrical.mean_inverse_open_gap(*gap, layer).mean() for gap in gaps]
    plates = thickness.copy(data=1.0 / np.reshape(inverse, thickness.shape))
    around = partial(electrical.surrounding_capacitance, length=length, oil=oil)
    beside = xr.apply_ufunc(around, thickness, half_width, radius)
    return electrical.film_capacitance(plates, half_width, length, oil) + beside


def read_shares(voltage: Array, experiment: Experiment, rig: Rig) -> tuple[list[float], Array]:
    """Read contact shares from a record, in all ways.

    Parameters
    ----------
    voltage : numpy.ndarray
        Shape (N,), V.
    experiment : Experiment
        The thresholds (ohm) and how contact ends.
    rig : Rig
        The circuit.

    Returns
    -------
    shares : list of float
        Contact share by each of `READINGS`.
    by_threshold : numpy.ndarray
        Share of time below each of the study's thresholds.
    """
    counter = record_counter(experiment, rig, "voltage", 1.0 / rig.sampling_rate)
    counter.add(voltage)
    by_threshold = counter.below.sum(axis=1) / voltage.size
    whole = electrical.divider_voltage(rig.leak_resistance, rig).item()
    # From zero to twice the open circuit; noise beyond it is put at the ends.
    bins = np.clip(voltage * (0.5 * _BINS / whole), 0, _BINS - 1).astype(np.int64)
    below = np.cumsum(np.bincount(bins, minlength=_BINS))
    highest = np.searchsorted(below, HIGHEST * voltage.size)
    shares = [
        by_threshold[experiment.thresholds.index(experiment.threshold)],
        below[highest // 2] / voltage.size,
        1.0 - float(np.sum(voltage)) / voltage.size / whole,
    ]
    return shares, by_threshold
