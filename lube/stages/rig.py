"""The rig stage: what the simulated rig logs at the trace points, and rigs of other bandwidths."""

import numpy as np
import xarray as xr

from lube.grid.operating_points import operating_points
from lube.physics.electrical import resistance_from_voltage
from lube.rig.contact_share import record_counter
from lube.rig.simulator import SimulatedRig
from lube.schema import EXPERIMENT_DIMS, POINT_DIMS, label

BANDWIDTHS = (1e3, 3e3, 1e4, 3e4, 1e5, 3e5)
"""Bandwidths in Hz that the rig's records are tried with, other things equal."""


def rig_records(lines, film, study):
    """Record the study's trace points with the simulated rig, and with others.

    Parameters
    ----------
    lines : xarray.Dataset
        A ``roughness_batch`` dataset of `Study.rig_realisations`.
    film : xarray.Dataset
        A ``film`` dataset.
    study : Study
        Its trace points, rig, evaluation of records, boundary layer, rollers and seed.

    Returns
    -------
    xarray.Dataset
        The ``rig`` file of `lube.schema`: voltage (V) and resistance (ohm) over
        (operating_point, rig_time) for the first revolution, and the shares of time below the
        thresholds that rigs of several bandwidths would find, over all revolutions of all
        its pairs of rollers.
    """
    points = [_point_at(levels, film) for levels in study.trace_points]
    records = [_TriedRecord(study) for _ in points]
    for _, number, revolution in SimulatedRig(lines, study, points).revolutions():
        records[number].add(revolution)
    return label(_dataset(points, records, study), "rig")


def _point_at(levels, film):
    """Operating point of the given levels, with the film of its formula."""
    table = film.sel(film_formula=levels["film_formula"])
    here = table.sel({name: [levels[name]] for name in POINT_DIMS})
    return operating_points(here, levels["slide_to_roll_ratio"])[0]


class _TriedRecord:
    """What rigs of several bandwidths log at one operating point, counted as it comes."""

    def __init__(self, study):
        self._rig, self.voltage = study.rig, None
        interval = 1.0 / study.rig.sampling_rate
        self._tried = [
            (rig, record_counter(study.experiment, rig, "voltage", interval))
            for rig in (study.rig.model_copy(update={"bandwidth": band}) for band in BANDWIDTHS)
        ]
        self._touched = self._steps = 0

    def add(self, revolution):
        if self.voltage is None:
            self.voltage = revolution.voltage(self._rig)
        for rig, counter in self._tried:
            counter.add(revolution.voltage(rig))
        self._touched += np.count_nonzero(revolution.contact)
        self._steps += revolution.contact.size

    @property
    def shares(self):
        """Share below each threshold, shape (bandwidth, threshold)."""
        return [counter.below.sum(axis=1) / counter.samples for _, counter in self._tried]

    @property
    def true_share(self):
        """Share of time with metal contact."""
        return self._touched / self._steps


def _dataset(points, records, study):
    """Set the records side by side, with their operating points."""
    voltage = np.array([record.voltage for record in records])
    along, over_time = ("operating_point",), ("operating_point", "rig_time")
    shares = np.array([record.shares for record in records])
    dataset = xr.Dataset(
        {
            "voltage": (over_time, voltage),
            "resistance": (over_time, resistance_from_voltage(voltage, study.rig)),
            "contact_share": ((*along, "bandwidth", "threshold"), shares),
            "true_contact_share": (along, np.array([record.true_share for record in records])),
        }
        | {name: (along, [point.levels[name] for point in points]) for name in EXPERIMENT_DIMS},
        coords={
            "rig_time": 1.0 / study.rig.sampling_rate * np.arange(voltage.shape[1]),
            "bandwidth": np.array(BANDWIDTHS),
            "threshold": np.array(study.experiment.thresholds),
            "origin": "simulated",
            "revolutions": study.rig.revolutions,
        },
    )
    for name in ("bandwidth", "sampling_rate", "bias_voltage"):
        dataset[f"rig_{name}"] = getattr(study.rig, name)
    return dataset.set_coords(list(EXPERIMENT_DIMS))
