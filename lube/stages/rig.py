"""The rig stage: voltages that rigs of several bandwidths log at the trace points."""

import numpy as np
import xarray as xr

from lube.grid.film_responses import with_surface_responses
from lube.grid.operating_points import known_rows
from lube.physics.electrical import resistance_from_voltage
from lube.rig.contact_share import record_counter
from lube.rig.simulator import simulated_revolutions
from lube.schema import EXPERIMENT_DIMS, label, with_dims
from lube.study.study import Study
from lube.types import Datasets

BANDWIDTHS = (1e3, 3e3, 1e4, 3e4, 1e5, 3e5)
"""Bandwidths in Hz of the rigs that are compared; they are equal otherwise."""
_KEPT = ("bandwidth", "sampling_rate", "bias_voltage")


def make(study: Study, inputs: Datasets, threads: int = 1) -> xr.Dataset:
    """Make ``rig.nc``: the study's trace points, recorded with rigs of several bandwidths.

    Parameters
    ----------
    study, inputs, threads
        As in `lube.stages`.

    Returns
    -------
    xarray.Dataset
        The ``rig`` file of `lube.schema`: voltage (V) and resistance (ohm) over
        (operating_point, rig_time) of the study's rig over the first revolution, and contact
        shares by bandwidth and threshold over all revolutions of all pairs of rollers. Points
        where the film is not known are left out.

    Raises
    ------
    DataError
        If the film is known at none of the points.
    """
    points = known_rows(with_surface_responses(inputs), study.trace_points, study.gap)
    voltage, counters, steps = _recorded(study, points, threads)
    values = {
        "voltage": voltage,
        "resistance": resistance_from_voltage(voltage, study.rig),
        "contact_share": [[one.below.sum(axis=1) / one.samples for one in row] for row in counters],
        "true_contact_share": steps[:, 0] / steps[:, 1],
    }
    values |= {f"rig_{name}": getattr(study.rig, name) for name in _KEPT}
    levels = {name: points[name].values for name in EXPERIMENT_DIMS}
    levels |= {
        "rig_time": 1.0 / study.rig.sampling_rate * np.arange(voltage.shape[1]),
        "bandwidth": np.array(BANDWIDTHS),
        "threshold": np.array(study.experiment.thresholds),
        "origin": "simulated",
        "revolutions": study.rig.revolutions,
    }
    return label(xr.Dataset(with_dims("rig", values), with_dims("rig", levels)), "rig")


def _recorded(study, points, threads):
    """Voltages of a revolution, counters by bandwidth, and time steps: in contact, and all."""
    count, interval = points.sizes["operating_point"], 1.0 / study.rig.sampling_rate
    rigs = [study.rig.model_copy(update={"bandwidth": band}) for band in BANDWIDTHS]
    counters = [
        [record_counter(study.experiment, rig, "voltage", interval) for rig in rigs]
        for _ in range(count)
    ]
    voltages, steps = {}, np.zeros((count, 2), int)
    for _, number, revolution in simulated_revolutions(study, points, threads):
        if number not in voltages:
            voltages[number] = revolution.voltage(study.rig)
        for rig, counter in zip(rigs, counters[number], strict=True):
            counter.add(revolution.voltage(rig))
        steps[number] += np.count_nonzero(revolution.contact), revolution.contact.size
    return np.array([voltages[number] for number in range(count)]), counters, steps
