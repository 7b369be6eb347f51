"""The rig stage: voltages that rigs of several bandwidths log at the trace points."""

import numpy as np
import xarray as xr

from lube.contact.rough_pair import roughness_batch
from lube.errors import DataError
from lube.grid.operating_points import OperatingPoint, operating_points
from lube.physics.electrical import resistance_from_voltage
from lube.rig.contact_share import record_counter
from lube.rig.simulator import Revolution, simulated_revolutions
from lube.schema import EXPERIMENT_DIMS, POINT_DIMS, label
from lube.study.study import Study
from lube.types import Datasets

BANDWIDTHS = (1e3, 3e3, 1e4, 3e4, 1e5, 3e5)
"""Bandwidths in Hz of the rigs that are compared, other things equal."""


def make(study: Study, inputs: Datasets, threads: int = 1) -> xr.Dataset:
    """Make ``rig.nc``; see `lube.stages`."""
    lines = roughness_batch(study.line_spec, study.seed, study.rig_realisations)
    return rig_records(lines, inputs["film"], study)


def rig_records(lines: xr.Dataset, film: xr.Dataset, study: Study) -> xr.Dataset:
    """Record the study's trace points with simulated rigs of several bandwidths.

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
        (operating_point, rig_time) of the study's rig over the first revolution, and contact
        shares by bandwidth and threshold over all revolutions of all pairs of rollers. Points
        where the film is not known are left out.

    Raises
    ------
    DataError
        If the film is known at none of the points.
    """
    points = [_point_at(levels, film) for levels in study.trace_points]
    points = [point for point in points if point.is_known]
    if not points:
        raise DataError("traces: the film is known at none of the points, need one at least")
    records = [_BandwidthRecord(study) for _ in points]
    for _, number, revolution in simulated_revolutions(lines, study, points):
        records[number].add(revolution)
    return label(_dataset(points, records, study), "rig")


def _point_at(levels: dict, film: xr.Dataset) -> OperatingPoint:
    """Operating point of the given levels, with the film thickness of its formula."""
    table = film.sel(film_formula=levels["film_formula"])
    here = table.sel({name: [levels[name]] for name in POINT_DIMS})
    return operating_points(here, levels["slide_to_roll_ratio"])[0]


class _BandwidthRecord:
    """Records of rigs of several bandwidths at one operating point, counted as they arrive."""

    def __init__(self, study: Study) -> None:
        self._rig, self.voltage = study.rig, None
        interval = 1.0 / study.rig.sampling_rate
        self._counters = [
            (rig, record_counter(study.experiment, rig, "voltage", interval))
            for rig in (study.rig.model_copy(update={"bandwidth": band}) for band in BANDWIDTHS)
        ]
        self._steps_in_contact = self._steps = 0

    def add(self, revolution: Revolution) -> None:
        if self.voltage is None:
            self.voltage = revolution.voltage(self._rig)
        for rig, counter in self._counters:
            counter.add(revolution.voltage(rig))
        self._steps_in_contact += np.count_nonzero(revolution.contact)
        self._steps += revolution.contact.size

    @property
    def shares(self) -> list[np.ndarray]:
        """Contact shares, shape (bandwidth, threshold)."""
        return [counter.below.sum(axis=1) / counter.samples for _, counter in self._counters]

    @property
    def true_share(self) -> float:
        """Share of time with metal contact."""
        return self._steps_in_contact / self._steps


def _dataset(
    points: list[OperatingPoint], records: list[_BandwidthRecord], study: Study
) -> xr.Dataset:
    """Dataset of the records and their operating points."""
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
